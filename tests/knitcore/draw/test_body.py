"""Surfaces of what cloth rests on."""

import numpy as np
import pytest

from knitcore.draw.body import Body

ANGLES = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
RING = np.stack([np.sin(ANGLES), np.zeros(12), np.cos(ANGLES)], axis=-1)
LIMB = np.stack([30.0 * RING + (0.0, level, 0.0) for level in (0.0, 40.0, 80.0)])
TABLE = np.array([(-60.0, -40.0), (0.0, -40.0), (0.0, 40.0), (-60.0, 40.0)])


@pytest.mark.parametrize(
    ("body", "volume"),
    [
        (Body.around(LIMB), 80.0 * 900.0 * np.pi),
        (Body.around(LIMB[..., [1, 0, 2]]), 80.0 * 900.0 * np.pi),  # columns run around it
        (Body.slab(TABLE, 10.0), 60.0 * 80.0 * 10.0),
        (Body.slab(TABLE[::-1], 10.0), 60.0 * 80.0 * 10.0),
    ],
    ids=["limb", "limb along the rows", "table", "table the other way round"],
)
def test_the_outside_of_a_body_is_outside(body: Body, volume: float) -> None:
    """Without its ends a limb of this shape has two thirds of its volume in its side."""
    points = body.vertices_mm.astype(float)
    # positive if the triangles are counterclockwise from outside
    enclosed = np.linalg.det((points - points.mean(axis=0))[body.faces]).sum() / 6.0
    assert 0.6 * volume < enclosed <= 1.001 * volume
