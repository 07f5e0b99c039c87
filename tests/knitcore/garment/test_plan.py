from dataclasses import replace

import numpy as np
import pytest

from knitcore import Direction, Fabric, InputError, RelaxedSize, StitchChart, material
from knitcore.formats.designs.design_file import design_from_mapping
from knitcore.formats.designs.garment_design import design_of_plan
from knitcore.formats.designs.layout import layout_notes
from knitcore.formats.read.written_reader import read_piece_rows
from knitcore.formats.write.written_pattern import write_rows
from knitcore.garment.gauge import Gauge, GaugeSet
from knitcore.garment.glove import CROTCH_ROWS, Finger, GloveFabrics, Hand, glove
from knitcore.garment.piece import Piece
from knitcore.garment.plan import GarmentPlan
from knitcore.garment.regions import Region, fill_regions, misfits, region_numbers, yarn_use
from knitcore.garment.shaped import ShapedChart
from knitcore.garment.templates import Girth, limb_tube, sock_leg, wrist_brace
from knitcore.garment.worked_piece import piece_rows
from knitcore.garment.worn_piece import Fit, Worn, worn
from knitcore.materials import load_library
from knitcore.materials.yarn_per_stitch import MeasuredYarn
from knitcore.mechanics.pressure import CAPILLARY_MMHG, too_tight
from tests.knitcore.machine.second_machine import verified_twice
from tests.knitcore.refusals import refuses

WOOL = material("glove-wool:published")
PLANS = (
    glove(Hand(), WOOL),
    wrist_brace(170, 90, WOOL),
    sock_leg(220, 360, 200, WOOL),
    limb_tube("sleeve", [Girth(0, 180), Girth(200, 260)], WOOL),
)


def first_place(plan: GarmentPlan, part: str) -> Worn:
    """Where the part of a plan is worn first."""
    return next(worn for worn in plan.worn if worn.part == part)


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
    assert len(crotches) == np.count_nonzero(np.diff(ends) > 0)  # back and front are alike
    fingers = next(
        r.cells & PLANS[0].shaped.stitch for r in PLANS[0].regions if r.name == "fingers"
    )
    palm = int(np.flatnonzero(fingers.any(axis=0))[0])
    assert np.count_nonzero(ends == palm) == 6 * CROTCH_ROWS
    assert ends[0] == ends[-1] < ends.max()


def test_parts_of_the_glove_take_other_fabrics() -> None:
    ribbed = GloveFabrics(support=Fabric.RIB, thumb=Fabric.GARTER, fingers=Fabric.SEED)
    plan = glove(Hand(), WOOL, fabrics=ribbed)
    fabrics = dict(zip((region.name for region in plan.regions), plan.fabrics, strict=True))
    assert fabrics == {
        "cuff": Fabric.GARTER,
        "wrist support": Fabric.RIB,
        "hand": Fabric.GARTER,
        "thumb": Fabric.GARTER,
        "thumb gusset": Fabric.GARTER,
        "fingers": Fabric.SEED,
    }
    assert (
        first_place(plan, "wrist support").rest_mm > first_place(PLANS[0], "wrist support").rest_mm
    )


def test_the_glove_is_shaped_where_rows_begin() -> None:
    """At the tips on right-side rows, at the wrist on wrong-side ones: nothing needs a strand."""
    for plan in (PLANS[0], glove(replace(Hand(), gusset_mm=0.0), WOOL)):
        rows = piece_rows(Piece.plain(plan.shaped))
        assert {row.last for row in rows} == {0}
        assert any(row.first > 1 for row in rows)
        assert any(row.first < -1 for row in rows)


def test_the_gusset_tapers_from_the_thumb_to_its_crotch() -> None:
    stitches = []
    for girth in (0.0, 22.0, 44.0):
        plan = glove(replace(Hand(), gusset_girth_mm=girth), WOOL)
        stitches.append(sum(n.stitches for n in plan.numbers if n.name == "thumb gusset"))
    assert stitches[0] == 0 < stitches[1] < stitches[2]
    ends = np.array([stop for _, stop in PLANS[0].shaped.spans])
    assert np.array_equal(ends, ends[::-1])


