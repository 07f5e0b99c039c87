"""How a sheet stretches under stress along one direction while the other is free.

Whatever the strains come from (a law, phases in series or in parallel, a table), a response has a
modulus and gives the strain at a stress.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

from knitcore.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import free_strains_at_stress

Array = NDArray[np.float64]


class Response(Protocol):
    """Stretch of a sheet pulled along one direction."""

    @property
    def modulus_n_per_mm(self) -> float:
        """Young's modulus at no stress."""
        ...

    def strain(self, stress: ArrayLike) -> Array:
        """Engineering strains at stresses (N/mm, at least 0); both arrays of one shape."""
        ...


@dataclass(frozen=True)
class LawResponse:
    """The response of a constitutive law."""

    law: ConstitutiveLaw
    direction: Direction

    @property
    def modulus_n_per_mm(self) -> float:
        """Young's modulus of the law."""
        return self.law.modulus(self.direction)

    def strain(self, stress: ArrayLike) -> Array:
        """Strains at stresses (N/mm)."""
        return free_strains_at_stress(self.law, self.direction, stress)


@dataclass(frozen=True)
class Stiffened:
    """A response that needs ``factor`` times the stress for every strain."""

    response: Response
    factor: float

    @property
    def modulus_n_per_mm(self) -> float:
        """Young's modulus."""
        return self.factor * self.response.modulus_n_per_mm

    def strain(self, stress: ArrayLike) -> Array:
        """Strains at stresses (N/mm)."""
        return self.response.strain(np.asarray(stress, dtype=float) / self.factor)


@dataclass(frozen=True, eq=False)
class Tabled:
    """A response through given points, smooth between them and a power of the stress beyond.

    Parameters
    ----------
    modulus_n_per_mm : Young's modulus, held up to :data:`LINEAR_N_PER_MM`.
    stress_n_per_mm, strains : (points,), increasing and above 0.
    """

    modulus_n_per_mm: float
    stress_n_per_mm: Array
    strains: Array

    @cached_property
    def _logs(self) -> PchipInterpolator:
        stress = np.concatenate([[LINEAR_N_PER_MM], self.stress_n_per_mm])
        strain = np.concatenate([[LINEAR_N_PER_MM / self.modulus_n_per_mm], self.strains])
        return PchipInterpolator(np.log(stress), np.log(np.maximum.accumulate(strain)))

    def strain(self, stress: ArrayLike) -> Array:
        """Strains at stresses (N/mm)."""
        sigma = np.asarray(stress, dtype=float)
        last = float(self.stress_n_per_mm[-1])
        at = np.log(np.clip(sigma, LINEAR_N_PER_MM, last))
        beyond = float(self._logs(np.log(last), 1)) * np.log(np.maximum(sigma / last, 1.0))
        curved = np.exp(self._logs(at) + beyond)
        return np.where(sigma < LINEAR_N_PER_MM, sigma / self.modulus_n_per_mm, curved)


LINEAR_N_PER_MM = 1e-4
"""Up to this stress a tabled response is linear."""

_STRESSES = np.concatenate([[0.0], np.geomspace(1e-5, 10.0, 600)])


def stress_at_strain(response: Response, strain: ArrayLike) -> Array:
    """Stresses (N/mm) at strains of at least 0; 10 N/mm where that stretches it less far."""
    reached = np.maximum.accumulate(response.strain(_STRESSES))
    grid, first = np.unique(reached, return_index=True)
    wanted = np.asarray(strain, dtype=float)
    # in logarithms, so that the first slope and the lock-up are met alike
    logs = np.interp(
        np.log(np.maximum(wanted, grid[1])), np.log(grid[1:]), np.log(_STRESSES[first][1:])
    )
    return np.where(wanted < grid[1], response.modulus_n_per_mm * wanted, np.exp(logs))


@dataclass(frozen=True)
class Part:
    """One phase of a 1-D repeat, seen along the pull.

    Attributes
    ----------
    fabric, law : which phase.
    share : share of the stitches' length in the repeat, by number of stitches.
    along_mm, across_mm : relaxed size of its stitch along the pull and across.
    """

    fabric: Fabric
    law: ConstitutiveLaw
    share: float
    along_mm: float
    across_mm: float


