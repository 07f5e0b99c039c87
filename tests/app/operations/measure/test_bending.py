"""``measure bending`` on the command line and over REST."""

from pathlib import Path

from fastapi.testclient import TestClient

from tests.app.command_line import run
from tests.app.rest import upload
from tests.knitcore.measure.synthetic import hanging_yarn, save_photo


def test_bending_from_photos(client: TestClient, tmp_path: Path) -> None:
    photos = [save_photo(tmp_path / f"{n}.png", hanging_yarn(n, length_px=700)) for n in (80, 100)]
    told = run(
        "measure", "bending", *photos, "--linear-density-g-per-m", "0.5", "--length-mm", "120"
    )
    assert set(told) >= {"bending_modulus_n_mm2", "standard_deviation", "photos"}
    body = {"images": [upload(p) for p in photos], "linear_density_g_per_m": 0.5, "length_mm": 120}
    assert client.post("/api/v1/measure/bending", json=body).json() == told
    del body["length_mm"]
    problem = client.post("/api/v1/measure/bending", json=body).json()
    assert problem["field"] == "length_mm"
