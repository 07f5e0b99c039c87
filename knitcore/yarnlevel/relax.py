"""Relax any repeat of knits and purls at the yarn level."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import partial

import numpy as np
from numpy.typing import NDArray

from knitcore.chart import StitchChart
from knitcore.errors import ConvergenceError, InputError, KnitcoreError, UnravelledError
from knitcore.yarnlevel.cell import YarnCell, free_cell, mirrored_cell
from knitcore.yarnlevel.clasps import cell_is_knitted
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.energy import CellEnergy
from knitcore.yarnlevel.growth import Start, grow, shaken
from knitcore.yarnlevel.published.relax import check_loop
from knitcore.yarnlevel.results import RelaxedCell
from knitcore.yarnlevel.solver import Minimum, Options, minimise
from knitcore.yarnlevel.spline import SplineGrid
from knitcore.yarnlevel.tiling import centre_lines, refined_state, tiled_state
from knitcore.yarnlevel.topology import Guard
from knitcore.yarnlevel.yarn import YarnModel

Array = NDArray[np.float64]
Cancel = Callable[[], bool]

MAX_STITCHES = 100
"""Largest cell that is solved; the unknowns fill a dense matrix."""
FINE = SplineGrid(controls=20, per_span=4)
COARSE = SplineGrid(controls=16, per_span=3)
ROUGH = SplineGrid(controls=10, per_span=5)
"""Large cells find their shape on this grid (energy within 2e-3) before they are refined."""
ROUGH_FROM = 30
FINE_UP_TO = 2
"""Cells of so many stitches are solved on the fine grid (energy within 1e-4), others coarse."""
SAME_ENERGY = 1e-3
"""Starts whose energies agree within this are the same minimum."""

OVERLONG = 1e-4
"""Error of the length, as a part of it, beyond which a state does not count."""

MIRRORED_STARTS = (
    Start("usual"),
    Start("wide", course=1.15, wale=0.85),
)
FREE_STARTS = (Start("asymmetric", noise=0.01, seed=1),)


class Branch(StrEnum):
    """Which shapes are admitted."""

    PUBLISHED = "published"
    MIRRORED = "mirrored"
    FREE = "free"


@dataclass(frozen=True)
class StartReport:
    """What became of one start.

    Attributes
    ----------
    name : of the start.
    outcome : ``relaxed``, ``not converged``, or the reason of a failure.
    energy_n_mm, cell_course_mm, cell_wale_mm : per stitch; nan where it failed.
    """

    name: str
    outcome: str
    energy_n_mm: float
    cell_course_mm: float
    cell_wale_mm: float


@dataclass(frozen=True, eq=False, kw_only=True)
class RelaxedRepeat(RelaxedCell):
    """A relaxed repeat on splines (branches ``mirrored`` and ``free``).

    Attributes
    ----------
    chart : the repeat that the centre lines show.
    yarn : the yarn.
    loop_lengths_mm : length of yarn per stitch of every course of the cell.
    cell : shape space; ``state`` are its unknowns.
    tension_n : tension of every course of the cell.
    force_n : dE/d(size of a stitch) of one stitch, course-wise and wale-wise.
    min_distance_mm : smallest distance of centre lines.
    starts : all starts.
    """

    chart: StitchChart
    yarn: YarnModel
    loop_lengths_mm: Array
    cell: YarnCell
    tension_n: Array
    force_n: tuple[float, float]
    min_distance_mm: float
    starts: tuple[StartReport, ...] = ()

    @property
    def control_points(self) -> Array:
        """(courses, controls, 3) of the solved cell, mm, with the drift of the cell."""
        points = self.cell.controls(self.state)
        count = self.cell.controls_per_course
        points[..., 0] += self.cell_course_mm * np.arange(count) / self.cell.grid.controls
        points[..., 1] += self.cell_wale_mm * np.arange(self.cell.rows)[:, None]
        return points

    @property
    def energy(self) -> CellEnergy:
        """The energy whose minimum this is."""
        return CellEnergy(self.cell, self.yarn, self.loop_lengths_mm, self.convention)


def relax(
    chart: StitchChart,
    yarn: YarnModel,
    loop_length_mm: float | Sequence[float],
    *,
    branch: Branch | str = Branch.MIRRORED,
    convention: Convention = Convention.PUBLISHED,
    grid: SplineGrid | None = None,
    starts: Sequence[Start] | None = None,
    cancel: Cancel | None = None,
) -> RelaxedRepeat:
    """Shape of least energy of a repeat, free of force.

    Parameters
    ----------
    chart : the repeat (or any number of it).
    yarn : the yarn.
    loop_length_mm : mm of yarn per stitch: one number, or one for every course of the repeat
        (bottom first).
    branch : ``mirrored`` imposes the symmetries of the chart, ``free`` none (it also continues the
        mirrored state, shaken, and keeps the lowest).
    convention : factors of the energy.
    grid : resolution; by default finer for small cells.
    starts : by default two.
    cancel : asked before every step; True stops with CancelledError.

    Raises
    ------
    InputError
        If the loop is too short or too long for the yarn or the cell is too large.
    ConvergenceError
        If no start relaxed.
    UnravelledError
        If every start lost its topology.
    """
    kind = Branch(branch)
    if kind is Branch.PUBLISHED:
        raise InputError(
            "branch", "the published ansatz is not a spline.", "Use relax_published for it."
        )
    repeat = chart.repeat()
    lengths = _loop_lengths(loop_length_mm, chart, repeat)
    for length in lengths:
        check_loop(yarn, float(length))
    uniform = bool(np.ptp(lengths) == 0.0)
    draft = (mirrored_cell if kind is Branch.MIRRORED else free_cell)(repeat, COARSE)
    if not uniform:
        draft = YarnCell(repeat.purl, False, False, None, COARSE)
    if draft.stitches > MAX_STITCHES:
        raise InputError(
            "chart",
            f"its cell has {draft.stitches} stitches.",
            f"Use a repeat of at most {MAX_STITCHES} stitches.",
        )
    if grid is None:
        grid = FINE if draft.stitches <= FINE_UP_TO else COARSE
    first = ROUGH if draft.stitches >= ROUGH_FROM else COARSE
    explored = grid if grid.controls <= first.controls else first
    cell = replace(draft, grid=explored)
    per_course = np.resize(lengths, cell.rows)
    options = Options(tolerance=1e-9 if cell.stitches <= FINE_UP_TO else 1e-6)
    _compile()
    clock = time.process_time()
    whole = _Search(cell, yarn, per_course, convention, options, cancel)
    if kind is Branch.MIRRORED:
        whole.try_starts(starts or MIRRORED_STARTS[: 2 if cell.stitches <= FINE_UP_TO else 1])
    else:
        if uniform:
            whole.continue_mirrored(repeat, explored)
        whole.try_starts(starts or FREE_STARTS)
    best = whole.best()
    if explored != grid:
        cell = replace(draft, grid=grid)
        energy = CellEnergy(cell, yarn, per_course, convention)
        best = minimise(
            energy, refined_state(whole.cell, best.state, cell),
            tension=best.tension, options=options, cancel=cancel,
        )  # fmt: skip
        whole.evaluations += best.evaluations
    notes = whole.notes()
    return relaxed_repeat(
        repeat, cell, yarn, per_course, convention, kind, best,
        seconds=time.process_time() - clock, evaluations=whole.evaluations,
        starts=tuple(whole.reports), notes=notes,
    )  # fmt: skip


def relaxed_repeat(
    chart: StitchChart, cell: YarnCell, yarn: YarnModel, lengths: Array, convention: Convention,
    branch: Branch, found: Minimum, *, seconds: float, evaluations: int,
    starts: tuple[StartReport, ...] = (), notes: tuple[str, ...] = (),
) -> RelaxedRepeat:  # fmt: skip
    """A minimum as a result, per stitch."""
    terms = found.terms
    return RelaxedRepeat(
        branch=branch.value,
        convention=convention,
        cell_course_mm=float(found.state[-2]),
        cell_wale_mm=float(found.state[-1]),
        energy_n_mm=terms.energy / cell.stitches,
        bending_share=terms.rod / terms.energy,
        contact_share=terms.contact / terms.energy,
        yarn_length_mm=float(np.mean(lengths) + terms.excess_mm.sum() / cell.stitches),
        seconds=seconds,
        evaluations=evaluations,
        converged=found.converged,
        centre_lines=centre_lines(cell, found.state, chart.rows, chart.columns),
        state=found.state,
        notes=notes,
        chart=chart,
        yarn=yarn,
        loop_lengths_mm=lengths,
        cell=cell,
        tension_n=found.tension,
        force_n=(float(found.force[0] / cell.stitches), float(found.force[1] / cell.stitches)),
        min_distance_mm=found.min_distance_mm,
        starts=starts,
    )


def overlong(energy: CellEnergy, found: Minimum) -> bool:
    """Whether a course is longer than its yarn: jammed or locked, not a state of the fabric."""
    excess = float(np.abs(found.terms.excess_mm).max()) / energy.cell.wales
    return excess > OVERLONG * energy.mean_loop_mm


class _Search:
    """Runs starts on one cell and remembers what became of them."""

    def __init__(
        self, cell: YarnCell, yarn: YarnModel, lengths: Array, convention: Convention,
        options: Options, cancel: Cancel | None,
    ) -> None:  # fmt: skip
        self.cell = cell
        self.yarn = yarn
        self.lengths = lengths
        self.convention = convention
        self.options = options
        self.cancel = cancel
        self.found: list[Minimum] = []
        self.reports: list[StartReport] = []
        self.errors: list[KnitcoreError] = []
        self.evaluations = 0
        self.mirrored: Minimum | None = None
        self.mirrored_energy = float("nan")

    def try_starts(self, starts: Sequence[Start]) -> None:
        for start in starts:
            self._run(start.name, partial(self._grow, start))

    def _grow(self, start: Start) -> Minimum:
        return grow(
            self.cell, self.yarn, self.lengths, self.convention, start,
            options=self.options, cancel=self.cancel,
        )  # fmt: skip

    def continue_mirrored(self, repeat: StitchChart, grid: SplineGrid) -> None:
        """Go on from the mirrored state, laid out over the free cell and shaken a little."""
        small = mirrored_cell(repeat, grid)
        lengths = np.resize(self.lengths, small.rows)
        options = replace(self.options, tolerance=1e-6)

        def run() -> Minimum:
            mirrored = grow(
                small, self.yarn, lengths, self.convention, MIRRORED_STARTS[0],
                options=options, cancel=self.cancel,
            )  # fmt: skip
            self.evaluations += mirrored.evaluations
            self.mirrored = mirrored
            self.mirrored_energy = mirrored.terms.energy / small.stitches
            energy = CellEnergy(self.cell, self.yarn, self.lengths, self.convention)
            state = tiled_state(small, mirrored.state, self.cell)
            state = _shaken_safely(energy, state)
            return minimise(energy, state, options=self.options, cancel=self.cancel)

        self._run("mirrored, shaken", run)

    def _run(self, name: str, solve: Callable[[], Minimum]) -> None:
        nan = float("nan")
        try:
            found = solve()
        except (UnravelledError, ConvergenceError) as error:
            self.errors.append(error)
            self.reports.append(StartReport(name, str(error), nan, nan, nan))
            return
        self.evaluations += found.evaluations
        outcome = self._outcome(found)
        self.reports.append(
            StartReport(
                name, outcome, found.terms.energy / self.cell.stitches,
                float(found.state[-2]), float(found.state[-1]),
            )
        )  # fmt: skip
        if outcome in ("relaxed", "not converged"):
            self.found.append(found)

    def _outcome(self, found: Minimum) -> str:
        if not np.all(np.isfinite(found.state)) or not np.isfinite(found.terms.energy):
            return "not finite"
        if overlong(CellEnergy(self.cell, self.yarn, self.lengths, self.convention), found):
            return "too little yarn"
        if found.min_distance_mm <= 2.0 * self.yarn.core_radius_mm:
            return "cores overlap"
        if found.state[-2] > 0.9 * float(np.mean(self.lengths)):
            return "pulled straight"
        if not cell_is_knitted(self.cell, found.state):
            return "unravelled"
        return "relaxed" if found.converged else "not converged"

    def best(self) -> Minimum:
        if not self.found:
            if self.errors:
                raise self.errors[0]
            reasons = ", ".join(sorted({r.outcome for r in self.reports}))
            raise UnravelledError(f"No start kept the stitches of this repeat: {reasons}.")
        settled = [m for m in self.found if m.converged] or self.found
        return min(settled, key=lambda m: m.terms.energy)

    def notes(self) -> tuple[str, ...]:
        """What the user should know: higher minima, and how far the mirrored state is off."""
        notes = []
        best = self.best()
        energies = [m.terms.energy for m in self.found]
        others = sum(e > min(energies) * (1.0 + SAME_ENERGY) for e in energies)
        if others:
            notes.append(f"{others} of {len(self.reports)} starts ended in a higher minimum.")
        failed = len(self.reports) - len(self.found)
        if failed:
            notes.append(f"{failed} of {len(self.reports)} starts failed.")
        if not best.converged:
            notes.append("The solver stopped before its tolerance.")
        if self.mirrored is not None:
            energy = best.terms.energy / self.cell.stitches
            lower = 1.0 - energy / self.mirrored_energy
            if lower > SAME_ENERGY:
                wide, high = (float(v) for v in best.state[-2:] / self.mirrored.state[-2:])
                notes.append(
                    f"The free shape differs from the mirrored one: its energy is {lower:.1%} "
                    f"lower, a stitch {wide:.2f} times as wide and {high:.2f} times as high."
                )
        return tuple(notes)


def _shaken_safely(energy: CellEnergy, state: Array) -> Array:
    """The state displaced at random by 0.02 r or as much less as keeps the yarn apart."""
    radius = energy.yarn.radius_mm
    curve = energy.curve(state)
    reach = 3.0 * radius
    pairs, _ = energy.pairs(curve, state, reach)
    guard = Guard(energy.cell, state, curve, pairs, reach, 2.0 * radius)
    # half of the way to the hard cores at most
    room = 0.25 * max(guard.min_distance_mm - 2.0 * energy.yarn.core_radius_mm, 0.0)
    moved = shaken(energy.cell, state, min(0.02 * radius, 0.3 * room), seed=7)
    scale = guard.longest_step(moved, energy.curve(moved), radius)
    return np.asarray(state + scale * (moved - state))


def _loop_lengths(
    loop_length_mm: float | Sequence[float], chart: StitchChart, repeat: StitchChart
) -> Array:
    lengths = np.atleast_1d(np.asarray(loop_length_mm, dtype=float))
    if len(lengths) not in (1, chart.rows, repeat.rows):
        raise InputError(
            "loop_length_mm",
            f"{len(lengths)} lengths were given for {repeat.rows} courses.",
            "Give one length, or one for every course of the repeat.",
        )
    cycle = np.resize(lengths[: repeat.rows], len(lengths))
    if len(lengths) == chart.rows and not np.array_equal(lengths, cycle):
        raise InputError(
            "loop_length_mm", "the lengths do not repeat with the chart.",
            "Give one length for every course of the smallest repeat.",
        )  # fmt: skip
    return np.resize(lengths, repeat.rows)


_COMPILED: list[bool] = []


def _compile() -> None:
    """Compile (or load) the kernels once, so that the time of a solve is the solve's."""
    if _COMPILED:
        return
    yarn = YarnModel(0.045, 6e-4, 2.4, 0.74, 0.3)
    cell = mirrored_cell(StitchChart.parse("K"), SplineGrid(8, 4))
    grow(cell, replace(yarn, core_radius_mm=0.1), np.array([12.0]), Convention.PUBLISHED,
         MIRRORED_STARTS[0], options=Options(iterations=2))  # fmt: skip
    _COMPILED.append(True)
