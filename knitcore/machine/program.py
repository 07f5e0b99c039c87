"""Knitout v2: the program that knits a piece flat on a V-bed machine.

A knit of the face is made on the front bed, a purl on the back bed. Before a course, the loops
whose next stitch is of the other kind are transferred straight across. Needle 1 is the left edge of
the face. Programs end in courses of waste yarn, which hold the last course without a transfer, or
in a chain bind-off.

Edges are shaped as by hand. Where a course begins, its own yarn casts on and binds off; where it
ends, that yarn has not arrived, so a separate strand is used. A loss of one stitch is a decrease:
its loop is put onto the neighbour. Blocks of colour have a carrier each (intarsia), and each course
tucks the yarn of a block into the next one, so that no slit is left.

Specification: https://textiles-lab.github.io/knitout/knitout.html
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.garment.piece import Piece
from knitcore.machine.carriers import CarrierPlan, CarrierRow, plan_carriers

MAX_NEEDLES = 540
"""Needles of one bed of a wide machine (Shima Seiki SWG091N2), and of the interpreter's."""
WASTE_COURSES = 6
TAG_STITCHES = 4
ANCHOR_TUCKS = 3
"""Tucks that hold a yarn brought in within a course."""
MAX_LOOPS = 3
"""Loops that a needle's hook holds well."""


class Finish(StrEnum):
    """The finish that keeps the last course from ravelling."""

    WASTE = "waste"
    BIND_OFF = "bind-off"


@dataclass(frozen=True)
class KnitoutProgram:
    """A program and its figures for a technician.

    Attributes
    ----------
    text : the program, one instruction a line.
    transfers : loops moved across the beds between the chart's courses.
    shaping_transfers : further loops moved to shape the edges.
    carriers : yarn carriers, without that of the waste yarn.
    """

    text: str
    transfers: int
    shaping_transfers: int
    carriers: int = 1


