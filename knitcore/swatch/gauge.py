"""Regions of different gauge in one cloth: their misfit, and the shape they relax to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.fabric import PHASES, Fabric
from knitcore.swatch.grid import QuarterGrid
from knitcore.swatch.results import SwatchTest
from knitcore.swatch.run import run_path
from knitcore.swatch.sheet import Sheet, State

Array = NDArray[np.float64]

RELAXATION_STEPS = 5


@dataclass(frozen=True, eq=False)
class Misfit:
    """Strain that a fabric would need to fill its place in the common grid.

    Attributes
    ----------
    course, wale : (rows, columns) laid-out size over natural size - 1, of each quarter cell.
    by_fabric : mean (course, wale) of each fabric in the chart.
    """

    course: Array
    wale: Array
    by_fabric: dict[Fabric, tuple[float, float]]

    @property
    def largest(self) -> float:
        """Largest absolute misfit of any quarter cell."""
        return float(max(np.abs(self.course).max(), np.abs(self.wale).max()))


def misfit(grid: QuarterGrid) -> Misfit:
    """How far the cells of a grid are from their natural sizes."""
    course = np.diff(grid.column_lines) / grid.natural_width - 1
    wale = np.diff(grid.row_lines)[:, None] / grid.natural_height - 1
    codes = grid.law_of_cell
    return Misfit(
        course,
        wale,
        {
            PHASES[code]: (float(course[codes == code].mean()), float(wale[codes == code].mean()))
            for code in np.unique(codes)
        },
    )


def relaxed_shape(sheet: Sheet, *, cancelled: Callable[[], bool] | None = None) -> SwatchTest:
    """The shape of a free swatch whose fabrics keep their own gauge (flat; it does not curl).

    The rest sizes change from the common grid's to the natural ones in a few steps, so that the
    solver follows the draw-in.

    Parameters
    ----------
    sheet : with natural sizes, as ``chart_sheet(..., draw_in=True)`` makes it.
    cancelled : asked now and then.

    Returns
    -------
    SwatchTest
        One step per stage of the relaxation; the last one is the shape.
    """
    grid = sheet.grid
    fixed = np.zeros((len(grid.corners), 2), dtype=bool)
    middle = (grid.rows + 1) // 2 * (grid.columns + 1) + (grid.columns + 1) // 2
    fixed[middle] = True  # no drift
    fixed[middle - 1, 1] = True  # no turning
    laid = grid.at_rest_as_laid_out
    state = sheet.reference
    seconds, problem = 0.0, None
    states: list[State] = []
    energies: list[float] = []
    iterations: list[int] = []
    for stage in range(1, RELAXATION_STEPS + 1):
        share = stage / RELAXATION_STEPS
        part = sheet.with_grid(
            QuarterGrid(
                grid.column_lines,
                grid.row_lines,
                grid.law_of_cell,
                laid.natural_width ** (1 - share) * grid.natural_width**share,
                laid.natural_height ** (1 - share) * grid.natural_height**share,
            )
        )
        held = state.corners if states else grid.corners
        path = run_path(part, fixed, [held], start=state, cancelled=cancelled)
        seconds += path.seconds
        if path.problem:
            problem = f"Stage {stage} of {RELAXATION_STEPS}: {path.problem}"
            break
        state = path.states[-1]
        states.append(state)
        energies.append(path.found[-1].energy)
        iterations.append(path.found[-1].iterations)
    return SwatchTest(
        sheet=sheet,
        states=tuple(states),
        energy_n_mm=np.array(energies),
        iterations=tuple(iterations),
        converged=problem is None,
        problem=problem,
        seconds=seconds,
    )
