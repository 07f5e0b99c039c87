"""Manufacturing tension as loop length (paper, Supplementary Fig. 9).

A machine that pulls harder puts less yarn into a stitch; the model knows tension as that length.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from knitcore.errors import InputError
from knitcore.yarnlevel.results import FloatArray, RelaxedCell


@dataclass(frozen=True, eq=False)
class TensionSeries:
    """One stitch knitted with different lengths of yarn.

    Parameters
    ----------
    loop_length_mm : the lengths, mm, as given.
    cells : the force-free stitch at each.
    """

    loop_length_mm: FloatArray
    cells: tuple[RelaxedCell, ...]

    @property
    def cell_course_mm(self) -> FloatArray:
        """Width of a stitch at each length, mm."""
        return np.array([cell.cell_course_mm for cell in self.cells])

    @property
    def cell_wale_mm(self) -> FloatArray:
        """Height of a stitch at each length, mm."""
        return np.array([cell.cell_wale_mm for cell in self.cells])

    @property
    def stitches_per_cm2(self) -> FloatArray:
        """Stitch density at each length."""
        return 100.0 / (self.cell_course_mm * self.cell_wale_mm)

    @property
    def energy_n_mm(self) -> FloatArray:
        """Energy of a stitch at each length, N·mm."""
        return np.array([cell.energy_n_mm for cell in self.cells])


def vary_loop_length(
    relax: Callable[[float], RelaxedCell], loop_lengths_mm: Sequence[float]
) -> TensionSeries:
    """Relax a stitch for each length of yarn.

    Parameters
    ----------
    relax : relaxes the stitch for a loop length in mm, in whatever branch.
    loop_lengths_mm : the lengths, mm.

    Raises
    ------
    InputError
        If there is no length; and what ``relax`` raises.
    """
    if not len(loop_lengths_mm):
        raise InputError("loop_lengths_mm", "is empty.", "Give at least one length in mm.")
    cells = tuple(relax(float(length)) for length in loop_lengths_mm)
    return TensionSeries(np.asarray(loop_lengths_mm, dtype=float), cells)
