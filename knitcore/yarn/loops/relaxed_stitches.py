"""A repeat of any stitches at rest: drawn, taken down, and let go after a named history."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.choice import Choice
from knitcore.base.errors import Cancelled, ConvergenceError, InputError, UnravelledError
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart, check_stitches
from knitcore.chart.stitch_graph import StitchGraph
from knitcore.chart.stitch_kinds import YarnAct
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.loops.chart_images import ChartImage
from knitcore.yarn.loops.drawn_yarn import DrawnYarn
from knitcore.yarn.loops.holes import holes, is_folded
from knitcore.yarn.loops.stitch_energy import StitchEnergy, YarnPerAct
from knitcore.yarn.loops.take_down import TakeDown, pulls_n, room_for_yarn
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import SPACING_PER_BENDING, CellEnergy
from knitcore.yarn.model.input_checks import check_loop
from knitcore.yarn.model.relaxed_cell import Branch
from knitcore.yarn.model.tiling import centre_lines
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.clasps import cell_is_knitted, clasp_code
from knitcore.yarn.solve.friction import RubbedCell, Rubbing, check_coefficient, rub
from knitcore.yarn.solve.newton import Minimum, Options, minimise
from knitcore.yarn.solve.splines import RelaxedRepeat, compile_kernels, relaxed_repeat

MAX_STITCHES = 36
"""Largest repeat."""
BLOCKING_N_PER_MM = 0.03
"""Pull both ways of a blocked cloth."""
FRICTION = 0.26
"""Coefficient of friction between yarns unless another is given."""
TAKE_DOWN_N_PER_MM = 0.03
"""Pull along the wale of a cloth as it was knitted."""
_RELEASE = 3
"""Steps in which a pull is let go."""
_SETTLED = Options(tolerance=1e-6, slack=1e-6, iterations=150)
_PULLED = Options(tolerance=1e-4, slack=1e-4, iterations=150, leaves_saddles=False, rounded=True)
"""Settings under a pull that is let go afterwards: it may hold a saddle, which friction leaves."""
_RUBBED = Options(tolerance=1e-5, slack=1e-5, iterations=60)
CAUTION = (
    "This is one history of many, and such a cloth rests differently after another one. Sizes of "
    "cells with lace, cables, slipped or tucked stitches miss measured cloth by a factor of 1.2 to "
    "1.35: take them as a picture of the yarn, not as a prediction."
)
LOOSENED = (
    "The yarn of loops that cross locked, so the row below a crossing got more: {:.0%} of a knit's "
    "for each such loop."
)
FOLDED = "The cloth folds in this shape, so it has no size."


class StitchHistory(Choice):
    """The treatment of a cloth of any stitches before it came to rest."""

    AGITATED = "agitated"
    """Shaken until no friction is left; lace and cables crumple."""
    KNITTED = "as-knitted"
    """Taken down as on the machine and let go, with friction."""
    BLOCKED = "blocked"
    """Pulled equally both ways, as on a blocking board, and let go, with friction."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class StitchRepeat(RelaxedRepeat):
    """A repeat of any stitches on splines."""

    @property
    def energy(self) -> StitchEnergy:
        """The energy whose minimum this is, without pulls."""
        return StitchEnergy(self.cell, self.yarn, self.loop_lengths_mm, self.convention)


