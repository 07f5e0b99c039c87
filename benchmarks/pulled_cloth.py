"""Cloth that is known from pulls at held widths, and a clamped strip of it: no law in between."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator, PPoly
from scipy.sparse.linalg import splu
from skfem import Basis, ElementQuad2, ElementVector, MeshQuad

from knitcore.arrays import Array
from knitcore.errors import ConvergenceError
from knitcore.fabric import Direction
from knitcore.yarnlevel.friction import RubbedCell
from knitcore.yarnlevel.hysteresis import Leg, pull
from knitcore.yarnlevel.splines import RelaxedRepeat

SHARES = (0.0, 0.35, 0.7, 1.0, 1.15)
"""Of the narrowing of the free pull, at which the cloth is pulled."""
BETWEEN = 5
"""Places between two of them at which stresses are interpolated monotonically first."""
TOP_N_PER_MM = 0.6
"""Largest stress of these pulls."""
CELLS = 6
"""Elements along each side of a quarter strip."""
GRADING = 1.5
"""Exponent with which elements grow smaller towards clamp and edge."""
BALANCED_N = 1e-7
MAX_NEWTON_STEPS, MAX_HALVINGS = 30, 5
_NO_NARROWING = 1e-7


class Curve:
    """Piecewise polynomials, and straight lines beyond their ends."""

    def __init__(self, inside: PPoly) -> None:
        self._value, self._slope = inside, inside.derivative()
        self._ends = inside.x[0], inside.x[-1]

    @property
    def end(self) -> float:
        """Where the straight line begins."""
        return float(self._ends[1])

    def __call__(self, x: Array) -> tuple[Array, Array]:
        """Values and slopes; the curve's own axes come last."""
        inside = np.clip(x, *self._ends)
        value, slope = self._value(inside), self._slope(inside)
        beyond = (x - inside).reshape(x.shape + (1,) * (value.ndim - x.ndim))
        return value + slope * beyond, slope


