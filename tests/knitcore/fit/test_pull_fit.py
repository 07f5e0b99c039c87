"""A law comes back from tests made of it."""

from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import Direction, InputError
from knitcore.fit.pull_fit import Reduction, median_curve
from knitcore.fit.strip_fit import fit_tests
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.least_squares import fit_direction
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials import MeasuredCurve
from knitcore.materials.measured_curves import MAX_POINTS
from knitcore.measure.stretch_test import StretchRun, StretchTest
from tests.knitcore.measure.synthetic import (
    LAW,
    csv_pair,
    h5_pair,
    save_as_xlsx,
    write_csv,
    write_h5,
)
from tests.knitcore.refusals import refuses

X, Y = Direction.COURSE, Direction.WALE
fit_files = partial(fit_tests, reduction=Reduction.UNIFORM)
CONSTANTS = [name for name in asdict(LAW) if name.startswith(("stiffness_", "alpha", "beta"))]


def close_to(law: ConstitutiveLaw, expected: ConstitutiveLaw, rel: float) -> None:
    for name in CONSTANTS:
        assert getattr(law, name) == pytest.approx(getattr(expected, name), rel=rel), name


@pytest.mark.parametrize("reduction", [Reduction.PUBLISHED, Reduction.UNIFORM])
@pytest.mark.parametrize("pair", [csv_pair, h5_pair])
def test_a_law_is_recovered(
    tmp_path: Path, pair: Callable[[Path], list[Path]], reduction: Reduction
) -> None:
    fit = fit_files(*pair(tmp_path), reduction=reduction)
    # The uniform reduction averages in 40 strain intervals: the curve bends within them.
    close_to(fit.law, LAW, 1e-3 if reduction is Reduction.PUBLISHED else 0.02)
    assert fit.runs == {X: 4, Y: 4}
    assert fit.rms_n_per_mm < 1e-3
    assert any("video1" in note for note in fit.notes) == (pair is h5_pair)


def test_a_workbook_gives_what_its_table_gives_as_csv(tmp_path: Path) -> None:
    files = csv_pair(tmp_path, runs=2)
    from_csv, from_books = (
        fit_files(*pair, reduction=Reduction.PUBLISHED)
        for pair in (files, map(save_as_xlsx, files))
    )
    assert from_books.law == from_csv.law
    assert from_books.runs == {X: 2, Y: 2}


def test_standard_errors_reflect_the_scatter_of_pulls(tmp_path: Path) -> None:
    """Pulls whose force differs by 5 % each: C is known to 5 % / sqrt(4)."""
    fit = fit_files(*csv_pair(tmp_path, noise=0.05, seed=4))
    for name in CONSTANTS:
        miss = abs(getattr(fit.law, name) - getattr(LAW, name))
        assert miss < 5 * fit.standard_errors[name], name
    relative = fit.standard_errors["modulus_course"] / fit.law.modulus_course
    assert 0.005 < relative < 0.1


def test_one_pull_has_errors_with_a_note_on_what_they_lack(tmp_path: Path) -> None:
    fit = fit_files(*csv_pair(tmp_path, runs=1, noise=0.01))
    assert "scatter of pulls unknown" in fit.error_method
    assert all(fit.standard_errors[name] > 0 for name in CONSTANTS)


@settings(max_examples=25)
@given(
    stiffness=st.floats(0.01, 2.0),
    share=st.floats(0.4, 0.9),
    beta=st.floats(0.005, 0.1),
    coupling=st.floats(0.05, 0.8),
)
def test_a_direction_is_recovered_whatever_its_constants(
    stiffness: float, share: float, beta: float, coupling: float
) -> None:
    along = np.linspace(0, 0.8, 300)
    across = -0.3 * along
    alpha = share / 0.8
    stress = stiffness * (along + coupling * across) + beta * (
        1 / (1 - alpha * along) ** 2 - 1 - 2 * alpha * along
    )
    fit = fit_direction(along, across, stress, np.ones(300), coupling)
    assert fit.stiffness == pytest.approx(stiffness, rel=1e-3)
    assert fit.alpha == pytest.approx(alpha, rel=1e-3)
    assert fit.beta == pytest.approx(beta, rel=0.01)


def test_residuals_add_up_to_the_rms(tmp_path: Path) -> None:
    fit = fit_files(*csv_pair(tmp_path, noise=0.02), reduction=Reduction.PUBLISHED)
    r = fit.residuals[X]
    assert np.sqrt(np.mean((r.stress - r.fitted) ** 2)) == pytest.approx(fit.rms_course_n_per_mm)


def test_exchanged_and_equal_tests_are_refused(tmp_path: Path) -> None:
    course, wale = h5_pair(tmp_path)
    with pytest.raises(InputError, match="pulled wale-wise"):
        fit_files(wale, course)
    misnamed = write_h5(tmp_path / "sample Y.h5", X)  # description and name contradict each other
    assert fit_files(misnamed, wale).law.alpha_xx == pytest.approx(LAW.alpha_xx, rel=0.02)
    csv = write_csv(tmp_path / "same.csv", X)
    with pytest.raises(InputError, match="same points"):
        fit_files(csv, csv)


@pytest.mark.parametrize(
    ("course_name", "wale_name"),
    [
        ("course.csv", "wale.csv"),
        ("rib_COURSE-wise 2.csv", "wale2.csv"),
        ("course.csv", "b.csv"),
        ("course and wale.csv", "concourse.csv"),  # which state no direction
    ],
)
def test_files_named_after_the_other_direction_are_refused(
    tmp_path: Path, course_name: str, wale_name: str
) -> None:
    course, wale = write_csv(tmp_path / course_name, X), write_csv(tmp_path / wale_name, Y)
    assert fit_files(course, wale).law.alpha_xx == pytest.approx(LAW.alpha_xx, rel=0.02)
    if wale_name != "concourse.csv":
        with pytest.raises(InputError, match=r"pulled (course|wale)-wise"):
            fit_files(wale, course)


def pulls(*factors: float, ends: tuple[float, ...] = (), points: int = 400) -> StretchTest:
    """Pulls of a straight law, each with its own stiffness and end."""
    runs = []
    for number, factor in enumerate(factors):
        strain = np.linspace(0, ends[number] if ends else 0.5, points)
        runs.append(StretchRun(f"{number}", strain, -0.3 * strain, factor * strain))
    return StretchTest("made", "", tuple(runs), (70.0,) * len(runs))


def test_a_fit_keeps_curves_that_are_those_of_its_law(tmp_path: Path) -> None:
    fit = fit_files(*csv_pair(tmp_path))
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
def test_a_median_curve_is_among_the_pulls(factors: list[float], points: int, seed: int) -> None:
    """Between the softest and the stiffest, whatever the number of pulls and of points."""
    ends = tuple(np.random.default_rng(seed).uniform(0.3, 0.6, len(factors)))
    curve = median_curve(pulls(*factors, ends=ends, points=points))
    strain, stress = np.array(curve.strain), np.array(curve.stress_n_per_mm)
    width = np.diff(strain).max(initial=0.6 / 20)
    assert np.all(stress >= min(factors) * (strain - width) - 1e-6)
    assert np.all(stress <= max(factors) * (strain + width) + 1e-6)
    assert strain[-1] <= max(ends)


def test_a_pull_that_went_wrong_does_not_move_the_median() -> None:
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
    with refuses("measured"):
        MeasuredCurve(strain, stress)
