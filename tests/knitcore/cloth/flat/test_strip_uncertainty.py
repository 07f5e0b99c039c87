"""Intervals of a strip test: against tests of other laws, and what must hold for any."""

import math
from collections.abc import Iterator
from dataclasses import astuple, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import Direction, Fabric, StitchChart, material, strip_test
from knitcore.cloth.flat import StripTest, chart_sheet
from knitcore.cloth.flat.fields import Fields
from knitcore.cloth.flat.strip import Clamps
from knitcore.cloth.flat.strip_uncertainty import (
    StepSpread,
    StripSpread,
    interval_source,
    model_log_sd,
)
from knitcore.law.constitutive import ConstitutiveLaw, Symmetrisation
from knitcore.materials import Laws, LawUncertainty, Material, load_library
from knitcore.materials.law_uncertainty import Z_SCORE, CurveUncertainty
from knitcore.prediction.quarter_laws import flat_laws
from tests.knitcore.charts import flipped

ACRYLIC = material("acrylic:published")
SHEAR_N_PER_MM = 0.02
"""Given, so that it has no part in the intervals."""
HALVES = StitchChart(
    np.hstack([StitchChart.of_fabric(f, rows=6, columns=5).purl for f in ("garter", "rib")])
)
NONE = LawUncertainty(0.0, 0.0, 0.0, 0.0, "made up")


def changed(fabric: Fabric, base: Material = ACRYLIC, **new: object) -> Material:
    """The material with another record of one fabric."""
    records = {**base.fabrics, fabric: replace(base.record(fabric), **new)}
    return replace(base, fabrics=records)


def certain() -> Material:
    """Acrylic without any uncertainty."""
    records = {f: replace(record, uncertainty=NONE) for f, record in ACRYLIC.fabrics.items()}
    return replace(ACRYLIC, fabrics=records)


def scaled(law: ConstitutiveLaw, course: float, wale: float) -> ConstitutiveLaw:
    """Stress along course and wale times a factor each, at the same Poisson ratios."""
    along = {"stiffness_xx": course, "stiffness_yy": wale, "beta_xx": course, "beta_yy": wale}
    factors = {n: f for n in vars(law) for start, f in along.items() if n.startswith(start)}
    return replace(law, **{name: getattr(law, name) * f for name, f in factors.items()})


def with_poisson(law: ConstitutiveLaw, poisson_yx: float, poisson_xy: float) -> ConstitutiveLaw:
    """Other Poisson ratios at the same Young's moduli."""
    moduli = law.modulus_course, law.modulus_wale
    linear = ConstitutiveLaw.of_moduli(
        *moduli, poisson_yx, poisson_xy, alpha_xx=0.0, alpha_yy=0.0, beta_xx=0.0, beta_yy=0.0
    )
    stiffness = {n: v for n, v in vars(linear).items() if n.startswith("stiffness")}
    return replace(law, **stiffness)


@pytest.fixture(autouse=True, scope="module")
def _laws_as_they_are() -> Iterator[None]:
    """Cells with the pure fabrics' own laws, so that a changed law is a changed cell."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(
            "knitcore.cloth.flat.strip.quarter_laws",
            lambda chart, of, gauge, **_: flat_laws(chart, of),
        )
        yield


def pulled(base: Material, direction: str = "wale") -> StripTest:
    return strip_test(HALVES, base, direction, 0.3, steps=3, shear_modulus=SHEAR_N_PER_MM)


def largest_error(spread: StepSpread, low: Fields, high: Fields) -> float:
    """Error of the deviations against half the difference of two tests, over the largest."""
    errors = []
    for name in ("strain_xx", "strain_yy", "utilisation"):
        half = np.abs(getattr(low, name) - getattr(high, name)) / 2
        errors.append(np.abs(getattr(spread, f"{name}_sd") - half).max() / half.max())
    return max(errors)


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("way", Direction)
def test_a_scale_of_stress_moves_strains_as_in_a_test_of_the_scaled_law(
    direction: Direction, way: Direction, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("knitcore.cloth.flat.strip_uncertainty.model_log_sd", lambda _: 0.0)
    sd = 0.02
    base = changed(Fabric.RIB, certain(), uncertainty=replace(NONE, **{f"log_modulus_{way}": sd}))
    tests = []
    for factor in (math.exp(sd), math.exp(-sd)):
        factors = (factor, 1.0) if way is Direction.COURSE else (1.0, factor)
        law = scaled(base.law(Fabric.RIB), *factors)
        tests.append(pulled(changed(Fabric.RIB, base, law=law), direction))
    test = pulled(base, direction)
    spread = StripSpread(test, base).at(-1)
    assert largest_error(spread, *(t.fields() for t in tests)) < 0.01
    logs = [math.log(t.force_n[-1]) for t in tests]
    assert spread.force_log_sd == pytest.approx(abs(logs[0] - logs[1]) / 2, rel=0.01)
    waists = [t.waist_strain[-1] for t in tests]
    assert spread.waist_sd == pytest.approx(abs(waists[0] - waists[1]) / 2, rel=0.02, abs=1e-7)


@pytest.mark.parametrize(
    ("model", "name"), [("full", "poisson_yx"), ("full", "poisson_xy"), ("published", "poisson_xy")]
)
def test_a_measured_poisson_ratio_moves_strains_as_in_a_test_of_the_changed_law(
    model: str, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The two couplings of rib differ by a factor of 8; ``published`` uses one of them."""
    monkeypatch.setattr("knitcore.cloth.flat.strip_uncertainty.model_log_sd", lambda _: 0.0)
    sd = 0.01
    base = changed(Fabric.RIB, certain(), uncertainty=replace(NONE, **{name: sd}))
    law = base.law(Fabric.RIB)
    if model == "published":
        law = law.symmetrised(Symmetrisation.SCRIPT)

    def of_ratio(change: float) -> StripTest:
        nu = {"poisson_yx": law.poisson_yx, "poisson_xy": law.poisson_xy}
        nu[name] += change
        if model == "published":
            nu["poisson_yx"] = nu["poisson_xy"] * law.stiffness_xxxx / law.stiffness_yyyy
        of_changed = changed(Fabric.RIB, base, law=with_poisson(law, **nu))
        options = {"steps": 3, "model": model, "shear_modulus": SHEAR_N_PER_MM}
        return strip_test(HALVES, of_changed, "course", 0.3, **options)

    spread = StripSpread(of_ratio(0.0), base).at(-1)
    assert largest_error(spread, *(of_ratio(step).fields() for step in (sd, -sd))) < 0.01


