"""Steps on which yarn cannot pass through yarn, and the way of a state along them.

Between two states every point moves along a straight line. Consecutive samples of a course are at
most a spacing h apart at either end of the step, hence also in between. Where two stretches of
yarn meet, some sample of one lies within 0.75 h of some sample of the other; so if the vector
between any two samples changes by less than its length minus 0.75 h, nothing meets on the way.
Pairs beyond the reach of the list are covered by a bound: their distance shrinks by no more than
the strain of the cell times itself plus twice the largest displacement. A step that passes keeps
the topology. Stretches of one yarn nearer than 2.1 r along it are exempt: they would need a kink
to cross.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.threads import on_halves
from knitcore.yarn.kernels.structures import Pairs
from knitcore.yarn.model.cell import YarnCell
from knitcore.yarn.model.energy import PAIRS_TO_SHARE, CellEnergy, Slope, Terms
from knitcore.yarn.model.neighbours import extremes, pair_distances, part_apart

CROSSING = 0.75
"""Two polylines that meet have samples within h / sqrt(2) of each other; the rest is for the bend
of the yarn between its samples."""
SAFETY = 0.95
"""Part of the free distance that a step may use."""
SKIN = 0.9
"""Reach of a new list of near pairs beyond 2r, in radii."""
RENEW = 0.4
"""Least certain reach of the list beyond 2r, in radii, before it is renewed."""
_SHORTER = 2.0**-20
"""Parts of a step in which it is shortened where places are rounded."""


@dataclass(frozen=True, eq=False)
class Clearance:
    """The distances at a state, and the step they allow.

    Parameters
    ----------
    cell : the cell.
    state, curve : where the step begins.
    pairs : all pairs of samples nearer than ``reach_mm``.
    reach_mm : reach of that list.
    touch_mm : 2r; unlisted pairs must stay beyond it, so that the energy of the step is complete.
    """

    cell: YarnCell
    state: Array
    curve: Array
    pairs: Pairs
    reach_mm: float
    touch_mm: float

    @property
    def min_distance_mm(self) -> float:
        """Smallest distance between samples of different stretches of yarn."""
        least, _ = self._extremes(self.curve, self.state[-2:])
        return min(least, self.reach_mm)

    @property
    def distances_mm(self) -> Array:
        """Distances of the listed pairs."""
        course, wale = self.state[-2:]
        shape = self.cell.rows, self.cell.wales
        distances = pair_distances(self.curve, (course, wale), self.cell.place, shape, self.pairs)
        return np.asarray(distances)

    def longest_step(self, state: Array, curve: Array, pair_cap_mm: float) -> tuple[float, float]:
        """Fraction (at most 1) of the way to another state that is certified, and the most by
        which an unlisted pair gets nearer on the whole way, mm.

        ``pair_cap_mm`` also bounds the change of the vector between any listed pair.
        """
        approach = self._approach_mm(state, curve)
        allowed = min(1.0, (self.reach_mm - self.touch_mm) / max(approach, 1e-300))
        if not len(self.pairs):
            return allowed, approach
        moved, by = curve - self.curve, state[-2:] - self.state[-2:]
        _, shift = self._extremes(moved, by)
        allowed = min(allowed, pair_cap_mm / max(shift, 1e-300))
        used = CROSSING * self._spacing(curve, allowed), SAFETY
        curves, cells = (self.curve, moved), (tuple(self.state[-2:]), tuple(by))
        place, shape = self.cell.place, (self.cell.rows, self.cell.wales)
        parts = on_halves(
            lambda of: part_apart(curves, cells, place, shape, of, used, shift, allowed),
            self.pairs, PAIRS_TO_SHARE,
        )  # fmt: skip
        return float(min(parts)), approach

    def _approach_mm(self, state: Array, curve: Array) -> float:
        """Most by which an unlisted pair gets nearer on the way to another state."""
        old, new = self.state[-2:], state[-2:]
        strain = float(np.abs(new / old - 1.0).max())
        moved = curve[:, 0] - self.curve[:, 0]
        moved = moved - moved.mean(axis=0) * np.array([1.0, 1.0, 0.0])
        # the rest of the affine change of the cell: the same in every image
        drift = (new - old) / old
        moved[:, 0] -= drift[0] * (self.curve[:, 0, 0] - self.curve[:, 0, 0].mean())
        moved[:, 1] -= drift[1] * (self.curve[:, 0, 1] - self.curve[:, 0, 1].mean())
        far = 2.0 * float(np.sqrt(np.einsum("im,im->i", moved, moved).max()))
        return far + strain * self.reach_mm

    def _extremes(self, curve: Array, size: Array) -> tuple[float, float]:
        """Least and greatest length of the vectors of the listed pairs, mm.

        There may be millions: their lengths are not kept.
        """
        shape, sizes = (self.cell.rows, self.cell.wales), (size[0], size[1])
        parts = on_halves(
            lambda of: extremes(curve, sizes, self.cell.place, shape, of),
            self.pairs, PAIRS_TO_SHARE,
        )  # fmt: skip
        least, greatest = zip(*parts, strict=True)
        return min(least), max(greatest)

    def _spacing(self, curve: Array, fraction: float) -> float:
        """Largest distance of consecutive samples up to a fraction of the step, mm.

        Positions are linear in the fraction, so the spacing is convex in it. Speeds between the
        samples hardly exceed those at the samples; five per cent are added for that.
        """
        here, there = (
            float(np.sqrt(np.einsum("im,im->i", c[:, 1], c[:, 1]).max()))
            for c in (self.curve, curve)
        )
        largest = max(here, (1.0 - fraction) * here + fraction * there)
        return 1.05 * largest / self.cell.grid.samples


def clearance_at(energy: CellEnergy, state: Array, reach_radii: float = 2.0) -> Clearance:
    """The clearance at a state of a cell, its pairs listed up to ``reach_radii``."""
    curve, reach = energy.curve(state), reach_radii * energy.yarn.radius_mm
    pairs, _ = energy.pairs(curve, state, reach)
    return Clearance(energy.cell, state, curve, pairs, reach, 2.0 * energy.yarn.radius_mm)


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
    rounded_mm : step to which the unknowns are rounded where a step ends; 0 where they are not.
    """

    def __init__(
        self, energy: CellEnergy, state: Array, pair_cap: float, rounded_mm: float = 0.0
    ) -> None:
        self._energy = energy
        self._rounded_mm = rounded_mm
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
        if self._rounded_mm:
            state = rounded(state, self._rounded_mm)
            step = state - here.state
        fraction, approach, curve = self._allowed(state)
        if fraction < 1.0:
            if self._rounded_mm:
                fraction -= fraction % _SHORTER
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


def rounded(values: Array | float, step: float) -> Array:
    """The nearest multiples of a step."""
    return np.asarray(step * np.round(np.asarray(values) / step))
