"""Relax any repeat of knits and purls at the yarn level, in any branch."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal, TypedDict, Unpack, overload

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.errors import Cancelled, InputError
from knitcore.base.kinds import check_callables, check_flags, check_kind
from knitcore.chart.stitch_chart import StitchChart, check_stitches
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.input_checks import check_time
from knitcore.yarn.model.relaxed_cell import Branch, RelaxedCell
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.paper.bezier_relax import relax_published
from knitcore.yarn.paper.bezier_stitch import published_fabric
from knitcore.yarn.solve.growth import Start
from knitcore.yarn.solve.images import same_for_images
from knitcore.yarn.solve.newton import COURSE, WALE
from knitcore.yarn.solve.splines import MAX_STITCHES, RelaxedRepeat, drafted, relax_splines
from knitcore.yarn.study.lowest import FOLLOWED_UP_TO, lowest
from knitcore.yarn.study.whole_chart import SECONDS_PER_STITCH, WINDOWS_FROM, explored, relax_whole

__all__ = ["Branch", "OnSplines", "RelaxedRepeat", "relax"]

OnSplines = Literal[Branch.MIRRORED, Branch.FREE, "mirrored", "free"]


class RelaxOptions(TypedDict, total=False):
    """Options of :func:`relax` besides the branch."""

    convention: Convention | str
    cell_course_mm: float | None
    cell_wale_mm: float | None
    flat: bool
    grid: SplineGrid | None
    starts: Sequence[Start] | None
    time_limit_s: float | None
    cancelled: Cancelled | None


@overload
def relax(
    chart: StitchChart, yarn: YarnModel, loop_length_mm: ArrayLike, *,
    branch: OnSplines | None = ..., **options: Unpack[RelaxOptions],
) -> RelaxedRepeat: ...  # fmt: skip


@overload
def relax(
    chart: StitchChart, yarn: YarnModel, loop_length_mm: ArrayLike, *,
    branch: Branch | str | None, **options: Unpack[RelaxOptions],
) -> RelaxedCell: ...  # fmt: skip


def relax(
    chart: StitchChart,
    yarn: YarnModel,
    loop_length_mm: ArrayLike,
    *,
    branch: Branch | str | None = None,
    convention: Convention | str = Convention.PUBLISHED,
    cell_course_mm: float | None = None,
    cell_wale_mm: float | None = None,
    flat: bool = False,
    grid: SplineGrid | None = None,
    starts: Sequence[Start] | None = None,
    time_limit_s: float | None = None,
    cancelled: Cancelled | None = None,
) -> RelaxedCell:
    """Shape of least energy of a repeat, free of force unless a size is prescribed.

    Parameters
    ----------
    chart : the repeat (or any number of repeats).
    yarn : the yarn.
    loop_length_mm : mm of yarn per stitch: one number, one for every course of the repeat (bottom
        first), or (rows, columns), one for every stitch, from the lowest point of the yarn before
        it to that after it. Where they do not repeat with the chart, the whole chart is the cell.
    branch : ``mirrored`` imposes the symmetries of the chart, ``free`` none (it also continues the
        mirrored state, shaken, and keeps the lowest). ``published`` is the paper's own
        description: a stitch of a pure fabric with one loop length. By default symmetry is only
        the start: the mirrored state is followed to the minimum that it leads to without its
        symmetries (:func:`~knitcore.yarn.study.lowest.lowest`). A repeat of more than
        ``FOLLOWED_UP_TO`` stitches is then relaxed in the free branch; a shape that is held, or
        has a grid or starts of your own, keeps its symmetries.
    convention : factors of the energy.
    cell_course_mm, cell_wale_mm : size of a stitch to hold, mm; None leaves it free of force.
    flat : hold the middles of all stitches in one plane, as in a fabric laid flat, without folds;
        no yarn passes from stitch to stitch, and those in like surroundings tip and lean alike.
    grid : resolution; by default finer for small cells.
    starts : by default two, and five in the free branch (fewer for large cells). Cells of 100 and
        more stitches without symmetry, nothing else prescribed, are relaxed by
        :func:`~knitcore.yarn.study.whole_chart.relax_whole`, smaller ones of 12 and more begin like
        this.
    time_limit_s : refuse a cell that would probably take more CPU time, s.
    cancelled : called before every step; True stops with CancelledError.

    Raises
    ------
    InputError
        If the loop is too short or too long for the yarn, a size is out of reach, the cell is too
        large, the branch does not support an option, or a name is not known.
    ConvergenceError
        If no start relaxed.
    UnravelledError
        If every start lost its topology.
    CancelledError
        If ``cancelled`` says so.
    """
    factors = Convention.parse(convention)
    check_flags(flat=flat)
    check_callables(cancelled=cancelled)
    if grid is not None:
        check_kind("grid", grid, SplineGrid, "Give a SplineGrid, such as SplineGrid(16, 5).")
    if starts is not None:
        for start in starts if isinstance(starts, Sequence) else (starts,):
            check_kind("starts", start, Start, "Give a list of Start, such as [Start('usual')].")
    set_by_caller = (cell_course_mm, cell_wale_mm, grid, starts)
    prescribed = flat or any(option is not None for option in set_by_caller)
    free, _, lengths = drafted(chart, loop_length_mm, Branch.FREE)
    prescribed = prescribed or lengths.ndim > 1
    uniform = bool(np.ptp(lengths) == 0.0)
    if branch is not None:
        kind = Branch.parse(branch)
    else:
        small = free.stitches <= FOLLOWED_UP_TO
        kind = Branch.MIRRORED if small or prescribed else Branch.FREE
    if kind is not Branch.PUBLISHED:
        cell = free if kind is Branch.FREE else drafted(chart, loop_length_mm, kind)[0]
        in_rounds = not (prescribed or cell.symmetric)
        if in_rounds and cell.stitches >= WINDOWS_FROM:
            check_stitches(cell.stitches, MAX_STITCHES, "its cell")
            check_time(cell.stitches, lambda stitches: SECONDS_PER_STITCH * stitches, time_limit_s)
            whole = relax_whole(
                StitchChart(cell.purl), yarn, np.resize(lengths, cell.rows),
                convention=factors, cancelled=cancelled,
            )  # fmt: skip
            return replace(whole, branch=kind)

        def searched(image: StitchChart) -> RelaxedRepeat:
            relaxed = relax_splines(
                image, yarn, lengths[0] if uniform else loop_length_mm, branch=kind,
                convention=factors, sizes_mm=(cell_course_mm, cell_wale_mm), flat=flat, grid=grid,
                starts=starts, explore=explored if in_rounds else None,
                time_limit_s=time_limit_s, cancelled=cancelled,
            )  # fmt: skip
            if branch is not None or prescribed:
                return relaxed
            return lowest(relaxed, cancelled=cancelled)

        if starts is not None or not uniform:
            return searched(chart)
        sizes = {COURSE: cell_course_mm, WALE: cell_wale_mm}
        fixed = tuple(which for which, size in sizes.items() if size is not None)
        return same_for_images(searched, chart.repeat(), fixed=fixed, cancelled=cancelled)
    if flat or grid is not None or starts is not None or np.size(loop_length_mm) != 1:
        raise InputError(
            "branch",
            "the published branch takes one loop length, and no grid, starts or plane.",
            "Use mirrored or free.",
        )
    return relax_published(
        published_fabric(chart), yarn, np.asarray(loop_length_mm, dtype=float).item(),
        cell_course_mm, cell_wale_mm, factors, cancelled=cancelled,
    )  # fmt: skip