@dataclass(frozen=True, eq=False)
class PulledCloth:
    """Stresses of cloth by its strains along and across a pull.

    Near rest they are linear in both strains. What the pulls show beyond that is interpolated by
    the share of the free narrowing, and goes on in straight lines beyond them.

    Parameters
    ----------
    at_rest : (2, 2) stiffness near rest, N/mm.
    narrowing : strain across a free pull, by the strain along it.
    stress : (shares, 2), N/mm, along and across, beyond the linear one, by the strain along.
    weights : (shares,), by the share.
    shear_modulus : N/mm, constant.
    """

    at_rest: Array
    narrowing: Curve
    stress: Curve
    weights: Curve
    shear_modulus: float

    @classmethod
    def of_stresses(
        cls, strain: Array, across: Array, shares: Array, stress: Array, shear_modulus: float
    ) -> PulledCloth:
        """From strains (n,) along and across the free pull, and stresses (n, shares, 2)."""
        narrowing = Curve(PchipInterpolator(strain, across))
        begin = np.zeros(1)
        paths = np.column_stack([np.ones(len(shares)), shares * narrowing(begin)[1]])
        slope = Curve(PchipInterpolator(strain, stress))(begin)[1][0]
        at_rest = np.linalg.lstsq(paths, slope, rcond=None)[0].T
        strains = np.stack(np.broadcast_arrays(strain[:, None], across[:, None] * shares), axis=2)
        beyond = stress - strains @ at_rest.T
        # a spline through the pulls themselves would swing where one of them locks
        places = np.arange(BETWEEN * (len(shares) - 1) + 1) / BETWEEN
        between = np.interp(places, np.arange(len(shares)), shares)
        beyond = PchipInterpolator(shares, beyond, axis=1)(between)
        weights = Curve(CubicSpline(between, np.eye(len(between))))
        return cls(
            at_rest, narrowing, Curve(PchipInterpolator(strain, beyond)), weights, shear_modulus
        )

    @classmethod
    def of_yarn(
        cls, begin: RelaxedRepeat | RubbedCell, along: Direction, friction: float,
        shear_modulus: float,
        *, max_strain: float, points: int, shares: tuple[float, ...] = SHARES,
    ) -> PulledCloth:  # fmt: skip
        """From pulls of a relaxed repeat, or of a state that other pulls have left.

        Where a pull locks it goes on in a straight line. Where its stress falls the yarn snaps, all
        stitches at once in the repeat; in cloth they snap one after the other while the stress
        stays, so the pull goes straight to where it has that stress again.

        Raises
        ------
        ConvergenceError
            If the yarn locks in the first step.
        """
        free = pull(
            begin, along, max_strain, friction, points=points, max_stress_n_per_mm=TOP_N_PER_MM
        )
        kept = _rising(free)
        if kept.sum() < 3:
            raise ConvergenceError("The yarn locks in the first step.")
        strain, across = free.strain[kept], free.transverse_strain[kept]
        narrowing = PchipInterpolator(strain, across)
        longest = float(strain[-1])

        def narrowed(share: float) -> Callable[[float], float]:
            return lambda along: share * float(narrowing(min(along, longest)))

        stress = np.empty((len(strain), len(shares), 2))
        for i, share in enumerate(shares):
            leg = free if share == 1.0 else pull(
                begin, along, longest, friction, points=len(free.strain),
                max_stress_n_per_mm=TOP_N_PER_MM, across=narrowed(share),
            )  # fmt: skip
            both = np.column_stack([leg.stress_n_per_mm, leg.transverse_stress_n_per_mm])
            own = _rising(leg)
            stress[:, i], _ = Curve(PchipInterpolator(leg.strain[own], both[own]))(strain)
        return cls.of_stresses(strain, across, np.array(shares), stress, shear_modulus)

    @property
    def longest(self) -> float:
        """Largest strain of the free pull."""
        return self.narrowing.end

    def at(self, along: Array, across: Array) -> tuple[Array, Array]:
        """Stresses (n, 2) and their derivatives (n, 2, 2) by the strains along and across (n,)."""
        free, change = self.narrowing(along)
        free = np.where(np.abs(free) < _NO_NARROWING, -_NO_NARROWING, free)
        share = across / free
        weight, more = self.weights(share)
        stress, slope = self.stress(along)
        by_share = np.einsum("nk,nki->ni", more, stress)
        by_along = np.einsum("nk,nki->ni", weight, slope)
        by_along -= by_share * (share * change / free)[:, None]
        beyond = np.einsum("nk,nki->ni", weight, stress)
        tangent = np.stack([by_along, by_share / free[:, None]], axis=2)
        linear = np.column_stack([along, across]) @ self.at_rest.T
        return linear + beyond, self.at_rest + tangent

    def respond(self, fibres: Array) -> tuple[Array, Array]:
        """Stresses (n, 4) and derivatives (n, 4, 4) by the images (n, 4) of the unit vectors along
        and across the pull; in shear the stress is proportional to the change of their angle.
        """
        a, b = fibres[:, :2], fibres[:, 2:]
        n = len(fibres)
        slopes, bends = np.zeros((n, 3, 4)), np.zeros((n, 3, 4, 4))
        for i, (fibre, sign) in enumerate(((a, 1.0), (b, -1.0))):
            own = slice(2 * i, 2 * i + 2)
            length = np.hypot(*fibre.T)[:, None]
            unit = fibre / length
            normal = np.column_stack([-unit[:, 1], unit[:, 0]])
            slopes[:, i, own] = unit
            slopes[:, 2, own] = sign * normal / length
            bends[:, i, own, own] = _product(normal, normal) / length[:, None]
            turned = _product(unit, normal) + _product(normal, unit)
            bends[:, 2, own, own] = -sign * turned / length[:, None] ** 2
        strain = np.hypot(*a.T) - 1.0, np.hypot(*b.T) - 1.0
        angle = np.arctan2(np.sum(a * b, axis=1), a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
        inner, stiffness = np.empty((n, 3)), np.zeros((n, 3, 3))
        inner[:, :2], stiffness[:, :2, :2] = self.at(*strain)
        inner[:, 2], stiffness[:, 2, 2] = self.shear_modulus * angle, self.shear_modulus
        tangent = np.swapaxes(slopes, 1, 2) @ stiffness @ slopes
        tangent += np.einsum("ni,nijk->njk", inner, bends)
        return np.einsum("ni,nij->nj", inner, slopes), tangent


def _rising(leg: Leg) -> NDArray[np.bool_]:
    """Where the stress is larger than anywhere before."""
    stress = leg.stress_n_per_mm
    return np.append(True, stress[1:] > np.maximum.accumulate(stress)[:-1])


def _product(u: Array, v: Array) -> Array:
    return np.asarray(u[:, :, None] * v[:, None, :])


class Reading(NamedTuple):
    """A balanced strip.

    Attributes
    ----------
    strain : clamp to clamp.
    stress_n_per_mm : force over the width at rest.
    waist : strain across, half-way between the clamps.
    """

    strain: float
    stress_n_per_mm: float
    waist: float


class Strip:
    """A quarter of a strip of cloth in quadratic elements, pulled along x.

    Parameters
    ----------
    cloth : of it.
    length_mm, width_mm : of the whole strip, at rest.
    across_mm : distance at rest of the points between which the waist is read; None for the edges.
    cells : elements along each side.
    clamped : whether the ends are gripped, or slide along their clamps.
    """

    def __init__(
        self, cloth: PulledCloth, length_mm: float, width_mm: float,
        *, across_mm: float | None = None, cells: int = CELLS, clamped: bool = True,
    ) -> None:  # fmt: skip
        self.cloth, self.width_mm = cloth, width_mm
        self.read_mm = 0.5 * (across_mm or width_mm)
        lines = 1.0 - (1.0 - np.linspace(0.0, 1.0, cells + 1)) ** GRADING
        mesh = MeshQuad.init_tensor(0.5 * length_mm * lines, 0.5 * width_mm * lines)
        basis = Basis(mesh, ElementVector(ElementQuad2()), intorder=4)
        self._gradient, self._weight = _gradient(basis), basis.dx.ravel()
        clamp, middle, centre = (
            basis.get_dofs(lambda at, axis=axis, line=line: np.isclose(at[axis], line))
            for axis, line in ((0, 0.5 * length_mm), (0, 0.0), (1, 0.0))
        )
        self._clamp = clamp.all(["u^1"])
        self._half_length = 0.5 * length_mm
        held = [self._clamp, middle.all(["u^1"]), centre.all(["u^2"])]
        if clamped:
            held.append(clamp.all(["u^2"]))
        self._free = np.setdiff1d(np.arange(basis.N), np.concatenate(held))
        places = middle.all(["u^2"])
        self._middle = places[np.argsort(basis.doflocs[1, places])]
        self._middle_mm = basis.doflocs[1, self._middle]

    def pull(self, strains: Array) -> Iterator[Reading]:
        """Equilibria at increasing strains, as far as they are found."""
        state, reached = np.zeros(self._gradient.shape[1]), 0.0
        for strain in map(float, strains):
            step = strain - reached
            least = step / 2**MAX_HALVINGS
            while reached < strain:
                goal = min(reached + step, strain)
                found = self._balanced(self._moved(state, goal - reached))
                if found is not None:
                    state, reached = found, goal
                elif step > least:
                    step /= 2.0
                else:
                    return
            stress = 2.0 * self._force(state)[0][self._clamp].sum() / self.width_mm
            waist = np.interp(self.read_mm, self._middle_mm, state[self._middle]) / self.read_mm
            yield Reading(strain, float(stress), float(waist))

    def _balanced(self, state: Array) -> Array | None:
        """The balanced state near another one, by Newton's method; None if it is not found."""
        force, tangent = self._force(state)
        for _ in range(MAX_NEWTON_STEPS):
            size = float(np.linalg.norm(force[self._free]))
            if size < BALANCED_N:
                return state
            step = self._solved(tangent, force)
            share = 1.0
            while share > 1e-3:
                trial = state + share * step
                there = self._force(trial)
                if np.linalg.norm(there[0][self._free]) < (1.0 - 0.1 * share) * size:
                    break
                share /= 2.0
            else:
                return None
            state, (force, tangent) = trial, there
        return None

    def _moved(self, state: Array, strain: float) -> Array:
        """The clamp moved by a strain, the cloth along the tangent."""
        moved = np.zeros(len(state))
        moved[self._clamp] = strain * self._half_length
        _, tangent = self._force(state)
        return np.asarray(state + moved + self._solved(tangent, tangent @ moved))

    def _solved(self, tangent: Any, force: Array) -> Array:
        """The displacements that take a force away."""
        step = np.zeros(len(force))
        free = self._free
        step[free] = -splu(tangent[free][:, free].tocsc()).solve(force[free])
        return step

    def _force(self, state: Array) -> tuple[Array, Any]:
        """Forces (unknowns,), N, and their derivatives."""
        fibres = (self._gradient @ state).reshape(-1, 4) + np.array([1.0, 0.0, 0.0, 1.0])
        stress, tangent = self.cloth.respond(fibres)
        n = len(fibres)
        blocks = sp.bsr_array(
            (tangent * self._weight[:, None, None], np.arange(n), np.arange(n + 1))
        )
        turned = self._gradient.T
        force = turned @ (stress * self._weight[:, None]).ravel()
        return force, (turned @ blocks @ self._gradient).tocsr()


def _gradient(basis: Any) -> sp.csr_array:
    """From the unknowns to the columns of their gradient at each point of the quadrature."""
    local = np.array([function[0].grad for function in basis.basis])  # unknown, i, j, cell, point
    values = local.transpose(0, 3, 4, 2, 1)
    rows = np.broadcast_to(np.arange(values[0].size).reshape(values[0].shape), values.shape)
    columns = np.broadcast_to(basis.element_dofs[:, :, None, None, None], values.shape)
    shape = (values[0].size, basis.N)
    return sp.csr_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=shape)
