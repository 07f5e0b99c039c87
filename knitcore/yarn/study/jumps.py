"""Jumps along a stretch: steps at which the shape changes abruptly."""

from itertools import pairwise

import numpy as np

from knitcore.base.arrays import Array

_JUMP = 4.0
"""A step whose shape changes this much more than the steps around it is a jump."""
_JUMP_FLOOR = 0.004
"""The change is also at least this much, root mean square over the stitch, in loop lengths."""


def find_jumps(centre_lines: list[Array], loop_length_mm: float) -> tuple[int, ...]:
    """Steps i, from state i - 1 to i, at which the shape changes far more than at those around.

    The change is the root mean square displacement of the centre lines, less its mean and affine
    part. Fewer than four states have no jumps.

    Parameters
    ----------
    centre_lines : one state after the other, mm, each (courses, points, 3).
    loop_length_mm : mean length of yarn in a stitch.
    """
    if len(centre_lines) < 4:
        return ()
    changes = np.array(
        [_change(before, after) / loop_length_mm for before, after in pairwise(centre_lines)]
    )
    jumps = []
    for i, change in enumerate(changes):
        around = np.delete(changes[max(i - 4, 0) : i + 5], min(i, 4))
        if change > _JUMP_FLOOR and change > _JUMP * float(np.median(around)):
            jumps.append(i + 1)
    return tuple(jumps)


def _change(before: Array, after: Array) -> float:
    a, b = before.reshape(-1, 3), after.reshape(-1, 3)
    a, b = a - a.mean(axis=0), b - b.mean(axis=0)
    affine = np.linalg.lstsq(a, b, rcond=None)[0]
    return float(np.sqrt(np.mean(np.sum((b - a @ affine) ** 2, axis=1))))