def test_the_thumb_does_not_widen_the_wrist() -> None:
    plan = PLANS[0]
    starts = np.array([start for start, _ in plan.shaped.spans])
    around = np.count_nonzero(starts == 0)
    assert first_place(plan, "wrist support").rest_mm == pytest.approx(
        around * Gauge.of_material(WOOL, Fabric.STOCKINETTE).stitch_wale_mm
    )
    assert around < plan.shaped.chart.rows


def test_the_study_glove_is_tighter_at_the_wrist() -> None:
    """Its support is on 2.0 mm needles (Methods; starred in table 6)."""
    study = glove(Hand(), material("glove-wool:glove"), mmhg=25)
    assert (
        first_place(study, "wrist support").rest_mm < first_place(PLANS[0], "wrist support").rest_mm
    )
    assert "2.0 mm needles" in study.notes[0]
    assert "for 25 mmhg the wrist support takes" in study.cautions[-1].lower()


@pytest.mark.parametrize("mmhg", [8.0, 15.0, 25.0])
def test_a_target_pressure_is_reached(mmhg: float) -> None:
    brace = wrist_brace(170, 90, WOOL, fit=Fit(mmhg=mmhg))
    interval = first_place(brace, "support").pressure.mmhg
    assert interval.low < mmhg * 1.1
    assert interval.high > mmhg * 0.9
    tube = limb_tube("s", [Girth(0, 200), Girth(200, 220)], WOOL, fit=Fit(mmhg=mmhg), hem_mm=0)
    for place in tube.worn:
        assert place.pressure.mmhg.low < mmhg * 1.25
        assert place.pressure.mmhg.high > mmhg * 0.75


def test_a_knitter_with_another_gauge_needs_other_counts() -> None:
    own = GaugeSet.of_material(WOOL)
    fine = GaugeSet.of_material(WOOL, Gauge(own[Fabric.RIB].stitch_course_mm / 2, 1.0), Fabric.RIB)
    assert fine[Fabric.RIB] == Gauge(
        own[Fabric.RIB].stitch_course_mm / 2, 1.0, fine[Fabric.RIB].source
    )
    ratio = own[Fabric.SEED].stitch_course_mm / fine[Fabric.SEED].stitch_course_mm
    assert ratio == pytest.approx(2)
    assert glove(Hand(), WOOL, gauges=fine).shaped.stitches > 3 * PLANS[0].shaped.stitches


def test_every_plan_is_a_design_with_its_regions() -> None:
    for plan in PLANS:
        design = design_of_plan(plan, "glove-wool", intarsia=True)
        assert design_from_mapping(design.model_dump(mode="json")) == design
        assert not layout_notes(design.to_chart(), design)
        piece = design.to_piece()
        assert piece.shaped == plan.shaped
        assert len(piece.yarns) == len({r.colour for r in plan.regions})


def test_a_glove_is_written_and_read_back() -> None:
    piece = design_of_plan(PLANS[0], "glove-wool", intarsia=True).to_piece()
    assert read_piece_rows(write_rows(piece)) == piece


@pytest.mark.slow
def test_a_glove_is_knitted_by_the_machine_in_four_yarns() -> None:
    """In a coarse gauge, so that it has few stitches."""
    own = GaugeSet.of_material(WOOL)[Fabric.STOCKINETTE]
    coarse = Gauge(3 * own.stitch_course_mm, 3 * own.stitch_wale_mm)
    plan = glove(Hand(), WOOL, gauges=GaugeSet.of_material(WOOL, coarse))
    piece = design_of_plan(plan, "glove-wool", intarsia=True).to_piece()
    program = verified_twice(piece)
    assert program.carriers <= 6
    assert program.shaping_transfers > 0
    assert len(piece.yarns) == 4


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


def test_a_limb_that_widens_too_fast_is_reported() -> None:
    plan = limb_tube("cone", [Girth(0, 100), Girth(40, 500)], WOOL, hem_mm=0)
    assert set(np.diff([stop - start for start, stop in plan.shaped.spans])) <= {0, 2}
    assert any("widens faster" in caution for caution in plan.cautions)


