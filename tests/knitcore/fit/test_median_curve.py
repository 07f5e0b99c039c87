"""The median curve of repeated pulls: near the law, whatever one of the pulls does."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.fit.median_curve import median_curve
from knitcore.fit.pull_fit import Reduction
from knitcore.fit.strip_fit import fit_tests
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials import MeasuredCurve
from knitcore.materials.measured_curves import MAX_POINTS
from knitcore.measure.stretch_test import StretchRun, StretchTest
from tests.knitcore.measure.synthetic import LAW, write_csv


def pulls(*factors: float, ends: tuple[float, ...] = (), points: int = 400) -> StretchTest:
    """Pulls of a straight law, each with its own stiffness and end."""
    runs = []
    for number, factor in enumerate(factors):
        strain = np.linspace(0, ends[number] if ends else 0.5, points)
        runs.append(StretchRun(f"{number}", strain, -0.3 * strain, factor * strain))
    return StretchTest("made", "", tuple(runs), (70.0,) * len(runs))


def test_a_fit_keeps_curves_that_are_those_of_its_law(tmp_path: Path) -> None:
    files = [write_csv(tmp_path / f"{d}.csv", d) for d in Direction]
    fit = fit_tests(*files, reduction=Reduction.UNIFORM)
    for direction in Direction:
        curve = fit.curves[direction]
        assert curve.pulls == 4
        assert 20 <= len(curve.strain) <= MAX_POINTS
        response = uniaxial_response(LAW, direction, np.array(curve.strain))
        peak = max(curve.stress_n_per_mm)
        assert np.array(curve.stress_n_per_mm) == pytest.approx(response.stress, abs=0.01 * peak)


@given(
    st.lists(st.floats(0.1, 10), min_size=1, max_size=7), st.integers(20, 800), st.integers(0, 99)
)
def test_it_is_a_pull_among_the_pulls(factors: list[float], points: int, seed: int) -> None:
    """Between the softest and the stiffest, whatever the number of pulls and of points."""
    ends = tuple(np.random.default_rng(seed).uniform(0.3, 0.6, len(factors)))
    curve = median_curve(pulls(*factors, ends=ends, points=points))
    strain, stress = np.array(curve.strain), np.array(curve.stress_n_per_mm)
    width = np.diff(strain).max(initial=0.6 / 20)
    assert np.all(stress >= min(factors) * (strain - width) - 1e-6)
    assert np.all(stress <= max(factors) * (strain + width) + 1e-6)
    assert strain[-1] <= max(ends)


def test_a_pull_that_went_wrong_does_not_move_it() -> None:
    assert median_curve(pulls(1.0, 1.02, 0.98, 9.0)).stress_n_per_mm[-1] == pytest.approx(
        median_curve(pulls(1.0, 1.02, 0.98, 1.04)).stress_n_per_mm[-1], rel=0.01
    )


def test_the_curve_ends_where_half_of_the_pulls_end() -> None:
    curve = median_curve(pulls(1.0, 1.0, 1.0, 1.0, ends=(0.2, 0.3, 0.4, 0.5)))
    assert curve.strain[-1] == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize(
    ("strain", "stress"),
    [
        ((0.1,), (0.1,)),
        ((0.1, 0.2), (0.1,)),
        ((0.2, 0.1), (0.1, 0.2)),
        ((0.1, float("nan")), (0.1, 0.2)),
        (tuple(np.arange(101.0)), tuple(np.arange(101.0))),
    ],
)
def test_invalid_curves_are_refused(strain: tuple[float, ...], stress: tuple[float, ...]) -> None:
    with pytest.raises(InputError) as caught:
        MeasuredCurve(strain, stress)
    assert caught.value.field == "measured"
