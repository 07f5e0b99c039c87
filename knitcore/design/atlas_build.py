"""Build the atlas of a material, here or on a cluster; a stopped build can be continued."""

import hashlib
import json
import shutil
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from knitcore.base.batch import BatchProgress, run_batch
from knitcore.base.errors import Cancelled, InputError, KnitcoreError, Progress
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart, as_chart
from knitcore.design.atlas import FORMAT, STRESS_N_PER_MM, Atlas, Entry, load_atlas, save_atlas
from knitcore.materials import Interval, Material, as_material
from knitcore.prediction.predict import predict
from knitcore.prediction.prediction import Prediction

AT_ONCE = 16
"""Repeats in one task of a batch: half a second of work."""


@dataclass(frozen=True)
class AtlasTask:
    """Some repeats to predict.

    Attributes
    ----------
    material : with all four fabrics.
    keys : of the repeats.
    """

    material: Material
    keys: tuple[str, ...]


def build_atlas(
    material: Material | str,
    repeats: Sequence[StitchChart | str],
    *,
    file: Path | None = None,
    workers: int | None = 1,
    scheduler: str | None = None,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> Atlas:
    """Predict every repeat.

    Parameters
    ----------
    material : with all four fabrics.
    repeats : in the order in which they are computed.
    file : where the atlas is kept. Entries of this material are not computed again. While it is
        built, finished parts are kept in a folder next to it, so it can be stopped at any point.
    workers, scheduler : as :func:`knitcore.base.batch.run_batch`; by default in this process.
    progress : called with the number of repeats done and in all.
    cancelled : asked now and then.

    Raises
    ------
    CancelledError
        If it was asked to stop.
    InputError
        If the file holds something else, or the cluster does not respond.
    """
    material = as_material(material)
    fingerprint = material_fingerprint(material)
    known = known_entries(file, fingerprint)
    keys = [as_chart(repeat).key for repeat in repeats]
    missing = [key for key in keys if key not in known]
    parts = [tuple(missing[k : k + AT_ONCE]) for k in range(0, len(missing), AT_ONCE)]
    tasks = {f"{fingerprint}-{_digest(part)}": AtlasTask(material, part) for part in parts}

    def tell(at: BatchProgress) -> None:
        if progress is not None:
            progress(len(keys) - max(len(missing) - at.done * AT_ONCE, 0), len(keys))

    batch = run_batch(
        predict_repeats,
        tasks,
        workers=workers,
        scheduler=scheduler,
        keep=None if file is None or not tasks else parts_folder(file),
        progress=tell,
        cancelled=cancelled,
    )
    if batch.failures:
        raise KnitcoreError(next(iter(batch.failures.values())))
    for document in batch.results.values():
        known |= {
            key: Entry(tuple(row["values"]), tuple(row["curves"]), row["provenance"])
            for key, row in document["entries"].items()
        }
    if file is not None and tasks:
        save_atlas(Atlas.of_entries(material.identifier, fingerprint, known), file)
        shutil.rmtree(parts_folder(file))
    chosen = {key: known[key] for key in dict.fromkeys(keys)}
    return Atlas.of_entries(material.identifier, fingerprint, chosen)


def predict_repeats(task: AtlasTask) -> dict[str, Any]:
    """One task: entries of its repeats, by key."""
    entries = {
        key: asdict(entry_of(predict_repeat(StitchChart.parse(key), task.material)))
        for key in task.keys
    }
    return {"entries": entries}


def predict_repeat(repeat: StitchChart, material: Material) -> Prediction:
    """Prediction for a large cloth of a repeat."""
    # two repeats each way, so that it is not read as a swatch with edges
    return predict(repeat.tile(2, 2), material)


def entry_of(prediction: Prediction) -> Entry:
    """The row of a repeat."""
    course, wale = (prediction.along(d) for d in Direction)
    values = (
        *_three(course.modulus_n_per_mm, course.modulus_interval_n_per_mm),
        *_three(wale.modulus_n_per_mm, wale.modulus_interval_n_per_mm),
        *_three(course.poisson, course.poisson_interval),
        *_three(wale.poisson, wale.poisson_interval),
        course.relaxed_mm,
        wale.relaxed_mm,
    )
    curves = [
        getattr(along, strain)(STRESS_N_PER_MM)
        for strain in ("strain", "across_strain", "held_strain")
        for along in (course, wale)
    ]
    as_kept = tuple(np.concatenate(curves).astype(np.float32).tolist())
    return Entry(values, as_kept, prediction.provenance.value)


def material_fingerprint(material: Material) -> str:
    """A hash of the laws and the learned model that an atlas of a material depends on."""
    content = {
        str(fabric): [
            asdict(record.law),
            asdict(record.uncertainty),
            record.stitch_course_mm,
            record.stitch_wale_mm,
            str(record.origin),
        ]
        for fabric, record in sorted(material.fabrics.items())
    }
    text = json.dumps([FORMAT, material.identifier, content], sort_keys=True, default=str)
    digest = hashlib.sha256(text.encode())
    digest.update(files("knitcore.prediction").joinpath("data/learned.npz").read_bytes())
    return digest.hexdigest()[:24]


def known_entries(file: Path | None, fingerprint: str) -> dict[str, Entry]:
    """Entries that a file already holds.

    Raises
    ------
    InputError
        If it is the atlas of other laws.
    """
    if file is None or not file.exists():
        return {}
    atlas = load_atlas(file)
    if atlas.fingerprint != fingerprint:
        problem = f"{file.name} is the atlas of {atlas.material} with other laws."
        raise InputError("out", problem, "Name another file, or remove this one.")
    return atlas.entries()


def parts_folder(file: Path) -> Path:
    """Folder that keeps the finished parts of an atlas until it is written."""
    return file.with_name(f"{file.stem}.parts")


def _three(value: float, interval: Interval) -> tuple[float, float, float]:
    return value, interval.low, interval.high


def _digest(keys: tuple[str, ...]) -> str:
    return hashlib.sha256("|".join(keys).encode()).hexdigest()[:24]
