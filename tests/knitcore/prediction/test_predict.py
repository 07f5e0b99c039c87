"""Predictions: the tables, the rule of sources, symmetry, bounds and intervals."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import Direction, Fabric, InputError, RelaxedSize, StitchChart, predict
from knitcore.law.constitutive import Transverse
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials import Laws, load_library, load_variants, material
from knitcore.prediction.predict import patches_of
from knitcore.prediction.prediction import Source
from tests.knitcore.charts import flipped, stitch_charts
from tests.knitcore.refusals import refuses

LOADS = [0.01, 0.05, 0.1, 0.2]
ALL = {**load_library(Laws.PUBLISHED), **load_variants(Laws.PUBLISHED)}


@pytest.mark.parametrize("identifier", ALL)
def test_pure_fabrics_have_their_table_values(identifier):
    yarn = ALL[identifier]
    for fabric, record in yarn.fabrics.items():
        pure = predict(StitchChart.of_fabric(fabric, rows=31, columns=31), yarn)
        figures = record.printed
        assert pure.modulus_course_n_per_mm == pytest.approx(figures["Y_x"].corrected, rel=0.01)
        assert pure.modulus_wale_n_per_mm == pytest.approx(figures["Y_y"].corrected, rel=0.01)
        assert pure.poisson_yx == pytest.approx(figures["nu_yx"].corrected, abs=5e-4)
        assert pure.poisson_xy == pytest.approx(figures["nu_xy"].corrected, abs=5e-4)
        simulated = identifier.endswith("simulation")
        expected = Source.SWEPT if simulated else Source.MEASURED
        assert pure.provenance is expected
        assert pure.relaxed_course_mm == record.stitch_course_mm


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("fabric", Fabric)
def test_a_held_pure_fabric_is_its_law(fabric, direction):
    acrylic = material("acrylic")
    along = predict(StitchChart.of_fabric(fabric, 4, 4), acrylic).along(direction)
    law = acrylic.law(fabric)
    strain = np.array([0.02, 0.4, 0.7]) * law.lock_up_strain(direction)
    held = uniaxial_response(law, direction, strain, transverse=Transverse.FIXED)
    np.testing.assert_allclose(along.held_stress(strain), held.stress, rtol=0.01)
    free = uniaxial_response(law, direction, strain)
    np.testing.assert_allclose(along.across_strain(free.stress), free.transverse_strain, rtol=1e-6)


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("text", ["KKPP", "K/K/P/P", "KKPP/KKPP/PPKK/PPKK"])
def test_a_held_mixed_chart_is_stiffer_and_of_one_mind_in_patches(text, direction):
    """The whole piece in patches as the repeat, within 15 %."""
    repeat, acrylic = StitchChart.parse(text), material("acrylic")
    piece = flipped(repeat.resized(40, 40), 0, 0)  # so that it does not repeat
    alone, cut = (predict(chart, acrylic).along(direction) for chart in (repeat, piece))
    stress = np.array([0.005, 0.05, 0.2])
    for along in (alone, cut):
        assert np.all(along.held_strain(stress) < along.strain(stress))
        assert along.held.modulus_n_per_mm > along.modulus_n_per_mm
    np.testing.assert_allclose(cut.held_strain(stress), alone.held_strain(stress), rtol=0.15)
    np.testing.assert_allclose(cut.across_strain(stress), alone.across_strain(stress), rtol=0.15)
    first = alone.across_strain(1e-5) / alone.strain(1e-5)
    assert -first == pytest.approx(alone.poisson, abs=0.02)


def test_sources_are_labelled_by_the_rule():
    acrylic = material("acrylic:published")
    for text in ("KKPP", "PKKP", "K/K/P/P", "KKPP/KKPP/PPKK/PPKK"):
        assert predict(StitchChart.parse(text), acrylic).provenance == "learned"
    assert predict(StitchChart.parse("KP/PK"), acrylic).provenance == "measured"
    cut = predict(StitchChart.parse("KKPP").resized(31, 31), acrylic)
    assert cut.provenance == "learned"
    assert cut.modulus_course_n_per_mm == pytest.approx(
        predict(StitchChart.parse("KKPP"), acrylic).modulus_course_n_per_mm
    )


def test_a_gauge_determines_how_deep_a_rib_folds():
    acrylic, rib = material("acrylic:published"), StitchChart.parse("KKKPPP")
    tight = predict(rib, acrylic, RelaxedSize.from_gauge(60, 36))
    loose = predict(rib, acrylic, RelaxedSize.from_gauge(50, 36))
    assert tight.provenance == "learned with known size"
    assert tight.relaxed_course_mm == pytest.approx(100 / 60)
    assert tight.course.strain(0.05) > loose.course.strain(0.05)
    low, high = tight.course.strain_interval(0.05)
    widest, most = predict(rib, acrylic).course.strain_interval(0.05)
    assert high / low < most / widest  # surer


@pytest.mark.parametrize("text", ["K", "KKPP\nKKPP\nPPKK\nPPKK", "KPPPKK\nPKPKPK"])
def test_a_gauge_is_the_size_of_any_chart(text):
    size = RelaxedSize.from_gauge(25, 40)
    sized = predict(StitchChart.parse(text), material("cotton:published"), size)
    assert (sized.relaxed_course_mm, sized.relaxed_wale_mm) == pytest.approx((4.0, 2.5))
    assert sized.relaxed_source == "gauge"
    assert sized.course.relaxed_interval_mm.high < 1.06 * 4.0


def test_wide_rib_pulls_in_and_unfolds():
    """Knitted 2x2 rib is 0.84 of the width of 1x1 rib."""
    for identifier in load_library():
        yarn = material(identifier)
        wide = predict(StitchChart.parse("KKPP"), yarn)
        narrow = predict(StitchChart.parse("KP"), yarn)
        plain = predict(StitchChart.parse("K"), yarn)
        assert 0.8 < wide.relaxed_course_mm / narrow.relaxed_course_mm < 0.97
        flat = (narrow.course.strain(0.1) + plain.course.strain(0.1)) / 2
        assert wide.course.strain(0.1) > 1.3 * flat
        assert any("the width are the least certain" in note for note in wide.notes)


@pytest.mark.parametrize("identifier", ["glove-wool", "lace-cashmere", "lace-alpaca-mohair"])
def test_a_2x2_rib_stretches_about_as_far_as_a_1x1_rib_of_the_same_loops(identifier):
    """Swatches of one yarn at one setting, KnitDB's: 1.93 and 1.96. From a narrower rest."""
    yarn = material(identifier)
    wide, narrow = (predict(StitchChart.parse(text), yarn).course for text in ("KKPP", "KP"))
    loads = np.array([0.05, 0.1, 0.2])
    ratio = wide.strain(loads) / narrow.strain(loads)
    assert np.all((ratio > 0.9) & (ratio < 1.2))
    assert wide.relaxed_mm < narrow.relaxed_mm


