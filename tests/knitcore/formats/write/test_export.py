import csv
import io
import re
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import meshio
import numpy as np
import pytest
import trimesh
from hypothesis import example, given, settings

from knitcore import Direction, Fabric, InputError, RelaxedSize, StitchChart, material, predict
from knitcore.chart.row_sides import Construction
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.designs.garment_design import design_of_plan
from knitcore.formats.designs.layout import (
    DesignLayout,
    DesignRegion,
    DesignRepeat,
    Placement,
    layout_of,
)
from knitcore.formats.read.chart_files import (
    read_noted_chart,
    read_noted_piece,
    read_noted_stitches,
)
from knitcore.formats.write import report
from knitcore.formats.write.chart_drawing import chart_pages, chart_pdf, chart_svg
from knitcore.formats.write.chart_key import (
    HEAVY,
    INK,
    KINDS_WITH_NAMES,
    ChartStyle,
    RegionMark,
    Symbols,
    tinted,
)
from knitcore.formats.write.drawn_page import Label, Lines, Page, Rectangle, to_pdf, to_svg
from knitcore.formats.write.export import FORMATS, ExportKind, ExportOptions, export_chart
from knitcore.formats.write.extensibility_drawing import region_fields
from knitcore.formats.write.yarn_mesh import MAX_STITCHES, yarn_mesh, yarn_radius_mm
from knitcore.garment.glove import Hand, glove
from knitcore.garment.piece import Piece
from knitcore.materials.yarn_per_stitch import mean_yarn
from knitcore.mechanics.local_moduli import local_moduli
from knitcore.prediction.prediction import Source
from tests.knitcore.charts import stitch_charts
from tests.knitcore.pieces import pieces
from tests.knitcore.symbol_charts import symbol_charts

ACRYLIC = material("acrylic:published")
WHOLE = (ExportKind.PNG, ExportKind.WRITTEN, ExportKind.DESIGN)
"""Formats that hold outlines and yarns, and are cheap to read back."""
CHEAP = (*WHOLE, ExportKind.TEXT, ExportKind.KNITSPEAK)


def exported(chart: StitchChart, kind: ExportKind, **options: Any) -> bytes:
    """The content of a file in acrylic."""
    return export_chart(chart, kind, ACRYLIC, ExportOptions(**options)).content


def region(name: str, runs: list[tuple[int, int, int]]) -> DesignRegion:
    return DesignRegion(id=name, name=name, colour="#1f3b70", yarn="navy", runs=runs)


def round_trip(chart: StitchChart, kind: ExportKind, folder: Path) -> StitchChart:
    file = folder / f"chart{FORMATS[kind].suffix}"
    file.write_bytes(exported(chart, kind))
    return read_noted_chart(file)[0]


@pytest.mark.parametrize("kind", CHEAP)
@settings(max_examples=25)
@given(chart=stitch_charts())
@example(chart=StitchChart(np.random.default_rng(0).random((170, 200)) < 0.5))
def test_round_trips_are_identities(kind: ExportKind, chart: StitchChart, tmp_path: Path) -> None:
    assert round_trip(chart, kind, tmp_path) == chart


@pytest.mark.parametrize("kind", WHOLE)
@settings(max_examples=25)
@given(piece=pieces() | pieces(most_rows=200, most_columns=200))
def test_outlines_and_yarns_come_back(kind: ExportKind, piece: Piece, tmp_path: Path) -> None:
    file = tmp_path / f"piece{FORMATS[kind].suffix}"
    file.write_bytes(exported(piece.chart, kind, layout=layout_of(piece)))
    read = read_noted_piece(file).piece
    assert read == (piece.cropped() if kind is ExportKind.WRITTEN else piece)


