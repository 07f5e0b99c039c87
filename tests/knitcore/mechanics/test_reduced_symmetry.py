"""The RS model against its 16 published values (tables 17 and 18)."""

import math

import numpy as np
import pytest

from knitcore import Direction, Fabric, InputError
from knitcore.mechanics.elastica import Parity
from knitcore.mechanics.reduced_symmetry import (
    SegmentGeometry,
    rs_fabric,
    rs_fabrics,
    stitch_modulus_n_per_mm,
)
from tests.knitcore.refusals import refuses

ODD_RATIOS = {
    ("acrylic", "garter", "wale"): 0.834,
    ("acrylic", "rib", "course"): 1.026,
    ("acrylic", "seed", "course"): 1.240,
    ("acrylic", "seed", "wale"): 1.582,
    ("cotton", "garter", "wale"): 0.852,
    ("cotton", "rib", "course"): 1.015,
    ("cotton", "seed", "course"): 1.310,
    ("cotton", "seed", "wale"): 1.409,
}


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("fabric", Fabric)
@pytest.mark.parametrize("material", ["acrylic", "cotton"])
def test_odd_values_are_derived_and_stand_beside_the_published(material, fabric, direction):
    """Even values are reproduced."""
    segment = rs_fabrics(material)[fabric].segment(direction)
    odd = fabric.course_odd if direction is Direction.COURSE else fabric.wale_odd
    ratio = segment.modulus_n_per_mm / segment.published_n_per_mm
    expected = ODD_RATIOS[material, fabric, direction] if odd else 1.0
    assert ratio == pytest.approx(expected, rel=2e-3 if odd else 0.006)


def test_the_misprinted_separation_is_corrected():
    geometry = rs_fabrics("acrylic")[Fabric.STOCKINETTE].wale.geometry
    assert geometry.separation_mm == 3.550
    assert geometry.length_mm == pytest.approx(5.289, rel=2e-4)


def test_odd_rigidity_is_the_curvature_of_the_rotational_energy():
    """E = 6 B v²/lambda with v = sin(psi - phi); d²E/d(lambda cos phi)² at fixed lambda, to lowest
    order in v, with L in place of lambda as in the paper."""
    lam, phi, psi, bending = 4.0, 0.8, 0.81, 0.045

    def energy(angle):
        return 6 * bending * math.sin(psi - angle) ** 2 / lam

    def angle(reach):
        return math.acos(reach / lam)

    reach, step = lam * math.cos(phi), 1e-4
    curvature = (
        energy(angle(reach + step)) - 2 * energy(phi) + energy(angle(reach - step))
    ) / step**2
    segment = SegmentGeometry(Parity.ODD, lam, lam, math.sin(psi - phi), phi)
    assert segment.rigidity_n_per_mm(bending) == pytest.approx(curvature, rel=1e-3)


def test_assembly():
    assert stitch_modulus_n_per_mm(Direction.COURSE, Parity.EVEN, 3.0) == 1.5
    assert stitch_modulus_n_per_mm(Direction.COURSE, Parity.ODD, 3.0) == 3.0
    assert stitch_modulus_n_per_mm(Direction.COURSE, Parity.ODD, 3.0, 6.0) == pytest.approx(2.0)
    assert stitch_modulus_n_per_mm(Direction.WALE, Parity.ODD, 3.0) == 6.0


def test_geometry_of_one_s_own():
    even = SegmentGeometry(Parity.EVEN, 2.2, 4.1, 1.0)
    odd = SegmentGeometry(Parity.ODD, 3.5, 4.0, 0.7, 0.75)
    garter = rs_fabric(Fabric.GARTER, even, odd, 0.045)
    assert garter.modulus_course_n_per_mm == pytest.approx(90 * 0.045 / (4.1 * 2.2**2))
    assert garter.wale.published_n_per_mm is None
    doubled = rs_fabric(Fabric.GARTER, even, odd, 0.09)
    assert doubled.modulus_wale_n_per_mm == pytest.approx(2 * garter.modulus_wale_n_per_mm)
    with pytest.raises(InputError, match="has even segments"):
        rs_fabric(Fabric.STOCKINETTE, even, odd, 0.045)


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ((Parity.EVEN, 0.0, 4.0, 1.0), "separation_mm"),
        ((Parity.EVEN, 2.0, float("nan"), 1.0), "length_mm"),
        ((Parity.EVEN, 2.0, 4.0, 0.0), "slope"),
        ((Parity.ODD, 2.0, 4.0, 1.0), "angle_rad"),
        ((Parity.ODD, 2.0, 4.0, 1.0, 0.0), "angle_rad"),
    ],
)
def test_impossible_geometry_is_refused(arguments, field):
    with refuses(field):
        SegmentGeometry(*arguments)


def test_other_yarns_and_bending_moduli_are_refused():
    with pytest.raises(InputError, match="acrylic or cotton"):
        rs_fabrics("lace-bamboo")
    with pytest.raises(InputError, match="above 0"):
        SegmentGeometry(Parity.EVEN, 2.2, 4.1, 1.0).rigidity_n_per_mm(0.0)


def test_an_arch_is_measured():
    """A circular arc of 1 rad: chord 2 R sin ½, length R, end slope sin ½."""
    angle = np.linspace(-0.5, 0.5, 400)
    curve = 3.0 * np.column_stack([np.sin(angle), np.cos(angle)])
    arch = SegmentGeometry.from_curve(Parity.EVEN, curve)
    assert arch.separation_mm == pytest.approx(6 * math.sin(0.5))
    assert arch.length_mm == pytest.approx(3.0, rel=1e-5)
    assert arch.slope == pytest.approx(math.sin(0.5), rel=1e-4)
    assert arch.angle_rad is None
    # yarn across the pull counts for the length only
    slanted = SegmentGeometry.from_curve(Parity.EVEN, np.column_stack([curve, 4.0 * angle]))
    assert slanted.length_mm == pytest.approx(5.0, rel=1e-5)
    assert (slanted.separation_mm, slanted.slope) == (arch.separation_mm, arch.slope)


@pytest.mark.parametrize("flip", [(1, 1), (-1, 1), (1, -1), (-1, -1)])
def test_an_s_curve_is_measured_from_any_side(flip):
    """z = x + a sin(2 pi x): chord at 45 degrees, ends steeper than it."""
    x = np.linspace(0, 1, 2000)
    amplitude = 0.1
    curve = np.column_stack([x, x + amplitude * np.sin(2 * np.pi * x)]) * flip
    segment = SegmentGeometry.from_curve(Parity.ODD, curve)
    rise = 1 + 2 * np.pi * amplitude
    assert segment.angle_rad == pytest.approx(math.pi / 4)
    assert segment.separation_mm == pytest.approx(math.sqrt(2))
    assert segment.slope == pytest.approx(math.sin(math.atan(rise)), rel=1e-3)
    assert segment.length_mm > segment.separation_mm


def test_curves_that_are_not_segments_are_refused():
    for bad in (np.zeros((3, 2)), np.zeros((9, 4)), np.zeros((9, 2)), np.eye(9)[:, :2] * np.nan):
        with pytest.raises(InputError, match="curve_mm"):
            SegmentGeometry.from_curve(Parity.EVEN, bad)
