"""The heavy elastica against independent solutions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from knitcore import InputError
from knitcore.measure.heavy_elastica import heavy_elastica


@pytest.mark.parametrize("load", [1.0, 10.0, 100.0, 1000.0])
def test_shape_agrees_with_shooting_from_the_free_end(load: float) -> None:
    """In t = load**(1/3) (1 - s), theta'' = -t cos(theta) from theta(0) = a, theta'(0) = 0: the
    load is the t at which theta is back at the clamp's angle."""
    end = np.cbrt(load)

    def shoot(gap: float) -> float:
        return float(_from_free_end(np.pi / 2 - gap, end).y[0, -1])

    gaps = np.logspace(-13, np.log10(np.pi / 2 - 1e-9), 90)
    clamped = [shoot(g) for g in gaps]
    first = int(np.flatnonzero(np.diff(np.sign(clamped)))[0])
    gap = brentq(shoot, gaps[first], gaps[first + 1], xtol=1e-14, rtol=1e-13)
    path = _from_free_end(np.pi / 2 - gap, end)
    t = np.linspace(0, end, 4001)
    theta = path.sol(t)[0]
    s, x, y = heavy_elastica(load)
    assert s[-1] == 1.0
    assert x[-1] == pytest.approx(np.trapezoid(np.cos(theta), t) / end, abs=2e-4)
    assert y[-1] == pytest.approx(np.trapezoid(np.sin(theta), t) / end, abs=2e-4)


def _from_free_end(angle: float, end: float):  # type: ignore[no-untyped-def]
    options = {"rtol": 1e-10, "atol": 1e-12, "dense_output": True}
    return solve_ivp(lambda t, u: [u[1], -t * np.cos(u[0])], (0.0, end), [angle, 0.0], **options)


@settings(max_examples=40)
@given(load=st.floats(0.0, 2e5))
def test_a_rod_keeps_its_length_and_only_goes_down(load: float) -> None:
    _, x, y = heavy_elastica(load)
    arc = np.sum(np.hypot(np.diff(x), np.diff(y)))
    assert arc == pytest.approx(1.0, abs=2e-3)
    assert np.all(np.diff(y) >= -1e-12)
    assert np.all(np.diff(x) >= -1e-12)


@pytest.mark.parametrize("load", [-1.0, np.nan, np.inf, 1e9])
def test_impossible_loads_are_refused(load: float) -> None:
    with pytest.raises(InputError, match="load"):
        heavy_elastica(load)
