"""One way to write intervals, rows and repeats in every request and answer; and one version."""

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

import knitcore
from app.operations.registry import operations
from app.requests.charts import CellLines, ChartLines, RepeatText
from knitcore.formats.designs.layout import Motif
from tests.app.command_line import printed

Schema = dict[str, Any]
PROJECT = Path(__file__).resolve().parents[3] / "pyproject.toml"
NAMED_ELSEWHERE = {"interval_source", "intervals"}
"""The sources of intervals, and the intervals of `values` by the name of the quantity."""


@pytest.fixture
def shapes(schema: Schema) -> dict[str, Schema]:
    schemas: dict[str, Schema] = schema["components"]["schemas"]
    assert {operation.result.__name__ for operation in operations().values()} <= set(schemas)
    return schemas


def _fields(shapes: dict[str, Schema]) -> Iterator[tuple[str, str, Schema, dict[str, Schema]]]:
    """Shape, field, the field's schema and all fields beside it; not those of an earlier name."""
    for shape, of in shapes.items():
        fields = {n: f for n, f in of.get("properties", {}).items() if not f.get("deprecated")}
        for name, field in fields.items():
            yield shape, name, field, fields


def _bare(schema: Schema) -> Any:
    """A schema without words and without null."""
    kinds = [kind for kind in schema.get("anyOf", [schema]) if kind != {"type": "null"}]
    wordless = {k: v for k, v in kinds[0].items() if k not in ("title", "description", "default")}
    return {k: _bare(v) if isinstance(v, dict) else v for k, v in wordless.items()}


def _of_ends(schema: Schema) -> Schema:
    """The schema of an interval with its ends in place of itself: one for every value of a map."""
    bare = _bare(schema)
    if "additionalProperties" in bare:
        return bare | {"additionalProperties": _of_ends(bare["additionalProperties"])}
    low, high = (_bare(end) for end in bare["prefixItems"])
    assert low == high
    assert (bare["minItems"], bare["maxItems"]) == (2, 2)
    return dict(low)


def test_an_interval_is_low_and_high_in_shape_and_unit_of_the_value_it_is_named_after(
    shapes: dict[str, Schema],
) -> None:
    seen = 0
    for shape, name, field, beside in _fields(shapes):
        if "interval" in name and name not in NAMED_ELSEWHERE:
            value = name.replace("_interval", "")
            assert value in beside, f"{shape}.{name} belongs to no value"
            assert _of_ends(field) == _bare(beside[value]), f"{shape}.{name}"
            seen += 1
    assert seen > 30


def test_every_interval_names_its_source_in_its_own_result_or_in_the_one_around_it(
    shapes: dict[str, Schema],
) -> None:
    """A material file is no result: it says what its user knows."""
    parents: dict[str, set[str]] = {shape: set() for shape in shapes}
    for shape, _, field, _ in _fields(shapes):
        for inner in _named(field):
            parents[inner].add(shape)

    def named(shape: str) -> bool:
        around = parents[shape] & results
        return "interval_source" in shapes[shape]["properties"] or (
            bool(around) and all(map(named, around))
        )

    results = {shape for shape in shapes if not shape.endswith(("Document", "Request", "Input"))}
    with_intervals = {
        shape
        for shape, name, _, _ in _fields(shapes)
        if shape in results and ("interval" in name or ("with" in name and "spread" in name))
    }
    assert len(with_intervals) > 20
    assert [shape for shape in sorted(with_intervals) if not named(shape)] == []


def _named(schema: Any) -> Iterator[str]:
    """Names of the shapes that a schema refers to."""
    if isinstance(schema, dict):
        if "$ref" in schema:
            yield schema["$ref"].rpartition("/")[2]
        schema = list(schema.values())
    if isinstance(schema, list):
        for part in schema:
            yield from _named(part)


def test_no_interval_is_written_otherwise(shapes: dict[str, Schema]) -> None:
    """`FieldColours` has the ends of a colour map, which are no interval."""
    for shape, name, _, _ in _fields(shapes):
        parts = set(name.split("_"))
        assert shape == "FieldColours" or not parts & {"low", "high", "margin", "lower", "upper"}


def test_charts_repeats_and_cells_are_each_written_in_one_way(shapes: dict[str, Schema]) -> None:
    """A chart is lines, a repeat has its rows between slashes; both have their top row first."""
    descriptions = {
        kind: kind.__metadata__[0].description
        for kind in (ChartLines, RepeatText, Motif, CellLines)
    }
    ways = {
        "chart": ("K/P lines, the top row first",),
        "repeat": (descriptions[RepeatText],),
        "fill": (descriptions[RepeatText], "Repeat that fills it"),
        "motif": (descriptions[Motif],),
        "cells": (descriptions[CellLines],),
        "outline": ("Lines of x",),
    }
    seen = set()
    for shape, name, field, _ in _fields(shapes):
        if name in ways and _bare(field).get("type") == "string":
            words = field.get("description", "")
            assert words.startswith(ways[name]), f"{shape}.{name}: {words}"
            seen.add(name)
    assert seen == set(ways)


def test_rows_and_columns_count_from_0_at_the_bottom_left(shapes: dict[str, Schema]) -> None:
    places = {"row": 0, "column": 0}
    for shape, name, field, _ in _fields(shapes):
        if name in places and field.get("type") == "integer":
            assert "rom 0" in field["description"], f"{shape}.{name}"
            assert field.get("minimum", 0) == 0, f"{shape}.{name}"
            places[name] += 1
    assert min(places.values()) >= 4


@pytest.mark.parametrize("written", ["KP\nPP", "KP/PP", "kp\n--"])
def test_a_chart_is_taken_as_lines_and_with_slashes(client: TestClient, written: str) -> None:
    body = {"chart": "KP\nPP", "material": "acrylic"}
    expected = client.post("/api/v1/predict", json=body).json()
    assert client.post("/api/v1/predict", json=body | {"chart": written}).json() == expected


def test_library_commands_and_service_have_the_version_of_pyproject(client: TestClient) -> None:
    version = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]["version"]
    assert knitcore.__version__ == version
    assert printed("--version").stdout.split()[-1] == version
    assert client.get("/api/v1/version").json() == {"version": version, "api": "v1"}
    assert client.get("/openapi.json").json()["info"]["version"] == version
