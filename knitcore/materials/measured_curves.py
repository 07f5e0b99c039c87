"""Measured stress–strain curves that are stored with a material."""

from dataclasses import dataclass

import numpy as np

from knitcore.base.errors import InputError

MAX_POINTS = 100
"""Most points of a stored curve: more than a plot shows."""


@dataclass(frozen=True)
class MeasuredCurve:
    """A stress–strain curve as it was measured, in the order of the pull.

    Parameters
    ----------
    strain : engineering strain along the pull, increasing.
    stress_n_per_mm : force per clamped width.
    pulls : number of pulls behind it.

    Raises
    ------
    InputError
        If it has fewer than two points or too many, is not finite, or does not increase in strain.
    """

    strain: tuple[float, ...]
    stress_n_per_mm: tuple[float, ...]
    pulls: int = 1

    def __post_init__(self) -> None:
        points = len(self.strain)
        if points != len(self.stress_n_per_mm) or not 2 <= points <= MAX_POINTS:
            problem = f"a curve of {points} strains and {len(self.stress_n_per_mm)} stresses."
            remedy = f"Give 2 to {MAX_POINTS} points, a stress for each strain."
            raise InputError("measured", problem, remedy)
        if not np.all(np.isfinite([self.strain, self.stress_n_per_mm])):
            raise InputError(
                "measured", "a curve has values that are not finite.", "Leave those points out."
            )
        if np.any(np.diff(self.strain) <= 0):
            raise InputError(
                "measured", "the strains of a curve do not increase.", "Give a pull, not a cycle."
            )
