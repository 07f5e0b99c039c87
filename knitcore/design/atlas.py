"""The atlas: every repeat with its predicted constants and curves, for one material.

It is a table in memory and one compressed file on disk; :mod:`knitcore.design.atlas_build` makes
it.
"""

from __future__ import annotations

import io
import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array, Indices
from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart
from knitcore.design.cost import KnittingCost, knitting_cost
from knitcore.materials import Material

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator

FORMAT = 5
MAX_BYTES = 50_000_000
_BUILD = "Build an atlas of this material with `knitcore atlas`."

STRESS_N_PER_MM: Array = np.array(
    [
        *(0.0, 0.0002, 0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.03, 0.05, 0.075),
        *(0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5, 2.0),
    ]
)
"""Stresses at which an atlas keeps the strains."""
CURVES = (3, 2, len(STRESS_N_PER_MM))
"""Shape of the curves of a repeat."""

VALUES = (
    "modulus_course_n_per_mm",
    "modulus_course_low",
    "modulus_course_high",
    "modulus_wale_n_per_mm",
    "modulus_wale_low",
    "modulus_wale_high",
    "poisson_yx",
    "poisson_yx_low",
    "poisson_yx_high",
    "poisson_xy",
    "poisson_xy_low",
    "poisson_xy_high",
    "relaxed_course_mm",
    "relaxed_wale_mm",
)
"""Columns of an atlas; low and high are ends of 90 % intervals. Relaxed sizes are of the mean
stitch."""

INTERVAL_SOURCE = "Each repeat's own prediction; `predict` names what its intervals rest on."


@dataclass(frozen=True)
class Entry:
    """One repeat of an atlas.

    Attributes
    ----------
    values : one of each of :data:`VALUES`.
    curves : all of an atlas's curves, one after the other.
    provenance : where the law comes from.
    """

    values: tuple[float, ...]
    curves: tuple[float, ...]
    provenance: str


@dataclass(frozen=True, eq=False, repr=False)
class Atlas(Result):
    """Predictions of many repeats of one material.

    Attributes
    ----------
    material : its identifier.
    fingerprint : of the material's laws and sizes; an atlas of other laws is not continued.
    keys : the repeats (see :attr:`~knitcore.chart.stitch_chart.StitchChart.key`).
    values : (repeats, len(VALUES)).
    curves : (repeats, 3, 2, stresses), strains at ``STRESS_N_PER_MM``: along a free pull, across
        it, and along a pull with the width held; each course-wise and wale-wise.
    provenance : where each repeat's law comes from.
    """

    material: str
    fingerprint: str
    keys: tuple[str, ...]
    values: Array
    curves: Array
    provenance: tuple[str, ...]

    @classmethod
    def of_entries(cls, material: str, fingerprint: str, entries: Mapping[str, Entry]) -> Atlas:
        """A table of entries by key."""
        rows = entries.values()
        return cls(
            material=material,
            fingerprint=fingerprint,
            keys=tuple(entries),
            values=np.array([e.values for e in rows]).reshape(-1, len(VALUES)),
            curves=np.array([e.curves for e in rows]).reshape(-1, *CURVES),
            provenance=tuple(e.provenance for e in rows),
        )

    def __len__(self) -> int:
        return len(self.keys)

    def check_material(self, material: Material) -> None:
        """Refuse another material than that of the atlas.

        Raises
        ------
        InputError
        """
        if self.material != material.identifier:
            problem = f"it was built for {self.material}, not for {material.identifier}."
            raise InputError("atlas", problem, _BUILD)

    def column(self, name: str) -> Array:
        """One of :data:`VALUES` for all repeats."""
        return self.values[:, VALUES.index(name)]

    def modulus(self, direction: Direction) -> Array:
        """Young's moduli, N/mm."""
        return self.column(f"modulus_{direction}_n_per_mm")

    def poisson(self, direction: Direction) -> Array:
        """Contraction across a pull along a direction, over the strain along it."""
        return self.column(direction.of("poisson_yx", "poisson_xy"))

    @cached_property
    def log_moduli(self) -> Array:
        """(repeats, 2) logarithms of Young's moduli, course-wise and wale-wise."""
        return np.log(np.stack([self.modulus(d) for d in Direction], axis=1))

    def strains(self, direction: Direction) -> Array:
        """(repeats, stresses) strains along a free pull, at ``STRESS_N_PER_MM``."""
        return np.asarray(self.curves[:, 0, direction.axis])

    def strain_at(self, direction: Direction, stress_n_per_mm: ArrayLike) -> Array:
        """Strain of every repeat at a stress (N/mm), one for all or one each.

        NaN beyond the last stress of the table, 2 N/mm.
        """
        stresses = np.broadcast_to(np.asarray(stress_n_per_mm, dtype=float), (len(self),))
        curves = self.strains(direction)
        if np.ptp(stresses) == 0 and len(self):
            return _through(STRESS_N_PER_MM, curves)(float(stresses[0]))
        return _each(curves, stresses)

    def stress_at(self, direction: Direction, strain: float) -> Array:
        """Stress (N/mm) of every repeat at a strain, free across; NaN beyond the table."""
        return _stresses(self.strains(direction), strain)

    def held_stress_at(self, direction: Direction, strain: float) -> Array:
        """Stress (N/mm) of every repeat at a strain, the width held; NaN beyond the table."""
        return _stresses(self.curves[:, 2, direction.axis], strain)

    def across_at(self, direction: Direction, stress_n_per_mm: Array) -> Array:
        """Strain across a pull by stresses (N/mm), one of each repeat; NaN beyond the table."""
        return _each(self.curves[:, 1, direction.axis], stress_n_per_mm)

    def index_of(self, repeat: StitchChart) -> int | None:
        """Index of a repeat, given as any of its images; None if it is not in the atlas."""
        return self._index.get(repeat.canonical().key)

    def chart(self, index: int) -> StitchChart:
        """One repeat."""
        return StitchChart.parse(self.keys[index])

    @cached_property
    def costs(self) -> tuple[KnittingCost, ...]:
        """Cost of knitting each repeat."""
        return tuple(knitting_cost(self.chart(k)) for k in range(len(self)))

    @cached_property
    def stitches(self) -> Indices:
        """Number of stitches of each repeat."""
        return np.array([len(key.replace("/", "")) for key in self.keys], dtype=np.intp)

    def entries(self) -> dict[str, Entry]:
        """The rows by key."""
        curves = self.curves.reshape(len(self), -1).tolist()
        rows = zip(self.keys, self.values.tolist(), curves, self.provenance, strict=True)
        return {key: Entry(tuple(values), tuple(c), source) for key, values, c, source in rows}

    def only(self, keys: tuple[str, ...]) -> Atlas:
        """The atlas of some of the repeats, in that order."""
        entries = self.entries()
        return Atlas.of_entries(
            self.material, self.fingerprint, {key: entries[key] for key in keys}
        )

    @cached_property
    def _index(self) -> dict[str, int]:
        return {key: k for k, key in enumerate(self.keys)}


