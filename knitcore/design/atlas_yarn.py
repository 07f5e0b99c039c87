"""Yarn-level results for an atlas: repeats relaxed and stretched one by one, small ones first.

A repeat takes seconds to a minute, all of a material more than a day, so every finished one is kept
in a folder beside the atlas, and the run can be stopped at any point and resumed. The pure fabrics
of the same yarn relate the results to the measured material (:mod:`knitcore.prediction.swept`).
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from knitcore.base.batch import BatchProgress, run_batch
from knitcore.base.errors import Cancelled, Progress
from knitcore.chart.fabric import Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.design.atlas import Atlas, Entry, load_atlas, save_atlas
from knitcore.design.atlas_build import (
    entry_of,
    known_entries,
    material_fingerprint,
    predict_repeat,
)
from knitcore.materials import Material
from knitcore.prediction.prediction import Source
from knitcore.prediction.swept import simulated_record, swept_chart
from knitcore.yarn.library.characterise import RepeatTask, characterise_repeat, law_of
from knitcore.yarn.library.yarns import yarn_for

Document = dict[str, Any]


def improve_atlas(
    material: Material,
    file: Path,
    *,
    most_stitches: int,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> Atlas:
    """Give repeats of an atlas file their yarn-level laws and relaxed sizes.

    Parameters
    ----------
    material : of the atlas.
    file : the atlas. It is written when the run ends or is stopped, and when a killed run is
        resumed.
    most_stitches : of the largest repeat; small ones come first.
    workers, scheduler : as :func:`knitcore.base.batch.run_batch`.
    progress : called with the number of repeats done and in all.
    cancelled : asked now and then.

    Raises
    ------
    CancelledError
        If it was asked to stop.
    InputError
        If the file is not an atlas of this material, or the yarn's parameters are unknown.
    """
    load_atlas(file)  # a missing fabric is reported before anything is computed
    entries = known_entries(file, material_fingerprint(material))
    tasks = yarn_level_tasks(material, entries, most_stitches)
    keep = yarn_level_folder(file)
    _merge(material, file, _kept(keep, tasks))

    def tell(at: BatchProgress) -> None:
        if progress is not None:
            progress(at.done, at.total)

    try:
        run_batch(
            characterise_repeat,
            {task.key: task for task in tasks.values()},
            workers=workers,
            scheduler=scheduler,
            keep=keep,
            progress=tell,
            cancelled=cancelled,
        )
    finally:
        _merge(material, file, _kept(keep, tasks))
    return load_atlas(file)


def yarn_level_folder(file: Path) -> Path:
    """Folder of the relaxed and stretched repeats of an atlas, a JSON document each."""
    return file.with_name(f"{file.stem}.yarn")


def yarn_level_tasks(
    material: Material, entries: Mapping[str, Entry], most_stitches: int
) -> dict[str, RepeatTask]:
    """Tasks left, by repeat: the pure fabrics, then small repeats first."""
    pure = {key_of_pure(fabric) for fabric in Fabric}
    mixed = [
        key
        for key, entry in entries.items()
        if key not in pure
        and len(key.replace("/", "")) <= most_stitches
        and entry.provenance != Source.SWEPT
    ]
    order = [*sorted(pure), *sorted(mixed, key=lambda key: (len(key.replace("/", "")), key))]
    return {key: _task(material, key) for key in order}


def key_of_pure(fabric: Fabric) -> str:
    """The key of a pure fabric's repeat."""
    return StitchChart.of_fabric(fabric, rows=2, columns=2).canonical().key


def _task(material: Material, key: str) -> RepeatTask:
    used = yarn_for(material, StitchChart.parse(key))
    return RepeatTask(key, used.yarn, used.loop_length_mm)


def _kept(folder: Path, tasks: Mapping[str, RepeatTask]) -> dict[str, Document]:
    """Finished repeats; a damaged file counts as not finished, as it does for the batch."""
    documents = {}
    for key, task in tasks.items():
        file = folder / f"{task.key}.json"
        if file.is_file():
            try:
                documents[key] = json.loads(file.read_text(encoding="utf-8"))
            except ValueError:
                continue
    return documents


def _merge(material: Material, file: Path, done: Mapping[str, Document]) -> None:
    """Write finished repeats into the atlas, once all four fabrics to compare with are there."""
    pure = {}
    for fabric in Fabric:
        document = done.get(key_of_pure(fabric), {})
        if (law := law_of(document)) is not None:
            pure[fabric] = simulated_record(fabric, _cell_mm(document), law)
    if len(pure) < len(Fabric):
        return
    fingerprint = material_fingerprint(material)
    entries = known_entries(file, fingerprint)
    for key, document in done.items():
        chart, law = StitchChart.parse(key), law_of(document)
        if law is None or not document["converged"] or key in map(key_of_pure, Fabric):
            continue
        sweep = swept_chart(chart, _cell_mm(document), law, pure, material)
        entries[key] = entry_of(predict_repeat(chart, material, sweep))
    save_atlas(Atlas.of_entries(material.identifier, fingerprint, entries), file)


def _cell_mm(document: Document) -> tuple[float, float]:
    return document["cell_course_mm"], document["cell_wale_mm"]
