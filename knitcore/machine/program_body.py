"""The passes of a program between its headers and its end, with the bed of each loop."""

from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import pairwise
from types import MappingProxyType

import numpy as np

from knitcore.base.errors import InputError
from knitcore.garment.piece import Piece
from knitcore.machine.carriers import CarrierPlan, CarrierRow
from knitcore.machine.feed import FirstCourse, HookFeed, WasteFeed, is_leftwards
from knitcore.machine.profile import MachineProfile
from knitcore.machine.program_passes import NEIGHBOURS
from knitcore.machine.tension import LoopYarn, plan_safely
from knitcore.machine.transfers import LoopMove, Needle, TransferPlan, plan_transfers

WASTE_COURSES = 6
TAG_STITCHES = 4
ANCHOR_TUCKS = 3
"""Tucks that hold a yarn brought in within a course."""
MAX_LOOPS = 3
"""Loops that a needle's hook holds well."""


class ProgramBody:
    """The passes of a program, with the bed of each loop.

    Parameters
    ----------
    piece : what is knitted.
    plan : its carriers.
    machine : the profile.
    number : of the piece's stitches.
    yarn : transfers are planned so that it stands them; None does not look at it.
    staged : courses, from 0, before which all loops come to the front, so that no racking pulls
        those of the back; with a stitch number, for bodies that knit the row before looser.
    """

    def __init__(
        self,
        piece: Piece,
        plan: CarrierPlan,
        machine: MachineProfile,
        number: float,
        yarn: LoopYarn | None = None,
        staged: Mapping[int, float] = MappingProxyType({}),
    ) -> None:
        self._piece, self._plan, self._machine = piece, plan, machine
        self._yarn, self._staged = yarn, staged
        self._plans: dict[tuple[LoopMove, ...], TransferPlan] = {}
        self._spans = piece.shaped.spans
        self._back: dict[int, bool] = {}
        self._held: Counter[int] = Counter()
        first = range(*self._spans[0])
        backs = piece.chart.purl[0]
        needles = FirstCourse(
            [self._number(c) for c in first if not backs[c]],
            [self._number(c) for c in first if backs[c]],
            self._number(min(a for a, _ in self._spans)),
            self._number(max(b for _, b in self._spans) - 1),
        )
        feed = HookFeed if machine.carriers.hooks else WasteFeed
        self._feed: HookFeed = feed(machine, plan, needles, number)

    def start(self) -> Iterator[str]:
        """Settings, and the waste yarn that comes first on a machine without a hook."""
        return self._feed.start()

    def cast_on(self) -> Iterator[str]:
        """Tucks on every other needle and back on the rest, each on its first stitch's bed."""
        yield "; cast-on"
        for run, carrier in reversed(self._plan.rows[0].runs):
            columns = range(run.start, run.stop)
            yield from self._feed.bring(carrier)
            yield from self._there_and_back(columns, carrier, 0, 0)
            yield from self._feed.hold(carrier)
            for column in columns:
                self._held[column] += self._feed.base_loops

    def courses(self) -> Iterator[str]:
        """The chart, course by course; odd courses (row 1, 3, …) run leftwards."""
        for row, carriers in enumerate(self._plan.rows):
            yield f"; course {row + 1}"
            waiting = set(carriers.new) if row else set()
            if row:
                yield from self._shape(row, carriers, waiting)
                yield from self._cross(row)
            yield from self._course(row, carriers, waiting)

    def _shape(self, row: int, carriers: CarrierRow, waiting: set[int]) -> Iterator[str]:
        below, here = self._spans[row - 1], self._spans[row]
        leftwards = is_leftwards(row)
        right_loss = range(below[1] - 1, here[1] - 1, -1)
        left_loss = range(below[0], here[0])
        right_gain, left_gain = range(below[1], here[1]), range(here[0], below[0])
        losses, gains = (right_loss, left_loss), (right_gain, left_gain)
        begin, end = (0, 1) if leftwards else (1, 0)
        inwards = -1 if leftwards else 1
        if row in self._staged:
            for column in range(*below):
                yield from self._to_bed(column, back=False)
        yield from self._lose(list(losses[end]), None, inwards=-inwards)
        for carrier in carriers.ended:
            yield from self._feed.end(carrier, row)
        if gains[end]:
            strand = self._feed.strand(on_left=leftwards)
            yield from self._feed.bring(strand)
            yield from self._there_and_back(gains[end], strand, row, row + 1)
            yield from self._feed.hold(strand)
            yield from self._feed.end_strand(strand)
        # A chain goes on as the course's first run, or it needs a strand of its own.
        first, parked = (self._plan.rows[r].runs[-1 if leftwards else 0][1] for r in (row, row - 1))
        chain = parked if parked == first and first not in carriers.new else None
        yield from self._lose(list(losses[begin]), chain, inwards=inwards)
        edge = gains[begin]
        for run, carrier in carriers.runs:
            new = range(max(run.start, edge.start), min(run.stop, edge.stop))
            if new:
                yield from self._gain(new, carrier, row, waiting)

    def _lose(self, columns: list[int], carrier: int | None, *, inwards: int) -> Iterator[str]:
        """Put the loops of an edge, the outermost first, onto the first one that stays.

        Several are chained by a yarn that is present, or by a strand brought in for it.
        """
        if not columns:
            return
        is_chained = carrier is None and len(columns) > 1
        strand = self._feed.strand(on_left=inwards > 0) if is_chained else None
        if len(columns) > 1:
            for column in (*columns[strand is None :], columns[-1] + inwards):
                yield from self._to_bed(column, back=False)
        sign = "-" if inwards < 0 else "+"
        if strand is not None:
            first = "-" if self._feed.needs_anchor else sign
            yield from self._feed.bring(strand)
            yield f"knit {first} {self._needle(False, columns[0])} {strand}"
            yield from self._feed.hold(strand)
            carrier = strand
        for here, beside in pairwise((*columns, columns[-1] + inwards)):
            yield from self._onto(here, beside)
            self._held[beside] += self._held.pop(here)
            if beside != columns[-1] + inwards:
                self._held[beside] = 1
                yield f"knit {sign} {self._needle(False, beside)} {carrier}"
        if strand is not None:
            yield from self._feed.end_strand(strand)

    def _gain(self, columns: range, carrier: int, row: int, waiting: set[int]) -> Iterator[str]:
        """Cast on with the yarn of the course, which then begins at the outer edge."""
        leftwards = is_leftwards(row)
        if carrier in waiting:
            waiting.remove(carrier)
            yield from self._feed.bring(carrier)
            if self._feed.comes_from_right(row) == leftwards:
                yield from self._there_and_back(columns, carrier, row, row)
            else:
                yield from self._zigzag(columns, carrier, leftwards=True)
            yield from self._feed.hold(carrier)
        else:
            yield from self._zigzag(columns, carrier, leftwards=not leftwards)

    def _zigzag(self, columns: range, carrier: int, *, leftwards: bool) -> Iterator[str]:
        """One pass of tucks, from bed to bed so that each is a loop."""
        for column in sorted(columns, reverse=leftwards):
            self._back[column], self._held[column] = bool(column % 2), 1
            sign = "-" if leftwards else "+"
            yield f"tuck {sign} {self._needle(self._back[column], column)} {carrier}"

    def _there_and_back(self, columns: range, carrier: int, row: int, begins: int) -> Iterator[str]:
        """Tucks for a row on every other needle, and back on the rest.

        They begin on the side where yarn comes from for the row ``begins``.
        """
        from_right = self._feed.comes_from_right(begins)
        outwards, back = ("-", "+") if from_right else ("+", "-")
        order = columns[::-1] if from_right else columns
        beds = self._piece.chart.purl[row]
        for sign, tucked in ((outwards, order[::2]), (back, order[1::2][::-1])):
            for column in tucked:
                self._back[column], self._held[column] = bool(beds[column]), 1
                yield f"tuck {sign} {self._needle(beds[column], column)} {carrier}"

    def _cross(self, row: int) -> Iterator[str]:
        """Loops that go to the back in one pass, and those that come to the front in another."""
        purl = self._piece.chart.purl[row]
        for back in (True, False):
            for column in range(*self._spans[row]):
                if purl[column] == back:
                    yield from self._to_bed(column, back=back)

    def _to_bed(self, column: int, *, back: bool) -> Iterator[str]:
        if self._back[column] != back:
            yield f"xfer {self._needle(not back, column)} {self._needle(back, column)}"
            self._back[column] = back

    def _course(self, row: int, carriers: CarrierRow, waiting: set[int]) -> Iterator[str]:
        beds, leftwards = self._piece.chart.purl[row], is_leftwards(row)
        sign = "-" if leftwards else "+"
        order = carriers.runs[::-1] if leftwards else carriers.runs
        for place, (run, carrier) in enumerate(order):
            columns = range(run.start, run.stop)
            if carrier in waiting:
                yield from self._feed.bring(carrier)
                if not leftwards and self._feed.needs_anchor:
                    anchor = columns[1 : 2 * ANCHOR_TUCKS : 2] or columns
                    for column in reversed(anchor):
                        yield from self._tie(column, row, carrier, "-")
                    yield from self._feed.hold(carrier)
            for column in reversed(columns) if leftwards else columns:
                self._held[column] = 1
                yield f"knit {sign} {self._needle(beds[column], column)} {carrier}"
            if place + 1 < len(order):
                beside = columns[0] - 1 if leftwards else columns.stop
                if not self._machine.tuck_with_knit and self._held[beside] < MAX_LOOPS:
                    last = beside + (1 if leftwards else -1)
                    back = "+" if leftwards else "-"
                    yield f"miss {back} {self._needle(beds[last], last)} {carrier}"
                yield from self._tie(beside, row, carrier, sign)
            if carrier in waiting and leftwards:
                yield from self._feed.hold(carrier)

    def _tie(self, column: int, row: int, carrier: int, sign: str) -> Iterator[str]:
        """Tuck a yarn into a stitch of another, unless that needle is full."""
        if self._held[column] < MAX_LOOPS:
            self._held[column] += 1
            needle = self._needle(self._piece.chart.purl[row, column], column)
            yield f"tuck {sign} {needle} {carrier}"

    def waste(self) -> Iterator[str]:
        """Courses of another yarn on the same needles, after which all loops are dropped."""
        beds, columns = self._piece.chart.purl[-1], range(*self._spans[-1])
        strand = self._feed.strand(on_left=True)
        for _, carrier in self._plan.rows[-1].runs:
            yield from self._feed.end(carrier, None)
        yield "; waste yarn"
        yield from self._feed.waste_settings()
        yield from self._feed.bring(strand)
        for course in range(WASTE_COURSES):
            leftwards = is_leftwards(course) == self._feed.needs_anchor
            sign, order = ("-", columns[::-1]) if leftwards else ("+", columns)
            for column in order:
                yield f"knit {sign} {self._needle(beds[column], column)} {strand}"
            if course == 1:
                yield from self._feed.hold(strand)
        yield from self._feed.finish(after_waste=True)
        for column in columns:
            yield f"drop {self._needle(beds[column], column)}"

    def bind_off(self) -> Iterator[str]:
        """A chain along the edge: each loop is put onto its neighbour and both are knitted."""
        yield "; bind-off"
        # The yarn is at the edge that the last course ran to; the chain starts there.
        rightwards = is_leftwards(len(self._spans) - 1)
        sign, back = ("+", "-") if rightwards else ("-", "+")
        columns = range(*self._spans[-1])[:: 1 if rightwards else -1]
        runs = self._plan.rows[-1].runs
        (_, carrier), *others = runs if rightwards else runs[::-1]
        for _, other in others:
            yield from self._feed.end(other, None)
        for column in columns[1:] or columns:
            yield from self._to_bed(column, back=False)
        for here, beside in pairwise(columns):
            yield from self._onto(here, beside)
            yield f"knit {sign} {self._needle(False, beside)} {carrier}"
        last = columns[-1]
        if len(columns) > 1:
            for way in (back, sign) * (TAG_STITCHES // 2):
                yield f"knit {way} {self._needle(False, last)} {carrier}"
        yield from self._feed.end(carrier, None)
        yield from self._feed.finish(after_waste=False)
        yield f"drop {self._needle(False, last)}"

    def _onto(self, here: int, beside: int) -> Iterator[str]:
        """Move a loop onto its neighbour, in few passes that the yarn stands."""
        inwards = beside - here
        near = [beside + inwards * steps for steps in range(NEIGHBOURS + 1)]
        held = [column for column in near if column in self._back]
        moves = [self._move(here, beside, beside), *(self._move(c, c, beside) for c in held)]
        rack = 0
        for step in self._planned(tuple(moves)).passes:
            if step.rack != rack:
                rack = step.rack
                yield f"rack {rack}"
            for start, end in step.transfers:
                names = [f"{n.bed}{n.number + self._number(beside)}" for n in (start, end)]
                yield f"xfer {' '.join(names)}"
        if rack:
            yield "rack 0"
        del self._back[here]

    def _planned(self, moves: tuple[LoopMove, ...]) -> TransferPlan:
        if moves not in self._plans:
            machine, yarn = self._machine, self._yarn
            if not machine.racking.most_needles and machine.beds > 1:
                raise InputError(
                    "outline",
                    f"decreases and bind-offs rack a bed; that of {machine.name} does not move.",
                    "Knit a rectangle that ends in waste yarn, or choose a machine that racks.",
                )
            self._plans[moves] = (
                plan_safely(moves, yarn, machine).plan
                if yarn is not None and machine.beds > 1
                else plan_transfers(
                    moves,
                    most_rack=int(machine.racking.most_needles),
                    spare_needles=2 * machine.needles_per_column,
                )
            )
        return self._plans[moves]

    def _move(self, start: int, end: int, origin: int) -> LoopMove:
        """A loop's move, with needles counted from a column's."""
        bed, at = "b" if self._back[start] else "f", self._number(origin)
        target = "b" if self._back[end] else "f"
        return LoopMove(
            Needle(bed, self._number(start) - at), Needle(target, self._number(end) - at)
        )

    def _number(self, column: int) -> int:
        return column * self._machine.needles_per_column + 1

    def _needle(self, back: bool | np.bool_, column: int) -> str:
        return f"{'b' if back else 'f'}{self._number(column)}"
