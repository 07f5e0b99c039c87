"""Punch cards on paper at true size, to be punched through or cut by a plotter."""

from collections.abc import Iterator

import numpy as np

from knitcore.base.arrays import Mask
from knitcore.formats.write.chart_drawing import A4_MM
from knitcore.formats.write.chart_key import GRID, INK, SMALL_MM
from knitcore.formats.write.drawn_page import Dots, Label, Lines, Page, Rectangle, Shape
from knitcore.formats.write.sheets.flow import Flow, numbered
from knitcore.machine.home.punch_card import JOIN_ROWS, STITCHES, PunchCard

STITCH_MM, ROW_MM, SIDE_MM = 4.5, 5.0, 17.0
"""Distances of holes across and up, and the blank side of the card (brendabell/pcgenerator)."""
HOLE_MM, CLIP_MM, SPROCKET_MM = 3.5, 3.0, 3.5
CLIP_FROM_HOLE_MM, SPROCKET_FROM_EDGE_MM = 6.0, 6.5
WIDTH_MM = 2 * SIDE_MM + STITCHES * STITCH_MM
PAGE_ROWS = 48
"""Rows of card on a page."""
TOP_MM, SCALE_MM = 24.0, 100.0


def card_pages(card: PunchCard, title: str) -> tuple[Page, ...]:
    """The card as A4 pages at true size from its lower end up, and a page of words before it."""
    flow = Flow()
    flow.title(title or "Untitled")
    flow.text("Punch card of 24 stitches at true size. Print at 100 %, not fitted to the page.")
    for note in card.notes:
        flow.text(note, bullet=True)
    flow.text(
        "Glue the pages together along the frame, put them on a blank card and punch every black "
        "dot. The number beside a line is in sight at the reader when that row is knitted."
    )
    full = np.ones((JOIN_ROWS, STITCHES), dtype=bool)
    rows = np.concatenate([full, card.holes, full])
    parts = [
        Page(*A4_MM, tuple(_part(card, rows[start : start + PAGE_ROWS], start)))
        for start in range(0, len(rows), PAGE_ROWS)
    ]
    return numbered([*flow.pages(), *parts], title or "Untitled")


def _part(card: PunchCard, rows: Mask, start: int) -> Iterator[Shape]:
    """A stretch of the card; ``start`` is the number of its lowest row from the card's end."""
    left, height = (A4_MM[0] - WIDTH_MM) / 2, len(rows) * ROW_MM
    right, first = left + WIDTH_MM, left + SIDE_MM + STITCH_MM / 2
    yield Label(left, TOP_MM - 12.0, f"This line is {SCALE_MM:g} mm long:", SMALL_MM)
    yield Lines(((left, TOP_MM - 9.0, left + SCALE_MM, TOP_MM - 9.0),), INK, 0.3)
    yield Rectangle(left, TOP_MM, WIDTH_MM, height, stroke=INK, line_width=0.2)
    lines = [TOP_MM + height - (index + 0.5) * ROW_MM for index in range(len(rows))]
    for holes, radius, colour in ((rows, HOLE_MM / 2, INK), (~rows, 0.3, GRID)):
        places = np.argwhere(holes).tolist()
        centres = tuple((first + stitch * STITCH_MM, lines[index]) for index, stitch in places)
        yield Dots(centres, radius, colour)
    clips = (first - CLIP_FROM_HOLE_MM, left + right - first + CLIP_FROM_HOLE_MM)
    yield Dots(tuple((x, y) for y in lines for x in clips), CLIP_MM / 2, GRID)
    edges = (left + SPROCKET_FROM_EDGE_MM, right - SPROCKET_FROM_EDGE_MM)
    between = [y - ROW_MM / 2 for y in lines[start % 2 :: 2]]
    yield Dots(tuple((x, y) for y in between for x in edges), SPROCKET_MM / 2, GRID)
    for index, y in enumerate(lines):
        row = start + index - JOIN_ROWS
        if 0 <= row < len(card.holes):  # the ends of a joined card follow each other
            number = (row - card.reads_below) % len(card.holes) + 1
            yield Label(right + 2.0, y + SMALL_MM / 3, str(number), SMALL_MM)