def knitout_program(
    chart: StitchChart | Piece, *, finish: Finish = Finish.WASTE, needles: int = MAX_NEEDLES
) -> KnitoutProgram:
    """The program of a chart; :func:`knitcore.formats.read.knitout_reader.verified` checks it.

    Raises
    ------
    InputError
        If the chart is wider than the machine, or has more blocks of colour than carriers.

    Examples
    --------
    >>> knitout_program(StitchChart.of_fabric("seed", rows=4, columns=6)).transfers
    18
    """
    piece = Piece.of(chart)
    columns, rows = piece.chart.columns, piece.chart.rows
    if columns > needles:
        parts = -(-columns // needles)
        turned = f"; turned by a quarter it is {rows} columns wide" if rows <= needles else ""
        raise InputError(
            "chart",
            f"{columns} columns are wider than the machine's {needles} needles.",
            f"Knit at most {needles} columns: split the chart into {parts} pieces of "
            f"{-(-columns // parts)}{turned}.",
        )
    plan = plan_carriers(piece)
    body = _Body(piece, plan)
    courses = [*body.cast_on(), *body.courses()]
    yarns = piece.yarns
    lines = [
        ";!knitout-2",
        ";;Machine: SWG091N2",
        ";;Gauge: 15",
        ";;Position: Keep",
        f";;Carriers: {' '.join(map(str, range(1, plan.waste + 1)))}",
        *(f"; carrier {k} knits {yarns[y].colour} {yarns[y].name}" for k, y in plan.yarns.items()),
        *courses,
        *(body.waste() if finish is Finish.WASTE else body.bind_off()),
    ]
    stitch = piece.shaped.stitch
    changed = (piece.chart.purl[1:] ^ piece.chart.purl[:-1]) & stitch[1:] & stitch[:-1]
    crossings = int(np.count_nonzero(changed))
    return KnitoutProgram(
        "\n".join(lines) + "\n",
        crossings,
        sum(line.startswith("xfer") for line in courses) - crossings,
        len(plan.yarns),
    )


class _Body:
    """The passes of a program, with the bed of each loop."""

    def __init__(self, piece: Piece, plan: CarrierPlan) -> None:
        self._piece, self._plan = piece, plan
        self._spans = piece.shaped.spans
        self._back: dict[int, bool] = {}
        self._held: Counter[int] = Counter()

    def cast_on(self) -> Iterator[str]:
        """Tucks on every other needle and back on the rest, each on its first stitch's bed."""
        yield "; cast-on"
        for run, carrier in reversed(self._plan.rows[0].runs):
            yield f"inhook {carrier}"
            yield from self._there_and_back(range(run.start, run.stop), carrier, 0)
            yield f"releasehook {carrier}"

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
        leftwards = _leftwards(row)
        right_loss = range(below[1] - 1, here[1] - 1, -1)
        left_loss = range(below[0], here[0])
        right_gain, left_gain = range(below[1], here[1]), range(here[0], below[0])
        losses, gains = (right_loss, left_loss), (right_gain, left_gain)
        begin, end = (0, 1) if leftwards else (1, 0)
        inwards = -1 if leftwards else 1
        yield from self._lose(list(losses[end]), None, inwards=-inwards)
        for carrier in carriers.ended:
            yield f"outhook {carrier}"
        if gains[end]:
            strand = self._plan.waste
            yield f"inhook {strand}"
            yield from self._there_and_back(gains[end], strand, row)
            yield f"releasehook {strand}"
            yield f"outhook {strand}"
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
        strand = self._plan.waste if carrier is None and len(columns) > 1 else None
        for column in (*columns, columns[-1] + inwards):
            yield from self._to_bed(column, back=False)
        if strand is not None:
            yield f"inhook {strand}"
            yield f"knit - {_needle(False, columns[0])} {strand}"
            yield f"releasehook {strand}"
            carrier = strand
        sign = "-" if inwards < 0 else "+"
        for here, beside in pairwise((*columns, columns[-1] + inwards)):
            yield from _onto(here, beside)
            self._held[beside] += self._held.pop(here)
            del self._back[here]
            if beside != columns[-1] + inwards:
                self._held[beside] = 1
                yield f"knit {sign} {_needle(False, beside)} {carrier}"
        if strand is not None:
            yield f"outhook {strand}"

    def _gain(self, columns: range, carrier: int, row: int, waiting: set[int]) -> Iterator[str]:
        """Cast on with the yarn of the course, which then begins at the outer edge."""
        leftwards = _leftwards(row)
        if carrier in waiting:
            waiting.remove(carrier)
            yield f"inhook {carrier}"
            if leftwards:
                yield from self._there_and_back(columns, carrier, row)
            else:
                yield from self._zigzag(columns, carrier, leftwards=True)
            yield f"releasehook {carrier}"
        else:
            yield from self._zigzag(columns, carrier, leftwards=not leftwards)

    def _zigzag(self, columns: range, carrier: int, *, leftwards: bool) -> Iterator[str]:
        """One pass of tucks, from bed to bed so that each is a loop."""
        for column in sorted(columns, reverse=leftwards):
            self._back[column], self._held[column] = bool(column % 2), 1
            sign = "-" if leftwards else "+"
            yield f"tuck {sign} {_needle(self._back[column], column)} {carrier}"

    def _there_and_back(self, columns: range, carrier: int, row: int) -> Iterator[str]:
        """Tucks leftwards on every other needle, and rightwards on the rest."""
        beds = self._piece.chart.purl[row]
        last = columns.stop - 1
        for column in range(last, columns.start - 1, -2):
            yield f"tuck - {_needle(beds[column], column)} {carrier}"
        rest = sorted(range(last - 1, columns.start - 1, -2))
        for column in rest:
            yield f"tuck + {_needle(beds[column], column)} {carrier}"
        for column in columns:
            self._back[column], self._held[column] = bool(beds[column]), 1

    def _cross(self, row: int) -> Iterator[str]:
        """Loops that go to the back in one pass, and those that come to the front in another."""
        purl = self._piece.chart.purl[row]
        for back in (True, False):
            for column in range(*self._spans[row]):
                if purl[column] == back:
                    yield from self._to_bed(column, back=back)

    def _to_bed(self, column: int, *, back: bool) -> Iterator[str]:
        if self._back[column] != back:
            yield f"xfer {_needle(not back, column)} {_needle(back, column)}"
            self._back[column] = back

    def _course(self, row: int, carriers: CarrierRow, waiting: set[int]) -> Iterator[str]:
        beds, leftwards = self._piece.chart.purl[row], _leftwards(row)
        sign = "-" if leftwards else "+"
        order = carriers.runs[::-1] if leftwards else carriers.runs
        for place, (run, carrier) in enumerate(order):
            columns = range(run.start, run.stop)
            if carrier in waiting:
                yield f"inhook {carrier}"
                if not leftwards:  # the hook brings yarn in leftwards only
                    anchor = columns[1 : 2 * ANCHOR_TUCKS : 2] or columns
                    for column in reversed(anchor):
                        yield from self._tie(column, row, carrier, "-")
                    yield f"releasehook {carrier}"
            for column in reversed(columns) if leftwards else columns:
                self._held[column] = 1
                yield f"knit {sign} {_needle(beds[column], column)} {carrier}"
            if place + 1 < len(order):
                yield from self._tie(
                    columns[0] - 1 if leftwards else columns.stop, row, carrier, sign
                )
            if carrier in waiting and leftwards:
                yield f"releasehook {carrier}"

    def _tie(self, column: int, row: int, carrier: int, sign: str) -> Iterator[str]:
        """Tuck a yarn into a stitch of another, unless that needle is full."""
        if self._held[column] < MAX_LOOPS:
            self._held[column] += 1
            yield f"tuck {sign} {_needle(self._piece.chart.purl[row, column], column)} {carrier}"

    def waste(self) -> Iterator[str]:
        """Courses of another yarn on the same needles, after which all loops are dropped."""
        beds, columns = self._piece.chart.purl[-1], range(*self._spans[-1])
        strand = self._plan.waste
        for _, carrier in self._plan.rows[-1].runs:
            yield f"outhook {carrier}"
        yield "; waste yarn"
        yield f"inhook {strand}"
        for course in range(WASTE_COURSES):
            sign, order = ("+", columns) if course % 2 else ("-", columns[::-1])
            for column in order:
                yield f"knit {sign} {_needle(beds[column], column)} {strand}"
            if course == 1:
                yield f"releasehook {strand}"
        yield f"outhook {strand}"
        for column in columns:
            yield f"drop {_needle(beds[column], column)}"

    def bind_off(self) -> Iterator[str]:
        """A chain along the edge: each loop is put onto its neighbour and both are knitted."""
        yield "; bind-off"
        # The yarn is at the edge that the last course ran to; the chain starts there.
        rightwards = _leftwards(len(self._spans) - 1)
        sign, back = ("+", "-") if rightwards else ("-", "+")
        columns = range(*self._spans[-1])[:: 1 if rightwards else -1]
        runs = self._plan.rows[-1].runs
        (_, carrier), *others = runs if rightwards else runs[::-1]
        for _, other in others:
            yield f"outhook {other}"
        for column in columns:
            yield from self._to_bed(column, back=False)
        for here, beside in pairwise(columns):
            yield from _onto(here, beside)
            yield f"knit {sign} {_needle(False, beside)} {carrier}"
        last = columns[-1]
        if len(columns) > 1:
            for way in (back, sign) * (TAG_STITCHES // 2):
                yield f"knit {way} {_needle(False, last)} {carrier}"
        yield f"outhook {carrier}"
        yield f"drop {_needle(False, last)}"


def _leftwards(row: int) -> bool:
    return row % 2 == 0


def _onto(here: int, beside: int) -> Sequence[str]:
    """Move a loop of the front bed onto its neighbour there."""
    return (
        f"xfer {_needle(False, here)} {_needle(True, here)}",
        f"rack {beside - here}",
        f"xfer {_needle(True, here)} {_needle(False, beside)}",
        "rack 0",
    )


def _needle(back: bool | np.bool_, column: int) -> str:
    return f"{'b' if back else 'f'}{column + 1}"
