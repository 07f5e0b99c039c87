"""Write the Python client (``make client``): what ``client/`` has and what the service determines.

``models.py`` is made from the models of requests and answers, ``operations.py`` from the registry,
and ``sync.py`` from ``aio.py``.
"""

import keyword
import shutil
import textwrap
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from app.operations.registry import Operation, operations
from app.service.designs.document import DesignDocument
from app.service.jobs.kinds import KINDS
from scripts.page_types import ANSWERED, ASKED, Schema, shapes

ROOT = Path(__file__).resolve().parent.parent
SOURCES = ROOT / "client"
HEAD = '"""{} (made by scripts/client_code.py)."""\n\nfrom __future__ import annotations\n\n'
SIMPLE = {"integer": "int", "number": "float", "string": "str", "boolean": "bool", "null": "None"}
FILE = "UploadedFile"
TO_SYNC = {
    "AsyncIterator": "Iterator",
    "AsyncClient": "Client",
    "AsyncBaseTransport": "BaseTransport",
    "AsyncOperations": "Operations",
    "async def": "def",
    "async with": "with",
    "async for": "for",
    "await asyncio.sleep": "time.sleep",
    "await ": "",
    "__aenter__": "__enter__",
    "__aexit__": "__exit__",
    "aclose": "close",
    "aiter_lines": "iter_lines",
    "aread": "read",
    "import asyncio\n": "import time\n",
    "asynchronous": "synchronous",
}


def write(folder: Path) -> None:
    """Write the client, from which a wheel can be built, into a folder."""
    ignored = shutil.ignore_patterns("__pycache__", "build", "*.egg-info")
    shutil.copytree(SOURCES, folder, ignore=ignored, dirs_exist_ok=True)
    package = folder / "knitcore_client"
    made = {
        "models.py": _models(),
        "operations.py": _operations(),
        "sync.py": _sync((package / "aio.py").read_text(encoding="utf-8")),
    }
    for name, text in made.items():
        (package / name).write_text(text, encoding="utf-8")


def _sync(text: str) -> str:
    """The module of the client that waits."""
    head, _, body = text.partition("\n")
    del head
    return _synchronous(f'"""The client that waits (made by scripts/client_code.py)."""\n{body}')


def _models() -> str:
    made = operations().values()
    given = shapes([*(known.request for known in made), *ASKED, DesignDocument], "validation")
    answered = shapes([*(known.result for known in made), *ANSWERED], "serialization")
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    parts = [
        HEAD.format("Requests and answers of the service")
        + "from pathlib import Path\n"
        + "from typing import Any, Literal, NotRequired, TypedDict\n\n"
        + "from pydantic import AwareDatetime, BaseModel, RootModel\n",
        f'VERSION = "{version}"\n"""Version of the program that it was made from."""',
    ]
    for name, shape in sorted((given | answered).items(), key=lambda item: "enum" not in item[1]):
        if "properties" not in shape:
            parts.append(_alias(name, shape))
        elif name in answered:
            parts.append(_class(name, given.get(name, shape), "BaseModel"))
        else:
            parts.append(_class(name, shape, "TypedDict"))
    results = " | ".join(operation.result.__name__ for operation in KINDS.values())
    parts.append(f'JobResult = {results}\n"""The result of a job; its ``kind`` says which."""')
    return "\n\n".join(parts) + "\n"


def _alias(name: str, shape: Schema) -> str:
    if "enum" in shape or "const" in shape:
        return f"{name} = {_type(shape)}"
    return f"class {name}(RootModel[{_type(shape)}]):\n{_doc(shape)}"


def _class(name: str, shape: Schema, base: str) -> str:
    fields = "".join(_fields(shape, base))
    return f"class {name}({base}):\n{_doc(shape)}\n{fields}"


def _fields(shape: Schema, base: str) -> Iterator[str]:
    required = shape.get("required", ())
    for name, of in shape["properties"].items():
        kind, rest = _type(of), ""
        if name not in required and base == "TypedDict":
            kind = f"NotRequired[{kind}]"
        elif name not in required and not isinstance(of.get("default", {}), dict):
            rest = f" = {of['default']!r}"
        elif name not in required:
            kind, rest = f"{kind} | None".replace(" | None | None", " | None"), " = None"
        yield f"    {name}: {kind}{rest}\n{_comment(of)}"


