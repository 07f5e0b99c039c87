"""Computations of scripts on every stored repeat, beginning with its relaxed shape."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.batch import run_batch
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.library.characterise import Document
from knitcore.yarn.library.fingerprint import content_key
from knitcore.yarn.library.store import MATERIALS, StoredStitch, stored_charts, stored_stitch
from knitcore.yarn.model.cell import YarnCell
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.splines import COARSE, FINE
from scripts.stored_stitches import DATA, tell


@dataclass(frozen=True)
class StoredTask:
    """A stored repeat to begin with.

    Parameters
    ----------
    chart : rows from the top, separated by ``/``.
    yarn, loop_length_mm, convention : of its relaxation.
    size_mm : (course, wale) of a stitch.
    energy_n_mm : per stitch, of the mirrored state.
    controls : (rows, columns * N, 3) its control points without the drift, mm.
    """

    chart: str
    yarn: YarnModel
    loop_length_mm: float
    convention: Convention
    size_mm: tuple[float, float]
    energy_n_mm: float
    controls: list[list[list[float]]]

    @classmethod
    def of(cls, stored: StoredStitch) -> StoredTask:
        """The task of a stored repeat."""
        return cls(
            stored.chart.key, stored.yarn, stored.loop_length_mm, stored.convention,
            (stored.cell_course_mm, stored.cell_wale_mm), stored.energy_n_mm,
            stored.controls.tolist(),
        )  # fmt: skip

    def begun(
        self, cell_of: Callable[[StitchChart, SplineGrid], YarnCell]
    ) -> tuple[CellEnergy, Array]:
        """Energy of a cell of the repeat, and its unknowns in the stored shape."""
        chart, points = StitchChart.parse(self.chart), np.array(self.controls)
        per_stitch = points.shape[1] // chart.columns
        cell = cell_of(chart, FINE if per_stitch == FINE.controls else COARSE)
        points = np.tile(points, (-(-cell.rows // chart.rows), -(-cell.wales // chart.columns), 1))
        points = points[: cell.rows, : cell.controls_per_course]
        lengths = np.full(cell.rows, self.loop_length_mm)
        energy = CellEnergy(cell, self.yarn, lengths, self.convention)
        return energy, cell.state(points, *self.size_mm)


@dataclass(frozen=True)
class FromStore:
    """A file of the library with a result for every stored repeat.

    Parameters
    ----------
    name : of the script, and of the folder of finished results.
    file : in the library's data folder.
    compute : a task's result.
    code : the module that decides it.
    """

    name: str
    file: str
    compute: Callable[[StoredTask], Document]
    code: str

    def write(
        self, path: Path, charts: dict[str, list[StitchChart]], keep: Path,
        workers: int | None = None,
    ) -> None:  # fmt: skip
        """Compute the results of the given repeats of each material and write them.

        Raises
        ------
        KnitcoreError
            As :func:`knitcore.base.batch.run_batch`.
        """
        tasks, label = {}, {}
        for material, repeats in charts.items():
            for chart in repeats:
                stored = stored_stitch(chart, material)
                if stored is not None:
                    key, task = f"{material}/{chart.key}", StoredTask.of(stored)
                    digest = content_key(asdict(task), (self.code,))
                    label[key] = f"{key.replace('/', '-')}.{digest}"
                    tasks[label[key]] = task
        batch = run_batch(self.compute, tasks, keep=keep, workers=workers, progress=tell)
        lines = ",\n".join(
            f"{json.dumps(key)}: {json.dumps(batch.results[name])}"
            for key, name in label.items()
            if name in batch.results
        )
        path.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")

    def main(self) -> None:
        """Read the options and compute."""
        parser = argparse.ArgumentParser(prog=f"python -m scripts.{self.name}_stitches")
        parser.add_argument("--path", type=Path, default=DATA / self.file)
        parser.add_argument("--keep", type=Path, default=Path("build") / self.name)
        parser.add_argument("--workers", type=int, help="processes; all cores if left out")
        chosen = parser.parse_args()
        charts = {material: stored_charts(material) for material in MATERIALS}
        self.write(chosen.path, charts, chosen.keep, chosen.workers)
