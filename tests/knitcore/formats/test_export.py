from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable
from pathlib import Path
from xml.etree import ElementTree as ET

import meshio
import numpy as np
import pytest
import trimesh
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from knitcore import InputError, StitchChart
from knitcore.fabric import Direction
from knitcore.formats import report
from knitcore.formats.chart_drawing import ChartStyle, chart_pdf, chart_svg
from knitcore.formats.chart_files import read_chart
from knitcore.formats.drawing import Box, Label, Page
from knitcore.formats.export import SUFFIXES, ExportKind, export_chart
from knitcore.formats.yarn_mesh import MAXIMUM_STITCHES, yarn_mesh, yarn_radius_mm
from knitcore.materials import material
from knitcore.mechanics.local import local_moduli
from knitcore.worked import Construction
from tests.knitcore.charts import stitch_charts

ACRYLIC = material("acrylic")
CHEAP = (ExportKind.TEXT, ExportKind.PNG, ExportKind.WRITTEN, ExportKind.DESIGN)


def round_trip(chart: StitchChart, kind: ExportKind, folder: Path) -> StitchChart:
    file = folder / f"chart{SUFFIXES[kind][0]}"
    file.write_bytes(export_chart(chart, kind, ACRYLIC).content)
    return read_chart(file)


@pytest.mark.parametrize("kind", CHEAP)
@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(chart=stitch_charts())
def test_round_trips_are_identities(kind: ExportKind, chart: StitchChart, tmp_path: Path) -> None:
    assert round_trip(chart, kind, tmp_path) == chart


@pytest.mark.parametrize("kind", CHEAP)
@settings(
    max_examples=2, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(seed=st.integers(0, 2**32 - 1), rows=st.integers(150, 200), columns=st.integers(150, 200))
def test_round_trips_of_large_charts(
    kind: ExportKind, seed: int, rows: int, columns: int, tmp_path: Path
) -> None:
    chart = StitchChart(np.random.default_rng(seed).random((rows, columns)) < 0.5)
    assert round_trip(chart, kind, tmp_path) == chart


def test_knitout_is_read_from_a_file(tmp_path: Path) -> None:
    chart = StitchChart.parse("KPP\nKKP")
    assert round_trip(chart, ExportKind.KNITOUT, tmp_path) == chart


@pytest.mark.parametrize("kind", list(ExportKind))
def test_the_same_chart_gives_the_same_bytes(kind: ExportKind) -> None:
    chart = StitchChart.parse("KPK\nPKP")
    first, again = (export_chart(chart, kind, ACRYLIC).content for _ in range(2))
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


def test_a_drawing_tells_sides_repeat_and_key() -> None:
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


def test_a_large_chart_is_printed_on_several_pages() -> None:
    small = chart_pdf(StitchChart.of_fabric("seed", rows=40, columns=40))
    large = chart_pdf(StitchChart.of_fabric("seed", rows=200, columns=200))
    count = [content.count(b"/Type /Page\n") for content in (small, large)]
    assert small.startswith(b"%PDF-")
    assert count[0] == 1
    assert count[1] >= 6


@pytest.mark.parametrize("aspect", [0.0, float("nan"), 9.0])
def test_stitches_have_a_shape(aspect: float) -> None:
    with pytest.raises(InputError, match="shape of a stitch"):
        ChartStyle(aspect=aspect)


@pytest.mark.parametrize(("kind", "unit"), [(ExportKind.GLB, 0.001), (ExportKind.STL, 1.0)])
def test_the_yarn_is_a_solid_of_its_length(kind: ExportKind, unit: float, tmp_path: Path) -> None:
    chart = StitchChart.parse("KPKK\nPPKP\nKKKP")
    file = tmp_path / f"yarn.{kind}"
    file.write_bytes(export_chart(chart, kind, ACRYLIC).content)
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
    side = int(MAXIMUM_STITCHES**0.5) + 1
    with pytest.raises(InputError, match="too many"):
        yarn_mesh(StitchChart.of_fabric("rib", side, side), ACRYLIC)


def test_values_of_every_stitch(tmp_path: Path) -> None:
    chart = StitchChart.parse("KPKK\nPPKP")
    local = local_moduli(chart, ACRYLIC)
    lines = list(
        csv.DictReader(io.StringIO(export_chart(chart, ExportKind.CSV, ACRYLIC).content.decode()))
    )
    assert [line["stitch"] for line in lines] == list("PPKPKPKK")
    extensibility = [float(line["extensibility_wale_mm_per_n"]) for line in lines]
    table = local.table.extensibility_mm_per_n(Direction.WALE)[local.codes]
    assert extensibility == pytest.approx(table.ravel().tolist(), rel=1e-5)

    file = tmp_path / "chart.vtu"
    file.write_bytes(export_chart(chart, ExportKind.VTU, ACRYLIC).content)
    mesh = meshio.read(file)
    assert mesh.cells_dict["quad"].shape == (8, 4)
    assert mesh.cell_data["modulus_course_n_per_mm"][0] == pytest.approx(
        local.modulus_course_n_per_mm.ravel()
    )


@pytest.mark.parametrize(
    ("chart", "pages"),
    [
        (StitchChart.of_fabric("garter", rows=31, columns=31), 2),
        (StitchChart(np.random.default_rng(0).random((60, 70)) < 0.5), 3),
    ],
    ids=["with curves", "patchwork"],
)
def test_a_report_has_numbers_and_the_chart(chart: StitchChart, pages: int) -> None:
    content = export_chart(chart, ExportKind.REPORT, ACRYLIC).content
    assert content.startswith(b"%PDF-")
    assert content.count(b"/Type /Page\n") == pages


def test_a_report_tells_its_numbers_with_their_source(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[Page] = []

    def keep(pages: Iterable[Page], _: str) -> bytes:
        drawn.extend(pages)
        return b""

    monkeypatch.setattr(report, "to_pdf", keep)
    chart = StitchChart.of_fabric("garter", rows=5, columns=5)
    report.design_report(chart, ACRYLIC, "Cuff", ChartStyle())
    words = " ".join(shape.text for shape in drawn[0].shapes if isinstance(shape, Label))
    assert "Cuff" in words
    assert "0.223  (" in words
    assert "Source: measured" in words
    assert "Shear modulus 0.01 N/mm: an assumption" in words
    inside = [s for s in drawn[0].shapes if isinstance(s, Box)]
    assert all(0 <= b.x <= 210 and b.y + b.height <= 297 for b in inside)
