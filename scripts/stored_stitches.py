"""Make the packaged store of relaxed stitches: ``python -m scripts.stored_stitches``.

Relaxes and stretches every small repeat (:func:`charts_of_the_store`) for each yarn and writes
``stitches.json`` (sizes, energies, laws) and ``stitches.npz`` (control points) into the library's
data folder. Finished repeats are kept in a folder, so an interrupted build can be resumed.
"""

import argparse
import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from knitcore.base.batch import BatchProgress, BatchResult, run_batch
from knitcore.chart.fabric import Direction
from knitcore.chart.repeats import primitive_repeats, repeats_up_to
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials import material
from knitcore.yarn.library.characterise import Document, RepeatTask, characterise_repeat
from knitcore.yarn.library.store import MATERIALS
from knitcore.yarn.library.yarns import yarn_for
from knitcore.yarn.study.relax import Branch

DATA = Path(__file__).parent.parent / "knitcore" / "yarn" / "library" / "data"
COMMON: dict[str, str] = {
    "stockinette": "K",
    "garter": "P\nK",
    "1x1 rib": "KP",
    "seed": "PK\nKP",
    "2x1 rib": "KKP",
    "2x2 rib": "KKPP",
    "3x1 rib": "KKKP",
    "3x3 rib": "KKKPPP",
    "2x1 welt": "P\nK\nK",
    "2x2 welt": "P\nP\nK\nK",
    "3x1 welt": "P\nK\nK\nK",
    "3x3 welt": "P\nP\nP\nK\nK\nK",
    "moss": "PK\nPK\nKP\nKP",
    "basket 2x2": "PPKK\nPPKK\nKKPP\nKKPP",
    "broken rib": "KP\nKK",
}
"""Repeats with names that knitters use, top row first."""
MAX_STITCHES = 8
SQUARE = 3
"""Repeats of this many rows and columns are also in the store, though they have more stitches."""


def charts_of_the_store(most_stitches: int = MAX_STITCHES) -> dict[StitchChart, str]:
    """The repeats to make, representatives of their fabrics, with the names of known ones."""
    names = {StitchChart.parse(text).canonical(): name for name, text in COMMON.items()}
    square = primitive_repeats(SQUARE, SQUARE) if most_stitches >= MAX_STITCHES else ()
    small = repeats_up_to(most_stitches, most_stitches, stitches=most_stitches)
    some = [*names, *small, *square]
    return {chart: names.get(chart, "") for chart in some}


def build(
    folder: Path,
    *,
    keep: Path,
    most_stitches: int = MAX_STITCHES,
    scheduler: str | None = None,
    workers: int | None = None,
) -> None:
    """Make all entries that `keep` does not hold, then write the store into `folder`.

    Raises
    ------
    KnitcoreError
        As :func:`knitcore.base.batch.run_batch`.
    """
    tasks = _tasks(most_stitches)
    named = {f"{name}.{task.key}": task for name, task in tasks.items()}
    batch = run_batch(
        characterise_repeat, named, scheduler=scheduler, workers=workers, keep=keep,
        progress=tell,
    )  # fmt: skip
    entries: dict[str, Any] = {}
    controls: dict[str, NDArray[np.float32]] = {}
    names = charts_of_the_store(most_stitches)
    for material_id in MATERIALS:
        for chart, name in names.items():
            label = _label(material_id, chart, Branch.MIRRORED)
            key = f"{material_id}/{chart.key}"
            document = _document_of(batch, label, tasks[label])
            provenance = yarn_for(material(material_id), chart).provenance
            entries[key] = _entry(document, tasks[label], provenance, name)
            free = _label(material_id, chart, Branch.FREE)
            if free in tasks:
                entries[key]["free"] = _free(_document_of(batch, free, tasks[free]))
            if "controls" in document:
                controls[key] = np.asarray(document["controls"], dtype=np.float32)
    write_store(folder, entries, controls)


