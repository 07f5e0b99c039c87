"""``curl`` on the command line and over REST."""

import io
from pathlib import Path

import numpy as np
import pytest
import trimesh
from fastapi.testclient import TestClient

from app.context import Context
from app.drawing.design_view import ViewRequest, build_scene
from app.drawing.fabric import solid_glb
from app.operations.cloth.curl import CurlRequest, curl
from knitcore.chart.stitch_chart import StitchChart
from knitcore.formats.designs.design_file import DesignFile, write_design
from tests.app.command_line import printed, run
from tests.app.rest import post, solid

STRIP = {"fabric": "stockinette", "columns": 12, "rows": 3}
FIELDS = {
    "width_mm", "height_mm", "depth_mm", "curl_course_mm", "curl_wale_mm", "converged", "seconds",
}  # fmt: skip


def test_curl_over_rest(client: TestClient) -> None:
    curled = post(client, "curl", {"chart": STRIP, "material": "acrylic", "corners": True})
    assert set(curled) >= FIELDS
    assert curled["converged"]
    assert curled["curl_wale_mm"] > 0.0
    assert np.array(curled["corners_mm"]).shape == (4, 13, 3)
    assert np.ptp(curled["corners_mm"], axis=(0, 1))[0] == pytest.approx(
        curled["width_mm"], abs=2e-3
    )


def test_a_first_shape_begins_at_an_old_one(client: TestClient) -> None:
    """Without time it is a step from that shape; unknown ids and other sizes have no effect."""

    def depth_mm(**more: object) -> float:
        body = {"chart": STRIP, "material": "acrylic", "time_limit_s": 1e-9} | more
        answer = post(client, "curl", body)
        assert not answer["converged"]
        return float(answer["depth_mm"])

    rest = post(client, "curl", {"chart": STRIP, "material": "acrylic"})
    changed = "KKKKKKKKKKKK\nKKKKKPKKKKKK\nKKKKKKKKKKKK"
    after = {"after": rest["id"]}
    assert depth_mm(chart=changed, **after) == pytest.approx(rest["depth_mm"], rel=0.1)
    assert depth_mm(chart=changed) < 0.5 * rest["depth_mm"]
    assert depth_mm(chart=changed, after="unknown") == depth_mm(chart=changed)
    assert depth_mm(chart="KKKK\nKKKK", **after) == depth_mm(chart="KKKK\nKKKK")


@pytest.mark.slow
def test_a_piece_with_a_hole_over_rest_as_a_solid_and_hanging(client: TestClient) -> None:
    outline = "\n".join(["xxxxxxxx", *["xx....xx"] * 4, "xxxxxxxx"])
    chart = {"fabric": "seed", "columns": 8, "rows": 6}
    body = {"chart": chart, "material": "acrylic", "outline": outline}
    curled = post(client, "curl", body | {"corners": True})
    assert curled["converged"]
    assert curled["curl_course_mm"] is None
    missing = [[at is None for at in line] for line in curled["corners_mm"]]
    assert np.argwhere(missing).tolist() == [[y, x] for y in (2, 3, 4) for x in (3, 4, 5)]
    mesh = solid(client, body | {"curl": {"id": curled["id"]}})
    width, height = 1000.0 * mesh.extents[:2]
    assert width == pytest.approx(curled["width_mm"], rel=0.1)
    near = np.abs(1000.0 * (mesh.vertices - mesh.bounds.mean(axis=0))[:, :2])
    assert not (near < (0.1 * width, 0.1 * height)).all(axis=1).any()
    assert post(client, "hang", body | {"linear_density_g_per_m": 0.5})["converged"]


def test_a_shaped_design_and_clamps_at_the_command_line(tmp_path: Path) -> None:
    design, out = tmp_path / "shaped.json", tmp_path / "shaped.glb"
    knits, outline = "\n".join(["KKKKKK"] * 4), "..xx..\nxxxxxx\nxx..xx\nxxxxxx"
    shaped = DesignFile(name="Shaped", material="acrylic", chart=knits, outline=outline)
    design.write_text(write_design(shaped))
    curled = run("curl", design, "--material", "acrylic", "--strain", "0.1", "--out", out)
    assert curled["curl_wale_mm"] is None
    assert "between clamps" in curled["notes"][0]
    assert out.stat().st_size > 1000


@pytest.mark.parametrize("kind", [".npz", ".glb"])
def test_curl_writes_the_shape(tmp_path: Path, kind: str) -> None:
    out = tmp_path / f"shape{kind}"
    curled = run("curl", "stockinette", "--size", "12x3", "--material", "acrylic", "--out", out)
    size = [curled["width_mm"], curled["height_mm"], curled["depth_mm"]]
    if kind == ".npz":
        with np.load(out) as arrays:
            assert np.ptp(arrays["corners_mm"], axis=(0, 1)) == pytest.approx(size)
    else:  # in metres, and the yarn has a thickness
        mesh = trimesh.load_mesh(out)
        assert np.all(1000.0 * mesh.extents > np.array(size) - 1e-3)
        assert np.all(1000.0 * mesh.extents < np.array(size) + 8.0)


def test_curl_prints_words() -> None:
    result = printed("curl", "stockinette", "--size", "4x16", "--material", "acrylic")
    assert "to the back" in result.stdout
    assert "Without friction" in result.stderr


def test_a_view_shows_the_shape(context: Context) -> None:
    request = CurlRequest(chart=StitchChart.parse("K").tile(3, 12).text, material="acrylic")
    curled = curl(request, context)
    body = {"chart": request.chart, "material": "acrylic", "curl": {"id": curled.result.id}}
    scene = build_scene(ViewRequest.model_validate(body), curled.view, context)
    assert scene.placement.heights_mm is not None
    assert np.ptp(scene.placement.heights_mm) > 2.0
    mesh = trimesh.load_mesh(io.BytesIO(solid_glb(scene)), file_type="glb")
    assert 1000.0 * mesh.extents[2] > np.ptp(scene.placement.heights_mm)