def test_different_gauges_are_reported_where_they_meet() -> None:
    stitch = np.ones((4, 6), dtype=bool)
    left = np.zeros_like(stitch)
    left[:, :3] = True
    regions = [
        Region("a", left, StitchChart.of_fabric(Fabric.RIB).repeat()),
        Region("b", ~left, StitchChart.of_fabric(Fabric.GARTER).repeat()),
    ]
    reported = misfits(regions, [Gauge(3.0, 3.0), Gauge(2.0, 2.0)], stitch)
    assert [(m.first, m.second, m.stitches) for m in reported] == [("a", "b", 4)]
    assert reported[0].difference == pytest.approx(0.5)
    assert "“a” lies beside “b” and its rows are 50 % higher" in reported[0].text
    assert misfits(regions, [Gauge(3.0, 3.0), Gauge(2.0, 2.8)], stitch) == ()


def test_contradictory_regions_are_named() -> None:
    stitch = np.ones((2, 2), dtype=bool)
    both = Region("a", stitch, StitchChart.of_fabric(Fabric.RIB).repeat())
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
    course, wale = WOOL.record(fabric).stitch_mm
    loose = yarn_use(shaped, WOOL, size=RelaxedSize(1.2 * course, 1.2 * wale))
    assert loose.length_m == pytest.approx(1.2 * use.length_m, rel=0.01)
    known = yarn_use(shaped, WOOL, linear_density_tex=500, measured=MeasuredYarn(10.0))
    assert (known.length_m, known.mass_g) == pytest.approx((2.0, 1.0))
    assert known.log_sd < use.log_sd
    assert known.length_interval_m.low < 2.0 < known.length_interval_m.high
    with pytest.raises(InputError, match="not a linear density"):
        yarn_use(shaped, WOOL, linear_density_tex=0)


def test_numbers_of_a_pure_region_are_its_fabrics() -> None:
    shaped = ShapedChart.rectangle(StitchChart.of_fabric("garter", rows=6, columns=6))
    region = Region(
        "all", np.ones((6, 6), dtype=bool), StitchChart.of_fabric(Fabric.GARTER).repeat()
    )
    (numbers,) = region_numbers(shaped, [region], WOOL)
    assert numbers.modulus_wale_n_per_mm == pytest.approx(WOOL.law(Fabric.GARTER).modulus_wale)


def test_a_tube_is_sized_for_a_pressure() -> None:
    fit = Fit(mmhg=20)
    rest_mm = fit.rest_mm(170, WOOL, Fabric.STOCKINETTE, Direction.WALE)
    tube = worn(WOOL, Fabric.STOCKINETTE, Direction.WALE, rest_mm, 170)
    assert tube.ease == pytest.approx(rest_mm / 170 - 1)
    assert tube.pressure.mmhg.low < 20 < tube.pressure.mmhg.high
    assert fit.rest_mm(170, WOOL, Fabric.GARTER, Direction.WALE) < rest_mm


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: wrist_brace(-1, 90, WOOL), "wrist_mm"),
        (lambda: wrist_brace(170, 90, WOOL, fit=Fit(-2)), "ease"),
        (lambda: limb_tube("x", [Girth(0, 100)], WOOL), "profile"),
        (lambda: limb_tube("x", [Girth(10, 100), Girth(0, 100)], WOOL), "profile"),
        (lambda: Hand(thumb_crotch_mm=200), "thumb_crotch_mm"),
        (lambda: Hand(palm_mm=float("nan")), "palm_mm"),
        (lambda: glove(Hand(), WOOL, ease=3), "ease"),
    ],
)
def test_measurements_that_cannot_be_knitted(make: object, field: str) -> None:
    with refuses(field):
        make()


def test_a_fit_takes_one_pressure_or_a_profile() -> None:
    graded = Fit(mmhg=((0, 20), (100, 10)))
    assert [graded.mmhg_at(at) for at in (-5, 0, 25, 100, 200)] == [20, 20, 17.5, 10, 10]
    assert Fit(mmhg=20).mmhg_at(70) == 20
    assert Fit().mmhg_at(70) is None
    with pytest.raises(InputError, match="mmhg: is of type list, no pressure and no profile"):
        Fit(mmhg=[20.0, 15.0])
    with pytest.raises(InputError, match="do not increase"):
        Fit(mmhg=[(10, 20.0), (0, 15.0)])


