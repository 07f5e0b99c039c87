"""Relaxed sizes of repeats: what the flat composite does not know.

Ribs draw in and welts shorten, because they fold. Their relaxed size comes from the yarn level,
from a user's gauge, or from a packaged table of common repeats. The table is of one yarn (loop
length 11.28 mm, radius 0.74 mm, core 0.30 mm, B = 0.045 N·mm², k = 6e-4 N/mm³, p = 2.4, convention
``authors-code``), relaxed freely in a study, or with the chart's mirror symmetries by
:mod:`knitcore.yarnlevel`. What it lacks comes from ``data/stored_sizes.csv``, the sizes of the
packaged store of relaxed repeats of acrylic and cotton (:mod:`knitcore.yarnlibrary.build`
writes it). Both are carried to a material by ratio: to the pure fabric that the repeat resembles
(1x1 rib for ribs, garter for welts), at equal loop length, because lengths scale with it.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from importlib.resources import files

import numpy as np

from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import PHASES, Fabric
from knitcore.materials import Material
from knitcore.phases import quarter_phases, reference_fabric

MOST_STITCHES = 64
"""Largest repeat that is looked for in the table."""


class SizeSource(StrEnum):
    """Where a relaxed size comes from."""

    TABLE = "packaged table"
    STORE = "packaged store"
    YARN_LEVEL = "yarn level"
    GAUGE = "gauge"


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


def canonical_repeat(repeat: StitchChart) -> StitchChart:
    """One chart for all that are the same cloth: shifted, mirrored, or seen from the back.

    A welt turned upside down is the same cloth too. Other repeats are not, because a stitch is not:
    the columns of its upside-down neighbours lie half a stitch aside.

    Examples
    --------
    >>> print(canonical_repeat(StitchChart.parse("PPKK")))
    KKPP
    """
    best: tuple[bytes, StitchChart] | None = None
    for chart in (repeat, repeat.mirror()):
        for upright in (chart, chart.mirror_vertical()) if chart.columns == 1 else (chart,):
            for side in (upright, upright.swap()):
                for down in range(side.rows):
                    for across in range(side.columns):
                        purl = np.roll(side.purl, (down, across), axis=(0, 1))
                        key = purl[::-1].tobytes()
                        if best is None or key < best[0]:
                            best = key, StitchChart(purl)
    assert best is not None  # noqa: S101 - a chart has at least one stitch
    return best[1]


def tabled_size(repeat: StitchChart, material: Material) -> RelaxedSize | None:
    """Relaxed size of a repeat in a material, or None if neither table nor store has it.

    Parameters
    ----------
    repeat : the smallest repeat of a chart.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> size = tabled_size(StitchChart.parse("KKPP"), material("acrylic"))
    >>> round(size.course_mm, 2)  # 1x1 rib is 2.64 mm wide
    1.8
    """
    if repeat.rows * repeat.columns > MOST_STITCHES:
        return None
    key = canonical_repeat(repeat).text
    for branch in _BRANCHES:
        cell = _table().get((branch, key))
        if cell is not None:
            pure = {f: _table()[branch, text] for f, text in _PURE_CHARTS.items()}
            return carried_over(cell, pure, repeat, material, SizeSource.TABLE)
    ratio = stored_ratio(repeat, material)
    if ratio is None:
        return None
    like = {reference_fabric(repeat): (1.0, 1.0)}
    return carried_over(ratio, like, repeat, material, SizeSource.STORE)


def stored_ratio(repeat: StitchChart, material: Material) -> tuple[float, float] | None:
    """Size of a repeat over that of its pure fabric at equal loop length, from the store.

    Acrylic and cotton have their own; other yarns get the geometric mean of the two.
    """
    own = material.identifier.partition(":")[0]
    ratios = _stored().get(canonical_repeat(repeat).text, {})
    used = [ratios[own]] if own in ratios else list(ratios.values())
    if not used:
        return None
    course, wale = np.exp(np.mean(np.log(used), axis=0))
    return float(course), float(wale)


def carried_over(
    cell_mm: tuple[float, float],
    pure_mm: Mapping[Fabric, tuple[float, float]],
    repeat: StitchChart,
    material: Material,
    source: SizeSource = SizeSource.YARN_LEVEL,
) -> RelaxedSize | None:
    """A relaxed size of one yarn taken over to a material, by its ratio to a pure fabric.

    Parameters
    ----------
    cell_mm : (course, wale) size of the repeat's mean stitch, relaxed on the yarn level.
    pure_mm : the same of the pure fabrics, of the same yarn, loop length and branch.
    repeat : the smallest repeat.

    Returns
    -------
    RelaxedSize, or None if the material lacks the pure fabric that the repeat resembles.
    """
    reference = reference_fabric(repeat)
    record = material.fabrics.get(reference)
    if record is None:
        return None
    pure = pure_mm[reference]
    scale = _loop_length_ratio(repeat, material, reference)
    return RelaxedSize(
        course_mm=cell_mm[0] / pure[0] * record.stitch_course_mm * scale,
        wale_mm=cell_mm[1] / pure[1] * record.stitch_wale_mm * scale,
        source=source,
    )


_BRANCHES = ("free", "mirrored")
"""Shape spaces of the yarn level, the preferred one first: ribs fold freely."""

_PURE_CHARTS = {
    Fabric.STOCKINETTE: "K",
    Fabric.GARTER: "K\nP",
    Fabric.RIB: "KP",
    Fabric.SEED: "KP\nPK",
}


def _loop_length_ratio(chart: StitchChart, material: Material, reference: Fabric) -> float:
    """Loop length of the repeat (the mean of its phases) over that of the reference fabric."""
    shares = np.bincount(quarter_phases(chart, periodic=True).ravel(), minlength=4)
    lengths = []
    for phase in np.flatnonzero(shares):
        record = material.fabrics.get(PHASES[phase])
        if record is None or record.loop_length_mm is None:
            return 1.0
        lengths.append(float(shares[phase] / shares.sum()) * record.loop_length_mm)
    own = material.record(reference).loop_length_mm
    return 1.0 if own is None else sum(lengths) / own


@cache
def _table() -> Mapping[tuple[str, str], tuple[float, float]]:
    """(course, wale) sizes in mm by branch and text of the canonical chart."""
    resource = files("knitcore.answer").joinpath("data", "relaxed_sizes.csv")
    found = {}
    for row in csv.DictReader(resource.read_text(encoding="utf-8").splitlines()):
        chart = canonical_repeat(StitchChart.parse(row["chart"].replace("/", "\n")))
        found[row["branch"], chart.text] = (float(row["course_mm"]), float(row["wale_mm"]))
    return found


@cache
def _stored() -> Mapping[str, Mapping[str, tuple[float, float]]]:
    """(course, wale) ratios by text of the canonical chart, and by yarn."""
    resource = files("knitcore.answer").joinpath("data", "stored_sizes.csv")
    found: dict[str, dict[str, tuple[float, float]]] = {}
    for row in csv.DictReader(resource.read_text(encoding="utf-8").splitlines()):
        chart = canonical_repeat(StitchChart.parse(row["chart"].replace("/", "\n")))
        ratio = (float(row["course_ratio"]), float(row["wale_ratio"]))
        found.setdefault(chart.text, {})[row["yarn"]] = ratio
    return found