@dataclass(frozen=True, eq=False, repr=False)
class RelaxedStitches(Result):
    """A relaxed repeat of any stitches.

    Attributes
    ----------
    chart : the repeat, at least two stitches each way.
    image : the image that was relaxed in its place.
    yarn : the yarn.
    loop_lengths_mm : (rows,) yarn per site of each row, bottom first.
    history, friction : how it came to rest; no friction where it was agitated.
    cell_course_mm, cell_wale_mm : width of a wale and height of a row, mm.
    thickness_mm : from the lowest to the highest yarn.
    folded : whether its rows or columns stand rather than lie, so that its sizes are none of a
        cloth.
    hole_share : part of the cloth that no yarn covers.
    eyelet_mm2 : mean area of the holes of yarn overs, neighbouring ones together; None without any.
    energy_n_mm : energy of one site, N·mm.
    bending_share : share of bending in it.
    crossings : crossings of the first shape that the chart asks for. All steps of the yarn from
        there are certified, so that they are kept.
    layered : crossings of loops that lie behind each other, beyond these.
    min_distance_mm : smallest distance of centre lines.
    seconds : CPU time, s.
    converged : whether the solver reached its tolerance.
    centre_lines : (rows, points, 3) of the yarn, mm, once across the repeat, bottom row first.
    state : the yarn of the image at rest with the friction that holds it, to be pulled on.
    notes : remarks for the user.
    """

    chart: SymbolChart
    image: ChartImage
    yarn: YarnModel
    loop_lengths_mm: Array
    history: StitchHistory
    friction: float | None
    cell_course_mm: float
    cell_wale_mm: float
    thickness_mm: float
    folded: bool
    hole_share: float
    eyelet_mm2: float | None
    energy_n_mm: float
    bending_share: float
    crossings: int
    layered: int
    min_distance_mm: float
    seconds: float
    converged: bool
    centre_lines: Array
    state: RubbedCell
    notes: tuple[str, ...] = (CAUTION,)

    also_listed: ClassVar = ("pattern",)
    not_listed: ClassVar = ("image", "state")

    @property
    def pattern(self) -> str:
        """The repeat in one line."""
        return self.chart.key

    def write(self, path: Path | str) -> None:
        """Write the yarn of one repeat by the file's suffix: ``.npz`` or ``.vtu``.

        The latter has a line for every row, with the row at every point of it.

        Raises
        ------
        InputError
            If the suffix is neither of these.
        """
        target, (rows, count, _) = Path(path), self.centre_lines.shape
        if target.suffix.lower() == ".npz":
            size = self.cell_course_mm, self.cell_wale_mm
            np.savez_compressed(
                target, centre_lines_mm=self.centre_lines, cell_mm=size, allow_pickle=False
            )
        elif target.suffix.lower() == ".vtu":
            import meshio

            place = np.arange(rows * count).reshape(rows, count)
            pairs = np.stack([place[:, :-1], place[:, 1:]], axis=-1).reshape(-1, 2)
            row = {"row": np.repeat(np.arange(rows), count)}
            points = self.centre_lines.reshape(-1, 3)
            meshio.Mesh(points, [("line", pairs)], point_data=row).write(target, file_format="vtu")
        else:
            raise InputError("out", f"{target.name} has an unknown suffix.", "Use .npz or .vtu.")


def relax_stitches(
    chart: SymbolChart,
    yarn: YarnModel,
    loop_length_mm: float,
    *,
    history: StitchHistory | str = StitchHistory.BLOCKED,
    friction: float = FRICTION,
    per_act: YarnPerAct | None = None,
    convention: Convention | str = Convention.PUBLISHED,
    cancelled: Cancelled | None = None,
) -> RelaxedStitches:
    """Relax a repeat of any balanced stitches.

    Parameters
    ----------
    chart : the repeat, or any number of repeats; at most 36 stitches in one.
    yarn : the yarn.
    loop_length_mm : yarn of a knit.
    history : what the cloth went through.
    friction : coefficient of friction between yarns; not used where it is agitated.
    per_act : yarn of other stitches, relative to a knit's. By default loops that cross get more
        where they would lock, and a note says how much.
    convention : factors of the energy.
    cancelled : called before every step; True stops with CancelledError.

    Raises
    ------
    InputError
        If the repeat is too large, or a value is out of range.
    ConvergenceError
        If the yarn cannot be drawn, or locks; the message has the remedy.
    CancelledError
        If ``cancelled`` says so.
    """
    kind = StitchHistory.parse(history)
    check_coefficient(friction)
    check_loop(yarn, loop_length_mm)
    chart = chart.repeat()
    whole = chart.tile(2 if chart.rows == 1 else 1, 2 if chart.columns == 1 else 1)
    check_stitches(whole.rows * whole.columns, MAX_STITCHES, "its repeat")
    compile_kernels()
    clock = time.process_time()
    image = ChartImage.least(whole)
    graph = image.chart.graph
    drawn = knotted(room_for_yarn(graph, yarn, loop_length_mm))
    lengths = loop_length_mm * (per_act or YarnPerAct()).of_rows(graph)
    crossing = loop_length_mm * _crossing(graph)
    loosened = crossing if per_act is None and crossing.any() else None
    take_down = TakeDown(yarn, Convention.parse(convention), lengths, loosened, cancelled)
    energy, minimum = take_down(drawn)
    more = energy.loop_length_mm - lengths
    lengths = energy.loop_length_mm
    energy, minimum, rubbing = _at_rest(
        energy, minimum.state, minimum.tension, kind, friction, cancelled
    )
    cell, state = energy.cell, minimum.state
    if not cell_is_knitted(cell, state):
        raise UnravelledError("The stitches come undone on the way to rest.")
    lines = centre_lines(cell, state, cell.rows, cell.wales)
    course, wale = float(state[-2]), float(state[-1])
    open_places = holes(lines, cell.wales * course, cell.rows * wale, yarn.radius_mm)
    folded = is_folded(lines, cell.wales, course, wale)
    notes = (FOLDED, CAUTION) if folded else (CAUTION,)
    if more.max() > 0.0:
        notes = (LOOSENED.format(1.0 + more.sum() / crossing.sum()), *notes)
    seconds = time.process_time() - clock
    plain = relaxed_repeat(
        StitchChart(cell.purl), energy, Branch.FREE, minimum, seconds=seconds,
        evaluations=minimum.evaluations, notes=notes,
    )  # fmt: skip
    return RelaxedStitches(
        chart=whole,
        image=image,
        yarn=yarn,
        loop_lengths_mm=image.rows_back(lengths),
        history=kind,
        friction=None if kind is StitchHistory.AGITATED else friction,
        cell_course_mm=course,
        cell_wale_mm=wale,
        thickness_mm=plain.thickness_mm,
        folded=folded,
        hole_share=open_places.share,
        eyelet_mm2=open_places.eyelet_mm2(yarn_overs(graph)),
        energy_n_mm=minimum.terms.energy / cell.stitches,
        bending_share=minimum.terms.rod / minimum.terms.energy,
        crossings=drawn.exact,
        layered=sum(drawn.crossings.values()) - drawn.exact,
        min_distance_mm=minimum.min_distance_mm,
        seconds=seconds,
        converged=minimum.converged,
        centre_lines=image.lines_back(lines, course, wale),
        state=RubbedCell(StitchRepeat(**vars(plain)), rubbing, 0.0),
        notes=notes,
    )


