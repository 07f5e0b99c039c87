"""The pure fabrics of a material, mixed by their shares in a chart whatever their arrangement.

Strain at equal stress (the Reuss bound), size and Poisson's ratio are means over the quarter cells.
:mod:`knitcore.prediction.learned` corrects this mixture.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.fabric import PHASES, Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import (
    free_strains_at_stress,
    free_transverse_strains,
    held_strains_at_stress,
)
from knitcore.materials import FabricRecord, Material, Origin
from knitcore.materials.interval_parts import Part, added, deviation
from knitcore.yarn.library.yarns import yarn_for
from knitcore.yarn.model.yarn_model import YarnModel

USUAL_STRESS_N_PER_MM = 2e-5
"""B / L³ assumed for a yarn whose B is unknown: about the middle of the library."""
_NOTHING = 1e-9
"""Shares below this are rounding errors."""


@dataclass(frozen=True, eq=False)
class Mixture:
    """Pure fabrics with their shares.

    Attributes
    ----------
    parts : (share, record) of each fabric that is present.
    numbers : (4,) ln r/L, ln core/L, ln k r⁴L/B and contact exponent of the yarn, means of the
        parts; nan where the material does not describe its yarn well enough.
    bending_stress_n_per_mm : B / L³, the unit in which stresses of different yarns compare.
    """

    parts: tuple[tuple[float, FabricRecord], ...]
    numbers: Array
    bending_stress_n_per_mm: float

    @classmethod
    def of(cls, shares: Array, material: Material) -> Mixture:
        """The mixture of a material's fabrics with these shares, by phase code.

        Raises
        ------
        InputError
            If the material lacks a fabric with a share.
        """
        return cls.each(shares[None], material)[0]

    @classmethod
    def each(cls, shares: Array, material: Material) -> list[Mixture]:
        """The mixtures with each of these shares, (m, 4)."""
        yarns = pure_numbers(material, present(shares))
        mixtures = []
        for own in shares:
            phases = present(own)
            parts = tuple((float(own[k]), material.record(PHASES[k])) for k in phases)
            *numbers, bending = own[phases] @ yarns[phases]
            stress = USUAL_STRESS_N_PER_MM if math.isnan(bending) else math.exp(bending)
            mixtures.append(cls(parts, np.array(numbers), stress))
        return mixtures

    @property
    def simulated(self) -> bool:
        """Say whether all of its fabrics are simulated at the yarn level."""
        return all(record.origin is Origin.SIMULATED for _, record in self.parts)

    @property
    def size_mm(self) -> Array:
        """(2,) width and height of the mean stitch."""
        sizes = [(s * r.stitch_course_mm, s * r.stitch_wale_mm) for s, r in self.parts]
        return np.asarray(np.sum(sizes, axis=0))

    @property
    def poisson(self) -> Array:
        """(2,) nu_yx and nu_xy."""
        ratios = [(s * r.law.poisson_yx, s * r.law.poisson_xy) for s, r in self.parts]
        return np.asarray(np.sum(ratios, axis=0))

    def modulus_n_per_mm(self, direction: Direction) -> float:
        """Initial modulus: parts in series."""
        return 1.0 / sum(share / record.law.modulus(direction) for share, record in self.parts)

    def bounds_n_per_mm(self, direction: Direction) -> tuple[float, float]:
        """Reuss and Voigt bounds of the modulus, by shares."""
        moduli = [(share, record.law.modulus(direction)) for share, record in self.parts]
        return self.modulus_n_per_mm(direction), sum(share * modulus for share, modulus in moduli)

    def strain(self, direction: Direction, stress_n_per_mm: ArrayLike) -> Array:
        """Strain at stresses (N/mm, at least 0)."""
        return np.asarray(np.sum(self._strains(direction, stress_n_per_mm), axis=0))

    def shares_of_strain(self, direction: Direction, stress_n_per_mm: ArrayLike) -> Array:
        """(2, …) strain across, and strain at a held width, over the strain at equal stress.

        Each is a mean of the parts, as the strain itself is.
        """
        stress = np.maximum(np.asarray(stress_n_per_mm, dtype=float), _STRESSES[0])
        strains = np.array(self._strains(direction, stress))
        own = np.array([_law_shares(r.law, direction, stress) for _, r in self.parts])
        return np.asarray((strains[:, None] * own).sum(axis=0) / strains.sum(axis=0))

    def log_sd(self, direction: Direction, stress_n_per_mm: ArrayLike) -> Array:
        """Standard deviation of the log strain from the uncertainty of the pure fabrics' laws.

        It applies to a law's scale of stress, so it changes strains less near the lock-up.
        """
        return deviation(added(self.variances(direction, stress_n_per_mm)))

    def variances(
        self, direction: Direction, stress_n_per_mm: ArrayLike
    ) -> list[dict[Part, Array]]:
        """Variances of the log strain from the uncertainty of each fabric's law."""
        strains = np.array(self._strains(direction, stress_n_per_mm))
        total = strains.sum(axis=0)
        deviations = np.array(
            [
                record.uncertainty.log_stress(direction, stress_n_per_mm)
                * _law_slopes(record.law, direction, np.asarray(stress_n_per_mm, dtype=float))
                for _, record in self.parts
            ]
        )
        shares = np.divide(strains, total, out=np.zeros_like(strains), where=total > 0)
        squares = (deviations * shares) ** 2
        return [{r.unknown: square} for (_, r), square in zip(self.parts, squares, strict=True)]

    def _strains(self, direction: Direction, stress_n_per_mm: ArrayLike) -> list[Array]:
        return [
            share * law_strains(record.law, direction, np.asarray(stress_n_per_mm, dtype=float))
            for share, record in self.parts
        ]


