"""The gallery of the documentation site: ten designs with their pictures, numbers and files."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from knitcore import StitchChart, material, predict
from knitcore.base import showing
from knitcore.chart.fabric import Direction
from knitcore.chart.patterns import PATTERNS
from knitcore.formats.write.export import ExportKind, ExportOptions, export_chart
from knitcore.prediction.prediction import Prediction

SIDE = 24
STRESS_N_PER_MM = np.linspace(0.0, 0.2, 31)
KINDS = {
    ExportKind.DESIGN: "design",
    ExportKind.WRITTEN: "rows in words",
    ExportKind.KNITOUT: "knitout",
}
HEAD = """# Gallery

Ten designs, each of 24 × 24 stitches, with their mechanics and files to work with. The chart is on
the left; beside it is a rectangle as wide as its extensibility along the rows and as high as that
along the columns (the scale differs between designs); on the right are its stress–strain curves
with their 90 % intervals. The design opens in [the studio](studio.md); the knitout program has been
knitted on a virtual machine.
"""


@dataclass(frozen=True)
class Design:
    """A design of the gallery."""

    identifier: str
    name: str
    chart: StitchChart
    material: str
    note: str


def designs() -> Iterator[Design]:
    """The ten."""
    named = {pattern.identifier: pattern for pattern in PATTERNS}
    for identifier, yarn in (
        ("garter", "acrylic"),
        ("rib-2-2", "acrylic"),
        ("rib-3-1", "cotton"),
        ("welt-2-2", "acrylic"),
        ("basket", "acrylic"),
        ("moss", "cotton"),
        ("diamonds", "acrylic"),
    ):
        pattern = named[identifier]
        chart = pattern.chart.resized(SIDE, SIDE)
        yield Design(identifier, pattern.name, chart, yarn, pattern.note)
    row, column = np.indices((SIDE, SIDE))
    garter, rib = row % 2 == 1, column % 2 == 1
    yield Design(
        "two-textures",
        "Palm and cuff",
        StitchChart(np.where(column < SIDE // 2, garter, rib)),
        "acrylic",
        "Garter beside rib: the right half gives first when it is pulled along the rows.",
    )
    yield Design(
        "steps",
        "Steps",
        StitchChart((row // 2 + column) % 6 < 3),
        "cotton",
        "A 3×3 rib that moves over by one stitch every other row, which interrupts its folds.",
    )
    yield Design(
        "soft-lines",
        "Soft lines",
        StitchChart(rib & (row % 8 < 2)),
        "acrylic",
        "Two rows of rib in every eight of stockinette.",
    )


def picture(design: Design, answer: Prediction) -> str:
    """Chart, rectangle and curves beside each other, on paper of their own."""
    along = {d: answer.along(d) for d in Direction}
    drawn = [
        (d, a.strain(STRESS_N_PER_MM), STRESS_N_PER_MM, a.strain_interval(STRESS_N_PER_MM))
        for d, a in along.items()
    ]
    give = answer.extensibility_course_mm_per_n, answer.extensibility_wale_mm_per_n
    parts = [
        ("10 10) scale(.5", showing.stitches(design.chart.purl)),
        ("245 40", showing.rectangles([("", *give)], "mm/N")),
        ("390 25", showing.curves(drawn, "strain", "stress, N/mm")),
    ]
    paper = '<rect width="100%" height="100%" fill="#ffffff"/><g style="color:#2a2521" '
    placed = [f'<g transform="translate({place})">{part}</g>' for place, part in parts]
    return showing.svg(700, 245, design.name, [paper, 'font-family="sans-serif">', *placed, "</g>"])


def section(design: Design, answer: Prediction, files: dict[ExportKind, str]) -> str:
    """The part of the page about a design."""
    rows = []
    for d in Direction:
        along = answer.along(d)
        modulus, size = along.modulus_interval_n_per_mm, along.relaxed_interval_mm
        rows.append(
            f"| {'rows' if d is Direction.COURSE else 'columns'} "
            f"| {along.modulus_n_per_mm:.3f} ({modulus.low:.3f} to {modulus.high:.3f}) "
            f"| {float(along.strain([0.1])[0]):.0%} "
            f"| {along.relaxed_mm:.2f} ({size.low:.2f} to {size.high:.2f}) |"
        )
    links = ", ".join(f"[{KINDS[kind]}](gallery/{name})" for kind, name in files.items())
    return f"""\
## {design.name}

{design.note} In {design.material}; {answer.provenance}.

![{design.name}: chart, extensibility and curves](gallery/{design.identifier}.svg)

| along | Young's modulus, N/mm | stretch at 0.1 N/mm | stitch at rest, mm |
|---|---|---|---|
{chr(10).join(rows)}

Files: {links}.
"""


def gallery() -> dict[str, str | bytes]:
    """Make the page and the files beside it; the same every time.

    Returns
    -------
    Contents by path below docs/.
    """
    made: dict[str, str | bytes] = {}
    sections = [HEAD]
    for design in designs():
        yarn = material(design.material)
        answer = predict(design.chart, yarn)
        files = {}
        for kind in KINDS:
            file = export_chart(design.chart, kind, yarn, ExportOptions(name=design.name))
            files[kind] = f"{design.identifier}{file.suffix}"
            made[f"gallery/{files[kind]}"] = file.content
        made[f"gallery/{design.identifier}.svg"] = picture(design, answer)
        sections.append(section(design, answer, files))
    return made | {"gallery.md": "\n".join(sections)}
