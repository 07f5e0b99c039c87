"""Bending of the stored repeats, from ``data/bending.json`` (``scripts/bending_stitches.py``).

A response to bending is four numbers: moment (N), rigidity with the size across free and held
(N·mm), and strain across per curvature (mm).
"""

from __future__ import annotations

import json
from dataclasses import astuple
from functools import cache
from importlib.resources import files
from typing import Any

from knitcore.yarn.study.bending import FabricBending, RepeatBending
from knitcore.yarn.study.bent_cell import BendingResponse

DIGITS = 6
"""Significant digits in the file."""
_NOTHING = 1e-9
"""Below this, in N or mm, a moment or a strain per curvature is rounding."""


def stored_bending(key: str) -> RepeatBending | None:
    """Bending of a representative of the store, by its material and chart (``acrylic/K``)."""
    entry = _entries().get(key)
    return None if entry is None else of_document(entry)


def document_of(bending: RepeatBending) -> dict[str, Any]:
    """As the file has it."""
    parts = {
        "mirrored": _state(bending.mirrored),
        "unmirrored": _state(bending.unmirrored),
        "failure": bending.failure,
        "unmirrored_failure": bending.unmirrored_failure,
    }
    return {name: part for name, part in parts.items() if part}


def of_document(entry: dict[str, Any]) -> RepeatBending:
    """From the file's entry."""
    return RepeatBending(
        mirrored=_read(entry.get("mirrored")),
        unmirrored=_read(entry.get("unmirrored")),
        failure=entry.get("failure", ""),
        unmirrored_failure=entry.get("unmirrored_failure", ""),
    )


def _state(found: FabricBending | None) -> dict[str, Any] | None:
    if found is None:
        return None
    oblique = found.oblique
    return {
        "course": _numbers(found.course),
        "wale": _numbers(found.wale),
        "oblique": None if oblique is None else [_numbers(response) for response in oblique],
        "twist_n_mm": _known(found.twist_n_mm),
        "coupling_n_mm": _known(found.coupling_n_mm),
        "shear_modulus_n_per_mm": _known(found.shear_modulus_n_per_mm),
        "thickness_mm": _short(found.thickness_mm),
        "minimum": found.minimum,
    }


def _read(state: dict[str, Any] | None) -> FabricBending | None:
    if state is None:
        return None
    diagonals = [BendingResponse(*numbers) for numbers in state["oblique"] or ()]
    return FabricBending(
        course=BendingResponse(*state["course"]),
        wale=BendingResponse(*state["wale"]),
        oblique=(diagonals[0], diagonals[1]) if diagonals else None,
        twist_n_mm=state["twist_n_mm"],
        coupling_n_mm=state["coupling_n_mm"],
        shear_modulus_n_per_mm=state["shear_modulus_n_per_mm"],
        thickness_mm=state["thickness_mm"],
        minimum=state["minimum"],
    )


def _numbers(response: BendingResponse) -> list[float]:
    return [_short(value) for value in astuple(response)]


def _known(value: float | None) -> float | None:
    return None if value is None else _short(value)


def _short(value: float) -> float:
    return 0.0 if abs(value) < _NOTHING else float(f"{value:.{DIGITS}g}")


@cache
def _entries() -> dict[str, Any]:
    path = files("knitcore.yarn.library") / "data" / "bending.json"
    entries: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return entries
