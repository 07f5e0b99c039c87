"""One chart and one material: the same numbers wherever they are asked for."""

import base64
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
from fastapi.testclient import TestClient
from numpy.typing import NDArray

from app.context import Context
from app.operations.chart.predict import PredictRequest
from app.operations.chart.predict import predict as predict_operation
from app.requests.fabrics import GaugeInput
from knitcore import Direction, Fabric, RelaxedSize, StitchChart, curve, predict, strip_test
from knitcore.design.atlas import STRESS_N_PER_MM, Atlas
from knitcore.design.atlas_build import build_atlas
from knitcore.draw.laid_out import laid_corners_mm, mean_stitch_mm
from knitcore.formats.designs.layout import DesignRegion
from knitcore.formats.write import report
from knitcore.formats.write.chart_key import ChartStyle
from knitcore.formats.write.drawn_page import Label, Page
from knitcore.formats.write.pattern import pattern_pages
from knitcore.formats.write.stitch_values import write_vtu
from knitcore.formats.write.yarn_mesh import course_centre_lines
from knitcore.garment.glove import Hand, glove
from knitcore.garment.piece import Piece
from knitcore.garment.shaped import ShapedChart, outline_marks
from knitcore.materials import Interval, Material, material
from knitcore.prediction.prediction import Prediction
from knitcore.yarn.library.store import stored_charts
from scripts.any_machine import OTHERS, SIZES, difference
from tests.app.command_line import run
from tests.app.rest import post, solid

LOADS = [0.01, 0.05, 0.2]


def _charts() -> dict[str, StitchChart]:
    """Every stored repeat, the pure fabrics, ribs, welts and random charts, each shown twice."""
    rng = np.random.default_rng(14)
    ribs = [StitchChart.parse("K" * k + "P" * p) for k in (2, 4, 5, 7) for p in (1, 2, 5)]
    pure = [StitchChart.of_fabric(fabric, 2, 2) for fabric in Fabric]
    random = [
        StitchChart(rng.random((int(rng.integers(2, 7)), int(rng.integers(2, 7)))) < 0.5)
        for _ in range(100)
    ]
    welts = [StitchChart(rib.purl.T) for rib in ribs]
    charts = [*pure, *stored_charts("acrylic"), *ribs, *welts, *random]
    return {chart.key: chart.tile(2, 2) for chart in charts}


CHARTS = _charts()
ALL = list(CHARTS.values())
MANY, FEW, SOME = ALL[::3], ALL[::12], ALL[::60]

in_yarns = pytest.mark.parametrize(
    ("yarn", "charts"),
    [
        *((yarn, SOME) for yarn in ("acrylic", "glove-wool", "lace-bamboo")),
        *(
            pytest.param(yarn, charts, marks=pytest.mark.slow)
            for yarn, charts in (("acrylic", MANY), ("acrylic:simulation", FEW), ("cotton", FEW))
        ),
    ],
    ids=lambda given: given if isinstance(given, str) else f"{len(given)} charts",
)


@in_yarns
def test_all_ways_of_asking_give_one_answer(
    client: TestClient,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    yarn: str,
    charts: list[StitchChart],
) -> None:
    """Library, operation, command line, REST, report, atlas and the files of stitches."""
    used, file = material(yarn), tmp_path / "chart.txt"
    atlas = build_atlas(used, [chart.canonical() for chart in charts])
    for chart in charts:
        answer, body = predict(chart, used), {"chart": chart.text, "material": yarn}
        request = PredictRequest.model_validate(body)
        result = predict_operation(request, Context(Path())).model_dump(mode="json")
        _agrees_with_library(result, answer)
        _agrees_with_atlas(atlas, chart, answer)
        _agrees_with_report(_report(chart, yarn, monkeypatch), answer)
        _agrees_with_files(chart, used, answer)
        file.write_text(chart.text)
        assert run("predict", file, "--material", yarn) == result
        assert client.post("/api/v1/predict", json=body).json() == result