def test_content_that_a_format_cannot_hold_is_reported() -> None:
    chart = StitchChart.of_fabric("seed", rows=3, columns=4)
    shaped = ExportOptions(layout=DesignLayout(outline="xxx.\nxxxx\nxxxx"))
    for kind in (k for k, f in FORMATS.items() if not f.holds_outlines):
        with pytest.raises(InputError, match="cannot hold an outline"):
            export_chart(chart, kind, ACRYLIC, shaped)
    coloured = ExportOptions(layout=DesignLayout(regions=[region("A", [(0, 0, 2)])]))
    for kind in (k for k, f in FORMATS.items() if not f.holds_yarns):
        assert "no colours" in export_chart(chart, kind, ACRYLIC, coloured).notes[-1]
    apart = ExportOptions(layout=DesignLayout(outline="xx..\n..xx\nxxxx"))
    with pytest.raises(InputError, match="the outline is in several parts"):
        export_chart(chart, ExportKind.SVG, ACRYLIC, apart)


def test_a_coloured_chart_has_its_yarns_in_the_key_with_length_and_mass() -> None:
    chart = StitchChart.of_fabric("stockinette", rows=4, columns=10)
    layout = DesignLayout(regions=[region("A", [(row, 0, 5) for row in range(4)])])
    options = {"note": "Mind the edge.", "layout": layout, "linear_density_tex": 500}
    drawing = exported(chart, ExportKind.SVG, **options).decode()
    metres = 20 * (ACRYLIC.record(Fabric.STOCKINETTE).loop_length_mm or 0) / 1000
    assert f"B: navy (#1f3b70), 20 sts, {metres:.1f} m, {metres / 2:.1f} g" in drawing
    assert "A: main yarn" in drawing
    assert "Mind the edge." in drawing
    assert drawing.count(f'fill="{tinted("#1f3b70")}"') == 4 + 1  # a stretch a row, and the key


def test_linked_repeats_are_bordered_and_named() -> None:
    chart = StitchChart.of_fabric("seed", rows=6, columns=9)
    places = [Placement(row=0, column=0, rows=4, columns=5)] * 2
    repeat = DesignRepeat(id="m", name="Moss", motif="KP/PK", edge_columns=1, placements=places)
    layout = DesignLayout(repeats=[repeat])
    drawing = exported(chart, ExportKind.SVG, layout=layout).decode()
    assert "Moss: multiple of 2 + 1 sts, multiple of 2 rows" in drawing
    assert drawing.count(f'stroke="{HEAVY}"') == 2 + 1  # the copies, and the key


def test_values_are_those_of_the_stitches_inside() -> None:
    chart = StitchChart.of_fabric("rib", rows=4, columns=6)
    layout = DesignLayout(outline="xxxx..\n" * 2 + "xxxxxx\n" * 2)
    lines = exported(chart, ExportKind.CSV, layout=layout).decode().splitlines()
    assert len(lines) == 1 + 2 * 4 + 2 * 6
    moduli = {line.split(",")[3] for line in lines[1:]}
    assert len(moduli) == 1  # the outline's edge does not change the fabric


def test_the_report_of_a_piece_speaks_by_regions() -> None:
    plan = glove(Hand(), material("glove-wool:glove"))
    document = design_of_plan(plan, "glove-wool:glove")
    options = ExportOptions(name="Glove", layout=document)
    content = export_chart(
        document.to_chart(), ExportKind.REPORT, material("glove-wool:glove"), options
    ).content
    assert content.startswith(b"%PDF")
    fields = region_fields(document.to_piece(), document.regions, material("glove-wool:glove"))
    support = next(field for field in fields if field.name == "wrist support")
    along = support.prediction.along(Direction.WALE)
    value, interval = along.modulus_n_per_mm, along.modulus_interval_n_per_mm
    assert value == pytest.approx(1.05, abs=0.03)  # table 20, stockinette on 2.0 mm, Y_y
    assert interval.low < value < interval.high
    assert sum(field.stitches for field in fields) == plan.shaped.stitches


def test_knitout_is_read_from_a_file(tmp_path: Path) -> None:
    chart = StitchChart.parse("KPP\nKKP")
    assert round_trip(chart, ExportKind.KNITOUT, tmp_path) == chart


@pytest.mark.parametrize("kind", list(ExportKind))
def test_the_same_chart_gives_the_same_bytes(kind: ExportKind) -> None:
    chart = StitchChart.parse("KPK\nPKP")
    first, again = (exported(chart, kind) for _ in range(2))
    assert first == again


