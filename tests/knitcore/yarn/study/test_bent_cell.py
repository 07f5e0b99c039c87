"""A curved cell, against the same points carried along by rotations in plain 3-D."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from knitcore.base.arrays import Array
from knitcore.yarn.kernels.bent import squared_distance
from knitcore.yarn.study.bent_cell import Curved

numbers = st.floats(-1.0, 1.0)
curvatures = st.tuples(*[st.floats(-0.4, 0.4)] * 3)


def _carried(plan: Array, height: Array, curvature: tuple[float, float, float]) -> Array:
    """Points of the curved fabric, seen from the origin: half of each way turns both ends alike."""
    kx, ky, kxy = curvature
    steps = 60
    places = []
    for end, z in zip(plan, height, strict=True):
        m = np.array([[kx, kxy], [kxy, ky]]) @ end
        place, frame = np.zeros(3), Rotation.identity()
        half = Rotation.from_rotvec(np.array([-m[1], m[0], 0.0]) / (2 * steps))
        for _ in range(steps):  # the normal turns towards m; the midpoint rule
            frame = frame * half
            place = place + frame.apply([*end / steps, 0.0])
            frame = frame * half
        places.append(place + frame.apply([0.0, 0.0, z]))
    return np.array(places)


@given(curvatures, st.tuples(numbers, numbers), st.tuples(numbers, numbers))
@pytest.mark.slow
def test_distance_of_two_points_that_are_carried_along(
    curvature: tuple[float, float, float], way: tuple[float, float], heights: tuple[float, float]
) -> None:
    delta = np.array(way)
    ends = _carried(np.array([-0.5 * delta, 0.5 * delta]), np.array(heights), curvature)
    expected = float(((ends[1] - ends[0]) ** 2).sum())
    squared = squared_distance(*way, *heights, curvature)[0]
    assert squared == pytest.approx(expected, rel=1e-5, abs=1e-9)


@given(curvatures, st.integers(0, 100))
@pytest.mark.slow
def test_derivatives_of_a_yarn_that_is_carried_along(
    curvature: tuple[float, float, float], seed: int
) -> None:
    series = 0.5 * np.random.default_rng(seed).standard_normal((4, 3))  # value and derivatives
    series[0, :2] = 0.0
    h = 0.02
    t = h * np.arange(-3, 4)
    yarn = np.stack(
        [series[0] + series[1] * x + series[2] * x**2 / 2 + series[3] * x**3 / 6 for x in t]
    )
    places = _carried(yarn[:, :2], yarn[:, 2], curvature)
    weights = np.array(
        [
            np.array([-1, 9, -45, 0, 45, -9, 1]) / 60,
            np.array([2, -27, 270, -490, 270, -27, 2]) / 180,
            np.array([1, -8, 13, 0, -13, 8, -1]) / 8,
        ]
    )
    expected = weights @ places / h ** np.array([1, 2, 3])[:, None]
    derivatives = Curved(series[None], curvature).bent[0, 1:]
    assert derivatives == pytest.approx(expected, abs=2e-3)
