"""The packaged relaxed repeats."""

import numpy as np
import pytest

from knitcore.chart import StitchChart
from knitcore.yarnlevel.catalogue import COMMON
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.relax import relax
from knitcore.yarnlevel.store import stored_charts, stored_stitch


@pytest.mark.parametrize("material", ["acrylic", "cotton"])
@pytest.mark.parametrize("name", COMMON)
def test_common_repeats_are_packaged(material, name):
    stored = stored_stitch(StitchChart.parse(COMMON[name]), material)
    assert stored is not None
    assert stored.free is not None
    lines = stored.centre_lines()
    assert lines.shape[0] == stored.chart.rows
    step = np.linalg.norm(np.diff(lines, axis=1), axis=2).sum(axis=1)
    stitches = stored.chart.columns
    assert step.mean() / stitches == pytest.approx(stored.loop_length_mm, rel=0.04)


@pytest.mark.parametrize("text", ["KKP", "PPK", "PKK", "KPP"])
def test_turned_and_moved_charts_are_found_with_their_own_shape(text):
    """The stored curve, carried over by symmetry, has the crossings of a fresh relaxation."""
    chart = StitchChart.parse(text)
    stored = stored_stitch(chart, "cotton")
    assert stored is not None
    fresh = relax(chart, stored.yarn, stored.loop_length_mm)
    assert fresh.convention is Convention.PUBLISHED
    assert stored.cell_course_mm == pytest.approx(fresh.cell_course_mm, rel=0.01)
    a, b = stored.centre_lines(3)[0], fresh.centre_lines[0]
    b = b[np.linspace(0, len(b) - 1, len(a)).round().astype(int)]
    a, b = a - a.mean(axis=0), b - b.mean(axis=0)
    assert np.sqrt(((a - b) ** 2).sum(axis=1).mean()) < 0.35


def test_two_by_two_rib_is_narrower_than_one_by_one():
    one, two = (stored_stitch(StitchChart.parse(t), "cotton") for t in ("KP", "KKPP"))
    assert one is not None
    assert two is not None
    assert two.cell_course_mm < one.cell_course_mm
    assert two.free.cell_course_mm < one.free.cell_course_mm


def test_unknown_repeats_and_yarns_are_not_in_the_store():
    large = StitchChart.from_rows(np.random.default_rng(0).random((5, 5)) < 0.5)
    assert stored_stitch(large, "acrylic") is None
    assert stored_stitch(StitchChart.parse("K"), "lace-bamboo") is None


def test_all_small_repeats_are_packaged_for_both_yarns():
    assert len(stored_charts("acrylic")) >= 53
    assert len(stored_charts("acrylic")) == len(stored_charts("cotton"))
