"""The extensibility field of a piece as rectangles, by region and by stitch (the paper's Fig. 4d).

The width of a rectangle is the extensibility along the course, 1/Y_x, its height that along the
wale, 1/Y_y, both to one scale.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from knitcore.base.arrays import runs
from knitcore.chart.stitch_chart import StitchChart
from knitcore.formats.designs.layout import DesignRegion, region_cells
from knitcore.formats.write.chart_key import tinted
from knitcore.formats.write.drawn_page import Label, Rectangle, Shape
from knitcore.garment.piece import Piece
from knitcore.garment.shaped import largest_rectangle
from knitcore.materials import Material
from knitcore.mechanics.local_moduli import local_moduli
from knitcore.prediction.predict import predict
from knitcore.prediction.prediction import Prediction

MAX_RECTANGLES = 900
"""Rectangles of stitches in a drawing; of larger pieces every second, third, … is drawn."""
_INK, _OUTSIDE = "#222222", "#e5e1d9"


@dataclass(frozen=True)
class RegionField:
    """A region of a piece with its prediction and its place.

    Attributes
    ----------
    name, colour : of the region.
    stitches : inside the outline and not covered by later regions.
    prediction : for the repeat that fills it, or for the largest rectangle inside it.
    row, column : the middle of the region's largest part.
    """

    name: str
    colour: str
    stitches: int
    prediction: Prediction
    row: float
    column: float


def region_fields(
    piece: Piece, regions: Sequence[DesignRegion], material: Material
) -> tuple[RegionField, ...]:
    """Predict each region; stitches of no region come last, as "rest".

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.
    """
    rows, columns = piece.chart.rows, piece.chart.columns
    owner = np.full((rows, columns), len(regions))
    for index, region in enumerate(regions):
        owner[region_cells(region, rows, columns)] = index
    named = [(r.name, r.colour, r.fill) for r in regions]
    named.append(("rest" if regions else "all", "#8c877d", None))
    fields = []
    for index, (name, colour, fill) in enumerate(named):
        cells = (owner == index) & piece.shaped.stitch
        if not cells.any():
            continue
        inside = piece.chart.purl[largest_rectangle(cells)]
        prediction = predict(StitchChart.parse(fill) if fill else StitchChart(inside), material)
        parts, _ = scipy.ndimage.label(cells)
        largest = parts == np.bincount(parts[cells]).argmax()
        row, column = (float(np.median(place)) for place in np.nonzero(largest))
        fields.append(RegionField(name, colour, int(cells.sum()), prediction, row, column))
    return tuple(fields)


def field_shapes(
    piece: Piece,
    regions: Sequence[DesignRegion],
    fields: Sequence[RegionField],
    material: Material,
    *,
    aspect: float,
    left: float,
    top: float,
    width: float,
    height: float,
) -> Iterator[Shape]:
    """The field inside a box on paper, in mm; ``aspect`` is height over width of a stitch.

    The stitches are those of flat cloth; ``fields`` are the piece's (:func:`region_fields`), in
    which ribs and welts fold.
    """
    chart, stitch = piece.chart, piece.shaped.stitch
    local = local_moduli(piece.shaped.continued(), material)
    course, wale = local.extensibility_course_mm_per_n, local.extensibility_wale_mm_per_n
    cell = min(width / chart.columns, height / (chart.rows * aspect))
    high = cell * aspect
    most = max(float(course[stitch].max()), float(wale[stitch].max()))
    yield Rectangle(left, top, cell * chart.columns, high * chart.rows, fill=_OUTSIDE)
    owner = np.full(stitch.shape, -1)
    for index, region in enumerate(regions):
        owner[region_cells(region, chart.rows, chart.columns)] = index
    for row in range(chart.rows):
        y = top + high * (chart.rows - 1 - row)
        for start, stop, index in runs(np.where(stitch[row], owner[row], -2)):
            if index > -2:
                fill = tinted(regions[index].colour) if index >= 0 else "#ffffff"
                yield Rectangle(left + cell * start, y, cell * (stop - start), high, fill=fill)
    step = max(1, int(np.ceil(np.sqrt(stitch.sum() / MAX_RECTANGLES))))
    scale = 0.9 * step * min(cell, high) / most
    for row, column in np.argwhere(stitch).tolist():
        if row % step or column % step:
            continue
        sides = scale * course[row, column], scale * wale[row, column]
        middle = left + cell * (column + 0.5), top + high * (chart.rows - 0.5 - row)
        yield _rectangle(middle, sides, _INK, 0.12)
    extents = [
        (1 / part.prediction.modulus_course_n_per_mm, 1 / part.prediction.modulus_wale_n_per_mm)
        for part in fields
    ]
    scale = 0.16 * min(cell * chart.columns, high * chart.rows) / max(map(max, extents))
    for part, (wide, tall) in zip(fields, extents, strict=True):
        sides = scale * wide, scale * tall
        middle = left + cell * (part.column + 0.5), top + high * (chart.rows - 0.5 - part.row)
        yield _rectangle(middle, sides, "#ffffff", 1.4)
        yield _rectangle(middle, sides, _INK, 0.7)
    share = f"one stitch in {step} × {step}" if step > 1 else "stitches"
    note = f"large rectangles: regions; small ones: {share} of flat cloth, on a scale of their own"
    yield Label(left, top + high * chart.rows + 4.0, note, 2.8)


def _rectangle(
    middle: tuple[float, float], sides: tuple[float, float], ink: str, line: float
) -> Rectangle:
    corner = middle[0] - sides[0] / 2, middle[1] - sides[1] / 2
    return Rectangle(*corner, *sides, stroke=ink, line_width=line)
