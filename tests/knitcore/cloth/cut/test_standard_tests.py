"""Bias, biaxial and trellis tests."""

import math
from functools import partial

import numpy as np
import pytest

from knitcore import Fabric, StitchChart, material, strip_test
from knitcore.cloth.cut import CutPiece, cloth_under
from knitcore.cloth.cut.standard_tests import bias_test, biaxial_test, trellis_test
from knitcore.cloth.flat.strip_uncertainty import StripSpread
from tests.knitcore.refusals import refuses

ACRYLIC = material("acrylic")
LAW = ACRYLIC.law(Fabric.STOCKINETTE)
KNIT = StitchChart.parse("K")
framed = partial(trellis_test, KNIT, ACRYLIC, side_mm=60.0, steps=1, mesh_mm=20.0)


def test_a_strip_along_the_columns_is_the_strip_test() -> None:
    chart = StitchChart.of_fabric("garter", rows=10, columns=16)
    swatch = strip_test(chart, ACRYLIC, "wale", 0.4, steps=2)
    size = {"width_mm": swatch.width_mm, "length_mm": swatch.length_mm}
    test = bias_test(chart, ACRYLIC, 0.4, angle_deg=0.0, steps=2, mesh_mm=3.0, **size)
    assert test.force_n == pytest.approx(swatch.force_n, rel=1e-3)
    assert test.waist_strain == pytest.approx(swatch.waist_strain, abs=1e-3)
    spread = [StripSpread(swatch, ACRYLIC).at(step).force_log_sd for step in range(2)]
    assert test.force_log_sd == pytest.approx(spread, rel=0.02)


def test_biaxial_stresses_are_those_of_the_law() -> None:
    test = biaxial_test(
        KNIT, ACRYLIC, 0.3, 0.1, width_mm=50.0, length_mm=60.0, steps=2, mesh_mm=20.0
    )
    course, wale = (
        cloth_under(CutPiece.rectangle(50.0, 60.0), KNIT, ACRYLIC)
        .sheet.laws[0]
        .stress(test.strain_x, test.strain_y)
    )
    assert test.stress_x_n_per_mm == pytest.approx(course, rel=1e-6)
    assert test.stress_y_n_per_mm == pytest.approx(wale, rel=1e-6)


def test_a_frame_along_the_rows_shears_without_stretching_yarn() -> None:
    frame = framed(0.5, steps=2)
    grown = 1 + LAW.shear_stiffening * frame.shear_angle**2
    shear = LAW.shear_modulus * frame.shear_angle * grown
    assert frame.shear_stress_n_per_mm == pytest.approx(shear, rel=1e-6)
    assert np.abs(frame.test.fields().strain_course).max() < 1e-8


def test_a_frame_measures_the_shear_modulus() -> None:
    frame = framed(0.01)
    stress = frame.shear_stress_n_per_mm[-1]
    assert LAW.shear_stiffening == 4.0
    assert stress / 0.01 == pytest.approx(LAW.shear_modulus * (1 + 4.0 * 0.01**2), rel=1e-4)
    # pulled at the corners of a square frame, force = shear stress * side * sqrt(2)
    assert frame.force_n[-1] == pytest.approx(math.sqrt(2) * 60.0 * stress, rel=1e-2)
    double = framed(0.01, shear_modulus=2 * LAW.shear_modulus)
    assert double.force_n[-1] == pytest.approx(2 * frame.force_n[-1], rel=1e-6)
    log_sd = ACRYLIC.record(Fabric.STOCKINETTE).uncertainty.log_shear
    assert frame.force_log_sd[-1] == pytest.approx(log_sd, rel=1e-3)


def test_a_frame_at_45_degrees_stretches_the_yarn_instead() -> None:
    across = framed(0.2, grain_deg=45.0)
    along = framed(0.2)
    assert across.force_n[-1] != pytest.approx(along.force_n[-1], rel=0.05)
    assert np.abs(across.test.fields().strain_course).max() > 0.09


def test_a_bias_strip_is_softer_and_narrows_more_the_softer_its_shear() -> None:
    tests = [
        bias_test(KNIT, ACRYLIC, 0.2, steps=2, mesh_mm=10.0, shear_modulus=g) for g in (0.003, 0.03)
    ]
    assert tests[0].force_n[-1] < 0.6 * tests[1].force_n[-1]
    assert tests[0].waist_strain[-1] < tests[1].waist_strain[-1] < 0


def test_opposite_angles_pull_sideways_the_opposite_way() -> None:
    a, b = (
        bias_test(KNIT, ACRYLIC, 0.2, angle_deg=angle, steps=1, mesh_mm=12.5) for angle in (30, -30)
    )
    assert a.force_n[-1] == pytest.approx(b.force_n[-1], rel=1e-9)
    assert a.sideways_n[-1] == pytest.approx(-b.sideways_n[-1], rel=1e-6)
    assert abs(a.sideways_n[-1]) > 0.01 * a.force_n[-1]


@pytest.mark.parametrize(
    ("field", "make"),
    [
        ("strain", lambda: bias_test(KNIT, ACRYLIC, 0.0)),
        ("strain", lambda: bias_test(KNIT, ACRYLIC, 1e-300)),
        ("strain", lambda: bias_test(KNIT, ACRYLIC, 3.0, angle_deg=0.0)),
        ("strain_x", lambda: biaxial_test(KNIT, ACRYLIC, 0.0, 0.0)),
        ("strain_x", lambda: biaxial_test(KNIT, ACRYLIC, 1e-300, 0.0)),
        ("strain_x", lambda: biaxial_test(KNIT, ACRYLIC, 4.0, 0.1)),
        ("strain_y", lambda: biaxial_test(KNIT, ACRYLIC, 0.1, -0.1)),
        ("shear_angle", lambda: trellis_test(KNIT, ACRYLIC, 1e-300)),
        ("shear_angle", lambda: trellis_test(KNIT, ACRYLIC, 1.5)),
    ],
)
def test_impossible_tests_are_refused(field: str, make: object) -> None:
    with refuses(field):
        make()  # type: ignore[operator]
