"""Atlas and search over REST and on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from fastapi.testclient import TestClient

from app.cli.main import main
from app.context import Context
from app.operations.design import find as find_module
from app.service.results.atlases import repeats_of
from knitcore.base.errors import InputError
from knitcore.formats.write.stitch_maps import read_wanted_moduli

WISH = {"quantity": "modulus_course_n_per_mm", "value": 0.135, "tolerance": 0.05, "weight": 1.0}


@pytest.fixture(scope="module")
def atlas(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, list[object]]]:
    """The small atlas of acrylic from the command line: its file and what was printed."""
    file = tmp_path_factory.mktemp("atlas") / "acrylic.npz"
    build = ["atlas", "--material", "acrylic", "--repeats", "small", "-o", str(file), "--json"]
    built = CliRunner().invoke(main, build)
    assert built.exit_code == 0, built.output
    return file, json.loads(built.stdout)


def test_rest_and_command_line_find_the_same(
    client: TestClient, atlas: tuple[Path, dict[str, list[object]]]
) -> None:
    request = {"materials": ["acrylic"], "targets": [WISH], "count": 3}
    asked = client.post("/api/v1/find", json=request)
    assert asked.status_code == 200, asked.text
    assert asked.json()["reached"]
    assert asked.json()["candidates"][0]["repeat"] in ("K/P", "P/K")
    assert asked.json()["searched"] == len(repeats_of("small"))

    find = [
        "find",
        "--atlas",
        str(atlas[0]),
        "--target",
        "course=0.135~5%*1",
        "--count=3",
        "--json",
    ]
    told = CliRunner().invoke(main, find)
    assert told.exit_code == 0, told.output
    assert json.loads(told.stdout) == asked.json()

    columns = client.post("/api/v1/atlas", json={"material": "acrylic"}).json()
    assert columns == atlas[1]
    assert len(atlas[1]["repeats"]) == len(repeats_of("small"))


@pytest.mark.slow
def test_other_yarns_are_offered_where_the_wanted_one_reaches_nothing(client: TestClient) -> None:
    """No acrylic is so stiff; the answer names the nearest and looks elsewhere."""
    wish = WISH | {"value": 0.6, "tolerance": 0.2}
    asked = client.post("/api/v1/find", json={"materials": ["acrylic"], "targets": [wish]}).json()
    assert not asked["reached"]
    assert {c["material"] for c in asked["elsewhere"]}.isdisjoint({"acrylic"})
    alone = {"materials": ["acrylic"], "targets": [wish], "elsewhere": False}
    assert client.post("/api/v1/find", json=alone).json()["elsewhere"] == []


def test_stretch_pressure_and_limits_over_rest_and_on_the_command_line(
    client: TestClient, atlas: tuple[Path, dict[str, list[object]]]
) -> None:
    targets = [
        {"quantity": "stretch_wale", "value": 0.4, "load_n_per_mm": 0.05, "tolerance": 0.2},
        {
            "quantity": "pressure_course_mmhg",
            "value": 20,
            "limb": {"rest_mm": 180, "worn_mm": 240},
            "weight": 2,
        },
        {"quantity": "poisson_xy", "value": 0.3, "tolerance": 0.2},
    ]
    request = {
        "materials": ["acrylic"],
        "targets": targets,
        "limits": {"transfers_per_stitch": 0.5, "curl": 0.4},
        "count": 4,
        "elsewhere": False,
    }
    asked = client.post("/api/v1/find", json=request)
    assert asked.status_code == 200, asked.text
    found = asked.json()
    assert set(found["candidates"][0]["values"]) == {
        "stretch_wale@0.05",
        "pressure_course_mmhg@180/240",
        "poisson_xy",
    }
    assert all(c["transfers_per_stitch"] <= 0.5 for c in found["candidates"])
    told = CliRunner().invoke(
        main,
        [
            "find",
            f"--atlas={atlas[0]}",
            "--target=stretch_wale@0.05=0.4~20%",
            "--target=pressure_course@180/240=20*2",
            "--target=poisson_xy=0.3~0.2",
            "--most-transfers=0.5",
            "--most-curl=0.4",
            "--count=4",
            "--json",
        ],
    )
    assert told.exit_code == 0, told.output
    assert json.loads(told.stdout) == found


def test_targets_for_parts_fill_them_and_contradictions_are_refused(client: TestClient) -> None:
    box = [[row, 0, 8] for row in range(8)]
    wishes = [
        {"name": "palm", "runs": box, "modulus_course_n_per_mm": 0.135},
        {"name": "back", "runs": [[row, 8, 8] for row in range(8)], "modulus_wale_n_per_mm": 0.48},
    ]
    request = {"material": "acrylic", "rows": 8, "columns": 16, "wishes": wishes}
    filled = client.post("/api/v1/fill", json=request)
    assert filled.status_code == 200, filled.text
    assert (filled.json()["rows"], filled.json()["columns"]) == (8, 16)
    assert filled.json()["off_share"] <= 0.3

    kept = ["KPPKKPKKPPKPPPKK"] * 8
    rest = {"wishes": wishes[:1], "chart": "\n".join(kept)}
    beside = client.post("/api/v1/fill", json=request | rest)
    assert beside.status_code == 200, beside.text
    assert [line[8:] for line in beside.json()["chart"].split()] == [line[8:] for line in kept]
    shape = {"outline": "\n".join(["xxxxxxxxxxxxxx.."] * 8)}
    shaped = client.post("/api/v1/fill", json=request | rest | shape)
    assert shaped.status_code == 200, shaped.text
    small = client.post("/api/v1/fill", json=request | rest | {"chart": "KP"})
    assert small.status_code == 422
    assert small.json()["field"] == "chart"

    wishes[1] = {"name": "thumb", "runs": box, "modulus_course_n_per_mm": 0.1}
    refused = client.post("/api/v1/fill", json=request)
    assert refused.status_code == 422
    assert "contradict" in refused.json()["detail"]
    for wrong in ({"rows": None}, {"modulus_course_n_per_mm": [[0.1]]}):
        assert client.post("/api/v1/fill", json=request | wrong).status_code == 422


def test_an_outline_over_rest_and_on_the_command_line(
    client: TestClient, atlas: tuple[Path, dict[str, list[object]]], tmp_path: Path
) -> None:
    width = [None, 0.97, 0.95, 0.94, 0.94, 0.95, 0.97, None]
    request = {"material": "acrylic", "strain": 0.3, "width": width, "across": 8}
    asked = client.post("/api/v1/shape", json=request | {"smallest_band": 2})
    assert asked.status_code == 200, asked.text
    assert asked.json()["largest"] < 0.05
    profile, design = tmp_path / "p.csv", tmp_path / "d.json"
    profile.write_text("width\n" + "\n".join("" if w is None else str(w) for w in width) + "\n")
    shape = ["shape", str(profile), "--material=acrylic", "--across=8", "--strain=0.3"]
    told = CliRunner().invoke(
        main, [*shape, "--smallest-band=2", f"--atlas={atlas[0]}", f"-o{design}", "--json"]
    )
    assert told.exit_code == 0, told.output
    assert json.loads(told.stdout) == asked.json()
    assert json.loads(design.read_text())["chart"] == asked.json()["chart"]
    profile.write_text("height\n1\n")
    assert CliRunner().invoke(main, shape).exit_code == 2


@pytest.mark.parametrize("target", ["course", "course=x", "colour=1", "course=0.1~%"])
def test_unreadable_targets_are_refused(target: str, tmp_path: Path) -> None:
    refused = CliRunner().invoke(main, ["find", "--atlas", "none.npz", "--target", target])
    assert refused.exit_code == 2


def test_a_search_without_materials_is_refused() -> None:
    refused = CliRunner().invoke(main, ["find", "--target", "course=0.1"])
    assert refused.exit_code == 2
    assert "nothing to search" in refused.stderr


def test_the_values_of_a_chart_give_the_chart_back(
    client: TestClient, atlas: tuple[Path, dict[str, list[object]]], tmp_path: Path
) -> None:
    """Exported values filled again: the same moduli over REST and on the command line."""
    chart, values, design = (tmp_path / name for name in ("c.txt", "v.csv", "d.json"))
    chart.write_text("\n".join(["KPKPKPKPKPKP"] * 6 + ["KKKKKKKKKKKK"] * 6))
    export = ["export", str(chart), "--to", "csv", "-o", str(values)]
    assert CliRunner().invoke(main, export).exit_code == 0
    fill = ["fill", str(values), "--material=acrylic", f"--atlas={atlas[0]}", f"-o{design}"]
    told = CliRunner().invoke(main, [*fill, "--json"])
    assert told.exit_code == 0, told.output
    result = json.loads(told.stdout)
    assert result["off_share"] == 0
    assert (result["rows"], result["columns"]) == (12, 12)
    assert json.loads(design.read_text())["chart"] == result["chart"]

    lines = values.read_text().splitlines()
    values.write_text(
        "\n".join([*lines[:61], *(f"{k // 12 + 1},{k % 12 + 1},," for k in range(60, 144))])
    )
    told = CliRunner().invoke(main, [*fill, f"--chart={chart}", "--json"])
    assert told.exit_code == 0, told.output
    assert json.loads(told.stdout)["chart"].split()[:7] == chart.read_text().split()[:7]
    values.write_text("\n".join(lines))

    course, wale = (m.tolist() for m in read_wanted_moduli(values))
    request = {"material": "acrylic", "modulus_course_n_per_mm": course}
    asked = client.post("/api/v1/fill", json=request | {"modulus_wale_n_per_mm": wale})
    assert asked.status_code == 200, asked.text
    assert asked.json() == result


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("row,column\n1,1\n", "lacks columns"),
        ("row,column,modulus_wale_n_per_mm\n1,x,1\n", "line 2 holds no numbers"),
        ("row,column,modulus_wale_n_per_mm\n0,1,1\n", "row 0, column 1"),
        ("row,column,modulus_wale_n_per_mm\n", "holds no stitch"),
        ("row,column,modulus_wale_n_per_mm\n1,1,\n", "there is no target"),
    ],
)
def test_unreadable_maps_are_refused(
    atlas: tuple[Path, dict[str, list[object]]], tmp_path: Path, text: str, says: str
) -> None:
    file = tmp_path / "v.csv"
    file.write_text(text)
    refused = CliRunner().invoke(
        main, ["fill", str(file), "--material=acrylic", f"--atlas={atlas[0]}"]
    )
    assert refused.exit_code == 2
    assert says in refused.stderr


def test_ragged_maps_are_refused(client: TestClient) -> None:
    request = {
        "material": "acrylic",
        "modulus_course_n_per_mm": [[0.1, 0.1], [0.1]],
        "modulus_wale_n_per_mm": [[0.1, None], [0.1, 0.1]],
    }
    refused = client.post("/api/v1/fill", json=request)
    assert refused.status_code == 422
    assert refused.json()["field"] == "modulus_course_n_per_mm"


def test_a_wrong_material_is_refused_before_any_atlas_is_computed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def never(*_: object) -> None:
        raise AssertionError("an atlas was computed")

    monkeypatch.setattr(Context, "atlas", never)
    request = find_module.FindRequest.model_validate(
        {"materials": ["acrylic", "nope"], "targets": [WISH]}
    )
    with pytest.raises(InputError, match="nope"):
        find_module.find(request, Context(Path("/nonexistent")))
