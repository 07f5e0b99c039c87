"""A design on paper: its numbers with intervals, maps, curves, assumptions, and the chart."""

import textwrap
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise

import numpy as np

from knitcore.base.arrays import runs
from knitcore.chart.fabric import Direction
from knitcore.chart.segments import segment_map
from knitcore.chart.stitch_chart import StitchChart
from knitcore.draw.laid_out import SizeAtRest, size_at_rest
from knitcore.formats.designs.layout import DesignRegion
from knitcore.formats.write.chart_drawing import A4_MM, chart_pages
from knitcore.formats.write.chart_key import MARGIN_MM, ChartStyle, shortened, tinted
from knitcore.formats.write.drawn_page import Label, Lines, Page, Rectangle, Shape, to_pdf
from knitcore.formats.write.extensibility_drawing import field_shapes, region_fields
from knitcore.garment.piece import Piece
from knitcore.materials import Interval, Material
from knitcore.mechanics.local_moduli import local_moduli
from knitcore.prediction.curve import DEFAULT_STRESS_N_PER_MM
from knitcore.prediction.hand import PULLS_N_PER_MM
from knitcore.prediction.predict import predict
from knitcore.prediction.prediction import Along, Prediction, Source

# Cividis at five points: perceptually uniform, and the same for colour-blind readers.
_CIVIDIS = np.array([[0, 32, 76], [65, 77, 107], [124, 123, 120], [187, 173, 108], [255, 234, 70]])
LINES = {Direction.COURSE: "rows", Direction.WALE: "columns"}
SOURCES = {
    Source.MEASURED: "measured",
    Source.ESTIMATED: "estimated from tests of the yarn and of others",
    Source.SWEPT: "simulated",
    Source.LEARNED: "estimated from simulations",
    Source.LEARNED_OF_SIZE: "estimated from simulations and a known size",
    Source.OTHER_STITCHES: "estimated from its knits and purls, and from swatches of others",
}
"""Bases of predictions in words, as on the page."""
_DIRECTION_INK = {Direction.COURSE: "#3b6fb6", Direction.WALE: "#b3322b"}
_LEVELS, _NO_STITCH = 32, -1
MAX_REGIONS = 12
"""Most lines in the table of regions, as fit a page."""
LOCAL_ASSUMPTIONS = (
    "A region has the moduli of the repeat that fills it, or of the largest rectangle inside it; "
    "intervals cover 90 %.",
    "Maps and small rectangles show single stitches of flat cloth, without the folds of ribs and "
    "welts, by the quarter-cell composite.",
    "An elastic model: no recovery, growth or hysteresis. Moduli are force per width.",
)
"""Assumptions behind the numbers of a piece with an outline."""
OF_KNITS_AND_PURLS = "Segments, maps and yarn are those of the chart's knits and purls."
ASSUMPTIONS = "Method and assumptions"
_LINE_CHARACTERS = 112
HAND_N_PER_MM = PULLS_N_PER_MM["hand"]
_MAP_MM = (84.0, 62.0)


def design_report(
    chart: StitchChart | Piece,
    material: Material,
    name: str,
    style: ChartStyle,
    regions: Sequence[DesignRegion] = (),
    notes: Sequence[str] = (),
    prediction: Prediction | None = None,
) -> bytes:
    """A PDF: mechanics, then the extensibility field if there are regions, then the chart.

    ``notes`` are added to the assumptions of the first page. A piece that is not a rectangle has no
    modulus of its own; those of its regions are given. A chart of other stitches is given as the
    piece of its purl map, with all of them in the style, and its ``prediction``.

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.
    """
    piece = Piece.of(chart)
    pages = []
    if prediction is None:
        prediction = predict(piece.shaped.rectangle_inside(), material, piece.gauge)
    else:
        notes = *notes, OF_KNITS_AND_PURLS
    size = size_at_rest(piece.shaped, material, prediction)
    if piece.is_rectangle:
        shapes = [
            *_numbers(piece.chart, material, name, prediction, size),
            *_maps(piece, material, style.aspect, 73.0),
        ]
        shapes += _plot(prediction)
        pages += _with_assumptions(shapes, [*notes, *assumptions(prediction)], 228.0)
    if regions or not piece.is_rectangle:
        shapes = [*_regions(piece, material, name, style.aspect, regions, size)]
        said = LOCAL_ASSUMPTIONS if pages else (*notes, *LOCAL_ASSUMPTIONS)
        pages += _with_assumptions(shapes, said, A4_MM[1] - 30.0)
    return to_pdf([*pages, *chart_pages(piece, style, first=len(pages) + 1)], name)


def assumptions(prediction: Prediction) -> list[str]:
    """Say how a prediction was made and what it assumes, in sentences."""
    return [
        f"Law: {prediction.method}.",
        f"Shear modulus {prediction.shear_modulus_n_per_mm:.2g} N/mm: an assumption unless "
        "calibrated.",
        "An elastic model: no recovery, growth or hysteresis. Moduli are force per width.",
        *prediction.notes,
    ]


