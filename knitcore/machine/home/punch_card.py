"""Punch cards of 24 stitches for Brother and Silver Reed machines of 4.5 mm.

A card repeats every 24 needles, twelve on each side of the middle, and its rows without end when it
is joined to a loop. A hole selects a needle: it knits the second yarn, or, with no button pressed,
shows a stitch that is re-formed by hand. Two full rows of holes at each end lie on each other where
the card is joined. The machine reads a row that is hidden below the one in sight.

Sources: brendabell/pcgenerator (distances and sizes of holes); alessandrina.com, "Brother KMs:
punchcards and their use" (places, least rows, row that is read, guide for work by hand);
vikkihaffenden.com, "Knitmaster" (Silver Reed: five rows below, no needles preselected).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Indices, Mask
from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.garment.piece import Piece
from knitcore.garment.shaped import largest_rectangle
from knitcore.machine.home.needle_places import facing, on_needles
from knitcore.machine.home.needle_selection import Selected, needle_selection
from knitcore.machine.profile import MachineProfile

STITCHES = 24
LEAST_ROWS = 36
"""Rows of the shortest card that rolls as a loop."""
JOIN_ROWS = 2
READS_BELOW = {"brother": 7, "silver-reed": 5}
"""Rows between the line in sight and the one that is read, by the beginning of a profile's name."""
FITTING = tuple(width for width in range(1, STITCHES + 1) if STITCHES % width == 0)


@dataclass(frozen=True, eq=False)
class PunchCard:
    """A card.

    Attributes
    ----------
    holes : bool (rows, 24), row 0 is row 1 of the knitting, the first column the leftmost needle.
    repeat_rows : rows after which the pattern begins again.
    reads_below : rows between the line in sight and the one that is read.
    notes : what to set, and what to do by hand.
    """

    holes: Mask
    repeat_rows: int
    reads_below: int
    notes: tuple[str, ...]

    @property
    def lines(self) -> tuple[str, ...]:
        """The card from its top, ``x`` for a hole, with the full rows where it is joined."""
        full = ("x" * STITCHES,) * JOIN_ROWS
        rows = ("".join("x" if hole else "-" for hole in row) for row in self.holes[::-1])
        return (*full, *rows, *full)

    @property
    def text(self) -> str:
        """The card as lines of x and -, with the row that each is."""
        count = len(self.holes)
        width = len(str(count))
        numbers = ["join", "join", *map(str, range(count, 0, -1)), "join", "join"]
        lines = zip(self.lines, numbers, strict=True)
        rows = [f"{line}  {number:>{width}}" for line, number in lines]
        return "\n".join([*rows, "", *self.notes, ""])


def punch_card(chart: StitchChart | Piece, profile: MachineProfile) -> PunchCard:
    """The card of a piece of at most 24 stitches, or of one that repeats every 24.

    Raises
    ------
    InputError
        If the machine has no cards, the repeat does not divide 24 (the nearest that do are named),
        or selecting needles cannot knit it.
    """
    piece = Piece.of(chart).cropped()
    brand = next((name for name in READS_BELOW if profile.identifier.startswith(name)), None)
    if brand is None:
        remedy = "Choose Brother or Silver Reed; for AYAB export its picture."
        raise InputError("machine", f"{profile.name} reads no punch cards.", remedy)
    selection = needle_selection(piece, profile)
    if selection.selected is Selected.HAND and brand == "silver-reed":
        problem = "a Silver Reed selects needles inside its carriage, where no hand can follow."
        raise InputError("machine", problem, "Export the hand plan, or use a Brother machine.")
    if len(selection.yarns) > 2:
        problem = f"a hole selects one of two yarns, the design has {len(selection.yarns)}."
        raise InputError("yarns", problem, "Use two yarns.")
    selected, width = selection.levels > 0, selection.levels.shape[1]
    stitch = on_needles(piece.shaped.stitch, facing(piece))
    first = STITCHES // 2 - (width + 1) // 2
    on_card = (np.arange(width) + first) % STITCHES
    known, holes = (_folded(cells, on_card) for cells in (stitch, selected & stitch))
    if (holes & _folded(stitch & ~selected, on_card)).any():
        _refuse_width(selected[largest_rectangle(stitch)])
    repeat = _period(holes, known)
    rows = repeat * -(-LEAST_ROWS // repeat)
    pattern = np.array([holes[row::repeat].any(axis=0) for row in range(repeat)])
    return PunchCard(
        np.resize(pattern, (rows, STITCHES)),
        repeat,
        READS_BELOW[brand],
        (*_notes(repeat, rows, READS_BELOW[brand], width), *selection.notes),
    )


def _folded(cells: Mask, on_card: Indices) -> Mask:
    """Columns of the card in which a row has such a cell."""
    card = np.zeros((len(cells), STITCHES), dtype=bool)
    for column in range(STITCHES):
        card[:, column] = cells[:, on_card == column].any(axis=1)
    return card


def _period(holes: Mask, known: Mask) -> int:
    """Rows after which the pattern begins again, wherever the piece has stitches."""
    count = len(holes)
    blank = known & ~holes
    for period in range(1, count // 2 + 1):
        if not any(
            (holes[row::period].any(axis=0) & blank[row::period].any(axis=0)).any()
            for row in range(period)
        ):
            return period
    return count


def _refuse_width(selected: Mask) -> None:
    width = StitchChart(selected).repeat_cut().columns
    narrower = max(fit for fit in FITTING if fit < width)
    wider = min((fit for fit in FITTING if fit > width), default=None)
    nearest = f"{narrower} or {wider}" if wider else f"{narrower}"
    problem = f"it repeats every {width} stitches, and a card every {STITCHES}."
    if width > STITCHES:
        problem = f"it does not repeat within the {STITCHES} stitches of a card."
    raise InputError(
        "chart",
        problem,
        f"The nearest repeats that fit are of {nearest} stitches; pieces of up to {STITCHES} "
        "stitches need none. AYAB has no such limit.",
    )


def _notes(repeat: int, rows: int, below: int, width: int) -> tuple[str, ...]:
    times = rows // repeat
    rows_in_words = "row" if repeat == 1 else f"{repeat} rows"
    often = "" if times == 1 else f" {times} times, so that the card is long enough"
    edge = (width + 1) // 2
    return (
        f"The card has the pattern's {rows_in_words}{often}; join it to a loop.",
        f"Its middle is the middle of the bed; the piece is on L{edge} to R{width - edge}.",
        f"The machine reads {below} rows below the row in sight: the numbers beside the card allow "
        "for it.",
        "Knit the first rows and compare: if the picture is mirrored, turn the card over.",
    )
