"""Loading and unloading with friction: loops, lost energy, and rest sizes that remember."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_count
from knitcore.base.choice import Choice
from knitcore.base.errors import Cancelled, ConvergenceError, check_cancelled
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.yarn.model.input_checks import check_stretch
from knitcore.yarn.model.relaxed_cell import RelaxedCell, Sweep
from knitcore.yarn.solve.friction import RubbedCell, agitated, check_coefficient, rubbed
from knitcore.yarn.solve.newton import COURSE, WALE
from knitcore.yarn.solve.splines import RelaxedRepeat
from knitcore.yarn.study.sweep import follow

DEFAULT_POINTS = 24
MAX_CYCLES = 5
TAKE_DOWN_N_PER_MM = 0.02
"""Pull of the take-down along the columns while the fabric is knitted."""
WORN_N_PER_MM = 0.1
"""Pull of the stretched histories, that of snug clothing."""
_STRIDE = 0.02
"""Strain of a step towards a pull."""
MAX_STRIDES = 150
_FREE = 1e-6
"""Pull that counts as none, as a part of that at which the release began."""
_THERE = 1e-9
"""Part of a size by which it may differ and still count as the same."""
_UNBALANCED = 0.1
"""Part of the larger by which a loop's area and the work against friction may differ without a
note."""
_SLIGHT = 1e-3
"""Part of the work of the pull by which they may, for loops that lose next to nothing."""


class History(Choice):
    """The treatment of the fabric before it was laid down."""

    AGITATED = "agitated"
    KNITTED = "as-knitted"
    STRETCHED_COURSE = "stretched-course"
    STRETCHED_WALE = "stretched-wale"


_PULLS = {
    History.KNITTED: (Direction.WALE, TAKE_DOWN_N_PER_MM),
    History.STRETCHED_COURSE: (Direction.COURSE, WORN_N_PER_MM),
    History.STRETCHED_WALE: (Direction.WALE, WORN_N_PER_MM),
}


@dataclass(frozen=True, eq=False, repr=False)
class Leg(Sweep):
    """One way of a loop, as a stretch; strain and stress refer to the agitated state.

    The stress (N/mm) contains friction, the energy of a cell does not.

    Attributes
    ----------
    loading : whether the fabric is pulled, not released.
    """

    loading: bool = True

    @property
    def work_n_per_mm(self) -> float:
        """Work of the pull per area of fabric at rest, N·mm/mm² (negative where it comes back)."""
        return float(np.trapezoid(self.stress_n_per_mm, self.strain))


@dataclass(frozen=True, eq=False, repr=False)
class Hysteresis(Result):
    """Cycles of pulling and letting go, with friction.

    Attributes
    ----------
    direction : of the pull.
    coefficient : of friction between yarns.
    zero : the agitated state, to which strains refer.
    legs : ways there and back in turn; each begins where the last one ended.
    lost_n_mm : (legs,) work per stitch against friction in each leg, N·mm; below 0 where the
        contacts give back more than slipping takes.
    """

    direction: Direction
    coefficient: float
    zero: RelaxedRepeat
    legs: tuple[Leg, ...]
    lost_n_mm: Array

    @property
    def last_cycle(self) -> Sweep:
        """The last cycle as one stretch, there and back; ``jumps`` are those of the way there."""
        there, back = self.legs[-2:]
        stress = np.concatenate([there.stress_n_per_mm, back.stress_n_per_mm[1:]])
        cells = (*there.cells, *back.cells[1:])
        return Sweep(self.direction, self.zero, cells, stress, there.jumps, self.notes)

    @property
    def turn(self) -> int:
        """Index in the last cycle at which the release begins, that of its largest strain."""
        return len(self.legs[-2].cells) - 1

    @property
    def notes(self) -> tuple[str, ...]:
        """Remarks for the user, in sentences."""
        notes = dict.fromkeys(note for leg in self.legs for note in leg.notes)
        area, work = self.zero.cell_course_mm * self.zero.cell_wale_mm, self.lost_n_mm[-2:].sum()
        # of a loop that does not close, the yarn keeps a part
        kept = self.legs[-1].energy_n_mm[-1] - self.legs[-2].energy_n_mm[0]
        loop = area * self.lost_per_cycle_n_per_mm - kept
        missed, larger = abs(loop - work), max(abs(loop), abs(work))
        if missed > max(_UNBALANCED * larger, _SLIGHT * area * self.legs[-2].work_n_per_mm):
            notes[
                "The loop's area and the work against friction differ by "
                f"{100 * missed / larger:.0f} %: take more points, unless the shape jumps."
            ] = None
        return tuple(notes)

    @property
    def lost_per_cycle_n_per_mm(self) -> float:
        """Area of the last loop: energy per area of fabric that one cycle loses, N·mm/mm²."""
        return self.legs[-2].work_n_per_mm + self.legs[-1].work_n_per_mm

    @property
    def lost_share(self) -> float:
        """Energy that one cycle loses, as a share of the work of the pull."""
        return self.lost_per_cycle_n_per_mm / self.legs[-2].work_n_per_mm

    @property
    def left_strain(self) -> float:
        """Strain that remains when the fabric has been released."""
        return float(self.legs[-1].strain[-1])

    @property
    def closes_within(self) -> float:
        """Change of the greatest stress from the first cycle to the last, over the first."""
        first, last = self.legs[0].stress_n_per_mm[-1], self.legs[-2].stress_n_per_mm[-1]
        return float(abs(last - first) / abs(first))


@dataclass(frozen=True, eq=False, repr=False)
class RestSize(Result):
    """Size of a stitch that is left free of force after a history, and the yarn's state there."""

    history: History
    state: RubbedCell

    @property
    def course_mm(self) -> float:
        """Width of the stitch, mm."""
        return self.state.cell.cell_course_mm

    @property
    def wale_mm(self) -> float:
        """Height of the stitch, mm."""
        return self.state.cell.cell_wale_mm


