"""Continuation of a stitch from one size to another in small steps, always in equilibrium."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from knitcore.base.arrays import Array
from knitcore.yarn.paper.bezier_stitch import Stitch
from knitcore.yarn.paper.certificate import is_certified, is_clasped
from knitcore.yarn.paper.minimise import BezierMinimum, HeldLengths, minimise_bezier

SEGMENT_FLOOR = 0.014
"""Shortest curve, in loop lengths: 0.15 mm in the paper's acrylic garter; others stay longer."""
STEP = 0.012
"""Longest step, in loop lengths (the authors' are 0.003 to 0.016)."""
_SHORTER = (1.0, 0.25)
"""Shares of a step that are tried before giving up."""


def free_constraints(
    loop_length_mm: float, cell_course_mm: float | None = None, cell_wale_mm: float | None = None
) -> HeldLengths:
    """Constraints of a relaxation without slide quenching."""
    return HeldLengths(cell_course_mm, cell_wale_mm, SEGMENT_FLOOR * loop_length_mm)


def is_admissible(stitch: Stitch, minimum: BezierMinimum) -> bool:
    """Tell whether the yarn is knotted as it should be, has not passed through yarn, and no core
    overlaps another."""
    return minimum.certified and has_room(stitch, minimum) and is_clasped(stitch, minimum.unknowns)


def has_room(stitch: Stitch, minimum: BezierMinimum) -> bool:
    """Tell whether every core is outside every other."""
    return minimum.evaluation.closest_mm > 2.0 * stitch.yarn.core_radius_mm


@dataclass(frozen=True, eq=False)
class Continuation:
    """Continuation of one stitch.

    Parameters
    ----------
    stitch : the stitch.
    loop_length_mm : length of its yarn, mm.
    held, held_mm : stretches of yarn that keep their length, as in
        :class:`~knitcore.yarn.paper.minimise.HeldLengths`.
    """

    stitch: Stitch
    loop_length_mm: float
    held: Array = field(default_factory=lambda: np.empty((0, 8)))
    held_mm: Array = field(default_factory=lambda: np.empty(0))

    def go(
        self, path: Sequence[Array], course_mm: float | None, wale_mm: float | None
    ) -> tuple[BezierMinimum, int] | None:
        """Go from the last unknowns of a path to given sizes (None: free).

        Returns
        -------
        The state there and the evaluations it took; None if an equilibrium was missing on the way.
        """
        known = list(path[-2:])
        target = [math.nan if size is None else size for size in (course_mm, wale_mm)]
        evaluations = 0
        while True:
            here = known[-1][-2:]
            left = np.nan_to_num(np.array(target) - here)
            count = max(1, math.ceil(np.abs(left).max() / (STEP * self.loop_length_mm) - 1e-9))
            step = None
            for share in _SHORTER:
                next_sizes = here + share * left / count
                step = self._step(
                    known,
                    *(
                        None if math.isnan(t) else float(s)
                        for t, s in zip(target, next_sizes, strict=True)
                    ),
                )
                if step is not None:
                    break
                known = known[-1:]
            if step is None:
                return None
            evaluations += step.evaluations
            known = [known[-1], step.unknowns]
            if np.nanmax(np.abs(np.array(target) - step.unknowns[-2:])) < 1e-9:
                return step, evaluations

    def _step(
        self, known: list[Array], course_mm: float | None, wale_mm: float | None
    ) -> BezierMinimum | None:
        """One minimisation, started on the line through the last two states if there are two."""
        last = known[-1]
        starts = [last]
        if len(known) == 2:
            change = last - known[0]
            goal = _resized(last, course_mm, wale_mm)[-2:] - last[-2:]
            held = [size is not None for size in (course_mm, wale_mm)]
            moved = change[-2:][held]
            if np.any(np.abs(moved) > 1e-9):
                ratio = float(goal[held] @ moved / (moved @ moved))
                starts.insert(0, last + np.clip(ratio, -2.0, 2.0) * change)
        for start in starts:
            free = free_constraints(self.loop_length_mm, course_mm, wale_mm)
            rules = replace(free, held=self.held, held_mm=self.held_mm)
            first = _resized(start, course_mm, wale_mm)
            minimum = minimise_bezier(self.stitch, first, self.loop_length_mm, rules, near=True)
            if (
                minimum.converged
                and is_admissible(self.stitch, minimum)
                and is_certified(self.stitch, last, _resized(start, course_mm, wale_mm))
            ):
                return minimum
        return None


def _resized(start: Array, course_mm: float | None, wale_mm: float | None) -> Array:
    out = start.copy()
    for i, size in ((-2, course_mm), (-1, wale_mm)):
        if size is not None:
            out[i] = size
    return out
