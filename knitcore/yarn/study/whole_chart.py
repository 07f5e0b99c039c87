"""A whole chart of knits and purls at the yarn level, relaxed in rounds.

A chart of up to ``MAX_STITCHES`` stitches ends in Newton's method for the sheet, at a minimum.
"""

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_count, check_range
from knitcore.base.errors import Cancelled, ConvergenceError, InputError, UnravelledError
from knitcore.base.threads import one_blas_thread
from knitcore.chart.stitch_chart import StitchChart, check_stitches
from knitcore.yarn.model.cell import free_cell, plain_cell
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import SPACING_PER_BENDING, STIFF_SPACING_PER_BENDING, CellEnergy
from knitcore.yarn.model.input_checks import check_loop
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
from knitcore.yarn.solve.newton import TIGHT, Minimum, Options, minimise
from knitcore.yarn.solve.polish import PAIR_CAP
from knitcore.yarn.solve.rounds import EXPLORED, MAX_ROUNDS, Rounds, WholeShape
from knitcore.yarn.solve.search import RELAXED, UNSETTLED, outcome
from knitcore.yarn.solve.splines import (
    COARSE,
    ROUGH,
    RelaxedRepeat,
    loop_lengths,
    relax_splines,
    relaxed_repeat,
)  # fmt: skip
from knitcore.yarn.solve.topology import SKIN, Trajectory, clearance_at
from knitcore.yarn.study.lowest import MAX_STITCHES, without_mirrors

MAX_STITCHES_WHOLE = 4_000
"""Largest chart that is relaxed as a whole."""
WINDOWS_FROM = 100
"""Cells of at least this many stitches relax faster, and mostly to lower energies, in windows than
with one factor."""
SECONDS_PER_STITCH = 0.25
"""CPU time (measured, an upper estimate)."""
_GROWING = Options(tolerance=1e-3, iterations=4, mended=False)
_EXACT_FLAT = 36
"""Largest chart laid flat that ends in Newton's method: what holds it is not in the sparse matrix,
which takes many damped steps."""
_REPEAT = 36
"""A chart with a repeat of up to this many stitches starts from that, relaxed."""
_PATIENCE = 12
"""Passes in which a core may fail to grow."""


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
        chart=chart, yarn=yarn, loop_lengths_mm=np.resize(lengths, chart.rows),
        convention=Convention.parse(convention), flat=flat, tolerance=tolerance, rounds=rounds,
        kept=kept, progress=progress, cancelled=cancelled,
    )  # fmt: skip
    with one_blas_thread():
        return work.relaxed(resume)


def explored(energy: CellEnergy, cancelled: Cancelled | None = None) -> Minimum:
    """Where rounds lead from the first shape of a cell without symmetry, on the coarser grid.

    ``energy`` is that of the cell on this grid. Mostly this shape is lower than the one to which
    Newton's method leads from there.
    """
    work = _Work(
        chart=StitchChart(energy.cell.purl), yarn=energy.yarn,
        loop_lengths_mm=energy.loop_length_mm, convention=energy.convention, tolerance=EXPLORED,
        rounds=MAX_ROUNDS, cancelled=cancelled,
    )  # fmt: skip
    with one_blas_thread():
        _, minimum, _ = work.mended(work.settled(work.grown(work.first_shape())))
    return minimum


def after_rounds(sheet: WholeShape, left_n: float) -> str:
    """The note on a shape that rounds led to."""
    gained = 0.0 - round(sheet.energy_change, 4)
    return (
        f"The last of {sheet.earlier + len(sheet.rounds)} rounds changed the energy by "
        f"{gained:+.2%} and a size by {sheet.size_change:.2%}; more rounds may take "
        f"up to {sheet.may_fall:.1%} of the energy away. Forces of up to {left_n:.1e} N are left "
        "on the yarn."
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class _Work(Rounds):
    chart: StitchChart
    loop_lengths_mm: Array
    convention: Convention

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
        note = after_rounds(sheet, left_n)
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
            least_of(repeat.rows, self.chart.rows), least_of(repeat.columns, self.chart.columns)
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
            grown = self._fitted(self.one_pass(sheet, energy, _GROWING, round_), OPENING)
            stuck = 0 if grown.core_radius_mm > sheet.core_radius_mm else stuck + 1
            core = max(sheet.core_radius_mm, grown.core_radius_mm)
            sheet = replace(grown, core_radius_mm=core)
            self.tell(sheet)
        raise ConvergenceError(does_not_fit(self.yarn, sheet.core_radius_mm))

    def _refined(self, sheet: WholeShape) -> WholeShape:
        """The sheet on the finer grid."""
        fine = plain_cell(self.chart, COARSE)
        state = refined_state(plain_cell(self.chart, ROUGH), sheet.state, fine)
        refined = replace(
            sheet, controls=fine.controls(state), fine=True, rounds=(), earlier=len(sheet.rounds)
        )
        # between the old samples the cores may overlap
        return self._fitted(refined, OPENING)


def least_of(repeat: int, whole: int) -> int:
    """Fewest rows or columns whose repetition makes up the chart; more than one if it has more."""
    return min(n for n in range(repeat, whole + 1) if whole % n == 0 and (n > 1 or whole == 1))