def _each(curves: Array, stress_n_per_mm: Array) -> Array:
    """Each curve of strains at its own stress."""
    pairs = zip(curves, stress_n_per_mm, strict=True)
    return np.array([_through(STRESS_N_PER_MM, curve)(stress) for curve, stress in pairs], float)


def _stresses(curves: Array, strain: float) -> Array:
    """Stress at a strain by each curve of strains."""
    # Curves are nearly flat at the lock-up; interpolation needs them to increase.
    rising = np.maximum.accumulate(curves, axis=1) + 1e-9 * np.arange(len(STRESS_N_PER_MM))
    return np.array([_through(curve, STRESS_N_PER_MM)(strain) for curve in rising], float)


def _through(x: Array, y: Array) -> PchipInterpolator:
    """The monotone curve through points, along the last axis; NaN beyond them."""
    from scipy.interpolate import PchipInterpolator  # loads for half a second

    return PchipInterpolator(x, y, axis=-1, extrapolate=False)


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
                curves=atlas.curves.astype(np.float32),
                provenance=np.array(atlas.provenance, dtype=np.str_),
            )
        Path(name).replace(file)
    finally:
        Path(name).unlink(missing_ok=True)


@in_reading_time
def load_atlas(file: Path) -> Atlas:
    """Read an atlas.

    Raises
    ------
    InputError
        If the file is missing or holds none.
    """
    if not file.is_file():
        raise InputError("atlas", f"there is no file {file}.", _BUILD)
    if file.stat().st_size > MAX_BYTES:
        raise InputError("atlas", f"{file.name} is too large.", _BUILD)
    version = FORMAT
    try:
        with np.load(io.BytesIO(file.read_bytes()), allow_pickle=False) as data:
            version = int(data["format"])
            atlas = Atlas(
                material=str(data["material"]),
                fingerprint=str(data["fingerprint"]),
                keys=tuple(data["keys"].tolist()),
                values=data["values"],
                curves=data["curves"].astype(float),
                provenance=tuple(data["provenance"].tolist()),
            )
    except Exception:  # a damaged archive fails in many ways: zlib, zipfile, numpy's own header
        if version != FORMAT:
            raise InputError("atlas", f"{file.name} is of another version.", _BUILD) from None
        raise InputError("atlas", f"{file.name} is not an atlas.", _BUILD) from None
    rows = len(atlas.keys)
    if (
        atlas.values.shape != (rows, len(VALUES))
        or atlas.curves.shape != (rows, *CURVES)
        or len(atlas.provenance) != rows
    ):
        raise InputError("atlas", f"{file.name} is damaged.", _BUILD)
    return atlas
