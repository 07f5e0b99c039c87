"""Keys of results, made from everything that determines them: inputs, code and data.

Modules are followed along their imports; comments, words of docstrings and, as a rule, layout do
not count. Data files count where a module names them.
"""

import hashlib
import json
import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.util import resolve_name
from pathlib import Path
from types import CodeType
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
"""Folder of the packages, but for those that are installed under another name."""
SOLVERS = ("knitcore.yarn.library.characterise",)
"""The module that relaxes, stretches and fits a law; it imports all others that do."""
_FILE_NAME = re.compile(r"[\w-]+\.\w+")
_IMPORT = re.compile(
    r"^[ \t]*(?:from (\S+) import (?:\(([^)]*)\)|([^\n(]*))|import ([^\n]*))", re.MULTILINE
)
_COMMENT = re.compile(r"#.*")


@cache
def code_version(*modules: str) -> str:
    """Digest of the code of modules, of their imports from these packages, and of their data.

    Raises
    ------
    ModuleNotFoundError
        If there is no source of a module.

    Examples
    --------
    >>> len(code_version("knitcore.chart.stitch_chart"))
    16
    """
    for name in modules:
        if _file(name) is None:
            raise ModuleNotFoundError(f"there is no source of {name}", name=name)
    digest = hashlib.sha256()
    data: set[Path] = set()
    for name, source in sorted(reached(modules).items()):
        data.update(_named_data(name, source))
        digest.update(f"{name}\0{source.digest}\0".encode())
    for file in sorted(data):
        digest.update(file.name.encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()[:16]


def content_key(content: Mapping[str, Any], modules: tuple[str, ...] = SOLVERS) -> str:
    """The key of a result, from its inputs (JSON) and the modules that compute it.

    Examples
    --------
    >>> content_key({"a": 1, "b": 2}) == content_key({"b": 2, "a": 1})
    True
    """
    text = json.dumps(content, sort_keys=True, allow_nan=False)
    return hashlib.sha256(f"{code_version(*modules)}\0{text}".encode()).hexdigest()[:32]


@dataclass(frozen=True)
class ModuleCode:
    """The parts of a module that decide: its imports, file names in it, a digest of its code."""

    imports: frozenset[str]
    files: frozenset[str]
    digest: str


def reached(modules: tuple[str, ...]) -> dict[str, ModuleCode]:
    """Modules and all that they import from these packages, by name."""
    packages = {name.partition(".")[0] for name in modules}
    packages.add("knitcore")
    code_of: dict[str, ModuleCode] = {}
    waiting = list(modules)
    while waiting:
        name = waiting.pop()
        file = _file(name)
        if name in code_of or file is None:
            continue
        code_of[name] = _read(file.read_text(encoding="utf-8"))
        package = name if file.stem == "__init__" else name.rpartition(".")[0]
        imported = (resolve_name(n, package) for n in code_of[name].imports)
        waiting += [n for n in imported if n.partition(".")[0] in packages]
    return code_of


@cache
def _read(text: str) -> ModuleCode:
    """Read a module's source; compiling it takes a third of the time of a syntax tree."""
    digest, names = hashlib.sha256(), set()
    for part in _parts(compile(text, "", "exec", dont_inherit=True, optimize=2)):
        digest.update(repr(part).encode() + b"\0")
        if isinstance(part, str) and _FILE_NAME.fullmatch(part):
            names.add(part)
    return ModuleCode(frozenset(_imports(text)), frozenset(names), digest.hexdigest())


def _parts(value: Any) -> Iterator[Any]:
    """Yield what decides of a constant of compiled code: of a function, its code and constants."""
    if isinstance(value, CodeType):
        yield from (value.co_code, value.co_exceptiontable, value.co_flags)
        yield from (value.co_argcount, value.co_posonlyargcount, value.co_kwonlyargcount)
        yield from (value.co_varnames, value.co_names, value.co_cellvars, value.co_freevars)
        yield from _parts(value.co_consts)
    elif isinstance(value, tuple | frozenset):
        parts = value if isinstance(value, tuple) else sorted(value, key=repr)
        yield len(value)
        for part in parts:
            yield from _parts(part)
    else:
        yield value


def _file(module: str) -> Path | None:
    path = _folder(*module.split("."))
    candidates = (path.with_suffix(".py"), path / "__init__.py")
    return next((file for file in candidates if file.is_file()), None)


def _folder(package: str, *inside: str) -> Path:
    folder = ROOT / package
    if not folder.is_dir() and package in sys.modules:
        folder = Path(sys.modules[package].__path__[0])
    return folder.joinpath(*inside)


def _imports(text: str) -> Iterator[str]:
    """Yield modules that a source imports, and what may be modules: names imported from them."""
    for module, *lists in _IMPORT.findall(text):
        names = [
            name.split()[0] for name in _COMMENT.sub("", "".join(lists)).split(",") if name.strip()
        ]
        dot = "" if module.endswith(".") else "."
        yield from (module, *(f"{module}{dot}{name}" for name in names)) if module else names


def _named_data(module: str, source: ModuleCode) -> Iterator[Path]:
    """Files in the data folders around a module that it names."""
    parts = module.split(".")
    folders = [_folder(*parts[:k], "data") for k in range(1, len(parts))]
    for name in source.files:
        yield from (folder / name for folder in folders if (folder / name).is_file())
