"""Follow the stored repeats without their mirrors: ``python -m scripts.lowest_stitches``.

Every repeat of the store is laid out over its free cell, followed along its instability if it has
one, and what it leads to is written to the library's ``data/lowest.json``. Finished repeats are
kept in a folder, so an interrupted run can be resumed.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from knitcore.batch import run_batch
from knitcore.chart import StitchChart
from knitcore.errors import ConvergenceError, UnravelledError
from knitcore.yarnlevel.cell import free_cell
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.energy import CellEnergy
from knitcore.yarnlevel.lowest import followed
from knitcore.yarnlevel.search import SAME_ENERGY
from knitcore.yarnlevel.splines import COARSE, FINE
from knitcore.yarnlevel.yarn import YarnModel
from knitcore.yarnlibrary.characterise import Document
from knitcore.yarnlibrary.fingerprint import content_key
from knitcore.yarnlibrary.store import MATERIALS, StoredStitch, stored_charts, stored_stitch
from scripts.stored_stitches import DATA, tell


@dataclass(frozen=True)
class FollowTask:
    """A stored repeat to follow without its mirrors.

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
    def of(cls, stored: StoredStitch) -> FollowTask:
        """The task of a stored repeat."""
        return cls(
            stored.chart.key, stored.yarn, stored.loop_length_mm, stored.convention,
            (stored.cell_course_mm, stored.cell_wale_mm), stored.energy_n_mm,
            stored.controls.tolist(),
        )  # fmt: skip

    @property
    def key(self) -> str:
        """A name made of everything that decides the result."""
        return content_key(asdict(self), ("knitcore.yarnlevel.lowest",))


def follow(task: FollowTask) -> Document:
    """Drop the mirrors of a repeat and follow its instability.

    Returns
    -------
    A JSON document: ``failure`` alone where the descent finds no state of the fabric; otherwise
    ``minimum``, whether the mirrored state is one without its mirrors, and size (mm) and energy
    (N·mm) of a stitch of the minimum that it is or leads to.
    """
    chart = StitchChart.parse(task.chart)
    controls = np.array(task.controls)
    per_stitch = controls.shape[1] // chart.columns
    cell = free_cell(chart, FINE if per_stitch == FINE.controls else COARSE)
    points = np.tile(controls, (cell.rows // chart.rows, cell.wales // chart.columns, 1))
    energy = CellEnergy(
        cell, task.yarn, np.full(cell.rows, task.loop_length_mm), task.convention
    )  # fmt: skip
    try:
        found = followed(energy, cell.state(points, *task.size_mm))
    except (ConvergenceError, UnravelledError) as error:
        return {"failure": str(error)}
    reached = found.terms.energy / cell.stitches
    lower = 1.0 - reached / task.energy_n_mm
    return {
        "minimum": bool(found.stable and lower < SAME_ENERGY),
        "cell_course_mm": float(f"{found.state[-2]:.7g}"),
        "cell_wale_mm": float(f"{found.state[-1]:.7g}"),
        "energy_n_mm": float(f"{reached:.7g}"),
        "converged": found.converged,
    }


def write_lowest(
    path: Path, charts: dict[str, list[StitchChart]], keep: Path, workers: int | None = None
) -> None:
    """Follow the given repeats of each material and write what they lead to.

    Raises
    ------
    KnitcoreError
        As :func:`knitcore.batch.run_batch`.
    """
    tasks = {}
    for material, repeats in charts.items():
        for chart in repeats:
            stored = stored_stitch(chart, material)
            if stored is not None:
                tasks[f"{material}/{chart.key}"] = FollowTask.of(stored)
    label = {key: f"{key.replace('/', '-')}.{task.key}" for key, task in tasks.items()}
    named = {label[key]: task for key, task in tasks.items()}
    found = run_batch(follow, named, keep=keep, workers=workers, progress=tell)
    lines = ",\n".join(
        f"{json.dumps(key)}: {json.dumps(found.results[label[key]])}"
        for key in tasks
        if label[key] in found.results
    )
    path.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")


def main() -> None:
    """Read the options and follow."""
    parser = argparse.ArgumentParser(prog="python -m scripts.lowest_stitches")
    parser.add_argument("--path", type=Path, default=DATA / "lowest.json")
    parser.add_argument("--keep", type=Path, default=Path("build/lowest"))
    parser.add_argument("--workers", type=int, help="processes; all cores if left out")
    chosen = parser.parse_args()
    charts = {material: stored_charts(material) for material in MATERIALS}
    write_lowest(chosen.path, charts, chosen.keep, chosen.workers)


if __name__ == "__main__":
    main()
