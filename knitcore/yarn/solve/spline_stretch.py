"""Stretching on splines: from one held size to the next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from knitcore.base.errors import Cancelled, ConvergenceError, InputError, UnravelledError
from knitcore.chart.fabric import Direction
from knitcore.yarn.model.relaxed_cell import RelaxedCell
from knitcore.yarn.model.slides import slides_at
from knitcore.yarn.solve.newton import COURSE, WALE, Options, minimise
from knitcore.yarn.solve.search import check_reached
from knitcore.yarn.solve.splines import MAX_STITCHES_RULED, RelaxedRepeat, relaxed_repeat
from knitcore.yarn.solve.topology import clearance_at

STRAIGHT = 0.97
"""A stitch is pulled straight when its size nears this part of its loop length."""
_HALVINGS = 3
_TOLERANCE = 4e-6
"""Tolerance of the energy in cells of more than four stitches: stresses differ from those of 1e-7
by 0.03 % of the largest in the median and 1 % at most (with 1e-6 by 0.01 and 0.6 %), in two thirds
of the time."""


@dataclass(frozen=True, eq=False)
class SplineStretch:
    """How a repeat on splines is stretched; a step that is too long is halved.

    Parameters
    ----------
    zero : the relaxed repeat, with its slide constraints.
    along : the direction.
    cancelled : called before every step of the solver.
    """

    zero: RelaxedRepeat
    along: Direction
    cancelled: Cancelled | None = None

    @classmethod
    def of(
        cls,
        zero: RelaxedRepeat,
        along: Direction,
        slide_quenching: bool,
        cancelled: Cancelled | None,
    ) -> SplineStretch:
        """The stretch of a relaxed repeat, its slides held or not."""
        return cls(with_slides_held(zero) if slide_quenching else zero, along, cancelled)

    @property
    def note(self) -> str:
        """How many slides are held; empty if none is."""
        held = len(self.zero.slides)
        return f"Slide quenching: {held} slides are held." if held else ""

    def reach(self, known: Sequence[RelaxedCell], size_mm: float) -> RelaxedRepeat:
        """The relaxed state with one size prescribed, continued from the last state.

        Raises
        ------
        ConvergenceError, UnravelledError
            If the yarn locks or unravels on the way, in halved steps too.
        CancelledError
            If ``cancelled`` says so.
        """
        last = known[-1] if known else self.zero
        assert isinstance(last, RelaxedRepeat)  # noqa: S101 - the states are this stretch's own
        return self._reach(last, size_mm, _HALVINGS)

    def _reach(self, last: RelaxedRepeat, size_mm: float, halvings: int) -> RelaxedRepeat:
        try:
            return self._held(last, size_mm)
        except (ConvergenceError, UnravelledError):
            if halvings == 0:
                raise
            middle = (last.cell_mm(self.along) + size_mm) / 2.0
            return self._reach(self._reach(last, middle, halvings - 1), size_mm, halvings - 1)

    def _held(self, last: RelaxedRepeat, size_mm: float) -> RelaxedRepeat:
        if size_mm > STRAIGHT * float(last.loop_lengths_mm.max()):
            raise ConvergenceError("the yarn is pulled straight.")
        small = last.cell.stitches <= 4
        minimum = minimise(
            last.energy, last.state, tension=last.tension_n,
            fixed=(COURSE if self.along is Direction.COURSE else WALE,),
            target=np.array([size_mm, size_mm]), cancelled=self.cancelled,
            options=Options(tolerance=1e-8 if small else _TOLERANCE, iterations=80),
        )  # fmt: skip
        check_reached(last.energy, minimum)
        if abs(minimum.state[self.along.axis - 2] - size_mm) > 1e-9:
            raise ConvergenceError("the yarn locks before it gets there.")
        return relaxed_repeat(
            last.chart, last.energy, last.branch, minimum, seconds=0.0,
            evaluations=minimum.evaluations,
        )  # fmt: skip


def with_slides_held(cell: RelaxedRepeat) -> RelaxedRepeat:
    """The same state with its yarn kept from sliding where it touches.

    Raises
    ------
    InputError
        If the cell is too large.
    """
    if cell.cell.stitches > MAX_STITCHES_RULED:
        raise InputError(
            "slide_quenching",
            f"is not available for a cell of {cell.cell.stitches} stitches.",
            f"Use a repeat of at most {MAX_STITCHES_RULED} stitches.",
        )
    energy = replace(cell.energy, slides=())
    near = clearance_at(energy, cell.state)
    slides = slides_at(
        cell.cell, cell.state, near.pairs, near.distances_mm, near.touch_mm, energy.mean_loop_mm
    )
    tension = np.concatenate([cell.tension_n[: energy.constraints], np.zeros(len(slides))])
    return replace(cell, slides=slides, tension_n=tension)
