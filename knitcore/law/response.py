"""Stretch of a sheet under stress along one direction, the other free or held.

Every response, whatever its source, has a modulus and gives the strain at a stress.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from knitcore.fabric import Direction
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import (
    free_strains_at_stress,
    free_transverse_strains,
    held_strains_at_stress,
)

Array = NDArray[np.float64]


class Response(Protocol):
    """Stretch of a sheet pulled along one direction."""

    @property
    def modulus_n_per_mm(self) -> float:
        """Stress over strain at zero stress."""
        ...

    def strain(self, stress: ArrayLike) -> Array:
        """Engineering strains at stresses (N/mm, at least 0); both arrays of one shape."""
        ...


@dataclass(frozen=True)
class LawResponse:
    """The response of a constitutive law, free across the pull."""

    law: ConstitutiveLaw
    direction: Direction

    @property
    def modulus_n_per_mm(self) -> float:
        """Young's modulus of the law."""
        return self.law.modulus(self.direction)

    def strain(self, stress: ArrayLike) -> Array:
        """Strains at stresses (N/mm)."""
        return free_strains_at_stress(self.law, self.direction, stress)

    def across(self, stress: ArrayLike) -> Array:
        """Strains across the pull at stresses (N/mm)."""
        return free_transverse_strains(self.law, self.direction, self.strain(stress))


@dataclass(frozen=True)
class HeldLawResponse:
    """The response of a constitutive law whose width is held."""

    law: ConstitutiveLaw
    direction: Direction

    @property
    def modulus_n_per_mm(self) -> float:
        """Stiffness of the law."""
        return float(self.law.stiffness[self.direction.axis, self.direction.axis])

    def strain(self, stress: ArrayLike) -> Array:
        """Strains at stresses (N/mm)."""
        return held_strains_at_stress(self.law, self.direction, stress)


@dataclass(frozen=True)
class Stiffened:
    """A response that needs ``exp(log_factor)`` times the stress for every strain.

    ``log_factor`` is a function of the stress (N/mm) that changes slowly.
    """

    response: Response
    log_factor: Callable[[ArrayLike], Array]

    @property
    def modulus_n_per_mm(self) -> float:
        """Young's modulus."""
        return float(np.exp(self.log_factor(0.0))) * self.response.modulus_n_per_mm

    def strain(self, stress: ArrayLike) -> Array:
        """Strains at stresses (N/mm)."""
        return self.response.strain(stress * np.exp(-self.log_factor(stress)))


_STRESSES = np.concatenate([[0.0], np.geomspace(1e-5, 10.0, 600)])


def stress_at_strain(response: Response, strain: ArrayLike) -> Array:
    """Stresses (N/mm) at strains of at least 0; 10 N/mm where that is not enough."""
    reached = np.maximum.accumulate(response.strain(_STRESSES))
    grid, first = np.unique(reached, return_index=True)
    wanted = np.asarray(strain, dtype=float)
    # in logarithms, so that the initial slope and the lock-up are equally accurate
    logs = np.interp(
        np.log(np.maximum(wanted, grid[1])), np.log(grid[1:]), np.log(_STRESSES[first][1:])
    )
    return np.where(wanted < grid[1], response.modulus_n_per_mm * wanted, np.exp(logs))
