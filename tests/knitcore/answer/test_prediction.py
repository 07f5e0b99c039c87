"""Predictions: the tables, the rule of sources, symmetry, bounds and intervals."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from knitcore.answer.prediction import Provenance, predict
from knitcore.answer.relaxed import RelaxedSize
from knitcore.answer.uncertainty import phase_log_sd
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.materials import load_library, load_variants, material
from knitcore.mechanics.homogenisation import homogenise

ALL = {**load_library(), **load_variants()}


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
        expected = Provenance.YARN_LEVEL if simulated else Provenance.MEASURED
        assert found.provenance is expected
        assert found.relaxed_course_mm == record.stitch_course_mm


def test_sources_are_labelled_by_the_rule():
    acrylic = material("acrylic")
    cases = {
        "KKPP": "composite, corrected",
        "PKKP": "composite, corrected",
        "K\nK\nP\nP": "composite, corrected",
        "KKKPPP": "composite, corrected",
        "KKKKKPPPPP": "composite, stretched state only",
        "KKPP\nKKPP\nPPKK\nPPKK": "composite, stretched state only",
        "KP\nPK": "measured",
    }
    for text, label in cases.items():
        assert predict(StitchChart.parse(text), acrylic).provenance == label
    cut = predict(StitchChart.parse("KKPP").resized(31, 31), acrylic)
    assert cut.provenance == "composite, corrected"
    assert cut.modulus_course_n_per_mm == pytest.approx(
        predict(StitchChart.parse("KKPP"), acrylic).modulus_course_n_per_mm
    )


def test_a_swept_repeat_has_its_own_law():
    acrylic = material("acrylic")
    law = acrylic.law(Fabric.SEED)
    found = predict(StitchChart.parse("KKPP\nPPKK"), acrylic, repeat_law=law)
    assert found.provenance == "yarn level"
    assert found.modulus_wale_n_per_mm == law.modulus_wale


def test_a_gauge_corrects_any_rib():
    acrylic = material("acrylic")
    found = predict(StitchChart.parse("KKKPPP"), acrylic, relaxed=RelaxedSize.from_gauge(60, 30))
    assert found.provenance == "composite, corrected"
    assert found.relaxed_course_mm == pytest.approx(100 / 60)
    assert "gauge" in found.method


def test_wide_rib_is_more_extensible_and_says_why():
    for identifier in load_library():
        yarn = material(identifier)
        wide = predict(StitchChart.parse("KKPP"), yarn)
        narrow = predict(StitchChart.parse("KP"), yarn)
        assert wide.extensibility_course_mm_per_n > 1.3 * narrow.extensibility_course_mm_per_n
        assert wide.relaxed_course_mm < narrow.relaxed_course_mm
        assert any("Draw-in" in note for note in wide.notes)


def test_stockinette_is_said_to_curl():
    found = predict(StitchChart.parse("K"), material("cotton"))
    assert any("curls" in note for note in found.notes)


@settings(deadline=None, max_examples=25)
@given(hnp.arrays(bool, hnp.array_shapes(min_dims=2, max_dims=2, min_side=1, max_side=6)))
def test_turning_over_changes_nothing(grid):
    yarn = material("acrylic")
    chart = StitchChart(grid)
    face, back = predict(chart, yarn), predict(chart.turn_over(), yarn)
    for name in ("modulus_course_n_per_mm", "modulus_wale_n_per_mm", "poisson_yx", "poisson_xy"):
        assert getattr(face, name) == pytest.approx(getattr(back, name), rel=1e-8)
    assert face.provenance == back.provenance


@settings(deadline=None, max_examples=25)
@given(
    hnp.arrays(bool, hnp.array_shapes(min_dims=2, max_dims=2, min_side=2, max_side=6)),
    st.sampled_from([*load_library()]),
)
def test_intervals_hold_the_value_and_bounds_hold_the_flat_composite(grid, identifier):
    found = predict(StitchChart(grid), material(identifier))
    for name in ("modulus_course", "modulus_wale"):
        value = getattr(found, f"{name}_n_per_mm")
        interval, bounds = getattr(found, f"{name}_interval"), getattr(found, f"{name}_bounds")
        assert 0 < interval.low < value < interval.high
        assert bounds.low <= bounds.high * (1 + 1e-9)
        if found.provenance is Provenance.STRETCHED:
            assert bounds.low * (1 - 1e-6) <= value <= bounds.high * (1 + 1e-6)
    assert found.poisson_yx * found.poisson_xy < 1
    one = found.extensibility_course_interval
    assert one.low < found.extensibility_course_mm_per_n < one.high


def test_a_patchwork_lies_between_its_regions():
    acrylic = material("acrylic")
    purl = np.zeros((30, 60), dtype=bool)
    purl[:, 30:] = StitchChart.of_fabric("garter", 30, 30).purl
    found = predict(StitchChart(purl), acrylic)
    plain, garter = acrylic.law(Fabric.STOCKINETTE), acrylic.law(Fabric.GARTER)
    assert plain.modulus_course < found.modulus_course_n_per_mm < garter.modulus_course
    assert garter.modulus_wale < found.modulus_wale_n_per_mm < plain.modulus_wale
    assert found.modulus_wale_n_per_mm == pytest.approx(
        (plain.modulus_wale + garter.modulus_wale) / 2, rel=0.15
    )
    assert any("patchwork" in note for note in found.notes)


def test_a_large_chart_of_noise_is_answered():
    chart = StitchChart(np.random.default_rng(3).random((200, 200)) < 0.5)
    found = predict(chart, material("cotton"))
    for direction in Direction:
        bounds = (
            found.modulus_course_bounds
            if direction is Direction.COURSE
            else found.modulus_wale_bounds
        )
        assert bounds.low < found.modulus_n_per_mm(direction) < bounds.high


def test_missing_fabrics_are_named():
    with pytest.raises(InputError, match="has no rib"):
        predict(StitchChart.parse("KKPP"), material("glove-wool:needle-2.0mm"))


def test_the_delta_method_agrees_with_sampling():
    """Laws of a flat double seed drawn from their log-normal spread, 120 times."""
    yarn = material("lace-cashmere")
    chart = StitchChart.parse("KKPP\nPPKK")
    rng = np.random.default_rng(0)
    drawn = []
    for _ in range(120):
        fabrics = {}
        for fabric, record in yarn.fabrics.items():
            factor = np.exp(rng.normal() * record.uncertainty.log_modulus_course)
            law = replace(
                record.law,
                **{name: getattr(record.law, name) * factor for name in STIFFNESSES},
            )
            fabrics[fabric] = replace(record, law=law)
        sheet = homogenise(chart, replace(yarn, fabrics=fabrics))
        drawn.append(np.log(sheet.modulus_n_per_mm(Direction.COURSE)))
    shares = homogenise(chart, yarn).energy_shares[0]
    assert phase_log_sd(shares, yarn, Direction.COURSE) == pytest.approx(np.std(drawn), rel=0.2)


STIFFNESSES = (
    "stiffness_xxxx",
    "stiffness_yyyy",
    "stiffness_xxyy",
    "stiffness_yyxx",
    "shear_modulus",
)
