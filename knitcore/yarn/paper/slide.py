"""Slide quenching: yarn that may not slide through its contacts (paper, Simulation method).

The paper keeps the length of yarn between the middles of neighbouring crossovers as it is at rest,
for seed stretched along the course only. Its equations and the authors' code hold different lengths
of yarn.
"""

from __future__ import annotations

from enum import StrEnum

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction, Fabric


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
        """As in the paper: quenched for seed along the course, free otherwise."""
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
