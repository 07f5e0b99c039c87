"""``measure photos`` and ``measure marks`` on the command line and over REST."""

import base64
import json
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.requests.uploads import EXAMPLES
from tests.app.command_line import run
from tests.app.rest import post, refusal, upload

PHOTOS = [EXAMPLES / "swatch-rest.jpg", EXAMPLES / "swatch-500g.jpg"]
OPTIONS = (
    "--load-g", "0", "--load-g", "500", "--fabric", "stockinette", "--direction", "wale",
    "--stitches-per-10-cm", "20", "--rows-per-10-cm", "28", "--clamped-width-mm", "110",
)  # fmt: skip
BODY = {
    "images": [upload(photo) for photo in PHOTOS],
    "loads_g": [0, 500],
    "fabric": "stockinette",
    "direction": "wale",
    "stitches_per_10_cm": 20,
    "rows_per_10_cm": 28,
    "clamped_width_mm": 110,
}


@pytest.mark.slow
def test_photos_give_a_point_of_the_stretch_curve(client: TestClient, tmp_path: Path) -> None:
    out = tmp_path / "points.json"
    result = run("measure", "photos", *PHOTOS, *OPTIONS, "--out", out)
    (point,) = result["points"]
    assert point["strain_along"] == pytest.approx(0.3, abs=0.01)
    assert point["strain_across"] == pytest.approx(-0.12, abs=0.01)
    assert [photo["scale"] for photo in result["photos"]] == ["sheet", "sheet"]
    assert json.loads(out.read_text()) == result["points"]
    assert post(client, "measure/photos", BODY) == result


def test_a_photo_that_cannot_serve_is_named(client: TestClient) -> None:
    answer = refusal(client, "measure/photos", BODY | {"coin_mm": 23.25})
    assert answer["field"] == "swatch-rest.jpg"
    assert "round thing" in answer["detail"]
    assert "loads_g" in str(refusal(client, "measure/photos", BODY | {"loads_g": [500]}))


def test_the_sheet_of_marks_is_a_file(client: TestClient, tmp_path: Path) -> None:
    sheet = client.get("/api/v1/measure/marks").json()
    assert base64.b64decode(sheet["content"]).startswith(b"%PDF")
    for suffix in ("svg", "pdf"):
        out = tmp_path / f"marks.{suffix}"
        facts = run("measure", "marks", "--out", out)
        assert out.stat().st_size == facts["bytes"]
        assert facts["kind"] == suffix.upper()
