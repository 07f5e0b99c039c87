"""Relax the training charts without mirrors: ``python -m scripts.training.lowest``.

The packaged sizes are those of the mirrored branch. Here every chart of the training library starts
several times without its symmetries, and the lowest state is kept beside the others that were
found. Charts are taken in a mixed order, so that any first part of them is a fair sample. Finished
ones are kept in a folder, so an interrupted run can be resumed; ``--pack`` writes those finished so
far to ``library.json.xz``.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from knitcore.base.errors import KnitcoreError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.library.characterise import Document
from knitcore.yarn.library.fingerprint import content_key
from knitcore.yarn.model.relaxed_cell import Branch
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.search import RELAXED
from knitcore.yarn.study.lowest import can_be_followed, without_mirrors
from knitcore.yarn.study.relax import relax
from scripts.training.command import resumable
from scripts.training.entries import FILE, training_entries, update_library

SOLVERS = ("knitcore.yarn.study.relax", "knitcore.yarn.study.lowest")
"""The modules that relax."""


@dataclass(frozen=True)
class LowestTask:
    """A repeat of one yarn, to relax without mirrors."""

    yarn_name: str
    chart: str
    yarn: YarnModel
    loop_length_mm: float

    @property
    def name(self) -> str:
        """Yarn and chart."""
        return f"{self.yarn_name}/{self.chart}"

    @property
    def key(self) -> str:
        """A key made from everything that determines the result."""
        name = self.name.replace("/", "-").replace(" ", "_")
        return f"{name}.{content_key(asdict(self), SOLVERS)}"


def lowest(task: LowestTask) -> Document:
    """The states that a chart without mirrors ends in.

    They are the mirrored one, followed along its instability, the mirrored one disturbed, and those
    of starts of their own; of the last two only the lowest is polished on the fine grid, and the
    others count as they are on the coarse one.

    Returns
    -------
    A JSON document: yarn and chart, and for each state that relaxed the energy (N·mm) of the mean
    stitch, its width and its height (mm), the lowest first; or ``failure``.
    """
    chart = StitchChart.parse(task.chart)
    states = []
    try:
        mirrored = relax(chart, task.yarn, task.loop_length_mm, branch="mirrored")
        if can_be_followed(mirrored):
            relaxed = without_mirrors(mirrored).state
            states.append((relaxed.energy_n_mm, relaxed.cell_course_mm, relaxed.cell_wale_mm))
    except KnitcoreError as error:
        failure = str(error)
    else:
        failure = ""
    try:
        free = relax(chart, task.yarn, task.loop_length_mm, branch=Branch.FREE)
        states.append((free.energy_n_mm, free.cell_course_mm, free.cell_wale_mm))
        states += [
            (start.energy_n_mm, start.cell_course_mm, start.cell_wale_mm)
            for start in free.starts
            if start.outcome == RELAXED and start.energy_n_mm != free.energy_n_mm
        ]
    except KnitcoreError as error:
        failure = failure or str(error)
    if not states:
        return {"name": task.name, "failure": failure}
    rounded = [[float(f"{part:.6g}") for part in state] for state in sorted(states)]
    return {"name": task.name, "states": rounded}


def named_tasks() -> dict[str, LowestTask]:
    """All charts of the library that relaxed with mirrors, by key, in a mixed order."""
    entries = (entry for entry in training_entries() if entry.cell_mm is not None)
    tasks = [LowestTask(e.yarn_name, e.chart.key, e.yarn, e.loop_length_mm) for e in entries]
    return {task.key: task for task in sorted(tasks, key=lambda task: task.key[::-1])}


def pack(keep: Path, file: Path) -> int:
    """Write what finished to a file, by yarn and chart; returns the number of charts."""
    documents = {}
    for path in keep.glob("*.json"):
        document = json.loads(path.read_text(encoding="utf-8"))
        documents[document.pop("name")] = document
    update_library(file, lowest={name: documents[name] for name in sorted(documents)})
    return len(documents)


def main() -> None:
    """Run ``python -m scripts.training.lowest``."""
    resumable(
        "python -m scripts.training.lowest", "build/training-lowest", lowest,
        named_tasks, lambda keep: pack(keep, FILE),
    )  # fmt: skip


if __name__ == "__main__":
    main()
