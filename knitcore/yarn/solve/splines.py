"""Branches ``mirrored`` and ``free``: the yarn of a repeat as splines, with or without mirrors."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, ConvergenceError, InputError, UnravelledError
from knitcore.base.kinds import as_numbers
from knitcore.chart.stitch_chart import StitchChart, check_stitches, size_in_words
from knitcore.materials.law_uncertainty import (
    YARN_LEVEL_FREE_SIZE_LOG_SD,
    YARN_LEVEL_SIZE_LOG_SD,
    Interval,
    log_interval,
)
from knitcore.yarn.model.cell import YarnCell, free_cell, mirrored_cell, plain_cell
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import SPACING_PER_BENDING, STIFF_SPACING_PER_BENDING, CellEnergy
from knitcore.yarn.model.input_checks import (
    check_at_rest,
    check_loop,
    check_stitch_size,
    check_time,
    is_at_rest,
)
from knitcore.yarn.model.relaxed_cell import Branch, RelaxedCell, StartReport
from knitcore.yarn.model.slides import SlideConstraint
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.tiling import centre_lines, refined_state
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.growth import Start, grow
from knitcore.yarn.solve.newton import COURSE, TIGHT, WALE, Minimum, Options, minimise
from knitcore.yarn.solve.search import RELAXED, UNSETTLED, Search, outcome

MAX_STITCHES = 400
"""Largest cell that is solved."""
MAX_STITCHES_RULED = 100
"""Largest cell in which each stitch has a rule of its own (its length, or a plane)."""
FINE = SplineGrid(controls=20, per_span=4)
COARSE = SplineGrid(controls=16, per_span=3)
ROUGH = SplineGrid(controls=12, per_span=4)
"""Large cells find their shape on this grid (energy within 2e-3) before they are refined."""
ROUGH_FROM = 12
_EXPLORED = 1e-5
"""Tolerance of a shape that will be refined, and of its lengths."""
FINE_UP_TO = 2
"""Cells of up to this many stitches are solved on the fine grid (energy within 1e-4)."""
SEVERAL_UP_TO = 9
"""Cells of up to this many stitches get more than one start."""
ALSO_DIRECT_UP_TO = 36
"""Cells of up to this many stitches whose shape is explored in rounds get the usual start, too."""
SECONDS_PER_START = 0.08
"""CPU time of one start: this times the stitches to the power 1.5 (measured, an upper estimate)."""
_STRIDE = 0.03
"""Longest step to a prescribed size, as a part of the loop length."""

MIRRORED_STARTS = (Start("usual"), Start("wide", course=1.15, wale=0.85))
FREE_STARTS = (
    Start("asymmetric", noise=0.01, seed=1),
    Start("asymmetric, narrow", course=0.85, wale=1.1, noise=0.02, seed=2),
)
_SHAKES = (7, 8)
"""Seeds of the displacements with which the mirrored state is left."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class RelaxedRepeat(RelaxedCell):
    """A relaxed repeat on splines (branches ``mirrored`` and ``free``).

    Attributes
    ----------
    cell : shape space; ``state`` are its unknowns.
    tension_n : tension of every course (or stitch) of the cell, then the forces that hold it flat.
    flat : the middles of all stitches were held in one plane.
    slides : where the yarn was kept from sliding.
    minimum : whether it is a minimum without the symmetries of the chart; None where this was not
        found out, and where more was prescribed than one length for every course.
    mirrored : the state with these symmetries that led to this one; None if none did.
    other_minima_mm : sizes of a stitch, course-wise and wale-wise, in other minima that are as low
        within ``SAME_ENERGY``; which of them is returned is a rule, not physics.
    """

    cell: YarnCell
    tension_n: Array
    flat: bool = False
    slides: tuple[SlideConstraint, ...] = ()
    minimum: bool | None = None
    mirrored: RelaxedRepeat | None = None
    other_minima_mm: tuple[tuple[float, float], ...] = ()

    @property
    def held(self) -> bool:
        """Tell whether more than symmetries and the yarn of each course holds it."""
        per_stitch = self.loop_lengths_mm.ndim > 1
        return bool(self.flat or self.slides or per_stitch) or not is_at_rest(self)

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
        return CellEnergy(
            self.cell, self.yarn, self.loop_lengths_mm, self.convention, self.flat, self.slides
        )

    def at(self, energy: CellEnergy, minimum: Minimum, seconds: float) -> Self:
        """Return the same repeat in another state."""
        other = relaxed_repeat(
            self.chart, energy, self.branch, minimum, seconds=seconds,
            evaluations=minimum.evaluations,
        )  # fmt: skip
        return type(self)(**vars(other))


