"""Relax and stretch the training charts: ``python -m scripts.training.build``.

Every finished task is kept in a folder, so an interrupted build can be resumed. ``--pack`` adds
the tasks finished so far to ``library.json.xz``; the next build leaves those out.
"""

import argparse
import json
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path

from knitcore.base.batch import run_batch
from knitcore.base.errors import KnitcoreError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials import material
from knitcore.yarn.library.characterise import Document, RepeatTask, characterise_repeat
from knitcore.yarn.library.fingerprint import content_key
from knitcore.yarn.library.store import stored_charts
from knitcore.yarn.library.yarns import yarn_for
from knitcore.yarn.model.cell import mirrored_cell
from knitcore.yarn.solve.splines import COARSE
from knitcore.yarn.study.relax import relax
from scripts.stored_stitches import tell
from scripts.training.charts import YARN_POINTS, anchor_charts, drawn_charts, training_charts
from scripts.training.entries import FILE, read_library, write_library

MAX_RELAXED = 36
"""Cells with more stitches are left out."""
MAX_STRETCHED = 25
"""Cells with more stitches are only relaxed, which takes a tenth of the time of curves."""


@dataclass(frozen=True)
class TrainingTask:
    """A repeat of one yarn, to relax and perhaps to stretch both ways."""

    yarn_name: str
    repeat: RepeatTask
    stretched: bool

    @property
    def key(self) -> str:
        """A key made from everything that determines the result."""
        name = self.repeat.chart.replace("/", "-")
        return f"{self.yarn_name.replace(' ', '_')}.{name}.{content_key(asdict(self))}"


def characterise(task: TrainingTask) -> Document:
    """Relaxed size of a repeat and, if asked for, both curves as they were computed."""
    repeat = task.repeat
    head = {"task": {**asdict(task), "repeat": asdict(repeat)}}
    if task.stretched:
        document = characterise_repeat(repeat)
        document.pop("controls", None)
        return {**head, **document}
    chart = StitchChart.parse(repeat.chart)
    try:
        rest = relax(
            chart, repeat.yarn, repeat.loop_length_mm, branch=repeat.branch,
            convention=repeat.convention,
        )  # fmt: skip
    except KnitcoreError as error:
        return {**head, "failure": str(error)}
    return {
        **head,
        "cell_course_mm": rest.cell_course_mm,
        "cell_wale_mm": rest.cell_wale_mm,
        "energy_n_mm": rest.energy_n_mm,
        "converged": rest.converged,
        "notes": list(rest.notes),
        "curves": {},
    }


def tasks(packed: Path | None = None) -> dict[str, TrainingTask]:
    """All tasks by key, the most informative first, without those in a packed file."""
    entries = [] if packed is None else read_library(packed)
    done = {(*_name(e), stretched) for e in entries for stretched in {False, _tried(e)}}
    return {
        key: task
        for key, task in _all().items()
        if (task.yarn_name, task.repeat.chart, task.stretched) not in done
    }


@cache
def _all() -> dict[str, TrainingTask]:
    return {task.key: task for task in _ordered()}


def _tried(entry: Document) -> bool:
    """Tell whether a relaxation was to be stretched, with or without success."""
    return "failure" in entry or "law" in entry


def _ordered() -> Iterator[TrainingTask]:
    anchors = iter([(chart, point) for chart in anchor_charts() for point in YARN_POINTS])
    for turn, chart in enumerate(training_charts()):
        if mirrored_cell(chart, COARSE).stitches > MAX_RELAXED:
            continue
        yield _of_material("acrylic", chart, stretched=True)
        yield _of_point(0, chart, stretched=turn % 4 == 2)
        yield _of_material("cotton", chart, stretched=turn % 4 == 0)
        for anchor, point in (entry for entry in (next(anchors, None),) if entry is not None):
            yield _of_point(YARN_POINTS.index(point), anchor, stretched=True)
    for chart in drawn_charts():
        if mirrored_cell(chart, COARSE).stitches <= MAX_STRETCHED:
            yield _of_material("acrylic", chart, stretched=False)
    for name in ("acrylic", "cotton"):
        for chart in stored_charts(name):
            yield _of_material(name, chart, stretched=True)


def _of_material(name: str, chart: StitchChart, *, stretched: bool) -> TrainingTask:
    used = yarn_for(material(name), chart)
    return _task(name, RepeatTask(chart.key, used.yarn, used.loop_length_mm), stretched)


def _of_point(index: int, chart: StitchChart, *, stretched: bool) -> TrainingTask:
    point = YARN_POINTS[index]
    text = chart.canonical().key
    return _task(point.name, RepeatTask(text, point.yarn, point.loop_length_mm), stretched)


def _task(name: str, repeat: RepeatTask, stretched: bool) -> TrainingTask:
    chart = StitchChart.parse(repeat.chart)
    small = mirrored_cell(chart, COARSE).stitches <= MAX_STRETCHED
    return TrainingTask(name, repeat, stretched and small)


def pack(keep: Path, file: Path) -> int:
    """Add the finished tasks to a file, in the place of earlier ones of the same chart and yarn.

    A stretched chart counts before one that was only relaxed, and the order does not depend on the
    order in which tasks end. Returns the number of entries.
    """
    entries = {_name(entry): entry for entry in read_library(file)}
    finished = [
        json.loads(path.read_text(encoding="utf-8")) for path in sorted(keep.glob("*.json"))
    ]
    for document in sorted(finished, key=lambda document: document["task"]["stretched"]):
        entry = _packed(document)
        entries[_name(entry)] = entry
    write_library(file, [entries[name] for name in sorted(entries)])
    return len(entries)


def _name(entry: Document) -> tuple[str, str]:
    return entry["yarn_name"], entry["chart"]


def _packed(document: Document) -> Document:
    task = document["task"]
    repeat = task["repeat"]
    head = {
        "chart": repeat["chart"],
        "yarn_name": task["yarn_name"],
        "yarn": repeat["yarn"],
        "loop_length_mm": repeat["loop_length_mm"],
        "branch": repeat["branch"],
    }
    if "failure" in document:
        return {**head, "failure": document["failure"]}
    kept = ("cell_course_mm", "cell_wale_mm", "energy_n_mm", "converged")
    packed = {**head, **{name: document[name] for name in kept}}
    if document["curves"]:
        packed["curves"] = {
            name: [[_short(value) for value in curve[column]] for column in _COLUMNS]
            for name, curve in document["curves"].items()
        }
        packed |= {"law": document["law"], "law_failure": document["law_failure"]}
    return packed


_COLUMNS = ("strain", "transverse_strain", "stress_n_per_mm")


def _short(value: float) -> float:
    return float(f"{value:.5g}")


def main() -> None:
    """Run ``python -m scripts.training.build``."""
    parser = argparse.ArgumentParser(prog="python -m scripts.training.build")
    parser.add_argument("--keep", type=Path, default=Path("build/training"))
    parser.add_argument("--scheduler", help="address of a Dask cluster, tcp://host:port")
    parser.add_argument("--workers", type=int, help="processes, all cores if left out")
    parser.add_argument("--pack", action="store_true", help="only pack what is finished")
    chosen = parser.parse_args()
    if chosen.pack:
        sys.stderr.write(f"{pack(chosen.keep, FILE)} packed\n")
        return
    run_batch(
        characterise, tasks(FILE), scheduler=chosen.scheduler, workers=chosen.workers,
        keep=chosen.keep, progress=tell,
    )  # fmt: skip


if __name__ == "__main__":
    main()
