"""Points on and above a curled piece."""

import numpy as np

from knitcore.chart.in_space import corners_of
from knitcore.cloth.space.surface import Surface, filled
from knitcore.garment.shaped import outline_marks


def test_a_cylinder_is_a_cylinder() -> None:
    angle, up = np.meshgrid(np.linspace(0.0, 2.0, 21), np.arange(9.0))
    corners = np.stack([5.0 * np.sin(angle), up, 5.0 * np.cos(angle)], axis=-1)
    surface = Surface(corners)
    across, rows = np.random.default_rng(0).uniform(0.0, 8.0, (2, 50))
    points = surface.at(2.5 * across, rows, np.full(50, 0.7))
    assert np.allclose(np.hypot(points[:, 0], points[:, 2]), 5.7, atol=1e-3)
    assert np.allclose(points[:, 1], rows, atol=1e-9)


def test_beyond_an_edge_the_surface_is_straight() -> None:
    x, y = np.meshgrid(np.arange(4.0), np.arange(3.0))
    surface = Surface(np.stack([2.0 * x, 3.0 * y, 0.0 * x], axis=-1))
    points = surface.at(np.array([-1.0, 3.5]), np.array([0.5, 2.5]), np.array([0.0, 1.0]))
    assert np.allclose(points, [[-2.0, 1.5, 0.0], [7.0, 7.5, 1.0]])


def test_a_piece_one_stitch_wide_has_a_surface() -> None:
    x, y = np.meshgrid(np.arange(2.0), np.arange(6.0))
    surface = Surface(np.stack([2.0 * x, 3.0 * y, 0.0 * x], axis=-1))
    points = surface.at(np.array([0.5]), np.array([2.5]), np.array([0.4]))
    assert np.allclose(points, [[1.0, 7.5, 0.4]])


def test_corners_without_a_stitch_go_on_as_those_beside_them() -> None:
    """A plane stays a plane, and a hole in a bowl is filled like the bowl."""
    there = corners_of(outline_marks("..xxxxxx\nxxx...xx\nxxx...xx\nxxxxxxxx"))
    row, column = np.indices(there.shape).astype(float)
    plane = np.stack([2.0 * column, 3.0 * row, column - row], axis=-1)
    bowl = np.stack([column, row, 0.1 * (row**2 + column**2)], axis=-1)
    hidden = np.where(there[..., None], 0.0, 50.0)
    np.testing.assert_allclose(filled(plane + hidden, there), plane, atol=1e-9)
    inner = (slice(1, -1), slice(3, 6))
    off = np.abs(filled(bowl + hidden, there) - bowl)
    assert off[inner].max() < 0.3
    np.testing.assert_array_equal(off[there], 0.0)