@dataclass(frozen=True)
class Series:
    """Parts in series along the pull, with the draw-in correction.

    Attributes
    ----------
    direction : of the pull.
    parts : phases, shares adding up to 1.
    relaxed_mm, across_mm : s_0 and t_0.
    gap_mm : s_c(0) - s_0 where the repeat folds, 0 where the composite is only scaled.
    unfolding_stress_n_per_mm : sigma_c.
    """

    direction: Direction
    parts: tuple[Part, ...]
    relaxed_mm: float
    across_mm: float
    gap_mm: float
    unfolding_stress_n_per_mm: float

    @property
    def flat_mm(self) -> float:
        """s_c(0), the flat composite's size at no force."""
        return flat_mm(self.parts)

    @property
    def _scale(self) -> float:
        return 1.0 if self.gap_mm else self.relaxed_mm / self.flat_mm

    def size_mm(self, stress: ArrayLike) -> Array:
        """Size of one stitch along the pull at stresses (N/mm of relaxed width)."""
        sigma = np.asarray(stress, dtype=float)
        size = np.zeros_like(sigma)
        for part in self.parts:
            strain = free_strains_at_stress(
                part.law, self.direction, sigma * self.across_mm / part.across_mm
            )
            size = size + part.share * part.along_mm * (1 + strain)
        fold = self.gap_mm * np.exp(-sigma / self.unfolding_stress_n_per_mm)
        result: Array = self._scale * size - fold
        return result

    def strain(self, stress: ArrayLike) -> Array:
        """Strain from the relaxed size at stresses (N/mm)."""
        strain: Array = self.size_mm(stress) / self.relaxed_mm - 1
        return strain

    def compliances(self) -> tuple[Array, float]:
        """d strain / d stress at no stress (mm/N): of each part, and of the fold."""
        parts = np.array(
            [
                part.share
                * part.along_mm
                * self.across_mm
                / (part.across_mm * part.law.modulus(self.direction))
                for part in self.parts
            ]
        )
        fold = self.gap_mm / self.unfolding_stress_n_per_mm
        return self._scale * parts / self.relaxed_mm, fold / self.relaxed_mm

    @property
    def modulus_n_per_mm(self) -> float:
        """Initial Young's modulus."""
        parts, fold = self.compliances()
        return 1.0 / (float(parts.sum()) + fold)


@dataclass(frozen=True)
class Parallel:
    """Parts side by side across the pull, strained alike (a welt pulled course-wise).

    Attributes
    ----------
    direction, parts : as in :class:`Series`; shares are by number of stitches across the pull.
    across_mm : mean size of a stitch across the pull that the force is shared over.
    """

    direction: Direction
    parts: tuple[Part, ...]
    across_mm: float

    def stiffnesses(self) -> Array:
        """Each part's contribution to the initial modulus, N/mm."""
        return np.array(
            [
                part.share * part.across_mm * part.law.modulus(self.direction) / self.across_mm
                for part in self.parts
            ]
        )

    @property
    def modulus_n_per_mm(self) -> float:
        """Initial Young's modulus."""
        return float(self.stiffnesses().sum())

    def strain(self, stress: ArrayLike) -> Array:
        """Strain at stresses (N/mm), by inverting the sum of the parts' stresses."""
        sigma = np.asarray(stress, dtype=float)
        part_stress = np.concatenate([[0.0], np.geomspace(1e-5, 1e3, 400)])
        ends = [free_strains_at_stress(p.law, self.direction, part_stress) for p in self.parts]
        grid = np.unique(np.concatenate(ends))
        grid = grid[grid <= min(float(end[-1]) for end in ends)]
        total = np.zeros_like(grid)
        for part, strain in zip(self.parts, ends, strict=True):
            carried = np.interp(grid, strain, part_stress)
            total += part.share * part.across_mm / self.across_mm * carried
        result: Array = np.interp(sigma, total, grid)
        return result


def flat_mm(parts: tuple[Part, ...]) -> float:
    """Mean relaxed size of a stitch along the pull, flat."""
    return sum(part.share * part.along_mm for part in parts)