def _regions(
    piece: Piece,
    material: Material,
    name: str,
    aspect: float,
    regions: Sequence[DesignRegion],
    at_rest: SizeAtRest,
) -> Iterator[Shape]:
    """Regions with their moduli, the maps of all stitches, and the extensibility field."""
    yield Label(MARGIN_MM, 16.0, f"{name}: regions", 6.0)
    shaped = piece.shaped
    size = f"{piece.chart.columns} stitches × {piece.chart.rows} rows, {shaped.stitches} stitches"
    yield Label(MARGIN_MM, 22.0, f"{size}, {_in_cm(at_rest)}", 3.4)
    yield Label(MARGIN_MM, 26.0, f"{material.name} ({material.identifier})", 3.0)
    places = (MARGIN_MM, 62.0, 84.0, 124.0, 164.0)
    head = (
        "region",
        "stitches",
        "stiffness, rows, N/mm",
        "columns, N/mm",
        "hand's pull, rows × columns",
    )
    yield from _row(places, head, 30.0)
    yield Lines(((MARGIN_MM, 32.0, A4_MM[0] - MARGIN_MM, 32.0),), "#b5b0a8", 0.2)
    y = 37.0
    fields = region_fields(piece, regions, material)
    for part in fields[:MAX_REGIONS]:
        yield Rectangle(MARGIN_MM, y - 2.6, 3.0, 3.0, fill=tinted(part.colour))
        both = [part.prediction.along(direction) for direction in Direction]
        cells = (
            f"    {shortened(part.name)}",
            str(part.stitches),
            *(_value(along.modulus_n_per_mm, along.modulus_interval_n_per_mm) for along in both),
            " × ".join(f"{along.strain(HAND_N_PER_MM):.0%}" for along in both),
        )
        yield from _row(places, cells, y)
        y += 5.0
    if (left_out := len(fields) - MAX_REGIONS) > 0:
        yield Label(MARGIN_MM, y, f"… and {left_out} more, in the maps only.", 3.0)
    yield from _maps(piece, material, aspect, y + 5.0)
    top = y + 86.0
    yield Label(
        MARGIN_MM,
        top - 2.0,
        "extensibility: as wide as it gives along rows, as high as along columns",
        3.0,
    )
    yield from field_shapes(
        piece,
        regions,
        fields,
        material,
        aspect=aspect,
        left=MARGIN_MM,
        top=top,
        width=A4_MM[0] - 2 * MARGIN_MM,
        height=A4_MM[1] - top - 44.0,
    )


def _row(
    places: Sequence[float], cells: Sequence[str], y: float, size: float = 3.0
) -> Iterator[Label]:
    """A line of a table."""
    for x, text in zip(places, cells, strict=True):
        yield Label(x, y, text, size)


def _in_cm(size: SizeAtRest) -> str:
    return f"{size.width_mm / 10:.1f} × {size.height_mm / 10:.1f} cm at rest"


def _numbers(
    chart: StitchChart, material: Material, name: str, prediction: Prediction, at_rest: SizeAtRest
) -> Iterator[Shape]:
    yield Label(MARGIN_MM, 16.0, name, 6.0)
    size = f"{chart.columns} stitches × {chart.rows} rows, {_in_cm(at_rest)}"
    yield Label(MARGIN_MM, 22.0, f"{size}, in {material.name} ({material.identifier})", 3.4)
    segments = segment_map(chart)
    course, wale = (segments.counts(d) for d in Direction)
    yield Label(
        MARGIN_MM,
        27.0,
        f"segments along rows: {course.even} even, {course.odd} odd; "
        f"along columns: {wale.even} even, {wale.odd} odd",
    )
    rows = [("", "along the rows", "along the columns")]
    for label, value in _NUMBERS:
        along_rows, along_columns = (_value(*value(prediction.along(d))) for d in Direction)
        rows.append((label, along_rows, along_columns))
    for index, cells in enumerate(rows):
        yield from _row((MARGIN_MM, 70.0, 132.0), cells, 36.0 + 5.2 * index, 3.2)
    yield Lines(((MARGIN_MM, 38.0, A4_MM[0] - MARGIN_MM, 38.0),), "#b5b0a8", 0.2)
    source = f"Intervals cover 90 %. Source: {SOURCES[prediction.provenance]}."
    pull = f"A hand's pull is {HAND_N_PER_MM:g} N/mm, 10 N on 10 cm of cloth."
    yield Label(MARGIN_MM, 64.0, f"{source} {pull}", 3.0)


def _stretch_by_hand(along: Along) -> tuple[float, Interval]:
    """Stretch at a hand's pull in per cent, with its interval."""
    low, high = (100 * float(end) for end in along.strain_interval(HAND_N_PER_MM))
    return 100 * float(along.strain(HAND_N_PER_MM)), Interval(low, high)


