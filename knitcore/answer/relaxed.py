"""Relaxed sizes of repeats: what the flat composite does not know.

Ribs draw in and welts shorten, because they fold. Their relaxed size comes from a user's gauge,
from the packaged store of relaxed repeats (:mod:`knitcore.yarnlibrary.store`), or from a packaged
table of common ones. The table is of one yarn (loop length 11.28 mm, radius 0.74 mm, core 0.30 mm,
B = 0.045 N·mm², k = 6e-4 N/mm³, p = 2.4, convention ``authors-code``), relaxed freely in a study,
or with the chart's mirror symmetries by :mod:`knitcore.yarnlevel`. All are taken over to a
material by ratio: to the pure fabric that the repeat resembles (1x1 rib for ribs, garter for
welts), at equal loop length, because lengths scale with it.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from importlib.resources import files

import numpy as np

from knitcore.answer.repeat import Repeat
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.materials import Material
from knitcore.phases import reference_fabric
from knitcore.yarnlibrary.store import MATERIALS, StoredStitch, stored_stitch

MOST_STITCHES = 64
"""Largest repeat that is looked for."""


class SizeSource(StrEnum):
    """Where a relaxed size comes from."""

    MATERIAL = "gauge of the pure fabric"
    TABLE = "packaged table"
    STORE = "packaged store"
    YARN_LEVEL = "yarn level"
    GAUGE = "gauge"
    COMPOSITE = "mean of its pure fabrics"


SIZE_LOG_SD = {
    SizeSource.MATERIAL: 0.08,
    SizeSource.TABLE: 0.10,
    SizeSource.STORE: 0.12,
    SizeSource.YARN_LEVEL: 0.10,
    SizeSource.GAUGE: 0.03,
    SizeSource.COMPOSITE: 0.25,
}
"""Standard deviations of the logarithm of a size. Pure fabrics: one aspect ratio stands for all
yarns, and those of two yarns differ by up to 17 % (``materials/data/aspect.csv``). Ratios of two
yarns in the store differ by 0.07 (ribs and welts); the branches differ by 0.10. The mean of the
pure fabrics misses 10 % of fresh yarn-level charts by more than a factor of 1.5."""


@dataclass(frozen=True)
class RelaxedSize:
    """Relaxed size of one mean stitch of a repeat.

    Raises
    ------
    InputError
        If a size is not a positive number.
    """

    course_mm: float
    wale_mm: float
    source: SizeSource

    def __post_init__(self) -> None:
        for name in ("course_mm", "wale_mm"):
            value = getattr(self, name)
            if not (np.isfinite(value) and 0 < value < 500):
                raise InputError(name, f"{value} mm is no stitch size.", "Give mm per stitch.")

    @classmethod
    def from_gauge(cls, stitches_per_10_cm: float, rows_per_10_cm: float) -> RelaxedSize:
        """From a swatch's gauge.

        Examples
        --------
        >>> RelaxedSize.from_gauge(25, 40).course_mm
        4.0
        """
        for name, value in (
            ("stitches_per_10_cm", stitches_per_10_cm),
            ("rows_per_10_cm", rows_per_10_cm),
        ):
            if not (np.isfinite(value) and value > 0):
                raise InputError(name, f"{value} is no gauge.", "Count over 10 cm.")
        return cls(100 / stitches_per_10_cm, 100 / rows_per_10_cm, SizeSource.GAUGE)

    @property
    def log_sd(self) -> float:
        """Standard deviation of the logarithm of both sizes."""
        return SIZE_LOG_SD[self.source]

    def extent_mm(self, direction: Direction) -> float:
        """Size along a direction."""
        return self.course_mm if direction is Direction.COURSE else self.wale_mm


def known_size(repeat: Repeat, material: Material) -> RelaxedSize | None:
    """Relaxed size of a repeat in a material, or None if neither table nor store has it.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> size = known_size(Repeat.of(StitchChart.parse("KKPP")), material("acrylic"))
    >>> round(size.course_mm, 2)  # 1x1 rib is 2.64 mm wide
    1.8
    """
    chart = repeat.chart
    if chart.rows * chart.columns > MOST_STITCHES or any(
        fabric not in material.fabrics for fabric in repeat.present
    ):
        return None
    key = chart.canonical().key
    for branch in _BRANCHES:
        cell = _table().get((branch, key))
        if cell is not None:
            pure = _table()[branch, _PURE_CHARTS[reference_fabric(chart)]]
            ratio = cell[0] / pure[0], cell[1] / pure[1]
            return _in_material(ratio, repeat, material, SizeSource.TABLE)
    stored = stored_ratio(chart, material)
    return None if stored is None else _in_material(stored, repeat, material, SizeSource.STORE)


def stored_ratio(chart: StitchChart, material: Material) -> tuple[float, float] | None:
    """Size of a repeat over that of its pure fabric at equal loop length, from the store.

    Acrylic and cotton have their own; other yarns get the geometric mean of the two.
    """
    own = material.identifier.partition(":")[0]
    ratios = {yarn: ratio for yarn in MATERIALS if (ratio := _ratio(chart, yarn)) is not None}
    used = [ratios[own]] if own in ratios else list(ratios.values())
    if not used:
        return None
    course, wale = np.exp(np.mean(np.log(used), axis=0))
    return float(course), float(wale)


def stored_pure(fabric: Fabric, yarn: str) -> StoredStitch | None:
    """The store's own pure fabric."""
    return stored_stitch(StitchChart.of_fabric(fabric, rows=2, columns=2), yarn)


def _ratio(chart: StitchChart, yarn: str) -> tuple[float, float] | None:
    stored, pure = stored_stitch(chart, yarn), stored_pure(reference_fabric(chart), yarn)
    if stored is None or pure is None or not (stored.converged and pure.converged):
        return None
    shorter = pure.loop_length_mm / stored.loop_length_mm
    return (
        stored.cell_course_mm / pure.cell_course_mm * shorter,
        stored.cell_wale_mm / pure.cell_wale_mm * shorter,
    )


def _in_material(
    ratio: tuple[float, float], repeat: Repeat, material: Material, source: SizeSource
) -> RelaxedSize | None:
    """A ratio to the pure fabric that a repeat resembles as a size in a material."""
    record = material.fabrics.get(reference_fabric(repeat.chart))
    if record is None:
        return None
    lengths = [material.record(fabric).loop_length_mm for fabric in repeat.present]
    scale = 1.0
    if record.loop_length_mm is not None and None not in lengths:
        shares = repeat.shares[repeat.shares > 0]
        scale = float(shares @ np.array(lengths, dtype=float)) / record.loop_length_mm
    return RelaxedSize(
        ratio[0] * record.stitch_course_mm * scale, ratio[1] * record.stitch_wale_mm * scale, source
    )


_BRANCHES = ("free", "mirrored")
"""Shape spaces of the yarn level, the preferred one first: ribs fold freely."""

_PURE_CHARTS = {fabric: StitchChart.of_fabric(fabric, 2, 2).canonical().key for fabric in Fabric}


@cache
def _table() -> Mapping[tuple[str, str], tuple[float, float]]:
    """(course, wale) sizes in mm by branch and key of the canonical chart."""
    resource = files("knitcore.answer").joinpath("data", "relaxed_sizes.csv")
    found = {}
    for row in csv.DictReader(resource.read_text(encoding="utf-8").splitlines()):
        key = StitchChart.parse(row["chart"]).canonical().key
        found[row["branch"], key] = (float(row["course_mm"]), float(row["wale_mm"]))
    return found
