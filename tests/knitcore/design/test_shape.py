from typing import Any

import numpy as np
import pytest

from knitcore import CancelledError, Direction, Fabric, StitchChart, material, strip_test
from knitcore.design.shape import ShapedSwatch, fill_shape
from tests.knitcore.design.atlases import acrylic_atlas
from tests.knitcore.refusals import refuses

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


def fill(
    width: np.ndarray, strain: float = 0.3, *, across: int = 16, **options: Any
) -> ShapedSwatch:
    return fill_shape(width, across, Direction.WALE, strain, ACRYLIC, acrylic_atlas(), **options)


@pytest.mark.slow
def test_the_outline_of_a_hidden_chart_is_found_again() -> None:
    target = outline(banded("seed", "rib", "garter"), 0.3)
    assert np.ptp(target) > 0.03
    swatch = fill(target)
    assert swatch.rms <= 0.01
    assert swatch.width == pytest.approx(outline(swatch.chart, 0.3), abs=1e-6)
    assert sum(band.lines for band in swatch.bands) == len(target)
    assert swatch.force_n > 0


@pytest.mark.slow
def test_the_same_seed_gives_the_same_chart() -> None:
    target = 1 - 0.08 * np.sin(np.linspace(0, np.pi, 16))
    assert fill(target, seed=4).chart == fill(target, seed=4).chart


@pytest.mark.slow
def test_a_column_profile_under_a_course_wise_pull() -> None:
    target = np.full(20, np.nan)
    target[10] = 0.9
    swatch = fill_shape(target, 10, Direction.COURSE, 0.3, ACRYLIC, acrylic_atlas())
    assert (swatch.chart.rows, swatch.chart.columns) == (10, 20)
    assert swatch.width[10] == pytest.approx(0.9, abs=0.02)


@pytest.mark.slow
def test_unreachable_outlines_are_reported_with_reachable_ones() -> None:
    swatch = fill(np.full(16, 0.3))
    assert "Row" in swatch.messages[0]
    assert "of its width at a strain of 0.3" in swatch.messages[0]


@pytest.mark.slow
def test_it_reports_progress_and_can_be_cancelled() -> None:
    shares: list[float] = []
    fill(np.full(12, 0.95), progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1
    with pytest.raises(CancelledError):
        fill(np.full(12, 0.95), cancelled=lambda: True)


@pytest.mark.parametrize(
    ("width", "options", "field"),
    [
        (np.ones((2, 2)), {}, "width"),
        (np.full(8, np.nan), {}, "width"),
        (np.full(8, 9.0), {}, "width"),
        (np.ones(8), {"strain": -0.3}, "strain"),
        (np.full(8, 0.9), {"strain": 4.9}, "strain"),
        (np.ones(8), {"across": 2}, "across"),
        (np.ones(8), {"across": 10_000}, "chart"),
        (np.ones(8), {"smallest_band": 0}, "smallest_band"),
    ],
)
def test_profiles_that_cannot_be_used(
    width: np.ndarray, options: dict[str, Any], field: str
) -> None:
    with refuses(field):
        fill(width, **options)