@in_yarns
@pytest.mark.parametrize("direction", Direction)
def test_all_ways_of_asking_give_one_curve(
    client: TestClient, tmp_path: Path, yarn: str, charts: list[StitchChart], direction: Direction
) -> None:
    """Library, command line and REST."""
    used, file = material(yarn), tmp_path / "chart.txt"
    for chart in charts:
        own = curve(chart, used, direction, LOADS)
        body = {"chart": chart.text, "material": yarn, "direction": direction}
        served = post(client, "curve", body | {"stress_n_per_mm": LOADS})
        assert served["strain"] == own.strain.tolist()
        assert served["strain_interval"] == np.array([own.strain_low, own.strain_high]).tolist()
        ends = np.array([own.stress_low, own.stress_high])
        assert served["stress_interval_n_per_mm"] == ends.tolist()
        file.write_text(chart.text)
        shown = run(
            "curve", file, "--material", yarn, "--direction", direction,
            "--max-stress", LOADS[-1], "--points", 2,
        )  # fmt: skip
        assert shown["strain"][-1] == pytest.approx(own.strain[-1])


def _agrees_with_library(result: Any, answer: Prediction) -> None:
    assert result["provenance"] == answer.provenance
    for direction in Direction:
        along = answer.along(direction)
        interval, size = along.modulus_interval_n_per_mm, along.relaxed_interval_mm
        assert result[f"modulus_{direction}_n_per_mm"] == along.modulus_n_per_mm
        assert result[f"modulus_{direction}_interval_n_per_mm"] == [interval.low, interval.high]
        assert interval.low < along.modulus_n_per_mm < interval.high
        assert result[f"relaxed_{direction}_mm"] == along.relaxed_mm
        assert result[f"relaxed_{direction}_interval_mm"] == [size.low, size.high]
        assert size.low < along.relaxed_mm < size.high
        low, high = result[f"modulus_{direction}_bounds_n_per_mm"]
        assert low <= along.modulus_n_per_mm <= high


def _agrees_with_atlas(atlas: Atlas, chart: StitchChart, answer: Prediction) -> None:
    """The curves of an atlas are kept in single precision."""
    row = atlas.index_of(chart)
    assert row is not None
    assert atlas.provenance[row] == answer.provenance
    for direction in Direction:
        along = answer.along(direction)
        modulus = atlas.column(f"modulus_{direction}_n_per_mm")[row]
        assert modulus == pytest.approx(along.modulus_n_per_mm, rel=1e-7)
        size = atlas.column(f"relaxed_{direction}_mm")[row]
        assert size == pytest.approx(along.relaxed_mm, rel=1e-7)
        for kind, strain in enumerate((along.strain, along.across_strain, along.held_strain)):
            np.testing.assert_allclose(
                atlas.curves[row, kind, direction.axis], strain(STRESS_N_PER_MM), rtol=1e-5
            )


def _agrees_with_report(labels: set[str], answer: Prediction) -> None:
    """Figures are printed with three digits."""
    assert any(report.SOURCES[answer.provenance] in label for label in labels)
    for direction in Direction:
        along = answer.along(direction)
        for value, interval in (
            (along.modulus_n_per_mm, along.modulus_interval_n_per_mm),
            (along.relaxed_mm, along.relaxed_interval_mm),
        ):
            assert _with_interval(value, interval) in labels


def _agrees_with_files(chart: StitchChart, used: Material, answer: Prediction) -> None:
    """The cloth of VTU, glTF and STL is as large as its stitches together."""
    piece = Piece.of(chart)
    stitch = np.array([answer.along(direction).relaxed_mm for direction in Direction])
    corners = laid_corners_mm(piece.shaped, used)
    width, height = (np.diff(corners[..., k], axis=1 - k).mean() for k in (0, 1))
    np.testing.assert_allclose([width, height], stitch, rtol=0.02)
    lines = course_centre_lines(chart, np.pad(corners, ((0, 0), (0, 0), (0, 1))), used)
    ends = [line[-1, 0] - line[0, 0] for line in lines]
    assert np.mean(ends) == pytest.approx(chart.columns * stitch[0], rel=0.02)
    np.testing.assert_allclose(mean_stitch_mm(piece.shaped, used), stitch, rtol=1e-12)


