"""Pages about the API, without scripts: its reference, and one for each kind of problem.

The reference is made from the schema; the documentation site shows the same.
"""

import json
import re
from collections.abc import Iterable
from functools import cache
from html import escape
from typing import Any

from fastapi import FastAPI, HTTPException, Request, Response
from fastapi.responses import HTMLResponse

from ..problems import FOLDER, KINDS
from .packed import tagged
from .schema import FIRST_PROBLEM

STYLE = """
:root {
  color-scheme: light dark;
  --page: light-dark(#ece7df, #171513);
  --panel: light-dark(#faf8f4, #24211e);
  --raised: light-dark(#ffffff, #302c28);
  --line: light-dark(#ddd5c9, #3b3631);
  --line-strong: light-dark(#8d8276, #857b70);
  --text: light-dark(#2a2521, #efe9e1);
  --muted: light-dark(#665d53, #ada297);
  --accent: light-dark(#a8321f, #f0765f);
  --accent-hover: light-dark(#8f2817, #f68f7b);
  --on-accent: light-dark(#ffffff, #25100b);
  --danger: light-dark(#9c2413, #ff9783);
}
html { background: var(--panel); color: var(--text); }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 0 auto; padding: 1rem; }
a { color: var(--accent); }
code, pre { font: 14px/1.45 ui-monospace, monospace; overflow-wrap: anywhere; }
pre { background: var(--raised); padding: .7rem; overflow: auto; white-space: pre-wrap; }
details { border-top: 1px solid var(--line); padding: .4rem 0; }
summary { cursor: pointer; }
summary b { display: inline-block; min-width: 4.5rem; }
table { border-collapse: collapse; width: 100%; }
td, th { border-top: 1px solid var(--line); padding: .25rem .8rem .25rem 0; }
td, th { text-align: left; vertical-align: top; }
nav a { margin-right: 1rem; }
"""


def page(title: str, content: str, style: str = "", mark: str = "") -> str:
    """A page without scripts and other hosts, in the colours of the studio.

    Parameters
    ----------
    title : as text.
    content : as HTML.
    style : more rules of CSS.
    mark : HTML above the title.
    """
    return f"""<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title>
<style>{STYLE}{style}</style>
{mark}
<h1>{escape(title)}</h1>
{content}
</html>
"""


def prose(text: str, tag: str = "p") -> str:
    """Text with `names` and **words** in it; a paragraph each, or without a tag in a line."""
    marked = re.sub(r"`+([^`]+)`+", r"<code>\1</code>", escape(text))
    marked = re.sub(r"\*\*([^*]+)\*\*", r"<b>\1</b>", marked)
    if not tag:
        return marked
    return "".join(f"<{tag}>{part}</{tag}>" for part in marked.split("\n\n") if part)


ALL = f'<p><a href="{FOLDER}">All problems</a> · <a href="/docs">REST API</a></p>'
PAGES = frozenset({FOLDER, *(f"{FOLDER}/{name}" for name in KINDS)})


def serve_kinds(app: FastAPI) -> None:
    """Add the pages."""

    @app.get(FOLDER, include_in_schema=False)
    def kinds() -> HTMLResponse:
        return HTMLResponse(page("Knitcore: problems", "".join(map(_part, KINDS))))

    @app.get(FOLDER + "/{name}", include_in_schema=False)
    def kind(name: str) -> HTMLResponse:
        if name not in KINDS:
            raise HTTPException(404)
        return HTMLResponse(page(f"Knitcore: problem {name}", _part(name) + ALL))


def _part(name: str) -> str:
    kind = KINDS[name]
    return (
        f'<h2><a href="{FOLDER}/{name}">{name}</a></h2>{prose(kind.means)}{prose(kind.remedy)}'
        f"<p>Status: {kind.statuses}</p>"
    )


Schema = dict[str, Any]

MAX_EXAMPLE = 3_000
"""Characters; longer examples are cut, since they end in lists of numbers."""
UNSAID = "Successful Response"
"""FastAPI's description of answers without one."""
BOUNDS = {
    "minimum": "≥",
    "exclusiveMinimum": ">",
    "maximum": "≤",
    "exclusiveMaximum": "<",
    "minLength": "characters ≥",
    "maxLength": "characters ≤",
    "minItems": "items ≥",
    "maxItems": "items ≤",
}


def serve_reference(app: FastAPI) -> None:
    """Add the page at ``/docs``."""

    @cache
    def made() -> bytes:
        return reference(app.openapi()).encode()

    @app.get("/docs", include_in_schema=False)
    def docs(request: Request) -> Response:
        return tagged(made(), request.headers, "text/html")


