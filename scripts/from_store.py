"""Compute from every stored repeat: ``python -m scripts.from_store lowest bending``.

``lowest`` lays every repeat of the store out over its free cell, without its mirrors, follows it
along its instability if it has one, and writes what this leads to into the library's
``data/lowest.json``. ``bending`` writes the linear response to bending and shear of every repeat,
and of the minimum that its instability leads to if it has one, into ``data/bending.json``. Finished
repeats are kept in a folder, so an interrupted run can be resumed.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.batch import run_batch
from knitcore.base.errors import ConvergenceError, UnravelledError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.library.characterise import Document
from knitcore.yarn.library.fingerprint import content_key
from knitcore.yarn.library.store import (
    MATERIALS,
    StoredStitch,
    document_of,
    stored_charts,
    stored_stitch,
)
from knitcore.yarn.model.cell import YarnCell, free_cell, mirrored_cell
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.newton import TIGHT, minimise
from knitcore.yarn.solve.search import SAME_ENERGY
from knitcore.yarn.solve.splines import COARSE, FINE, relaxed_repeat
from knitcore.yarn.study.bending import repeat_bending
from knitcore.yarn.study.lowest import followed
from knitcore.yarn.study.relax import Branch
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
    file : in the library's data folder.
    compute : a task's result.
    code : the module that decides it.
    """

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


def follow(task: StoredTask) -> Document:
    """Drop the mirrors of a repeat and follow its instability.

    Returns
    -------
    A JSON document: ``failure`` alone where the descent finds no state of the fabric; otherwise
    ``minimum``, whether the mirrored state is one without its mirrors, and size (mm) and energy
    (N·mm) of a stitch of the minimum that it is or leads to.
    """
    energy, state = task.begun(free_cell)
    try:
        minimum, _ = followed(energy, state)
    except (ConvergenceError, UnravelledError) as error:
        return {"failure": str(error)}
    reached = minimum.terms.energy / energy.cell.stitches
    lower = 1.0 - reached / task.energy_n_mm
    return {
        "minimum": bool(minimum.stable and lower < SAME_ENERGY),
        "cell_course_mm": float(f"{minimum.state[-2]:.7g}"),
        "cell_wale_mm": float(f"{minimum.state[-1]:.7g}"),
        "energy_n_mm": float(f"{reached:.7g}"),
        "converged": minimum.converged,
    }


def bend(task: StoredTask) -> Document:
    """Bending of a repeat (:func:`knitcore.yarn.library.store.document_of`).

    A few steps from the stored shape recover the tension of the yarn and the digits that the store
    leaves out.
    """
    energy, state = task.begun(mirrored_cell)
    minimum = minimise(energy, state, options=TIGHT)
    relaxed = relaxed_repeat(
        StitchChart.parse(task.chart), energy, Branch.MIRRORED, minimum, seconds=0.0,
        evaluations=minimum.evaluations,
    )  # fmt: skip
    return document_of(repeat_bending(relaxed))


FILES = {
    "lowest": FromStore("lowest.json", follow, "knitcore.yarn.study.lowest"),
    "bending": FromStore("bending.json", bend, "knitcore.yarn.study.bending"),
}
"""Files that are made from the store."""


def main() -> None:
    """Read the options and compute."""
    parser = argparse.ArgumentParser(prog="python -m scripts.from_store")
    parser.add_argument("names", nargs="+", choices=FILES)
    parser.add_argument("--folder", type=Path, default=DATA)
    parser.add_argument("--keep", type=Path, default=Path("build"))
    parser.add_argument("--workers", type=int, help="processes; all cores if left out")
    chosen = parser.parse_args()
    charts = {material: stored_charts(material) for material in MATERIALS}
    for name in chosen.names:
        made = FILES[name]
        made.write(chosen.folder / made.file, charts, chosen.keep / name, chosen.workers)


if __name__ == "__main__":
    main()
