"""``compare`` and ``calibrate``: command line and REST."""

from pathlib import Path

import numpy as np
import pytest
from fastapi.testclient import TestClient

from knitcore.cloth.flat import SheetModel
from knitcore.materials import material
from tests.app.command_line import refused, run
from tests.app.rest import post, upload
from tests.knitcore.cloth.flat.synthetic import camera_arrays

FABRIC = ["--material", "acrylic", "--fabric", "garter", "--direction", "wale"]


@pytest.fixture(scope="module")
def field(tmp_path_factory: pytest.TempPathFactory) -> Path:
    displacement, frame = camera_arrays(material("acrylic").law("garter"), SheetModel())
    path = tmp_path_factory.mktemp("field") / "field.npz"
    np.savez_compressed(path, displacement=displacement.astype(np.float32), frame=frame)
    return path


def test_compare_gives_the_fields_of_the_contract(field: Path) -> None:
    for edges in ("measured", "rigid"):
        out = run("compare", field, *FABRIC, "--edges", edges, "--model", "full")
        assert [f["frame"] for f in out["frames"]] == [2, 3]
        measures = {f"{u}_{what}_percent_width" for u in ("ux", "uy") for what in ("rms", "max")}
        assert set(out["frames"][0]) == {"frame", "applied_stretch", *measures}
        assert out["frames"][1]["ux_rms_percent_width"] < 0.06


@pytest.mark.slow
def test_a_calibrated_law_can_be_compared(field: Path, tmp_path: Path) -> None:
    law = tmp_path / "law.json"
    calibrated = run("calibrate", field, *FABRIC, "--frame", "3", "--out", law)
    assert calibrated["frames"] == [3]
    assert [f["frame"] for f in calibrated["comparison"]] == [2, 3]
    out = run("compare", field, "--law", law, "--direction", "wale")
    assert out["frames"][0]["ux_rms_percent_width"] < 0.1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["compare", "missing.npz", *FABRIC], "field"),
        (["compare", "FIELD", "--direction", "wale"], "law"),
        (["compare", "FIELD", *FABRIC, "--frame", "9"], "no stretched picture 9. Use 2, 3"),
        (["calibrate", "FIELD", "x.h5", *FABRIC, "--out", "law.json"], "tests"),
    ],
)
def test_unusable_input_ends_with_code_2(field: Path, arguments: list[str], message: str) -> None:
    assert message in refused(*(field if a == "FIELD" else a for a in arguments))


def test_rest_compares_too(client: TestClient, field: Path) -> None:
    body = {"field": upload(field), "direction": "wale", "material": "acrylic", "fabric": "garter"}
    assert post(client, "compare", body)["frames"][1]["frame"] == 3
    assert client.post("/api/v1/compare", json=body | {"material": None}).status_code == 422
