"""Relaxed centre lines of the four pure fabrics, in the sizes of a material.

They come from the packaged store of the yarn level, which holds acrylic and cotton. Other materials
get those of acrylic, scaled to their own stitches, and labelled as an estimate.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.fabric import PHASES
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials import Material
from knitcore.yarn.library.store import MATERIALS, StoredStitch, stored_fabric
from knitcore.yarn.model.spline import SUPPORT, quintic_basis

POINTS = 49
"""Number of points of a centre line over one stitch, both ends included."""


@dataclass(frozen=True, eq=False)
class FabricLines:
    """One knit stitch of each pure fabric, in the order of the phase codes.

    Attributes
    ----------
    lines : (4, POINTS, 3); x and y in stitch widths and row heights from the stitch's centre, z in
        mm, positive towards the face. A purl is the same with z reversed.
    strand_mm : (4,) smallest distance between the centre lines of two strands.
    source : where the lines come from.
    """

    lines: Array
    strand_mm: Array
    source: str


def stored_material(material: Material) -> str:
    """Name the stored material whose stitches stand in for a material."""
    return material.sample if material.sample in MATERIALS else MATERIALS[0]


def fabric_lines(material: Material) -> FabricLines:
    """The relaxed stitches of a material's four fabrics.

    Raises
    ------
    InputError
        If the material lacks one of the four fabrics.
    """
    sizes = tuple(material.record(fabric).stitch_mm for fabric in PHASES)
    return _fabric_lines(stored_material(material), material.sample in MATERIALS, sizes)


@lru_cache(maxsize=64)
def _fabric_lines(stored: str, own: bool, sizes_mm: tuple[tuple[float, float], ...]) -> FabricLines:
    lines, strands = [], []
    for fabric, (course_mm, wale_mm) in zip(PHASES, sizes_mm, strict=True):
        chart, relaxed = StitchChart.of_fabric(fabric), stored_fabric(fabric, stored)
        scale = np.sqrt(course_mm * wale_mm / (relaxed.cell_course_mm * relaxed.cell_wale_mm))
        row, column = np.argwhere(~relaxed.chart.purl)[0]
        line = cell_lines(relaxed)[row, column] * (1.0, 1.0, scale)
        line = 0.5 * (line + line[::-1] * (-1.0, 1.0, 1.0))  # left and right are alike
        lines.append(line)
        strands.append(strand_distance_mm(line, chart, course_mm, wale_mm))
    source = f"relaxed curves of the four fabrics in {stored}"
    if not own:
        source += ", scaled to this material's stitches: an estimate"
    result = FabricLines(np.array(lines), np.array(strands), source)
    result.lines.setflags(write=False)
    return result


def cell_lines(stored: StoredStitch, points: int = POINTS) -> Array:
    """Centre lines of every stitch of a stored repeat, shape (rows, columns, points, 3).

    x and y in stitch widths and row heights from the stitch's centre, z in mm.
    """
    rows, columns = stored.chart.rows, stored.chart.columns
    count = stored.controls.shape[1]
    place = np.linspace(0.0, columns, columns * (points - 1) + 1) * (count // columns)
    span = np.floor(place + 1e-9).astype(int)
    weights = quintic_basis(place - span, 0)
    index = (span[:, None] - 2 + np.arange(SUPPORT)) % count
    curve = np.einsum("pa,rpax->rpx", weights, stored.controls[:, index])
    stitch = np.arange(columns)[:, None] * (points - 1) + np.arange(points)
    lines: Array = curve[:, stitch] / (stored.cell_course_mm, stored.cell_wale_mm, 1.0)
    lines[..., 0] += np.linspace(-0.5, 0.5, points)  # controls are without the drift
    assert lines.shape == (rows, columns, points, 3)  # noqa: S101 - states the layout
    return lines


def strand_distance_mm(line: Array, chart: StitchChart, course_mm: float, wale_mm: float) -> float:
    """Smallest distance between strands of a fabric of one kind of stitch.

    Parameters
    ----------
    line : (points, 3) of a knit; a purl is its mirror image.
    chart : a repeat of the fabric, continued periodically.
    """
    shape = line * (course_mm, wale_mm, 1.0)
    sign = 1.0 - 2.0 * chart.purl
    course = np.concatenate(
        [
            shape[:-1] * (1.0, 1.0, sign[0, j % chart.columns]) + (j * course_mm, 0.0, 0.0)
            for j in range(-1, 3)
        ]
    )
    above = course * (1.0, 1.0, sign[1 % chart.rows, 0] * sign[0, 0]) + (0.0, wale_mm, 0.0)
    distance = np.linalg.norm(shape[:, None] - above[None], axis=2)
    return float(distance.min())