def relax_splines(
    chart: StitchChart,
    yarn: YarnModel,
    loop_length_mm: ArrayLike,
    *,
    branch: Branch,
    convention: Convention,
    sizes_mm: tuple[float | None, float | None],
    flat: bool,
    grid: SplineGrid | None,
    starts: Sequence[Start] | None,
    time_limit_s: float | None,
    cancelled: Cancelled | None,
    explore: Callable[[CellEnergy, Cancelled | None], Minimum] | None = None,
) -> RelaxedRepeat:
    """Shape of least energy of a repeat, free of force unless a size is prescribed.

    Parameters and errors are those of :func:`knitcore.yarn.study.relax.relax`; ``sizes_mm`` are the
    sizes of a stitch to hold, course-wise and wale-wise. Large cells take the shape that
    ``explore`` finds on the grid ``ROUGH``, the largest in place of the usual start.
    """
    draft, repeat, lengths = drafted(chart, loop_length_mm, branch)
    for length in lengths.ravel():
        check_loop(yarn, float(length))
    uniform = bool(np.ptp(lengths) == 0.0)
    for name, size in zip(("cell_course_mm", "cell_wale_mm"), sizes_mm, strict=True):
        check_stitch_size(name, size, float(lengths.mean()))
    if grid is None:
        grid = FINE if draft.stitches <= FINE_UP_TO else COARSE
    first = ROUGH if draft.stitches >= ROUGH_FROM else COARSE
    explored = grid if grid.controls <= first.controls else first
    if branch is Branch.FREE:  # neighbouring repeats need not look alike there
        repeat = StitchChart(draft.purl)
    chosen = _starts(branch, draft, starts)
    shakes = _SHAKES[: 2 if draft.stitches <= SEVERAL_UP_TO else int(has_mirrors(repeat))]
    shakes = shakes if branch is Branch.FREE and uniform else ()
    if not chosen and not shakes:
        raise InputError("starts", "is empty.", "Give at least one start, or leave it out.")
    most = MAX_STITCHES if lengths.ndim == 1 and not flat else MAX_STITCHES_RULED
    check_stitches(draft.stitches, most, "its cell")
    per_start = (len(chosen) + len(shakes)) * SECONDS_PER_START
    check_time(draft.stitches, lambda stitches: per_start * stitches**1.5, time_limit_s)
    if lengths.ndim == 1:
        lengths = np.resize(lengths, draft.rows)
    energy = CellEnergy(replace(draft, grid=explored), yarn, lengths, convention, flat)
    if explored != grid:
        energy = replace(energy, spacing_per_bending=STIFF_SPACING_PER_BENDING)
    compile_kernels()
    clock = time.process_time()
    enough = TIGHT if explored == grid else replace(TIGHT, tolerance=_EXPLORED, slack=_EXPLORED)
    search = Search(energy, enough, cancelled)
    if shakes:
        small = mirrored_cell(repeat, explored)
        smaller = replace(energy, cell=small, loop_length_mm=np.resize(lengths, small.rows))
        search.continue_from(
            smaller, _starts(Branch.MIRRORED, small, None), shakes,
            follow=draft.stitches <= SEVERAL_UP_TO,
        )  # fmt: skip
    rounds = explore is not None and explored == ROUGH
    if explore is not None and rounds:
        search.run("rounds", lambda: explore(energy, cancelled))
    if not rounds or draft.stitches <= ALSO_DIRECT_UP_TO:
        search.try_starts(chosen)
    best, others = search.best()
    if explored != grid:
        energy = replace(
            energy, cell=replace(draft, grid=grid), spacing_per_bending=SPACING_PER_BENDING
        )
        best = search.refined(best, energy, TIGHT)
    held = any(size is not None for size in sizes_mm)
    if held:
        best = _held_at(energy, best, sizes_mm, cancelled)
    imposed = held or flat or lengths.ndim > 1
    imposed = imposed or (branch is Branch.MIRRORED and has_mirrors(repeat))
    relaxed = relaxed_repeat(
        repeat, energy, branch, best, seconds=time.process_time() - clock,
        evaluations=search.evaluations, starts=tuple(search.reports), notes=search.notes(best),
        others=others,
    )  # fmt: skip
    return relaxed if imposed else replace(relaxed, minimum=best.stable)