def write_store(
    folder: Path, entries: dict[str, Any], controls: dict[str, NDArray[np.float32]]
) -> None:
    """Write both files, the same bytes for the same entries."""
    lines = ",\n".join(f"{json.dumps(k)}: {json.dumps(v)}" for k, v in entries.items())
    text = f'{{"stitches": {{\n{lines}\n}}}}\n'
    (folder / "stitches.json").write_text(text, encoding="utf-8")
    np.savez_compressed(folder / "stitches.npz", **controls)  # type: ignore[arg-type]


def _tasks(most_stitches: int) -> dict[str, RepeatTask]:
    """Every repeat in the mirrored branch, then those with a name in the free one."""
    charts = charts_of_the_store(most_stitches)
    tasks = {}
    for branch in (Branch.MIRRORED, Branch.FREE):
        for chart, name in charts.items():
            if branch is Branch.FREE and not name:
                continue
            for material_id in MATERIALS:
                used = yarn_for(material(material_id), chart)
                tasks[_label(material_id, chart, branch)] = RepeatTask(
                    chart.key, used.yarn, used.loop_length_mm, branch=branch
                )
    return tasks


def _label(material_id: str, chart: StitchChart, branch: Branch) -> str:
    return f"{material_id}.{chart.key.replace('/', '-')}.{branch}"


def _document_of(batch: BatchResult, label: str, task: RepeatTask) -> Document:
    key = f"{label}.{task.key}"
    return batch.results.get(key) or {"failure": batch.failures[key]}


def _entry(document: Document, task: RepeatTask, provenance: str, name: str) -> dict[str, Any]:
    head: dict[str, Any] = {"name": name} if name else {}
    head |= {
        "yarn": asdict(task.yarn),
        "loop_length_mm": task.loop_length_mm,
        "yarn_provenance": provenance,
        "branch": task.branch.value,
        "convention": task.convention.value,
    }
    if "failure" in document:
        return {**head, "failure": document["failure"]}
    kept = {name: document[name] for name in _SIZE + _SHARES + _LAW}
    return {
        **head,
        **kept,
        "law_max_stress_n_per_mm": task.max_stress_n_per_mm,
        "law_jumps": [_jumps(document, direction, task) for direction in Direction],
    }


def _jumps(document: Document, direction: Direction, task: RepeatTask) -> int:
    """Number of abrupt changes of shape below the fitted stress."""
    curve = document["curves"].get(str(direction))
    if curve is None:
        return 0
    stress = curve["stress_n_per_mm"]
    return sum(stress[i] <= task.max_stress_n_per_mm for i in curve["jumps"])


def _free(document: Document) -> dict[str, Any]:
    if "failure" in document:
        return {"failure": document["failure"]}
    return {name: document[name] for name in (*_SIZE, "law")}


_SIZE = ("cell_course_mm", "cell_wale_mm", "energy_n_mm", "converged")
_SHARES = ("bending_share", "contact_share")
_LAW = ("law", "law_failure")


def tell(progress: BatchProgress) -> None:
    """Progress of a batch, to stderr."""
    sys.stderr.write(
        f"{progress.done}/{progress.total} {progress.key.rpartition('.')[0]}"
        f"{f', {progress.failed} failed' if progress.failed else ''}\n"
    )
    sys.stderr.flush()


def main() -> None:
    """Read the options and build."""
    parser = argparse.ArgumentParser(prog="python -m scripts.stored_stitches")
    parser.add_argument("--most-stitches", type=int, default=MAX_STITCHES)
    parser.add_argument("--folder", type=Path, default=DATA)
    parser.add_argument("--keep", type=Path, default=Path("build/stitches"))
    parser.add_argument("--scheduler", help="address of a Dask cluster, tcp://host:port")
    parser.add_argument("--workers", type=int, help="processes here; all cores if left out")
    chosen = parser.parse_args()
    build(
        chosen.folder, keep=chosen.keep, most_stitches=chosen.most_stitches,
        scheduler=chosen.scheduler, workers=chosen.workers,
    )  # fmt: skip


if __name__ == "__main__":
    main()
