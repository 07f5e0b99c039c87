"""Elastica energies of segments: series, identities, limits and derivatives."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore.base.errors import InputError
from knitcore.mechanics.elastica import (
    EnergyForm,
    Parity,
    energy_function,
    high_tension_energy,
    rest_separation_mm,
    segment_energy,
    segment_force,
    segment_stiffness,
    tension_parameter,
)

parities = st.sampled_from(Parity)
slopes = st.floats(0.05, 1.0)
excesses = st.floats(0.01, 0.9)


@pytest.mark.parametrize("q", [0.3, 0.8, 2.0, 15.0])
def test_functions_are_those_of_the_paper(q):
    even = q / math.tanh(q)
    odd = q**2 * math.sinh(q) / (q * math.cosh(q) - math.sinh(q))
    assert energy_function(Parity.EVEN, q**2)[0] == pytest.approx(even, rel=1e-12)
    assert energy_function(Parity.ODD, q**2)[0] == pytest.approx(odd, rel=1e-11)


@given(parities, st.floats(-9.0, 200.0))
def test_derivatives_agree_with_differences(parity, tension):
    step = 1e-4
    low, high = (energy_function(parity, tension + s) for s in (-step, step))
    _, slope, curvature = energy_function(parity, tension)
    # Towards the even pole at -9.87 the function bends sharply.
    assert (high[0] - low[0]) / (2 * step) == pytest.approx(slope, rel=1e-5)
    assert (high[1] - low[1]) / (2 * step) == pytest.approx(curvature, rel=1e-5)
    assert slope > 0 > curvature


@pytest.mark.parametrize(
    ("parity", "first", "second"), [(Parity.EVEN, 1 / 3, -1 / 45), (Parity.ODD, 1 / 5, -1 / 175)]
)
def test_series_is_the_paper_s(parity, first, second):
    f, slope, curvature = energy_function(parity, 0.0)
    assert (f, slope, curvature / 2) == pytest.approx((parity.order, first, second), rel=1e-14)


@pytest.mark.parametrize("parity", Parity)
def test_series_and_closed_form_meet(parity):
    below, above = (energy_function(parity, q) for q in (0.5 - 1e-12, 0.5 + 1e-12))
    assert below == pytest.approx(above, rel=1e-11)


@given(parities, slopes, excesses)
def test_the_tension_holds_the_length(parity, slope, excess):
    tension = tension_parameter(parity, slope, excess)
    assert slope**2 * energy_function(parity, tension)[1] == pytest.approx(2 * excess, rel=1e-8)


@given(slopes, st.floats(1.05, 1.6), st.floats(0.5, 5.0))
def test_quartic_energies_are_the_paper_s(slope, ratio, separation):
    x, v2, bending = ratio - 1, slope**2, 0.045
    scale = 2 * bending / separation
    even = scale * (9 / 4 * v2 + 45 / v2 * x * (x - v2 / 3))
    odd = scale * (19 / 4 * v2 + 175 / v2 * x * (x - v2 / 5))
    args = (slope, separation, separation * ratio, bending, EnergyForm.QUARTIC)
    assert segment_energy(Parity.EVEN, *args) == pytest.approx(even, rel=1e-9, abs=1e-12)
    assert segment_energy(Parity.ODD, *args) == pytest.approx(odd, rel=1e-9, abs=1e-12)


@given(parities, st.floats(0.2, 1.0), st.floats(0.02, 0.4))
def test_force_and_stiffness_are_derivatives_of_the_energy(parity, slope, excess):
    length, bending = 5.0, 0.045
    separation = length / (1 + excess)
    step = 1e-4
    energies = [
        segment_energy(parity, slope, separation + s, length, bending) for s in (-step, 0, step)
    ]
    force = segment_force(parity, slope, separation, length, bending)
    stiffness = segment_stiffness(parity, slope, separation, length, bending)
    scale = abs(energies[1]) / separation
    assert (energies[2] - energies[0]) / (2 * step) == pytest.approx(
        force, rel=1e-3, abs=1e-5 * scale
    )
    low, high = (
        segment_force(parity, slope, separation + s, length, bending) for s in (-step, step)
    )
    assert (high - low) / (2 * step) == pytest.approx(stiffness, rel=1e-3, abs=1e-4 * scale)


@given(parities, slopes)
def test_no_force_at_the_rest_separation(parity, slope):
    separation = rest_separation_mm(parity, slope, 4.0)
    energy = segment_energy(parity, slope, separation, 4.0, 0.045)
    force = segment_force(parity, slope, separation, 4.0, 0.045)
    assert abs(force) < 1e-7 * energy
    assert segment_stiffness(parity, slope, separation, 4.0, 0.045) > 0


@pytest.mark.parametrize("parity", Parity)
def test_rest_separation_to_lowest_order(parity):
    """lambda*/L = 1 - v²/6 (even), 1 - v²/10 (odd), with an error of order v⁴."""
    lowest = {Parity.EVEN: 6, Parity.ODD: 10}[parity]
    errors = [rest_separation_mm(parity, v, 1.0) - (1 - v**2 / lowest) for v in (0.1, 0.2)]
    assert errors[1] / errors[0] == pytest.approx(16, rel=0.15)


@pytest.mark.parametrize("parity", Parity)
def test_stiffness_at_rest_for_small_slopes(parity):
    """180 B / (v² L lambda²) for even, 700 B / (v² L lambda²) for odd segments."""
    v, length, bending = 0.02, 3.0, 0.045
    separation = rest_separation_mm(parity, v, length)
    coefficient = {Parity.EVEN: 180, Parity.ODD: 700}[parity]
    assert segment_stiffness(parity, v, separation, length, bending) == pytest.approx(
        coefficient * bending / (v**2 * length * separation**2), rel=2e-3
    )


@pytest.mark.parametrize("parity", Parity)
def test_taut_segments_forget_their_parity(parity):
    slope, length, bending = 0.4, 5.0, 0.045
    for gap, tolerance in ((1e-4, 0.02), (1e-6, 2e-4)):
        separation = length * (1 - gap)
        energy = segment_energy(parity, slope, separation, length, bending)
        limit = high_tension_energy(slope, separation, length, bending)
        assert energy == pytest.approx(limit, rel=tolerance)


def test_impossible_segments_are_refused():
    with pytest.raises(InputError, match="above the distance of the ends"):
        segment_energy(Parity.EVEN, 0.5, 3.0, 2.9, 0.045)
    with pytest.raises(InputError, match="straight"):
        tension_parameter(Parity.ODD, 0.0, 0.1)
    with pytest.raises(InputError, match="straight"):
        rest_separation_mm(Parity.ODD, float("nan"), 1.0)
    with pytest.raises(InputError, match="buckling"):
        energy_function(Parity.EVEN, -10.0)
    with pytest.raises(InputError, match="above the distance of the ends"):
        high_tension_energy(0.5, 3.0, 3.0, 0.045)
