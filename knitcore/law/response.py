"""Stretch of a sheet under stress along one direction, the other free or held."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import free_strains_at_stress, held_strains_at_stress

MAX_STRESS_N_PER_MM = 10.0
"""Stress that locks any fabric; curves end here."""
_STRESSES = np.concatenate([[0.0], np.geomspace(1e-5, MAX_STRESS_N_PER_MM, 600)])


@dataclass(frozen=True, eq=False)
class Response:
    """Stretch of a sheet pulled along one direction.

    Attributes
    ----------
    modulus_n_per_mm : stress over strain at zero stress.
    strain : engineering strains at stresses (N/mm, at least 0); both arrays of one shape.
    """

    modulus_n_per_mm: float
    strain: Callable[[ArrayLike], Array]

    @cached_property
    def _points(self) -> tuple[Array, Array]:
        """Strains and the stresses that they take, both increasing from 0."""
        reached = np.maximum.accumulate(self.strain(_STRESSES))
        grid, first = np.unique(reached, return_index=True)
        return grid, _STRESSES[first]

    @property
    def lock_up_strain(self) -> float:
        """Strain under a stress that locks any fabric."""
        return float(self._points[0][-1])

    def stress(self, strain: ArrayLike) -> Array:
        """Stresses (N/mm) at strains of at least 0; 10 N/mm where that is not enough."""
        grid, stresses = self._points
        strains = np.asarray(strain, dtype=float)
        # in logarithms, so that the initial slope and the lock-up are equally accurate
        logs = np.interp(
            np.log(np.maximum(strains, grid[1])), np.log(grid[1:]), np.log(stresses[1:])
        )
        return np.where(strains < grid[1], self.modulus_n_per_mm * strains, np.exp(logs))


def free_response(law: ConstitutiveLaw, direction: Direction) -> Response:
    """Response of a law with its width free."""
    return Response(law.modulus(direction), partial(free_strains_at_stress, law, direction))


def held_response(law: ConstitutiveLaw, direction: Direction) -> Response:
    """Response of a law while the width is held."""
    stiffness = float(law.stiffness[direction.axis, direction.axis])
    return Response(stiffness, partial(held_strains_at_stress, law, direction))


def stiffened(response: Response, log_factor: Callable[[ArrayLike], Array]) -> Response:
    """A response that needs ``exp(log_factor)`` times the stress for every strain.

    ``log_factor`` is a function of the stress (N/mm) that changes slowly.
    """

    def strain(stress: ArrayLike) -> Array:
        return response.strain(stress * np.exp(-log_factor(stress)))

    return Response(float(np.exp(log_factor(0.0))) * response.modulus_n_per_mm, strain)


def response_through(stress_n_per_mm: Array, strains: Array) -> Response:
    """Through points: linear below the first, a power law between two, no stretch beyond the last.

    Parameters
    ----------
    stress_n_per_mm, strains : (points,), increasing and above 0.
    """
    first, modulus = float(stress_n_per_mm[0]), float(stress_n_per_mm[0] / strains[0])

    def strain(stress: ArrayLike) -> Array:
        sigma = np.asarray(stress, dtype=float)
        at = np.log(np.maximum(sigma, first))
        curved = np.exp(np.interp(at, np.log(stress_n_per_mm), np.log(strains)))
        return np.where(sigma < first, sigma / modulus, curved)

    return Response(modulus, strain)