def drafted(
    chart: StitchChart, loop_length_mm: ArrayLike, branch: Branch
) -> tuple[YarnCell, StitchChart, Array]:
    """The cell of a chart, its repeat, and the repeat's loop lengths, mm, (rows,) or (rows, wales).

    Raises
    ------
    InputError
        If the lengths do not fit the chart.
    """
    repeat, lengths = loop_lengths(loop_length_mm, chart)
    if np.ptp(lengths) > 0.0:
        return plain_cell(repeat, COARSE), repeat, lengths
    cell_of = mirrored_cell if branch is Branch.MIRRORED else free_cell
    return cell_of(repeat, COARSE), repeat, lengths


def refined(relaxed: RelaxedRepeat, grid: SplineGrid) -> RelaxedRepeat:
    """A repeat relaxed again on a finer grid, from the shape that it has.

    Raises
    ------
    ConvergenceError, UnravelledError
        If this leads to no state of the fabric.
    """
    energy = replace(relaxed.energy, cell=replace(relaxed.cell, grid=grid))
    state = refined_state(relaxed.cell, relaxed.state, energy.cell)
    clock = time.process_time()
    minimum = minimise(energy, state, tension=relaxed.tension_n, options=TIGHT)
    became = outcome(energy, minimum)
    if became != RELAXED:
        raise ConvergenceError(f"On a finer grid it does not settle: {became}.")
    return replace(relaxed.at(energy, minimum, time.process_time() - clock), notes=relaxed.notes)


def check_unheld(relaxed: RelaxedRepeat) -> None:
    """Refuse a repeat that is held by more than symmetries and the yarn of each course.

    Raises
    ------
    InputError
    """
    check_at_rest(relaxed, "relaxed")
    if relaxed.held:
        how = (
            "it is held flat" if relaxed.flat
            else "its yarn is kept from sliding" if relaxed.slides
            else "it has a loop length for every stitch"
        )  # fmt: skip
        raise InputError("relaxed", f"{how}.", "Relax it with one loop length and nothing held.")


def relaxed_repeat(
    chart: StitchChart, energy: CellEnergy, branch: Branch, minimum: Minimum, *,
    seconds: float, evaluations: int,
    starts: tuple[StartReport, ...] = (), notes: tuple[str, ...] = (),
    others: Sequence[Minimum] = (),
) -> RelaxedRepeat:  # fmt: skip
    """A minimum as a result, per stitch, with the sizes of others that are as low."""
    sizes = tuple((float(m.state[-2]), float(m.state[-1])) for m in others)
    if sizes:
        shown = ", ".join(f"{wide:.2f} × {high:.2f} mm" for wide, high in sizes)
        notes = (
            *notes,
            f"Other shapes have the same energy within 0.1 %, with stitches of {shown}.",
        )
    terms, cell = minimum.terms, energy.cell
    excess = terms.excess_mm[: len(energy.prescribed_mm)].sum()
    return RelaxedRepeat(
        branch=branch,
        convention=energy.convention,
        cell_course_mm=float(minimum.state[-2]),
        cell_wale_mm=float(minimum.state[-1]),
        energy_n_mm=terms.energy / cell.stitches,
        bending_share=terms.rod / terms.energy,
        contact_share=terms.contact / terms.energy,
        yarn_length_mm=energy.mean_loop_mm + float(excess) / cell.stitches,
        seconds=seconds,
        evaluations=evaluations,
        converged=minimum.converged,
        centre_lines=centre_lines(cell, minimum.state, chart.rows, chart.columns),
        state=minimum.state,
        notes=notes,
        chart=chart,
        yarn=energy.yarn,
        loop_lengths_mm=energy.loop_length_mm,
        cell=cell,
        tension_n=minimum.tension,
        force_n=(float(minimum.force[0] / cell.stitches), float(minimum.force[1] / cell.stitches)),
        min_distance_mm=minimum.min_distance_mm,
        starts=starts,
        flat=energy.flat,
        slides=energy.slides,
        other_minima_mm=sizes,
    )


def has_mirrors(repeat: StitchChart) -> bool:
    """Tell whether the mirrored branch imposes symmetries on a repeat."""
    cell = mirrored_cell(repeat, COARSE)
    return cell.symmetric or cell.stitches < free_cell(repeat, COARSE).stitches


def _starts(branch: Branch, cell: YarnCell, starts: Sequence[Start] | None) -> Sequence[Start]:
    if starts is not None:
        return starts
    if branch is Branch.FREE:
        return FREE_STARTS[: 2 if cell.stitches <= SEVERAL_UP_TO else 1]
    return MIRRORED_STARTS[: 2 if cell.stitches <= SEVERAL_UP_TO else 1]


