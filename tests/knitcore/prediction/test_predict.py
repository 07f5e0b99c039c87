"""Predictions: the tables, the rule of sources, symmetry, bounds and intervals."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from knitcore import Direction, Fabric, InputError, RelaxedSize, StitchChart, predict
from knitcore.law.constitutive import Transverse
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials import Laws, load_library, load_variants, material
from knitcore.prediction.predict import patches_of
from knitcore.prediction.prediction import Source

ALL = {**load_library(Laws.PUBLISHED), **load_variants(Laws.PUBLISHED)}


@pytest.mark.parametrize("identifier", ALL)
def test_pure_fabrics_have_their_table_values(identifier):
    yarn = ALL[identifier]
    for fabric, record in yarn.fabrics.items():
        found = predict(StitchChart.of_fabric(fabric, rows=31, columns=31), yarn)
        figures = record.printed
        assert found.modulus_course_n_per_mm == pytest.approx(figures["Y_x"].corrected, rel=0.01)
        assert found.modulus_wale_n_per_mm == pytest.approx(figures["Y_y"].corrected, rel=0.01)
        assert found.poisson_yx == pytest.approx(figures["nu_yx"].corrected, abs=5e-4)
        assert found.poisson_xy == pytest.approx(figures["nu_xy"].corrected, abs=5e-4)
        simulated = identifier.endswith("simulation")
        expected = Source.SWEPT if simulated else Source.MEASURED
        assert found.provenance is expected
        assert found.relaxed_course_mm == record.stitch_course_mm


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
    cut = repeat.resized(40, 40).purl.copy()
    cut[0, 0] ^= True  # one stitch off, so that it does not repeat
    one, many = (predict(c, acrylic).along(direction) for c in (repeat, StitchChart(cut)))
    stress = np.array([0.005, 0.05, 0.2])
    for along in (one, many):
        assert np.all(along.held_strain(stress) < along.strain(stress))
        assert along.held.modulus_n_per_mm > along.modulus_n_per_mm
    np.testing.assert_allclose(many.held_strain(stress), one.held_strain(stress), rtol=0.15)
    np.testing.assert_allclose(many.across_strain(stress), one.across_strain(stress), rtol=0.15)
    first = one.across_strain(1e-5) / one.strain(1e-5)
    assert -first == pytest.approx(one.poisson, abs=0.02)


def test_sources_are_labelled_by_the_rule():
    acrylic = material("acrylic:published")
    cases = {
        "KKPP": "learned",
        "PKKP": "learned",
        "K\nK\nP\nP": "learned",
        "KKPP\nKKPP\nPPKK\nPPKK": "learned",
        "KP\nPK": "measured",
    }
    for text, label in cases.items():
        assert predict(StitchChart.parse(text), acrylic).provenance == label
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
    found = predict(StitchChart.parse(text), material("cotton:published"), size)
    assert (found.relaxed_course_mm, found.relaxed_wale_mm) == pytest.approx((4.0, 2.5))
    assert found.relaxed_source == "gauge"
    assert found.course.relaxed_interval_mm.high < 1.06 * 4.0


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
        assert any("draw-in" in note for note in wide.notes)


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
    found = predict(StitchChart.parse("K"), material("cotton:published"))
    assert any("curls" in note for note in found.notes)


@settings(deadline=None, max_examples=25)
@given(hnp.arrays(bool, hnp.array_shapes(min_dims=2, max_dims=2, min_side=1, max_side=6)))
def test_turning_over_changes_nothing(grid):
    yarn = material("acrylic:published")
    chart = StitchChart(grid)
    face, back = predict(chart, yarn), predict(chart.turn_over(), yarn)
    for name in ("modulus_course_n_per_mm", "modulus_wale_n_per_mm", "poisson_yx", "poisson_xy"):
        assert getattr(face, name) == pytest.approx(getattr(back, name), rel=1e-8)
    assert face.provenance == back.provenance
    assert face.relaxed_course_mm == pytest.approx(back.relaxed_course_mm)


@settings(deadline=None, max_examples=25)
@given(
    hnp.arrays(bool, hnp.array_shapes(min_dims=2, max_dims=2, min_side=2, max_side=6)),
    st.sampled_from([*load_library()]),
)
def test_intervals_and_bounds_hold_the_value(grid, identifier):
    found = predict(StitchChart(grid), material(identifier))
    for along in (found.course, found.wale):
        interval, bounds = along.modulus_interval_n_per_mm, along.bounds_n_per_mm
        assert 0 < interval.low < along.modulus_n_per_mm < interval.high
        assert bounds.low <= along.modulus_n_per_mm <= bounds.high
    assert found.poisson_yx * found.poisson_xy < 1
    loads = np.array([0.0, 0.01, 0.05, 0.2])
    for direction in Direction:
        along = found.along(direction)
        assert along.relaxed_interval_mm.low < along.relaxed_mm < along.relaxed_interval_mm.high
        one = along.extensibility_interval_mm_per_n
        assert one.low < 1 / along.modulus_n_per_mm < one.high
        strain, (low, high) = along.strain(loads), along.strain_interval(loads)
        assert strain[0] == low[0] == high[0] == 0
        assert np.all((low[1:] < strain[1:]) & (strain[1:] < high[1:]))
        np.testing.assert_allclose(along.stress(strain), loads, rtol=5e-3)
        softest, stiffest = along.stress_interval(strain)
        assert np.all((softest[1:] < loads[1:]) & (loads[1:] < stiffest[1:]))


def test_a_patchwork_lies_between_its_regions():
    acrylic = material("acrylic:published")
    purl = np.zeros((30, 600), dtype=bool)
    purl[:, 300:] = StitchChart.of_fabric("garter", 30, 300).purl
    found = predict(StitchChart(purl), acrylic)
    plain, garter = acrylic.law(Fabric.STOCKINETTE), acrylic.law(Fabric.GARTER)
    assert plain.modulus_course < found.modulus_course_n_per_mm < garter.modulus_course
    assert garter.modulus_wale < found.modulus_wale_n_per_mm < plain.modulus_wale
    assert found.modulus_wale_n_per_mm == pytest.approx(
        (plain.modulus_wale + garter.modulus_wale) / 2, rel=0.15
    )


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
    found = predict(chart, material("cotton:published"))
    for direction in Direction:
        bounds = found.along(direction).bounds_n_per_mm
        assert bounds.low < found.modulus_n_per_mm(direction) < bounds.high


def test_missing_fabrics_are_named():
    with pytest.raises(InputError, match="has no rib"):
        predict(StitchChart.parse("KKPP"), material("glove-wool:needle-2.0mm"))


def test_the_public_face():
    """What notebooks import."""
    import knitcore

    for name in ("StitchChart", "material", "predict", "curve", "relax", "strip_test"):
        assert name in knitcore.__all__
        assert callable(getattr(knitcore, name))
    for name in knitcore.__all__:
        assert getattr(knitcore, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'moduli'"):
        _ = knitcore.moduli


def test_an_answer_says_what_its_intervals_rest_on():
    yarn = material("acrylic")
    tests = yarn.record("garter").uncertainty.source
    learned, gauge = "errors on charts that the model had not seen", RelaxedSize(3.0, 2.0)
    garter, mixed = StitchChart.parse("K/P"), StitchChart.parse("KKPP")
    assert predict(garter, yarn).stretch_errors == (tests,)
    assert predict(mixed, yarn).stretch_errors == (learned, tests)
    assert learned in predict(mixed, yarn).size_errors
    assert predict(mixed, yarn, size=gauge).size_errors == ("the gauge as given",)
    large = StitchChart.of_fabric("garter", 40, 40).purl.copy()
    large[20:, ::2] ^= True
    assert predict(StitchChart(large), yarn).stretch_errors == (learned, tests)


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
    with pytest.raises(InputError) as refused:
        predict(*arguments)
    assert refused.value.field == field
