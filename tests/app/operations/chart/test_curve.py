from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.context import Context
from app.operations.chart.curve import CurveRequest, curve
from knitcore.base.errors import CancelledError
from tests.app.command_line import refused, run


@pytest.mark.slow
def test_a_wide_rib_is_learned_and_ones_own_gauge_counts(
    client: TestClient, tmp_path: Path
) -> None:
    body = {"material": "acrylic", "direction": "course", "stress_n_per_mm": [0.05, 0.1]}
    narrow = client.post("/api/v1/curve", json=body | {"chart": "KP"}).json()
    wide = client.post("/api/v1/curve", json=body | {"chart": "KKPP"}).json()
    assert wide["strain"] != narrow["strain"]
    assert wide["provenance"] == "learned"

    chart = tmp_path / "rib.txt"
    chart.write_text("KKPP")
    arguments = [str(chart), "--material", "acrylic", "--direction", "course"]
    tight = ["--stitches-per-10-cm", "70", "--rows-per-10-cm", "35"]
    own = run("curve", *arguments, *tight, "--max-stress", "0.1", "--points", "3")
    assert own["strain"][-1] > wide["strain"][-1]
    assert "rows-per-10-cm" in refused("curve", *arguments, *tight[:2])


def test_the_prediction_takes_the_gauge_too(client: TestClient) -> None:
    gauge = {"stitches_per_10_cm": 70, "rows_per_10_cm": 35}
    body = {"chart": "KKPP", "material": "acrylic", "gauge": gauge}
    shown = client.post("/api/v1/predict", json=body).json()
    assert shown["relaxed_course_mm"] == pytest.approx(100 / 70)
    assert shown["relaxed_source"] == "gauge"
    low, high = shown["modulus_course_interval_n_per_mm"]
    assert low < shown["modulus_course_n_per_mm"] < high
    problem = client.post("/api/v1/predict", json=body | {"gauge": {"rows_per_10_cm": 3}}).json()
    assert problem["field"] == "gauge.stitches_per_10_cm"


def test_an_abandoned_curve_is_not_computed(tmp_path: Path) -> None:
    body = {"chart": "KKPP", "material": "acrylic", "direction": "course"}
    with pytest.raises(CancelledError):
        curve(CurveRequest.model_validate(body), Context(tmp_path, cancelled=lambda: True))
