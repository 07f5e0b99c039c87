"""Which stitches fold against each other, how far, and how large they are."""

from __future__ import annotations

import numpy as np
import pytest

from knitcore.answer.neighbourhood import neighbourhood_sizes
from knitcore.chart import StitchChart
from knitcore.fabric import Fabric
from knitcore.materials import material
from knitcore.shell.folds import folds_of, opposed, turning

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
    found = folds_of(StitchChart.of_fabric(fabric, rows=8, columns=8), ACRYLIC, FREE)
    record = ACRYLIC.record(fabric)
    size = (record.stitch_course_mm, record.stitch_wale_mm)
    assert np.allclose(found.sizes_mm, size, rtol=1e-3)
    assert np.all(found.share == 1.0)


def test_a_wide_rib_turns_over_to_the_width_of_its_surroundings() -> None:
    """The polygon of its panels spans what the resolver says."""
    chart = StitchChart.parse("KKKKPPPP").tile(16, 4)
    found = folds_of(chart, ACRYLIC, FREE)
    turn = found.share[8, 13] * FREE[0]
    at = turn * (np.arange(4) - 1.5)
    span = found.sizes_mm[8, 13, 0] * np.cos(at).mean()
    assert span == pytest.approx(neighbourhood_sizes(chart, ACRYLIC)[8, 13, 0], rel=1e-9)
    assert turn < np.pi / 4
