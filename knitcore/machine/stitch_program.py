"""Programs in knitout for charts of any stitches: transfers, racking, tucks and misses.

The columns of a row fall into groups that take just the loops below them. A group whose loops
change needles is brought into place by planned passes (:mod:`knitcore.machine.transfers`) before
the row is knitted; like groups that are far enough apart go together. Loops that share a needle
arrive in the order in which they lie: what comes later lies between the beds, so behind the others
on the front bed and in front of them on the back bed. In a cable, the loops that pass in front are
on the front bed while the bed is racked.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from types import MappingProxyType

import numpy as np

from knitcore.base.arrays import Mask
from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.stitch_graph import StitchGraph
from knitcore.chart.stitch_kinds import YarnAct
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.garment.piece import Piece, check_row
from knitcore.machine.carriers import CarrierPlan
from knitcore.machine.feed import is_leftwards
from knitcore.machine.profile import DEFAULT, MachineProfile, profile
from knitcore.machine.program import Finish, KnitoutProgram, is_mirrored, knitout_program
from knitcore.machine.program_body import MAX_LOOPS, ProgramBody
from knitcore.machine.tension import LoopYarn
from knitcore.machine.transfers import LoopMove, Needle, TransferPass, TransferPlan, plan_transfers

MOST_SHIFT = 8
"""Most columns by which a bed is racked, however far the machine can."""
MOST_SPARE = 3
"""Needles that the yarn at most lets two neighbours be apart."""


_Move = tuple[int, str, str]
"""A racking in columns, and the needles from which and to which loops go."""


def bed_map(graph: StitchGraph, *, tuck_with_knit: bool = True) -> Mask:
    """For each site, whether it works on the back bed.

    It does for a purl, and where the yarn lies in front of a held loop; and every second one of
    neighbouring yarn overs does, so that each is a loop. Where a bed cannot tuck in the pass in
    which it knits, the yarn overs of a row work on the bed that knits less of it.
    """
    back = np.where(graph.act == YarnAct.MISS, graph.front, graph.purl)
    is_over = (graph.act == YarnAct.OVER) & (np.diff(graph.first, axis=1) == 0)
    if not tuck_with_knit:
        knits = graph.act == YarnAct.THROUGH
        fewer = 2 * (back & knits).sum(axis=1) <= knits.sum(axis=1)
        back = np.where(is_over, fewer[:, None], back)
    for row, column in np.argwhere(is_over[:, :-1] & is_over[:, 1:]):
        back[row, column + 1] = not back[row, column]
    return np.asarray(back, dtype=bool)


def stitches_from_row(chart: SymbolChart, number: int) -> SymbolChart:
    """The chart from a row on, counted from 1.

    Raises
    ------
    InputError
        If there is no such row, or its needles hold several loops, of which a cast-on has none.
    """
    check_row(number, chart.rows)
    single = (chart.graph.act[: number - 1] == YarnAct.THROUGH) | (
        np.diff(chart.graph.first, axis=1)[: number - 1] == 0
    )
    plain = single.all(axis=1)
    if number > 1 and not plain[-1]:
        before = max(np.flatnonzero(plain), default=-1) + 2
        raise InputError(
            "from_row",
            f"row {number - 1} tucks or slips, so that needles hold more than a loop below row "
            f"{number}.",
            f"Begin at row {before}.",
        )
    return SymbolChart(chart.cells[number - 1 :])


def stitch_program(
    chart: Piece | SymbolChart,
    *,
    finish: Finish = Finish.WASTE,
    machine: MachineProfile | None = None,
    stitch_number: float | None = None,
    yarn: LoopYarn | None = None,
    looser: Mapping[float, LoopYarn] = MappingProxyType({}),
) -> KnitoutProgram:
    """The program of a piece, or of a chart of any stitches.

    Parameters are those of :func:`knitcore.machine.program.knitout_program`; ``looser`` is for
    other stitches than knits and purls.

    Raises
    ------
    InputError
        As that function; and for a twisted stitch, more loops than a hook holds, or loops that
        the machine cannot bring into place.

    Examples
    --------
    >>> stitch_program(SymbolChart.parse("O/KK;KKKK")).transfers
    4
    """
    if isinstance(chart, Piece):
        return knitout_program(
            chart, finish=finish, machine=machine, stitch_number=stitch_number, yarn=yarn
        )
    graph = chart.graph
    for row, column in np.argwhere(graph.turn != 0):
        problem = f"row {row + 1}, stitch {column + 1} is twisted, which no machine does."
        raise InputError("chart", problem, "Knit or purl it plainly, or knit the piece by hand.")
    knitted = chart.mirror().graph if machine and is_mirrored(machine) else graph
    beds = bed_map(graph, tuck_with_knit=(machine or profile(DEFAULT)).tuck_with_knit)
    made = knitout_program(
        Piece.plain(StitchChart(beds)),
        finish=finish,
        machine=machine,
        stitch_number=stitch_number,
        yarn=yarn,
        body_of=lambda *given: _StitchBody(knitted, *given),
        looser=looser,
    )
    return replace(made, transfers=made.transfers + made.shaping_transfers, shaping_transfers=0)


def _groups(graph: StitchGraph, row: int) -> Iterator[range]:
    """The narrowest runs of columns that take just the loops below them."""
    start = taken = 0
    last = -1
    for column in range(graph.columns):
        sources = graph.sources(row, column)
        taken, last = taken + len(sources), max(last, *sources, last)
        if taken == last + 1 == column + 1:
            yield range(start, column + 1)
            start = column + 1


class _StitchBody(ProgramBody):
    """The passes of a chart of any stitches; its piece says on which bed each site works."""

    def __init__(
        self,
        graph: StitchGraph,
        piece: Piece,
        plan: CarrierPlan,
        machine: MachineProfile,
        number: float,
        yarn: LoopYarn | None,
        staged: Mapping[int, float],
    ) -> None:
        self._most_rack = min(
            int(machine.racking.most_needles / machine.needles_per_column), MOST_SHIFT
        )
        moves = bool((np.diff(graph.first, axis=1) != 1).any() or graph.layer.any())
        self._margin = self._most_rack if moves else 0
        super().__init__(piece, plan, machine, number, yarn, staged)
        self._graph = graph
        free = machine.columns - 2 * self._margin
        if graph.columns > free:
            raise InputError(
                "chart",
                f"{graph.columns} columns leave no {self._margin} needles free at each side, over "
                "which loops change places.",
                f"Knit at most {free} columns with lace or cables.",
            )

    def courses(self) -> Iterator[str]:
        """The chart, course by course; odd courses (row 1, 3, …) run leftwards."""
        for row, carriers in enumerate(self._plan.rows):
            yield f"; course {row + 1}"
            yield from self._place(row)
            ((_, carrier),) = carriers.runs
            yield from self._feed.stitch_number(self._staged.get(row + 1))
            yield from self._worked(row, carrier)
        yield from self._feed.stitch_number(None)

    def _worked(self, row: int, carrier: int) -> Iterator[str]:
        """The lines of what the carriage does at each needle."""
        columns = range(self._graph.columns)
        leftwards = is_leftwards(row)
        sign = "-" if leftwards else "+"
        for column in reversed(columns) if leftwards else columns:
            act = self._graph.act[row, column]
            self._back[column] = bool(self._piece.chart.purl[row, column])
            needle = self._needle(self._back[column], column)
            if act == YarnAct.THROUGH:
                self._held[column] = 1
            elif act == YarnAct.OVER:
                self._held[column] += 1
            if self._held[column] > MAX_LOOPS:
                raise InputError(
                    "chart",
                    f"row {row + 1}, stitch {column + 1} holds {self._held[column]} loops; a hook "
                    f"holds {MAX_LOOPS}.",
                    "Knit it in fewer rows of tucks.",
                )
            yield f"{_OPERATIONS[YarnAct(act)]} {sign} {needle} {carrier}"

    def _place(self, row: int) -> Iterator[str]:
        """Bring the loops below to the needles that work them."""
        full = {self._needle(back, column) for column, back in self._back.items()}
        rack, per_column = 0, self._machine.needles_per_column
        for at, here, there in _without_returns(list(self._moves_of(row)), full):
            if at != rack:
                rack = at
                yield f"rack {rack * per_column}"
            yield f"xfer {here} {there}"
        if rack:
            yield "rack 0"

    def _moves_of(self, row: int) -> Iterator[_Move]:
        groups = list(_groups(self._graph, row))
        beds = self._piece.chart.purl[row]
        for back in (True, False):
            for group in groups:
                if len(group) == 1 and beds[group.start] == back:
                    for line in self._to_bed(group.start, back=back):
                        _, here, there = line.split()
                        yield 0, here, there
        waiting = [group for group in groups if len(group) > 1]
        while waiting:
            passes = self._passes(row, waiting[0])
            numbers = [*_numbers(passes), 0, len(waiting[0]) - 1]
            width = max(numbers) - min(numbers) + 1
            together = [waiting[0]]
            for group in waiting[1:]:
                is_far = group.start - together[-1].start >= width
                if is_far and self._passes(row, group) == passes:
                    together.append(group)
            yield from self._moved(row, passes, together)
            waiting = [group for group in waiting if group not in together]

    def _passes(self, row: int, group: range) -> tuple[TransferPass, ...]:
        """The passes that bring a group's loops into place, counted from its first column."""
        shift = max(
            abs(int(source) - column)
            for column in group
            for source in self._graph.sources(row, column)
        )
        for beside in (shift, self._most_rack):  # loops beside the group may be in the way
            plan = _planned(self._moves(row, group, beside), self._most_rack)
            near = range(-beside, len(group) + beside)
            if plan and (beside >= self._most_rack or set(_numbers(plan.passes)) <= set(near)):
                return plan.passes
        raise InputError(
            "chart",
            f"row {row + 1}, stitches {group.start + 1} to {group.stop}: "
            f"{self._machine.name} cannot bring these loops to their needles; it racks "
            f"{self._machine.racking.most_needles:g}.",
            "Use a narrower cable, or a machine that racks further.",
        )

    def _moves(self, row: int, group: range, beside: int) -> tuple[LoopMove, ...]:
        """The ways of a group's loops and those beside it, counted from its first column."""
        graph, beds = self._graph, self._piece.chart.purl[row]
        moves = []
        for column in group:
            sources = [int(source) for source in graph.sources(row, column)]
            layers = graph.layers(row, column)
            is_back = bool(beds[column])
            for k, (source, layer) in enumerate(zip(sources, layers, strict=True)):
                order = len(sources) - 1 - k if is_back else k
                start = self._at(source, self._back[source], group)
                moves.append(LoopMove(start, self._at(column, is_back, group), order, int(layer)))
        edges = [*range(group.start - beside, group.start), *range(group.stop, group.stop + beside)]
        still = [self._at(c, self._back[c], group) for c in edges if c in self._back]
        moves += [LoopMove(place, place) for place in still]
        return tuple(sorted(moves, key=lambda move: move.start.number))

    def _number(self, column: int) -> int:
        return super()._number(column + self._margin)

    @staticmethod
    def _at(column: int, back: bool, group: range) -> Needle:
        return Needle("b" if back else "f", column - group.start)

    def _moved(
        self, row: int, passes: Sequence[TransferPass], groups: Sequence[range]
    ) -> Iterator[_Move]:
        """Carry out the passes of like groups together."""
        for step in passes:
            for group in groups:
                for pair in step.transfers:
                    here, there = (
                        self._needle(place.bed == "b", place.number + group.start) for place in pair
                    )
                    yield step.rack, here, there
        for group in groups:
            self._check_hooks(row, group)
            held = {column: self._held.pop(column) for column in group}
            for column in group:
                self._back.pop(column)
            for column in group:
                sources = self._graph.sources(row, column)
                if len(sources):
                    self._held[column] = sum(held[int(source)] for source in sources)
                    self._back[column] = bool(self._piece.chart.purl[row, column])

    def _check_hooks(self, row: int, group: range) -> None:
        """Refuse stitches through more loops than a hook holds."""
        for column in group:
            loops = sum(self._held[int(source)] for source in self._graph.sources(row, column))
            if loops > MAX_LOOPS:
                raise InputError(
                    "chart",
                    f"row {row + 1}, stitch {column + 1} is worked through {loops} loops; a hook "
                    f"holds {MAX_LOOPS}.",
                    "Begin with a row of knits." if row == 0 else "Decrease after a plain row.",
                )