@dataclass(eq=False)
class RubbedStretch:
    """Pulling with friction along a direction: a stretch (:mod:`knitcore.yarn.study.sweep`) whose
    every step goes on from the state that the steps before it have left.

    Attributes
    ----------
    state : reached so far.
    along : direction of the pull.
    coefficient : of friction between yarns.
    """

    state: RubbedCell
    along: Direction
    coefficient: float
    cancelled: Cancelled | None = None
    note: str = ""

    def reach(self, known: Sequence[RelaxedCell], size_mm: float) -> RelaxedRepeat:
        """The state at a size of a stitch along the pull, one step from the last.

        Raises
        ------
        ConvergenceError, UnravelledError
            If the yarn locks or unravels before it gets there; the last state remains.
        """
        del known  # the forces of friction are in the state
        check_cancelled(self.cancelled)
        if abs(size_mm - self.state.cell.cell_mm(self.along)) > _THERE * size_mm:
            place = (COURSE if self.along is Direction.COURSE else WALE,)
            self._step(fixed=place, target=np.array([size_mm, size_mm]))
        return self.state.cell

    def release(self, stride_mm: float) -> Iterator[RelaxedRepeat]:
        """Back in steps until the pull would turn into a push, then free."""
        begin = self.state.cell
        least = _FREE * begin.force_n[self.along.axis]
        sizes = begin.cell_mm(self.along) - stride_mm * np.arange(1, 10 * MAX_STRIDES)
        for size in sizes[sizes > 0.0]:
            before = self.state
            if self.reach((), float(size)).force_n[self.along.axis] <= least:
                self.state = before
                break
            yield self.state.cell
        self._step()
        yield self.state.cell

    def _step(self, **held: Any) -> None:
        self.state = rubbed(self.state, self.coefficient, cancelled=self.cancelled, **held)


