"""Stretch tests that cannot be: corrected where certain, told where rare, else refused."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore import InputError
from knitcore.measure.plausibility import check_units, plausible, slack
from knitcore.measure.stretch_test import StretchRun, StretchTest


def pull(stiffness: float = 0.2, power: float = 1.0, noise: float = 0.0) -> StretchRun:
    """A pull to a strain of 0.6 that stiffens; with a power of 2 it unfolds slowly at first."""
    strain = np.linspace(0.0, 0.6, 150)
    stress = stiffness * (strain**power + strain**4)
    stress += noise * stress.max() * np.random.default_rng(1).normal(size=150)
    return StretchRun("pull", strain, -0.3 * strain, stress)


def slackened(run: StretchRun, by: float) -> StretchRun:
    """The same pull of a strip that hangs free at first: strains count from the shorter length."""
    free = np.linspace(0.0, by, 20, endpoint=False)
    return StretchRun(
        run.name,
        np.concatenate([free, by + (1 + by) * run.strain_along]),
        np.concatenate([0 * free, run.strain_across]),
        np.concatenate([0 * free, run.stress]),
    )


@given(by=st.floats(0.01, 0.1), noise=st.floats(0.0, 0.003), stiffness=st.floats(0.01, 1.0))
def test_slack_is_found_and_taken_away(by: float, noise: float, stiffness: float) -> None:
    notes: list[str] = []
    run = pull(stiffness, noise=noise)
    corrected = plausible(slackened(run, by), notes)
    assert any("slack" in note for note in notes)
    at = np.array([0.1, 0.3, 0.5])
    expected = np.interp(at, run.strain_along, run.stress)
    measured = np.interp(at, corrected.strain_along, corrected.stress)
    assert measured == pytest.approx(expected, rel=0.1)


@pytest.mark.parametrize("power", [1.0, 1.5, 2.0, 3.0])
@pytest.mark.parametrize("noise", [0.0, 0.002, 0.005])
def test_cloth_that_unfolds_slowly_is_not_slack(power: float, noise: float) -> None:
    assert slack(pull(power=power, noise=noise)) == 0.0


def test_a_strain_that_does_not_begin_at_zero_is_shifted_and_one_under_load_told() -> None:
    run, notes = pull(), []
    shifted = replace(run, strain_along=0.05 + 1.05 * run.strain_along)
    assert plausible(shifted, notes).strain_along == pytest.approx(run.strain_along)
    assert any("first reading" in note for note in notes)
    loaded = run.only(run.strain_along > 0.1)
    assert plausible(loaded, notes) is loaded
    assert "under load" in notes[-1]
    preloaded = replace(run, stress=run.stress + 0.1 * run.stress.max())
    assert plausible(preloaded, notes) is preloaded
    assert "preload" in notes[-1]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda e, t: (1 + e, 1 + t), "stretch ratio"),
        (lambda e, t: (e, -t), "strain_across.*wider"),
    ],
)
def test_ratios_and_exchanged_signs_are_refused(change: object, says: str) -> None:
    run = pull()
    along, across = change(run.strain_along, run.strain_across)  # type: ignore[operator]
    with pytest.raises(InputError, match=says):
        plausible(replace(run, strain_along=along, strain_across=across), [])


def strip_of(stiffness: float, width_mm: float = 70.0) -> StretchTest:
    return StretchTest("test", "", (pull(stiffness),), (width_mm,))


def test_units_that_knitted_fabric_rules_out_are_refused_and_rare_ones_told() -> None:
    usual = strip_of(0.2)
    assert check_units(usual, strip_of(0.05)) == []
    for stiffness in (0.2 * 100, 0.2 * 9806, 0.2 / 1000):
        with pytest.raises(InputError, match=r"force over width.*newton"):
            check_units(strip_of(stiffness), usual)
    (note,) = check_units(usual, strip_of(2.5, width_mm=7.0))
    assert "7 beside 70 looks like cm" in note
