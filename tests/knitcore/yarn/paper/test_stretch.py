from functools import cache

import numpy as np
import pytest

from knitcore import CancelledError, Direction, Fabric
from knitcore.yarn.library.law_of_stretches import fit_sweeps
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.paper.bezier_relax import relax_published
from knitcore.yarn.paper.bezier_stitch import Stitch
from knitcore.yarn.paper.stretch import PublishedStretch, SlideQuenching
from knitcore.yarn.study.sweep import follow, sweep


def stretch(yarn_id, fabric, direction, max_strain, points, **options):
    known = sample(yarn_id, fabric)
    zero = relax_published(fabric, known.yarn, known.loop_length_mm, starts=1)
    return sweep(zero, direction, max_strain, points=points, **options)


@cache
def cotton_stockinette(direction, points=15):
    top = {Direction.COURSE: 0.84, Direction.WALE: 0.42}[direction]
    return stretch("cotton", "stockinette", direction, top, points, max_stress_n_per_mm=0.35)


@pytest.mark.slow
def test_stress_is_the_slope_of_the_energy():
    for curve in map(cotton_stockinette, Direction):
        assert curve.converged
        area = curve.zero.cell_course_mm * curve.zero.cell_wale_mm
        middle = 0.5 * (curve.strain[1:] + curve.strain[:-1])
        slope = np.diff(curve.energy_n_mm) / (np.diff(curve.strain) * area)
        inside = slice(0, 8)
        exact = np.interp(middle, curve.strain, curve.stress_n_per_mm)
        assert slope[inside] == pytest.approx(exact[inside], rel=0.05, abs=2e-3)
        assert abs(curve.stress_n_per_mm[0]) < 1e-4


@pytest.mark.slow
def test_published_moduli_of_cotton_stockinette():
    # Supplementary Table 12, simulation
    law = fit_sweeps(*map(cotton_stockinette, Direction)).law
    assert law.modulus_course == pytest.approx(0.298, rel=0.15)
    assert law.modulus_wale == pytest.approx(0.536, rel=0.15)
    assert law.poisson_yx == pytest.approx(0.441, abs=0.05)
    assert law.poisson_xy == pytest.approx(0.359, abs=0.05)


@pytest.mark.slow
def test_a_stretch_ends_beyond_the_requested_stress():
    course = cotton_stockinette(Direction.COURSE, points=7)
    assert course.stress_n_per_mm[-1] > 0.35 > course.stress_n_per_mm[-2]
    assert len(course.cells) < 7


@pytest.mark.slow
def test_contact_takes_over_along_the_wale_of_cotton_garter():
    # Supplementary Fig. 7b: bending leads at rest, contact at high strain
    curve = stretch("cotton", "garter", "wale", 1.0, 11)
    assert curve.contact_share[0] < 0.25
    assert np.all(np.diff(curve.contact_share) > 0)
    assert 0.6 < curve.contact_overtakes_at_strain < 1.0


@pytest.mark.slow
def test_acrylic_seed_buckles_along_the_wale():
    # paper, "Instability in acrylic seed": at a strain of about 0.8
    curve = stretch("acrylic", "seed", "wale", 0.91, 14)
    (after,) = curve.jumps
    assert 0.7 <= curve.strain[after - 1] < curve.strain[after] <= 0.9
    assert curve.stress_n_per_mm[after] < curve.stress_n_per_mm[after - 1]
    assert curve.transverse_strain[after] < curve.transverse_strain[after - 1] - 0.05
    assert curve.contact_share[after] < curve.contact_share[after - 1]


@pytest.mark.slow
def test_quenched_slides_keep_their_lengths_and_stiffen_seed():
    known = sample("acrylic", "seed")
    stitch = Stitch(known.fabric, known.yarn)
    zero = relax_published("seed", known.yarn, known.loop_length_mm, starts=1)
    stresses = {}
    for variant in SlideQuenching:
        along = PublishedStretch(zero, Direction.COURSE, variant)
        curve = follow(along, zero, Direction.COURSE, np.linspace(0.0, 0.1, 3))
        stresses[variant] = curve.stress_n_per_mm[-1]
        held = [variant.weights @ stitch.evaluate(cell.state).lengths_mm for cell in curve.cells]
        assert np.ptp(held, axis=0) == pytest.approx(0.0, abs=1e-4)
    assert stresses[SlideQuenching.NONE] < 0.7 * stresses[SlideQuenching.PAPER]
    assert stresses[SlideQuenching.PAPER] < stresses[SlideQuenching.AS_CODED]


def test_only_seed_along_the_course_is_quenched_by_default():
    quenched = {
        (fabric, direction)
        for fabric in Fabric
        for direction in Direction
        if SlideQuenching.default(fabric, direction) is not SlideQuenching.NONE
    }
    assert quenched == {(Fabric.SEED, Direction.COURSE)}


@pytest.mark.slow
def test_a_locked_yarn_ends_the_stretch_with_a_note():
    curve = stretch("cotton", "stockinette", "course", 1.2, 3)
    assert len(curve.cells) == 2
    assert any("locks" in note for note in curve.notes)


def test_a_stretch_can_be_stopped():
    answers = iter([False, False, True])
    with pytest.raises(CancelledError):
        stretch("cotton", "rib", "course", 0.2, 5, cancelled=answers.__next__)
    assert not list(answers)  # it is called before each point