_STRESSES: Array = np.geomspace(1e-7, 100.0, 1000)
_LOG_STRESSES: Array = np.log(_STRESSES)


def law_strains(law: ConstitutiveLaw, direction: Direction, stress_n_per_mm: Array) -> Array:
    """Strains of a law from its table, within 1e-4 of their own size."""
    at = np.log(np.maximum(stress_n_per_mm, _STRESSES[0]))
    strains = np.exp(np.interp(at, _LOG_STRESSES, _log_strains(law, direction)))
    return np.asarray(strains * np.minimum(stress_n_per_mm / _STRESSES[0], 1.0))


def _law_slopes(law: ConstitutiveLaw, direction: Direction, stress_n_per_mm: Array) -> Array:
    """d ln strain / d ln stress of a law: 1 at first, less where it stiffens."""
    at = np.log(np.maximum(stress_n_per_mm, _STRESSES[0]))
    return np.asarray(np.interp(at, _LOG_STRESSES, _slopes(law, direction)))


def _law_shares(law: ConstitutiveLaw, direction: Direction, stress_n_per_mm: Array) -> Array:
    """(2, …) strain across, and strain at a held width, over a law's strain, from its table."""
    at = np.log(stress_n_per_mm)
    return np.array([np.interp(at, _LOG_STRESSES, shares) for shares in _shares(law, direction)])


@lru_cache(maxsize=128)
def _shares(law: ConstitutiveLaw, direction: Direction) -> Array:
    free = np.exp(_log_strains(law, direction))
    across = free_transverse_strains(law, direction, free)
    return np.array([across, held_strains_at_stress(law, direction, _STRESSES)]) / free


@lru_cache(maxsize=128)
def _slopes(law: ConstitutiveLaw, direction: Direction) -> Array:
    return np.asarray(np.gradient(_log_strains(law, direction), _LOG_STRESSES))


@lru_cache(maxsize=128)
def _log_strains(law: ConstitutiveLaw, direction: Direction) -> Array:
    return np.log(free_strains_at_stress(law, direction, _STRESSES))


def yarn_numbers(yarn: YarnModel, loop_length_mm: float) -> Array:
    """(5,): ln r/L, ln core/L, ln k r⁴L/B, contact exponent, ln B/L³ (of N/mm)."""
    r, bending = yarn.radius_mm, yarn.bending_modulus_n_mm2
    contact = yarn.contact_stiffness_n_per_mm3 * r**4 * loop_length_mm / bending
    return np.array(
        [
            math.log(r / loop_length_mm),
            math.log(yarn.core_radius_mm / loop_length_mm),
            math.log(contact),
            yarn.contact_exponent,
            math.log(bending / loop_length_mm**3),
        ]
    )


def present(shares: Array) -> NDArray[np.int64]:
    """Phase codes with a share in any of the mixtures (…, 4)."""
    return np.flatnonzero(shares.reshape(-1, 4).max(axis=0) > _NOTHING)


def pure_numbers(material: Material, phases: NDArray[np.int64]) -> Array:
    """Numbers of the yarn in these pure fabrics, (4, 5).

    They are nan in other fabrics, and where too little is known.
    """
    numbers = np.full((len(PHASES), 5), np.nan)
    for phase in phases:
        try:
            used = yarn_for(material, StitchChart.of_fabric(PHASES[phase]))
        except InputError:
            continue
        numbers[phase] = yarn_numbers(used.yarn, used.loop_length_mm)
    return numbers
