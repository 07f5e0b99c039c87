"""Write a design as a pattern: materials, parts, rows, chart and the evidence for its numbers.

The same pages are written as PDF and as SVG. Sizes are those of the cloth at rest, with intervals.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from knitcore.base.arrays import Array, Mask
from knitcore.chart.fabric import Direction
from knitcore.chart.row_sides import Construction
from knitcore.draw.laid_out import SizeAtRest, laid_corners_mm, size_at_rest
from knitcore.formats.write.chart_drawing import chart_pages
from knitcore.formats.write.chart_key import (
    ChartStyle,
    RegionMark,
    is_coloured,
    kinds_of,
    shortened,
    tinted,
)
from knitcore.formats.write.drawn_page import Page
from knitcore.formats.write.sheets.flow import Flow, numbered
from knitcore.formats.write.written_pattern import written_sections
from knitcore.garment.piece import Piece, yarn_name
from knitcore.materials import Interval, Material
from knitcore.prediction.predict import predict
from knitcore.prediction.prediction import Along, Prediction, Source
from knitcore.prediction.pure import CURL, CURLS

MAX_SECTIONS = 24
"""Rows of designs with more borders between regions are written without sections."""
PULL_N_PER_MM = 0.05

_ABBREVIATIONS = {
    "k": "knit",
    "p": "purl",
    "st": "stitch",
    "sts": "stitches",
    "rep": "repeat",
    "rnd": "round",
    "RS": "right side of the fabric",
    "WS": "wrong side of the fabric",
    "k2tog": "knit two stitches together",
    "k3tog": "knit three stitches together",
    "p2tog": "purl two stitches together",
    "p3tog": "purl three stitches together",
    "ssk": "slip two stitches as if to knit, one at a time, put them back and knit them together "
    "through the back loops",
    "ssp": "slip two stitches as if to knit, one at a time, put them back and purl them together "
    "through the back loops",
    "m1": "make one: lift the strand between two stitches and knit it through the back loop",
    "m1p": "make one: lift the strand between two stitches and purl it through the back loop",
}

_RESTS_ON: dict[Source | None, str] = {
    None: (
        "Sizes are computed stitch by stitch from the fabrics of this yarn. Where fabrics meet "
        "they are partly assumed, because such borders were not knitted and measured."
    ),
    Source.MEASURED: "This fabric was knitted in this yarn, measured at rest and stretched.",
    Source.ESTIMATED: (
        "This fabric was not knitted and stretched in this yarn: size and stretch are estimated "
        "from the yarn's tests and from other yarns."
    ),
    Source.SWEPT: (
        "Size and stretch were computed from the yarn, loop by loop; nothing was knitted."
    ),
    Source.LEARNED: (
        "Size and stretch are computed from stockinette, garter, rib and seed of this yarn, "
        "corrected by simulations of other charts; this chart was not knitted."
    ),
    Source.LEARNED_OF_SIZE: (
        "The size at rest is your own gauge. The stretch is computed from stockinette, garter, rib "
        "and seed of this yarn, corrected by simulations of other charts."
    ),
    Source.OTHER_STITCHES: (
        "Size and stretch are computed from the knits and purls of this chart. Its other stitches "
        "change the size as they did on knitted swatches; this chart was not knitted."
    ),
}
"""Basis of a prediction's numbers, in a knitter's words; None is for a piece with an outline."""


def pattern_pages(
    piece: Piece,
    material: Material,
    style: ChartStyle,
    yarn_facts: Sequence[str] = (),
    photo: bytes | None = None,
    yarn_notes: Sequence[str] = (),
    prediction: Prediction | None = None,
) -> tuple[Page, ...]:
    """The pattern as A4 pages.

    Parameters
    ----------
    piece : what is knitted; the purl map of a chart of other stitches, which the style has.
    material : gives sizes and stretch.
    style : how it is worked, its title, note, regions and linked repeats.
    yarn_facts : of each yarn, such as its length.
    photo : a PNG picture of the cloth for the first page.
    yarn_notes : sentences about all yarns.
    prediction : of a chart of other stitches.

    Raises
    ------
    InputError
        If the photo is no PNG or too large, the material lacks a fabric that the chart needs, or
        the piece cannot be worked in the round.
    """
    flow = Flow()
    facts = _Facts.of(piece, material, prediction)
    flow.title(style.title or "Untitled")
    flow.text(f"{piece.shaped.stitches} stitches in {piece.chart.rows} rows; {facts.finished}.")
    if photo is not None:
        flow.photo(photo, "The cloth as it was computed, not a photograph.")
    _materials(flow, piece, material, yarn_facts, yarn_notes)
    parts = _known_parts(facts, style.regions)
    _gauge(flow, facts, parts=bool(parts))
    if style.note:
        flow.heading("Notes")
        for paragraph in style.note.splitlines():
            flow.text(paragraph, bullet=True)
    _parts(flow, facts, parts)
    opening, sections = written_sections(
        style.stitches or piece,
        style.construction,
        first_side=style.first_side,
        breaks=_breaks(piece, style.regions),
    )
    _abbreviations(flow, [*opening, *(line for lines in sections for line in lines)], style)
    _instructions(flow, piece, style, opening, sections)
    _finishing(flow, facts, style)
    _evidence(flow, facts, style)
    written = flow.pages()
    plain = replace(style, note="")  # printed above
    pages = [*written, *chart_pages(piece, plain, first=len(written) + 1)]
    return numbered(pages, style.title or "Untitled")


@dataclass(frozen=True, eq=False)
class _Facts:
    """Facts about the cloth that the pattern prints.

    Attributes
    ----------
    prediction : None for a piece with an outline, which has no prediction of its own.
    size : of the whole.
    sizes_mm : (rows, columns, 2) width and height of the stitches, laid flat at rest.
    """

    piece: Piece
    prediction: Prediction | None
    size: SizeAtRest
    sizes_mm: Array

    @classmethod
    def of(cls, piece: Piece, material: Material, known: Prediction | None) -> _Facts:
        shaped = piece.shaped
        prediction = known or predict(shaped.rectangle_inside(), material, piece.gauge)
        size = size_at_rest(shaped, material, prediction)
        own = prediction if piece.is_rectangle else None
        corners = laid_corners_mm(shaped, material, piece.gauge)
        across, up = np.diff(corners[..., 0], axis=1), np.diff(corners[..., 1], axis=0)
        sizes = np.stack([across[1:] + across[:-1], up[:, 1:] + up[:, :-1]], axis=-1) / 2
        return cls(piece, own, size, sizes)

    @property
    def finished(self) -> str:
        """The finished size in words."""
        most = "" if self.piece.is_rectangle else " at the widest and highest"
        return f"{self.size.width_mm / 10:.1f} × {self.size.height_mm / 10:.1f} cm at rest{most}"


def _materials(
    flow: Flow,
    piece: Piece,
    material: Material,
    yarn_facts: Sequence[str],
    yarn_notes: Sequence[str],
) -> None:
    flow.heading("Materials")
    yarn = material.yarn
    details = ", ".join(part for part in (yarn.product, yarn.fibre) if part)
    flow.text(f"{material.name}{f' ({details})' if details else ''}.")
    for index, own in enumerate(piece.yarns):
        facts = yarn_facts[index] if index < len(yarn_facts) else ""
        name = f"{yarn_name(index)}: {own.name}" if is_coloured(piece) else own.name
        flow.text(": ".join(filter(None, (name.capitalize(), facts))), colour=tinted(own.colour))
    for note in (*yarn_notes, "Lengths are for the stitches alone: add tails, cast-on, a swatch."):
        flow.text(note)
    flow.text("Needles of the size with which your swatch has the gauge below.")


def _gauge(flow: Flow, facts: _Facts, *, parts: bool) -> None:
    flow.heading("Gauge and size")
    if facts.prediction is None and parts:
        flow.text("Each part has a gauge of its own: see Parts.")
    else:
        width, height = facts.sizes_mm[facts.piece.shaped.stitch].mean(axis=0).tolist()
        counts = f"{100 / width:.0f} stitches and {100 / height:.0f} rows"
        flow.text(f"{counts} to 10 cm of the whole cloth at rest.")
    places = (0.0, 62.0, 124.0)
    flow.row(("", "along the rows", "along the columns"), places, bold=True)
    size = facts.size
    across = _interval(size.width_mm, size.width_interval_mm, 0.1, "cm", 1)
    up = _interval(size.height_mm, size.height_interval_mm, 0.1, "cm", 1)
    flow.row(("Finished size", across, up), places)
    if facts.prediction is not None:
        pulled = [_pulled(facts.prediction.along(direction)) for direction in Direction]
        flow.row((f"Stretch under {PULL_N_PER_MM * 100:g} N on 10 cm", *pulled), places)
    flow.text("In brackets are 90 % intervals: nine pieces in ten should lie inside.")


def _pulled(along: Along) -> str:
    low, high = along.strain_interval(PULL_N_PER_MM)
    strain = float(along.strain(PULL_N_PER_MM))
    return _interval(strain, Interval(float(low), float(high)), 100.0, "%", 0)


def _interval(value: float, ends: Interval, scale: float, unit: str, digits: int) -> str:
    low, middle, high = (f"{x * scale:.{digits}f}" for x in (ends.low, value, ends.high))
    return f"{middle} {unit} ({low} to {high})"


def _known_parts(facts: _Facts, regions: Sequence[RegionMark]) -> list[tuple[RegionMark, Mask]]:
    """Regions with stitches inside the outline, and those stitches."""
    inside = facts.piece.shaped.stitch
    known = [(region, region.cells & inside) for region in regions]
    return [(region, cells) for region, cells in known if cells.any()]


def _parts(flow: Flow, facts: _Facts, shown: Sequence[tuple[RegionMark, Mask]]) -> None:
    """Each region: where it lies, its gauge, and its size at its widest row and highest column."""
    if not shown:
        return
    flow.heading("Parts")
    places = (0.0, 54.0, 104.0, 150.0)
    flow.row(("", "where", "gauge, 10 cm", "size at rest"), places, bold=True)
    for region, cells in shown:
        rows, columns = np.nonzero(cells)
        width, height = facts.sizes_mm[cells].mean(axis=0).tolist()
        first, last = (facts.piece.chart.columns - c for c in (columns.max(), columns.min()))
        where = f"rows {rows.min() + 1}–{rows.max() + 1}, sts {first}–{last}"
        across = width * cells.sum(axis=1).max() / 10
        up = height * cells.sum(axis=0).max() / 10
        gauge = f"{100 / width:.0f} sts, {100 / height:.0f} rows"
        texts = (shortened(region.name), where, gauge, f"{across:.1f} × {up:.1f} cm")
        flow.row(texts, places, colour=region.colour)
    flow.text(
        "Stitches are counted from the right edge; sizes are of each part's widest row and "
        "highest column, beside its neighbours. By itself, its fabric has another gauge."
    )


def _breaks(piece: Piece, regions: Sequence[RegionMark]) -> list[int]:
    """Rows at which a region begins or has ended, in rising order."""
    breaks: set[int] = set()
    for region in regions:
        rows = np.flatnonzero((region.cells & piece.shaped.stitch).any(axis=1))
        if len(rows):
            breaks |= {int(rows[0]), int(rows[-1]) + 1}
    inner = sorted(breaks - {0, piece.chart.rows})
    return inner if len(inner) <= MAX_SECTIONS else []


def _abbreviations(flow: Flow, lines: Sequence[str], style: ChartStyle) -> None:
    """List the abbreviations that the rows use."""
    words = {word for line in lines for word in re.findall(r"[A-Za-z]+\d?[a-z]*", line)}
    written = words | {re.sub(r"\d+$", "", word) for word in words}
    used = {short for short in _ABBREVIATIONS if {short, short.capitalize()} & written}
    flow.heading("Abbreviations")
    explained = [f"{short}: {_ABBREVIATIONS[short]}" for short in _ABBREVIATIONS if short in used]
    faces = kinds_of(style)
    backs = [kind.turned_over for kind in faces if style.construction is Construction.FLAT]
    others = {kind.words: kind.name for kind in (*faces, *backs)}
    explained += [f"{word}: {name}" for word, name in others.items() if word not in _ABBREVIATIONS]
    flow.text("; ".join(explained) + ". A number after k or p is a number of stitches.")
    if any("*" in line for line in lines):
        flow.text("Work the stitches after * once, then repeat them as often as stated.")


def _instructions(
    flow: Flow,
    piece: Piece,
    style: ChartStyle,
    opening: Sequence[str],
    sections: Sequence[Sequence[str]],
) -> None:
    flow.heading("Instructions")
    for line in opening:
        flow.text(line)
    edges = pairwise([0, *_breaks(piece, style.regions), piece.chart.rows])
    row = "Row" if style.construction is Construction.FLAT else "Round"
    for (start, stop), lines in zip(edges, sections, strict=True):
        if len(sections) > 1:
            here = [r.name for r in style.regions if r.cells[start:stop].any()]
            span = f"{row} {start + 1}" if stop == start + 1 else f"{row}s {start + 1}–{stop}"
            flow.subheading(f"{span}: {', '.join(map(shortened, here)) or 'between the parts'}")
        for line in lines:
            flow.text(re.sub(r"(?<=\d)-(?=\d)", "–", line))


def _finishing(flow: Flow, facts: _Facts, style: ChartStyle) -> None:
    flow.heading("Finishing")
    flow.text("Bind off as loosely as the cloth stretches, and weave in the ends.")
    flow.text(
        f"Wash the piece and let it dry lying flat, without pulling it: {facts.finished}. "
        "The sizes of this pattern are those of cloth at rest, not of cloth pinned out."
    )
    if style.construction is Construction.ROUND:
        flow.text("In the round the width is the circumference.")


def _evidence(flow: Flow, facts: _Facts, style: ChartStyle) -> None:
    flow.heading("Where the numbers come from")
    prediction = facts.prediction
    source = None if prediction is None else prediction.provenance
    curls = prediction is not None and CURL in prediction.notes
    notes = () if style.stitches is None or prediction is None else prediction.notes
    for sentence in (
        _RESTS_ON[source],
        *(note for note in notes if note != CURL),
        *([CURLS] if curls else []),
        "The report of this design has all numbers, their intervals and methods.",
        "Knit a swatch. If its gauge differs from this pattern's, trust the swatch.",
    ):
        flow.text(sentence, bullet=True)
