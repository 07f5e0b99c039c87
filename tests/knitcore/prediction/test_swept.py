"""Charts that were themselves simulated: sweeps, and sizes of a relaxation."""

import math

import numpy as np
import pytest

from knitcore import Direction, Fabric, RelaxedSize, StitchChart, predict
from knitcore.materials import Material, material
from knitcore.prediction.densities import densities
from knitcore.prediction.learned import packaged_model
from knitcore.prediction.mixture import Mixture
from knitcore.prediction.size import KnownBy
from knitcore.prediction.swept import (
    MAX_STITCHES,
    STRESS,
    of_law,
    size_from_relaxation,
    swept_chart,
    worth_relaxing,
)
from knitcore.yarn.library.store import StoredStitch, stored_stitch
from scripts.training.learned import simulated_materials


@pytest.fixture(scope="module")
def simulated() -> Material:
    """Acrylic made of the store's own pure fabrics."""
    return simulated_materials()["acrylic"]


def _stored(text: str) -> StoredStitch:
    return stored_stitch(StitchChart.parse(text), "acrylic")


@pytest.mark.parametrize("text", ["KKPP", "K/K/P", "KP/KK", "KKPP/PPKK"])
def test_a_simulated_material_answers_like_its_sweep(text: str, simulated: Material) -> None:
    """Strains within 5 %: the answer goes through six stresses of the curve."""
    stored = _stored(text)
    size = stored.cell_course_mm, stored.cell_wale_mm
    sweep = swept_chart(stored.chart, size, stored.law, simulated.fabrics, simulated)
    prediction = predict(stored.chart, simulated, swept=sweep)
    assert prediction.provenance == "swept"
    assert (prediction.relaxed_course_mm, prediction.relaxed_wale_mm) == pytest.approx(size)
    strains, _ = of_law(stored.law)
    for direction, strain in zip(Direction, strains, strict=True):
        along = prediction.along(direction)
        np.testing.assert_allclose(along.strain(STRESS)[4:], strain[4:], rtol=0.05)
        low, high = along.strain_interval(0.05)
        assert low < along.strain(0.05) < high


def test_a_simulated_material_finds_the_packaged_sweep(simulated: Material) -> None:
    """And no other material does; with a gauge its stretch starts at that size."""
    chart = StitchChart.parse("KP/KK")
    stored = _stored("KP/KK")
    prediction = predict(chart, simulated)
    assert prediction.provenance == "swept"
    assert prediction.relaxed_course_mm == pytest.approx(stored.cell_course_mm, rel=0.02)
    assert predict(StitchChart.parse("KP/KK"), material("acrylic")).provenance == "learned"
    assert packaged_model().sweep_of(chart, material("lace-bamboo")) is None
    known = predict(chart, simulated, RelaxedSize(3.0, 2.0))
    assert known.relaxed_course_mm == 3.0
    assert known.course.strain(0.05) != pytest.approx(prediction.course.strain(0.05), rel=0.01)


@pytest.mark.parametrize("text", ["KKPP", "K/K/P/P", "KKPP/KKPP/PPKK/PPKK"])
def test_knitted_fabric_folds_less_than_its_sweep_as_the_learned_answer_does(text: str) -> None:
    chart, acrylic = StitchChart.parse(text), material("acrylic")
    sweep = packaged_model().sweep_of(chart, acrylic)
    swept, learned = predict(chart, acrylic, swept=sweep), predict(chart, acrylic)
    assert swept.provenance == "swept"
    flat = Mixture.of(densities(chart).shares, acrylic).size_mm
    for direction in Direction:
        own, other = swept.along(direction), learned.along(direction)
        fold = np.log(own.relaxed_mm / flat[direction.axis])
        assert abs(fold) <= abs(sweep.folding[direction.axis])
        assert own.relaxed_mm == pytest.approx(other.relaxed_mm, rel=0.06)
        assert own.strain(0.1) == pytest.approx(other.strain(0.1), rel=0.35)


