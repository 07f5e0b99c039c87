"""Regions of different gauge in one fabric: their misfit, and the shape they relax to."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled
from knitcore.cloth.flat.equilibrium_path import Equilibrium, Path, Tolerance, run_path
from knitcore.cloth.flat.grid import QuarterGrid
from knitcore.cloth.flat.grid_sheet import Sheet
from knitcore.cloth.flat.strip_results import SwatchTest

RELAXATION_STAGES = 10
BALANCED = Tolerance(absolute_n=1e-6)
"""Absolute tolerance, since a free swatch has no clamp force to compare its residual with."""


@dataclass(frozen=True, eq=False)
class Misfit:
    """Strain that a fabric would need to fill its place in the common grid.

    Attributes
    ----------
    course, wale : (rows, columns) laid-out size over natural size - 1, of each quarter cell; 0
        where there is no fabric.
    """

    course: Array
    wale: Array

    @property
    def largest(self) -> float:
        """Largest absolute misfit of any quarter cell."""
        return float(max(np.abs(self.course).max(), np.abs(self.wale).max()))


def misfit(grid: QuarterGrid) -> Misfit:
    """Misfit between the cells of a grid and their natural sizes."""
    course = np.diff(grid.column_lines) / grid.natural_width - 1
    wale = np.diff(grid.row_lines)[:, None] / grid.natural_height - 1
    course[~grid.cloth] = wale[~grid.cloth] = 0.0
    return Misfit(course, wale)


def relaxed_shape(sheet: Sheet, *, cancelled: Cancelled | None = None) -> SwatchTest:
    """The shape of a free swatch whose fabrics keep their own gauge (flat; it does not curl).

    The smooth energy is tried first; where compressed regions make it unstable, the sheet's own
    model with its tension field.

    Parameters
    ----------
    sheet : with natural sizes, as ``chart_sheet(..., draw_in=True)`` makes it.
    cancelled : called from time to time; True stops the relaxation.

    Returns
    -------
    SwatchTest
        One step per stage of the relaxation; the last one is the shape.
    """
    grid = sheet.grid
    fixed = np.zeros((len(grid.corners), 2), dtype=bool)
    middle = int(np.argmin(np.where(grid.cloth.ravel(), np.hypot(*grid.centres.T), np.inf)))
    left, right, *_ = grid.cell_corners[middle]
    fixed[right] = True  # no drift
    fixed[left, 1] = True  # no turning
    plain = replace(sheet.model, tension_field=False)
    path = draw_in(sheet.with_model(plain), fixed, cancelled=cancelled)
    if path.problem and sheet.model.tension_field:
        path = draw_in(sheet, fixed, cancelled=cancelled)
    return SwatchTest.of(sheet, path)


def draw_in(sheet: Sheet, fixed: NDArray[np.bool_], *, cancelled: Cancelled | None = None) -> Path:
    """Change the rest sizes from the common grid's to the natural ones, some nodes held.

    It goes in a few stages, so that the solver follows the motion.
    """
    grid = sheet.grid
    laid = grid.at_rest_as_laid_out
    state = sheet.reference
    equilibria: list[Equilibrium] = []
    seconds = 0.0
    for stage in range(1, RELAXATION_STAGES + 1):
        share = stage / RELAXATION_STAGES
        part = sheet.with_grid(
            replace(
                grid,
                natural_width=laid.natural_width ** (1 - share) * grid.natural_width**share,
                natural_height=laid.natural_height ** (1 - share) * grid.natural_height**share,
            )
        )
        path = run_path(
            part, fixed, [grid.corners], start=state, tolerance=BALANCED, cancelled=cancelled
        )
        seconds += path.seconds
        if path.problem:
            problem = f"Draw-in, stage {stage} of {RELAXATION_STAGES}: {path.problem}"
            return Path(tuple(equilibria), problem, seconds)
        equilibria += path.equilibria
        state = path.states[-1]
    return Path(tuple(equilibria), None, seconds)