@given(chart=stitch_charts(most=6))
def test_a_drawing_has_a_dot_for_every_purl_in_its_place(chart: StitchChart) -> None:
    root = ET.fromstring(chart_svg(chart, ChartStyle(aspect=1.0)))  # noqa: S314 - our own
    groups = root.findall("{http://www.w3.org/2000/svg}g")
    dots = [(float(d.get("cx", 0)), float(d.get("cy", 0))) for d in groups[0]]
    left, top = 18.0, 26.0
    drawn = np.zeros_like(chart.purl)
    for x, y in dots:
        drawn[chart.rows - 1 - int((y - top) / 5.0), int((x - left) / 5.0)] = True
    assert np.array_equal(drawn, chart.purl)


def test_a_drawing_has_sides_repeat_and_key() -> None:
    chart = StitchChart.of_fabric("rib", rows=9, columns=7)
    svg = chart_svg(chart)
    labels = {
        text: float(x)
        for x, text in re.findall(r'<text[^>]* x="([\d.]+)"[^>]*>([^<]+)</text>', svg)
    }
    assert "purl on RS, knit on WS" in labels
    assert any("multiple of 2 + 1 sts" in label for label in labels)
    in_the_round = chart_svg(chart, ChartStyle(Construction.ROUND))
    assert "every round from right to left" in in_the_round
    assert in_the_round.count(">2</text>") == 2  # a row and a stitch
    assert labels["8"] < labels["9"]  # WS numbers at the left, RS numbers at the right


@pytest.mark.parametrize("aspect", [0.6, 0.75, 1.0])
def test_a_printed_chart_can_be_knitted_from(aspect: float) -> None:
    """Every page has numbers of both sides at arm's length, and shares stitches with the next."""
    rows, columns = 132, 77
    cells = np.zeros((rows, columns), dtype=bool)
    cells[10:60, 5:30] = True
    style = ChartStyle(
        aspect=aspect, title="Glove", note="Wash.", regions=(RegionMark("palm", "#336699", cells),)
    )
    overview, *pages = chart_pages(StitchChart(np.arange(rows)[:, None] % 3 < cells), style)
    assert len(pages) > 1
    words = " ".join(shape.text for shape in overview.shapes if isinstance(shape, Label))
    assert all(word in words for word in ("Glove", "palm", "Wash.", "page 2", f"page {len(pages)}"))
    right: set[int] = set()
    for page in pages:
        labels = [shape for shape in page.shapes if isinstance(shape, Label)]
        assert min(label.size for label in labels) >= 2.47  # 7 pt
        numbers = [label for label in labels if label.text.isdigit() and label.anchor != "middle"]
        here = {
            side: [int(n.text) for n in numbers if n.anchor == side] for side in ("start", "end")
        }
        assert min(map(len, here.values())) > 5
        assert all(number % 2 for number in here["start"])
        assert not any(number % 2 for number in here["end"])
        right |= set(here["start"])
    assert right == set(range(1, rows + 1, 2))


def test_a_large_chart_is_printed_on_several_pages() -> None:
    small = chart_pdf(StitchChart.of_fabric("seed", rows=40, columns=40))
    large = chart_pdf(StitchChart.of_fabric("seed", rows=120, columns=120))
    count = [content.count(b"/Type /Page\n") for content in (small, large)]
    assert small.startswith(b"%PDF-")
    assert count[0] == 1
    assert count[1] >= 6


def test_fonts_are_in_the_file_as_printers_ask_for() -> None:
    content = to_pdf([Page(99, 99, (Label(9, 9, "Knit"), Label(9, 19, "Purl", bold=True)))], "Two")
    assert content.count(b"/Type /FontDescriptor") == content.count(b"/FontFile2") == 2
    assert b"/Subtype /Type1" not in content


@pytest.mark.parametrize("aspect", [0.0, float("nan"), 9.0])
def test_stitches_have_a_shape(aspect: float) -> None:
    with pytest.raises(InputError, match="aspect ratio of a stitch"):
        ChartStyle(aspect=aspect)


