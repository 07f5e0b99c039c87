"""Row-by-row plans for home machines: one bed with a latch tool, or a bed with a ribber.

On one bed every stitch is made alike, and the purl side of the fabric looks at the knitter. The
stitches of the other kind are re-formed by hand: the latch tool goes into the stitch below, the
stitch is dropped down to it and latched up from the side that looks at the knitter. Stitches of one
needle above each other are dropped together, after the last of them. A garter bar turns the whole
work instead, where that is quicker. With a ribber these stitches lie on its needles, and loops are
transferred before the row in which they change the bed.

Sources: S. Guagliumi, "Latching up stitches" (susanguagliumi.com); R. Knutson, "Garter bar, hints
and tips" (lacecarriage.com). The seconds of each act are stated guesses for a practised knitter.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from knitcore.base.arrays import Mask, runs
from knitcore.chart.stitch_chart import StitchChart
from knitcore.garment.piece import Piece, yarn_name
from knitcore.machine.home.needle_places import (
    check_home,
    facing,
    needle_name,
    needle_words,
    on_needles,
    other_stitches,
    side_words,
)
from knitcore.machine.home.plan_rows import Act, HandPlan, HandRow, Task, minutes_in_words
from knitcore.machine.profile import MachineProfile

LADDER_S, RUNG_S = 12.0, 3.0
"""Seconds to drop a stitch and hang it back, and to latch up each of its rows."""
TURN_S, TURN_STITCH_S = 120.0, 1.0
"""Seconds to turn the work with a garter bar, and for each of its stitches."""
EDGE_S = 8.0
"""Seconds to shape a stitch of an edge, or to lay a yarn."""
MAX_LADDER = 30
"""Most rows that are dropped at once: longer ladders draw in (a stated guess)."""

INTARSIA = (
    "Intarsia rows: use the intarsia carriage, or lay each yarn over its needles by hand. Each "
    "block has a ball of its own; cross the yarns where blocks meet."
)


def hand_plan(chart: StitchChart | Piece, profile: MachineProfile) -> HandPlan:
    """Plan a piece for a home machine, flat.

    Raises
    ------
    InputError
        If the machine is no home machine, or the piece is wider than its bed.

    Examples
    --------
    >>> from knitcore.machine.profile import profile
    >>> rib = StitchChart.of_fabric("rib", rows=10, columns=4)
    >>> print("\\n".join(hand_plan(rib, profile("brother")).blocks[0].lines))
    Knit 10 rows.
    Drop the stitches of L2 and R1 down 10 rows and latch up as knits.
    """
    piece = Piece.of(chart).cropped()
    check_home(piece, profile)
    ribber = profile.beds > 1
    toward = facing(piece) if ribber else _sides(piece)
    return _Planner(piece, profile, toward, ribber=ribber).plan()


def _sides(piece: Piece) -> Mask:
    """For each row, the side that looks at the knitter, so that the work by hand is shortest.

    The choice is made from row to row (dynamic programming): to re-form the other stitches costs
    time by the ladder and by the rung, to turn the work costs time by the stitch.
    """
    purl, stitch = piece.chart.purl, piece.shaped.stitch
    spent = np.zeros((piece.chart.rows, 2))
    before = np.zeros((piece.chart.rows, 2), dtype=int)
    others = [(purl != bool(side)) & stitch for side in (0, 1)]
    turns = TURN_S + TURN_STITCH_S * stitch.sum(axis=1)
    for row in range(piece.chart.rows):
        for side, other in enumerate(others):
            rungs = RUNG_S * other[row].sum() + LADDER_S * other[row].sum()
            if not row:
                spent[row, side] = rungs
                continue
            longer = LADDER_S * np.count_nonzero(other[row] & other[row - 1])
            ways = [
                spent[row - 1, side] + rungs - longer,
                spent[row - 1, 1 - side] + rungs + turns[row - 1],
            ]
            before[row, side] = side if ways[0] <= ways[1] else 1 - side
            spent[row, side] = min(ways)
    toward = np.zeros(piece.chart.rows, dtype=bool)
    side = int(np.argmin(spent[-1]))
    for row in reversed(range(piece.chart.rows)):
        toward[row] = bool(side)
        side = int(before[row, side])
    return toward


class _Planner:
    """The acts of a plan, worked out for one way of laying the piece on the needles."""

    def __init__(
        self, piece: Piece, profile: MachineProfile, toward: Mask, *, ribber: bool
    ) -> None:
        self._piece, self._profile, self._toward, self._ribber = piece, profile, toward, ribber
        self._spans = piece.shaped.spans
        self._width = piece.chart.columns
        self._other = other_stitches(piece, toward)
        self._stitch = on_needles(piece.shaped.stitch, toward)
        self._starts_left = self._best_start()

    def plan(self) -> HandPlan:
        reforms = {} if self._ribber else self._reforms()
        yarns = on_needles(self._piece.yarn_of, self._toward)
        rows = []
        for row in range(len(self._spans)):
            places = np.flatnonzero(self._stitch[row])
            rows.append(
                HandRow(
                    row + 1,
                    self._leftwards(row),
                    int(places[0]),
                    tuple(self._other[row, places].tolist()),
                    tuple((stop - start, yarn) for start, stop, yarn in runs(yarns[row, places])),
                    tuple(self._before(row)),
                    tuple(reforms.get(row, ())),
                )
            )
        times = self._profile.times
        bed_m = self._width * self._profile.pitch_mm / 1000
        plan = HandPlan(
            self._profile.name,
            self._ribber,
            self._width,
            self._opening(rows[0]),
            tuple(rows),
            self._closing(),
            bed_m / times.carriage_speed_m_per_s + times.turn_s,
        )
        return replace(plan, notes=self._notes(plan))

    def _best_start(self) -> bool:
        """Choose whether row 1 begins at the left edge, so that few edges need a separate strand.

        Where both are as good, the carriage starts at the knitter's right.
        """
        strands = [0, 0]
        for row, (below, here) in enumerate(pairwise(self._spans), start=1):
            for edge in (0, 1):
                if abs(here[edge] - below[edge]) > 1:
                    strands[(row + edge) % 2] += 1  # such a start ends this row there
        right = int(not self._toward[0])
        return bool(right) if strands[0] == strands[1] else strands[1] < strands[0]

    def _from_left(self, row: int) -> bool:
        """Return whether a row begins at the chart's left edge."""
        return self._starts_left == (row % 2 == 0)

    def _leftwards(self, row: int) -> bool:
        return self._from_left(row) != bool(self._toward[row])

    def _names(self, places: Iterable[int]) -> tuple[str, ...]:
        return tuple(needle_name(place, self._width) for place in sorted(places))

    def _words(self, places: Iterable[int]) -> str:
        return needle_words(places, self._width)

    def _places(self, row: int, columns: Iterable[int]) -> list[int]:
        return [c if self._toward[row] else self._width - 1 - c for c in columns]

    def _before(self, row: int) -> Iterator[Task]:
        if row:
            if self._toward[row] != self._toward[row - 1]:
                yield self._turn(row)
            for edge in (0, 1):
                yield from self._shape(row, edge)
            if self._ribber:
                yield from self._transfers(row)
        yield from self._yarns(row)

    def _turn(self, row: int) -> Task:
        stitches = self._spans[row - 1][1] - self._spans[row - 1][0]
        side = "right" if self._leftwards(row) else "left"
        words = (
            "Turn the work with the garter bar. "
            f"Take the carriage to the {side} without knitting: the yarn is there now."
        )
        return Task(Act.TURN, (), words, TURN_S + TURN_STITCH_S * stitches)

    def _shape(self, row: int, edge: int) -> Iterator[Task]:
        below, here = self._spans[row - 1][edge], self._spans[row][edge]
        gain = below - here if edge == 0 else here - below
        if not gain:
            return
        side = "left" if (edge == 0) == bool(self._toward[row]) else "right"
        places = self._places(row, range(min(below, here), max(below, here)))
        inner = max(below, here) if edge == 0 else min(below, here) - 1
        (beside,) = self._names(self._places(row, [inner]))
        strand = "" if self._from_left(row) == (edge == 0) else " with a separate strand"
        names, words = self._names(places), self._words(places)
        if gain == -1:
            text = f"Decrease at the {side}: put the stitch of {words} onto {beside}."
        elif gain < 0:
            text = f"Bind off {-gain} stitches at the {side}{strand}, from the edge: {words}. "
            text += f"The last goes onto {beside}."
        elif gain == 1:
            text = f"Increase at the {side}: hang the loop below {beside} onto {words}."
        else:
            text = f"Cast on {gain} stitches at the {side}{strand}: {words}."
        yield Task(Act.SHAPE, names, text, EDGE_S * abs(gain))

    def _transfers(self, row: int) -> Iterator[Task]:
        kept = self._stitch[row] & self._stitch[row - 1]
        for to_ribber, bed in ((False, "the main bed"), (True, "the ribber")):
            here, below = self._other[row] == to_ribber, self._other[row - 1] == to_ribber
            places = np.flatnonzero(kept & here & ~below).tolist()
            if places:
                words = f"Transfer to {bed}: {self._words(places)}."
                seconds = self._profile.times.hand_transfer_s * len(places)
                yield Task(Act.TRANSFER, self._names(places), words, seconds)

    def _yarns(self, row: int) -> Iterator[Task]:
        """The yarns of a row by their needles, where they are others than in the row below."""
        if len(self._piece.yarns) == 1:
            return
        here = self._yarn_places(row)
        if row and here == self._yarn_places(row - 1):
            return
        names = [
            f"{yarn_name(yarn)} ({self._piece.yarns[yarn].name}) on {self._words(places)}"
            for yarn, places in here
        ]
        head = "Yarn " if len(names) == 1 else "Intarsia, from the left: "
        yield Task(Act.YARNS, (), head + "; ".join(names) + ".", EDGE_S * len(names))

    def _yarn_places(self, row: int) -> list[tuple[int, list[int]]]:
        places = [
            (run.yarn, sorted(self._places(row, range(run.start, run.stop))))
            for run in self._piece.runs(row)
        ]
        return sorted(places, key=lambda item: item[1])

    def _reforms(self) -> dict[int, list[Task]]:
        """The ladders that are dropped and latched up after each row."""
        ladders: dict[tuple[int, int], list[int]] = defaultdict(list)
        for place in range(self._width):
            start = None
            for row in range(len(self._spans)):
                if start is not None and self._is_cut(row, place, start):
                    ladders[row - 1, start].append(place)
                    start = None
                if start is None and self._other[row, place]:
                    start = row
            if start is not None:
                ladders[len(self._spans) - 1, start].append(place)
        tasks: dict[int, list[Task]] = defaultdict(list)
        for (last, first), places in sorted(ladders.items()):
            rows = last - first + 1
            depth = "1 row" if rows == 1 else f"{rows} rows"
            what = "the stitch" if len(places) == 1 else "the stitches"
            words = f"Drop {what} of {self._words(places)} down {depth} and latch up as knits."
            seconds = (LADDER_S + RUNG_S * rows) * len(places)
            task = Task(Act.REFORM, self._names(places), words, seconds, (first + 1, last + 1))
            tasks[last].append(task)
        return tasks

    def _is_cut(self, row: int, place: int, start: int) -> bool:
        """Say whether a ladder from ``start`` must be latched up before a row."""
        if not self._other[row, place] or row - start >= MAX_LADDER:
            return True
        if self._toward[row] != self._toward[row - 1]:
            return True
        below, here = self._spans[row - 1], self._spans[row]
        lost = [here[0]] * (here[0] > below[0]) + [here[1] - 1] * (here[1] < below[1])
        return place in self._places(row, lost)  # a loop is put onto its needle

    def _opening(self, row: HandRow) -> tuple[str, ...]:
        rows = range(len(self._spans))
        has_intarsia = any(len(self._yarn_places(number)) > 1 for number in rows)
        return (*self._cast_on(row), *([INTARSIA] if has_intarsia else []))

    def _cast_on(self, row: HandRow) -> tuple[str, ...]:
        last = row.first + len(row.other)
        places = range(row.first, last)
        start = "right" if row.leftwards else "left"
        count = f"{len(places)} stitches" if len(places) > 1 else "1 stitch"
        if not self._ribber:
            return (
                f"Cast on {count}, {self._words(places)}. The carriage ends at the {start}.",
                "Knit plain: no tuck, slip or pattern buttons.",
            )
        ribbed = [place for place, other in zip(places, row.other, strict=True) if other]
        main = [place for place in places if place not in set(ribbed)]
        beds = [
            f"{bed}: {self._words(some)}"
            for bed, some in (("main bed", main), ("ribber", ribbed))
            if some
        ]
        return (
            "Set the beds needle to needle (pitch lever at P) and the racking to its middle.",
            f"Cast on {count}, {'; '.join(beds)}. The carriages end at the {start}.",
            "Knit plain on both beds: no tuck, slip or pattern buttons. Nothing is racked.",
        )

    def _closing(self) -> tuple[str, ...]:
        ribbed = np.flatnonzero(self._other[-1]).tolist() if self._ribber else []
        move = [f"Transfer to the main bed: {self._words(ribbed)}."] if ribbed else []
        return (*move, "Bind off with the latch tool, loosely.")

    def _notes(self, plan: HandPlan) -> tuple[str, ...]:
        notes = [side_words(self._toward)]
        if self._ribber:
            alone = _Planner(self._piece, self._profile, _sides(self._piece), ribber=False).plan()
            if alone.minutes < plan.minutes:
                notes.append(
                    f"Without the ribber it takes about {minutes_in_words(alone.minutes)}."
                )
        return tuple(notes)
