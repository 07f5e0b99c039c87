from typing import Any

import numpy as np
import pytest

from knitcore import (
    CancelledError,
    Direction,
    Fabric,
    InputError,
    StitchChart,
    material,
    strip_test,
)
from knitcore.design.shape import ShapedSwatch, fill_shape
from tests.knitcore.design.atlases import acrylic_atlas

ACRYLIC = material("acrylic")


def outline(chart: StitchChart, strain: float) -> np.ndarray:
    """Widths of a swatch under a wale-wise pull, row by row, over those at rest."""
    test = strip_test(chart, ACRYLIC, Direction.WALE, strain, steps=4)
    moved = test.x_mm + test.ux_mm[-1]
    rest = test.x_mm[1::2, -1] - test.x_mm[1::2, 0]
    return np.array((moved[1::2, -1] - moved[1::2, 0]) / rest)


def banded(*fabrics: str) -> StitchChart:
    parts = [StitchChart.of_fabric(Fabric(name), rows=8, columns=16).purl for name in fabrics]
    return StitchChart(np.concatenate(parts))


def fill(width: np.ndarray, strain: float = 0.3, **options: Any) -> ShapedSwatch:
    return fill_shape(width, 16, Direction.WALE, strain, ACRYLIC, acrylic_atlas(), **options)


@pytest.mark.slow
def test_the_outline_of_a_hidden_chart_is_found_again() -> None:
    wanted = outline(banded("seed", "rib", "garter"), 0.3)
    assert np.ptp(wanted) > 0.03
    found = fill(wanted)
    assert found.rms <= 0.01
    assert found.width == pytest.approx(outline(found.chart, 0.3), abs=1e-6)
    assert sum(band.lines for band in found.bands) == len(wanted)
    assert found.force_n > 0


@pytest.mark.slow
def test_the_same_seed_gives_the_same_chart() -> None:
    wanted = 1 - 0.08 * np.sin(np.linspace(0, np.pi, 16))
    assert fill(wanted, seed=4).chart == fill(wanted, seed=4).chart


def test_a_column_profile_under_a_course_wise_pull() -> None:
    wanted = np.full(20, np.nan)
    wanted[10] = 0.9
    found = fill_shape(wanted, 10, Direction.COURSE, 0.3, ACRYLIC, acrylic_atlas())
    assert (found.chart.rows, found.chart.columns) == (10, 20)
    assert found.width[10] == pytest.approx(0.9, abs=0.02)


def test_unreachable_outlines_are_reported_with_reachable_ones() -> None:
    found = fill(np.full(16, 0.3))
    assert "Row" in found.messages[0]
    assert "of its width at a strain of 0.3" in found.messages[0]


def test_it_reports_progress_and_can_be_cancelled() -> None:
    told: list[float] = []
    fill(np.full(12, 0.95), progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1
    with pytest.raises(CancelledError):
        fill(np.full(12, 0.95), cancelled=lambda: True)


@pytest.mark.parametrize(
    ("width", "strain", "field"),
    [
        (np.ones((2, 2)), 0.3, "width"),
        (np.full(8, np.nan), 0.3, "width"),
        (np.full(8, 9.0), 0.3, "width"),
        (np.ones(8), -0.3, "strain"),
        (np.full(8, 0.9), 4.9, "strain"),
    ],
)
def test_profiles_that_cannot_be_used(width: np.ndarray, strain: float, field: str) -> None:
    with pytest.raises(InputError) as told:
        fill(width, strain)
    assert told.value.field == field


def test_other_sizes_that_cannot_be_used() -> None:
    for across, band in ((2, 4), (16, 0), (10_000, 4)):
        with pytest.raises(InputError):
            fill_shape(
                np.ones(8),
                across,
                Direction.WALE,
                0.3,
                ACRYLIC,
                acrylic_atlas(),
                smallest_band=band,
            )