def knotted(drawn: DrawnYarn) -> DrawnYarn:
    """Keep in its cell how a first shape is knotted."""
    cell, state = drawn.cell, drawn.state
    lines = centre_lines(cell, state, cell.rows, cell.wales)
    code = clasp_code(lines, cell.wales * float(state[-2]), cell.rows * float(state[-1]))
    return replace(drawn, cell=replace(cell, code=tuple(code.tolist())))


def _crossing(graph: StitchGraph) -> Array:
    """(rows,) part of each row's loops that cross others."""
    plain, twice = YarnPerAct(), YarnPerAct(crossing=2.0)
    return twice.of_rows(graph) - plain.of_rows(graph)


def yarn_overs(graph: StitchGraph) -> int:
    """How many runs of neighbouring yarn overs a repeat has."""
    over = (graph.act == YarnAct.OVER) & (np.diff(graph.first, axis=1) == 0)
    return int((over & ~np.roll(over, 1, axis=1)).sum())


def _at_rest(
    energy: StitchEnergy, state: Array, tension: Array, history: StitchHistory, friction: float,
    cancelled: Cancelled | None,
) -> tuple[StitchEnergy, Minimum, Rubbing]:  # fmt: skip
    """The state after a history, from that under the take-down, and the friction it holds."""
    stitches, pull = energy.cell.stitches, (0.0, 0.0)
    if history is StitchHistory.KNITTED:
        pull = pulls_n(stitches, energy.mean_loop_mm, TAKE_DOWN_N_PER_MM)
    if history is StitchHistory.BLOCKED:
        both = BLOCKING_N_PER_MM * stitches
        pull = both * float(state[-1]), both * float(state[-2])
    energy = replace(energy, pull_n=pull, spacing_per_bending=SPACING_PER_BENDING)
    options = _SETTLED if history is StitchHistory.AGITATED else _PULLED
    minimum = minimise(energy, state, tension=tension, options=options, cancelled=cancelled)
    rubbing = Rubbing(np.zeros(0, np.int64), np.zeros((0, 2)))
    if history is StitchHistory.AGITATED:
        return energy, minimum, rubbing
    for left in range(_RELEASE - 1, -1, -1):
        energy = replace(energy, pull_n=(pull[0] * left / _RELEASE, pull[1] * left / _RELEASE))
        minimum, rubbing, _ = rub(
            energy, minimum.state, minimum.tension, rubbing, friction, options=_RUBBED,
            check=_check_apart, cancelled=cancelled,
        )  # fmt: skip
    return energy, minimum, rubbing


def _check_apart(energy: CellEnergy, minimum: Minimum) -> None:
    if minimum.min_distance_mm <= 2.0 * energy.yarn.core_radius_mm:
        raise ConvergenceError("The yarn locks while the cloth is let go. Give longer loops.")
