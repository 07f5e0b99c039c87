"""Bending of the four fabrics of a material, from the yarn level."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache, lru_cache
from importlib.resources import files
from types import MappingProxyType

from knitcore.chart import StitchChart
from knitcore.fabric import Fabric
from knitcore.materials import Material
from knitcore.yarnlevel.bending import bending_response
from knitcore.yarnlevel.relax import relax
from knitcore.yarnlevel.yarn import YarnModel
from knitcore.yarnlibrary.yarns import yarn_for


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

    Those of the library come with the package (``data/bends.csv``, made by
    ``scripts/bends_table.py``); others take a second or two.

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
    """Bending of a fabric, from the yarn level."""
    used = yarn_for(material, StitchChart.of_fabric(fabric, rows=2, columns=2).repeat())
    return _bend(fabric, used.yarn, used.loop_length_mm)


@cache
def _stored() -> Mapping[str, Mapping[Fabric, Bend]]:
    found: dict[str, dict[Fabric, Bend]] = {}
    path = files("knitcore.shell") / "data" / "bends.csv"
    with path.open(encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            values = {field.name: float(row[field.name]) for field in fields(Bend)}
            found.setdefault(row["material"], {})[Fabric(row["fabric"])] = Bend(**values)
    return MappingProxyType({name: MappingProxyType(bends) for name, bends in found.items()})


@lru_cache(maxsize=256)
def _bend(fabric: Fabric, yarn: YarnModel, loop_length_mm: float) -> Bend:
    repeat = StitchChart.of_fabric(fabric, rows=2, columns=2).repeat()
    found = bending_response(relax(repeat, yarn, loop_length_mm))
    curls = fabric is Fabric.STOCKINETTE  # the others look the same from the back
    return Bend(
        curvature_course_per_mm=found.course.curvature_per_mm if curls else 0.0,
        curvature_wale_per_mm=found.wale.curvature_per_mm if curls else 0.0,
        rigidity_course_n_mm=found.course.rigidity_n_mm,
        rigidity_wale_n_mm=found.wale.rigidity_n_mm,
        thickness_mm=found.thickness_mm,
    )
