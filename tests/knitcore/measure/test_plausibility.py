"""Stretch tests that cannot be: corrected where certain, told where rare, else refused."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore import Fabric, InputError
from knitcore.measure.plausibility import check_units, order_doubt, plausible, slack
from knitcore.measure.stretch_test import StretchRun, StretchTest
from knitcore.measure.table_reading import Doubt, DoubtError, TableReading


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
    doubts: list[Doubt] = []
    run = pull(stiffness, noise=noise)
    corrected = plausible(slackened(run, by), TableReading(), notes, doubts)
    assert any("slack" in note for note in notes)
    assert len(doubts) == 1
    late = slackened(run, by)
    assert plausible(late, TableReading(keeps_slack=True), notes, doubts) is late
    at = np.array([0.1, 0.3, 0.5])
    expected = np.interp(at, run.strain_along, run.stress)
    measured = np.interp(at, corrected.strain_along, corrected.stress)
    assert measured == pytest.approx(expected, rel=0.1)


@pytest.mark.parametrize("power", [1.0, 1.5, 2.0, 3.0])
@pytest.mark.parametrize("noise", [0.0, 0.002, 0.005])
def test_cloth_that_unfolds_slowly_is_not_slack(power: float, noise: float) -> None:
    assert slack(pull(power=power, noise=noise)) == 0.0


def test_a_strain_that_does_not_begin_at_zero_is_shifted_and_one_under_load_told() -> None:
    run, own = pull(), TableReading()
    notes: list[str] = []
    shifted = replace(run, strain_along=0.05 + 1.05 * run.strain_along)
    assert plausible(shifted, own, notes, []).strain_along == pytest.approx(run.strain_along)
    assert any("first reading, 0.050, as if the strip was 5.0% longer" in note for note in notes)
    loaded = run.only(run.strain_along > 0.1)
    assert plausible(loaded, own, notes, []) is loaded
    assert "under load" in notes[-1]
    preloaded = replace(run, stress=run.stress + 0.1 * run.stress.max())
    assert plausible(preloaded, own, notes, []) is preloaded
    assert "preload" in notes[-1]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda e, t: (1 + e, 1 + t), "strain_along: begins at 1, .* stretch ratio"),
        (lambda e, t: (1 + e, t), "strain_along: begins at 1, .* stretch ratio"),
        (lambda e, t: (e, 1 + t), "strain_across: begins at 1, .* stretch ratio"),
        (lambda e, t: (e, -t), "strain_across.*wider"),
    ],
)
def test_ratios_and_exchanged_signs_are_refused(change: object, says: str) -> None:
    run = pull()
    along, across = change(run.strain_along, run.strain_across)  # type: ignore[operator]
    with pytest.raises(InputError, match=says):
        plausible(replace(run, strain_along=along, strain_across=across), TableReading(), [], [])


def strip_of(stiffness: float, width_mm: float = 70.0) -> StretchTest:
    return StretchTest("test", "", (pull(stiffness),), (width_mm,))


def test_units_that_knitted_fabric_rules_out_are_refused_and_rare_ones_told() -> None:
    usual = strip_of(0.2)
    assert check_units(usual, strip_of(0.05)) == []
    for stiffness in (0.2 * 100, 0.2 * 9806, 0.2 / 1000):
        with pytest.raises(InputError, match=r"force over width.*newton"):
            check_units(strip_of(stiffness), usual)
    (note,) = check_units(usual, strip_of(2.5))
    assert "rare for knitted fabric" in note
    assert check_units(usual, replace(strip_of(2.5), sure=frozenset({"force_n"}))) == []


def test_doubtful_units_have_the_readings_that_would_fit() -> None:
    usual, tens = strip_of(0.2), strip_of(2.0, width_mm=7.0)
    with pytest.raises(DoubtError, match="7 beside 70 looks like cm") as error:
        check_units(usual, tens)
    cm, mm = error.value.doubt.readings
    assert (cm.words, dict(cm.changes)) == ("cm: 70 mm", {"width_mm": 70.0})
    assert check_units(usual, strip_of(2.0, width_mm=7.0).with_width(mm.changes["width_mm"]))
    with pytest.raises(DoubtError) as error:
        check_units(usual, strip_of(20.0))
    words = [reading.words for reading in error.value.doubt.readings]
    assert words[0] == "cN"
    assert words[-1] == "N, as it stands"
    assert pickle.loads(pickle.dumps(error.value)).doubt == error.value.doubt  # noqa: S301


def test_tests_of_a_rib_that_is_stiffer_along_its_rows_may_be_exchanged() -> None:
    stiff, soft = strip_of(0.4), strip_of(0.05)
    assert order_doubt(soft, stiff, Fabric.RIB) is None
    assert order_doubt(stiff, soft, Fabric.SEED) is None
    doubt = order_doubt(stiff, soft, Fabric.RIB)
    assert doubt
    assert "8 times stiffer along its rows" in doubt.problem
    assert [reading.exchanges for reading in doubt.readings] == [True, False]


def test_a_strain_beyond_any_knit_is_doubted() -> None:
    usual, run = strip_of(0.2), pull()
    stretched = replace(run, strain_along=run.strain_along * 8)
    far = replace(usual, runs=(stretched,))
    with pytest.raises(DoubtError, match=r"reaches 4\.8; .* force and strain exchanged") as error:
        check_units(far, usual)
    words = [reading.words for reading in error.value.doubt.readings]
    assert words == ["per cent: 0.048", "4.8, as it stands"]
    assert check_units(replace(far, sure=frozenset({"strain_along"})), usual) == []


def test_a_strip_that_is_shorter_than_wide_is_told() -> None:
    usual = strip_of(0.2)
    assert check_units(replace(usual, length_mm=100.0), usual) == []
    (note,) = check_units(replace(usual, length_mm=20.0), usual)
    assert "shorter (20 mm) than wide (70 mm)" in note
