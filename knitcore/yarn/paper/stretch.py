"""Stretching one stitch in the published description.

Slide quenching keeps yarn from sliding through its contacts (paper, Simulation method): the length
of yarn between the middles of neighbouring crossovers stays as it is at rest, for seed stretched
along the course only. The paper's equations and the authors' code hold different lengths of yarn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import ConvergenceError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.yarn.model.relaxed_cell import RelaxedCell
from knitcore.yarn.paper.bezier_relax import relaxed_cell
from knitcore.yarn.paper.bezier_stitch import Stitch, published_fabric
from knitcore.yarn.paper.continuation import Continuation


class SlideQuenching(StrEnum):
    """Pieces of yarn that keep their length."""

    NONE = "none"
    PAPER = "paper"
    AS_CODED = "as-coded"

    @property
    def weights(self) -> Array:
        """Weights of the eight curves (yarn order) in the lengths held, shape (rows, 8)."""
        return _WEIGHTS[self]

    @classmethod
    def default(cls, fabric: Fabric, direction: Direction) -> SlideQuenching:
        """The paper's rule: quenched for seed along the course, free otherwise."""
        quenched = fabric is Fabric.SEED and direction is Direction.COURSE
        return cls.PAPER if quenched else cls.NONE


_WEIGHTS = {
    SlideQuenching.NONE: np.empty((0, 8)),
    # ½ B1 + c11 + ½ A1 and ½ A1 + c12 + ½ A2
    SlideQuenching.PAPER: np.array(
        [[0.5, 1.0, 0.5, 0, 0, 0, 0, 0], [0, 0, 0.5, 1.0, 0.5, 0, 0, 0]]
    ),
    # c21 + ½ B1 and c21 + B1 + c11 + ½ A1
    SlideQuenching.AS_CODED: np.array(
        [[0.5, 0, 0, 0, 0, 0, 0, 1.0], [1.0, 1.0, 0.5, 0, 0, 0, 0, 1.0]]
    ),
}


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
        """Stretch with slide quenching or without; by default where the paper had it."""
        quenching = SlideQuenching.default(published_fabric(zero.chart), along)
        if quenched is not None:
            quenching = SlideQuenching.PAPER if quenched else SlideQuenching.NONE
        return cls(zero, along, quenching)

    @property
    def note(self) -> str:
        """Name of the slides that are held; empty if none is."""
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
        reached = path.go([cell.state for cell in known or [zero]], *sizes)
        if reached is None:
            raise ConvergenceError("the yarn locks before it gets there.")
        return relaxed_cell(stitch, loop_mm, *reached)