@pytest.mark.parametrize(("kind", "unit"), [(ExportKind.GLB, 0.001), (ExportKind.STL, 1.0)])
def test_the_yarn_is_a_solid_of_its_length(kind: ExportKind, unit: float, tmp_path: Path) -> None:
    chart = StitchChart.parse("KPKK\nPPKP\nKKKP")
    file = tmp_path / f"yarn.{kind}"
    file.write_bytes(exported(chart, kind))
    solid = trimesh.load_mesh(file)
    solid.merge_vertices()
    assert solid.is_watertight
    assert solid.body_count == chart.rows
    radius = yarn_radius_mm(chart, ACRYLIC)
    ring = 3 / np.pi * np.sin(np.pi / 3)  # hexagon over circle
    length = solid.volume / (unit**3 * ring * np.pi * radius**2)
    loop = ACRYLIC.record(next(iter(ACRYLIC.fabrics))).loop_length_mm or 0.0
    assert length == pytest.approx(chart.purl.size * loop, rel=0.5)


def test_a_mesh_has_a_limit() -> None:
    side = int(MAX_STITCHES**0.5) + 1
    with pytest.raises(InputError, match="Use at most"):
        yarn_mesh(StitchChart.of_fabric("rib", side, side), ACRYLIC)


def test_values_of_every_stitch(tmp_path: Path) -> None:
    chart = StitchChart.parse("KPKK\nPPKP")
    local = local_moduli(chart, ACRYLIC)
    lines = list(csv.DictReader(io.StringIO(exported(chart, ExportKind.CSV).decode())))
    assert [line["stitch"] for line in lines] == list("PPKPKPKK")
    extensibility = [float(line["extensibility_wale_mm_per_n"]) for line in lines]
    table = local.table.extensibility_mm_per_n(Direction.WALE)[local.codes]
    assert extensibility == pytest.approx(table.ravel().tolist(), rel=1e-5)

    file = tmp_path / "chart.vtu"
    file.write_bytes(exported(chart, ExportKind.VTU))
    mesh = meshio.read(file)
    assert mesh.cells_dict["quad"].shape == (8, 4)
    assert mesh.cell_data["modulus_course_n_per_mm"][0] == pytest.approx(
        local.modulus_course_n_per_mm.ravel()
    )


@pytest.mark.parametrize(
    ("chart", "pages"),
    [
        (StitchChart.of_fabric("garter", rows=31, columns=31), 2),
        (StitchChart(np.random.default_rng(0).random((60, 70)) < 0.5), 4),
    ],
    ids=["with curves", "patchwork"],
)
def test_a_report_has_numbers_and_the_chart(chart: StitchChart, pages: int) -> None:
    content = exported(chart, ExportKind.REPORT)
    assert content.startswith(b"%PDF-")
    assert content.count(b"/Type /Page\n") == pages


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> list[Page]:
    """The pages of a report that is made."""
    drawn: list[Page] = []

    def keep(pages: Iterable[Page], _: str) -> bytes:
        drawn.extend(pages)
        return b""

    monkeypatch.setattr(report, "to_pdf", keep)
    return drawn


def test_a_report_tells_how_many_regions_its_table_leaves_out(drawn: list[Page]) -> None:
    most = report.MAX_REGIONS
    chart = StitchChart.of_fabric("stockinette", rows=most + 2, columns=4)
    regions = [region(str(row), [(row, 0, 4)]) for row in range(most + 2)]
    for some in (regions[: most - 1], regions):  # and the rest of the chart, if there is one
        report.design_report(chart, ACRYLIC, "Cuff", ChartStyle(), some)
    words = [shape.text for page in drawn for shape in page.shapes if isinstance(shape, Label)]
    assert [text for text in words if "more, in" in text] == ["… and 2 more, in the maps only."]


def test_a_report_gives_its_numbers_with_their_source(drawn: list[Page]) -> None:
    chart = StitchChart.of_fabric("garter", rows=5, columns=5)
    report.design_report(chart, ACRYLIC, "Cuff", ChartStyle())
    words = " ".join(shape.text for shape in drawn[0].shapes if isinstance(shape, Label))
    assert "Cuff" in words
    assert "0.223  (" in words
    assert "Source: measured" in words
    assert "Shear modulus 0.01 N/mm: an assumption" in words
    inside = [s for s in drawn[0].shapes if isinstance(s, Rectangle)]
    assert all(0 <= b.x <= 210 and b.y + b.height <= 297 for b in inside)


