"""Estimates and pressure over REST and on the command line."""

from __future__ import annotations

import base64
from dataclasses import asdict
from pathlib import Path

import pytest
from click.testing import CliRunner
from fastapi.testclient import TestClient

from app.cli.main import main
from knitcore.chart.fabric import Direction, Fabric
from knitcore.materials import load_material_file, material
from tests.app.command_line import run
from tests.knitcore.measure.synthetic import write_csv


def test_an_estimate_from_one_swatch(client: TestClient) -> None:
    record = material("cotton").record(Fabric.STOCKINETTE)
    lengths = {f: material("cotton").record(f).loop_length_mm for f in Fabric}
    options = [f"--loop-length-mm={f}={length}" for f, length in lengths.items()]
    told = run(
        "estimate", "--bending-modulus-n-mm2", "0.0708", *options,
        "--swatch", "stockinette=cotton", "--swatch-setting", "a", "--product-setting", "a",
    )  # fmt: skip
    body = {
        "bending_modulus_n_mm2": 0.0708,
        "loop_length_mm": lengths,
        "swatches": [
            {
                "fabric": "stockinette",
                "law": asdict(record.law),
                "loop_length_mm": record.loop_length_mm,
                "setting": "a",
            }
        ],
        "product_setting": "a",
    }
    asked = client.post("/api/v1/estimate", json=body).json()
    assert asked == told
    assert next(iter(asked["fabrics"]["rib"])) == "strain_at_0_1_n_per_mm"
    assert asked["left_out"]["modulus_rms_factor"] == pytest.approx(1.52, abs=0.01)
    assert asked["warnings"] == []


@pytest.mark.slow
def test_measured_curves_go_from_the_tests_into_the_material(
    client: TestClient, tmp_path: Path
) -> None:
    """fit, estimate, materials: the median curve of the pulls stays with the fabric."""
    files = [write_csv(tmp_path / f"{d}.csv", d) for d in Direction]
    law, out = tmp_path / "law.json", tmp_path / "mine.yaml"
    fitted = run("fit", *files, "--out", law)
    run("estimate", "--bending-modulus-n-mm2", "0.02", "--loop-length-mm", "12",
        "--swatch", f"garter={law}", "--out", out)  # fmt: skip
    told = run("materials", out)
    assert told["measured"] == {"garter": fitted["curves"]}
    saved = load_material_file(out)
    curve = saved.record(Fabric.GARTER).measured[Direction.WALE]
    assert curve.pulls == 4
    assert not saved.record(Fabric.RIB).measured
    uploads = {
        f"test_{d}": {"name": f.name, "content": base64.b64encode(f.read_bytes()).decode()}
        for d, f in zip(Direction, files, strict=True)
    }
    asked = client.post("/api/v1/fit", json=uploads).json()
    assert asked["curves"] == fitted["curves"]
    assert client.get("/api/v1/materials/acrylic").json()["measured"] == {}


def test_an_estimate_becomes_a_material(tmp_path: Path) -> None:
    out = tmp_path / "mine.json"
    told = run("estimate", "--bending-modulus-n-mm2", "0.02", "--loop-length-mm", "9", "--out", out)
    saved = load_material_file(out)
    assert saved.is_complete
    fabrics = told["fabrics"]
    assert isinstance(fabrics, dict)
    assert saved.law(Fabric.SEED).alpha_xx == pytest.approx(fabrics["seed"]["law"]["alpha_xx"])
    predicted = run("predict", "seed", "--size", "8x8", "--material", out)
    modulus = fabrics["seed"]["modulus_n_per_mm"]["course"]
    interval = fabrics["seed"]["modulus_interval_n_per_mm"]["course"]
    assert predicted["modulus_course_n_per_mm"] == pytest.approx(modulus, rel=1e-3)
    low, high = predicted["modulus_course_interval_n_per_mm"]  # type: ignore[misc]
    assert (low, high) == pytest.approx(tuple(interval), rel=0.02)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ([], "Missing option '--bending-modulus-n-mm2'"),
        (["--bending-modulus-n-mm2", "0.02"], "loop_length_mm: is missing"),
        (["--bending-modulus-n-mm2", "0.02", "--loop-length-mm", "long"], "FABRIC=MM"),
        (["--bending-modulus-n-mm2", "0.02", "--loop-length-mm", "rib=9"], "missing"),
        (
            ["--bending-modulus-n-mm2", "0.02", "--loop-length-mm", "9", "--swatch", "cotton"],
            "FABRIC=",
        ),
        (
            ["--bending-modulus-n-mm2", "0.02", "--loop-length-mm", "9", "--swatch", "rib=none"],
            "library",
        ),
    ],
)
def test_bad_estimates_end_with_code_2(arguments: list[str], says: str) -> None:
    result = CliRunner().invoke(main, ["estimate", *arguments, "--json"])
    assert result.exit_code == 2
    assert result.stdout == ""
    assert says in result.stderr


