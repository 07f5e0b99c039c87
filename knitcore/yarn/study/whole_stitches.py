"""A whole chart of any stitches at the yarn level, held spread as on a blocking board.

Free of force and friction, lace and cables crumple; so the cloth is pulled evenly both ways. Its
yarn begins as the first shape of the chart and is drawn in under a take-down, as that of a repeat
(:mod:`knitcore.yarn.loops.take_down`); a chart of repeats begins with one of them, relaxed. A large
sheet is made smaller evenly, as far as that is certified, before its windows and a descent of all
of it follow. Then come rounds, each with one factor where the chart has up to
``MAX_STITCHES_AT_ONCE`` stitches.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_count, check_range
from knitcore.base.errors import Cancelled, ConvergenceError, InputError, UnravelledError
from knitcore.base.threads import one_blas_thread
from knitcore.chart.stitch_chart import StitchChart, check_stitches
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.loops.chart_images import ChartImage
from knitcore.yarn.loops.drawn_yarn import DrawnYarn
from knitcore.yarn.loops.holes import holes, is_folded
from knitcore.yarn.loops.relaxed_stitches import BLOCKING_N_PER_MM, FOLDED, knotted, yarn_overs
from knitcore.yarn.loops.stitch_energy import SpreadEnergy, StitchEnergy, YarnPerAct
from knitcore.yarn.loops.take_down import GRID, TakeDown, between, room_for_yarn
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import SPACING_PER_BENDING, CellEnergy
from knitcore.yarn.model.input_checks import check_loop
from knitcore.yarn.model.relaxed_cell import Branch
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.tiling import centre_lines
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.newton import Minimum, Options, minimise
from knitcore.yarn.solve.polish import PAIR_CAP
from knitcore.yarn.solve.rounds import MAX_ROUNDS, Rounds, WholeShape, after_round
from knitcore.yarn.solve.search import RELAXED, UNSETTLED, outcome
from knitcore.yarn.solve.splines import compile_kernels, relaxed_repeat
from knitcore.yarn.solve.topology import Trajectory, clearance_at
from knitcore.yarn.study.whole_chart import MAX_STITCHES_WHOLE, RelaxedChart, after_rounds, least_of

MAX_STITCHES_AT_ONCE = 200
"""Largest chart whose rounds have one factor."""
_DRAWN = Options(tolerance=1e-2, slack=1e-2, iterations=5, mended=False, leaves_saddles=False)
"""Settings of a pass while the yarn is drawn in."""
_AT_ONCE = Options(tolerance=1e-7, slack=1e-7, iterations=150)
_EVEN = 0.01
"""Excess of yarn up to which the sheet is not made smaller."""
_FEW = 60
"""Largest chart whose yarn is drawn in with one factor."""
_LONGEST = 0.12
"""Longest part of the way on which a large sheet is drawn in, in logarithms of the length."""
_APART = 0.5
"""Part of their least free distance that strands keep where it is made smaller."""
_STEPS = 8
"""Most such steps before a pass."""
_LEFT = 0.04
"""Most excess of yarn that is left to the windows."""
_DRAWING_IN = 0.7
"""Part of the work that drawing the yarn in counts as."""
PINNED = (
    f"The cloth is held spread by {BLOCKING_N_PER_MM:g} N/mm both ways, without friction, as on a "
    "blocking board; let go, it becomes smaller. Take its size as a picture of the yarn, not as a "
    "prediction."
)


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class RelaxedStitchChart(RelaxedChart):
    """A chart of any stitches relaxed as a whole.

    Attributes
    ----------
    stitches : the chart.
    folded : whether its rows or columns stand rather than lie, so that its sizes are none of a
        cloth.
    hole_share : part of the cloth that no yarn covers.
    eyelet_mm2 : mean area of the holes of yarn overs, neighbouring ones together; None without any.
    crossings : crossings of the first shape that the chart asks for. They are kept: the yarn is
        knotted at the end as it was at first (:mod:`knitcore.yarn.solve.clasps`).
    """

    stitches: SymbolChart
    folded: bool
    hole_share: float
    eyelet_mm2: float | None
    crossings: int

    @property
    def energy(self) -> StitchEnergy:
        """The energy whose minimum this is, without the pull."""
        return StitchEnergy(self.cell, self.yarn, self.loop_lengths_mm, self.convention)


def relax_whole_stitches(
    chart: SymbolChart,
    yarn: YarnModel,
    loop_length_mm: float,
    *,
    per_act: YarnPerAct | None = None,
    convention: Convention | str = Convention.PUBLISHED,
    tolerance: float = 1e-3,
    rounds: int = 40,
    resume: WholeShape | None = None,
    kept: Callable[[WholeShape], None] | None = None,
    progress: Callable[[float, float], None] | None = None,
    cancelled: Cancelled | None = None,
) -> RelaxedStitchChart:
    """Shape of least energy of a whole chart of any balanced stitches, pulled evenly both ways.

    The chart repeats, as in :func:`~knitcore.yarn.study.whole_chart.relax_whole`.

    Parameters
    ----------
    chart : the chart, taken as it stands.
    yarn : the yarn.
    loop_length_mm : yarn of a knit, mm.
    per_act : yarn of other stitches, relative to a knit's.
    convention : factors of the energy.
    tolerance : relative change of the energy in a round at which to stop; the sizes may then change
        by ten times as much.
    rounds : most rounds, at least two.
    resume : where an earlier call was, as it gave it to ``kept``.
    kept : called with the shape so far after every step of the take-down and every round.
    progress : called with (done, total).
    cancelled : called before every step; True stops with CancelledError.

    Raises
    ------
    InputError
        If the chart is too large, a value is out of range, or ``resume`` is of another chart.
    ConvergenceError
        If the yarn cannot be drawn, or locks; the message has the remedy.
    UnravelledError
        If the stitches come undone.
    CancelledError
        If ``cancelled`` says so.
    """
    whole = chart.tile(2 if chart.rows == 1 else 1, 2 if chart.columns == 1 else 1)
    count = whole.rows * whole.columns
    check_stitches(count, MAX_STITCHES_WHOLE, "a whole chart")
    check_range("tolerance", tolerance, 1e-6, 0.1)
    check_count("rounds", rounds, 2, MAX_ROUNDS)
    check_loop(yarn, loop_length_mm)
    compile_kernels()
    clock = time.process_time()
    small = count <= MAX_STITCHES_AT_ONCE
    image = ChartImage.least(whole) if small else ChartImage(whole, 0, 0, False, False)
    options: dict[str, Any] = {
        "yarn": yarn,
        "tolerance": tolerance,
        "rounds": rounds,
        "cancelled": cancelled,
    }

    def work_on(part: SymbolChart, **more: Any) -> _Work:
        return _Work(
            drawn=knotted(room_for_yarn(part.graph, yarn, loop_length_mm)),
            convention=Convention.parse(convention),
            goal_mm=loop_length_mm * (per_act or YarnPerAct()).of_rows(part.graph),
            **options, **more,
        )  # fmt: skip

    work = work_on(image.chart, kept=kept, progress=progress)
    part = _least_part(image.chart)
    with one_blas_thread():
        if resume is None and part.cells.size <= MAX_STITCHES_AT_ONCE and part != image.chart:
            resume = _laid_out(work_on(part).relaxed(None)[0], part, image.chart)
        sheet, energy, minimum, left_n = work.relaxed(resume)
    cell, state = energy.cell, minimum.state
    lines, (course, wale) = centre_lines(cell, state, cell.rows, cell.wales), state[-2:].tolist()
    eyelets = yarn_overs(image.chart.graph)
    open_places = holes(lines, cell.wales * course, cell.rows * wale, yarn.radius_mm)
    folded = is_folded(lines, cell.wales, course, wale)
    repeat = relaxed_repeat(
        StitchChart(cell.purl), energy, Branch.FREE, minimum, seconds=time.process_time() - clock,
        evaluations=sheet.evaluations,
        notes=(after_rounds(sheet, left_n), *((FOLDED,) if folded else ()), PINNED),
    )  # fmt: skip
    shown = {"centre_lines": image.lines_back(lines, course, wale)}
    return RelaxedStitchChart(
        **vars(repeat) | shown, rounds=sheet.earlier + len(sheet.rounds),
        energy_change=sheet.energy_change, size_change=sheet.size_change,
        may_fall=sheet.may_fall, largest_force_n=left_n, stitches=whole, folded=folded,
        hole_share=open_places.share, eyelet_mm2=open_places.eyelet_mm2(eyelets),
        crossings=work.drawn.exact,
    )  # fmt: skip


def _least_part(chart: SymbolChart) -> SymbolChart:
    """The smallest part, at least two stitches each way, whose repetition makes up a chart."""
    repeat = chart.repeat()
    return repeat.tile(
        least_of(repeat.rows, chart.rows) // repeat.rows,
        least_of(repeat.columns, chart.columns) // repeat.columns,
    )


def _laid_out(sheet: WholeShape, part: SymbolChart, whole: SymbolChart) -> WholeShape:
    """The sheet of a part repeated to a whole one."""
    up, across = whole.rows // part.rows, whole.columns // part.columns
    return replace(
        sheet, controls=np.tile(sheet.controls, (up, across, 1)),
        tension_n=np.tile(sheet.tension_n, (up, across)), rounds=(),
    )  # fmt: skip


@dataclass(frozen=True, eq=False, kw_only=True)
class _Work(Rounds):
    drawn: DrawnYarn
    convention: Convention
    goal_mm: Array

    def relaxed(self, resume: WholeShape | None) -> tuple[WholeShape, StitchEnergy, Minimum, float]:
        """The chart at rest: as a sheet, its energy and minimum, and the force that is left, N."""
        if resume is None or resume.drawn_in < 1.0:
            resume = self._drawn_in(resume)
        sheet = self.settled(self._checked(resume))
        if not self.at_once:
            sheet, minimum, left_n = self.mended(sheet)
        else:
            minimum, left_n = self.minimum(self.energy(sheet), sheet)
        energy = self.energy(sheet)
        became = outcome(energy, minimum)
        if became not in (RELAXED, UNSETTLED):
            raise UnravelledError(f"The relaxed chart is not a fabric: {became}.")
        return sheet, energy, minimum, left_n

    @property
    def at_once(self) -> bool:
        """Tell whether the chart is small enough for one factor."""
        return self.drawn.cell.stitches <= MAX_STITCHES_AT_ONCE

    def energy(self, sheet: WholeShape) -> SpreadEnergy:
        """Energy of the whole sheet, pulled evenly both ways."""
        cell = self.drawn.cell
        controls = sheet.controls.shape[1] // cell.wales
        return SpreadEnergy(
            replace(cell, grid=SplineGrid(controls, GRID.per_span)), self.yarn, self.goal_mm,
            self.convention, spacing_per_bending=SPACING_PER_BENDING,
            spread_n_per_mm=BLOCKING_N_PER_MM,
        )  # fmt: skip

    def shape(self, energy: StitchEnergy, minimum: Minimum, drawn_in: float) -> WholeShape:
        """A state of the take-down as a sheet."""
        cell = energy.cell
        return WholeShape(
            cell.controls(minimum.state), minimum.state[-2:],
            np.tile(minimum.tension[:, None], cell.wales), self.yarn.core_radius_mm,
            fine=True, drawn_in=drawn_in, evaluations=minimum.evaluations,
        )  # fmt: skip

    def _checked(self, sheet: WholeShape) -> WholeShape:
        rows, count, _ = sheet.controls.shape
        if rows != self.drawn.cell.rows or count % self.drawn.cell.wales:
            raise InputError("resume", "belongs to another chart.", "Leave it out.")
        return sheet

    def one_round(
        self, sheet: WholeShape, energy: CellEnergy, number: int, *, probes: bool
    ) -> WholeShape:
        """The sheet after a round; a small one is relaxed at once."""
        if not self.at_once:
            return super().one_round(sheet, energy, number, probes=probes)
        lowered = minimise(
            energy, sheet.state, tension=sheet.tension_n.mean(axis=1),
            options=replace(_AT_ONCE, leaves_saddles=probes), cancelled=self.cancelled,
        )  # fmt: skip
        return after_round(sheet, energy, lowered)

    def done(self, sheet: WholeShape) -> float:
        """Part of the work that is done."""
        return super().done(sheet) if sheet.drawn_in == 1.0 else _DRAWING_IN * sheet.drawn_in

    def _drawn_in(self, resume: WholeShape | None) -> WholeShape:
        take_down = _TakeDown(
            self.yarn, self.convention, self.goal_mm, cancelled=self.cancelled, work=self,
            resume=None if resume is None else self._checked(resume),
            longest=TakeDown.longest if self.drawn.cell.stitches <= _FEW else _LONGEST,
        )  # fmt: skip
        energy, minimum = take_down(self.drawn)
        return self.shape(energy, minimum, 1.0)


@dataclass(frozen=True, eq=False, kw_only=True)
class _TakeDown(TakeDown):
    """The yarn of a whole chart being drawn in, in windows where it is large."""

    work: _Work
    resume: WholeShape | None

    def begun(self, drawn: DrawnYarn, pull: float) -> tuple[StitchEnergy, Minimum, float]:
        """The first shape, or where an earlier call was, under its pull."""
        if self.resume is None:
            return super().begun(drawn, pull)
        sheet, cell = self.resume, drawn.cell
        grid = SplineGrid(sheet.controls.shape[1] // cell.wales, GRID.per_span)
        lengths = between(drawn.loop_lengths_mm, self.goal_mm, sheet.drawn_in)
        energy = self.energy(replace(cell, grid=grid), lengths, pull)
        return energy, self.work.minimum(energy, sheet)[0], sheet.drawn_in

    def reached(self, energy: StitchEnergy, minimum: Minimum, done: float) -> None:
        """Keep the shape."""
        if done < 1.0:
            self.work.tell(self.work.shape(energy, minimum, done))

    def stage(self, energy: StitchEnergy, state: Array, tension: Array | None) -> Minimum:
        """The state with the lengths of an energy, near enough to go on from."""
        if energy.cell.stitches <= _FEW:
            return super().stage(energy, state, tension)
        sheet = self._smaller(energy, state, tension)
        number = round(float(energy.mean_loop_mm) * 1e3)  # so that windows end elsewhere
        sheet = self.work.one_pass(sheet, energy, _DRAWN, number)
        minimum = self.work.descended(sheet, energy, number)
        if minimum.min_distance_mm <= 2.0 * self.yarn.core_radius_mm:
            raise ConvergenceError("cores overlap")
        return minimum

    def _smaller(self, energy: StitchEnergy, state: Array, tension: Array | None) -> WholeShape:
        """The sheet made smaller evenly, as far as its strands stay apart, until it has about the
        lengths of an energy."""
        path, cell = Trajectory(energy, state, PAIR_CAP), energy.cell
        core, whole_mm = 2.0 * self.yarn.core_radius_mm, float(energy.prescribed_mm.sum())
        least = core + _APART * (path.min_distance_mm - core)
        share, steps = 1.0, 0
        while (excess := float(path.here.terms.excess_mm.sum()) / whole_mm) > _EVEN:
            if steps == _STEPS:
                if excess > _LEFT:
                    raise ConvergenceError("The strands are too near for so much less yarn.")
                break
            steps += 1
            controls, sizes = cell.controls(path.here.state), path.here.state[-2:]
            step = -share * excess * cell.state(controls * (1.0, 1.0, 0.0), *sizes)
            trial = path.certified(step)
            if clearance_at(energy, trial.to.state).min_distance_mm < least:
                share *= 0.5
            else:
                path.advance(trial)
        pulls = np.zeros(cell.rows) if tension is None else tension
        state = path.here.state
        return WholeShape(
            cell.controls(state), state[-2:], np.tile(pulls[:, None], cell.wales),
            self.yarn.core_radius_mm,
        )  # fmt: skip
