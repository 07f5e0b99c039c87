import numpy as np
import pytest

from knitcore import StitchChart, material
from knitcore.draw.fabric_loops import POINTS
from knitcore.draw.instances import occlusion
from knitcore.draw.lattice import Lattice
from knitcore.draw.stitches import StitchShapes, stitch_shapes

WIDE_MM = 6.0


def _straight_rows(apart_mm: float, radius_mm: float) -> StitchShapes:
    """Three rows of straight yarn."""
    line = np.zeros((1, POINTS, 3))
    line[0, :, 0] = np.linspace(-0.5, 0.5, POINTS)
    row, column = np.indices((3, 3))
    centres = np.stack([column * WIDE_MM, row * apart_mm], axis=-1)
    sizes = np.broadcast_to([WIDE_MM, apart_mm], (3, 3, 2)).copy()
    lattice = Lattice(centres, sizes)
    return StitchShapes(line, np.zeros((3, 3), int), lattice, radius_mm, "straight")


@pytest.mark.parametrize("apart_mm", [2.2, 3.0, 6.0])
def test_a_strand_beside_another_loses_the_light_that_it_hides(apart_mm: float) -> None:
    """A long strand of radius r whose axis is at a distance D covers 4 r / (pi D)."""
    radius, half = 0.5, 1.5 * WIDE_MM
    up, face, down, back = occlusion(_straight_rows(apart_mm, radius), 9, 4)[0, 4]
    distance = apart_mm - radius
    ends = half / np.hypot(half, distance)
    assert up == pytest.approx(np.exp(-4 * radius * ends / (np.pi * distance)), rel=0.03)
    assert down == pytest.approx(up)
    assert (face, back) == (1, 1)


@pytest.mark.parametrize("chart", ["KKKK\nKKKK\nKKKK", "KPKP\nPPKK\nKPKP"])
def test_yarn_is_dark_where_loops_hang_in_each_other_and_light_outside(chart: str) -> None:
    shapes = stitch_shapes(StitchChart.parse(chart), material("acrylic"))
    light = occlusion(shapes, 24, 8)
    assert light.shape == (len(shapes.lines), 24, 8)
    assert 0 < light.min() < 0.15
    assert 0.9 < light.max() <= 1
