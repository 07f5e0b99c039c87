"""Phases in series or in parallel: the responses that ribs and welts are made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from knitcore.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import free_strains_at_stress

Array = NDArray[np.float64]


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
