"""Textures side by side in a strip: it stretches like its curve, and a row more changes little."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from knitcore import StitchChart, material, predict
from knitcore.chart.fabric import Direction
from knitcore.cloth.flat import strip_test

ACRYLIC = material("acrylic")


def cloth(text: str, rows: int, columns: int) -> NDArray[np.bool_]:
    return StitchChart.parse(text).resized(rows, columns).purl


def bands(lower: str, upper: str, rows: int, of_lower: int = 10) -> StitchChart:
    """Two textures one above the other, 16 stitches wide."""
    both = np.vstack([cloth(lower, of_lower, 16), cloth(upper, 80, 16)])
    return StitchChart(both[:rows])


HEMS = {
    "rib": ("KKPP", "K"),
    "welt": ("K/K/P/P", "K"),
    "garter": ("K/P", "K"),
    "seed": ("KKPP", "KP/PK"),
}


@pytest.mark.parametrize("rows", [6, 17, 24, pytest.param(40, marks=pytest.mark.slow)])
@pytest.mark.parametrize("hem", HEMS)
@pytest.mark.parametrize("direction", Direction)
def test_a_long_free_strip_with_a_hem_stretches_like_its_curve(
    direction: Direction, hem: str, rows: int
) -> None:
    """Ends that slide; within 17 % of the strain at each stress, and of one area at rest."""
    chart = bands(*HEMS[hem], rows)
    answer = predict(chart, ACRYLIC)
    along = answer.along(direction)
    strains = along.strain([0.05, 0.1, 0.2])
    test = strip_test(chart, ACRYLIC, direction, strains.tolist(), clamps="sliding")
    np.testing.assert_allclose(along.strain(test.stress_n_per_mm), strains, rtol=0.17)
    area = 16 * rows * answer.relaxed_course_mm * answer.relaxed_wale_mm
    assert test.length_mm * test.width_mm == pytest.approx(area, rel=0.01)


def stress(chart: StitchChart) -> NDArray[np.float64]:
    """Logarithms of the stresses of a strip with sliding ends at strains of .1 to .3."""
    return np.concatenate(
        [
            np.log(
                strip_test(
                    chart, ACRYLIC, direction, [0.1, 0.2, 0.3], clamps="sliding"
                ).stress_n_per_mm
            )
            for direction in Direction
        ]
    )


@pytest.mark.parametrize("hem", HEMS)
def test_a_strip_that_outgrows_one_patch_is_as_stiff_as_before(hem: str) -> None:
    """16 and 17 rows."""
    lower, upper = HEMS[hem]
    small, large = (stress(bands(lower, upper, rows)) for rows in (16, 17))
    assert np.abs(large - small).max() < 0.1


@pytest.mark.slow
@pytest.mark.parametrize("hem", HEMS)
def test_a_row_more_changes_the_force_little(hem: str) -> None:
    """From 16 rows, one patch, to 63, four: 22 % at most, as in the curve."""
    lower, upper = HEMS[hem]
    forces = [stress(bands(lower, upper, rows)) for rows in range(16, 64)]
    most = max(float(np.abs(b - a).max()) for a, b in pairwise(forces))
    assert most < np.log(1.22)
