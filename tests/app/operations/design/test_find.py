"""Atlas and search over REST and on the command line."""

import json
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.context import Context
from app.operations.design.find import FindRequest, find
from app.service.results.atlases import repeats_of
from knitcore.base.errors import InputError
from knitcore.formats.read.stitch_maps import read_target_moduli
from tests.app.command_line import printed, refused, run
from tests.app.rest import post, refusal

WISH = {"quantity": "modulus_course_n_per_mm", "value": 0.135, "tolerance": 0.05, "weight": 1.0}


@pytest.fixture(scope="module")
def atlas(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of the small atlas of acrylic, from the command line; beside it what was printed."""
    file = tmp_path_factory.mktemp("atlas") / "acrylic.npz"
    options = "--material", "acrylic", "--repeats", "small", "-o", file, "--json"
    file.with_suffix(".json").write_text(printed("atlas", *options).stdout)
    return file


def test_rest_and_command_line_find_the_same(client: TestClient, atlas: Path) -> None:
    answer = post(client, "find", {"materials": ["acrylic"], "targets": [WISH], "count": 3})
    assert answer["reached"]
    assert answer["candidates"][0]["repeat"] in ("K/P", "P/K")
    assert answer["searched"] == len(repeats_of("small"))
    target = "course=0.135~5%*1"
    assert run("find", "--atlas", atlas, "--target", target, "--count=3") == answer


def test_rest_and_command_line_print_the_same_atlas(client: TestClient, atlas: Path) -> None:
    columns = post(client, "atlas", {"material": "acrylic"})
    assert columns == json.loads(atlas.with_suffix(".json").read_text())
    assert len(columns["repeats"]) == len(repeats_of("small"))


@pytest.mark.slow
def test_other_yarns_are_offered_where_the_wanted_one_reaches_nothing(client: TestClient) -> None:
    """No acrylic is so stiff; the answer names the nearest and looks elsewhere."""
    body = {"materials": ["acrylic"], "targets": [WISH | {"value": 0.6, "tolerance": 0.2}]}
    answer = post(client, "find", body)
    assert not answer["reached"]
    assert {c["material"] for c in answer["elsewhere"]}.isdisjoint({"acrylic"})
    assert post(client, "find", body | {"elsewhere": False})["elsewhere"] == []


def test_stretch_pressure_and_limits_over_rest_and_on_the_command_line(
    client: TestClient, atlas: Path
) -> None:
    limb = {"rest_mm": 180, "worn_mm": 240}
    targets = [
        {"quantity": "stretch_wale", "value": 0.4, "load_n_per_mm": 0.05, "tolerance": 0.2},
        {"quantity": "pressure_course_mmhg", "value": 20, "limb": limb, "weight": 2},
        {"quantity": "poisson_xy", "value": 0.3, "tolerance": 0.2},
    ]
    limits = {"transfers_per_stitch": 0.5, "curl": 0.4}
    request = {"materials": ["acrylic"], "targets": targets, "limits": limits, "count": 4}
    answer = post(client, "find", request | {"elsewhere": False})
    names = {"stretch_wale@0.05", "pressure_course_mmhg@180/240", "poisson_xy"}
    assert set(answer["candidates"][0]["values"]) == names
    assert all(c["transfers_per_stitch"] <= 0.5 for c in answer["candidates"])
    written = "stretch_wale@0.05=0.4~20%", "pressure_course@180/240=20*2", "poisson_xy=0.3~0.2"
    options = f"--atlas={atlas}", "--most-transfers=0.5", "--most-curl=0.4", "--count=4"
    assert run("find", *options, *(f"--target={target}" for target in written)) == answer


@pytest.mark.slow
def test_targets_for_parts_fill_them_and_contradictions_are_refused(client: TestClient) -> None:
    box = [[row, 0, 8] for row in range(8)]
    targets = [
        {"name": "palm", "runs": box, "modulus_course_n_per_mm": 0.135},
        {"name": "back", "runs": [[row, 8, 8] for row in range(8)], "modulus_wale_n_per_mm": 0.48},
    ]
    request = {"material": "acrylic", "rows": 8, "columns": 16, "targets": targets}
    filled = post(client, "fill", request)
    assert (filled["rows"], filled["columns"]) == (8, 16)
    assert filled["off_share"] <= 0.3

    kept = ["KPPKKPKKPPKPPPKK"] * 8
    rest = {"targets": targets[:1], "chart": "\n".join(kept)}
    beside = post(client, "fill", request | rest)
    assert [line[8:] for line in beside["chart"].split()] == [line[8:] for line in kept]
    shape = {"outline": "\n".join(["xxxxxxxxxxxxxx.."] * 8)}
    post(client, "fill", request | rest | shape)
    assert refusal(client, "fill", request | rest | {"chart": "KP"})["field"] == "chart"

    targets[1] = {"name": "thumb", "runs": box, "modulus_course_n_per_mm": 0.1}
    problem = refusal(client, "fill", request)
    assert "contradict" in problem["detail"]
    for wrong in ({"rows": None}, {"modulus_course_n_per_mm": [[0.1]]}):
        assert client.post("/api/v1/fill", json=request | wrong).status_code == 422


@pytest.mark.slow
def test_an_outline_over_rest_and_on_the_command_line(
    client: TestClient, atlas: Path, tmp_path: Path
) -> None:
    width = [None, 0.97, 0.95, 0.94, 0.94, 0.95, 0.97, None]
    request = {"material": "acrylic", "strain": 0.3, "width": width, "across": 8}
    answer = post(client, "shape", request | {"smallest_band": 2})
    assert answer["largest"] < 0.05
    profile, design = tmp_path / "p.csv", tmp_path / "d.json"
    profile.write_text("width\n" + "\n".join("" if w is None else str(w) for w in width) + "\n")
    shape = ["shape", str(profile), "--material=acrylic", "--across=8", "--strain=0.3"]
    assert run(*shape, "--smallest-band=2", f"--atlas={atlas}", f"-o{design}") == answer
    assert json.loads(design.read_text())["chart"] == answer["chart"]
    profile.write_text("height\n1\n")
    refused(*shape)


def test_the_values_of_a_chart_give_the_chart_back(
    client: TestClient, atlas: Path, tmp_path: Path
) -> None:
    """Exported values filled again: the same moduli over REST and on the command line."""
    chart, values, design = (tmp_path / name for name in ("c.txt", "v.csv", "d.json"))
    chart.write_text("\n".join(["KPKPKPKPKPKP"] * 6 + ["KKKKKKKKKKKK"] * 6))
    printed("export", chart, "--to", "csv", "-o", values)
    fill = ["fill", str(values), "--material=acrylic", f"--atlas={atlas}", f"-o{design}"]
    result = run(*fill)
    assert result["off_share"] == 0
    assert (result["rows"], result["columns"]) == (12, 12)
    assert json.loads(design.read_text())["chart"] == result["chart"]

    lines = values.read_text().splitlines()
    values.write_text(
        "\n".join([*lines[:61], *(f"{k // 12 + 1},{k % 12 + 1},," for k in range(60, 144))])
    )
    assert run(*fill, f"--chart={chart}")["chart"].split()[:7] == chart.read_text().split()[:7]
    values.write_text("\n".join(lines))

    course, wale = (m.tolist() for m in read_target_moduli(values))
    request = {"material": "acrylic", "modulus_course_n_per_mm": course}
    assert post(client, "fill", request | {"modulus_wale_n_per_mm": wale}) == result


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
def test_unreadable_maps_are_refused(atlas: Path, tmp_path: Path, text: str, says: str) -> None:
    file = tmp_path / "v.csv"
    file.write_text(text)
    assert says in refused("fill", file, "--material=acrylic", f"--atlas={atlas}")


def test_a_wrong_material_is_refused_before_any_atlas_is_computed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Context, "atlas", lambda *_: pytest.fail("an atlas was computed"))
    request = FindRequest.model_validate({"materials": ["acrylic", "nope"], "targets": [WISH]})
    with pytest.raises(InputError, match="nope"):
        find(request, Context(Path("/nonexistent")))
