"""Estimates over REST and on the command line."""

from dataclasses import asdict
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from knitcore.chart.fabric import Direction, Fabric
from knitcore.materials import load_material_file, material
from tests.app.command_line import run
from tests.app.rest import post, upload
from tests.knitcore.measure.synthetic import write_csv


def test_an_estimate_from_one_swatch(client: TestClient) -> None:
    record = material("cotton").record(Fabric.STOCKINETTE)
    lengths = {f: material("cotton").record(f).loop_length_mm for f in Fabric}
    options = [f"--loop-length-mm={f}={length}" for f, length in lengths.items()]
    made = run(
        "estimate", "--bending-modulus-n-mm2", "0.0708", *options,
        "--swatch", "stockinette=cotton", "--swatch-setting", "a", "--product-setting", "a",
    )  # fmt: skip
    swatch = {"fabric": "stockinette", "law": asdict(record.law), "setting": "a"}
    swatch["loop_length_mm"] = record.loop_length_mm
    body = {"bending_modulus_n_mm2": 0.0708, "loop_length_mm": lengths, "product_setting": "a"}
    assert post(client, "estimate", body | {"swatches": [swatch]}) == made
    assert next(iter(made["fabrics"]["rib"])) == "strain_at_0_1_n_per_mm"
    assert made["left_out"]["modulus_rms_factor"] == pytest.approx(1.52, abs=0.01)
    assert made["warnings"] == []


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
    assert run("materials", out)["measured"] == {"garter": fitted["curves"]}
    saved = load_material_file(out)
    curve = saved.record(Fabric.GARTER).measured[Direction.WALE]
    assert curve.pulls == 4
    assert not saved.record(Fabric.RIB).measured
    uploads = {f"test_{d}": upload(f) for d, f in zip(Direction, files, strict=True)}
    assert post(client, "fit", uploads)["curves"] == fitted["curves"]
    assert client.get("/api/v1/materials/acrylic").json()["measured"] == {}


def test_an_estimate_becomes_a_material(tmp_path: Path) -> None:
    out = tmp_path / "mine.json"
    made = run("estimate", "--bending-modulus-n-mm2", "0.02", "--loop-length-mm", "9", "--out", out)
    saved = load_material_file(out)
    assert saved.is_complete
    seed = made["fabrics"]["seed"]
    assert saved.law(Fabric.SEED).alpha_xx == pytest.approx(seed["law"]["alpha_xx"])
    predicted = run("predict", "seed", "--size", "8x8", "--material", out)
    modulus, interval = (
        seed[name]["course"] for name in ("modulus_n_per_mm", "modulus_interval_n_per_mm")
    )
    assert predicted["modulus_course_n_per_mm"] == pytest.approx(modulus, rel=1e-3)
    assert predicted["modulus_course_interval_n_per_mm"] == pytest.approx(interval, rel=0.02)
