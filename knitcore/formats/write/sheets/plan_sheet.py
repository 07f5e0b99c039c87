"""The plan for a home machine on paper, large enough to be read at the machine."""

from knitcore.formats.write.chart_drawing import A4_MM
from knitcore.formats.write.chart_key import GRID, INK, MARGIN_MM, SMALL_MM
from knitcore.formats.write.drawn_page import Label, Lines, Page, Rectangle
from knitcore.formats.write.sheets.flow import Flow, numbered
from knitcore.machine.home.plan_rows import Block, HandPlan

BODY_MM = 4.2
NEEDLE_MM, STRIP_MM = 4.0, 5.0
"""Greatest width of a needle in the picture of a row, and the height of that picture."""
TICK_NEEDLES = 10


def plan_pages(plan: HandPlan, title: str) -> tuple[Page, ...]:
    """The plan as A4 pages: a box to tick, the needles and the words of each group of rows.

    In the picture of the needles those are filled whose stitches are re-formed, or on the ribber.
    """
    flow = Flow(BODY_MM)
    flow.title(title or "Untitled")
    flow.text(f"For {plan.machine}.")
    for note in (*plan.notes, plan.time):
        flow.text(note, bullet=True)
    flow.heading("Begin")
    for line in plan.opening:
        flow.text(line)
    flow.heading("Rows")
    filled = "on the ribber" if plan.ribber else "to be latched up"
    if any(any(row.other) for row in plan.rows):
        flow.text(f"Filled needles have stitches {filled}. The left of the picture is your left.")
    for section in plan.sections:
        flow.subheading(section.heading, box=True)
        if isinstance(section, Block) and any(section.rows[-1].other):
            _strip(flow, plan, section)
        for line in section.lines:
            flow.text(line)
    flow.heading("End")
    for line in plan.closing:
        flow.text(line)
    return numbered(flow.pages(), title or "Untitled")


def _strip(flow: Flow, plan: HandPlan, block: Block) -> None:
    """Draw the needles of a block of rows as the knitter sees them."""
    row = block.rows[-1]
    cell = min(NEEDLE_MM, (A4_MM[0] - 2 * MARGIN_MM) / plan.width)
    top = flow.place(STRIP_MM + 2 * SMALL_MM) + 2.0
    high = STRIP_MM - 1.0
    for index, other in enumerate(row.other):
        left = MARGIN_MM + (row.first + index) * cell
        flow.draw(Rectangle(left, top, cell, high, INK if other else None, GRID, 0.15))
    middle = MARGIN_MM + (plan.width + 1) // 2 * cell
    flow.draw(Lines(((middle, top - 1.0, middle, top + high + 1.0),), INK, 0.5))
    names, ends = plan.needles, (row.first, row.first + len(row.other) - 1)
    room = max(1, round(3 * SMALL_MM / cell))
    tens = [
        place
        for place in range(ends[0] + room, ends[1] - room)
        if int(names[place][1:]) % TICK_NEEDLES == 0
    ]
    for place in (*dict.fromkeys(ends), *tens):
        centre = MARGIN_MM + (place + 0.5) * cell
        flow.draw(Label(centre, top + high + SMALL_MM + 0.5, names[place], SMALL_MM, "middle"))
