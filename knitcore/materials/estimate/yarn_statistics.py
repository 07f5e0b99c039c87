"""Statistics of the yarns in the library, and how well they predict a yarn left out.

Young's moduli are scaled by B / L³ (bending modulus over the cube of the loop length) and predicted
by the mixed model of :mod:`knitcore.materials.estimate.mixed_model`, fitted to the packaged tables;
alpha and beta by the same model, unscaled; Poisson ratios are the library's means of each fabric.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from knitcore.base.arrays import Array, Mask
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import Material, load_library
from knitcore.materials.estimate.mixed_model import MixedModel, covering, interval_factor
from knitcore.materials.law_uncertainty import COVERAGE

LOAD_N_PER_MM = 0.1
"""Load at which the extension is shown: that of a garment pulled on by hand."""
FABRICS = tuple(Fabric)
DIRECTIONS = tuple(Direction)
QUANTITIES = ("modulus", "alpha", "beta")
"""Quantities that are each predicted by a mixed model."""


@dataclass(frozen=True)
class LeftOut:
    """How well yarns left out are predicted; factors are exp(rms of the logarithm).

    Attributes
    ----------
    measured : fabrics of the left-out yarn that were given.
    modulus_rms_factor, modulus_median_factor, modulus_within_two : moduli of all other fabrics.
    strain_rms_factor : extension at 0.1 N/mm.
    alpha_rms_factor, beta_rms_factor : constants of the stiffening.
    modulus_coverage, strain_coverage : share of left-out values inside intervals that were
        calibrated without that yarn.
    values : number of left-out moduli.
    """

    measured: tuple[Fabric, ...]
    modulus_rms_factor: float
    modulus_median_factor: float
    modulus_within_two: float
    strain_rms_factor: float
    alpha_rms_factor: float
    beta_rms_factor: float
    modulus_coverage: float
    strain_coverage: float
    values: int


@dataclass(frozen=True, eq=False)
class LibraryTable:
    """Logarithms over (yarns, fabrics, directions); Poisson ratios as they are.

    ``modulus`` is of Y L³ / B; ``strain`` of the extension at 0.1 N/mm; ``scale`` of B / L³;
    ``stitch`` of the stitch's extent over the loop length.
    """

    modulus: Array
    alpha: Array
    beta: Array
    strain: Array
    scale: Array
    poisson: Array
    stitch: Array

    def without(self, index: int) -> LibraryTable:
        """The table with one yarn left out."""
        return LibraryTable(
            *(np.delete(getattr(self, name), index, axis=0) for name in self.__dataclass_fields__)
        )


@cache
def library_table() -> LibraryTable:
    """The library's eight yarns as arrays."""
    return table_of(tuple(load_library().values()))


def table_of(materials: Sequence[Material]) -> LibraryTable:
    """Arrays of complete materials whose B and loop lengths are known.

    Raises
    ------
    InputError
        If a bending modulus or a loop length is missing.
    """
    rows = []
    for material in materials:
        bending = material.yarn.bending_modulus_n_mm2
        for fabric in FABRICS:
            record = material.record(fabric)
            if bending is None or record.loop_length_mm is None:
                problem = f"has no bending modulus or no loop length of its {fabric}."
                raise InputError(material.identifier, problem, "Add both to the material.")
            for direction in DIRECTIONS:
                scale = math.log(bending / record.loop_length_mm**3)
                modulus = math.log(record.law.modulus(direction))
                strain = float(free_strains_at_stress(record.law, direction, LOAD_N_PER_MM))
                rows.append(
                    (
                        modulus - scale,
                        math.log(record.law.alpha(direction)),
                        math.log(record.law.beta(direction)),
                        math.log(strain),
                        scale,
                        record.law.poisson(direction),
                        math.log(record.stitch_size_mm(direction) / record.loop_length_mm),
                    )
                )
    table = np.array(rows).reshape(len(materials), len(FABRICS), len(DIRECTIONS), 7)
    return LibraryTable(*np.moveaxis(table, -1, 0))


