"""A chart's own sweep at the yarn level, as a simulated and as a measured material have it."""

from __future__ import annotations

import numpy as np
import pytest

from knitcore import Direction, RelaxedSize, StitchChart, predict
from knitcore.answer.choose import choose
from knitcore.answer.densities import densities
from knitcore.answer.learned import packaged_model
from knitcore.answer.mixture import Mixture
from knitcore.answer.swept import STRESS, of_law, swept_chart
from knitcore.materials import Material, material
from knitcore.yarnlibrary.store import StoredStitch, stored_stitch
from scripts.training.learned import simulated_materials


@pytest.fixture(scope="module")
def simulated() -> Material:
    """Acrylic made of the store's own pure fabrics."""
    return simulated_materials()["acrylic"]


def _stored(text: str) -> StoredStitch:
    found = stored_stitch(StitchChart.parse(text), "acrylic")
    assert found is not None
    return found


@pytest.mark.parametrize("text", ["KKPP", "K/K/P", "KP/KK", "KKPP/PPKK"])
def test_a_simulated_material_answers_like_its_sweep(text: str, simulated: Material) -> None:
    """Strains within 5 %: the answer goes through six stresses of the curve."""
    stored = _stored(text)
    assert stored.law is not None
    size = stored.cell_course_mm, stored.cell_wale_mm
    sweep = swept_chart(stored.chart, size, stored.law, simulated.fabrics, simulated)
    found = choose(stored.chart, simulated, swept=sweep)
    assert found.provenance == "swept"
    assert (found.relaxed_course_mm, found.relaxed_wale_mm) == pytest.approx(size)
    strains, _ = of_law(stored.law)
    for direction, strain in zip(Direction, strains, strict=True):
        along = found.along(direction)
        np.testing.assert_allclose(along.strain(STRESS)[4:], strain[4:], rtol=0.05)
        low, high = along.strain_interval(0.05)
        assert low < along.strain(0.05) < high


def test_a_simulated_material_finds_the_packaged_sweep(simulated: Material) -> None:
    """And no other material does; with a gauge its stretch starts at that size."""
    chart = StitchChart.parse("KP/KK")
    stored = _stored("KP/KK")
    found = choose(chart, simulated)
    assert found.provenance == "swept"
    assert found.relaxed_course_mm == pytest.approx(stored.cell_course_mm, rel=0.02)
    assert predict(StitchChart.parse("KP/KK"), material("acrylic")).provenance == "learned"
    assert packaged_model().sweep_of(chart, material("lace-bamboo")) is None
    known = choose(chart, simulated, RelaxedSize(3.0, 2.0))
    assert known.relaxed_course_mm == 3.0
    assert known.course.strain(0.05) != pytest.approx(found.course.strain(0.05), rel=0.01)


@pytest.mark.parametrize("text", ["KKPP", "K/K/P/P", "KKPP/KKPP/PPKK/PPKK"])
def test_knitted_fabric_folds_less_than_its_sweep_as_the_learned_answer_does(text: str) -> None:
    chart, acrylic = StitchChart.parse(text), material("acrylic")
    sweep = packaged_model().sweep_of(chart, acrylic)
    assert sweep is not None
    found, learned = choose(chart, acrylic, swept=sweep), choose(chart, acrylic)
    assert found.provenance == "swept"
    flat = Mixture.of(densities(chart).shares, acrylic).size_mm
    for direction in Direction:
        own, other = found.along(direction), learned.along(direction)
        fold = np.log(own.relaxed_mm / flat[direction.axis])
        assert abs(fold) <= abs(sweep.folding[direction.axis])
        assert own.relaxed_mm == pytest.approx(other.relaxed_mm, rel=0.06)
        assert own.strain(0.1) == pytest.approx(other.strain(0.1), rel=0.35)
