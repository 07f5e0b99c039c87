"""Centre lines of every stitch of a chart, each different shape only once.

Where the chart repeats a cell that was relaxed at the yarn level, its stitches are that cell's. All
other charts are assembled like their mechanics, from quarters: each quarter of a stitch touches
one course-wise and one wale-wise segment and follows the relaxed line of the pure fabric with those
parities (:mod:`knitcore.chart.phases`). Along the line of a stitch the four fabrics are blended
smoothly,

    line(u) = sum over fabrics of weight(u) * fabric(u),    u from 0 to 1 along the stitch,

and the weights at a place that two stitches share are the mean of both: where the line passes to
the next stitch of its course, and where its foot hangs in the head of the stitch below. So joins
have neither gap nor kink, crossings keep the order and about the distance that they have in the
relaxed fabrics, and pure fabrics are exactly relaxed. A purl is the mirror image of a knit, so 16
surroundings (a few more with their neighbours) represent all.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array, Indices, Mask
from knitcore.chart.fabric import PHASES
from knitcore.chart.phases import (
    ABOVE,
    BELOW,
    LEFT,
    RIGHT,
    pure_fabric,
    quarter_phases,
    reference_fabric,
    surroundings,
)
from knitcore.chart.stitch_chart import StitchChart
from knitcore.draw.fabric_loops import (
    POINTS,
    FabricLines,
    cell_lines,
    fabric_lines,
    stored_material,
)
from knitcore.draw.lattice import Lattice, flat_lattice, resting_lattice
from knitcore.materials import Material
from knitcore.prediction.densities import densities_of
from knitcore.prediction.learned import packaged_model
from knitcore.prediction.size import RelaxedSize
from knitcore.yarn.library.store import StoredStitch, stored_fabric, stored_stitch

MAX_STORED = 36
"""Number of stitches of the largest repeats that are looked up in the store."""
MAX_SHAPES = 192
"""Number of shapes above which crossings with the rows above and below are drawn less exactly."""
FULLNESS = 1.1
"""Factor by which yarn is drawn thicker than touching strands allow, because it is soft."""
FOOT = (0.12, 0.20)
"""Part of a stitch, from its end, that hangs in the head below; before it is the course's join."""
HEAD = 0.28
"""Place along a stitch from which the next row hangs in it."""
TOP = 0.42
"""Place along a stitch from which, up to its mirror image, the left half becomes the right."""


@dataclass(frozen=True, eq=False)
class StitchShapes:
    """The yarn of a chart, laid on a lattice.

    Attributes
    ----------
    lines : (shapes, POINTS, 3); x and y in stitch widths and row heights from the stitch's centre,
        z in mm, positive towards the face. They begin and end on the cell's left and right edges.
    index : (rows, columns) which shape each stitch has.
    lattice : where the stitches lie when the fabric rests.
    yarn_radius_mm : about half of the distance that neighbouring strands keep.
    source : where the shapes come from.
    """

    lines: Array
    index: Indices
    lattice: Lattice
    yarn_radius_mm: float
    source: str

    def resized(self, size: RelaxedSize, stitches: Mask | None = None) -> StitchShapes:
        """The same stitches with a mean stitch of a known size.

        Loops open where it is larger; where it is smaller, the yarn is squeezed with them.

        Parameters
        ----------
        stitches : (rows, columns) False where the piece has none.
        """
        ratio = size.over(self.lattice.sizes_mm, stitches)
        squeezed = min(1.0, float(np.sqrt(ratio.prod())))
        return replace(
            self,
            lines=self.lines * (1.0, 1.0, squeezed),
            lattice=Lattice(self.lattice.centres_mm * ratio, self.lattice.sizes_mm * ratio),
            yarn_radius_mm=self.yarn_radius_mm * squeezed,
        )


def stitch_shapes(chart: StitchChart, material: Material, *, folded: bool = True) -> StitchShapes:
    """The shapes of a chart's stitches in a material.

    Parameters
    ----------
    folded : whether relaxed repeats keep their folds; False where the sheet itself is folded, which
        then places its stitches: the lattice is straight.

    Raises
    ------
    InputError
        If the material lacks one of the four fabrics.
    """
    fabrics, radius = fabric_lines(material), yarn_radius_mm(chart, material)
    stored = _stored_repeat(chart, material) if folded else None
    if stored is not None:
        return _of_stored(chart, material, stored, radius)
    lines, index = _of_quarters(chart, fabrics)
    lattice = (resting_lattice if folded else flat_lattice)(chart, material)
    return StitchShapes(lines, index, lattice, radius, fabrics.source)


def yarn_radius_mm(chart: StitchChart, material: Material) -> float:
    """About half of the distance that neighbouring strands of a chart keep.

    Raises
    ------
    InputError
        If the material lacks one of the four fabrics.
    """
    shares = np.bincount(quarter_phases(chart).ravel(), minlength=len(PHASES))
    return FULLNESS * 0.5 * float(shares @ fabric_lines(material).strand_mm / shares.sum())


# -- a repeat that was relaxed -----------------------------------------------------------------


def _stored_repeat(chart: StitchChart, material: Material) -> StoredStitch | None:
    if pure_fabric(chart) is not None:
        return None  # its quarters are exact
    repeat = chart.repeat_cut()
    if repeat.stitches > MAX_STORED:
        return None
    return stored_stitch(repeat, stored_material(material))