@cache
def left_out(measured: tuple[Fabric, ...] = ()) -> LeftOut:
    """Predict each library yarn from the other seven and its own swatches of these fabrics.

    Intervals are calibrated without the yarn whose values they should cover (nested).

    Raises
    ------
    InputError
        If all four fabrics are given, so that nothing is left out.
    """
    mask = mask_of(measured)
    if mask.all():
        raise InputError("measured", "all fabrics are measured.", "Leave at least one out.")
    table = library_table()
    out = ~mask
    errors: dict[str, list[Array]] = {name: [] for name in (*QUANTITIES, "strain")}
    inside: dict[str, list[float]] = {"modulus": [], "strain": []}
    for i in range(len(table.modulus)):
        others = table.without(i)
        predicted = predict_cells(others, _own_row(table, i), mask, table.scale[i])
        for name, collected in errors.items():
            collected.append((getattr(table, name)[i] - predicted.values[name])[out])
        width = (
            interval_factor(others.modulus, mask, COVERAGE) * predicted.deviation["modulus"][out]
        )
        inside["modulus"].append(float(np.mean(np.abs(errors["modulus"][-1]) <= width)))
        strain_width = _strain_width(others, mask)
        inside["strain"].append(float(np.mean(np.abs(errors["strain"][-1]) <= strain_width)))
    rms = {name: float(np.exp(np.sqrt(np.mean(np.square(e))))) for name, e in errors.items()}
    modulus = np.abs(np.array(errors["modulus"]))
    return LeftOut(
        measured=measured,
        modulus_rms_factor=rms["modulus"],
        modulus_median_factor=float(np.exp(np.median(modulus))),
        modulus_within_two=float(np.mean(modulus <= math.log(2))),
        strain_rms_factor=rms["strain"],
        alpha_rms_factor=rms["alpha"],
        beta_rms_factor=rms["beta"],
        modulus_coverage=float(np.mean(inside["modulus"])),
        strain_coverage=float(np.mean(inside["strain"])),
        values=int(modulus.size),
    )


@dataclass(frozen=True, eq=False)
class PredictedCells:
    """Logarithms (4, 2) by quantity, their standard deviations, and the laws they make."""

    values: dict[str, Array]
    deviation: dict[str, Array]
    laws: list[ConstitutiveLaw]


def predict_cells(
    table: LibraryTable, own: Mapping[str, Array], measured: Mask, scale: Array
) -> PredictedCells:
    """All cells of a yarn from a table of others and its own measured cells.

    Parameters
    ----------
    table : the other yarns.
    own : logarithms (4, 2) by quantity, read where measured.
    measured : (4, 2).
    scale : (4, 2), logarithm of B / L³ of the fabrics to predict.
    """
    values: dict[str, Array] = {}
    deviation: dict[str, Array] = {}
    for name in QUANTITIES:
        model = MixedModel.fit(getattr(table, name)[:, None]).knowing_cells(
            own[name][None], measured
        )
        values[name], deviation[name] = model.mean[0], model.deviation[0]
    poisson = table.poisson.mean(axis=0)
    modulus, alpha, beta = (
        np.exp(values["modulus"] + scale),
        np.exp(values["alpha"]),
        np.exp(values["beta"]),
    )
    laws = [
        ConstitutiveLaw.of_moduli(
            *modulus[i].tolist(),
            *poisson[i].tolist(),
            alpha_xx=float(alpha[i, 0]),
            alpha_yy=float(alpha[i, 1]),
            beta_xx=float(beta[i, 0]),
            beta_yy=float(beta[i, 1]),
        )
        for i in range(len(FABRICS))
    ]
    values["strain"] = np.log(
        [[free_strains_at_stress(law, d, LOAD_N_PER_MM) for d in DIRECTIONS] for law in laws]
    )
    return PredictedCells(values, deviation, laws)


@cache
def interval_widths(measured: tuple[Fabric, ...]) -> dict[str, float]:
    """Half widths of the intervals: in standard deviations, for the strain as a logarithm."""
    mask = mask_of(measured)
    table = library_table()
    if mask.all():
        return {"modulus": 0.0, "alpha": 0.0, "beta": 0.0, "strain": 0.0}
    factors = {name: interval_factor(getattr(table, name), mask, COVERAGE) for name in QUANTITIES}
    return factors | {"strain": _strain_width(table, mask)}


def _strain_width(table: LibraryTable, mask: Mask) -> float:
    """Logarithm of the factor that covers 90 % of left-out extensions under load."""
    errors = [
        (
            table.strain[i]
            - predict_cells(table.without(i), _own_row(table, i), mask, table.scale[i]).values[
                "strain"
            ]
        )[~mask]
        for i in range(len(table.strain))
    ]
    return covering(np.abs(errors), COVERAGE)


def _own_row(table: LibraryTable, index: int) -> dict[str, Array]:
    return {name: getattr(table, name)[index] for name in QUANTITIES}


def mask_of(measured: Sequence[Fabric]) -> Mask:
    """(4, 2) mask of both directions of these fabrics."""
    mask = np.zeros((4, 2), dtype=bool)
    for fabric in measured:
        mask[FABRICS.index(fabric)] = True
    return mask
