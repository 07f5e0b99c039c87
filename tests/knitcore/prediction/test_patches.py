"""Large charts in patches: two halves of pure fabrics, whose answers are known."""

import numpy as np
import pytest

from knitcore import Direction, Fabric, RelaxedSize, StitchChart, material, predict
from knitcore.prediction.prediction import Prediction

YARN = material("acrylic")
SEED, KNIT = (StitchChart.of_fabric(f, 32, 256) for f in (Fabric.SEED, Fabric.STOCKINETTE))
BOTH = StitchChart(np.hstack([SEED.purl, KNIT.purl]))
"""Seed stitch at the left of stockinette, wide enough that the seams between them hardly count."""
FORCES_N = np.array([1e-3, 0.05, 0.2]) * 80


def answers() -> list[Prediction]:
    """Predictions of the whole, of the left half, and of the right one."""
    return [predict(chart, YARN) for chart in (BOTH, SEED, KNIT)]


def test_what_is_a_mean_is_the_mean_of_both_halves() -> None:
    predictions = answers()
    for direction in Direction:
        whole, *halves = (answer.along(direction) for answer in predictions)
        for name in ("poisson", "poisson_sd", "relaxed_mm", "relaxed_log_sd"):
            mean = np.mean([getattr(half, name) for half in halves])
            assert getattr(whole, name) == pytest.approx(mean, rel=0.05), name
        bounds = whole.bounds_n_per_mm
        assert bounds.low <= min(half.bounds_n_per_mm.low for half in halves)
        assert bounds.high >= max(half.bounds_n_per_mm.high for half in halves)
        assert bounds.low <= whole.modulus_n_per_mm <= bounds.high


def test_along_the_rows_they_are_in_series() -> None:
    """The same force goes through both; each stretches by its length."""
    whole, *halves = answers()
    height = whole.relaxed_wale_mm * 32
    lengths = [half.relaxed_course_mm for half in halves]
    strains = [half.course.strain(FORCES_N / (32 * half.relaxed_wale_mm)) for half in halves]
    expected = np.average(strains, axis=0, weights=lengths)
    assert whole.course.strain(FORCES_N / height) == pytest.approx(expected, rel=0.03)


def test_along_the_columns_they_are_side_by_side() -> None:
    """Both stretch alike; their forces add up."""
    whole, *halves = answers()
    strain = np.array([0.02, 0.1, 0.25])
    widths = [half.relaxed_course_mm for half in halves]
    expected = np.average([half.wale.stress(strain) for half in halves], axis=0, weights=widths)
    assert whole.wale.stress(strain) == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("chart", [BOTH, KNIT], ids=["patches", "pure"])
def test_ones_own_gauge_is_the_size_of_the_whole(chart: StitchChart) -> None:
    sized = predict(chart, YARN, size=RelaxedSize(3.0, 2.0, 0.01))
    assert sized.relaxed_course_mm == pytest.approx(3.0)
    assert sized.relaxed_wale_mm == pytest.approx(2.0)
    assert sized.course.relaxed_log_sd == pytest.approx(0.01)
