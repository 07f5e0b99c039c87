"""Knitout v2: the program that knits a chart flat on a V-bed machine.

A knit of the face is made on the front bed, a purl on the back bed. Before a course, the loops
whose next stitch is of the other kind are transferred straight across; no other transfer is made.
Needle 1 is the left edge of the face. Programs end in courses of waste yarn, which hold the last
course without a transfer, or in a chain bind-off.

Specification: https://textiles-lab.github.io/knitout/knitout.html
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from knitcore.chart import StitchChart
from knitcore.errors import InputError

MAXIMUM_NEEDLES = 540
"""Needles of one bed of a wide machine (Shima Seiki SWG091N2), and of the interpreter's."""
WASTE_COURSES = 6
TAG_STITCHES = 4
YARN_CARRIER, WASTE_CARRIER = 1, 2


class Finish(StrEnum):
    """How the last course is kept from ravelling."""

    WASTE = "waste"
    BIND_OFF = "bind-off"


@dataclass(frozen=True)
class KnitoutProgram:
    """A program and what a technician asks of it.

    Attributes
    ----------
    text : the program, one instruction a line.
    transfers : loops moved across the beds between the chart's courses.
    finishing_transfers : loops moved to bind off.
    """

    text: str
    transfers: int
    finishing_transfers: int


def knitout_program(
    chart: StitchChart, *, finish: Finish = Finish.WASTE, needles: int = MAXIMUM_NEEDLES
) -> KnitoutProgram:
    """The program of a chart; :func:`knitcore.formats.knitout_reader.verified` checks it.

    Raises
    ------
    InputError
        If the chart is wider than the machine.

    Examples
    --------
    >>> knitout_program(StitchChart.of_fabric("seed", rows=4, columns=6)).transfers
    18
    """
    if chart.columns > needles:
        raise InputError(
            "chart",
            f"{chart.columns} columns are wider than the machine's {needles} needles.",
            f"Knit at most {needles} columns: split the chart, or turn it so that rows are short.",
        )
    body = _Body(chart)
    lines = [
        ";!knitout-2",
        ";;Machine: SWG091N2",
        ";;Gauge: 15",
        ";;Position: Keep",
        f";;Carriers: {YARN_CARRIER} {WASTE_CARRIER}",
        *body.cast_on(),
        *body.courses(),
        *(body.waste() if finish is Finish.WASTE else body.bind_off()),
    ]
    crossings = int(np.count_nonzero(chart.purl[1:] ^ chart.purl[:-1]))
    finishing = sum(line.startswith("xfer") for line in lines) - crossings
    return KnitoutProgram("\n".join(lines) + "\n", crossings, finishing)


class _Body:
    """The passes of a program; it remembers only which way the carriage goes next."""

    def __init__(self, chart: StitchChart) -> None:
        self._chart = chart
        self._leftwards = True

    def cast_on(self) -> Iterator[str]:
        """Tucks on every other needle and back on the rest, each on its first stitch's bed."""
        beds = self._chart.purl[0]
        yield "; cast-on"
        yield f"inhook {YARN_CARRIER}"
        last = self._chart.columns - 1
        for remainder in (last % 2, (last + 1) % 2):
            yield from self._pass("tuck", beds, range(remainder, self._chart.columns, 2))

    def courses(self) -> Iterator[str]:
        """The chart, course by course."""
        purl = self._chart.purl
        every = range(self._chart.columns)
        for row, beds in enumerate(purl):
            yield f"; course {row + 1}"
            if row:
                for column in np.flatnonzero(beds ^ purl[row - 1]).tolist():
                    source, target = (
                        _needle(back, column) for back in (~beds[column], beds[column])
                    )
                    yield f"xfer {source} {target}"
            yield from self._pass("knit", beds, every)
            if row == 0:
                yield f"releasehook {YARN_CARRIER}"

    def waste(self) -> Iterator[str]:
        """Courses of another yarn on the same needles, then everything is let go."""
        beds, every = self._chart.purl[-1], range(self._chart.columns)
        yield f"outhook {YARN_CARRIER}"
        yield "; waste yarn"
        yield f"inhook {WASTE_CARRIER}"
        self._leftwards = True
        for course in range(WASTE_COURSES):
            yield from self._pass("knit", beds, every, carrier=WASTE_CARRIER)
            if course == 1:
                yield f"releasehook {WASTE_CARRIER}"
        yield f"outhook {WASTE_CARRIER}"
        for column in every:
            yield f"drop {_needle(beds[column], column)}"

    def bind_off(self) -> Iterator[str]:
        """A chain along the edge: each loop is put onto its neighbour and both are knitted."""
        beds = self._chart.purl[-1]
        yield "; bind-off"
        # The yarn is at the edge that the last course ran to; the chain starts there.
        leftwards, sign = self._leftwards, "-" if self._leftwards else "+"
        order = range(self._chart.columns)
        columns = list(reversed(order)) if leftwards else list(order)
        for column in np.flatnonzero(beds).tolist():
            yield f"xfer {_needle(True, column)} {_needle(False, column)}"
        for here, beside in pairwise(columns):
            yield f"xfer {_needle(False, here)} {_needle(True, here)}"
            yield f"rack {beside - here}"
            yield f"xfer {_needle(True, here)} {_needle(False, beside)}"
            yield "rack 0"
            yield f"knit {sign} {_needle(False, beside)} {YARN_CARRIER}"
        last = columns[-1]
        if len(columns) > 1:
            back = "+" if leftwards else "-"
            for way in (back, sign) * (TAG_STITCHES // 2):
                yield f"knit {way} {_needle(False, last)} {YARN_CARRIER}"
        yield f"outhook {YARN_CARRIER}"
        yield f"drop {_needle(False, last)}"

    def _pass(
        self, operation: str, beds: NDArray[np.bool_], columns: Iterable[int], carrier: int = 1
    ) -> Iterator[str]:
        """One course of the carriage over these columns; none if there are no columns."""
        ordered = sorted(columns, reverse=self._leftwards)
        sign = "-" if self._leftwards else "+"
        for column in ordered:
            yield f"{operation} {sign} {_needle(beds[column], column)} {carrier}"
        if ordered:
            self._leftwards = not self._leftwards


def _needle(back: bool | np.bool_, column: int) -> str:
    return f"{'b' if back else 'f'}{column + 1}"
