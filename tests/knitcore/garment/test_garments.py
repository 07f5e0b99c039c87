from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from knitcore import Fabric, InputError, StitchChart
from knitcore.fabric import Direction
from knitcore.garment.fit import fit_tube
from knitcore.garment.gauge import Gauge
from knitcore.garment.glove import CROTCH_ROWS, Hand, glove
from knitcore.garment.plan import GarmentPlan
from knitcore.garment.regions import (
    Region,
    fabric_repeat,
    fill_regions,
    misfits,
    region_numbers,
    yarn_use,
)
from knitcore.garment.shaped import ShapedChart
from knitcore.garment.templates import Girth, limb_tube, sock_leg, wrist_brace
from knitcore.materials import material

WOOL = material("glove-wool")
PLANS = (
    glove(Hand(), WOOL),
    wrist_brace(170, 90, WOOL),
    sock_leg(220, 360, 200, WOOL),
    limb_tube("sleeve", [Girth(0, 180), Girth(200, 260)], WOOL),
)


@pytest.mark.parametrize("plan", PLANS, ids=lambda plan: plan.name)
def test_every_stitch_has_one_region_and_its_fabric(plan: GarmentPlan) -> None:
    times = sum(region.cells.astype(int) for region in plan.regions)
    assert (times[plan.shaped.stitch] == 1).all()
    for region in plan.regions:
        cells = region.cells & plan.shaped.stitch
        expected = region.fill.resized(*cells.shape).purl
        assert np.array_equal(plan.shaped.chart.purl[cells], expected[cells])
    assert sum(n.stitches for n in plan.numbers) == plan.shaped.stitches


def test_the_wrist_of_the_glove_is_stiff_around_the_hand() -> None:
    """Wales run around the wrist; stockinette's are its stiffer direction (table 13)."""
    plan = PLANS[0]
    numbers = {n.name: n for n in plan.numbers}
    support = numbers["wrist support"]
    assert plan.around is Direction.WALE
    assert support.modulus_wale_n_per_mm == pytest.approx(0.442, rel=0.02)
    assert support.modulus_wale_n_per_mm > 2 * support.modulus_course_n_per_mm
    assert numbers["fingers"].extensibility_course_mm_per_n > 20
    assert {r.name for r in plan.regions} >= {"thumb", "fingers", "wrist support", "hand", "cuff"}


def test_fingers_are_parted_by_crotches() -> None:
    ends = np.array([stop for _, stop in PLANS[0].shaped.spans])
    crotches = np.flatnonzero(np.diff(ends) < 0)
    assert len(crotches) == 8  # beside both thumb halves, and three between fingers on each side
    palm = ends[crotches[1] + 1]
    assert np.count_nonzero(ends == palm) >= 6 * CROTCH_ROWS
    assert ends[0] == ends[-1] < ends.max()


def test_a_longer_finger_is_longer() -> None:
    hand = Hand()
    fingers = (*hand.fingers[:3], replace(hand.fingers[3], length_mm=100.0))
    longer = glove(replace(hand, fingers=fingers), WOOL)
    assert longer.shaped.chart.columns > PLANS[0].shaped.chart.columns


def test_tubes_follow_the_limb() -> None:
    gauge = Gauge.of_material(WOOL, Fabric.STOCKINETTE)
    widths = [stop - start for start, stop in PLANS[3].shaped.spans]
    assert set(np.diff(widths)) <= {-2, 0, 2}
    assert widths[0] * gauge.stitch_course_mm == pytest.approx(180 * 0.85, rel=0.05)
    assert widths[-1] * gauge.stitch_course_mm == pytest.approx(260 * 0.85, rel=0.05)
    assert len(widths) * gauge.stitch_wale_mm == pytest.approx(200, rel=0.01)


def test_a_limb_that_widens_too_fast_is_told() -> None:
    plan = limb_tube("cone", [Girth(0, 100), Girth(40, 500)], WOOL, hem_mm=0)
    assert set(np.diff([stop - start for start, stop in plan.shaped.spans])) <= {0, 2}
    assert "widens faster" in plan.notes[0]