def reference(schema: Schema) -> str:
    """The page of an OpenAPI schema."""
    rooms: dict[str, list[str]] = {}
    for path, methods in schema["paths"].items():
        for method, operation in methods.items():
            room = operation.get("tags", ["service"])[0]
            rooms.setdefault(room, []).append(_operation(method.upper(), path, operation))
    shapes = [_shape(name, shape) for name, shape in schema["components"]["schemas"].items()]
    links = "".join(f'<a href="#{room}">{room}</a>' for room in (*rooms, "shapes"))
    parts = [
        f'<h2 id="{room}">{room}</h2>' + "".join(operations) for room, operations in rooms.items()
    ]
    content = f"""<p>Every operation, its request and its answer. Requests are JSON
(<code>Content-Type: application/json</code>). Every refusal is a
<a href="{FOLDER}">problem</a> that names the field and the remedy
(<a href="#Problem">its shape</a>). For programs: <a href="/openapi.json">openapi.json</a>.</p>
{prose(schema["info"]["description"])}
<nav>{links}</nav>
{"".join(parts)}
<h2 id="shapes">shapes</h2>
{"".join(shapes)}"""
    return page(f"{schema['info']['title']} {schema['info']['version']}: REST API", content)


def _operation(method: str, path: str, operation: Schema) -> str:
    parts = [prose(operation.get("description", ""))]
    if parameters := operation.get("parameters"):
        parts.append(_table("parameter", map(_parameter, parameters)))
    if body := operation.get("requestBody"):
        content = body["content"]["application/json"]
        parts.append(f"<p>Send {_kind(content['schema'])}:</p>{_example(content)}")
    refusals = []
    for status, response in operation["responses"].items():
        text = prose(response["description"], tag="")
        if int(status) >= FIRST_PROBLEM:
            refusals.append(f"<tr><td>{status}</td><td>{text}</td></tr>")
            continue
        for media, content in response.get("content", {"": {}}).items():
            kind = _kind(content["schema"]) if content.get("schema") else escape(media) or "nothing"
            text = "" if text == UNSAID else f". {text}"
            parts.append(f"<p>{status}: {kind}{text}</p>{_example(content)}")
    parts.append(f"<table>{''.join(refusals)}</table>")
    name = f"<b>{method}</b><code>{escape(path)}</code> {prose(operation['summary'], tag='')}"
    return f"<details><summary>{name}</summary>{''.join(parts)}</details>"


def _parameter(parameter: Schema) -> tuple[str, str, str]:
    of = parameter["schema"]
    kind = f"{parameter['in']}, {_kind(of)}{_or_else(of, parameter['required'])}"
    return parameter["name"], kind, parameter.get("description", "")


def _shape(name: str, shape: Schema) -> str:
    text = f'<h3 id="{escape(name)}">{escape(name)}</h3>{prose(shape.get("description", ""))}'
    if "properties" not in shape:
        return f"{text}<p>{_kind(shape)}</p>"
    required = shape.get("required", ())
    rows = (
        (field, _kind(of) + _or_else(of, field in required), of.get("description", ""))
        for field, of in shape["properties"].items()
    )
    return text + _table("field", rows)


def _table(what: str, rows: Iterable[tuple[str, str, str]]) -> str:
    lines = (
        f"<tr><td>{_code(name)}</td><td>{kind}</td><td>{prose(text, tag='')}</td></tr>"
        for name, kind, text in rows
    )
    return f"<table><tr><th>{what}</th><th>kind</th><th></th></tr>{''.join(lines)}</table>"


def _kind(of: Schema) -> str:
    """The type of a value, in a few words."""
    if "$ref" in of:
        name = escape(of["$ref"].rsplit("/", 1)[1])
        return f'<a href="#{name}">{name}</a>'
    for choice in ("anyOf", "oneOf"):
        if choice in of:
            return " or ".join(_kind(option) for option in of[choice])
    if "enum" in of or "const" in of:
        return " or ".join(_code(value) for value in of.get("enum", [of.get("const")]))
    kind = str(of.get("type", "anything"))
    if kind == "array":
        items = of.get("items") or {"anyOf": of.get("prefixItems", [{}])}
        kind = f"list of {_kind(items)}"
    elif isinstance(of.get("additionalProperties"), dict):
        kind = f"object of {_kind(of['additionalProperties'])}"
    bounds = [f"{sign} {of[name]:,.12g}" for name, sign in BOUNDS.items() if name in of]
    pattern = [f"like {_code(of['pattern'])}"] if "pattern" in of else []
    return ", ".join([kind, *bounds, *pattern])


def _or_else(of: Schema, required: bool) -> str:
    """The default of a value."""
    if required:
        return ""
    return ", optional" if of.get("default") is None else f", {_code(of['default'])} if left out"


def _example(content: Schema) -> str:
    if content.get("example") is None:
        return ""
    text = json.dumps(content["example"], indent=2, ensure_ascii=False)
    if len(text) > MAX_EXAMPLE:
        text = f"{text[:MAX_EXAMPLE]}\n…"
    return f"<pre>{escape(text)}</pre>"


def _code(value: object) -> str:
    text = value if isinstance(value, str) else json.dumps(value)
    return f"<code>{escape(text)}</code>"
