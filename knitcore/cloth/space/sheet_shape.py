"""Shape of least energy of a sheet.

A sheet is soft against bending and stiff in its plane, and free edges that roll move far. The
descent is a quasi-Newton one (L-BFGS; Nocedal, Wright, "Numerical Optimization", algorithm 7.4)
around the factor of a convex part of the Hessian, made anew every few steps. No step moves a corner
by more than a part of the thickness, so that the sheet cannot pass through itself.
"""

import time
from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array, rounded, scattered
from knitcore.base.errors import Cancelled, check_cancelled
from knitcore.cloth.space.stitch_sheet import StitchSheet
from knitcore.cloth.space.tangent import Tangent
from knitcore.linear.dense import dot
from knitcore.linear.sheet_factor import SheetFactor

MEMORY = 16
_STRIDE = 0.3
"""Longest displacement of a corner in one step, in thicknesses."""
_SKIN = 0.8
"""Reach of the list of near points beyond those that touch, in thicknesses."""
TOLERANCE = 1e-3
"""Largest force on a corner of a converged sheet, in units of its bending (``force_scale_n``), or
of the load on a corner where that is less."""
_SHIFT = 3e-3
"""Shift of the convex part of the Hessian, in units of the bending stiffness of a corner."""
_RENEW = 32
"""Number of steps with one factor."""
_GROW = 2.0
"""Growth of the longest displacement, over that of the step before."""
_LEAST = 0.1
"""Smallest value of the longest displacement in a step, in units of its greatest value."""
_MIN_STEP = 1e-8
_LARGE = 0.03
"""Share of the largest force from which a force counts as large."""
_AROUND = 8
"""Width, in stitches, of the surroundings of large forces that settle with them."""
_ROUNDING = 1e-10
"""Relative difference below which energies count as equal; then the slope decides."""


@dataclass(frozen=True, eq=False)
class Shape:
    """The result of a descent.

    Parameters
    ----------
    x : (corners, 3), mm.
    energy_n_mm : of the whole sheet.
    residual : largest force on a corner, over the force that turns two stitches by a radian or the
        largest load on a corner, whichever is less.
    converged : whether the residual is below the tolerance.
    steps : evaluations of the energy.
    seconds : CPU time.
    """

    x: Array
    energy_n_mm: float
    residual: float
    converged: bool
    steps: int
    seconds: float


def shake_mm(shape: tuple[int, ...], size_mm: float = 1e-3) -> Array:
    """Random displacements, mm, the same every time: they move a start off a saddle of the energy.

    Parameters
    ----------
    shape : of the result.
    size_mm : their root mean square.
    """
    return scattered(shape, size_mm, seed=0)


def settle(
    sheet: StitchSheet,
    x: Array,
    *,
    held: NDArray[np.bool_] | None = None,
    load_n: Array | None = None,
    floor_mm: float | None = None,
    near: bool = False,
    max_steps: float = np.inf,
    time_limit_s: float = 60.0,
    cancelled: Cancelled | None = None,
) -> Shape:
    """Descend from a shape.

    Parameters
    ----------
    x : (corners, 3) to begin with, mm.
    held : (corners, 3) coordinates that do not change, or (corners,) corners that do not move.
    load_n : (corners, 3) forces that act on the corners, such as their weight.
    floor_mm : height z of a smooth table, below which corners are pushed up.
    near : settle the rectangle around the large forces first, by one step at least. Where a shape
        was at rest before a few stitches were changed, that is most of the way.
    max_steps : evaluations of the energy after which it ends, not converged.
    time_limit_s : CPU time after which it ends, not converged.
    cancelled : called several times in every step; True stops with CancelledError.

    Raises
    ------
    CancelledError
        If ``cancelled`` returned True.
    """
    clock = time.process_time()
    load = None if load_n is None else rounded(load_n)
    descent = _Descent(sheet, rounded(x), held, load, floor_mm, cancelled)
    if near:
        descent.settle_near(time_limit_s)
    descent.run(time_limit_s - (time.process_time() - clock), max_steps)
    return Shape(
        descent.x, descent.energy, descent.residual, descent.residual <= TOLERANCE, descent.steps,
        time.process_time() - clock,
    )  # fmt: skip