def test_the_assumed_shear_modulus_counts_and_a_given_one_does_not() -> None:
    base = certain()
    garter = StitchChart.of_fabric("garter", rows=6, columns=8)
    assumed = strip_test(garter, base, "wale", 0.3, steps=2)
    given_one = strip_test(garter, base, "wale", 0.3, steps=2, shear_modulus=SHEAR_N_PER_MM)
    assert StripSpread(assumed, base).at(-1).strain_yy_sd.max() > 0.002
    spread = StripSpread(given_one, base).at(-1)
    assert spread.strain_yy_sd.max() == 0.0
    assert spread.force_log_sd == 0.0
    assert interval_source(given_one.sheet, base) == "Made up."
    assert interval_source(assumed.sheet, base).endswith(
        "; an assumed shear modulus, within a factor of 5."
    )


def doubled(spread: LawUncertainty) -> LawUncertainty:
    """Twice all deviations."""
    curves = [
        CurveUncertainty(*(2 * v for v in astuple(spread.curve(direction))))
        for direction in Direction
    ]
    names = "log_modulus_course", "log_modulus_wale", "poisson_yx", "poisson_xy"
    log_shear = None if spread.log_shear is None else 2 * spread.log_shear
    return LawUncertainty(*(2 * getattr(spread, n) for n in names), "twice", *curves, log_shear)


@settings(max_examples=10)
@given(
    seed=st.integers(0, 2**32 - 1),
    name=st.sampled_from(list(load_library(Laws.PUBLISHED))),
    direction=st.sampled_from(Direction),
    clamps=st.sampled_from(Clamps),
    model=st.sampled_from(["full", "published"]),
)
def test_of_any_chart_twice_the_uncertainty_is_twice_the_interval(
    seed: int, name: str, direction: Direction, clamps: Clamps, model: str
) -> None:
    """The clamps' motion is certain; elsewhere deviations are finite, and linear in the laws'."""
    chart = StitchChart(np.random.default_rng(seed).random((5, 6)) < 0.5)
    base = material(name)
    records = {f: replace(r, uncertainty=doubled(r.uncertainty)) for f, r in base.fabrics.items()}
    double = replace(base, fabrics=records)
    test = strip_test(
        chart, base, direction, 0.2, steps=2, clamps=clamps, model=model, shear_modulus=0.02
    )
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("knitcore.cloth.flat.strip_uncertainty.model_log_sd", lambda _: 0.0)
        once, twice = (StripSpread(test, b, clamps).at(-1) for b in (base, double))
    for name_ in ("strain_xx_sd", "strain_yy_sd", "utilisation_sd"):
        values = getattr(once, name_)
        assert np.isfinite(values).all()
        assert getattr(twice, name_) == pytest.approx(2 * values, rel=1e-9)
    assert once.force_log_sd > 0
    assert twice.force_log_sd == pytest.approx(2 * once.force_log_sd)
    with_model = StripSpread(test, base, clamps).at(-1)
    assert with_model.force_n.low < test.force_n[-1] < with_model.force_n.high
    assert np.all(with_model.strain_yy_sd >= once.strain_yy_sd - 1e-12)