def pull(
    begin: RelaxedRepeat | RubbedCell,
    direction: Direction | str,
    max_strain: float,
    coefficient: float,
    *,
    points: int = DEFAULT_POINTS,
    max_stress_n_per_mm: float | None = None,
    cancelled: Cancelled | None = None,
) -> Leg:
    """Pull in one direction with friction, the other direction free of force.

    Where the yarn locks or unravels, the pull ends, with a note. The other parameters are those of
    :func:`hysteresis`.

    Parameters
    ----------
    begin : a relaxed repeat, which begins in its agitated state, or a state free of force that
        other pulls have left; strains and stresses refer to its size.
    max_stress_n_per_mm : stop beyond this nominal stress.

    Raises
    ------
    InputError
        If an input is out of range, or the repeat is too large or held.
    CancelledError
        If ``cancelled`` says so.
    """
    along = Direction.parse(direction)
    check_stretch(max_strain, points, max_stress_n_per_mm)
    state = begin if isinstance(begin, RubbedCell) else agitated(begin)
    stretch = RubbedStretch(state, along, coefficient, cancelled)
    strain = np.linspace(0.0, max_strain, points)
    return _pulled(stretch, state.cell, strain, max_stress_n_per_mm)


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
    points : number of strains on the way there, the first of them 0.
    cycles : number of times to pull and let go; the first begins in the agitated state.
    cancelled : called before every step; True stops with CancelledError.

    Where the yarn locks or unravels on the way there, the fabric turns, with a note.

    Raises
    ------
    InputError
        If an input is out of range, or the repeat is too large or held.
    ConvergenceError, UnravelledError
        If the yarn locks in the first step, or unravels on the way back.
    CancelledError
        If ``cancelled`` says so.
    """
    along = Direction.parse(direction)
    check_stretch(max_strain, points, None)
    check_count("cycles", cycles, 1, MAX_CYCLES)
    stretch = RubbedStretch(agitated(relaxed), along, coefficient, cancelled)
    strain = np.linspace(0.0, max_strain, points)
    legs, lost = [], [0.0]
    for _ in range(cycles):
        legs.append(_pulled(stretch, relaxed, strain))
        lost.append(stretch.state.lost_n_mm)
        if len(legs[-1].cells) < 2:
            raise ConvergenceError(
                "The yarn locks in the first step. Ask for less strain, or for more points."
            )
        strain = strain[: len(legs[0].cells)]
        legs.append(_released(stretch, relaxed, float(strain[1])))
        lost.append(stretch.state.lost_n_mm)
    return Hysteresis(along, coefficient, relaxed, tuple(legs), np.diff(lost))


def at_rest(
    relaxed: RelaxedRepeat, history: History | str, coefficient: float, *,
    cancelled: Cancelled | None = None,
) -> RubbedCell:  # fmt: skip
    """The fabric, free of force, after a history.

    ``agitated`` is the state without friction; ``as-knitted`` was pulled along the columns by the
    take-down; the stretched ones were pulled by ``WORN_N_PER_MM`` along rows or columns.

    Raises
    ------
    InputError
        If the coefficient is out of range, or the repeat is too large or held.
    ConvergenceError, UnravelledError
        If the yarn locks or unravels on the way.
    """
    check_coefficient(coefficient)
    state = agitated(relaxed)
    what = History.parse(history)
    if what is History.AGITATED:
        return state
    along, force = _PULLS[what]
    stretch = RubbedStretch(state, along, coefficient, cancelled)
    stride, width = _STRIDE * relaxed.cell_mm(along), relaxed.cell_mm(along.other)
    for step in range(1, MAX_STRIDES + 1):
        reached = stretch.reach((), relaxed.cell_mm(along) + step * stride)
        if reached.force_n[along.axis] >= force * width:
            break
    for _ in stretch.release(stride):
        pass
    return stretch.state


def rest_sizes(
    relaxed: RelaxedRepeat, coefficient: float, *, cancelled: Cancelled | None = None
) -> tuple[RestSize, ...]:
    """Rest size after every history (see :func:`at_rest`)."""
    return tuple(
        RestSize(h, at_rest(relaxed, h, coefficient, cancelled=cancelled)) for h in History
    )


def _pulled(
    stretch: RubbedStretch, zero: RelaxedRepeat, strain: Array, max_stress: float | None = None
) -> Leg:
    """Onward from where the fabric is, to the strains beyond."""
    along = stretch.along
    here = stretch.state.cell.cell_mm(along) / zero.cell_mm(along) - 1.0
    ahead = np.concatenate([[here], strain[strain > here + _THERE]])
    curve = follow(
        stretch, zero, along, ahead, max_stress_n_per_mm=max_stress, back=False,
        cancelled=stretch.cancelled,
    )  # fmt: skip
    return Leg(along, zero, curve.cells, curve.stress_n_per_mm, curve.jumps, curve.notes)


def _released(stretch: RubbedStretch, zero: RelaxedRepeat, stride: float) -> Leg:
    """Back until free of force, in steps of a strain."""
    along = stretch.along
    cells = (stretch.state.cell, *stretch.release(stride * zero.cell_mm(along)))
    force = np.array([cell.force_n[along.axis] for cell in cells])
    return Leg(along, zero, cells, force / zero.cell_mm(along.other), loading=False)
