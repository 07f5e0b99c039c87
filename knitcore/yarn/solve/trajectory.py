"""Motion of a state of a cell along certified steps only."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from knitcore.base.arrays import Array
from knitcore.yarn.model.energy import CellEnergy, Slope, Terms
from knitcore.yarn.solve.topology import Clearance

SKIN = 0.9
"""Reach of a new list of near pairs beyond 2r, in radii."""
RENEW = 0.4
"""Least certain reach of the list beyond 2r, in radii, before it is renewed."""


@dataclass(frozen=True, eq=False)
class Configuration:
    """A state with its curve and the parts of its energy."""

    state: Array
    curve: Array
    terms: Terms


@dataclass(frozen=True, eq=False)
class CertifiedStep:
    """A straight path to another configuration on which no yarn passes through yarn.

    Attributes
    ----------
    to : its end.
    fraction : of the wanted step.
    approach_mm : most by which pairs of yarn that are not listed get nearer on it.
    """

    to: Configuration
    fraction: float
    approach_mm: float


class Trajectory:
    """A configuration on its way, with its list of near pairs.

    The list is kept over several steps: pairs not in it were farther apart than its reach when it
    was made, and have approached by no more than the steps taken since allow.

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
        self._stand(Configuration(state, curve, energy.value(state, curve, self._pairs)))

    @property
    def min_distance_mm(self) -> float:
        """Smallest distance between different stretches of yarn."""
        return self.clearance.min_distance_mm

    def slope(
        self, tension: Array, *, hessian: bool, sparse: bool = False, lengths: bool = True
    ) -> Slope:
        """Derivatives of the Lagrangian here."""
        here = self.here
        return self._energy.derivatives(
            here.state, here.curve, self._pairs, self._start, tension,
            hessian=hessian, sparse=sparse, lengths=lengths,
        )  # fmt: skip

    def certified(
        self, step: Array, mending: Callable[[Array], Array] | None = None
    ) -> CertifiedStep:
        """The part of a step that is certified.

        A straight step along inextensible yarn stretches it. ``mending`` gives the step that takes
        an excess of the lengths away; with it the path ends where the yarn has its length.
        """
        here = self.here
        if mending is not None:
            straight = self._allowed(here.state + step)[0]
            moved = here.state + straight * step
            excess = self._energy.excess(moved, self._energy.curve(moved))
            mended = mending(excess - (1.0 - straight) * here.terms.excess_mm)
            mended_step = self.certified(straight * step + mended)
            return replace(mended_step, fraction=straight * mended_step.fraction)
        state = here.state + step
        fraction, approach, curve = self._allowed(state)
        if fraction < 1.0:
            state = here.state + fraction * step
            curve = here.curve + fraction * (curve - here.curve)
        terms = self._energy.value(state, curve, self._pairs)
        return CertifiedStep(Configuration(state, curve, terms), fraction, fraction * approach)

    def _allowed(self, state: Array) -> tuple[float, float, Array]:
        """Fraction of the straight way to a state that is certified, the most by which unlisted
        pairs get nearer on the whole way, mm, and the curve at its end."""
        if state[-2] <= 0.0 or state[-1] <= 0.0:
            return 0.0, 0.0, self.here.curve
        curve = self._energy.curve(state)
        return *self.clearance.longest_step(state, curve, self._cap), curve

    def advance(self, step: CertifiedStep) -> None:
        """Take a certified step from here."""
        self._reach -= step.approach_mm
        if self._reach < (2.0 + RENEW) * self._radius:
            del self.clearance, self._pairs  # in a large sheet the list is most of the memory
            self._list(step.to.curve, step.to.state)
        self._stand(step.to)

    def _stand(self, at: Configuration) -> None:
        self.here = at
        self.clearance = Clearance(
            self._energy.cell, at.state, at.curve, self._pairs, self._reach,
            2.0 * self._radius,
        )  # fmt: skip

    def _list(self, curve: Array, state: Array) -> None:
        self._reach = (2.0 + SKIN) * self._radius
        self._pairs, self._start = self._energy.pairs(curve, state, self._reach)