GLOVE = ("--material", "glove-wool:glove", "--fabric", "stockinette", "--direction", "wale")


def test_pressure_of_a_material(client: TestClient) -> None:
    told = run("pressure", *GLOVE, "--rest-mm", "150", "--worn-mm", "180")
    mmhg, kpa = told["mmhg"], told["kpa"]
    assert isinstance(mmhg, list)
    assert isinstance(kpa, list)
    assert 0 < mmhg[0] < mmhg[1]
    assert mmhg == pytest.approx([7.50062 * end for end in kpa], rel=1e-5)
    assert told["warnings"]
    body = {
        "material": "glove-wool:glove",
        "fabric": "stockinette",
        "direction": "wale",
        "rest_mm": 150,
        "worn_mm": 180,
    }
    assert client.post("/api/v1/pressure", json=body).json() == told
    law = asdict(material("glove-wool:glove").law(Fabric.STOCKINETTE))
    body = {"law": law, "direction": "wale", "rest_mm": 150, "worn_mm": 180}
    assert client.post("/api/v1/pressure", json=body).json()["mmhg"] == mmhg


def test_a_tube_is_sized_for_a_target() -> None:
    told = run("pressure", *GLOVE, "--target-mmhg", "20", "--worn-mm", "180")
    sizes = told["rest_mm_for_target"]
    assert isinstance(sizes, list)
    assert sizes[0] < told["rest_mm"] < sizes[1] < 180
    low, high = told["mmhg"]  # type: ignore[misc]
    assert low < 20 < high


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--rest-mm", "200", "--worn-mm", "150"], "loose"),
        (["--rest-mm", "100", "--worn-mm", "180"], "lock-up"),
        (["--worn-mm", "150"], "rest_mm"),
        (["--worn-mm", "150", "--rest-mm", "100", "--target-mmhg", "20"], "rest_mm"),
        (["--worn-mm", "150", "--rest-mm", "120", "--law", "x.json"], "one of the two"),
    ],
)
def test_bad_pressures_end_with_code_2(arguments: list[str], says: str) -> None:
    result = CliRunner().invoke(main, ["pressure", *GLOVE, *arguments, "--json"])
    assert result.exit_code == 2
    assert result.stdout == ""
    assert says in result.stderr


@pytest.mark.parametrize(
    ("fields", "detail"),
    [
        ({"material": None}, "material: is missing."),
        ({"law": {"alpha": 1.0}}, "law: material is given as well."),
        ({"fabric": None}, "fabric: is missing."),
        ({"chart": "KP"}, "chart: fabric is given as well."),
        ({"rest_mm": None}, "rest_mm: is missing."),
        ({"target_mmhg": 20}, "target_mmhg: rest_mm is given as well."),
    ],
)
def test_a_pressure_names_the_field_that_is_missing_or_too_much(
    client: TestClient, fields: dict[str, object], detail: str
) -> None:
    body = {
        "direction": "course",
        "material": "acrylic",
        "fabric": "stockinette",
        "rest_mm": 120,
        "worn_mm": 150,
    }
    response = client.post("/api/v1/pressure", json=body | fields)
    assert response.status_code == 422
    assert response.json()["detail"] == detail