class _Descent:
    def __init__(
        self,
        sheet: StitchSheet,
        x: Array,
        held: NDArray[np.bool_] | None,
        load_n: Array | None,
        floor_mm: float | None,
        cancelled: Cancelled | None,
    ) -> None:
        self._sheet = sheet
        self._cancelled = cancelled
        self.x = x
        self._load = load_n
        self._floor = -np.inf if floor_mm is None else floor_mm
        self._free = np.repeat(sheet.used[:, None], 3, axis=1)
        if held is not None:
            self._free[held] = False
        self._tangent = Tangent(sheet)
        self._unit = sheet.force_scale_n
        if load_n is not None:
            self._unit = min(self._unit, float(np.linalg.norm(load_n, axis=1).max()))
        self._shift = _SHIFT * sheet.force_scale_n / float(sheet.membrane[:, :2].mean())
        self._stride = _STRIDE * sheet.thickness_mm
        self._reach = self._stride
        self.steps = self.factors = 0
        self._past: deque[tuple[Array, Array, float]] = deque(maxlen=MEMORY)
        self._factor: SheetFactor | None = None
        self._quick = False  # leaves contact out of the factor, which comes five times as soon
        self._age = 0
        self._list()
        self.energy, self._gradient = self._at(x)

    @property
    def residual(self) -> float:
        """Largest force on a corner, in the units of :class:`Shape`."""
        return float(np.sqrt((self._gradient**2).sum(axis=1).max())) / self._unit

    def load(self, forces_n: Array) -> None:
        """Let forces (corners, 3) act on the corners."""
        self._load = forces_n
        self.energy, self._gradient = self._at(self.x)

    def run(self, time_limit_s: float, max_steps: float) -> None:
        """Descend until the sheet is at rest, or CPU time or steps are used up."""
        clock = time.process_time()
        while self.residual > TOLERANCE and time.process_time() - clock < time_limit_s:
            if self.steps >= max_steps or not self.step():
                break

    def settle_near(self, time_limit_s: float) -> None:
        """Settle a part of the sheet under the forces that the rest exerts on it now."""
        clock = time.process_time()
        sheet, force = self._sheet, np.linalg.norm(self._gradient, axis=1)
        where = np.divmod(np.flatnonzero(force >= _LARGE * force.max()), sheet.columns + 1)
        box = map(_around, where, (sheet.rows, sheet.columns))
        part, corners, rim = sheet.part(*box)
        held = ~self._free[corners] | rim[:, None]
        near = _Descent(part, self.x[corners], held, None, None, self._cancelled)
        near.load(np.where(held, 0.0, near._gradient - self._gradient[corners]))
        near._unit, near._quick = self._unit, True
        while near.residual > TOLERANCE and near.step():
            x = self.x.copy()
            x[corners] = near.x
            energy, gradient = self._at(x)
            if energy >= self.energy:
                return  # it runs into the rest
            self.x, self.energy, self._gradient = x, energy, gradient
            if time.process_time() - clock > time_limit_s:
                return
            self._list_again()

    def step(self) -> bool:
        """Take one step downhill; return False if there is none."""
        if self._factor is None or self._age >= _RENEW:
            self._renew()
        way = self._direction()
        slope = float((way * self._gradient).sum())
        longest = float(np.sqrt((way**2).sum(axis=1).max()))
        fraction = min(1.0, self._reach / longest)
        while fraction > _MIN_STEP:
            moved = fraction * way
            energy, gradient = self._at(self.x + moved)
            if energy <= self.energy + 1e-4 * fraction * slope:
                break
            level = energy <= self.energy + _ROUNDING * abs(self.energy)
            if level and abs(float((way * gradient).sum())) < 0.9 * abs(slope):
                break
            fraction *= 0.4
        else:
            if self._age == 0 and not self._past:
                return False
            self._past.clear()
            self._factor = None
            return True
        change = gradient - self._gradient
        product = float((moved * change).sum())
        if product > 1e-9 * float(np.sqrt((moved**2).sum() * (change**2).sum())):
            self._past.append((moved, change, product))
        self.x, self.energy, self._gradient = self.x + moved, energy, gradient
        self._age += 1
        self._reach = min(self._stride, max(_GROW * fraction * longest, _LEAST * self._stride))
        self._list_again()
        return True

    def _renew(self) -> None:
        """Compute the factor again, with a larger shift where single precision needs it."""
        shift = self._shift
        while not self._factorised(shift):
            shift *= 10.0
        self._age = 0
        self.factors += 1

    def _factorised(self, least: float) -> bool:
        shift = np.full(self.x.shape, least)
        shift[:, 2] += self._sheet.touch_n_per_mm * (self.x[:, 2] < self._floor)
        pairs = self._pairs[:0] if self._quick else self._pairs
        matrix = self._tangent.matrix(self.x, pairs, self._free, convex=True, shift=shift)
        check_cancelled(self._cancelled)
        try:
            apart = self._tangent.is_apart(matrix)
            self._factor = SheetFactor(matrix, self._sheet.columns + 1, again=apart)
        except np.linalg.LinAlgError:
            if least > self._sheet.stiffness_n_per_mm:
                raise  # not a matter of rounding
            return False
        return True

    def _direction(self) -> Array:
        """Two loops of L-BFGS around the factor, for which single precision is enough."""
        q = self._gradient.copy()
        factors = []
        for moved, change, product in reversed(self._past):
            factor = float((moved * q).sum()) / product
            q -= factor * change
            factors.append(factor)
        assert self._factor is not None  # noqa: S101 - made before
        way = self._factor.solve(q.ravel()).reshape(-1, 3)
        for (moved, change, product), factor in zip(self._past, reversed(factors), strict=True):
            way += moved * (factor - float((change * way).sum()) / product)
        return -np.asarray(way)

    def _at(self, x: Array) -> tuple[float, Array]:
        check_cancelled(self._cancelled)
        self.steps += 1
        energy, gradient = self._sheet.energy(x, self._pairs)
        if self._load is not None:
            energy -= float((self._load * x).sum())
            gradient -= self._load
        below = np.minimum(x[:, 2] - self._floor, 0.0)
        energy += 0.5 * self._sheet.touch_n_per_mm * dot(below, below)
        gradient[:, 2] += self._sheet.touch_n_per_mm * below
        gradient[~self._free] = 0.0
        return energy, gradient

    def _list_again(self) -> None:
        """Update the list of near points if others may touch after the next step."""
        far = 0.5 * _SKIN * self._sheet.thickness_mm - self._reach
        if float(((self.x - self._listed) ** 2).sum(axis=1).max()) > far * far:
            self._list()

    def _list(self) -> None:
        self._pairs = self._sheet.pairs(self.x, _SKIN * self._sheet.thickness_mm)
        self._listed = self.x


def _around(places: NDArray[np.int64], stitches: int) -> slice:
    """Range of corners around these; its length has few different values, so that orders of
    elimination are used again."""
    first, last = max(int(places.min()) - _AROUND, 0), min(int(places.max()) + _AROUND, stitches)
    side = min(-((first - last) // _AROUND) * _AROUND, stitches)
    first = min(first, stitches - side)
    return slice(first, first + side + 1)
