"""A whole chart at the yarn level: its windows relaxed in turn, and the sheet together.

A cell of thousands of stitches is too large for one factor. Its shape is found in rounds. A pass
relaxes windows one after the other by Newton steps, each with the yarn around it at rest (the
alternating method of Schwarz); where the next round's windows end lies in the middle of this
one's. Long waves, the sizes of the sheet, and yarn that passes along a course take many passes;
these come from a descent of all unknowns at once (:mod:`knitcore.yarn.solve.polish`).

Rounds that bring little may have come to a saddle, where a symmetric start stays. Before they end,
every window is therefore asked for a direction of negative curvature, and leaves along it. A chart
of up to ``MAX_STITCHES`` stitches ends in Newton's method for the sheet, at a minimum.
"""

import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, zip_longest

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_count, check_range
from knitcore.base.errors import (
    Cancelled,
    ConvergenceError,
    InputError,
    UnravelledError,
    check_cancelled,
)  # fmt: skip
from knitcore.base.threads import on_halves, one_blas_thread
from knitcore.chart.stitch_chart import StitchChart, check_stitches
from knitcore.yarn.kernels.structures import Pairs
from knitcore.yarn.model.cell import YarnCell, free_cell, plain_cell
from knitcore.yarn.model.constraints import foot_slopes, lean_weights, middle_weights, tip_weights
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import SPACING_PER_BENDING, STIFF_SPACING_PER_BENDING, CellEnergy
from knitcore.yarn.model.input_checks import check_loop
from knitcore.yarn.model.neighbours import reaches
from knitcore.yarn.model.relaxed_cell import Branch
from knitcore.yarn.model.start_shape import start_state
from knitcore.yarn.model.tiling import refined_state, tiled_state
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.growth import (
    FIRST_OPENING,
    OPENING,
    START_HEIGHT,
    core_that_fits,
    does_not_fit,
    with_stiff_shell,
)  # fmt: skip
from knitcore.yarn.solve.images import same_for_images
from knitcore.yarn.solve.newton import COURSE, TIGHT, WALE, Minimum, Options, minimise
from knitcore.yarn.solve.polish import PAIR_CAP, polished
from knitcore.yarn.solve.search import RELAXED, UNSETTLED, outcome, overlong
from knitcore.yarn.solve.splines import (
    COARSE,
    ROUGH,
    RelaxedRepeat,
    loop_lengths,
    relax_splines,
    relaxed_repeat,
)  # fmt: skip
from knitcore.yarn.solve.topology import SKIN, Trajectory, clearance_at
from knitcore.yarn.solve.windows import Window, each, row_lengths, touch, window_energy, windows
from knitcore.yarn.study.lowest import MAX_STITCHES, without_mirrors

