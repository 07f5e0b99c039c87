"""A yarn that is not in the library: how well left-out yarns are predicted, and what is warned."""

import math
from dataclasses import asdict, replace
from itertools import combinations
from typing import Any

import numpy as np
import pytest

from knitcore import Direction, Fabric, InputError, material
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials.estimate.estimate import MeasuredSwatch, estimate_yarn
from knitcore.materials.estimate.yarn_statistics import left_out, library_table

STOCKINETTE = (Fabric.STOCKINETTE,)


def cotton_swatch(**changes: Any) -> MeasuredSwatch:
    record = material("cotton:published").record(Fabric.STOCKINETTE)
    given = {"fabric": record.fabric, "law": record.law, "loop_length_mm": 12.28}
    return MeasuredSwatch(**(given | changes))


def cotton_loops() -> dict[Fabric, float]:
    return {f: material("cotton:published").record(f).loop_length_mm or 0.0 for f in Fabric}


def test_left_out_yarns_are_predicted_as_well_as_the_notes_say() -> None:
    """Leave one of eight yarns out: rms factors 2.14 with nothing measured, 1.52 with one
    stockinette swatch, 1.38 with stockinette and rib; 1.3 on the extension under load."""
    none, plain, both = left_out(()), left_out(STOCKINETTE), left_out((*STOCKINETTE, Fabric.RIB))
    assert none.modulus_rms_factor == pytest.approx(2.14, abs=0.01)
    assert plain.modulus_rms_factor == pytest.approx(1.52, abs=0.01)
    assert plain.modulus_median_factor == pytest.approx(1.26, abs=0.02)
    assert plain.modulus_within_two > 0.8
    assert both.modulus_rms_factor == pytest.approx(1.38, abs=0.01)
    assert plain.strain_rms_factor == pytest.approx(1.27, abs=0.02)


@pytest.mark.slow
def test_ninety_percent_intervals_cover_85_to_95() -> None:
    """Calibrated without the yarn that they should cover; of the values of all swatches that a user
    may have knitted, up to two. Of a single choice there are only 32 to 64 values.
    """
    choices = [c for n in range(3) for c in combinations(Fabric, n)]
    errors = [left_out(measured) for measured in choices]
    for coverage in ("modulus_coverage", "strain_coverage"):
        shares = [getattr(each, coverage) for each in errors]
        assert 0.85 <= np.average(shares, weights=[each.values for each in errors]) <= 0.95
        assert min(shares) >= 0.84


def test_the_refitted_constants_are_those_of_the_notes() -> None:
    constant = np.exp(library_table().modulus.mean(axis=0))
    expected = [[3242, 16632], [2805, 2663], [817, 9001], [3459, 4339]]
    assert constant == pytest.approx(np.array(expected), rel=0.003)


def test_the_measured_fabric_keeps_its_law() -> None:
    estimate = estimate_yarn(0.0708, cotton_loops(), [cotton_swatch()])
    stockinette = estimate.fabrics[Fabric.STOCKINETTE]
    assert stockinette.measured
    assert stockinette.law == cotton_swatch().law
    interval = stockinette.modulus[Direction.WALE]
    assert interval.low == interval.value == interval.high


def test_intervals_enclose_their_value_and_narrow_with_a_swatch() -> None:
    without = estimate_yarn(0.0708, cotton_loops())
    measured = estimate_yarn(0.0708, cotton_loops(), [cotton_swatch()])
    for direction in Direction:
        wide = without.fabrics[Fabric.RIB].modulus[direction]
        narrow = measured.fabrics[Fabric.RIB].modulus[direction]
        assert wide.low < wide.value < wide.high
        assert narrow.high / narrow.low < wide.high / wide.low


def test_the_extension_is_the_laws() -> None:
    garter = estimate_yarn(0.02, 9.0).fabrics[Fabric.GARTER]
    for direction in Direction:
        strain = free_strains_at_stress(garter.law, direction, 0.1)
        assert garter.strain_at_load[direction].value == pytest.approx(strain)


@pytest.mark.parametrize("factor", [0.25, 4.0])
def test_moduli_scale_with_the_bending_modulus(factor: float) -> None:
    yarn, stiffer = estimate_yarn(0.02, 9.0), estimate_yarn(0.02 * factor, 9.0)
    for fabric in Fabric:
        ratio = stiffer.fabrics[fabric].law.modulus_wale / yarn.fabrics[fabric].law.modulus_wale
        assert ratio == pytest.approx(factor)


def test_a_stiffer_swatch_means_a_stiffer_yarn() -> None:
    law = cotton_swatch().law
    doubled = {n: 2.0 * value for n, value in asdict(law).items() if n.startswith("stiffness")}
    plain = estimate_yarn(0.0708, cotton_loops(), [cotton_swatch()])
    stiffer = estimate_yarn(0.0708, cotton_loops(), [cotton_swatch(law=replace(law, **doubled))])
    for fabric in (Fabric.GARTER, Fabric.RIB, Fabric.SEED):
        ratio = (
            stiffer.fabrics[fabric].law.modulus_course / plain.fabrics[fabric].law.modulus_course
        )
        assert ratio == pytest.approx(2 ** (0.752 + 0.097), rel=0.01)  # drawn towards the mean


def test_another_setting_is_warned_of() -> None:
    swatch = cotton_swatch(setting="2.0 mm needles")
    same = estimate_yarn(0.07, cotton_loops(), [swatch], product_setting="2.0 mm needles ")
    other = estimate_yarn(0.07, cotton_loops(), [swatch], product_setting="2.75 mm needles")
    assert not same.warnings
    assert any("another tightness" in w for w in other.warnings)


def test_other_loops_and_a_yarn_unlike_the_library_are_warned_of() -> None:
    swatch = cotton_swatch(loop_length_mm=9.8)
    for estimate, warning in (
        (estimate_yarn(0.07, cotton_loops(), [swatch]), "yarn per stitch"),
        (estimate_yarn(1.0, 5.0), "outside the range"),
        (estimate_yarn(0.02, 9.0), "No swatch"),
    ):
        assert any(warning in text for text in estimate.warnings)


def test_stitches_get_a_plausible_size() -> None:
    """Cotton's stitch areas, 7 to 12 mm² (table 5)."""
    cotton = estimate_yarn(0.0708, cotton_loops())
    for fabric, estimate in cotton.fabrics.items():
        area = estimate.stitch_course_mm * estimate.stitch_wale_mm
        truth = material("cotton:published").record(fabric)
        assert abs(math.log(area / truth.stitch_course_mm / truth.stitch_wale_mm)) < 0.6


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((math.nan, 9.0), "bending_modulus"),
        ((45.0, 9.0), "bending_modulus"),
        ((0.02, 0.9), "loop_length_mm"),
        ((0.02, {Fabric.RIB: 9.0}), "stockinette, garter, seed"),
        ((0.07, 12.0, [cotton_swatch(), cotton_swatch()]), "twice"),
        ((0.07, 12.0, [cotton_swatch(loop_length_mm=0.0)]), "loop_length_mm"),
    ],
)
def test_bad_input_names_the_field(arguments: Any, says: str) -> None:
    with pytest.raises(InputError, match=says):
        estimate_yarn(*arguments)


def test_something_must_be_left_out() -> None:
    with pytest.raises(InputError, match="all fabrics"):
        left_out(tuple(Fabric))
