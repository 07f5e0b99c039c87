"""Starting shapes for a descent: a sheet bent about one direction.

A strip with the mean properties of a piece shows much faster what the piece does as a whole: it
rolls from the sides, rolls from top and bottom, or folds. The best start is the one of least energy
among the two bent sheets and the flat one.
"""

from dataclasses import replace

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled
from knitcore.cloth.space.sheet_shape import settle, shake_mm
from knitcore.cloth.space.stitch_sheet import Net, StitchSheet

_ALIKE = 0.1
"""Relative difference below which energies count as equal. Of two bent shapes of equal energy the
one bent the shorter way is taken, so that the long edges roll; of a bent and the flat shape, the
flat one."""

_STEPS = 1700
"""Largest number of steps of a strip. A strip of 100 stitches comes to rest within them; longer
ones have rolled up far enough to be compared. Their ends are far away, and no step moves them by a
millimetre."""


def start(
    sheet: StitchSheet, *, time_limit_s: float = 60.0, cancelled: Cancelled | None = None
) -> Array:
    """A shape from which to descend, (corners, 3), mm, slightly perturbed.

    Parameters
    ----------
    time_limit_s : CPU time for each of the two strips.
    cancelled : called before every step; True stops with CancelledError.

    Raises
    ------
    CancelledError
        If ``cancelled`` returned True.
    """
    width, height, _ = np.ptp(sheet.flat_mm, axis=0)
    shorter_first = (0, 1) if height <= width else (1, 0)
    bent = [_bent(sheet, axis, time_limit_s, cancelled) for axis in shorter_first]
    energy = [_energy(sheet, shape) for shape in bent]
    best = bent[0] if energy[0] < (1.0 + _ALIKE) * energy[1] else bent[1]
    if min(energy) > (1.0 - _ALIKE) * _energy(sheet, sheet.flat_mm):
        best = sheet.flat_mm
    return np.asarray(best + shake_mm(best.shape))


def _bent(sheet: StitchSheet, axis: int, time_limit_s: float, cancelled: Cancelled | None) -> Array:
    strip = strip_of(sheet, axis)
    plane = np.zeros(strip.flat_mm.shape, dtype=bool)
    plane[:, axis] = True  # a strip would roll up into a helix
    shape = settle(
        strip, _shaken(strip), held=plane, max_steps=_STEPS, time_limit_s=time_limit_s,
        cancelled=cancelled,
    )  # fmt: skip
    return extruded(sheet, axis, shape.x)


def strip_of(sheet: StitchSheet, axis: int) -> StitchSheet:
    """A strip one stitch wide with the mean properties of the sheet's lines.

    Parameters
    ----------
    axis : 0 for a strip up the columns, 1 for one along the rows.
    """
    shape = sheet.rows, sheet.columns
    rows, columns = (shape[0], 1) if axis == 0 else (1, shape[1])
    across = 1 - axis
    membrane = sheet.membrane.reshape(*shape, -1).mean(axis=across).reshape(-1, 6)
    twisting = sheet.twisting.reshape(shape).mean(axis=across)
    along_count = shape[0] * (shape[1] - 1)
    along, up = np.split(sheet.turning, [along_count])
    lines = (along if axis else up).reshape(shape[across], shape[axis] - 1, 4)
    weight = lines[..., :1]
    turning = lines.mean(axis=0)
    turning[:, 1] = (weight * lines).mean(axis=0)[:, 1] / weight.mean(axis=0)[:, 0]
    corners = sheet.flat_mm.reshape(shape[0] + 1, shape[1] + 1, 3)
    middle = corners.shape[across] // 2
    flat = corners.take([middle - 1, middle], axis=across).reshape(-1, 3)
    net = Net.of(rows, columns)
    return replace(
        sheet, rows=rows, columns=columns, flat_mm=flat, quarters=net.quarters,
        membrane=membrane, hinges=net.hinges, turning=turning, quads=net.quads, twisting=twisting,
    )  # fmt: skip


def extruded(sheet: StitchSheet, axis: int, strip_mm: Array) -> Array:
    """Bend a sheet like the strip of it, (corners, 3), mm."""
    shape = sheet.rows + 1, sheet.columns + 1
    bent = sheet.flat_mm.reshape(*shape, 3).copy()
    if axis == 0:
        line = strip_mm.reshape(shape[0], 2, 3).mean(axis=1)
        bent[..., 1:] = line[:, None, 1:]
    else:
        line = strip_mm.reshape(2, shape[1], 3).mean(axis=0)
        bent[..., ::2] = line[None, :, ::2]
    return bent.reshape(-1, 3)


def _shaken(strip: StitchSheet) -> Array:
    """Lift a flat strip a little, both sides alike, so that it does not twist."""
    sides = (strip.rows + 1, 1) if strip.columns == 1 else (1, strip.columns + 1)
    lift = shake_mm(sides)
    shaken = strip.flat_mm.copy()
    shaken[:, 2] += np.broadcast_to(lift, (strip.rows + 1, strip.columns + 1)).ravel()
    return shaken


def _energy(sheet: StitchSheet, x: Array) -> float:
    return sheet.energy(x, sheet.pairs(x))[0]