def test_loops_of_different_length_are_noted():
    """Acrylic's 1x1 rib has longer loops than its stockinette, so a 2x2 rib gives less than it."""
    wide, narrow = (
        predict(StitchChart.parse(text), material("acrylic")) for text in ("KKPP", "KP")
    )
    assert wide.course.strain(0.1) < narrow.course.strain(0.1)
    assert any("different loop lengths" in note for note in wide.notes)


def test_stockinette_is_said_to_curl():
    plain = predict(StitchChart.parse("K"), material("cotton:published"))
    assert any("curls" in note for note in plain.notes)


@settings(max_examples=15)
@given(stitch_charts(8))
def test_the_same_cloth_has_one_answer(chart):
    yarn = material("acrylic:published")
    own = predict(chart, yarn)
    for other in (chart.mirror(), chart.swap(), chart.turn_over(), chart.tile(2, 2)):
        same = predict(other, yarn)
        assert same.provenance == own.provenance
        for along, expected in ((same.course, own.course), (same.wale, own.wale)):
            for name in ("modulus_n_per_mm", "poisson", "relaxed_mm", "relaxed_log_sd"):
                assert getattr(along, name) == pytest.approx(getattr(expected, name), rel=1e-6)
            for stretch in ("strain", "strain_interval"):
                strains, own_strains = (getattr(a, stretch)(LOADS) for a in (along, expected))
                np.testing.assert_allclose(strains, own_strains, rtol=1e-6)


