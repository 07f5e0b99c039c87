"""The atlas: every repeat with its predicted constants, for one material.

It is a table in memory and one compressed file on disk. A build goes through the repeats in order,
writes the file now and then, and goes on where an earlier build stopped.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from importlib.resources import files
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from knitcore.chart import StitchChart
from knitcore.design.repeats import canonical, repeat_key, repeat_of_key
from knitcore.errors import CancelledError, InputError
from knitcore.materials import Material
from knitcore.mechanics.prediction import Prediction, predict
from knitcore.segments import segment_map
from knitcore.yarnlevel.known import STORED_MATERIALS, known_repeat

Array = NDArray[np.float64]

FORMAT = 1
SAVE_EVERY_S = 20.0
MAXIMUM_BYTES = 50_000_000

VALUES = (
    "modulus_course_n_per_mm",
    "modulus_course_low",
    "modulus_course_high",
    "modulus_wale_n_per_mm",
    "modulus_wale_low",
    "modulus_wale_high",
    "poisson_yx",
    "poisson_xy",
)
"""Columns of an atlas; low and high are ends of 90 % intervals."""


@dataclass(frozen=True, eq=False)
class Atlas:
    """Predictions of many repeats of one material.

    Attributes
    ----------
    material : its identifier.
    fingerprint : of the material's laws and sizes; an atlas of other laws is not continued.
    keys : the repeats (see :func:`knitcore.design.repeats.repeat_key`).
    values : (repeats, len(VALUES)).
    provenance : where each repeat's law comes from.
    """

    material: str
    fingerprint: str
    keys: tuple[str, ...]
    values: Array
    provenance: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.keys)

    def column(self, name: str) -> Array:
        """One of :data:`VALUES` for all repeats."""
        column: Array = self.values[:, VALUES.index(name)]
        return column

    def index_of(self, repeat: StitchChart) -> int | None:
        """Where a repeat stands, whichever of its images is given; None if it is not here."""
        key = repeat_key(canonical(repeat))
        return self.keys.index(key) if key in self.keys else None

    def chart(self, index: int) -> StitchChart:
        """One repeat."""
        return repeat_of_key(self.keys[index])


@dataclass(frozen=True)
class KnittingCost:
    """What a repeat asks of machine and cloth.

    Attributes
    ----------
    transfers_per_stitch : loops that a V-bed machine moves between its beds.
    curl : knits minus purls on the face, over all stitches; far from 0 the cloth curls.
    even_share : share of even segments, course-wise and wale-wise together; 1 is stockinette.
    """

    transfers_per_stitch: float
    curl: float
    even_share: float


def knitting_cost(repeat: StitchChart) -> KnittingCost:
    """The cost of a repeat.

    Examples
    --------
    >>> knitting_cost(StitchChart.parse("KP")).transfers_per_stitch
    0.0
    """
    segments = segment_map(repeat, periodic=True)
    odd = (float(segments.course_odd.mean()) + float(segments.wale_odd.mean())) / 2
    return KnittingCost(
        transfers_per_stitch=float(segments.wale_odd.mean()),
        curl=1.0 - 2.0 * float(repeat.purl.mean()),
        even_share=1.0 - odd,
    )


def build_atlas(
    material: Material,
    repeats: Sequence[StitchChart],
    *,
    file: Path | None = None,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Atlas:
    """Predict every repeat.

    Parameters
    ----------
    material : with all four fabrics.
    repeats : in the order in which they are computed.
    file : where the atlas is kept; what it already holds of this material is not computed again.
    progress : called with the number of repeats done and in all.
    cancelled : asked before every repeat.

    Raises
    ------
    CancelledError
        If it was asked to stop; what was done is in the file.
    InputError
        If the file holds something else.
    """
    fingerprint = material_fingerprint(material)
    known = _known(file, fingerprint)
    keys = [repeat_key(repeat) for repeat in repeats]
    saved = time.monotonic()
    fresh = False
    for done, (key, repeat) in enumerate(zip(keys, repeats, strict=True)):
        if cancelled is not None and cancelled():
            if file is not None and fresh:
                save_atlas(_table(material, fingerprint, known), file)
            raise CancelledError(f"stopped after {done} of {len(keys)} repeats")
        if key not in known:
            known[key] = _row(predict_repeat(repeat, material))
            fresh = True
        if file is not None and fresh and time.monotonic() - saved > SAVE_EVERY_S:
            save_atlas(_table(material, fingerprint, known), file)
            saved, fresh = time.monotonic(), False
        if progress is not None:
            progress(done + 1, len(keys))
    if file is not None and fresh:
        save_atlas(_table(material, fingerprint, known), file)
    return _table(material, fingerprint, {key: known[key] for key in keys})


def predict_repeat(repeat: StitchChart, material: Material) -> Prediction:
    """What a large cloth of a repeat does, with its yarn-level law where the store has one."""
    cloth = repeat.tile(2, 2)  # twice, so that nobody takes its edges for those of a swatch
    stored = known_repeat(cloth, material)
    if stored is None:
        return predict(cloth, material)
    return predict(cloth, material, relaxed=stored.relaxed, repeat_law=stored.law)


def material_fingerprint(material: Material) -> str:
    """A hash of the laws and stored stitches that the predictions of a material depend on."""
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
    text = json.dumps([material.identifier, content], sort_keys=True, default=str)
    digest = hashlib.sha256(text.encode())
    if material.identifier in STORED_MATERIALS:
        digest.update(files("knitcore.yarnlevel").joinpath("data/stitches.json").read_bytes())
    return digest.hexdigest()[:24]


def save_atlas(atlas: Atlas, file: Path) -> None:
    """Write an atlas; a file of the same name is replaced as a whole or not at all."""
    handle, name = tempfile.mkstemp(dir=file.parent, suffix=".npz")
    try:
        with os.fdopen(handle, "wb") as stream:
            np.savez_compressed(
                stream,
                allow_pickle=False,
                format=np.array(FORMAT),
                material=np.array(atlas.material),
                fingerprint=np.array(atlas.fingerprint),
                keys=np.array(atlas.keys, dtype=np.str_),
                values=atlas.values,
                provenance=np.array(atlas.provenance, dtype=np.str_),
            )
        Path(name).replace(file)
    finally:
        Path(name).unlink(missing_ok=True)


def load_atlas(file: Path) -> Atlas:
    """Read an atlas.

    Raises
    ------
    InputError
        If the file is missing or holds none.
    """
    if not file.is_file():
        raise InputError("atlas", f"there is no file {file}.", "Build it with `knitcore atlas`.")
    if file.stat().st_size > MAXIMUM_BYTES:
        raise InputError("atlas", f"{file.name} is too large.", "Build it again.")
    try:
        with np.load(io.BytesIO(file.read_bytes()), allow_pickle=False) as data:
            version = int(data["format"])
            atlas = Atlas(
                material=str(data["material"]),
                fingerprint=str(data["fingerprint"]),
                keys=tuple(data["keys"].tolist()),
                values=data["values"],
                provenance=tuple(data["provenance"].tolist()),
            )
    except Exception:  # a damaged archive fails in many ways: zlib, zipfile, numpy's own header
        raise InputError("atlas", f"{file.name} holds no atlas.", "Build it again.") from None
    if version != FORMAT:
        raise InputError("atlas", f"{file.name} is of another version.", "Build it again.")
    rows = len(atlas.keys)
    if atlas.values.shape != (rows, len(VALUES)) or len(atlas.provenance) != rows:
        raise InputError("atlas", f"{file.name} is damaged.", "Build it again.")
    return atlas


def _known(file: Path | None, fingerprint: str) -> dict[str, tuple[tuple[float, ...], str]]:
    if file is None or not file.exists():
        return {}
    atlas = load_atlas(file)
    if atlas.fingerprint != fingerprint:
        raise InputError(
            "out",
            f"{file.name} is the atlas of {atlas.material} with other laws.",
            "Name another file, or remove this one.",
        )
    rows = zip(atlas.keys, atlas.values.tolist(), atlas.provenance, strict=True)
    return {key: (tuple(values), source) for key, values, source in rows}


def _table(
    material: Material, fingerprint: str, rows: dict[str, tuple[tuple[float, ...], str]]
) -> Atlas:
    return Atlas(
        material=material.identifier,
        fingerprint=fingerprint,
        keys=tuple(rows),
        values=np.array([values for values, _ in rows.values()]).reshape(-1, len(VALUES)),
        provenance=tuple(source for _, source in rows.values()),
    )


def _row(found: Prediction) -> tuple[tuple[float, ...], str]:
    course, wale = found.modulus_course_interval, found.modulus_wale_interval
    values = (
        found.modulus_course_n_per_mm,
        course.low,
        course.high,
        found.modulus_wale_n_per_mm,
        wale.low,
        wale.high,
        found.poisson_yx,
        found.poisson_xy,
    )
    return values, found.provenance.value
