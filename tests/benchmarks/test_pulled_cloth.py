"""Strips of cloth that is known from pulls, against the library's laws."""

import numpy as np
import pytest

from benchmarks.pulled_cloth import SHARES, PulledCloth, Strip
from knitcore.fabric import Direction, Fabric
from knitcore.law.uniaxial import free_transverse_strains
from knitcore.materials import material
from knitcore.swatch.measured_strip import MeasuredStrip

LAW = material("acrylic").law(Fabric.STOCKINETTE)
LENGTH_MM, WIDTH_MM = 70.0, 60.0
STRAINS = np.linspace(0.0, 0.6, 7)[1:] * LAW.lock_up_strain(Direction.COURSE)


@pytest.fixture(scope="module")
def cloth():
    """What pulls of the law's fabric along its rows would show."""
    strain = np.linspace(0.0, 0.75, 40) * LAW.lock_up_strain(Direction.COURSE)
    across = free_transverse_strains(LAW, Direction.COURSE, strain)
    shares = np.array(SHARES)
    pulls = [np.array(LAW.stress(strain, share * across))[:2].T for share in shares]
    return PulledCloth.of_stresses(
        strain, across, shares, np.stack(pulls, axis=1), LAW.shear_modulus
    )


def readings(strip, strains):
    return np.array([reading[1:] for reading in strip.pull(strains)]).T


def test_a_strip_whose_ends_slide_strains_evenly(cloth):
    strip = Strip(cloth, LENGTH_MM, WIDTH_MM, cells=3, clamped=False)
    stress, waist = readings(strip, STRAINS)
    across = free_transverse_strains(LAW, Direction.COURSE, STRAINS)
    np.testing.assert_allclose(stress, LAW.stress(STRAINS, across)[0], rtol=1e-4)
    np.testing.assert_allclose(waist, across, rtol=1e-4)


def test_a_clamped_strip_is_that_of_the_law(cloth):
    unread = np.zeros((1, len(STRAINS)))
    strip = MeasuredStrip(Direction.COURSE, WIDTH_MM, LENGTH_MM, STRAINS, unread, unread)
    stress, waist = readings(Strip(cloth, LENGTH_MM, WIDTH_MM), STRAINS)
    known, narrowing = strip.simulate(LAW, cells=30)
    np.testing.assert_allclose(stress, known, rtol=0.005)
    np.testing.assert_allclose(waist, narrowing, atol=0.001)


def test_derivatives_agree_with_differences(cloth):
    rng = np.random.default_rng(3)
    fibres = np.array([1.3, 0.05, -0.1, 0.9]) + 0.05 * rng.standard_normal((5, 4))
    _, tangent = cloth.respond(fibres)
    step = 1e-6 * np.eye(4)
    columns = [(cloth.respond(fibres + s)[0] - cloth.respond(fibres - s)[0]) / 2e-6 for s in step]
    np.testing.assert_allclose(tangent, np.stack(columns, axis=2), atol=1e-7)


def test_near_rest_the_cloth_is_linear_in_any_direction(cloth):
    along, across = 1e-5 * np.array([[1.0, -1.0, 0.0, 0.5], [0.0, 0.3, 1.0, 0.8]])
    found, _ = cloth.at(along, across)
    known = np.array(LAW.stress(along, across))[:2].T
    np.testing.assert_allclose(found, known, rtol=0.02, atol=1e-9)
