"""The import contract: every package of the house imports from the floors below it only."""

import ast
import importlib.util
import re
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

FLOORS = (
    {"base"},
    {"chart", "linear"},
    {"law", "measure"},
    {"materials"},
    {"mechanics"},
    {"yarn"},
    {"prediction"},
    {"garment"},
    {"cloth"},
    {"draw", "fit"},
    {"machine"},
    {"design", "formats", "notebook", "compile_share", "warm_up"},
)
"""Rooms of ``knitcore`` from the ground up; one imports from lower floors only."""

APP_FLOORS = (
    {"cli.options", "identity", "listeners", "memory", "problems"},
    {"limits", "periodic", "settings"},
    {"results"},
    {"context"},
    {"requests"},
    {"drawing", "store"},
    {"operations"},
    {"compute", "web"},
    {"designs", "doctor"},
    {"health", "jobs", "viewer"},
    {"api"},
    {"main"},
    {"cli"},
)
"""Rooms of ``app`` and ``app/service`` from the ground up; one imports from lower floors only.

A module that stands on a floor of its own has a dotted name: operations declare the options of
their commands with ``app.cli.options``.
"""


CLASS = re.compile(r"^class (\w+)", re.MULTILINE)


@cache
def imports(file: Path) -> frozenset[str]:
    modules: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            modules |= {node.module} | {f"{node.module}.{name.name}" for name in node.names}
        elif isinstance(node, ast.Import):
            modules |= {name.name for name in node.names}
    return frozenset(modules)


ROOMS = sorted(
    path
    for path in (ROOT / "knitcore").iterdir()
    if path.suffix == ".py" or (path / "__init__.py").exists()
)


@pytest.mark.parametrize("room", ROOMS, ids=lambda path: path.stem)
def test_a_room_imports_from_lower_floors_only(room: Path) -> None:
    if room.stem == "__init__":
        return
    floor = next((i for i, names in enumerate(FLOORS) if room.stem in names), None)
    assert floor is not None, f"{room.stem} has no floor yet: add it to FLOORS"
    below = {name for names in FLOORS[:floor] for name in names} | {room.stem}
    files = room.rglob("*.py") if room.is_dir() else [room]
    modules = [module.split(".") for file in files for module in imports(file)]
    known = {name for names in FLOORS for name in names}
    used = {parts[1] for parts in modules if parts[0] == "knitcore" and len(parts) > 1}
    assert used & known <= below


MOST_FILES = 15
"""Modules of a folder that one can still survey."""


def test_a_folder_is_surveyed_at_a_glance() -> None:
    folders = [path for top in ("knitcore", "app") for path in (ROOT / top).rglob("*/")]
    files = {folder: [*folder.glob("*.py")] for folder in folders}
    assert not [
        folder.name
        for folder, modules in files.items()
        if len([module for module in modules if module.stem != "__init__"]) > MOST_FILES
    ]


def test_no_two_modules_of_the_library_have_one_name() -> None:
    names = [file.stem for file in (ROOT / "knitcore").rglob("*.py") if file.stem != "__init__"]
    assert len(names) == len(set(names))


def test_a_name_of_a_class_means_one_thing() -> None:
    """Names for use within a module begin with an underscore, and do not count."""
    files = [file for top in ("knitcore", "app") for file in (ROOT / top).rglob("*.py")]
    names = [name for file in files for name in CLASS.findall(file.read_text(encoding="utf-8"))]
    public = Counter(name for name in names if not name.startswith("_"))
    assert [name for name, count in public.items() if count > 1] == []


def test_the_library_does_not_import_the_service() -> None:
    outside = {"app", "fastapi", "starlette", "uvicorn", "sqlalchemy", "viser"}
    for file in (ROOT / "knitcore").rglob("*.py"):
        assert not {module.split(".")[0] for module in imports(file)} & outside, file


@pytest.mark.parametrize("folder", ["knitcore", "app", "scripts"])
def test_nothing_imports_the_scripts_or_the_studies_that_use_it(folder: str) -> None:
    above = {"studies", "scripts"} - {folder}
    for file in (ROOT / folder).rglob("*.py"):
        assert not {module.split(".")[0] for module in imports(file)} & above, file


def test_studies_import_neither_tests_nor_documentation() -> None:
    for file in (ROOT / "studies").rglob("*.py"):
        assert not {module.split(".")[0] for module in imports(file)} & {"docs", "tests"}, file
        assert "sys.path" not in file.read_text(encoding="utf-8"), file


@pytest.mark.parametrize("folder", ["studies", "examples", "scripts"])
def test_what_programs_beside_the_product_import_from_it_exists(folder: str) -> None:
    for file in (ROOT / folder).rglob("*.py"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        for node in (n for n in ast.walk(tree) if isinstance(n, ast.ImportFrom)):
            if re.match(r"(knitcore|app)\b", node.module or ""):
                module = importlib.import_module(str(node.module))
                missing = {n.name for n in node.names if not hasattr(module, n.name)}
                assert all(importlib.util.find_spec(f"{module.__name__}.{n}") for n in missing)


ACROSS = {"notebook/test_notebook.py", "prediction/test_continuity.py"}
"""Tests that several modules of ``knitcore`` must pass together."""


def test_tests_of_the_library_stand_where_their_modules_do() -> None:
    tests = ROOT / "tests" / "knitcore"
    files = {file.relative_to(tests) for file in tests.rglob("test_*.py")}
    modules = {file: file.with_name(file.name.removeprefix("test_")) for file in files}
    without = {file for file, name in modules.items() if not (ROOT / "knitcore" / name).exists()}
    assert {file.as_posix() for file in without} == ACROSS


APP_FLOOR = {name: floor for floor, names in enumerate(APP_FLOORS) for name in names}


def app_room(module: str) -> str | None:
    """The room of the service that a module belongs to."""
    first, *parts = module.replace("app.service.", "app.").split(".")
    if first != "app":
        return None
    names = (".".join(parts[:2]), *parts[:1])
    return next((name for name in names if name in APP_FLOOR), None)


def test_a_room_of_the_service_imports_from_lower_floors_only() -> None:
    for file in (ROOT / "app").rglob("*.py"):
        module = ".".join(file.relative_to(ROOT).with_suffix("").parts)
        if module in ("app.__init__", "app.service.__init__"):
            continue
        room = app_room(module)
        assert room is not None, f"{module} has no floor yet: add its room to APP_FLOORS"
        for other in {app_room(name) for name in imports(file)} - {None, room}:
            assert other is not None
            assert APP_FLOOR[other] < APP_FLOOR[room], f"{file} imports from {other}"
