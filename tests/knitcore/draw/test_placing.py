"""Stitches on a curled sheet."""

import numpy as np

from knitcore import StitchChart, material
from knitcore.draw.instances import quaternions
from knitcore.draw.lattice import flat_lattice
from knitcore.draw.placing import lying, placed_lines, unstretched
from knitcore.draw.stitches import stitch_shapes

CHART = StitchChart.of_fabric("stockinette", rows=3, columns=4)
SHAPES = stitch_shapes(CHART, material("acrylic"), folded=False)


def _corners() -> np.ndarray:
    width, height = flat_lattice(CHART, material("acrylic")).sizes_mm[0, 0]
    x, y = np.meshgrid(width * np.arange(5), height * np.arange(4))
    return np.stack([x, y, 0.0 * x], axis=-1)


def test_a_flat_sheet_is_the_fabric_at_rest() -> None:
    flat = placed_lines(SHAPES, unstretched(SHAPES))
    on_sheet = placed_lines(SHAPES, lying(_corners()))
    assert np.allclose(on_sheet - on_sheet[0, 0, 0], flat - flat[0, 0, 0], atol=1e-9)
    assert np.allclose(quaternions(lying(_corners())), (1.0, 0.0, 0.0, 0.0), atol=1e-6)


def test_a_sheet_that_is_turned_over_turns_its_loops() -> None:
    over = placed_lines(SHAPES, lying(_corners() * (-1.0, 1.0, -1.0)))
    on_sheet = placed_lines(SHAPES, lying(_corners()))
    assert np.allclose(over, on_sheet * (-1.0, 1.0, -1.0), atol=1e-9)


def test_a_part_keeps_its_places() -> None:
    corners = _corners()
    corners[..., 2] = 0.1 * corners[..., 0] ** 2
    whole = lying(corners)
    part = whole.part((slice(1, 3), slice(0, 2)))
    assert np.array_equal(part.heights_mm, whole.heights_mm[1:3, :2])
