"""Parts of a design other than its chart: other stitches, outline, regions, linked repeats and
patterns.

The same fields are in the project file, in the service's designs and in the page.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Annotated, Self

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from knitcore.base.arrays import Mask
from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, StitchChart
from knitcore.formats.designs.other_stitches import MAX_STITCH_RUNS, Index, StitchRun, placed
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart, check_outline, check_outline_size, outline_marks
from knitcore.machine.profile import MAX_BYTES as MAX_MACHINE

MAX_TEXT = 1_200_000
MAX_ITEMS = 200
MAX_RUNS = 200_000
MAX_MOTIF = 20_000

Identifier = Annotated[str, Field(pattern=r"^[A-Za-z0-9_.:-]{1,64}$", examples=["wrist-support"])]
ItemName = Annotated[str, Field(min_length=1, max_length=80, pattern=r"^[^\x00-\x1f]+$")]
Colour = Annotated[str, Field(pattern=r"^#[0-9a-fA-F]{6}$", examples=["#3b6fb6"])]
Motif = Annotated[
    str,
    Field(
        max_length=MAX_MOTIF,
        pattern=r"^[KP]+(/[KP]+)*$",
        description="A repeat; its rows from the top, separated by /.",
        examples=["KP/PK"],
    ),
]
Length = Annotated[int, Field(ge=1, le=MAX_STITCHES_PER_SIDE)]


class _Part(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class DesignRegion(_Part):
    """A part of the chart with a fill or a yarn of its own; later regions lie on top."""

    id: Identifier
    name: ItemName
    colour: Colour
    yarn: ItemName | None = Field(None, description="Intarsia yarn; None leaves the yarn beneath.")
    fill: Motif | None = Field(
        None, description="Repeat that fills it, counted from the chart's corner."
    )
    runs: list[tuple[Index, Index, Length]] = Field(
        max_length=MAX_RUNS,
        description="[row, column, length] of adjacent stitches; row 0 is the bottom.",
    )
    locked: bool = False
    hidden: bool = False


class Placement(_Part):
    """Place of a linked repeat."""

    row: Index
    column: Index
    rows: Length
    columns: Length


class DesignRepeat(_Part):
    """A motif whose placements all follow it; "multiple of n + m" has m ``edge_columns``."""

    id: Identifier
    name: ItemName
    motif: Motif
    edge_columns: int = Field(0, ge=0, le=MAX_STITCHES_PER_SIDE)
    edge_rows: int = Field(0, ge=0, le=MAX_STITCHES_PER_SIDE)
    placements: list[Placement] = Field(default=[], max_length=MAX_ITEMS)


class ShelfPattern(_Part):
    """A pattern of the user's."""

    name: ItemName
    motif: Motif


class DesignLayout(BaseModel):
    """Everything in a design except its chart and its names."""

    other_stitches: list[StitchRun] = Field(
        default=[],
        max_length=MAX_STITCH_RUNS,
        description="Stitches that are neither knit nor purl; under them the chart has the K or P "
        "that each shows.",
    )
    outline: str | None = Field(
        None,
        max_length=MAX_TEXT,
        description="Lines of x (stitch) and . (no stitch), the top row first; a full rectangle "
        "if left out.",
    )
    regions: list[DesignRegion] = Field(default=[], max_length=MAX_ITEMS)
    repeats: list[DesignRepeat] = Field(default=[], max_length=MAX_ITEMS)
    shelf: list[ShelfPattern] = Field(default=[], max_length=MAX_ITEMS)
    machine: str | None = Field(
        None,
        max_length=MAX_MACHINE,
        description="Machine of knitting programs: its name, or a profile of one's own as JSON.",
    )

    @model_validator(mode="after")
    def _bounded(self) -> Self:
        if sum(len(region.runs) for region in self.regions) > MAX_RUNS:
            raise ValueError(f"all regions together have at most {MAX_RUNS} runs")
        return self


def region_cells(region: DesignRegion, rows: int, columns: int) -> Mask:
    """The stitches of a region, bool (rows, columns), row 0 at the bottom.

    Raises
    ------
    InputError
        If a run reaches beyond the chart.
    """
    cells = np.zeros((rows, columns), dtype=bool)
    for row, column, length in region.runs:
        if row >= rows or column + length > columns:
            raise InputError(
                "regions",
                f"{region.name} reaches beyond the chart in row {row + 1}: its stitches "
                f"{column + 1} to {column + length} do not fit {columns}x{rows}.",
                "Keep regions within the chart; when a chart is resized, cut them.",
            )
        cells[row, column : column + length] = True
    return cells


def runs_of(cells: Mask) -> list[tuple[int, int, int]]:
    """The inverse of :func:`region_cells`."""
    edges = np.diff(np.pad(cells.astype(np.int8), ((0, 0), (1, 1))), axis=1)
    starts, stops = np.argwhere(edges == 1).tolist(), np.argwhere(edges == -1)[:, 1].tolist()
    return [(row, start, stop - start) for (row, start), stop in zip(starts, stops, strict=True)]


