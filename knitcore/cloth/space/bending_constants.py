"""Bending of the four fabrics of a material, from the yarn level."""

import csv
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache, lru_cache
from importlib.resources import files
from types import MappingProxyType

from knitcore.base.errors import ConvergenceError
from knitcore.chart.fabric import Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials import Material
from knitcore.yarn.library.store import stored_for
from knitcore.yarn.library.yarns import ChartYarn, yarn_for
from knitcore.yarn.study.bending import FabricBending, bending_response
from knitcore.yarn.study.relax import relax


@dataclass(frozen=True)
class Bend:
    """Bending of a pure fabric.

    Parameters
    ----------
    curvature_course_per_mm, curvature_wale_per_mm : free curvature of a knit, positive with the
        face outside.
    rigidity_course_n_mm, rigidity_wale_n_mm : with the other size free.
    thickness_mm : extent of the yarn across the fabric.
    """

    curvature_course_per_mm: float
    curvature_wale_per_mm: float
    rigidity_course_n_mm: float
    rigidity_wale_n_mm: float
    thickness_mm: float


def bends_of(material: Material) -> Mapping[Fabric, Bend]:
    """Bending of the four fabrics of a material, relaxed with their symmetries.

    Acrylic and cotton are in the store of repeats. The library's other materials are in
    ``data/bends.csv``, which ``scripts/bends_table.py`` makes; others take a second or two.

    Raises
    ------
    InputError
        If the material lacks data that the yarn level needs.
    ConvergenceError
        If a fabric does not relax.
    """
    stored = _stored().get(material.sample)
    if stored is not None:
        return stored
    return MappingProxyType({fabric: computed(fabric, material) for fabric in Fabric})


def computed(fabric: Fabric, material: Material) -> Bend:
    """Bending of a fabric at the yarn level, from the store of repeats if it has the fabric."""
    repeat = StitchChart.of_fabric(fabric, rows=2, columns=2).repeat()
    return _bend(fabric, yarn_for(material, repeat))


def mirrored_bending(repeat: StitchChart, used: ChartYarn) -> FabricBending:
    """Bending of a repeat with the symmetries of its chart, stored or else computed.

    Raises
    ------
    ConvergenceError
        If it does not relax, or folds by itself.
    """
    stored = stored_for(repeat, used)
    if stored is None or stored.bending is None:
        return bending_response(relax(repeat, used.yarn, used.loop_length_mm, branch="mirrored"))
    if stored.bending.mirrored is None:
        raise ConvergenceError(stored.bending.failure)
    return stored.bending.mirrored


@cache
def _stored() -> Mapping[str, Mapping[Fabric, Bend]]:
    by_material: dict[str, dict[Fabric, Bend]] = {}
    path = files("knitcore.cloth.space") / "data" / "bends.csv"
    with path.open(encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            values = {field.name: float(row[field.name]) for field in fields(Bend)}
            by_material.setdefault(row["material"], {})[Fabric(row["fabric"])] = Bend(**values)
    return MappingProxyType({name: MappingProxyType(bends) for name, bends in by_material.items()})


@lru_cache(maxsize=256)
def _bend(fabric: Fabric, used: ChartYarn) -> Bend:
    repeat = StitchChart.of_fabric(fabric, rows=2, columns=2).repeat()
    bending = mirrored_bending(repeat, used)
    curls = fabric is Fabric.STOCKINETTE  # the others look the same from the back
    return Bend(
        curvature_course_per_mm=bending.course.curvature_per_mm if curls else 0.0,
        curvature_wale_per_mm=bending.wale.curvature_per_mm if curls else 0.0,
        rigidity_course_n_mm=bending.course.rigidity_n_mm,
        rigidity_wale_n_mm=bending.wale.rigidity_n_mm,
        thickness_mm=bending.thickness_mm,
    )
