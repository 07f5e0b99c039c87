"""The cloth that a piece is cut from: a chart in material coordinates, with its laws."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, StitchChart
from knitcore.cloth.cut.outline import CutPiece
from knitcore.cloth.flat.grid_sheet import Sheet
from knitcore.cloth.flat.sheet_models import EnergyModel, SheetModel
from knitcore.cloth.flat.strip import chart_sheet
from knitcore.materials import Material
from knitcore.prediction.quarter_laws import quarter_laws
from knitcore.prediction.size import RelaxedSize


@dataclass(frozen=True, eq=False, repr=False)
class Cloth(Result):
    """A sheet of cells with laws, larger than the piece.

    Attributes
    ----------
    sheet : the cells; their lines are material coordinates, x along the rows.
    corner_mm : material coordinates (x, y) in the piece's frame of the sheet's lower left corner.
    """

    sheet: Sheet
    corner_mm: tuple[float, float]

    def law_at(self, x_mm: Array, y_mm: Array) -> NDArray[np.int32]:
        """Codes of the laws at material coordinates; beyond the sheet, those of its edge."""
        grid = self.sheet.grid
        column, row = (
            np.clip(np.searchsorted(lines, at - corner + lines[0], "right") - 1, 0, cells - 1)
            for lines, at, corner, cells in (
                (grid.column_lines, x_mm, self.corner_mm[0], grid.columns),
                (grid.row_lines, y_mm, self.corner_mm[1], grid.rows),
            )
        )
        return np.asarray(grid.law_of_cell[row, column], dtype=np.int32)


def cloth_under(
    piece: CutPiece,
    chart: StitchChart,
    material: Material,
    model: EnergyModel | str | SheetModel = EnergyModel.FULL,
    *,
    shear_modulus: float | None = None,
    size: RelaxedSize | None = None,
) -> Cloth:
    """Cloth of a chart, repeated from the piece's lower left corner along rows and columns.

    Parameters
    ----------
    piece : to be covered.
    chart : the stitches, face side.
    material : yarn and laws.
    model : energy model by name, or with all its options.
    shear_modulus : N/mm, replaces the laws' own.
    size : relaxed size of the mean stitch, if known.

    Raises
    ------
    InputError
        If the piece needs too many stitches, or the material lacks a fabric of the chart.
    """
    corners = np.asarray(piece.outline, dtype=float) @ piece.turn
    low, extent = corners.min(axis=0), np.ptp(corners, axis=0)
    columns, rows = chart.columns, chart.rows
    while True:
        if max(columns, rows) > MAX_STITCHES_PER_SIDE:
            raise InputError(
                "size",
                f"the piece is {columns} x {rows} stitches large.",
                f"Use pieces of at most {MAX_STITCHES_PER_SIDE} stitches a side.",
            )
        covering = chart.tile(rows // chart.rows, columns // chart.columns)
        # one law for all quarters of a stitch, because elements are larger than stitches
        laws = quarter_laws(covering, material, size, even=True)
        sheet = chart_sheet(covering, material, model, shear_modulus, laws=laws)
        missing = extent - (sheet.grid.width_mm, sheet.grid.length_mm)
        if np.all(missing <= 1e-9 * extent):
            return Cloth(sheet, (float(low[0]), float(low[1])))
        columns = _repeated(columns, chart.columns, extent[0] / sheet.grid.width_mm)
        rows = _repeated(rows, chart.rows, extent[1] / sheet.grid.length_mm)


def _repeated(stitches: int, repeat: int, ratio: float) -> int:
    """Stitches in whole repeats that cover ``ratio`` times as many stitches, never fewer."""
    reach = stitches * max(ratio, 1.0)
    return repeat * math.ceil(reach / repeat - 1e-10)
