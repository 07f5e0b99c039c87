"""A sheet of many stitches that is relaxed in rounds: its windows in turn, and all of it together.

A cell of thousands of stitches is too large for one factor. Its shape is found in rounds. A pass
relaxes windows one after the other by Newton steps, each with the yarn around it at rest (the
alternating method of Schwarz); where the next round's windows end lies in the middle of this
one's. Long waves, the sizes of the sheet, and yarn that passes along a course take many passes;
these come from a descent of all unknowns at once (:mod:`knitcore.yarn.solve.polish`).

Rounds that bring little may have come to a saddle, where a symmetric start stays. Before they end,
every window is therefore asked for a direction of negative curvature, and leaves along it.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import chain, zip_longest

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, ConvergenceError, UnravelledError, check_cancelled
from knitcore.base.threads import on_halves
from knitcore.yarn.kernels.structures import Pairs
from knitcore.yarn.model.cell import YarnCell
from knitcore.yarn.model.constraints import foot_slopes, lean_weights, middle_weights, tip_weights
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.neighbours import reaches
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.newton import COURSE, WALE, Minimum, Options, minimise
from knitcore.yarn.solve.polish import PAIR_CAP, polished
from knitcore.yarn.solve.search import overlong
from knitcore.yarn.solve.topology import SKIN, Trajectory, clearance_at
from knitcore.yarn.solve.windows import Window, each, row_lengths, touch, window_energy, windows

MAX_ROUNDS = 200
_WINDOW = 8
"""Most rows and wales of a window."""
_FIRSTS = ((0, 0), (_WINDOW // 2, _WINDOW // 2), (0, _WINDOW // 2), (_WINDOW // 2, 0))
"""Where the first window of a round begins, round after round."""
_PASS = Options(tolerance=1e-6, iterations=3, mended=False)
_LAST_PASS = Options(tolerance=1e-6, iterations=6)
"""Settings of the last pass: its steps keep the lengths of yarn, which no later pass restores."""
_PROBE = Options(tolerance=1e-3, iterations=4, damping=0.1, mended=False)
"""Settings of a pass whose windows leave saddles: they count as settled early, and seek one."""
_DESCENT_STEPS = 20
_SIZES = 10.0
"""Sizes may still change by this many times the tolerance, as the energy near its minimum hardly
depends on them."""
EXPLORED = 4e-3
"""Least tolerance on the coarser grid."""


@dataclass(frozen=True, eq=False)
class WholeShape:
    """A chart on its way to its shape of least energy, from which it can be continued.

    Attributes
    ----------
    controls : (rows, controls, 3) control points, mm, without the drift of the cell.
    sizes_mm : (2,) size of a stitch.
    tension_n : (rows, wales).
    core_radius_mm : core that the yarn has so far.
    fine : whether it is on the finer of the two grids.
    rounds : energy of a stitch, N·mm, its width and its height, mm, after each round on this grid.
    earlier : rounds on the coarser grid, once on the finer one.
    drawn_in : part of the way to its length that the yarn of other stitches than knits and purls
        has been drawn in.
    evaluations : of the energy, in windows and of the sheet.
    """

    controls: Array
    sizes_mm: Array
    tension_n: Array
    core_radius_mm: float
    fine: bool = False
    rounds: tuple[tuple[float, float, float], ...] = ()
    earlier: int = 0
    evaluations: int = 0
    drawn_in: float = 1.0

    @property
    def state(self) -> Array:
        """Unknowns of the plain cell."""
        return np.concatenate([self.controls.ravel(), self.sizes_mm])

    @property
    def energy_change(self) -> float:
        """Part of the energy that the last round took away; infinite before the second."""
        return self._changes[0]

    @property
    def size_change(self) -> float:
        """Larger relative change of the two sizes in the last round; infinite before the second."""
        return max(map(abs, self._changes[1:]))

    @property
    def may_fall(self) -> float:
        """Part of the energy that further rounds may take away: the last change times all rounds.

        An upper bound if the changes shrink at least as fast as 1/n², n being the round.
        """
        return abs(self.energy_change) * (self.earlier + len(self.rounds))

    @property
    def _changes(self) -> tuple[float, float, float]:
        if len(self.rounds) < 2:
            return (np.inf, np.inf, np.inf)
        energy, wide, high = (b / a - 1.0 for a, b in zip(*self.rounds[-2:], strict=True))
        return -energy, wide, high

    @property
    def change(self) -> float:
        """Smallest tolerance that the last round meets; infinite before the second."""
        return max(abs(self.energy_change), self.size_change / _SIZES)


@dataclass(frozen=True, eq=False, kw_only=True)
class Rounds(ABC):
    """Rounds in which a sheet finds its shape.

    Parameters
    ----------
    yarn : the yarn.
    tolerance : relative change of the energy in a round at which to stop.
    rounds : most of them on each grid.
    flat : hold the middles of all stitches in one plane.
    kept : called with the shape so far after every round.
    progress : called with (done, total).
    cancelled : called before every step; True stops with CancelledError.
    """

    yarn: YarnModel
    tolerance: float
    rounds: int
    flat: bool = False
    kept: Callable[[WholeShape], None] | None = None
    progress: Callable[[float, float], None] | None = None
    cancelled: Cancelled | None = None

    @abstractmethod
    def energy(self, sheet: WholeShape) -> CellEnergy:
        """Energy of the whole sheet."""

    def mended(self, sheet: WholeShape) -> tuple[WholeShape, Minimum, float]:
        """The sheet after a last pass that gives every course its length, as a minimum, and the
        largest force that is left, N."""
        energy = self.energy(sheet)
        for number in range(len(_FIRSTS)):  # again where windows failed and the lengths with them
            sheet = self.one_pass(sheet, energy, _LAST_PASS, number)
            minimum, left_n = self.minimum(energy, sheet)
            if not overlong(energy, minimum):
                break
        return sheet, minimum, left_n

    def settled(self, sheet: WholeShape) -> WholeShape:
        """Rounds until the energy settles, and no window knows how to lower it."""
        enough = self.tolerance if sheet.fine else max(self.tolerance, EXPLORED)
        probed = False
        while len(sheet.rounds) < self.rounds:
            settled = sheet.change <= enough
            if settled and probed:
                break
            probed = settled
            number = len(sheet.rounds)
            sheet = self.one_round(sheet, self.energy(sheet), number, probes=probed)
            self.tell(sheet)
        return sheet

    def one_round(
        self, sheet: WholeShape, energy: CellEnergy, number: int, *, probes: bool
    ) -> WholeShape:
        """The sheet after a pass, in which windows may leave saddles, and a descent."""
        sheet = self.one_pass(sheet, energy, _PROBE if probes else _PASS, number)
        return after_round(sheet, energy, self.descended(sheet, energy, number))

    def descended(self, sheet: WholeShape, energy: CellEnergy, number: int) -> Minimum:
        """Where a descent of the whole sheet leads."""
        path = Trajectory(energy, sheet.state, PAIR_CAP)
        return polished(
            energy, path, sheet.tension_n.mean(axis=1),
            _windows(energy.cell, path.clearance.pairs, number), flat=self.flat,
            steps=_DESCENT_STEPS, cancelled=self.cancelled,
        )  # fmt: skip

    def one_pass(
        self, sheet: WholeShape, energy: CellEnergy, options: Options, number: int = 0
    ) -> WholeShape:
        """The sheet after its windows have been relaxed in turn, two apart at a time."""
        controls, tension = sheet.controls.copy(), sheet.tension_n.copy()
        curve = energy.curve(sheet.state)
        missing = energy.loop_length_mm - row_lengths(energy.cell, curve) / energy.cell.wales

        def settled(window: Window) -> Callable[[], int] | None:
            """Relax a window; returned is a function that lays it into the sheet and tells how many
            evaluations it took, or None where the window cannot be relaxed."""
            rows, wales = window
            part, state = window_energy(
                energy, controls, sheet.sizes_mm, window, missing, flat=self.flat
            )
            pulls = tension[np.ix_(rows.own, wales.own)].mean(axis=1)
            try:
                minimum = minimise(
                    part, state, tension=np.concatenate([pulls, np.zeros(len(part.held))]),
                    fixed=(COURSE, WALE), options=options,
                )  # fmt: skip
            except (ConvergenceError, UnravelledError):  # the next windows divide it elsewhere
                return None

            def lay() -> int:
                place = np.ix_(rows.stitches, each(wales.stitches, energy.cell.grid.controls))
                block = controls[place]
                block[part.cell.free] = minimum.state[:-2].reshape(-1, 3)
                controls[place] = block
                tension[np.ix_(rows.own, wales.own)] = minimum.tension[: len(rows.own), None]
                return minimum.evaluations

            return lay

        laid, evaluations = 0, sheet.evaluations
        near = clearance_at(energy, sheet.state, 2.0 + SKIN)
        covering = _windows(energy.cell, near.pairs, number)
        del near  # its list of pairs is most of the memory
        for some in _side_by_side(covering):
            check_cancelled(self.cancelled)
            for lay in chain.from_iterable(on_halves(lambda of: [*map(settled, of)], some, 2)):
                if lay is not None:
                    evaluations += lay()
                    laid += 1
        if not laid:
            raise UnravelledError("No window of the chart could be relaxed.")
        return replace(sheet, controls=controls, tension_n=tension, evaluations=evaluations)

    def minimum(self, energy: CellEnergy, sheet: WholeShape) -> tuple[Minimum, float]:
        """The sheet as a minimum, and the largest force that is left, N."""
        path = Trajectory(energy, sheet.state, PAIR_CAP)
        tension = sheet.tension_n.mean(axis=1)
        slope = path.slope(tension, hessian=False, lengths=False)
        minimum = Minimum(
            state=sheet.state, tension=tension, terms=path.here.terms,
            force=slope.gradient[-2:].copy(), min_distance_mm=path.min_distance_mm,
            converged=sheet.change <= self.tolerance, stable=False, steps=0,
            evaluations=sheet.evaluations,
        )  # fmt: skip
        left = slope.gradient[:-2].reshape(*sheet.controls.shape)
        if self.flat:
            _take_held_forces(energy.cell, left)
        return minimum, float(np.abs(left).max())

    def tell(self, sheet: WholeShape) -> None:
        """Keep a shape, and tell how near the end it is."""
        if self.kept is not None:
            self.kept(sheet)
        if self.progress is not None:
            self.progress(self.done(sheet), 1.0)

    def done(self, sheet: WholeShape) -> float:
        """Part of the work that is done."""
        # the logarithm of the change falls about evenly
        there = max(sheet.change, self.tolerance)
        near = np.log(min(there, 1.0)) / np.log(self.tolerance) if there < np.inf else 0.0
        share = max(float(near), len(sheet.rounds) / self.rounds)
        core = self.yarn.core_radius_mm
        grown = sheet.core_radius_mm / core if core else 1.0
        return 0.1 * grown + (0.6 if sheet.fine else 0.0) + 0.3 * share


def after_round(sheet: WholeShape, energy: CellEnergy, lowered: Minimum) -> WholeShape:
    """The sheet in a lower state."""
    per_stitch = lowered.terms.energy / energy.cell.stitches
    wide, high = lowered.state[-2:].tolist()
    return replace(
        sheet, controls=energy.cell.controls(lowered.state), sizes_mm=lowered.state[-2:],
        tension_n=np.tile(lowered.tension[:, None], energy.cell.wales),
        rounds=(*sheet.rounds, (per_stitch, wide, high)),
        evaluations=sheet.evaluations + lowered.evaluations,
    )  # fmt: skip


def _take_held_forces(cell: YarnCell, forces: Array) -> None:
    """Take from the forces (rows, controls, 3) on a sheet laid flat what holds it: the middles,
    postures and feet of its stitches."""
    grid = cell.grid
    held = np.array([of(grid)[:-1] for of in (middle_weights, tip_weights, lean_weights)])
    heights = forces[..., 2].reshape(-1, grid.controls)
    heights -= _within(held, heights)
    along = forces[..., 1]
    along -= _within(foot_slopes(grid, cell.wales), along)


def _within(rows: Array, forces: Array) -> Array:
    """The part of forces (n, k) that forces along rows (m, k) can balance."""
    return np.asarray(np.linalg.lstsq(rows.T, forces.T, rcond=None)[0].T @ rows)


def _windows(cell: YarnCell, pairs: Pairs, number: int) -> list[Window]:
    """Windows with as many resting stitches around them as strands reach."""
    around = reaches(pairs, cell.grid.samples, (cell.rows, cell.wales))
    return windows(around, _WINDOW, _FIRSTS[number % len(_FIRSTS)])


def _side_by_side(covering: list[Window]) -> Iterator[list[Window]]:
    """The windows, by twos where neither touches the other."""
    half = -(-len(covering) // 2)
    for first, second in zip_longest(covering[:half], covering[half:]):
        if second is None:
            yield [first]
        elif touch(first, second):
            yield from ([first], [second])
        else:
            yield [first, second]