def _from_relaxation(text: str, of: Material) -> RelaxedSize:
    stored = _stored(text)
    pure = {f: _stored(StitchChart.of_fabric(f).repeat().key) for f in Fabric}
    pure_mm = {f: (cell.cell_course_mm, cell.cell_wale_mm) for f, cell in pure.items()}
    cell_mm = stored.cell_course_mm, stored.cell_wale_mm
    return size_from_relaxation(stored.chart, of, cell_mm, pure_mm)


@pytest.mark.parametrize("text", ["KKPP", "K/K/P", "KP/KK", "KKPP/PPKK"])
def test_a_material_of_the_yarn_levels_fabrics_takes_its_size(
    text: str, simulated: Material
) -> None:
    relaxed, stored = _from_relaxation(text, simulated), _stored(text)
    size = stored.cell_course_mm, stored.cell_wale_mm
    assert (relaxed.course_mm, relaxed.wale_mm) == pytest.approx(size)


def test_measured_cloth_takes_only_a_part_of_the_fold() -> None:
    """A 2×2 rib narrows less, against the mixture of its fabrics, than on the yarn level."""
    acrylic, chart = material("acrylic"), StitchChart.parse("KKPP")
    flat = (acrylic.record("stockinette").stitch_mm[0] + acrylic.record("rib").stitch_mm[0]) / 2
    stored, pure = _stored("KKPP"), (_stored("K"), _stored("KP"))
    whole = stored.cell_course_mm / sum(cell.cell_course_mm / 2 for cell in pure)
    part = _from_relaxation("KKPP", acrylic).course_mm / flat
    assert whole < part < 1
    assert predict(chart, acrylic).relaxed_course_mm == pytest.approx(part * flat, rel=0.05)


def test_it_makes_the_stretch_of_a_simulated_material_more_certain() -> None:
    chart, of = StitchChart.parse("KPPK/KKPK/PKKP"), material("acrylic:simulation")
    learned = predict(chart, of)
    size = learned.relaxed_course_mm, learned.relaxed_wale_mm
    sd = _from_relaxation("KP/KK", of).log_sd  # that of another chart of the same kind
    known = predict(chart, of, RelaxedSize(*size, sd, KnownBy.RELAXATION))
    assert (known.provenance, known.relaxed_source) == ("learned with known size", "relaxation")
    assert known.size_is_known
    assert "simulation of the yarn" in " ".join(known.notes)
    for direction in Direction:
        (low, high), (least, most) = (
            each.along(direction).strain_interval(0.05) for each in (known, learned)
        )
        assert math.log(high / low) < 0.9 * math.log(most / least)
        assert (
            known.along(direction).relaxed_log_sd < 0.95 * learned.along(direction).relaxed_log_sd
        )


@pytest.mark.parametrize(
    ("text", "of", "worth"),
    [
        ("KPPK/KKPK/PKKP", "acrylic:simulation", True),
        ("KPPK/KKPK/PKKP", "acrylic", False),  # measured
        ("KP/KK", "acrylic:simulation", False),  # swept
        ("KP/PK", "acrylic:simulation", False),  # pure
    ],
)
def test_only_learned_answers_of_simulated_materials_are_worth_it(
    text: str, of: str, worth: bool
) -> None:
    yarn, repeat = material(of), StitchChart.parse(text)
    swatch = repeat.resized(3 * repeat.rows - 1, 2 * repeat.columns + 1)  # cuts its repeat
    to_relax = worth_relaxing(swatch, yarn, predict(swatch, yarn))
    assert to_relax == (repeat if worth else None)


def test_large_repeats_and_known_sizes_are_not() -> None:
    yarn, repeat = material("acrylic:simulation"), StitchChart.parse("KPPK/KKPK/PKKP")
    wide = StitchChart.parse("K" * MAX_STITCHES + "P" + "/" + "K" * (MAX_STITCHES + 1))
    assert worth_relaxing(wide, yarn, predict(wide, yarn)) is None
    assert worth_relaxing(repeat, yarn, predict(repeat, yarn, RelaxedSize(3, 2))) is None