@settings(max_examples=15)
@given(stitch_charts(6), st.sampled_from([*load_library()]))
def test_intervals_and_bounds_hold_the_value(chart, identifier):
    prediction = predict(chart, material(identifier))
    for along in (prediction.course, prediction.wale):
        interval, bounds = along.modulus_interval_n_per_mm, along.bounds_n_per_mm
        assert 0 < interval.low < along.modulus_n_per_mm < interval.high
        assert bounds.low <= along.modulus_n_per_mm <= bounds.high
    assert prediction.poisson_yx * prediction.poisson_xy < 1
    loads = np.array([0.0, 0.01, 0.05, 0.2])
    for direction in Direction:
        along = prediction.along(direction)
        assert along.relaxed_interval_mm.low < along.relaxed_mm < along.relaxed_interval_mm.high
        extensibility = along.extensibility_interval_mm_per_n
        assert extensibility.low < 1 / along.modulus_n_per_mm < extensibility.high
        strain, (low, high) = along.strain(loads), along.strain_interval(loads)
        assert strain[0] == low[0] == high[0] == 0
        assert np.all((low[1:] < strain[1:]) & (strain[1:] < high[1:]))
        np.testing.assert_allclose(along.stress(strain), loads, rtol=5e-3)
        softest, stiffest = along.stress_interval(strain)
        assert np.all((softest[1:] < loads[1:]) & (loads[1:] < stiffest[1:]))


def test_a_piece_of_patches_keeps_to_a_gauge():
    """A ribbed hem below stockinette: each keeps its own width, the mean is the gauge's."""
    hem = StitchChart.parse("KKPP").resized(20, 40).purl
    piece = StitchChart(np.vstack([hem, np.zeros((20, 40), dtype=bool)]))
    patches = patches_of(piece, material("acrylic:published"), RelaxedSize.from_gauge(35, 40))
    assert patches.together().relaxed_course_mm == pytest.approx(100 / 35, rel=0.01)
    bottom, top = patches.predictions[0][0], patches.predictions[-1][0]
    assert bottom.relaxed_course_mm < 0.9 * top.relaxed_course_mm
    assert bottom.provenance == "learned with known size"


def test_a_gauge_leaves_the_moduli_of_a_measured_fabric():
    cotton, chart = material("cotton:published"), StitchChart.parse("K")
    plain, given = predict(chart, cotton), predict(chart, cotton, RelaxedSize.from_gauge(25, 40))
    for direction in Direction:
        assert given.modulus_n_per_mm(direction) == plain.modulus_n_per_mm(direction)


def test_a_large_chart_of_noise_is_answered():
    chart = StitchChart(np.random.default_rng(3).random((200, 200)) < 0.5)
    noise = predict(chart, material("cotton:published"))
    assert noise.provenance == "learned"
    for along in (noise.course, noise.wale):
        assert along.bounds_n_per_mm.low < along.modulus_n_per_mm < along.bounds_n_per_mm.high
        assert np.all(np.diff(along.strain(LOADS)) > 0)


def test_missing_fabrics_are_named():
    with pytest.raises(InputError, match="has no rib"):
        predict(StitchChart.parse("KKPP"), material("glove-wool:needle-2.0mm"))


def test_an_answer_says_what_its_intervals_rest_on():
    yarn = material("acrylic")
    tests = yarn.record("garter").uncertainty.source
    learned, gauge = "errors on charts that the model had not seen", RelaxedSize(3.0, 2.0)
    garter, mixed = StitchChart.parse("K/P"), StitchChart.parse("KKPP")
    assert predict(garter, yarn).stretch_errors == (tests,)
    assert predict(mixed, yarn).stretch_errors == (learned, tests)
    assert learned in predict(mixed, yarn).size_errors
    assert predict(mixed, yarn, size=gauge).size_errors == ("the gauge as given",)
    large = flipped(StitchChart.of_fabric("garter", 40, 40), slice(20, None), slice(None, None, 2))
    assert predict(large, yarn).stretch_errors == (learned, tests)


def test_names_stand_for_charts_and_materials() -> None:
    rib, acrylic = StitchChart.parse("KKPP"), material("acrylic")
    assert predict("KKPP", "acrylic").to_dict() == predict(rib, acrylic).to_dict()
    garter = StitchChart.of_fabric("garter")
    assert predict("garter", "acrylic").to_dict() == predict(garter, acrylic).to_dict()


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ((3, "acrylic"), "chart"),
        (("KKPP", 3), "material"),
        (("KKPP", StitchChart.parse("K")), "material"),
        (("KKPP", "acrylic", 3.0), "size"),
        (("KX", "acrylic"), "chart"),
        (("KKPP", "nylon"), "material"),
    ],
)
def test_arguments_of_another_kind_are_named(arguments: tuple[Any, ...], field: str) -> None:
    with refuses(field):
        predict(*arguments)