def test_a_report_prints_every_assumption_in_a_knitters_words(
    drawn: list[Page], monkeypatch: pytest.MonkeyPatch
) -> None:
    chart = StitchChart(np.arange(600).reshape(20, 30) % 7 < 3)
    region_name = "the left half, with a name that has no end"
    named = region("left", [(0, 0, 9)]).model_copy(update={"name": region_name})
    report.design_report(chart, ACRYLIC, "Cuff", ChartStyle(), [named])
    labels = [shape for page in drawn for shape in page.shapes if isinstance(shape, Label)]
    words = " ".join(label.text for label in labels)
    assert not re.findall(r"\b(?:course|wale|learned)\b", words)
    assert f"{region_name[:25]}…" in words
    monkeypatch.setattr(report, "assumptions", lambda _: [f"Assumption {k}." for k in range(99)])
    drawn.clear()
    report.design_report(chart, ACRYLIC, "Cuff", ChartStyle())
    labels = [shape for page in drawn for shape in page.shapes if isinstance(shape, Label)]
    assert {f"Assumption {k}." for k in range(99)} <= {label.text for label in labels}
    assert all(label.y < page.height for page in drawn for label in labels)


def test_a_designs_note_is_for_the_knitter_alone() -> None:
    """Changes for the designer stand beside the plan, not in the pattern."""
    plan = glove(Hand(), material("glove-wool"), mmhg=25)
    note = design_of_plan(plan, "glove-wool").note
    assert plan.cautions
    assert not [caution for caution in plan.cautions if caution in note]
    assert all(line in note for line in plan.notes)


def test_a_drawing_is_xml_whatever_it_is_called() -> None:
    page = Page(10.0, 10.0, (Label(1.0, 1.0, "a\ufffe\x0b\ud800🧶", 3.0),))
    drawn = ET.fromstring(to_svg(page, "\x00")).find("{*}text")  # noqa: S314 - our own
    assert drawn.text == "a\ufffd\ufffd\ufffd🧶"


def pdf_letters(content: bytes) -> set[str]:
    """Letters of the embedded fonts of a PDF, as programs find and copy them."""
    letters: set[str] = set()
    for head in re.finditer(
        rb"/Filter \[ /FlateDecode \] /Length (\d+)\s+>>\s+stream\r?\n", content
    ):
        text = zlib.decompress(content[head.end() : head.end() + int(head[1])]).decode("latin-1")
        codes = re.findall(r"<([0-9A-F]{4})>", text) if "beginbf" in text else []
        letters |= {chr(int(code, 16)) for code in codes}
    return letters


@pytest.mark.parametrize("kind", [ExportKind.PDF, ExportKind.PATTERN, ExportKind.REPORT])
def test_names_keep_the_letters_of_their_language(kind: ExportKind) -> None:
    chart = StitchChart.of_fabric("seed", rows=2, columns=4)
    name = "Łódź – Жук, sleeve ⅛, őΕλ"
    file = export_chart(chart, kind, ACRYLIC, ExportOptions(name=name))
    assert set(name) - {" "} <= pdf_letters(file.content)
    assert file.notes == ()
    (note,) = export_chart(chart, kind, ACRYLIC, ExportOptions(name="毛衣 סוודר")).notes
    assert "毛衣סודר" in note


def test_the_designer_chooses_the_symbols_of_the_chart() -> None:
    """The key shows the same as the chart: one entry for knits, one for purls."""

    def drawn(symbols: Symbols) -> tuple[int, int]:
        style = ChartStyle(symbols=symbols)
        root = ET.fromstring(chart_svg(StitchChart.parse("KKP"), style))  # noqa: S314 - our own
        names = [element.tag.split("}")[1] for element in root.iter()]
        strokes = sum(
            element.get("d", "").count("M")
            for element in root.iter()
            if element.get("stroke") == INK
        )
        return names.count("circle"), strokes

    assert drawn(Symbols.DOTS) == (2, 0)
    assert drawn(Symbols.DASHES) == (0, 2)
    assert drawn(Symbols.JAPANESE) == (0, 5)