def _held_at(
    energy: CellEnergy, minimum: Minimum, sizes: tuple[float | None, float | None],
    cancelled: Cancelled | None,
) -> Minimum:  # fmt: skip
    """Go from the force-free state to prescribed sizes in steps."""
    places = [place for place, size in zip((COURSE, WALE), sizes, strict=True) if size is not None]
    goal = np.array([0.0 if size is None else size for size in sizes])
    begin = minimum.state[-2:].copy()
    natural = f"{begin[0]:.2f} x {begin[1]:.2f} mm"
    way = np.where([size is not None for size in sizes], goal - begin, 0.0)
    count = max(1, math.ceil(float(np.abs(way).max()) / (_STRIDE * energy.mean_loop_mm)))
    for k in range(1, count + 1):
        reached = minimum.state[-2:]
        nearer = (
            f"Give one nearer to the natural {natural}; {reached[0]:.2f} x {reached[1]:.2f} mm "
            "was reached."
        )
        try:
            minimum = minimise(
                energy, minimum.state, tension=minimum.tension, fixed=tuple(places),
                target=begin + way * k / count, options=TIGHT, cancelled=cancelled,
            )  # fmt: skip
        except (ConvergenceError, UnravelledError) as error:
            raise type(error)(f"No equilibrium at this size: {error} {nearer}") from error
        became = outcome(energy, minimum)
        if became == "unravelled":
            raise UnravelledError(f"The stitches come undone on the way to this size. {nearer}")
        if became not in (RELAXED, UNSETTLED):
            raise ConvergenceError(f"No equilibrium at this size: {became}. {nearer}")
    return minimum


def loop_lengths(
    loop_length_mm: ArrayLike, chart: StitchChart, *, by_stitch: bool = True
) -> tuple[StitchChart, Array]:
    """Repeat and its loop lengths: (rows,), or (rows, columns) where stitches differ.

    ``by_stitch`` says whether a length for every stitch is accepted.

    Raises
    ------
    InputError
        If the lengths do not fit the chart.
    """
    remedy = "Give mm of yarn per stitch, or a table with mm for every stitch."
    lengths = np.atleast_1d(as_numbers("loop_length_mm", loop_length_mm, remedy))
    repeat = chart.repeat()
    if by_stitch and lengths.ndim == 2 and lengths.shape in (chart.purl.shape, repeat.purl.shape):
        if np.all(lengths == lengths[:, :1]):
            return loop_lengths(lengths[:, 0], chart)
        small = lengths[: repeat.rows, : repeat.columns]
        tiles = (lengths.shape[0] // repeat.rows, lengths.shape[1] // repeat.columns)
        if np.array_equal(np.tile(small, tiles), lengths):
            return repeat, small
        return chart, lengths
    if lengths.ndim != 1 or len(lengths) not in (1, chart.rows, repeat.rows):
        raise InputError(
            "loop_length_mm",
            f"{' x '.join(map(str, lengths.shape))} lengths were given for a repeat of "
            f"{size_in_words(repeat.columns, repeat.rows)}.",
            "Give one length, one for every course, or one for every stitch of the repeat."
            if by_stitch
            else "Give one length, or one for every course.",
        )
    if len(lengths) == chart.rows and not np.array_equal(
        lengths, np.resize(lengths[: repeat.rows], len(lengths))
    ):
        return chart, lengths
    return repeat, np.resize(lengths, repeat.rows)


@cache
def compile_kernels() -> None:
    """Compile (or load) the kernels once, so that the times of solves do not include it."""
    yarn = YarnModel(0.045, 6e-4, 2.4, 0.74, 0.1)
    cell = mirrored_cell(StitchChart.parse("K"), SplineGrid(8, 4))
    minimum = grow(
        cell, yarn, np.array([12.0]), Convention.PUBLISHED, MIRRORED_STARTS[0],
        options=Options(iterations=2),
    )  # fmt: skip
    outcome(CellEnergy(cell, yarn, np.array([12.0]), Convention.PUBLISHED), minimum)


def size_intervals(cell: RelaxedCell) -> tuple[Interval, Interval]:
    """90 % intervals of the width and height of a knitted stitch, mm.

    They cover those of other shapes that are as low, for which of them is shown is a rule.
    """
    others = cell.other_minima_mm if isinstance(cell, RelaxedRepeat) else ()
    folded = cell.branch is Branch.FREE and has_mirrors(cell.chart)
    log_sd = YARN_LEVEL_FREE_SIZE_LOG_SD if folded else YARN_LEVEL_SIZE_LOG_SD
    each = zip((cell.cell_course_mm, cell.cell_wale_mm), *others, strict=True)
    course, wale = (
        Interval(log_interval(min(sizes), log_sd).low, log_interval(max(sizes), log_sd).high)
        for sizes in each
    )
    return course, wale
