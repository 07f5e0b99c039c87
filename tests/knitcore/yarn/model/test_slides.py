"""Yarn that is kept from sliding where it touches."""

import numpy as np
import pytest

from knitcore.chart.fabric import Direction, Fabric
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.study.sweep import sweep, with_slides_held
from tests.knitcore.yarn.relaxed import relaxed


@pytest.fixture(scope="module")
def seed():
    return relaxed(Fabric.SEED, sample("acrylic", Fabric.SEED), branch="mirrored")


def test_a_stitch_has_the_two_slides_of_the_paper(seed):
    held = with_slides_held(seed)
    assert len(held.slides) == 2  # two crossovers that mirror each other, along either strand
    assert [slide.value(seed.state) for slide in held.slides] == pytest.approx([0.0, 0.0])
    apart = [np.linalg.norm(slide.apart @ seed.state) for slide in held.slides]
    np.testing.assert_allclose(apart, seed.min_distance_mm, rtol=1e-9)


def test_derivatives_of_a_slide_agree_with_differences(seed):
    slide = with_slides_held(seed).slides[0]
    rng = np.random.default_rng(0)
    for direction in rng.standard_normal((4, len(seed.state))):
        h = 1e-6
        ahead, behind = seed.state + h * direction, seed.state - h * direction
        slope = (slide.value(ahead) - slide.value(behind)) / (2 * h)
        assert slide.gradient(seed.state) @ direction == pytest.approx(slope, rel=1e-6)
        bend = (slide.gradient(ahead) - slide.gradient(behind)) / (2 * h)
        np.testing.assert_allclose(slide.hessian() @ direction, bend, atol=1e-6)


def test_quenched_slides_are_held_and_stiffen_seed(seed):
    free, held = (
        sweep(seed, Direction.COURSE, 0.3, points=4, back=False, slide_quenching=quenched)
        for quenched in (False, True)
    )
    assert any("Slide quenching" in note for note in held.notes)
    for cell in held.cells:
        assert cell.converged
        assert [slide.value(cell.state) for slide in cell.slides] == pytest.approx([0, 0], abs=1e-6)
    assert np.all(held.energy_n_mm[1:] > free.energy_n_mm[1:])
    assert held.stress_n_per_mm[1] > 1.05 * free.stress_n_per_mm[1]
