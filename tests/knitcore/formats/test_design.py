from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore import InputError
from knitcore.formats import design as designs
from knitcore.formats.design import DesignFile, design_schema, read_design, write_design
from tests.knitcore.charts import stitch_charts

NAMES = st.text(st.characters(exclude_categories=["Cs", "Cc"]), min_size=1, max_size=40)


@given(chart=stitch_charts(), name=NAMES, material=st.none() | NAMES, note=NAMES)
def test_nothing_is_lost(
    chart: object, name: str, material: str | None, note: str, tmp_path: Path
) -> None:
    file = tmp_path / "design.json"
    design = DesignFile(name=name, material=material, chart=str(chart), note=note)
    file.write_text(write_design(design), encoding="utf-8")
    assert read_design(file) == design
    assert read_design(file).to_chart() == chart


def test_the_schema_names_what_a_file_holds() -> None:
    schema = design_schema()
    assert schema["additionalProperties"] is False
    assert set(schema["properties"]) == set(DesignFile.model_fields)
    assert schema["properties"]["format"]["const"] == "knitcore-design"
    assert schema["required"] == ["chart"]


def test_an_older_version_is_brought_up_to_date(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def from_version_0(data: dict[str, Any]) -> dict[str, Any]:
        return {**data, "version": 1, "chart": data["chart"].replace(".", "P")}  # and 1 to 2

    monkeypatch.setitem(designs.MIGRATIONS, 0, from_version_0)
    file = tmp_path / "design.json"
    file.write_text(json.dumps({"format": "knitcore-design", "version": 0, "chart": "K."}))
    assert read_design(file).chart == "KP"
    assert read_design(file).version == designs.VERSION


def test_version_1_is_read_and_written_as_version_2(tmp_path: Path) -> None:
    file = tmp_path / "design.json"
    old = {"format": "knitcore-design", "version": 1, "chart": "KP", "name": "Old", "outline": "xx"}
    file.write_text(json.dumps(old))
    design = read_design(file)
    assert (design.version, design.name, design.outline, design.regions) == (2, "Old", "xx", [])
    file.write_text(write_design(design))
    assert read_design(file) == design


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"colour": "red"}, "colour"),
        ({"name": ""}, "name"),
        ({"chart": "KX"}, "neither K nor P"),
        ({"version": 3}, "version 3"),
        ({"version": True}, "version"),
        ({"version": [1]}, "version"),
        ({"format": "other"}, "not a design"),
    ],
)
def test_errors_name_their_place(tmp_path: Path, change: dict[str, object], says: str) -> None:
    file = tmp_path / "design.json"
    file.write_text(json.dumps({"format": "knitcore-design", "version": 1, "chart": "KP"} | change))
    with pytest.raises(InputError, match=says):
        read_design(file)