def _without_returns(moves: Sequence[_Move], full: set[str]) -> list[_Move]:
    """Leave out moves that others take back before any at another racking.

    ``full`` are the needles that hold loops before: what is laid onto them does not come back.
    """
    kept: list[tuple[_Move, bool]] = []
    for rack, here, there in moves:
        ends = {here, there}
        met = next(
            (
                k
                for k in reversed(range(len(kept)))
                if kept[k][0][0] != rack or ends & {*kept[k][0]}
            ),
            None,
        )
        if met is not None and kept[met] == ((rack, there, here), False):
            del kept[met]
        else:
            kept.append(((rack, here, there), there in full))
        full.discard(here)
        full.add(there)
    return [move for move, _ in kept]


def _numbers(passes: Sequence[TransferPass]) -> list[int]:
    """Numbers of all needles that passes touch."""
    return [place.number for step in passes for pair in step.transfers for place in pair]


_OPERATIONS = {YarnAct.THROUGH: "knit", YarnAct.OVER: "tuck", YarnAct.MISS: "miss"}


@lru_cache(maxsize=1000)
def _planned(moves: tuple[LoopMove, ...], most_rack: int) -> TransferPlan | None:
    """A plan with as little yarn to spare between neighbours as will do; None if there is none."""
    for spare in range(1, MOST_SPARE + 1):
        try:
            return plan_transfers(moves, most_rack=most_rack, spare_needles=spare)
        except InputError:
            continue
    return None
