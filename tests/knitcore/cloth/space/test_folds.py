"""Stitches that fold against each other: which, how far, and how large they are."""

import numpy as np
import pytest

from knitcore import Fabric, StitchChart, material
from knitcore.chart.phases import continued
from knitcore.cloth.space.folds import balances, folds_of, opposed, rest_turns, turning
from knitcore.prediction.neighbourhood import neighbourhood_sizes

ACRYLIC = material("acrylic")
FREE = np.array([1.8, 1.1])


@pytest.mark.parametrize(
    ("row", "runs"),
    [
        ("KKKPPPKKK", [3, 3, 3, 3, 3, 3, 3, 3, 3]),
        ("KKKKPPKK", [0, 0, 0, 0, 2, 2, 2, 2]),  # the wider edge is free
        ("KKKKK", [0, 0, 0, 0, 0]),
        ("PPKKKPKKKPP", [2, 2, 3, 3, 3, 0, 3, 3, 3, 2, 2]),  # a single purl opposes, but is plain
        ("PKPKKKKPKP", [0, 0, 0, 0, 0, 0, 0, 0, 0, 0]),  # a border of 1x1 rib does not
    ],
)
def test_runs_between_others_are_opposed(row: str, runs: list[int]) -> None:
    assert opposed(turning(StitchChart.parse(row).tile(3, 1)))[1].tolist() == runs


@pytest.mark.parametrize("fabric", list(Fabric))
def test_pure_fabrics_keep_their_size_and_their_turn(fabric: Fabric) -> None:
    folds = folds_of(StitchChart.of_fabric(fabric, rows=8, columns=8), ACRYLIC, FREE)
    record = ACRYLIC.record(fabric)
    size = (record.stitch_course_mm, record.stitch_wale_mm)
    assert np.allclose(folds.sizes_mm, size, rtol=1e-3)
    assert np.all(folds.share == 1.0)


def test_a_wide_rib_turns_over_to_the_width_of_its_surroundings() -> None:
    """The polygon of its panels spans what the resolver says."""
    chart = StitchChart.parse("KKKKPPPP").tile(16, 4)
    folds = folds_of(chart, ACRYLIC, FREE)
    turn = folds.share[8, 13, 0] * FREE[0]
    at = turn * (np.arange(4) - 1.5)
    span = folds.sizes_mm[8, 13, 0] * np.cos(at).mean()
    assert span == pytest.approx(neighbourhood_sizes(chart, ACRYLIC)[8, 13, 0], rel=1e-9)
    assert turn < np.pi / 4


@pytest.mark.parametrize("row", ["KKKKPP", "KKKKKP", "KKPP", "KKKPP"])
def test_ribs_turn_back_between_their_panels_as_far_as_within(row: str) -> None:
    side = turning(StitchChart.parse(row).tile(3, 4))
    inside = np.where(side[:, 1:] == side[:, :-1], side[:, 1:], 0.0)
    turns = rest_turns(side, 0.3 * inside, 0.0 * inside, np.ones_like(inside))
    inner = slice(len(row), 2 * len(row))
    assert turns[1, inner].sum() == pytest.approx(0.0, abs=1e-12)
    assert np.all(turns[1, inner][inside[1, inner] > 0] == 0.3)


def test_what_does_not_balance_rolls_up_evenly() -> None:
    side = turning(StitchChart.parse("KKKKKP").tile(3, 4))
    inside = np.where(side[:, 1:] == side[:, :-1], side[:, 1:], 0.0)
    turns = rest_turns(side, 0.0 * inside, inside, np.ones_like(inside))
    assert np.allclose(turns[1, 6:12], 4 / 6)


@pytest.mark.parametrize(
    ("row", "balanced"), [("KKPP", True), ("KKKKPP", False), ("KKKKKP", False), ("K", True)]
)
def test_ribs_of_as_many_knits_as_purls_balance(row: str, balanced: bool) -> None:
    chart = StitchChart.parse(row).tile(6, 4)
    assert balances(chart) is balanced


def test_runs_end_at_a_hole() -> None:
    """Two panels of a rib beside a hole are at an edge, and no longer between others."""
    chart = StitchChart.parse("KKKPPPKKKPPPKKK").tile(6, 1)
    stitches = np.ones(chart.purl.shape, dtype=bool)
    stitches[2:4, 6:9] = False
    side = turning(continued(chart, stitches), stitches)
    assert opposed(side)[0].tolist() == [3] * 15
    assert opposed(side)[2, [1, 4, 10, 13]].tolist() == [3, 3, 3, 3]
    lone = np.ones(chart.purl.shape, dtype=bool)
    lone[:, [2, 6]] = False  # the purls have nothing beside them
    assert opposed(turning(continued(chart, lone), lone))[2, 4] == 0
