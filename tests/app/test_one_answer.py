"""One chart and one material: the same numbers wherever they are asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.operations.context import Context
from app.operations.predict import PredictRequest
from app.operations.predict import predict as predict_operation
from knitcore import Direction, Fabric, StitchChart, curve, predict, strip_test
from knitcore.design.atlas import STRESS_N_PER_MM
from knitcore.design.atlas_build import build_atlas
from knitcore.design.targets import Limb, Quantity, Target, values_of
from knitcore.formats import report
from knitcore.formats.chart_key import ChartStyle
from knitcore.formats.drawing import Label, Page
from knitcore.materials import material
from knitcore.yarnlibrary.store import stored_charts
from tests.app.command_line import run

LOADS = [0.01, 0.05, 0.2]


def _charts() -> dict[str, StitchChart]:
    """Every stored repeat, the pure fabrics, ribs, welts and random charts, each shown twice."""
    rng = np.random.default_rng(14)
    found = [StitchChart.of_fabric(fabric, 2, 2) for fabric in Fabric]
    found += stored_charts("acrylic")
    found += [StitchChart.parse("K" * k + "P" * p) for k in (2, 4, 5, 7) for p in (1, 2, 5)]
    found += [StitchChart(rib.purl.T) for rib in found[-12:]]
    found += [
        StitchChart(rng.random((int(rng.integers(2, 7)), int(rng.integers(2, 7)))) < 0.5)
        for _ in range(100)
    ]
    return {chart.key: chart.tile(2, 2) for chart in found}


CHARTS = _charts()
SOME = [*list(CHARTS)[:6], *list(CHARTS)[60::40]]


@pytest.mark.parametrize(
    "yarn",
    [
        "acrylic",
        "acrylic:simulation",
        *(pytest.param(yarn, marks=pytest.mark.slow) for yarn in ("cotton", "lace-bamboo")),
    ],
)
def test_library_operations_and_atlas_give_one_answer(yarn: str) -> None:
    used, charts = material(yarn), list(CHARTS.values())
    atlas = build_atlas(used, [chart.canonical() for chart in charts])
    for chart in charts:
        answer, told = predict(chart, used), _operation(chart, yarn)
        row = atlas.index_of(chart)
        assert row is not None
        for direction in Direction:
            along = answer.along(direction)
            interval = along.modulus_interval_n_per_mm
            assert told[f"modulus_{direction}_n_per_mm"] == along.modulus_n_per_mm
            assert told[f"modulus_{direction}_interval_n_per_mm"] == [interval.low, interval.high]
            assert told[f"relaxed_{direction}_mm"] == along.relaxed_mm
            assert interval.low < along.modulus_n_per_mm < interval.high
            size = along.relaxed_interval_mm
            assert size.low < along.relaxed_mm < size.high
            bounds = told[f"modulus_{direction}_bounds_n_per_mm"]
            assert bounds[0] <= along.modulus_n_per_mm <= bounds[1]
            kept = atlas.column(f"modulus_{direction}_n_per_mm")[row]
            assert kept == pytest.approx(along.modulus_n_per_mm, rel=1e-7)
            assert atlas.column(f"relaxed_{direction}_mm")[row] == pytest.approx(
                along.relaxed_mm, rel=1e-7
            )
            for kind, own in enumerate((along.strain, along.across_strain, along.held_strain)):
                np.testing.assert_allclose(
                    atlas.curves[row, kind, direction.axis], own(STRESS_N_PER_MM), rtol=1e-5
                )
        assert told["provenance"] == answer.provenance == atlas.provenance[row]


@pytest.mark.parametrize("key", SOME)
@pytest.mark.parametrize("yarn", ["acrylic", "glove-wool"])
def test_command_line_rest_and_report_give_the_same(
    client: TestClient, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, key: str, yarn: str
) -> None:
    chart, used = CHARTS[key], material(yarn)
    answer, told = predict(chart, used), _operation(chart, yarn)
    file = tmp_path / "chart.txt"
    file.write_text(chart.text)
    body = {"chart": chart.text, "material": yarn}
    assert run("predict", str(file), "--material", yarn) == told
    assert client.post("/api/v1/predict", json=body).json() == told
    for direction in Direction:
        own = curve(chart, used, direction, LOADS)
        asked = body | {"direction": direction, "stress_n_per_mm": LOADS}
        served = client.post("/api/v1/curve", json=asked).json()
        assert served["strain"] == own.strain.tolist()
        ends = [own.strain_low.tolist(), own.strain_high.tolist()]
        assert served["strain_interval"] == ends
        ends = [own.stress_low.tolist(), own.stress_high.tolist()]
        assert served["stress_interval_n_per_mm"] == ends
        shown = run(
            "curve", str(file), "--material", yarn, "--direction", str(direction),
            "--max-stress", "0.2", "--points", "2",
        )  # fmt: skip
        assert shown["strain"][-1] == pytest.approx(own.strain[-1])
    labels = _report(chart, yarn, monkeypatch)
    for direction in Direction:
        along = answer.along(direction)
        interval = along.modulus_interval_n_per_mm
        modulus = f"{along.modulus_n_per_mm:.3g}  ({interval.low:.3g} to {interval.high:.3g})"
        assert modulus in labels
        size = along.relaxed_interval_mm
        assert f"{along.relaxed_mm:.3g}  ({size.low:.3g} to {size.high:.3g})" in labels
    assert any(str(answer.provenance) in label for label in labels)


@pytest.mark.parametrize("yarn", ["acrylic", "cotton"])
@pytest.mark.parametrize("text", ["KKPP", "K/K/P/P", "KP/KK", "KKPP/KKPP/PPKK/PPKK", "KP/PK"])
@pytest.mark.parametrize("direction", Direction)
def test_a_long_free_strip_stretches_like_its_curve(
    yarn: str, text: str, direction: Direction
) -> None:
    """Ends that slide; within 10 % of the strain at each stress."""
    chart = StitchChart.parse(text).resized(12, 32)
    along = predict(chart, material(yarn)).along(direction)
    strains = along.strain([0.05, 0.1, 0.2])
    test = strip_test(chart, material(yarn), direction, strains.tolist(), clamps="sliding")
    np.testing.assert_allclose(along.strain(test.stress_n_per_mm), strains, rtol=0.1)
    across = predict(chart, material(yarn)).along(direction.other)
    area = 12 * 32 * along.relaxed_mm * across.relaxed_mm
    assert test.length_mm * test.width_mm == pytest.approx(area, rel=0.03)


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("fabric", Fabric)
def test_a_target_pressure_agrees_with_the_pressure_command(
    fabric: Fabric, direction: Direction
) -> None:
    """The laws of every day, a tube a quarter wider on the limb; within 1 %."""
    chart = StitchChart.of_fabric(fabric, 2, 2)
    atlas = build_atlas(material("acrylic"), [chart.canonical()])
    told = run(
        "pressure", "--material", "acrylic", "--fabric", str(fabric),
        "--direction", str(direction), "--rest-mm", "200", "--worn-mm", "250",
    )  # fmt: skip
    middle = float(np.sqrt(np.prod(told["mmhg"])))
    target = Target(Quantity(f"pressure_{direction}_mmhg"), middle, limb=Limb(200.0, 250.0))
    value, _, _ = values_of(atlas, target)
    assert value[0] == pytest.approx(middle, rel=0.01)


def _operation(chart: StitchChart, yarn: str) -> Any:
    request = PredictRequest.model_validate({"chart": chart.text, "material": yarn})
    return predict_operation(request, Context(Path())).model_dump(mode="json")


def _report(chart: StitchChart, yarn: str, monkeypatch: pytest.MonkeyPatch) -> set[str]:
    """All that is written on the pages of the report."""
    pages: list[Page] = []
    monkeypatch.setattr(report, "to_pdf", lambda drawn, _title: pages.extend(drawn) or b"")
    report.design_report(chart, material(yarn), "One", ChartStyle())
    return {shape.text for page in pages for shape in page.shapes if isinstance(shape, Label)}
