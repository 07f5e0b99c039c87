"""``measure bending`` on the command line and over REST."""

from pathlib import Path

from fastapi.testclient import TestClient

from tests.app.command_line import run
from tests.app.rest import post, refusal, upload
from tests.knitcore.measure.synthetic import hanging_yarn, save_photo


def test_bending_from_photos(client: TestClient, tmp_path: Path) -> None:
    photos = [save_photo(tmp_path / f"{n}.png", hanging_yarn(n, length_px=700)) for n in (80, 100)]
    sizes = "--linear-density-g-per-m", "0.5", "--length-mm", "120"
    result = run("measure", "bending", *photos, *sizes)
    assert set(result) >= {"bending_modulus_n_mm2", "standard_deviation", "photos"}
    body = {"images": [upload(p) for p in photos], "linear_density_g_per_m": 0.5}
    assert post(client, "measure/bending", body | {"length_mm": 120}) == result
    assert refusal(client, "measure/bending", body)["field"] == "length_mm"
