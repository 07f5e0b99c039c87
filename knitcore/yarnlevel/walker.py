"""A state on its way through the shapes of a cell: it moves along certified steps only."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.yarnlevel.energy import CellEnergy, Slope, Terms
from knitcore.yarnlevel.topology import Guard

Array = NDArray[np.float64]

SKIN = 0.9
"""How much farther than 2r the list of near pairs reaches when it is made, in radii."""
RENEW = 0.4
"""The list is made anew when it is only known to reach so far beyond 2r."""


@dataclass(frozen=True, eq=False)
class Place:
    """A state with its curve and the parts of its energy."""

    state: Array
    curve: Array
    terms: Terms


@dataclass(frozen=True, eq=False)
class Leg:
    """A certified way to another place.

    Attributes
    ----------
    to : where it ends.
    fraction : of the wanted step.
    approach_mm : most by which pairs of yarn that are not listed get nearer on it.
    """

    to: Place
    fraction: float
    approach_mm: float


class Walker:
    """Place on the way, with its list of near pairs.

    The list is kept over several steps: what is not in it was farther than its reach when it was
    made, and has come nearer by no more than the legs walked since allow.

    Parameters
    ----------
    energy : the energy of the cell.
    state : where to begin.
    pair_cap : longest change of the vector between near samples in one step, in radii.
    """

    def __init__(self, energy: CellEnergy, state: Array, pair_cap: float) -> None:
        self._energy = energy
        self._radius = energy.yarn.radius_mm
        self._cap = pair_cap * self._radius
        curve = energy.curve(state)
        self._list(curve, state)
        self._stand(Place(state, curve, energy.value(state, curve, self._pairs)))

    @property
    def min_distance_mm(self) -> float:
        """Smallest distance between different stretches of yarn."""
        return self.guard.min_distance_mm

    def slope(self, tension: Array, *, hessian: bool) -> Slope:
        """Derivatives of the Lagrangian at this place."""
        here = self.place
        return self._energy.derivatives(
            here.state, here.curve, self._pairs, self._start, tension, hessian=hessian
        )

    def leg(self, step: Array) -> Leg:
        """As much of a step as is certified."""
        here = self.place
        state = here.state + step
        if state[-2] <= 0.0 or state[-1] <= 0.0:
            return Leg(here, 0.0, 0.0)
        curve = self._energy.curve(state)
        fraction = self.guard.longest_step(state, curve, self._cap)
        approach = fraction * self.guard.approach_mm(state, curve)
        if fraction < 1.0:
            state = here.state + fraction * step
            curve = here.curve + fraction * (curve - here.curve)
        terms = self._energy.value(state, curve, self._pairs)
        return Leg(Place(state, curve, terms), fraction, approach)

    def go(self, leg: Leg) -> None:
        """Walk a leg from here."""
        self._reach -= leg.approach_mm
        if self._reach < (2.0 + RENEW) * self._radius:
            self._list(leg.to.curve, leg.to.state)
        self._stand(leg.to)

    def _stand(self, place: Place) -> None:
        self.place = place
        self.guard = Guard(
            self._energy.cell, place.state, place.curve, self._pairs, self._reach,
            2.0 * self._radius,
        )  # fmt: skip

    def _list(self, curve: Array, state: Array) -> None:
        self._reach = (2.0 + SKIN) * self._radius
        self._pairs, self._start = self._energy.pairs(curve, state, self._reach)
