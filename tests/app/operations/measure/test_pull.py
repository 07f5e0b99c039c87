"""One stretch test of a yarn: command line, REST, and the file it leaves."""

import json
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.requests.uploads import EXAMPLES, example_file
from knitcore.chart.fabric import Fabric
from knitcore.materials import material, save_material_file
from knitcore.materials.estimate.without_tester import KnownSwatch, yarn_without_tester
from tests.app.command_line import refused, run
from tests.app.rest import post

STRIP = ("--fabric", "rib", "--direction", "course")


def widths(result: dict[str, Any]) -> dict[tuple[str, str], float]:
    """Width of each interval after the pull over that before."""
    return {
        (of["fabric"], of["direction"]): (of["after_interval"][1] - of["after_interval"][0])
        / (of["before_interval"][1] - of["before_interval"][0])
        for of in result["fabrics"]
    }


def test_one_pull_narrows_its_own_fabric_of_a_yarn_that_was_measured(
    client: TestClient, tmp_path: Path
) -> None:
    out = tmp_path / "mine.json"
    test = str(EXAMPLES / "course.csv")
    result = run("measure", "pull", test, "--material", "cotton", *STRIP, "--out", str(out))
    narrower = widths(result)
    assert narrower.pop(("rib", "course")) < 0.8
    assert list(narrower.values()) == pytest.approx([1.0] * 7)
    assert "pull a second strip" in result["warning"]  # the test is of another yarn's stockinette
    body = {
        "test": example_file("course.csv"),
        "material": "cotton",
        "fabric": "rib",
        "direction": "course",
    }
    assert post(client, "measure/pull", body) == result
    assert set(json.loads(out.read_text())["fabrics"]) == set(Fabric)


def test_one_pull_narrows_all_fabrics_of_a_yarn_that_was_estimated(tmp_path: Path) -> None:
    size = material("cotton").record(Fabric.STOCKINETTE).stitch_mm
    swatch = KnownSwatch(Fabric.STOCKINETTE, *(100 / mm for mm in size))
    own = tmp_path / "own.json"
    save_material_file(yarn_without_tester(swatch).material("own"), own)
    test = str(EXAMPLES / "course.csv")
    narrower = widths(run("measure", "pull", test, "--material", str(own), *STRIP))
    assert len(narrower) == 8
    assert narrower["rib", "course"] < 0.5
    assert all(of["after"] != of["before"] for of in run_fabrics(test, own))


def run_fabrics(test: str, own: Path) -> list[dict[str, float]]:
    """List what a pull changed of each fabric."""
    result: dict[str, list[dict[str, float]]] = run(
        "measure", "pull", test, "--material", str(own), *STRIP
    )
    return result["fabrics"]


def test_a_pull_that_ends_too_early_is_refused(tmp_path: Path) -> None:
    rows = ["strain_along,strain_across,force_n,width_mm"]
    rows += [f"{k / 100},{-k / 200},{k / 100},100" for k in range(1, 40)]
    short = tmp_path / "short.csv"
    short.write_text("\n".join(rows))
    answer = refused("measure", "pull", str(short), "--material", "cotton", *STRIP)
    assert "reaches 0.03 N/mm" in answer
