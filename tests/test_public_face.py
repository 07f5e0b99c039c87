"""What people meet who import the library: its names, and refusals of wrong arguments."""

import inspect
import math
from typing import Any

import numpy as np
import pytest

import knitcore
from knitcore import CancelledError, InputError
from knitcore.yarn.study.relax import RelaxOptions

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
        "model": "full", "clamps": "clamped", "draw_in": False, "cancelled": lambda: True,
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


def _public(name: str) -> Any:
    place = LIBRARY
    for part in name.split("."):
        place = getattr(place, part)
    return place