def _of_stored(
    chart: StitchChart, material: Material, stored: StoredStitch, radius_mm: float
) -> StitchShapes:
    """Shapes of a stored repeat, as deep as in the fabric that it resembles.

    It is as wide and high as predicted: yarn that was relaxed alone folds more than knitted fabric.
    """
    reference = reference_fabric(stored.chart)
    like, record = stored_fabric(reference, stored.material), material.record(reference)
    depth = np.sqrt(np.prod(record.stitch_mm) / (like.cell_course_mm * like.cell_wale_mm))
    repeat = densities_of(chart.repeat_cut().purl[None])
    course, wale = packaged_model().relaxed_mm(repeat, material)[0]
    rows, columns = np.indices((chart.rows, chart.columns))
    index = rows % stored.chart.rows * stored.chart.columns + columns % stored.chart.columns
    centres = np.stack([(columns + 0.5) * course, (rows + 0.5) * wale], axis=-1)
    source = f"relaxed cell of this repeat in {stored.material}"
    if stored.material != material.sample:
        source += ", scaled to this material's stitches: an estimate"
    return StitchShapes(
        lines=cell_lines(stored).reshape(-1, POINTS, 3) * (1.0, 1.0, depth),
        index=index,
        lattice=Lattice(centres, np.broadcast_to([course, wale], centres.shape).copy()),
        yarn_radius_mm=radius_mm,
        source=source,
    )


# -- put together from quarters ----------------------------------------------------------------


def _of_quarters(chart: StitchChart, fabrics: FabricLines) -> tuple[Array, Indices]:
    bits = _parities(chart)
    code = bits @ (1 << np.arange(bits.shape[-1]))
    codes, index = np.unique(code, return_inverse=True)
    if len(codes) > MAX_SHAPES:  # leave out the crossings' bits
        bits[..., [7, 9]], bits[..., [8, 10]] = bits[..., 1:2], bits[..., 2:3]
        code = bits @ (1 << np.arange(bits.shape[-1]))
        codes, index = np.unique(code, return_inverse=True)
    kinds = (codes[:, None] >> np.arange(bits.shape[-1])) & 1
    weights = _weights(kinds)
    lines = np.einsum("sup,pux->sux", weights, fabrics.lines)
    lines[..., 2] *= np.where(kinds[:, 0], -1.0, 1.0)[:, None]
    return lines, index.reshape(chart.rows, chart.columns)


def _parities(chart: StitchChart) -> NDArray[np.int64]:
    """Bits (rows, columns, 11) that decide the shape of each stitch, 0 or 1.

    Purl; odd segments left, right, below, above; below the left and the right neighbour; left and
    right of the stitch below; left and right of the one above.
    """
    codes = surroundings(chart)
    left, right, below, above = (
        (codes & bit > 0).astype(int) for bit in (LEFT, RIGHT, BELOW, ABOVE)
    )
    return np.stack(
        [
            chart.purl.astype(int), left, right, below, above,
            _beside(below, 0, -1), _beside(below, 0, 1),
            _beside(left, -1, 0), _beside(right, -1, 0),
            _beside(left, 1, 0), _beside(right, 1, 0),
        ],
        axis=-1,
    )  # fmt: skip


def _beside(values: NDArray[np.int64], up: int, right: int) -> NDArray[np.int64]:
    """Shift values by rows up and columns to the right; edge values are repeated."""
    rows, columns = values.shape
    row = np.clip(np.arange(rows) + up, 0, rows - 1)
    column = np.clip(np.arange(columns) + right, 0, columns - 1)
    return values[np.ix_(row, column)]


def _weights(kinds: NDArray[np.int64]) -> Array:
    """Share (shapes, POINTS, 4) of each fabric in the lines of some shapes."""
    u = np.linspace(0.0, 1.0, POINTS)
    _, left, right, below, above, left_below, right_below = kinds.T[:7]
    foot_left, foot_right, head_left, head_right = kinds.T[7:]
    halves = [
        _half(u, left, below, above, left_below, foot_left, head_left),
        _half(1.0 - u, right, below, above, right_below, foot_right, head_right),
    ]
    across = _step(TOP, 1.0 - TOP, u)[:, None]
    return halves[0] * (1.0 - across) + halves[1] * across


def _half(
    u: Array,
    course: NDArray[np.int64],
    below: NDArray[np.int64],
    above: NDArray[np.int64],
    beside_below: NDArray[np.int64],
    course_below: NDArray[np.int64],
    course_above: NDArray[np.int64],
) -> Array:
    """Weights of one half of the stitch; ``u`` counts from its end of the course."""

    def mean(*parities: tuple[NDArray[np.int64], NDArray[np.int64]]) -> Array:
        fabrics = [np.eye(len(PHASES))[2 * c + w] for c, w in parities]
        return np.asarray(np.mean(fabrics, axis=0))[:, None]

    join = mean((course, below), (course, beside_below))
    foot = mean((course, below), (course_below, below))
    head = mean((course, above), (course_above, above))
    into_foot = _step(0.0, FOOT[0], u)[:, None]
    into_head = _step(FOOT[1], HEAD, u)[:, None]
    lower = join * (1.0 - into_foot) + foot * into_foot
    return lower * (1.0 - into_head) + head * into_head


def _step(start: float, end: float, u: Array) -> Array:
    """Rise smoothly from 0 before to 1 after, flat at both ends."""
    t = np.clip((u - start) / (end - start), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)