def test_nine_of_ten_tests_of_laws_drawn_from_their_uncertainty_are_inside() -> None:
    test = pulled(ACRYLIC)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("knitcore.cloth.flat.strip_uncertainty.model_log_sd", lambda _: 0.0)
        spread = StripSpread(test, ACRYLIC).at(-1)
    fields = test.fields()
    random = np.random.default_rng(5)
    forces, strains = [], []
    for _ in range(60):
        drawn = {}
        for fabric, record in ACRYLIC.fabrics.items():
            sd = record.uncertainty
            factors = np.exp(random.normal(0, (sd.log_modulus_course, sd.log_modulus_wale)))
            law = record.law
            ratios = np.array([law.poisson_yx, law.poisson_xy])
            log_sd = math.hypot(*(sd.poisson_yx, sd.poisson_xy) / ratios) / 2
            other_law = with_poisson(law, *ratios * (1 + random.normal() * log_sd))
            drawn[fabric] = replace(record, law=scaled(other_law, *factors))
        other = pulled(replace(ACRYLIC, fabrics=drawn))
        forces.append(spread.force_n.low <= other.force_n[-1] <= spread.force_n.high)
        off = np.abs(other.fields().strain_yy - fields.strain_yy)
        moving = spread.strain_yy_sd > 1e-6
        strains.append(np.mean(off[moving] <= Z_SCORE * spread.strain_yy_sd[moving]))
    assert 0.82 <= np.mean(forces) <= 0.98
    assert 0.82 <= np.mean(strains) <= 0.98


def test_the_composites_own_error_is_that_of_predictions() -> None:
    assert model_log_sd(chart_sheet(StitchChart.of_fabric("rib", 4, 4), ACRYLIC)) == 0.0
    small = chart_sheet(StitchChart.parse("KKPP\nPPKK"), ACRYLIC)
    blocks = StitchChart(np.kron([[0, 1], [1, 0]], np.ones((40, 40))) > 0)
    assert 0.05 < model_log_sd(chart_sheet(blocks, ACRYLIC)) < 0.1
    assert model_log_sd(small) > 0.3
    assert "the mixture's own error" in interval_source(small, ACRYLIC)


def test_a_shaped_piece_has_intervals_where_it_has_cloth() -> None:
    stitch = np.ones((6, 10), dtype=bool)
    stitch[2:4, :3] = False
    test = strip_test(HALVES, ACRYLIC, "wale", 0.2, steps=2, stitch=stitch)
    spread = StripSpread(test, ACRYLIC).at(-1)
    used = test.sheet.grid.used_corners.reshape(spread.strain_yy_sd.shape)
    assert np.array_equal(np.isfinite(spread.strain_yy_sd), used)


CLOTHS = ["K", "K/P", "KP", "KP/PK", "KKPP", "K/K/P/P", "KKKKPPPP", "KPKK/KKKP"]


def interval_widths(chart: StitchChart, direction: str, strain: float, scale: float) -> np.ndarray:
    """Logarithm of the force; of the widths of intervals of force, waist and utilisation."""
    acrylic = material("acrylic")
    size = chart_sheet(chart, acrylic).grid
    width, length = scale * size.width_mm, scale * size.length_mm
    test = strip_test(chart, acrylic, direction, strain, steps=2, width_mm=width, length_mm=length)
    spread = StripSpread(test, acrylic).at(-1)
    values = [test.stress_n_per_mm[-1], spread.waist_sd, np.nanmean(spread.utilisation_sd)]
    return np.append(np.log(values), 2 * Z_SCORE * spread.force_log_sd)


@given(
    cloth=st.sampled_from(CLOTHS),
    side=st.integers(10, 13),
    direction=st.sampled_from(list(Direction)),
    strain=st.floats(0.03, 0.2),
    change=st.sampled_from(["strain", "gauge", "stitch", "row"]),
)
@settings(max_examples=6)
def test_intervals_change_as_little_as_what_they_are_about(
    cloth: str, side: int, direction: Direction, strain: float, change: str
) -> None:
    """3 % more strain or gauge, one stitch or one row more."""
    chart = StitchChart.parse(cloth).resized(side, side)
    changed = {
        "row": StitchChart.parse(cloth).resized(side + 1, side),
        "stitch": flipped(chart, side // 2, side // 2),
    }
    before = interval_widths(chart, direction, strain, 1.0)
    strain *= 1.03 if change == "strain" else 1.0
    gauge = 1.03 if change == "gauge" else 1.0
    after = interval_widths(changed.get(change, chart), direction, strain, gauge)
    force, *widths = np.abs(after - before)
    most = {"strain": 0.1, "gauge": 0.02, "stitch": 31 / side**2, "row": 0.15}[change]
    assert max(widths) < most + force


@pytest.mark.parametrize("rows", [16, 32])
def test_a_patch_more_does_not_change_the_interval_of_the_force(rows: int) -> None:
    """A ribbed hem below seed stitch, at the sizes from which a chart has one patch more."""
    hem, body = (StitchChart.parse(text).resized(rows // 3, rows) for text in ("KKPP", "KP/PK"))
    widths = []
    for more in (0, 1):
        above = body.resized(rows + more - rows // 3, rows).purl
        widths.append(interval_widths(StitchChart([*hem.purl, *above]), "wale", 0.1, 1.0)[-1])
    assert abs(widths[1] - widths[0]) < 0.25
