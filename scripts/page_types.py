"""Write what the page takes from Python (``make types``).

That is ``frontend/types.d.ts`` from the service's models, and :mod:`scripts.page_stitches`.

Request types have optional fields; the types of answers have every field (except problems, which
the page also makes). TypeScript compares them with how the page uses them (``make lint``).
"""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel
from pydantic.json_schema import models_json_schema

from app.drawing.design_view import ViewRequest, ViewResult
from app.operations.registry import operations
from app.service.api.views import CameraRequest, MarkRequest
from app.service.designs import document as designs
from app.service.jobs.document import JobPage
from app.service.problems import Problem
from app.service.web.sessions import SignedIn
from app.viewer.share import SharedViewRequest
from knitcore.formats.designs.layout import DesignLayout
from scripts import page_stitches

FILE = Path(__file__).resolve().parent.parent / "frontend" / "types.d.ts"
HEAD = "// Made from the service's models by scripts/page_types.py (`make types`)."

Schema = dict[str, Any]

ASKED: tuple[type[BaseModel], ...] = (
    ViewRequest,
    SharedViewRequest,
    MarkRequest,
    CameraRequest,
    designs.DesignPatch,
    designs.PlaceRequest,
    designs.ShareRequest,
    designs.Strokes,
    designs.VersionRequest,
)
ANSWERED: tuple[type[BaseModel], ...] = (
    DesignLayout,
    Problem,
    JobPage,
    SignedIn,
    ViewResult,
    designs.Design,
    designs.DesignPage,
    designs.KnittingPlaces,
    designs.NewShare,
    designs.Painted,
    designs.SharedDesign,
    designs.Shares,
    designs.Version,
    designs.Versions,
    designs.VersionSummary,
)
SIMPLE = {
    "integer": "number",
    "number": "number",
    "string": "string",
    "boolean": "boolean",
    "null": "null",
}


def page_types() -> str:
    """The content of the file."""
    made = operations().values()
    requests = [*(operation.request for operation in made), *ASKED]
    answered = [*(operation.result for operation in made), *ANSWERED]
    declared = shapes(requests, "validation")
    for name, shape in shapes(answered, "serialization").items():
        required = shape.get("required") if name == "Problem" else list(shape.get("properties", ()))
        declared[name] = shape | {"required": required}
    parts = [_declared(name, shape) for name, shape in sorted(declared.items())]
    return "\n\n".join([HEAD, *parts, _addresses()]) + "\n"


def _addresses() -> str:
    """Models of request and result of each operation that is posted, by its address."""
    lines = [
        f'  "{operation.address.removeprefix("/")}":'
        f" {{ request: {operation.request.__name__}; result: {operation.result.__name__} }};"
        for operation in operations().values()
        if operation.method == "POST" and operation.path is not None
    ]
    head = "/** Operations by their address. */\nexport interface Operations {"
    return "\n".join([head, *sorted(lines), "}"])


def shapes(
    models: Sequence[type[BaseModel]], mode: Literal["validation", "serialization"]
) -> dict[str, Schema]:
    """JSON schemas of models and of the models in their fields, by name."""
    _, schema = models_json_schema([(model, mode) for model in models])
    definitions: dict[str, Schema] = schema["$defs"]
    return definitions


def _name(of: dict[str, Any]) -> str:
    return str(of["$ref"]).rsplit("/", 1)[1]


def _declared(name: str, shape: dict[str, Any]) -> str:
    if "properties" not in shape:
        return f"{_comment(shape, '')}export type {name} = {_type(shape)};"
    lines = "\n".join(_fields(shape))
    return f"{_comment(shape, '')}export interface {name} {{\n{lines}\n}}"


def _fields(shape: dict[str, Any]) -> Iterator[str]:
    for field, of in shape["properties"].items():
        mark = "" if field in shape.get("required", ()) else "?"
        yield f"{_comment(of, '  ')}  {field}{mark}: {_type(of)};"


def _comment(shape: dict[str, Any], indent: str) -> str:
    text = " ".join(shape.get("description", "").split("\n\n")[0].split())
    return f"{indent}/** {text} */\n" if text else ""


def _type(of: dict[str, Any]) -> str:
    """A JSON schema as a type."""
    if "$ref" in of:
        return _name(of)
    if "const" in of or "enum" in of:
        return " | ".join(json.dumps(value) for value in of.get("enum", [of.get("const")]))
    choices = of.get("anyOf", of.get("oneOf"))
    if choices is not None:
        return " | ".join(dict.fromkeys(map(_type, choices)))
    kinds = {"array": _list, "object": _object}
    kind = str(of.get("type"))
    return kinds[kind](of) if kind in kinds else SIMPLE.get(kind, "unknown")


def _list(of: dict[str, Any]) -> str:
    if "prefixItems" in of:
        return f"[{', '.join(map(_type, of['prefixItems']))}]"
    item = _type(of.get("items", {}))
    return f"({item})[]" if " | " in item else f"{item}[]"


def _object(of: dict[str, Any]) -> str:
    values = of.get("additionalProperties")
    value = _type(values) if isinstance(values, dict) else "unknown"
    if "$ref" not in of.get("propertyNames", {}):
        return f"Record<string, {value}>"
    key = _name(of["propertyNames"])
    # of both directions there is always one; of the fabrics a material may lack some
    return f"Record<{key}, {value}>" if key == "Direction" else f"Partial<Record<{key}, {value}>>"


if __name__ == "__main__":
    FILE.write_text(page_types(), encoding="utf-8")
    page_stitches.write()