def _doc(shape: Schema) -> str:
    text = (
        " ".join(shape.get("description", "").split("\n\n")[0].split()) or "As the service has it."
    )
    return textwrap.indent(textwrap.fill(f'"""{text}"""', 94), "    ") + "\n"


def _comment(of: Schema) -> str:
    text = " ".join(of.get("description", "").split())
    return textwrap.indent(textwrap.fill(f'"""{text}"""', 94), "    ") + "\n" if text else ""


def _type(of: Schema) -> str:
    """A JSON schema as a type."""
    if "$ref" in of:
        name = str(of["$ref"]).rsplit("/", 1)[1]
        return f"{name} | Path" if name == FILE else name
    if "const" in of or "enum" in of:
        return f"Literal[{', '.join(map(repr, of.get('enum', [of.get('const')])))}]"
    choices = of.get("anyOf", of.get("oneOf"))
    if choices is not None:
        return " | ".join(dict.fromkeys(map(_type, choices)))
    if of.get("format") == "date-time":
        return "AwareDatetime"
    made = {"array": _list, "object": _object}.get(of.get("type", ""))
    return made(of) if made else SIMPLE.get(str(of.get("type")), "Any")


def _list(of: Schema) -> str:
    if "prefixItems" in of:
        return f"tuple[{', '.join(map(_type, of['prefixItems']))}]"
    return f"list[{_type(of.get('items', {}))}]"


def _object(of: Schema) -> str:
    values, keys = of.get("additionalProperties"), of.get("propertyNames", {})
    key = _type(keys) if "$ref" in keys else "str"
    return f"dict[{key}, {_type(values) if isinstance(values, dict) else 'Any'}]"


def _operations() -> str:
    methods = "\n\n".join(
        map(_method, (known for known in operations().values() if known.path is not None))
    )
    submit = "".join(_kind(known, "submit", "JobStatus") for known in KINDS.values())
    run = "".join(_kind(known, "run", known.result.__name__) for known in KINDS.values())
    both = [
        f'''class AsyncOperations:
    """Every operation of the service, as a method."""

    async def _ask(self, result: type[Model], method: str, path: str, request: Any) -> Model:
        raise NotImplementedError

    async def _submit(self, kind: str, request: Any) -> JobStatus:
        raise NotImplementedError

    async def _run(self, kind: str, request: Any) -> JobResult:
        raise NotImplementedError

{methods}

{submit}
    async def submit(self, kind: Any, **request: Any) -> JobStatus:
        """Run an operation in the background."""
        return await self._submit(kind, request)

{run}
    async def run(self, kind: Any, **request: Any) -> JobResult:
        """The result of an operation that runs in the background; given up, it is cancelled."""
        return await self._run(kind, request)
'''
    ]
    both.append(_synchronous(both[0]))
    used = {known.request.__name__ for known in operations().values()} - {"NoRequest"}
    used |= {known.result.__name__ for known in operations().values()} | {"JobStatus", "JobResult"}
    return (
        HEAD.format("A method for every operation")
        + "from typing import Any, Literal, TypeVar, Unpack, overload\n\n"
        + "from pydantic import BaseModel\n\n"
        + f"from knitcore_client.models import ({', '.join(sorted(used))})\n\n"
        + 'Model = TypeVar("Model", bound=BaseModel)\n\n\n'
        + "\n\n".join(both)
    )


def _method(operation: Operation[Any, Any]) -> str:
    name = f"{operation.name}_" if keyword.iskeyword(operation.name) else operation.name
    result = operation.result.__name__
    asks = operation.request.__name__
    given, sent = (f", **request: Unpack[{asks}]", "request") if asks != "NoRequest" else ("", "{}")
    where = f'"{operation.method}", "{operation.address}"'
    return f'''    async def {name}(self{given}) -> {result}:
        """{operation.summary}."""
        return await self._ask({result}, {where}, {sent})'''


def _kind(operation: Operation[Any, Any], method: str, result: str) -> str:
    """One of the ways to submit a job, or to run it to its end."""
    asks = f"**request: Unpack[{operation.request.__name__}]"
    return f'''    @overload
    async def {method}(self, kind: Literal["{operation.name}"], {asks}) -> {result}: ...
'''


def _synchronous(text: str) -> str:
    for old, new in TO_SYNC.items():
        text = text.replace(old, new)
    return text


if __name__ == "__main__":
    write(ROOT / "build" / "client")