def test_unlike_gauges_are_told_where_they_meet() -> None:
    stitch = np.ones((4, 6), dtype=bool)
    left = np.zeros_like(stitch)
    left[:, :3] = True
    regions = [
        Region("a", left, fabric_repeat(Fabric.RIB)),
        Region("b", ~left, fabric_repeat(Fabric.GARTER)),
    ]
    found = misfits(regions, [Gauge(3.0, 3.0), Gauge(2.0, 2.0)], stitch)
    assert [(m.first, m.second, m.stitches) for m in found] == [("a", "b", 4)]
    assert found[0].difference == pytest.approx(0.5)
    assert "a lies beside b and its rows are 50% higher" in found[0].text
    assert misfits(regions, [Gauge(3.0, 3.0), Gauge(2.0, 2.8)], stitch) == ()


def test_contradictory_regions_are_named() -> None:
    stitch = np.ones((2, 2), dtype=bool)
    both = Region("a", stitch, fabric_repeat(Fabric.RIB))
    with pytest.raises(InputError, match="4 stitches belong to two regions, the first in row 1"):
        fill_regions(stitch, [both, replace(both, name="b")])
    with pytest.raises(InputError, match="no region"):
        fill_regions(stitch, [])


@pytest.mark.parametrize("fabric", list(Fabric))
def test_yarn_of_a_pure_fabric_is_its_loop_length(fabric: Fabric) -> None:
    shaped = ShapedChart.rectangle(StitchChart.of_fabric(fabric, rows=10, columns=20))
    use = yarn_use(shaped, WOOL, linear_density_tex=500)
    assert use.length_m == pytest.approx(0.2 * (WOOL.record(fabric).loop_length_mm or 0))
    assert use.mass_g == pytest.approx(use.length_m / 2)
    with pytest.raises(InputError, match="no yarn"):
        yarn_use(shaped, WOOL, linear_density_tex=0)


def test_numbers_of_a_pure_region_are_its_fabrics() -> None:
    shaped = ShapedChart.rectangle(StitchChart.of_fabric("garter", rows=6, columns=6))
    region = Region("all", np.ones((6, 6), dtype=bool), fabric_repeat(Fabric.GARTER))
    (numbers,) = region_numbers(shaped, [region], WOOL)
    assert numbers.modulus_wale_n_per_mm == pytest.approx(WOOL.law(Fabric.GARTER).modulus_wale)


def test_a_tube_is_sized_for_a_pressure() -> None:
    fit = fit_tube(WOOL, Fabric.STOCKINETTE, Direction.WALE, 170, 20, multiple=2)
    assert fit.count % 2 == 0
    assert fit.ease == pytest.approx(fit.rest_mm / 170 - 1)
    low, high = fit.pressure.mmhg.low, fit.pressure.mmhg.high
    assert low < 21
    assert high > 19
    softer = fit_tube(WOOL, Fabric.GARTER, Direction.WALE, 170, 20)
    assert softer.rest_mm < fit.rest_mm


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: wrist_brace(-1, 90, WOOL), "wrist_mm"),
        (lambda: wrist_brace(170, 90, WOOL, ease=-2), "ease"),
        (lambda: limb_tube("x", [Girth(0, 100)], WOOL), "profile"),
        (lambda: limb_tube("x", [Girth(10, 100), Girth(0, 100)], WOOL), "profile"),
        (lambda: Hand(thumb_crotch_mm=200), "thumb_crotch_mm"),
        (lambda: Hand(palm_mm=float("nan")), "palm_mm"),
        (lambda: glove(Hand(), WOOL, ease=3), "ease"),
    ],
)
def test_measurements_that_cannot_be_knitted(make: object, field: str) -> None:
    assert callable(make)
    with pytest.raises(InputError) as caught:
        make()
    assert caught.value.field == field