def test_pressure_is_graded_along_a_sleeve() -> None:
    """The middle of every interval follows the profile, as near as whole stitches allow."""
    fit = Fit(mmhg=((50, 20), (250, 8)))  # places as they are measured, the sleeve begins at 50
    limb = [Girth(50, 200), Girth(250, 210)]
    plan = limb_tube("s", limb, WOOL, fit=fit, hem_mm=0)
    middles = [(w.pressure.mmhg.low + w.pressure.mmhg.high) / 2 for w in plan.worn]
    targets = np.interp([w.at_mm for w in plan.worn], [0, 200], [20, 8])
    assert middles == pytest.approx(targets, rel=0.15)
    bent = limb_tube("s", limb, WOOL, fit=Fit(mmhg=((50, 20), (150, 20), (250, 8))), hem_mm=0)
    assert 100 in [w.at_mm for w in bent.worn]


def test_a_ribbing_that_misses_the_pressure_says_so() -> None:
    limb = [Girth(0, 200), Girth(200, 210)]
    cautions = limb_tube("s", limb, WOOL, fit=Fit(mmhg=15)).cautions
    missed = [note for note in cautions if "does not keep to the 15 mmHg" in note]
    assert len(missed) == 2
    assert all("ribbing" in note for note in missed)
    like_body = limb_tube("s", limb, WOOL, fit=Fit(mmhg=15), hem=Fabric.STOCKINETTE)
    assert not any("does not keep" in note for note in like_body.cautions)
    assert not any("does not keep" in note for note in limb_tube("s", limb, WOOL).cautions)


def test_an_edge_of_a_brace_that_misses_the_pressure_says_so() -> None:
    acrylic = material("acrylic")
    brace = wrist_brace(170, 90, acrylic, fit=Fit(mmhg=20))
    assert [worn.part for worn in brace.worn] == [
        "edge at the forearm",
        "support",
        "edge at the hand",
    ]
    assert [note.split(":")[0] for note in brace.cautions] == [
        f"The {edge} does not keep to the 20 mmHg of the support"
        for edge in ("edge at the forearm", "edge at the hand")
    ]
    assert not wrist_brace(170, 90, acrylic, fit=Fit(mmhg=20), edge=Fabric.STOCKINETTE).cautions
    assert not any("does not keep" in note for note in wrist_brace(170, 90, acrylic).cautions)


COMPLETE = [summary for summary in load_library() if len(material(summary).fabrics) == len(Fabric)]


@pytest.mark.parametrize("yarn", COMPLETE)
def test_a_glove_warns_of_nothing_until_it_is_made_tight(yarn: str) -> None:
    assert not [note for note in glove(Hand(), material(yarn)).cautions if "stop the blood" in note]
    tight = glove(Hand(), material(yarn), ease=-0.3)
    (warning,) = [note for note in tight.cautions if "stop the blood" in note]
    named = warning.removeprefix("Too tight: ").split(". ")[0].split(", ")
    assert "index finger" in named
    assert named == [place.part for place in tight.worn if place.highest_mmhg > CAPILLARY_MMHG]


def test_where_a_fabric_can_stretch_no_further_the_warning_says_so() -> None:
    fingers = (*Hand().fingers[:3], Finger(57.0, 120.0))
    assert "little finger" in glove(Hand(fingers=fingers), WOOL, ease=-0.4).cautions[0]
    locked = worn(WOOL, Fabric.RIB, Direction.WALE, 30, 120)
    assert (locked.pressure, locked.highest_mmhg) == (None, float("inf"))
    assert "can stretch no further" in too_tight(locked.highest_mmhg)[0]


def test_a_loose_place_says_so_in_round_numbers() -> None:
    loose = worn(WOOL, Fabric.RIB, Direction.WALE, 172.98765, 165.0)
    assert "loose, 173 mm around unworn on a limb of 165 mm" in loose.problem


def test_a_pressure_that_can_stop_the_blood_is_warned_of() -> None:
    tight, loose = (
        worn(WOOL, Fabric.STOCKINETTE, Direction.WALE, rest, 60).pressure.warnings[0]
        for rest in (45, 58)
    )
    assert "stop the blood" in tight
    assert "stop the blood" not in loose
