"""Loading and unloading with friction: loops, lost energy, and rest sizes that remember."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from knitcore.arrays import Array
from knitcore.bounds import check_range
from knitcore.choice import Choice
from knitcore.errors import Cancelled, check_cancelled
from knitcore.fabric import Direction
from knitcore.yarnlevel.friction import RubbedCell, agitated, rubbed
from knitcore.yarnlevel.limits import check_stretch
from knitcore.yarnlevel.results import RelaxedCell
from knitcore.yarnlevel.solver import COURSE, WALE
from knitcore.yarnlevel.splines import RelaxedRepeat

DEFAULT_POINTS = 24
MAX_CYCLES = 5
TAKE_DOWN_N_PER_MM = 0.02
"""Pull of the take-down along the columns while the fabric is knitted."""
WORN_N_PER_MM = 0.1
"""Pull of the stretched histories, that of snug clothing."""
_STRIDE = 0.02
"""Steps to a pull, in strain."""
MAX_STRIDES = 150


class History(Choice):
    """What happened to the fabric before it was laid down."""

    AGITATED = "agitated"
    KNITTED = "as-knitted"
    STRETCHED_COURSE = "stretched-course"
    STRETCHED_WALE = "stretched-wale"


_PULLS = {
    History.KNITTED: (Direction.WALE, TAKE_DOWN_N_PER_MM),
    History.STRETCHED_COURSE: (Direction.COURSE, WORN_N_PER_MM),
    History.STRETCHED_WALE: (Direction.WALE, WORN_N_PER_MM),
}


@dataclass(frozen=True, eq=False)
class Leg:
    """One way of a loop.

    Attributes
    ----------
    strain, transverse_strain : (n,) along and across the pull, from the agitated rest size.
    stress_n_per_mm : (n,) nominal stress, over the agitated rest width.
    loading : whether the fabric is pulled, not released.
    """

    strain: Array
    transverse_strain: Array
    stress_n_per_mm: Array
    loading: bool

    @property
    def work_n_per_mm(self) -> float:
        """Work of the pull per area of fabric at rest, N·mm/mm² (negative where it comes back)."""
        return float(np.trapezoid(self.stress_n_per_mm, self.strain))


@dataclass(frozen=True, eq=False)
class Hysteresis:
    """Cycles of pulling and letting go, with friction.

    Attributes
    ----------
    direction : of the pull.
    coefficient : of friction between yarns.
    zero : the agitated state, to which strains refer.
    legs : ways there and back in turn; each begins where the last one ended.
    lost_n_mm : energy of one stitch that slipping took in each leg, N·mm.
    """

    direction: Direction
    coefficient: float
    zero: RelaxedRepeat
    legs: tuple[Leg, ...]
    lost_n_mm: Array

    @property
    def lost_per_cycle_n_per_mm(self) -> float:
        """Area of the last loop: energy per area of fabric that one cycle loses, N·mm/mm²."""
        return self.legs[-2].work_n_per_mm + self.legs[-1].work_n_per_mm

    @property
    def lost_share(self) -> float:
        """The same as a share of the work of the pull."""
        return self.lost_per_cycle_n_per_mm / self.legs[-2].work_n_per_mm

    @property
    def left_strain(self) -> float:
        """Strain that remains when the fabric has been released."""
        return float(self.legs[-1].strain[-1])

    @property
    def stiffer_at_turn(self) -> float:
        """Stiffness in the first step of unloading over that in the last of loading (last cycle).

        Without friction it is near 1; the finer the steps, the nearer it comes to the tangents'.
        """
        there, back = self.legs[-2:]
        pulling = np.diff(there.stress_n_per_mm[-2:]) / np.diff(there.strain[-2:])
        easing = np.diff(back.stress_n_per_mm[:2]) / np.diff(back.strain[:2])
        return float(easing[0] / pulling[0])

    @property
    def closes_within(self) -> float:
        """Change of the greatest stress from the first cycle to the last, as a part of it."""
        first, last = self.legs[0].stress_n_per_mm[-1], self.legs[-2].stress_n_per_mm[-1]
        return float(abs(last - first) / abs(first))


@dataclass(frozen=True)
class RestSize:
    """Size of a stitch that is left free of force after a history, mm."""

    history: History
    course_mm: float
    wale_mm: float


def hysteresis(
    relaxed: RelaxedRepeat,
    direction: Direction | str,
    max_strain: float,
    coefficient: float,
    *,
    points: int = DEFAULT_POINTS,
    cycles: int = 2,
    cancelled: Cancelled | None = None,
) -> Hysteresis:
    """Pull in one direction and release until free of force, the other direction free throughout.

    Parameters
    ----------
    relaxed : the repeat, relaxed without friction.
    direction : course or wale.
    max_strain : largest strain, above 0.
    coefficient : of friction between yarns.
    points : strains on the way there.
    cycles : of pulling and letting go; the first begins in the agitated state.

    Raises
    ------
    InputError
        If an input is out of range, or the repeat is too large.
    ConvergenceError, UnravelledError
        If the yarn locks or unravels on the way.
    """
    along = Direction.parse(direction)
    check_stretch(max_strain, points, None)
    check_range("cycles", cycles, 1, MAX_CYCLES)
    rest = relaxed.cell_mm(along)
    steps = rest * (1.0 + np.linspace(0.0, max_strain, points))[1:]
    state = agitated(relaxed)
    legs, lost = [], []
    for _ in range(cycles):
        ahead = steps[steps > state.cell.cell_mm(along) * (1.0 + 1e-9)]
        there = [state, *_pulled(state, along, ahead, coefficient, cancelled)]
        stride = float(steps[0]) - rest
        back = [there[-1], *_released(there[-1], along, stride, coefficient, cancelled)]
        state = back[-1]
        for leg, loading in ((there, True), (back, False)):
            legs.append(_leg(relaxed, along, [s.cell for s in leg], loading))
            lost.append(leg[-1].lost_n_mm - leg[0].lost_n_mm)
    return Hysteresis(along, coefficient, relaxed, tuple(legs), np.array(lost))


def at_rest(
    relaxed: RelaxedRepeat, history: History | str, coefficient: float, *,
    cancelled: Cancelled | None = None,
) -> RubbedCell:  # fmt: skip
    """The fabric, free of force, after a history.

    ``agitated`` is the state without friction; ``as-knitted`` was pulled along the columns by the
    take-down; the stretched ones were pulled by ``WORN_N_PER_MM`` along rows or columns.

    Raises
    ------
    InputError, ConvergenceError, UnravelledError
        See :func:`hysteresis`.
    """
    state = agitated(relaxed)
    what = History.parse(history)
    if what is History.AGITATED:
        return state
    along, pull = _PULLS[what]
    rest, width = relaxed.cell_mm(along), relaxed.cell_mm(along.other)
    sizes = np.asarray(rest * (1.0 + _STRIDE * np.arange(1, MAX_STRIDES + 1)))
    for reached in _pulled(state, along, sizes, coefficient, cancelled):
        state = reached
        if state.cell.force_n[along.axis] >= pull * width:
            break
    *_, state = _released(state, along, _STRIDE * rest, coefficient, cancelled)
    return state


def rest_sizes(
    relaxed: RelaxedRepeat, coefficient: float, *, cancelled: Cancelled | None = None
) -> tuple[RestSize, ...]:
    """Rest size after every history (see :func:`at_rest`)."""
    states = {h: at_rest(relaxed, h, coefficient, cancelled=cancelled).cell for h in History}
    return tuple(RestSize(h, c.cell_course_mm, c.cell_wale_mm) for h, c in states.items())


def _pulled(
    state: RubbedCell,
    along: Direction,
    sizes: Array,
    coefficient: float,
    cancelled: Cancelled | None,
) -> Iterator[RubbedCell]:
    place = (COURSE if along is Direction.COURSE else WALE,)
    for size in sizes:
        check_cancelled(cancelled)
        target = np.array([size, size])
        state = rubbed(state, coefficient, fixed=place, target=target, cancelled=cancelled)
        yield state


def _released(
    state: RubbedCell, along: Direction, stride_mm: float, coefficient: float,
    cancelled: Cancelled | None,
) -> Iterator[RubbedCell]:  # fmt: skip
    """Back in steps until the pull would turn into a push, then free."""
    sizes = np.asarray(state.cell.cell_mm(along) - stride_mm * np.arange(1, 10 * MAX_STRIDES))
    ahead = _pulled(state, along, sizes[sizes > 0.0], coefficient, cancelled)
    for reached in ahead:
        if reached.cell.force_n[along.axis] <= 0.0:
            break
        state = reached
        yield state
    yield rubbed(state, coefficient, cancelled=cancelled)


def _leg(
    zero: RelaxedRepeat, along: Direction, cells: list[RelaxedRepeat], loading: bool
) -> Leg:  # fmt: skip
    def strain(direction: Direction, of: RelaxedCell) -> float:
        return of.cell_mm(direction) / zero.cell_mm(direction) - 1.0

    width = zero.cell_mm(along.other)
    return Leg(
        np.array([strain(along, c) for c in cells]),
        np.array([strain(along.other, c) for c in cells]),
        np.array([c.force_n[along.axis] / width for c in cells]),
        loading,
    )