@pytest.mark.parametrize("machine", ["swg091n2", "kniterate"])
def test_a_program_begins_at_any_row_after_a_jam(machine: str) -> None:
    chart = StitchChart.parse("KPKKPK\nPPKPKK\nKKPPKP\nKPKPKK")
    layout = DesignLayout(outline="..xxxx\n.xxxxx\nxxxxxx\nxxxxx.", machine=machine)
    options = ExportOptions(layout=layout, from_row=3)
    file = export_chart(chart, ExportKind.KNITOUT, ACRYLIC, options)
    rest = DesignLayout(outline=".xxxx\nxxxxx", machine=machine)
    upper = StitchChart(chart.purl[2:, 1:])
    again = export_chart(upper, ExportKind.KNITOUT, ACRYLIC, ExportOptions(layout=rest))
    assert file.content == again.content
    assert any("hold row 2 on waste yarn" in note for note in file.notes)
    with pytest.raises(InputError, match="no row 5"):
        export_chart(chart, ExportKind.KNITOUT, ACRYLIC, ExportOptions(layout=layout, from_row=5))


def test_a_program_of_other_stitches_begins_where_needles_hold_one_loop() -> None:
    chart = SymbolChart.parse("KKKKKK;KO/\\OK;KVKKTK;KKKKKK;[2/2R]KK")
    file = export_chart(chart, ExportKind.KNITOUT, ACRYLIC, ExportOptions(from_row=3))
    upper = SymbolChart.parse("KKKKKK;KO/\\OK;KVKKTK")
    assert file.content == export_chart(upper, ExportKind.KNITOUT, ACRYLIC).content
    assert any("hold row 2 on waste yarn" in note for note in file.notes)
    for row, problem in ((4, "row 3 tucks or slips.* Begin at row 3"), (6, "no row 6")):
        with pytest.raises(InputError, match=problem):
            export_chart(chart, ExportKind.KNITOUT, ACRYLIC, ExportOptions(from_row=row))


@pytest.mark.parametrize("kind", ["hand-plan-text", "ayab", "punch-card-text"])
def test_files_for_home_machines_follow_the_machine_of_the_design(kind: str) -> None:
    chart = StitchChart.of_fabric("rib", rows=4, columns=8)
    usual = export_chart(chart, kind, ACRYLIC)
    assert usual.notes
    ribber = DesignLayout(machine="brother-ribber")
    own = export_chart(chart, kind, ACRYLIC, ExportOptions(layout=ribber))
    assert (own.content != usual.content) == (kind != "ayab")
    industrial = ExportOptions(layout=DesignLayout(machine="kniterate"))
    with pytest.raises(InputError, match="Kniterate"):
        export_chart(chart, kind, ACRYLIC, industrial)


STITCH_KINDS = [kind for kind, exporter in FORMATS.items() if exporter.write_stitches]
READ_BACK = [ExportKind.TEXT, ExportKind.WRITTEN, ExportKind.KNITSPEAK, ExportKind.DESIGN]
READ_BACK += [ExportKind.PNG]


def with_stitches(chart: SymbolChart, kind: ExportKind, folder: Path) -> SymbolChart:
    file = folder / f"stitches{FORMATS[kind].suffix}"
    file.write_bytes(export_chart(chart, kind, ACRYLIC).content)
    read = read_noted_stitches(file)[0]
    return read if isinstance(read, SymbolChart) else SymbolChart.of(read)


