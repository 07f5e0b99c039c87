"""The face of the library to those who import it: names, refusals of wrong arguments, results."""

import ast
import importlib
import inspect
import itertools
import math
import pkgutil
import re
import typing
from collections.abc import Iterable, Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import knitcore
from knitcore import CancelledError, InputError
from knitcore.chart.in_space import ClothInSpace
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.read.chart_files import PieceInFile
from knitcore.formats.write.export import ExportedFile
from knitcore.machine.program import KnitoutProgram
from knitcore.materials import Interval
from knitcore.prediction.learned import LearnedModel
from knitcore.yarn.study.relax import RelaxOptions

ROOT = Path(__file__).resolve().parent.parent

LIBRARY: Any = knitcore
ALL_STITCHES = np.ones((2, 2), dtype=bool)
CALLS: dict[str, dict[str, Any]] = {
    "material": {"identifier": "acrylic", "laws": "published"},
    "predict": {"chart": "KKPP", "material": "acrylic", "size": None, "swept": None},
    "curve": {
        "chart": "KP", "material": "acrylic", "direction": "course", "stress_n_per_mm": [0.1],
        "size": None,
    },
    "segment_map": {"chart": "KP/PK", "periodic": False},
    "quarter_phases": {"chart": "KP/PK", "periodic": False, "stitch": ALL_STITCHES},
    "strip_test": dict.fromkeys(inspect.signature(knitcore.strip_test).parameters)
    | {
        "chart": "KP/PK", "material": "acrylic", "direction": "wale", "strain": 0.1, "steps": 1,
        "model": "full", "clamps": "clamped", "cancelled": lambda: True,
    },
    "relax": dict.fromkeys(RelaxOptions.__annotations__)
    | {
        "chart": "K", "material": "acrylic", "loop_length_mm": None, "branch": "mirrored",
        "convention": "published", "flat": False, "cancelled": lambda: True,
    },
    "RelaxedSize": {"course_mm": 3, "wale_mm": 2, "log_sd": 0.03, "known_by": "gauge"},
    "RelaxedSize.from_gauge": {"stitches_per_10_cm": 22, "rows_per_10_cm": 30},
    "StitchChart": {"purl": ALL_STITCHES},
    "StitchChart.parse": {"text": "KP"},
    "StitchChart.of_fabric": {"fabric": "rib", "rows": 2, "columns": 2},
    "Direction.parse": {"name": "wale"},
    "Fabric.parse": {"name": "rib"},
}  # fmt: skip
"""Right arguments of everything that takes some."""
NOT_CALLED = {"Direction", "Fabric", "SegmentCounts", "SegmentMap"}
"""Classes whose objects the library makes, and enumerations."""
WRONG = [
    3, -1, 2.5, math.nan, None, True, "x", "", b"x", [], [1], ["x"], [object()], {}, {"a": 1},
    object(), int, np.zeros((2, 2)), np.array(["a"]),
]  # fmt: skip


def test_every_name_is_there_and_listed_once() -> None:
    assert len(dir(LIBRARY)) == len(set(dir(LIBRARY)))
    assert set(LIBRARY.__all__) <= set(dir(LIBRARY))
    for name in LIBRARY.__all__:
        assert getattr(LIBRARY, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'moduli'"):
        _ = LIBRARY.moduli


def test_everything_that_is_called_is_checked_here() -> None:
    called = {name for name in LIBRARY.__all__ if not name.endswith("Error")} - NOT_CALLED
    assert called <= set(CALLS)
    for name, right in CALLS.items():
        parameters = inspect.signature(_public(name)).parameters.values()
        takes = {p.name for p in parameters if p.kind is not inspect.Parameter.VAR_KEYWORD}
        assert takes <= set(right), name


@pytest.mark.parametrize(("name", "parameter"), [(n, p) for n in CALLS for p in CALLS[n]])
def test_a_wrong_argument_is_refused_with_what_to_give(name: str, parameter: str) -> None:
    """Or it has a meaning: a number in place of a list, for example."""
    for wrong in WRONG:
        if wrong is int and parameter in ("progress", "cancelled"):
            continue  # a function
        try:
            _public(name)(**CALLS[name] | {parameter: wrong})
        except CancelledError:
            continue
        except InputError as error:
            assert error.remedy.endswith("."), error  # noqa: PT017


NO_RESULTS = {
    StitchChart, SymbolChart, Interval, KnitoutProgram, LearnedModel, PieceInFile, ExportedFile
}  # fmt: skip
"""Kinds that functions return, but that are inputs, a pair of numbers, a model, or the content of a
file."""


def test_results_of_functions_become_plain_values() -> None:
    """Functions are the public ones, those that the documentation shows in Python and, where they
    return arrays, those that operations call."""
    shown = {*_imported(_documentation()), *(_public(name) for name in LIBRARY.__all__)}
    called = _imported(file.read_text("utf-8") for file in (ROOT / "app/operations").rglob("*.py"))
    results = _results(shown) | {kind for kind in _results(called) if _has_arrays(kind)}
    assert len(results) > 40
    for kind in results - NO_RESULTS:
        assert hasattr(kind, "to_dict"), kind


def test_results_with_arrays_have_short_texts_and_cloth_is_written_for_other_programs() -> None:
    modules = pkgutil.walk_packages(LIBRARY.__path__, "knitcore.")
    members = (vars(importlib.import_module(module.name)).values() for module in modules)
    for kind in set(filter(inspect.isclass, itertools.chain.from_iterable(members))):
        if issubclass(kind, Result) and is_dataclass(kind):
            text_is_made_by_dataclass = hasattr(kind.__repr__, "__wrapped__")
            assert not (text_is_made_by_dataclass and _has_arrays(kind)), kind
            has_corners = "corners_mm" in {field.name for field in fields(kind)}
            assert issubclass(kind, ClothInSpace) or not has_corners, kind


def _documentation() -> Iterator[str]:
    for page in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]:
        yield from re.findall(r"(?ms)^```python\n(.*?)^```", page.read_text("utf-8"))


def _imported(programs: Iterable[str]) -> set[Any]:
    """Functions that programs import from the library."""
    nodes = itertools.chain.from_iterable(ast.walk(ast.parse(program)) for program in programs)
    objects = (
        getattr(importlib.import_module(node.module), name.name)
        for node in nodes
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("knitcore")
        for name in node.names
        if node.module
    )
    return set(filter(inspect.isfunction, objects))


def _results(functions: Iterable[Any]) -> set[Any]:
    hints = [typing.get_type_hints(f).get("return") for f in functions if inspect.isfunction(f)]
    kinds = itertools.chain.from_iterable((hint, *typing.get_args(hint)) for hint in hints)
    return {kind for kind in kinds if inspect.isclass(kind) and is_dataclass(kind)}


def _has_arrays(kind: Any) -> bool:
    return any("ndarray" in str(hint) for hint in typing.get_type_hints(kind).values())


def _public(name: str) -> Any:
    place = LIBRARY
    for part in name.split("."):
        place = getattr(place, part)
    return place
