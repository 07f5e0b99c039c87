"""Yarn in a stitch: own loop lengths first, then the rule; a measurement comes before both."""

from dataclasses import replace

import numpy as np
import pytest

from knitcore import Fabric, StitchChart, material
from knitcore.materials import Material
from knitcore.materials.yarn_per_stitch import (
    MeasuredYarn,
    change_rule,
    loop_length,
    yarn_per_stitch,
)
from tests.knitcore.refusals import refuses

WOOL = material("glove-wool:glove")
RULE = change_rule()
MIXED = StitchChart.parse("KPKK/KKKK")


def knows(*fabrics: Fabric, laws: tuple[Fabric, ...] = tuple(Fabric)) -> Material:
    """The wool with the laws of some fabrics, and the loop lengths of some of these."""
    records = {
        fabric: record if fabric in fabrics else replace(record, loop_length_mm=None)
        for fabric, record in WOOL.fabrics.items()
        if fabric in laws
    }
    return replace(WOOL, fabrics=records)


def length(fabric: Fabric) -> float:
    """The wool's own loop length."""
    return WOOL.record(fabric).loop_length_mm or np.nan


@pytest.mark.parametrize("fabric", list(Fabric))
def test_a_fabric_has_its_own_loop_length_before_that_of_the_rule(fabric: Fabric) -> None:
    assert loop_length(WOOL, fabric).mm == length(fabric)
    assert loop_length(WOOL, fabric).like == ()


@pytest.mark.parametrize("laws", [tuple(Fabric), (Fabric.STOCKINETTE,)])
def test_what_a_material_lacks_follows_from_its_changes_along_the_row(
    laws: tuple[Fabric, ...],
) -> None:
    plain = knows(Fabric.STOCKINETTE, laws=laws)
    row = length(Fabric.STOCKINETTE)
    assert loop_length(plain, Fabric.GARTER).mm == pytest.approx(row)
    for fabric in (Fabric.RIB, Fabric.SEED):
        assert loop_length(plain, fabric).mm == pytest.approx(row * (1 + RULE.per_change))
    used = yarn_per_stitch(MIXED, plain, periodic=True)
    assert used.rows_mm == pytest.approx([row, row * (1 + 2 / 4 * RULE.per_change)])


def test_a_fabric_with_as_many_changes_says_more_than_others() -> None:
    ribbed = knows(Fabric.RIB, Fabric.STOCKINETTE)
    seed, garter = (loop_length(ribbed, fabric) for fabric in (Fabric.SEED, Fabric.GARTER))
    assert seed.mm == pytest.approx(length(Fabric.RIB))
    assert garter.like == (Fabric.STOCKINETTE,)
    assert seed.log_sd == RULE.alike_log_sd < loop_length(knows(Fabric.GARTER), Fabric.SEED).log_sd


def test_the_interval_grows_with_what_the_rule_must_say() -> None:
    def interval(chart: str, of: Material) -> float:
        used = yarn_per_stitch(StitchChart.parse(chart), of, periodic=True)
        low, high = used.mean_interval_mm
        assert low < used.mean_mm < high
        return high / low

    plain = knows(Fabric.STOCKINETTE)
    assert interval("K", plain) == interval("K", WOOL) == interval("KP", WOOL)
    assert interval("K", plain) < interval("KKKKP", plain) < interval("KP", plain)
    assert "rib from stockinette" in yarn_per_stitch(StitchChart.parse("KP"), plain).source
    assert "from" not in yarn_per_stitch(StitchChart.parse("KK"), plain).source


def test_a_measured_mean_is_kept_and_shared_out() -> None:
    used = yarn_per_stitch(MIXED, WOOL, periodic=True)
    known = yarn_per_stitch(MIXED, WOOL, measured=MeasuredYarn(9.0), periodic=True)
    assert known.mean_mm == pytest.approx(9.0)
    assert known.stitch_mm == pytest.approx(used.stitch_mm * 9.0 / used.mean_mm)
    assert known.log_sd < used.log_sd
    assert "measured in this cloth" in known.source


def test_a_swatch_says_most_of_its_own_fabric() -> None:
    swatch = MeasuredYarn(10.0, Fabric.GARTER)
    own = yarn_per_stitch(StitchChart.parse("K/P"), WOOL, measured=swatch, periodic=True)
    assert own.mean_mm == pytest.approx(10.0)
    other = yarn_per_stitch(StitchChart.parse("KP"), WOOL, measured=swatch, periodic=True)
    assert other.mean_mm == pytest.approx(10.0 * length(Fabric.RIB) / length(Fabric.GARTER))
    assert own.log_sd < other.log_sd


def test_a_measurement_serves_without_any_loop_length() -> None:
    swatch = MeasuredYarn(10.0, Fabric.STOCKINETTE)
    used = yarn_per_stitch(StitchChart.parse("KP"), knows(), measured=swatch, periodic=True)
    assert used.mean_mm == pytest.approx(10.0 * (1 + RULE.per_change))
    with refuses("material", "Unravel ten stitches"):
        yarn_per_stitch(MIXED, knows())


def test_cells_have_the_mean_of_their_own() -> None:
    cells = np.array([[False] * 4, [False, True, False, False]])
    used = yarn_per_stitch(MIXED, WOOL, periodic=True, cells=cells)
    assert used.mean_mm == pytest.approx(used.stitch_mm[1, 1])


def test_a_swatch_may_be_weighed() -> None:
    assert MeasuredYarn.weighed(12.0, 2000, 500).mm == pytest.approx(12.0)
    with refuses("yarn_per_stitch_mm", "mm"):
        MeasuredYarn(-1.0)
