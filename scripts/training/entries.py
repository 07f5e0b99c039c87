"""The training library: relaxed sizes, raw curves and failures of repeats.

``scripts/training/build.py`` packs them into ``library.json.xz``.
"""

import json
import lzma
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.yarn.model.yarn_model import YarnModel

FILE = Path(__file__).parent / "library.json.xz"


@dataclass(frozen=True, eq=False)
class RawCurve:
    """A stretch as computed, including its jumps."""

    strain: Array
    transverse_strain: Array
    stress_n_per_mm: Array

    def strain_at(self, stress_n_per_mm: Array) -> Array:
        """Strain where a stress is first reached; nan beyond the end."""
        reached = np.maximum.accumulate(self.stress_n_per_mm)
        first = np.searchsorted(reached, stress_n_per_mm)
        strain = np.full(np.shape(stress_n_per_mm), np.nan)
        inside = (first > 0) & (first < len(reached))
        i = first[inside]
        low, high = self.stress_n_per_mm[i - 1], self.stress_n_per_mm[i]
        part = (stress_n_per_mm[inside] - low) / (high - low)
        strain[inside] = self.strain[i - 1] + part * (self.strain[i] - self.strain[i - 1])
        return strain

    def poisson(self, most_stress_n_per_mm: float = 0.3) -> float:
        """Slope of the contraction over the strain, up to a stress."""
        used = np.maximum.accumulate(self.stress_n_per_mm) <= most_stress_n_per_mm
        return -float(np.polyfit(self.strain[used], self.transverse_strain[used], 1)[0])


@dataclass(frozen=True, eq=False)
class TrainingEntry:
    """One repeat of one yarn.

    Attributes
    ----------
    chart, yarn_name, yarn, loop_length_mm, branch : of the relaxation.
    cell_mm : (course, wale) of the mean stitch; None where it failed for the reason in `failure`.
    curves : by direction; empty where it was only relaxed, or the stretch failed.
    law : fitted to the curves, None where there is none.
    """

    chart: StitchChart
    yarn_name: str
    yarn: YarnModel
    loop_length_mm: float
    branch: str
    cell_mm: tuple[float, float] | None
    converged: bool
    curves: Mapping[Direction, RawCurve]
    law: ConstitutiveLaw | None
    failure: str


@cache
def training_entries() -> tuple[TrainingEntry, ...]:
    """All entries, in the order of the build."""
    return tuple(_entry(document) for document in read_library())


def read_library(file: Path = FILE) -> list[dict[str, Any]]:
    """The documents in a file; none where there is no file."""
    if not file.exists():
        return []
    documents: list[dict[str, Any]] = json.loads(lzma.decompress(file.read_bytes()))
    return documents


def write_library(file: Path, documents: list[dict[str, Any]]) -> None:
    """Write documents to a file."""
    file.write_bytes(lzma.compress(json.dumps(documents, separators=(",", ":")).encode()))


def _entry(document: Mapping[str, Any]) -> TrainingEntry:
    curves = {
        Direction(name): RawCurve(*(np.array(column) for column in columns))
        for name, columns in document.get("curves", {}).items()
    }
    law = document.get("law")
    failed = "failure" in document
    size = None if failed else (document["cell_course_mm"], document["cell_wale_mm"])
    return TrainingEntry(
        chart=StitchChart.parse(document["chart"]),
        yarn_name=document["yarn_name"],
        yarn=YarnModel(**document["yarn"]),
        loop_length_mm=document["loop_length_mm"],
        branch=document["branch"],
        cell_mm=size,
        converged=document.get("converged", False),
        curves=curves,
        law=None if law is None else ConstitutiveLaw(**law),
        failure=document.get("failure", ""),
    )