_NUMBERS: tuple[tuple[str, Callable[[Along], tuple[float, Interval]]], ...] = (
    ("stretch at a hand's pull, %", _stretch_by_hand),
    (
        "stiffness (Young's modulus), N/mm",
        lambda a: (a.modulus_n_per_mm, a.modulus_interval_n_per_mm),
    ),
    ("narrowing when pulled", lambda a: (a.poisson, a.poisson_interval)),
    ("stitch at rest, mm", lambda a: (a.relaxed_mm, a.relaxed_interval_mm)),
)


def _value(value: float, interval: Interval) -> str:
    return f"{value:.3g}  ({interval.low:.3g} to {interval.high:.3g})"


def _maps(piece: Piece, material: Material, aspect: float, top: float) -> Iterator[Shape]:
    """Local moduli as two maps with one logarithmic scale."""
    chart, stitch = piece.chart, piece.shaped.stitch
    local = local_moduli(piece.shaped.continued(), material)
    logs = {d: np.log(local.table.modulus_n_per_mm(d)[local.codes]) for d in Direction}
    low = float(min(m[stitch].min() for m in logs.values()))
    high = max(float(max(m[stitch].max() for m in logs.values())), low + 1e-9)
    cell = min(_MAP_MM[0] / chart.columns, _MAP_MM[1] / (chart.rows * aspect))
    high_mm = cell * aspect
    for direction, left in zip(Direction, (MARGIN_MM, 108.0), strict=True):
        yield Label(left, top, f"stiffness of each stitch along the {LINES[direction]}, N/mm", 3.0)
        level = ((logs[direction] - low) / (high - low) * (_LEVELS - 1)).round().astype(int)
        level[~stitch] = _NO_STITCH
        for row in range(chart.rows):
            y = top + 2.5 + high_mm * (chart.rows - 1 - row)
            for start, stop, value in runs(level[row]):
                if value != _NO_STITCH:
                    width = cell * (stop - start)
                    yield Rectangle(left + cell * start, y, width, high_mm, fill=_colour(value))
    for step in range(_LEVELS):
        yield Rectangle(MARGIN_MM + 2.0 * step, top + 68.0, 2.0, 3.0, fill=_colour(step))
    yield Label(MARGIN_MM, top + 75.0, f"{np.exp(low):.3g}", 2.8)
    end = MARGIN_MM + 2.0 * _LEVELS
    yield Label(end, top + 75.0, f"{np.exp(high):.3g} N/mm (logarithmic)", 2.8, "end")


def _colour(level: int) -> str:
    place = np.linspace(0, _LEVELS - 1, len(_CIVIDIS))
    rgb = [round(float(np.interp(level, place, channel))) for channel in _CIVIDIS.T]
    return "#{:02x}{:02x}{:02x}".format(*rgb)


def _plot(prediction: Prediction) -> Iterator[Shape]:
    """Stress over stretch, both directions, named beside the title, where no curve runs."""
    yield Label(MARGIN_MM, 158.0, "stress (N/mm) over stretch, pulled one way, free the other", 3.0)
    left, top, width, height = MARGIN_MM + 10.0, 162.0, 150.0, 52.0
    stress = np.array(DEFAULT_STRESS_N_PER_MM)
    strains = {d: prediction.along(d).strain(stress) for d in Direction}
    widest, tallest = max(float(strain[-1]) for strain in strains.values()), float(stress[-1])
    yield Rectangle(left, top, width, height, stroke="#b5b0a8")
    for share in (0.0, 0.5, 1.0):
        x, y = left + width * share, top + height * (1 - share)
        yield Label(x, top + height + 4.0, f"{100 * widest * share:.0f} %", 2.8, "middle")
        yield Label(left - 1.5, y + 1.0, f"{tallest * share:.2f}", 2.8, "end")
    for index, (direction, strain) in enumerate(strains.items()):
        across, up = left + width * strain / widest, top + height * (1 - stress / tallest)
        points = list(zip(across.tolist(), up.tolist(), strict=True))
        ink = _DIRECTION_INK[direction]
        yield Lines(tuple((*a, *b) for a, b in pairwise(points)), ink, 0.5)
        start = 106.0 + 44.0 * index
        yield Lines(((start, 157.0, start + 7.0, 157.0),), ink, 0.5)
        yield Label(start + 9.0, 158.0, f"along the {LINES[direction]}", 3.0)


def _with_assumptions(shapes: Sequence[Shape], said: Sequence[str], top: float) -> list[Page]:
    """A page with assumptions below its shapes; what does not fit goes on a page of its own."""
    lines = [line for note in said for line in textwrap.wrap(note, _LINE_CHARACTERS)]
    pages, y = [], top + 6.0
    drawn = [*shapes, Label(MARGIN_MM, top, ASSUMPTIONS, 3.4)]
    for line in lines:
        if y > A4_MM[1] - 8.0:
            pages.append(Page(*A4_MM, tuple(drawn)))
            drawn, y = [Label(MARGIN_MM, 16.0, f"{ASSUMPTIONS}, continued", 3.4)], 22.0
        drawn.append(Label(MARGIN_MM, y, line, 2.8))
        y += 4.2
    return [*pages, Page(*A4_MM, tuple(drawn))]