def piece_of(chart: StitchChart, layout: DesignLayout) -> Piece:
    """The piece of a design: regions with a yarn colour their stitches, later ones on top.

    Raises
    ------
    InputError
        If the outline is in several parts, or the layout does not belong to the chart.
    """
    check_layout(chart, layout)
    shaped = ShapedChart.rectangle(chart)
    if layout.outline is not None:
        shaped = ShapedChart(chart, outline_marks(layout.outline))
    yarns = [MAIN_YARN]
    yarn_of = np.zeros(chart.purl.shape, dtype=np.intp)
    names: dict[str, int] = {}
    for region in layout.regions:
        if region.yarn is None:
            continue
        if region.yarn not in names:  # a yarn has the colour of its first region
            names[region.yarn] = len(yarns)
            yarns.append(PieceYarn(region.yarn, region.colour.lower()))
        yarn_of[region_cells(region, chart.rows, chart.columns)] = names[region.yarn]
    return Piece(shaped, tuple(yarns), yarn_of)


def layout_of(piece: Piece) -> DesignLayout:
    """A layout from which :func:`piece_of` makes the piece again."""
    regions = [
        DesignRegion(
            id=f"yarn-{index + 1}",
            name=yarn.name,
            colour=yarn.colour,
            yarn=yarn.name,
            runs=runs_of(piece.cells(index)),
        )
        for index, yarn in enumerate(piece.yarns)
        if yarn != MAIN_YARN
    ]
    outline = None if piece.is_rectangle else piece.shaped.outline
    return DesignLayout(outline=outline, regions=regions)


def check_layout(chart: StitchChart, layout: DesignLayout) -> None:
    """Refuse a layout that does not belong to a chart.

    Raises
    ------
    InputError
        Naming the region, repeat or outline, the problem and the remedy.
    """
    for _ in placed(layout.other_stitches, chart.rows, chart.columns):
        pass
    if layout.outline is not None:
        check_outline_size(outline_marks(layout.outline), chart)
    for field, items in (("regions", layout.regions), ("repeats", layout.repeats)):
        twice = [i for i, n in Counter(item.id for item in items).items() if n > 1]
        if twice:
            raise InputError(field, f"two have the id {twice[0]}.", "Give each an id of its own.")
    for region in layout.regions:
        region_cells(region, chart.rows, chart.columns)
        if region.fill is not None:
            _check_motif("regions", region.name, region.fill)
    for repeat in layout.repeats:
        _check_motif("repeats", repeat.name, repeat.motif)
        for place in repeat.placements:
            if place.row + place.rows > chart.rows or place.column + place.columns > chart.columns:
                raise InputError(
                    "repeats",
                    f"a placement of {repeat.name} reaches beyond the chart of "
                    f"{chart.columns}x{chart.rows} stitches.",
                    "Move or cut it.",
                )
    for pattern in layout.shelf:
        _check_motif("shelf", pattern.name, pattern.motif)


def _check_motif(field: str, name: str, motif: str) -> None:
    widths = {len(row) for row in motif.split("/")}
    if len(widths) > 1:
        problem = f"the pattern of {name} has rows of {min(widths)} and of {max(widths)} stitches."
        raise InputError(field, problem, "Give every row of a repeat the same number of stitches.")


def layout_notes(chart: StitchChart, layout: DesignLayout) -> tuple[str, ...]:
    """Warnings: hidden regions, contradictions, an outline in several parts."""
    stitch = np.ones(chart.purl.shape, dtype=bool)
    if layout.outline is not None:
        stitch = outline_marks(layout.outline)
    return (
        *_outline_notes(stitch),
        *_region_notes(chart, stitch, layout.regions),
        *_yarn_notes(layout.regions),
    )


def _outline_notes(stitch: Mask) -> Iterator[str]:
    try:
        check_outline(stitch)
    except InputError as error:
        yield f"Outline: {error.problem} {error.remedy}"


def _yarn_notes(regions: Sequence[DesignRegion]) -> Iterator[str]:
    colours: dict[str, str] = {}
    for region in regions:
        if region.yarn is None:
            continue
        first = colours.setdefault(region.yarn, region.colour.lower())
        if first != region.colour.lower():
            yield (
                f"The yarn {region.yarn} has several colours: that of its first region, {first}, "
                f"is used in {region.name}, too."
            )


def _region_notes(
    chart: StitchChart, stitch: Mask, regions: Sequence[DesignRegion]
) -> Iterator[str]:
    above = np.zeros(stitch.shape, dtype=bool)
    notes = []
    for region in reversed(regions):
        cells = region_cells(region, chart.rows, chart.columns)
        seen = cells & ~above
        kept = seen & stitch
        above |= cells
        if not cells.any():
            notes.append(f"{region.name} has no stitches.")
        elif not seen.any():
            notes.append(f"{region.name} is lost: later regions cover it completely.")
        elif not kept.any():
            notes.append(f"{region.name} is lost: it lies completely outside the outline.")
        elif region.fill is not None:
            purl = StitchChart.parse(region.fill).resized(chart.rows, chart.columns).purl
            other = int(np.count_nonzero((purl != chart.purl) & kept))
            if other:
                notes.append(
                    f"{region.name} contradicts the chart: {other} of its {int(kept.sum())} "
                    "stitches differ from its fill. The chart is used."
                )
    yield from reversed(notes)
