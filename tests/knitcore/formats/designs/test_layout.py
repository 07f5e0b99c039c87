"""Outline, regions, repeats and shelf of a design."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from knitcore.formats.designs.design_file import (
    DesignFile,
    design_from_mapping,
    read_design,
    write_design,
)
from knitcore.formats.designs.layout import (
    DesignRegion,
    DesignRepeat,
    Placement,
    ShelfPattern,
    layout_notes,
    layout_of,
    piece_of,
    runs_of,
)
from knitcore.garment.piece import Piece
from knitcore.garment.shaped import INSIDE, OUTSIDE
from tests.knitcore.charts import stitch_charts
from tests.knitcore.pieces import pieces
from tests.knitcore.refusals import refuses

NAMES = st.text(st.characters(exclude_categories=["Cs", "Cc"]), min_size=1, max_size=20)
MOTIFS = stitch_charts(4).map(lambda chart: chart.key)
COLOURS = st.from_regex(r"\A#[0-9a-f]{6}\Z")


@st.composite
def designs(draw: st.DrawFn) -> DesignFile:
    """Designs with everything that a design can have."""
    chart = draw(stitch_charts(8))
    shape = chart.purl.shape
    marks = draw(st.none() | hnp.arrays(np.bool_, shape))
    outline = None
    if marks is not None:
        rows = ("".join(INSIDE if cell else OUTSIDE for cell in row) for row in marks)
        outline = "\n".join(rows)
    regions = [
        DesignRegion(
            id=f"r{index}",
            name=draw(NAMES),
            colour=draw(COLOURS),
            yarn=draw(st.none() | NAMES),
            fill=draw(st.none() | MOTIFS),
            runs=runs_of(draw(hnp.arrays(np.bool_, shape))),
            locked=draw(st.booleans()),
            hidden=draw(st.booleans()),
        )
        for index in range(draw(st.integers(0, 3)))
    ]
    row, column = (draw(st.integers(0, size - 1)) for size in shape)
    place = Placement(
        row=row,
        column=column,
        rows=draw(st.integers(1, shape[0] - row)),
        columns=draw(st.integers(1, shape[1] - column)),
    )
    repeats = [
        DesignRepeat(
            id="m",
            name=draw(NAMES),
            motif=draw(MOTIFS),
            edge_columns=draw(st.integers(0, 3)),
            edge_rows=draw(st.integers(0, 3)),
            placements=[place],
        )
    ]
    shelf = [ShelfPattern(name=draw(NAMES), motif=draw(MOTIFS))]
    return DesignFile(
        name=draw(NAMES),
        material=draw(st.none() | NAMES),
        note=draw(NAMES),
        chart=chart.text,
        outline=outline,
        regions=regions,
        repeats=draw(st.sampled_from([[], repeats])),
        shelf=draw(st.sampled_from([[], shelf])),
    )


@given(design=designs())
def test_nothing_is_lost(design: DesignFile, tmp_path: Path) -> None:
    file = tmp_path / "design.json"
    file.write_text(write_design(design), encoding="utf-8")
    assert read_design(file) == design
    assert str(read_design(file).to_chart()) == design.chart
    assert design_from_mapping(design.model_dump(mode="json")) == design


@settings(max_examples=40)
@given(piece=pieces())
def test_a_layout_makes_the_piece_again(piece: Piece) -> None:
    assert piece_of(piece.chart, layout_of(piece)) == piece


def region(name: str, runs: list[tuple[int, int, int]], **more: object) -> dict[str, object]:
    return {"id": name, "name": name, "colour": "#3b6fb6", "runs": runs} | more


def design(**more: object) -> dict[str, object]:
    return {"format": "knitcore-design", "version": 2, "chart": "KPK\nKKK"} | more


MOTIF = {"id": "m", "name": "moss", "motif": "KP/PK"}


@pytest.mark.parametrize(
    ("change", "field", "says"),
    [
        ({"regions": [region("a", [(2, 0, 1)])]}, "regions", "a reaches beyond the chart in row 3"),
        ({"regions": [region("a", [(1, 2, 2)])]}, "regions", "stitches 3 to 4 do not fit 3x2"),
        ({"regions": [region("a", [(0, 0, 0)])]}, "regions.0.runs.0.2", "greater than"),
        ({"regions": [region("a", []), region("a", [])]}, "regions", "two have the id a"),
        ({"regions": [region("a", [], fill="KP/K")]}, "regions", "rows of 1 and of 2 stitches"),
        ({"regions": [region("a", [], fill="KX")]}, "regions.0.fill", "pattern"),
        ({"regions": [region("a", [], colour="red")]}, "regions.0.colour", "pattern"),
        ({"outline": "xx\nxx"}, "outline", "2x2 cells, the chart 3x2"),
        ({"outline": "x"}, "outline", "1x1 cells"),
        ({"shelf": [{"name": "mine", "motif": "KP/K"}]}, "shelf", "pattern of mine"),
        (
            {
                "repeats": [
                    MOTIF | {"placements": [{"row": 1, "column": 0, "rows": 2, "columns": 1}]}
                ]
            },
            "repeats",
            "a placement of moss reaches beyond the chart",
        ),
    ],
)
def test_errors_name_their_place(change: dict[str, object], field: str, says: str) -> None:
    with refuses(field, says):
        design_from_mapping(design(**change))


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"regions": [region("a", [])]}, "a has no stitches"),
        (
            {"regions": [region("a", [(0, 0, 1)]), region("b", [(0, 0, 2)])]},
            "a is lost: later regions cover it",
        ),
        ({"regions": [region("a", [(0, 0, 3)], fill="P")]}, "a contradicts the chart: 3 of its 3"),
        (
            {"regions": [region("a", [(0, 0, 3)], fill="P"), region("b", [(0, 0, 3)], fill="K")]}
            | {"chart": "KKK\nKKK"},
            "a is lost",
        ),
        ({"outline": "x.x\nxxx"}, "row 2 is in two parts"),
        (
            {
                "regions": [
                    region("a", [(0, 0, 1)], yarn="navy"),
                    region("b", [(0, 1, 1)], yarn="navy", colour="#000000"),
                ]
            },
            "navy has several colours: that of its first region, #3b6fb6",
        ),
        ({"outline": "xx.\nxx.", "regions": [region("a", [(0, 2, 1)])]}, "outside the outline"),
    ],
)
def test_doubtful_layouts_are_reported(change: dict[str, object], says: str) -> None:
    made = design_from_mapping(design(**change))
    (note,) = layout_notes(made.to_chart(), made)
    assert says in note
