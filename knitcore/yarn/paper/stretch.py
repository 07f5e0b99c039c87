"""Stretching one stitch in the published description."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from knitcore.base.errors import ConvergenceError
from knitcore.chart.fabric import Direction
from knitcore.yarn.model.relaxed_cell import RelaxedCell
from knitcore.yarn.paper.bezier_relax import relaxed_cell
from knitcore.yarn.paper.bezier_stitch import Stitch, published_fabric
from knitcore.yarn.paper.continuation import Continuation
from knitcore.yarn.paper.slide import SlideQuenching


@dataclass(frozen=True, eq=False)
class PublishedStretch:
    """How a stitch is stretched, with the lengths that slide quenching holds.

    Parameters
    ----------
    zero : the relaxed stitch.
    along : the direction.
    quenching : which stretches of yarn keep their length at rest.
    """

    zero: RelaxedCell
    along: Direction
    quenching: SlideQuenching

    @classmethod
    def of(cls, zero: RelaxedCell, along: Direction, quenched: bool | None) -> PublishedStretch:
        """With the paper's slide quenching, or without; by default where the paper had it."""
        quenching = SlideQuenching.default(published_fabric(zero.chart), along)
        if quenched is not None:
            quenching = SlideQuenching.PAPER if quenched else SlideQuenching.NONE
        return cls(zero, along, quenching)

    @property
    def note(self) -> str:
        """Which slides are held."""
        none = self.quenching is SlideQuenching.NONE
        return "" if none else f"Slide quenching: {self.quenching}."

    def reach(self, known: Sequence[RelaxedCell], size_mm: float) -> RelaxedCell:
        """The relaxed state with one size prescribed, continued from the last two states."""
        zero = self.zero
        stitch = Stitch(published_fabric(zero.chart), zero.yarn, zero.convention)
        held = self.quenching.weights
        loop_mm = float(zero.loop_lengths_mm.mean())
        path = Continuation(stitch, loop_mm, held, held @ stitch.evaluate(zero.state).lengths_mm)
        sizes = (size_mm, None) if self.along is Direction.COURSE else (None, size_mm)
        found = path.go([cell.state for cell in known or [zero]], *sizes)
        if found is None:
            raise ConvergenceError("the yarn locks before it gets there.")
        return relaxed_cell(stitch, loop_mm, *found)