MAX_STITCHES_WHOLE = 4_000
"""Largest chart that is relaxed as a whole."""
MAX_ROUNDS = 200
_WINDOW = 8
"""Most rows and wales of a window."""
WINDOWS_FROM = 100
"""Cells of at least this many stitches relax faster, and mostly to lower energies, in windows than
with one factor."""
SECONDS_PER_STITCH = 0.25
"""CPU time (measured, an upper estimate)."""
_FIRSTS = ((0, 0), (_WINDOW // 2, _WINDOW // 2), (0, _WINDOW // 2), (_WINDOW // 2, 0))
"""Where the first window of a round begins, round after round."""
_GROWING = Options(tolerance=1e-3, iterations=4, mended=False)
_PASS = Options(tolerance=1e-6, iterations=3, mended=False)
_LAST_PASS = Options(tolerance=1e-6, iterations=6)
"""Settings of the last pass: its steps keep the lengths of yarn, which no later pass restores."""
_PROBE = Options(tolerance=1e-3, iterations=4, damping=0.1, mended=False)
"""Settings of a pass whose windows leave saddles: they count as settled early, and seek one."""
_EXACT_FLAT = 36
"""Largest chart laid flat that ends in Newton's method: what holds it is not in the sparse matrix,
which takes many damped steps."""
_DESCENT_STEPS = 20
_SIZES = 10.0
"""Sizes may still change by this many times the tolerance, as the energy near its minimum hardly
depends on them."""
_EXPLORED = 4e-3
"""Least tolerance on the coarser grid."""
_REPEAT = 36
"""A chart with a repeat of up to this many stitches starts from that, relaxed."""
_PATIENCE = 12
"""Passes in which a core may fail to grow."""


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


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class RelaxedChart(RelaxedRepeat):
    """A chart relaxed as a whole.

    Attributes
    ----------
    rounds : on both grids.
    energy_change : part of the energy that the last round took away; 0 where Newton's method
        followed, as are the next two.
    size_change : larger relative change of width and height in it.
    may_fall : part of the energy that further rounds may take away.
    largest_force_n : that is left on the yarn.
    """

    rounds: int
    energy_change: float
    size_change: float
    may_fall: float
    largest_force_n: float


def relax_whole(
    chart: StitchChart,
    yarn: YarnModel,
    loop_length_mm: ArrayLike,
    *,
    convention: Convention | str = Convention.PUBLISHED,
    flat: bool = False,
    tolerance: float = 1e-3,
    rounds: int = 40,
    resume: WholeShape | None = None,
    kept: Callable[[WholeShape], None] | None = None,
    progress: Callable[[float, float], None] | None = None,
    cancelled: Cancelled | None = None,
) -> RelaxedChart:
    """Shape of least energy of a chart of up to ``MAX_STITCHES_WHOLE`` stitches, free of force.

    The chart repeats; no symmetry is imposed. A chart of up to ``MAX_STITCHES`` stitches (fewer if
    it lies flat) ends in Newton's method, at a minimum. For a larger one ``converged`` says whether
    the last round changed the energy, and the sizes, by less than the tolerance allows; the result
    also says how much they changed and how far the energy may still fall.

    Parameters
    ----------
    chart : the chart, taken as it stands.
    yarn : the yarn.
    loop_length_mm : mm of yarn per stitch, one number or one for every course of the chart or of
        its repeat, bottom first.
    convention : factors of the energy.
    flat : hold the middles of all stitches in one plane, as in a fabric laid flat, without folds;
        no yarn passes from stitch to stitch, and those in like surroundings tip and lean alike.
    tolerance : relative change of the energy in a round at which to stop; the sizes may then change
        by ten times as much.
    rounds : most rounds on each of the two grids, at least two.
    resume : where an earlier call was, as it gave it to ``kept``.
    kept : called with the shape so far after every round.
    progress : called with (done, total).
    cancelled : called before every step; True stops with CancelledError.

    Raises
    ------
    InputError
        If the loop is too short or too long for the yarn, the chart is too large, or ``resume`` is
        of another chart.
    ConvergenceError
        If the yarn does not fit into its loop.
    UnravelledError
        If the stitches come undone.
    CancelledError
        If ``cancelled`` says so.
    """
    check_stitches(chart.stitches, MAX_STITCHES_WHOLE, "a whole chart")
    check_range("tolerance", tolerance, 1e-6, 0.1)
    check_count("rounds", rounds, 2, MAX_ROUNDS)
    _, lengths = loop_lengths(loop_length_mm, chart, by_stitch=False)
    for length in np.unique(lengths):
        check_loop(yarn, float(length))
    work = _Work(
        chart, yarn, np.resize(lengths, chart.rows), Convention.parse(convention), flat,
        tolerance, rounds, kept, progress, cancelled,
    )  # fmt: skip
    with one_blas_thread():
        return work.relaxed(resume)


def explored(energy: CellEnergy, cancelled: Cancelled | None = None) -> Minimum:
    """Where rounds lead from the first shape of a cell without symmetry, on the coarser grid.

    ``energy`` is that of the cell on this grid. Mostly this shape is lower than the one to which
    Newton's method leads from there.
    """
    work = _Work(
        StitchChart(energy.cell.purl), energy.yarn, energy.loop_length_mm, energy.convention,
        False, _EXPLORED, MAX_ROUNDS, None, None, cancelled,
    )  # fmt: skip
    with one_blas_thread():
        _, minimum, _ = work.mended(work.settled(work.grown(work.first_shape())))
    return minimum


@dataclass(frozen=True, eq=False)
class _Work:
    chart: StitchChart
    yarn: YarnModel
    loop_lengths_mm: Array
    convention: Convention
    flat: bool
    tolerance: float
    rounds: int
    kept: Callable[[WholeShape], None] | None
    progress: Callable[[float, float], None] | None
    cancelled: Cancelled | None

    def relaxed(self, resume: WholeShape | None) -> RelaxedChart:
        clock = time.process_time()
        sheet = self._first() if resume is None else self._checked(resume)
        if not sheet.fine:
            sheet = self.settled(self.grown(sheet))
            sheet = self._refined(sheet)
        sheet, minimum, left_n = self.mended(self.settled(self.grown(sheet)))
        energy = replace(self.energy(sheet), flat=self.flat)
        became = outcome(energy, minimum)
        if became not in (RELAXED, UNSETTLED):
            raise UnravelledError(f"The relaxed chart is not a fabric: {became}.")
        rounds = sheet.earlier + len(sheet.rounds)
        changes = (sheet.energy_change, sheet.size_change, sheet.may_fall)
        note = (
            f"The last of {rounds} rounds changed the energy by {-sheet.energy_change:+.2%} and a "
            f"size by {sheet.size_change:.2%}; more rounds may take up to {sheet.may_fall:.1%} of "
            f"the energy away. Forces of up to {left_n:.1e} N are left on the yarn."
        )
        exact = self._exact(energy, minimum)
        if exact is not None:
            minimum, changes = exact, (0.0, 0.0, 0.0)
            where = "a minimum, though perhaps not the lowest" if exact.stable else "rest"
            note = f"After {rounds} rounds, Newton's method brought the chart to {where}."
            path = Trajectory(energy, minimum.state, PAIR_CAP)
            left_n = float(np.abs(path.slope(minimum.tension, hessian=False).gradient).max())
        repeat = relaxed_repeat(
            self.chart, energy, Branch.FREE, minimum, seconds=time.process_time() - clock,
            evaluations=sheet.evaluations + (minimum.evaluations if exact else 0),
            notes=(note,),
        )  # fmt: skip
        if exact is not None:
            repeat = replace(repeat, minimum=minimum.stable)
        return RelaxedChart(
            **vars(repeat), rounds=rounds, energy_change=changes[0], size_change=changes[1],
            may_fall=changes[2], largest_force_n=left_n,
        )  # fmt: skip

    def _exact(self, energy: CellEnergy, begin: Minimum) -> Minimum | None:
        """The minimum that Newton's method finds for the sheet; None where it is too large, or
        finds none."""
        if energy.cell.stitches > (_EXACT_FLAT if self.flat else MAX_STITCHES):
            return None
        tension = np.append(begin.tension, np.zeros(energy.constraints - len(begin.tension)))
        try:
            minimum = minimise(
                energy, begin.state, tension=tension, options=TIGHT, cancelled=self.cancelled
            )  # fmt: skip
        except (ConvergenceError, UnravelledError):
            return None
        return minimum if outcome(energy, minimum) == RELAXED else None

    def mended(self, sheet: WholeShape) -> tuple[WholeShape, Minimum, float]:
        """The sheet after a last pass that gives every course its length, as a minimum, and the
        largest force that is left, N."""
        energy = self.energy(sheet)
        for number in range(len(_FIRSTS)):  # again where windows failed and the lengths with them
            sheet = self._one_pass(sheet, energy, _LAST_PASS, number)
            minimum, left_n = self._minimum(energy, sheet)
            if not overlong(energy, minimum):
                break
        return sheet, minimum, left_n

    def energy(self, sheet: WholeShape) -> CellEnergy:
        """Energy of the whole sheet."""
        grid, spacing = (
            (COARSE, SPACING_PER_BENDING) if sheet.fine else (ROUGH, STIFF_SPACING_PER_BENDING)
        )
        return CellEnergy(
            plain_cell(self.chart, grid), self.yarn, self.loop_lengths_mm, self.convention,
            spacing_per_bending=spacing,
        )  # fmt: skip

    def _first(self) -> WholeShape:
        repeat = self.chart.repeat().stitches
        uniform = bool(np.ptp(self.loop_lengths_mm) == 0.0)
        if uniform and repeat <= _REPEAT and repeat < self.chart.stitches:
            return self._tiled()
        return self.first_shape()

    def first_shape(self) -> WholeShape:
        """The first shape of the whole chart, with as thick a core as fits."""
        cell = plain_cell(self.chart, ROUGH)
        height = START_HEIGHT * self.yarn.radius_mm
        state = start_state(cell, float(self.loop_lengths_mm.mean()), height)
        sheet = WholeShape(cell.controls(state), state[-2:], np.zeros(self.chart.purl.shape), 0.0)
        return self._fitted(sheet, FIRST_OPENING)

    def _tiled(self) -> WholeShape:
        """The chart's repeat, relaxed and laid out; without its mirrors, unless it is held flat."""
        repeat = self.chart.repeat()
        part = repeat.resized(
            _least(repeat.rows, self.chart.rows), _least(repeat.columns, self.chart.columns)
        )
        fits = part.stitches == free_cell(repeat, COARSE).stitches
        search = partial(
            relax_splines, yarn=self.yarn, loop_length_mm=self.loop_lengths_mm[0],
            branch=Branch.FREE if fits and not self.flat else Branch.MIRRORED,
            convention=self.convention, sizes_mm=(None, None), flat=self.flat, grid=COARSE,
            starts=None, time_limit_s=None, cancelled=self.cancelled,
        )  # fmt: skip
        relaxed = same_for_images(search, repeat, cancelled=self.cancelled)
        if not fits and not self.flat and part.stitches <= MAX_STITCHES:
            with suppress(ConvergenceError, UnravelledError):  # then with its mirrors
                relaxed = without_mirrors(relaxed, part=part, cancelled=self.cancelled).state
        cell = plain_cell(self.chart, COARSE)
        state = tiled_state(relaxed.cell, relaxed.state, cell)
        tension = np.resize(relaxed.tension_n[: relaxed.cell.rows], cell.rows)
        return WholeShape(
            cell.controls(state), state[-2:], np.tile(tension[:, None], cell.wales),
            self.yarn.core_radius_mm, fine=True,
        )  # fmt: skip

    def _checked(self, resume: WholeShape) -> WholeShape:
        grid = COARSE if resume.fine else ROUGH
        if resume.controls.shape != (self.chart.rows, self.chart.columns * grid.controls, 3):
            raise InputError("resume", "belongs to another chart.", "Leave it out.")
        return resume

    def _fitted(self, sheet: WholeShape, opening: float) -> WholeShape:
        """The sheet with as thick a core as fits."""
        distance = clearance_at(self.energy(sheet), sheet.state, 2.0 + SKIN).min_distance_mm
        core = core_that_fits(self.yarn, distance, opening)
        return replace(sheet, core_radius_mm=core)

    def grown(self, sheet: WholeShape) -> WholeShape:
        """The sheet with its yarn's whole core."""
        stuck = 0
        for round_ in range(MAX_ROUNDS):
            if sheet.core_radius_mm >= self.yarn.core_radius_mm:
                return sheet
            if stuck > _PATIENCE:
                break
            yarn = with_stiff_shell(replace(self.yarn, core_radius_mm=sheet.core_radius_mm))
            energy = replace(self.energy(sheet), yarn=yarn)
            grown = self._fitted(self._one_pass(sheet, energy, _GROWING, round_), OPENING)
            stuck = 0 if grown.core_radius_mm > sheet.core_radius_mm else stuck + 1
            core = max(sheet.core_radius_mm, grown.core_radius_mm)
            sheet = replace(grown, core_radius_mm=core)
            self._tell(sheet)
        raise ConvergenceError(does_not_fit(self.yarn, sheet.core_radius_mm))

    def settled(self, sheet: WholeShape) -> WholeShape:
        """Rounds until the energy settles, and no window knows how to lower it."""
        enough = self.tolerance if sheet.fine else max(self.tolerance, _EXPLORED)
        probed = False
        while len(sheet.rounds) < self.rounds:
            settled = sheet.change <= enough
            if settled and probed:
                break
            probed = settled
            number = len(sheet.rounds)
            energy = self.energy(sheet)
            sheet = self._one_pass(sheet, energy, _PROBE if probed else _PASS, number)
            path = Trajectory(energy, sheet.state, PAIR_CAP)
            lowered = polished(
                energy, path, sheet.tension_n.mean(axis=1),
                _windows(energy.cell, path.clearance.pairs, number), flat=self.flat,
                steps=_DESCENT_STEPS, cancelled=self.cancelled,
            )  # fmt: skip
            del path  # its list of pairs is most of the memory
            per_stitch = lowered.terms.energy / energy.cell.stitches
            wide, high = lowered.state[-2:].tolist()
            sheet = replace(
                sheet, controls=energy.cell.controls(lowered.state), sizes_mm=lowered.state[-2:],
                tension_n=np.tile(lowered.tension[:, None], energy.cell.wales),
                rounds=(*sheet.rounds, (per_stitch, wide, high)),
                evaluations=sheet.evaluations + lowered.evaluations,
            )  # fmt: skip
            self._tell(sheet)
        return sheet

    def _refined(self, sheet: WholeShape) -> WholeShape:
        """The sheet on the finer grid."""
        fine = plain_cell(self.chart, COARSE)
        state = refined_state(plain_cell(self.chart, ROUGH), sheet.state, fine)
        refined = replace(
            sheet, controls=fine.controls(state), fine=True, rounds=(), earlier=len(sheet.rounds)
        )
        # between the old samples the cores may overlap
        return self._fitted(refined, OPENING)

    def _one_pass(
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

    def _minimum(self, energy: CellEnergy, sheet: WholeShape) -> tuple[Minimum, float]:
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

    def _tell(self, sheet: WholeShape) -> None:
        if self.kept is not None:
            self.kept(sheet)
        if self.progress is not None:
            # the logarithm of the change falls about evenly
            there = max(sheet.change, self.tolerance)
            near = np.log(min(there, 1.0)) / np.log(self.tolerance) if there < np.inf else 0.0
            share = max(float(near), len(sheet.rounds) / self.rounds)
            core = self.yarn.core_radius_mm
            grown = sheet.core_radius_mm / core if core else 1.0
            self.progress(0.1 * grown + (0.6 if sheet.fine else 0.0) + 0.3 * share, 1.0)


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


def _least(repeat: int, whole: int) -> int:
    """Fewest rows or columns whose repetition makes up the chart; more than one if it has more."""
    return min(n for n in range(repeat, whole + 1) if whole % n == 0 and (n > 1 or whole == 1))


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