def test_a_glove_has_one_size_wherever_it_is_told(
    client: TestClient, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """REST, pattern, report and the files of its stitches; a counted gauge scales it."""
    wool = material("glove-wool")
    shaped = glove(Hand(), wool).shaped
    body = {"chart": shaped.chart.text, "outline": shaped.outline, "material": "glove-wool"}
    result = post(client, "predict", body)
    for side in ("width", "height"):
        low, high = result[f"{side}_interval_mm"]
        assert low < result[f"{side}_mm"] < high

    pages = pattern_pages(Piece.plain(shaped), wool, ChartStyle())
    for texts in (_texts(pages), _report(shaped, "glove-wool", monkeypatch)):
        assert any(_in_cm(result) in text for text in texts)
    size = _size_mm(write_vtu(Piece.plain(shaped), wool), tmp_path)
    np.testing.assert_allclose(size, [result["width_mm"], result["height_mm"]])

    gauge = {"stitches_per_10_cm": 20, "rows_per_10_cm": 30}
    counted = post(client, "predict", body | {"gauge": gauge})
    mean = mean_stitch_mm(shaped, wool)
    assert counted["width_mm"] == pytest.approx(result["width_mm"] * 5 / mean[0])


@pytest.mark.parametrize("outline", [None, "\n".join(["..xxxxxxxx.."] * 4 + ["x" * 12] * 8)])
def test_files_and_pages_have_the_size_of_a_known_gauge(
    client: TestClient, outline: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    chart, acrylic = StitchChart.parse("KKPP/PPKK").resized(12, 12), material("acrylic")
    body = {
        "chart": chart.text,
        "outline": outline,
        "material": "acrylic",
        "gauge": {"stitches_per_10_cm": 20, "rows_per_10_cm": 30, "known_by": "relaxation"},
    }
    result = post(client, "predict", body)
    made = base64.b64decode(post(client, "export", body | {"to": "vtu"})["content"])
    size = [result["width_mm"], result["height_mm"]]
    np.testing.assert_allclose(_size_mm(made, tmp_path), size, rtol=0.02)

    shaped = ShapedChart.rectangle(chart)
    if outline is not None:
        shaped = ShapedChart(chart, outline_marks(outline))
    piece = replace(Piece.plain(shaped), gauge=GaugeInput(**body["gauge"]).relaxed_size())
    pages = pattern_pages(piece, acrylic, ChartStyle())
    for texts in (_texts(pages), _report(piece, "acrylic", monkeypatch)):
        assert any(_in_cm(result) in text for text in texts)


GAUGED = {
    "chart": {"fabric": "garter", "columns": 12, "rows": 12},
    "material": "acrylic",
    "gauge": {"stitches_per_10_cm": 20, "rows_per_10_cm": 30},
}
GIRTHS = [{"at_mm": 0, "girth_mm": 60}, {"at_mm": 40, "girth_mm": 61}]


def test_a_counted_piece_has_its_size_flat_unpinned_hanging_pulled_worn_and_in_3d(
    client: TestClient,
) -> None:
    """12 stitches of 5 mm and 12 rows of 3.3 mm; a strip of the cloth weighs accordingly."""
    yarn = {"linear_density_g_per_m": 0.5}
    lying, hanging = post(client, "curl", GAUGED), post(client, "hang", GAUGED | yarn)
    pulled = post(client, "stretch", GAUGED | {"direction": "wale", "strain": 0.1, "steps": 1})
    worn = post(client, "limb", GAUGED | {"girths": GIRTHS})
    for size in (
        (lying["flat_width_mm"], lying["flat_height_mm"]),
        (hanging["width_mm"], hanging["drop_mm"] / (1 + hanging["lengthening"])),
        (pulled["width_mm"], pulled["length_mm"]),
        (worn["places"][0]["rest_mm"], worn["relaxed_length_mm"]),
    ):
        assert size == pytest.approx((60, 40), rel=0.01)
    large = GAUGED | {"chart": {"fabric": "garter", "columns": 40, "rows": 60}}
    np.testing.assert_allclose(1000 * solid(client, large).extents[:2], 200, rtol=0.03)
    strip = GAUGED | yarn | {"chart": "K/P"}
    counted, plain = (
        post(client, "overhang", body)["weight_g_per_m2"]
        for body in (strip, strip | {"gauge": None})
    )
    record = material("acrylic").record(Fabric.GARTER)
    area = record.stitch_course_mm * record.stitch_wale_mm
    assert counted == pytest.approx(plain * (area / (5 * 100 / 30)) ** 0.5)


@pytest.mark.parametrize(
    ("name", "more", "options"),
    [
        ("curl", {}, ()),
        ("hang", {"linear_density_g_per_m": 0.5}, ("--linear-density-g-per-m", 0.5)),
        ("limb", {"girths": GIRTHS}, ("--girth", "0:60", "--girth", "40:61")),
    ],
)
def test_a_gauge_counts_alike_over_rest_and_on_the_command_line(
    client: TestClient, name: str, more: dict[str, Any], options: tuple[str | float, ...]
) -> None:
    served = post(client, name, GAUGED | more)
    gauge = "--stitches-per-10-cm", 20, "--rows-per-10-cm", 30
    shown = run(name, "garter", "--size", "12x12", "--material", "acrylic", *options, *gauge)
    sizes, others, where = difference(served, shown)
    assert (sizes <= SIZES, others <= OTHERS) == (True, True), where


def test_the_border_of_a_counted_piece_is_said_to_be_uncounted(client: TestClient) -> None:
    body = GAUGED | {"chart": "K/P", "border": "seed", "linear_density_g_per_m": 0.5}
    assert any("nobody has counted" in note for note in post(client, "border", body)["notes"])
    plain = post(client, "border", body | {"gauge": None})
    assert not any("counted" in note for note in plain["notes"])


KNOWN = RelaxedSize.from_gauge(stitches_per_10_cm=24, rows_per_10_cm=36)
MIXED = ("KKPP", "K/K/P/P", "KP/KK", "KKPP/KKPP/PPKK/PPKK", "KP/PK")


@pytest.mark.parametrize(
    ("yarn", "text", "gauge"),
    [
        *((yarn, text, None) for yarn in ("acrylic", "cotton") for text in MIXED),
        *(("acrylic", text, KNOWN) for text in ("K", "KP/PK", "KKPP")),
    ],
)
@pytest.mark.parametrize("direction", Direction)
def test_a_long_free_strip_stretches_like_its_curve(
    yarn: str, text: str, gauge: RelaxedSize | None, direction: Direction
) -> None:
    """Ends that slide; within 10 % of the strain at each stress, and as large as its stitches."""
    chart, used = StitchChart.parse(text).resized(12, 32), material(yarn)
    answer = predict(chart, used, gauge)
    along, across = answer.along(direction), answer.along(direction.other)
    strains = along.strain([0.05, 0.1, 0.2])
    test = strip_test(chart, used, direction, strains.tolist(), clamps="sliding", size=gauge)
    np.testing.assert_allclose(along.strain(test.stress_n_per_mm), strains, rtol=0.1)
    area = 12 * 32 * along.relaxed_mm * across.relaxed_mm
    assert test.length_mm * test.width_mm == pytest.approx(area, rel=1e-6 if gauge else 0.03)


@pytest.mark.parametrize("fill", [None, "KKPP"])
def test_a_region_of_a_report_says_what_is_predicted_of_it(
    fill: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ribs left, garter right: as a region and its rest, with a repeat or without one."""
    rib, garter = StitchChart.parse("KKPP").resized(12, 16), StitchChart.of_fabric("garter", 12, 8)
    chart = StitchChart(np.hstack([rib.purl, garter.purl]))
    region = DesignRegion(
        id="r", name="ribs", colour="#336699", fill=fill, runs=[(row, 0, 16) for row in range(12)]
    )
    written = _report(chart, "acrylic", monkeypatch, region)
    for part in (rib if fill is None else StitchChart.parse(fill), garter):
        for direction in Direction:
            along = predict(part, material("acrylic")).along(direction)
            shown = _with_interval(along.modulus_n_per_mm, along.modulus_interval_n_per_mm)
            assert shown in written


def _in_cm(result: dict[str, float]) -> str:
    return f"{result['width_mm'] / 10:.1f} × {result['height_mm'] / 10:.1f} cm at rest"


def _size_mm(vtu: bytes, folder: Path) -> NDArray[np.float64]:
    """Width and height of the cloth in a file of stitches."""
    file = folder / "cloth.vtu"
    file.write_bytes(vtu)
    mesh = meshio.read(file)
    points = mesh.points[np.unique(mesh.cells_dict["quad"])]
    size: NDArray[np.float64] = np.ptp(points[:, :2], axis=0)
    return size


def _with_interval(value: float, interval: Interval) -> str:
    return f"{value:.3g}  ({interval.low:.3g} to {interval.high:.3g})"


def _report(
    chart: StitchChart | ShapedChart | Piece,
    yarn: str,
    monkeypatch: pytest.MonkeyPatch,
    *regions: DesignRegion,
) -> set[str]:
    """All that is written on the pages of the report."""
    pages: list[Page] = []
    monkeypatch.setattr(report, "to_pdf", lambda drawn, _title: pages.extend(drawn) or b"")
    piece = chart if isinstance(chart, Piece) else Piece.plain(chart)
    report.design_report(piece, material(yarn), "One", ChartStyle(), regions)
    return _texts(pages)


def _texts(pages: Iterable[Page]) -> set[str]:
    return {shape.text for page in pages for shape in page.shapes if isinstance(shape, Label)}