@pytest.mark.parametrize("kind", READ_BACK)
@settings(max_examples=20)
@given(chart=symbol_charts())
def test_any_stitches_are_read_back(
    kind: ExportKind, chart: SymbolChart, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("stitches")
    assert with_stitches(chart, kind, folder) == chart
    assert with_stitches(chart.turn_over(), kind, folder).turn_over() == chart
    assert with_stitches(chart.mirror(), kind, folder).mirror() == chart


@pytest.mark.parametrize("kind", [kind for kind in ExportKind if kind not in STITCH_KINDS])
def test_other_formats_refuse_other_stitches_in_words(kind: ExportKind) -> None:
    chart = SymbolChart.parse("O/;KK")
    with pytest.raises(InputError, match=f"{kind} holds knits and purls only. Export .*text, "):
        export_chart(chart, kind, ACRYLIC)


def test_a_pattern_and_a_report_have_the_size_words_and_symbols_of_all_stitches() -> None:
    mesh = SymbolChart.parse("KKKKKK;KO/\\OK").tile(4, 2)
    options = ExportOptions(name="Mesh")

    def text(options: ExportOptions) -> str:
        drawing = export_chart(mesh, ExportKind.PATTERN_SVG, ACRYLIC, options).content.decode()
        return re.sub(r"(\s|<[^>]*>)+", " ", drawing)

    size = predict(mesh, ACRYLIC)
    width, height = 1.2 * size.relaxed_course_mm, 0.8 * size.relaxed_wale_mm
    for words in (f"{width:.1f} × {height:.1f} cm at rest", "ssk", "yo: yarn over", "yo, ssk"):
        assert words in text(options)
    assert export_chart(mesh, ExportKind.REPORT, ACRYLIC, options).content.startswith(b"%PDF")
    assert report.SOURCES.keys() == set(Source)
    gauged = ExportOptions(gauge=RelaxedSize(5.0, 4.0))
    assert "6.0 × 3.2 cm at rest" in text(gauged)


def test_a_pattern_counts_the_yarn_of_every_stitch_as_predict_does() -> None:
    slipped = SymbolChart.parse("VK;KK").tile(5, 6)
    plain = SymbolChart.parse("KK;KK").tile(5, 6)
    metres = []
    for chart in (slipped, plain):
        drawing = export_chart(chart, ExportKind.PATTERN_SVG, ACRYLIC).content.decode()
        text = re.sub(r"(\s|<[^>]*>)+", " ", drawing)
        metres.append(float(re.findall(r"In all ([\d.]+) m", text)[0]))
        mean, _ = mean_yarn(chart, ACRYLIC)
        assert metres[-1] == pytest.approx(mean * chart.cells.size / 1000, rel=5e-3)
    assert metres[0] < 0.85 * metres[1]


def test_a_solid_of_other_stitches_has_a_closed_tube_for_every_row() -> None:
    rope = SymbolChart.parse("P[2/2R]P;PKKKKP;PKKKKP")
    content = export_chart(rope, ExportKind.STL, ACRYLIC).content
    solid = trimesh.load(io.BytesIO(content), file_type="stl")
    assert solid.body_count == 3
    assert solid.is_watertight


def test_a_shaped_chart_of_other_stitches_is_refused() -> None:
    options = ExportOptions(layout=DesignLayout(outline=".x\nxx"))
    with pytest.raises(InputError, match="outline: a chart with lace"):
        export_chart(SymbolChart.parse("O/;KK"), ExportKind.TEXT, ACRYLIC, options)


@pytest.mark.parametrize("symbols", Symbols)
@given(chart=symbol_charts(most_columns=60))
@settings(max_examples=10)
def test_every_drawing_names_its_stitches(symbols: Symbols, chart: SymbolChart) -> None:
    pages = chart_pages(chart.tile(3, 2), ChartStyle(symbols=symbols))
    labels = {shape.text for page in pages for shape in page.shapes if isinstance(shape, Label)}
    kinds = {chart.stitch(*cell) for cell in np.ndindex(chart.cells.shape)}
    if len(kinds) <= KINDS_WITH_NAMES and not chart.is_plain:
        assert all(any(text.startswith(f"{s.name}: ") for text in labels) for s in kinds)


def test_a_cable_at_the_edge_of_a_page_is_cut_there() -> None:
    rope = SymbolChart.parse("P[3/3R]P;PKKKKKKP").tile(8, 12)
    _, *pages = chart_pages(rope)
    for page in pages:
        box = next(s for s in page.shapes if isinstance(s, Rectangle) and s.fill == "#ffffff")
        drawn = [s for s in page.shapes if isinstance(s, Lines) and s.stroke == INK]
        ends = [
            x for s in drawn for line in s.lines for x in line[::2] if line[1] < box.y + box.height
        ]
        assert box.x - 1e-9 <= min(ends) <= max(ends) <= box.x + box.width + 1e-9
