"""Minimisation of a stitch's energy at a given length of yarn (SLSQP with exact gradients).

The unknowns are made dimensionless with the loop length and the energy with B over it, so that one
tolerance serves thread and rope.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.base.threads import one_blas_thread
from knitcore.yarn.paper.bezier_shape import PARAMETERS, unknown_names
from knitcore.yarn.paper.bezier_stitch import Evaluation, Stitch
from knitcore.yarn.paper.certificate import is_certified

MAX_TWIST = float(np.arccos(0.9))
"""Largest twist of a crossover's frame between its ends (authors' constraint cos >= 0.9)."""

_DISTINCT = np.array([0, 1, 2, 3, 7])
# The connector between courses, c11, gets short in garter and then turns back on itself in a cusp
# that no quadrature sees, unless it is made to run evenly: with its length l, its speed at the ends
# alpha >= l/4 and in the middle 4.9 l >= 2 alpha + 10 beta.
_EVEN_CURVE = np.array([1, 1])
_EVEN_BY_LENGTH = np.array([-0.25, 4.9])
_HALF_PI = float(np.pi / 2)
_LENGTHS = ("centre_x", "centre_z", "half_length", "cell_course", "cell_wale")
_BOXES = {  # in loop lengths and radians; wide, to stop a line search from leaving the stitch
    "centre_x": (-0.6, 0.6),
    "centre_z": (-0.6, 0.6),
    "half_length": (0.01, 0.3),
    "tilt": (0.02, 1.55),
    "polar": (0.02, _HALF_PI),
    "azimuth": (0.0, _HALF_PI),
    "alpha": (0.003, 0.6),
    "beta": (0.0, 0.3),
    "kappa": (-60.0, 60.0),
    "cell_course": (0.03, 0.95),
    "cell_wale": (0.02, 0.95),
}
_ENERGY = 60.0
"""Usual energy of a stitch, in B/L (the paper's have 36 to 99)."""
_HIGH = 5.0
"""Energy, in that unit, above which its logarithm is minimised."""
_TYPICAL = {1.0: 0.1, 0.0: 1.0, -1.0: 10.0}
"""Usual size of an unknown by its power of length, in loop lengths."""
_TYPICAL_SPEED = 0.4
"""Usual size of the speeds alpha at the ends of curves, which hardly move the yarn."""
_REACH = 0.3
"""Largest change in one round of the optimiser, in those sizes."""
_ROUNDS, _NEAR_ROUNDS = 8, 6


@dataclass(frozen=True, eq=False)
class HeldLengths:
    """Constraints of a minimisation besides the loop length.

    Parameters
    ----------
    cell_course_mm, cell_wale_mm : a size of the cell, or None where it is free.
    segment_floor_mm : no curve gets shorter than this; without it the curves of garter between two
        courses collapse to a point.
    held : rows of weights over the eight curves' lengths, shape (rows, 8), and
    held_mm : the values those weighted lengths keep (slide quenching).
    """

    cell_course_mm: float | None = None
    cell_wale_mm: float | None = None
    segment_floor_mm: float = 0.15
    held: Array | None = None
    held_mm: Array | None = None


@dataclass(frozen=True, eq=False)
class BezierMinimum:
    """End of a minimisation.

    Parameters
    ----------
    unknowns : the stitch's unknowns (mm, radians, 1/mm).
    evaluation : energy and gradients there.
    force_n : ∂E/∂(cell_course, cell_wale) at constant constraints, N: zero along a free size.
    residual : largest component of the dimensionless Lagrangian gradient of the free unknowns.
    evaluations : evaluations of the energy with its gradient.
    converged : whether the optimiser met its tolerance with all constraints satisfied.
    certified : whether the yarn can go there from the start without meeting itself.
    """

    unknowns: Array
    evaluation: Evaluation
    force_n: Array
    residual: float
    evaluations: int
    converged: bool
    certified: bool

    @property
    def energy_n_mm(self) -> float:
        """Energy of the stitch, N·mm."""
        return self.evaluation.energy_n_mm


def length_powers(stitch: Stitch) -> Array:
    """Power of length in each unknown's dimension: 1, 0 (angles) or -1 (curvatures)."""
    powers = []
    for name in unknown_names(stitch.fabric):
        last = name.rsplit("_", maxsplit=1)[-1]
        is_length = name in _LENGTHS or last in ("alpha", "beta")
        powers.append(1.0 if is_length else (-1.0 if last == "kappa" else 0.0))
    return np.array(powers)


def minimise_bezier(
    stitch: Stitch,
    start: Array,
    loop_length_mm: float,
    constraints: HeldLengths,
    *,
    tolerance: float = 1e-10,
    max_iterations: int = 400,
    near: bool = False,
) -> BezierMinimum:
    """Lowest energy near a start.

    Parameters
    ----------
    stitch : the stitch.
    start : unknowns (mm, radians, 1/mm), shape (stitch.size,).
    loop_length_mm : length of yarn in the stitch, mm.
    constraints : besides the loop length.
    tolerance : of the energy, in units of 60 B over the loop length.
    max_iterations : of the optimiser, for each of its rounds.
    near : whether the start is an equilibrium of a neighbouring state; then give up early.
    """
    problem = _Problem(stitch, loop_length_mm, constraints)
    lower, upper = problem.bounds()
    x = np.clip(start / problem.scale, lower, upper)
    rules: Any = [
        {"type": "eq", "fun": problem.equal, "jac": problem.equal_jacobian},
        {"type": "ineq", "fun": problem.above, "jac": problem.above_jacobian},
    ]
    converged, energy = False, np.inf
    iterates = [start]
    for _ in range(_NEAR_ROUNDS if near else _ROUNDS):
        # A box around the start keeps a line search from pulling yarn through yarn.
        reach = _REACH * problem.typical
        near_lower, near_upper = np.maximum(lower, x - reach), np.minimum(upper, x + reach)
        with one_blas_thread():
            result = scipy.optimize.minimize(
                problem.energy,
                x,
                jac=problem.gradient,
                method="SLSQP",
                bounds=list(zip(near_lower, near_upper, strict=True)),
                constraints=rules,
                options={"ftol": tolerance, "maxiter": max_iterations},
                callback=lambda iterate: iterates.append(iterate * problem.scale),
            )
        if not np.all(np.isfinite(result.x)):
            break
        x = np.clip(result.x, near_lower, near_upper)
        slack = 1e-6 * reach
        stopped = (x < near_lower + slack) & (near_lower > lower)
        stopped |= (x > near_upper - slack) & (near_upper < upper)
        converged = bool(result.status == 0) and not np.any(stopped)
        before, energy = energy, problem.energy(x)
        stuck = result.status != 0 and energy > before - 1e-3
        if converged or stuck or (near and energy > _HIGH):
            break
    iterates.append(x * problem.scale)
    # any path without contact will do: the straight one, else the one that was taken
    certified = is_certified(stitch, start, iterates[-1]) or all(
        is_certified(stitch, *leg) for leg in pairwise(iterates)
    )
    return problem.report(x, converged, certified)


class _Problem:
    """A stitch in dimensionless unknowns, with the last evaluation kept."""

    def __init__(self, stitch: Stitch, loop_length_mm: float, constraints: HeldLengths) -> None:
        self.stitch = stitch
        self.loop_length_mm = loop_length_mm
        self.constraints = constraints
        self.scale = loop_length_mm ** length_powers(stitch)
        self.typical = np.array([_TYPICAL[power] for power in length_powers(stitch)])
        speeds = [name.endswith("alpha") for name in unknown_names(stitch.fabric)]
        self.typical[speeds] = _TYPICAL_SPEED
        self.energy_scale = _ENERGY * stitch.yarn.bending_modulus_n_mm2 / loop_length_mm
        self.evaluations = 0
        self._at: bytes = b""
        self._last: Evaluation | None = None
        alpha, beta = (stitch.ties[PARAMETERS.index(f"c11_{name}")] for name in ("alpha", "beta"))
        self.even = np.array([alpha, -2.0 * alpha - 10.0 * beta])  # rows that keep c11 even
        rows, values = [np.ones(8)], [loop_length_mm]
        if constraints.held is not None and constraints.held_mm is not None:
            rows.extend(constraints.held)
            values.extend(constraints.held_mm)
        self.rows, self.values = np.array(rows), np.array(values)

    def bounds(self) -> tuple[Array, Array]:
        lower = np.full(self.stitch.size, -np.inf)
        upper = np.full(self.stitch.size, np.inf)
        for i, name in enumerate(unknown_names(self.stitch.fabric)):
            box = _BOXES.get(name) or _BOXES.get(name.rsplit("_", maxsplit=1)[-1])
            if box is not None:
                lower[i], upper[i] = box
            if name == "twist":
                lower[i], upper[i] = -MAX_TWIST, MAX_TWIST
        fixed = (self.constraints.cell_course_mm, self.constraints.cell_wale_mm)
        for i, size in zip((-2, -1), fixed, strict=True):
            if size is not None:
                lower[i] = upper[i] = size / self.loop_length_mm
        return lower, upper

    def evaluate(self, x: Array) -> Evaluation:
        key = x.tobytes()
        if self._last is None or key != self._at:
            self._last = self.stitch.evaluate(x * self.scale)
            self._at = key
            self.evaluations += 1
        return self._last

    def energy(self, x: Array) -> float:
        """Energy over 60 B/L; far above a stitch's energy its logarithm, to limit steps."""
        energy = self.evaluate(x).energy_n_mm / self.energy_scale
        if not np.isfinite(energy):
            return 1e6
        return energy if energy < _HIGH else _HIGH * (1.0 + np.log(energy / _HIGH))

    def gradient(self, x: Array) -> Array:
        evaluation = self.evaluate(x)
        gradient = evaluation.gradient * self.scale / self.energy_scale
        high = evaluation.energy_n_mm / self.energy_scale / _HIGH
        return np.nan_to_num(gradient / max(high, 1.0), nan=0.0, posinf=0.0, neginf=0.0)

    def equal(self, x: Array) -> Array:
        held: Array = self.rows @ self.evaluate(x).lengths_mm - self.values
        return held / self.loop_length_mm

    def equal_jacobian(self, x: Array) -> Array:
        jacobian: Array = self.rows @ self.evaluate(x).length_gradient
        return jacobian * self.scale / self.loop_length_mm

    def above(self, x: Array) -> Array:
        lengths = self.evaluate(x).lengths_mm
        floors = lengths[_DISTINCT] - self.constraints.segment_floor_mm
        even = _EVEN_BY_LENGTH * lengths[_EVEN_CURVE] + self.even @ (x * self.scale)
        return np.concatenate([floors, even]) / self.loop_length_mm

    def above_jacobian(self, x: Array) -> Array:
        lengths = self.evaluate(x).length_gradient
        even = _EVEN_BY_LENGTH[:, None] * lengths[_EVEN_CURVE] + self.even
        return np.vstack([lengths[_DISTINCT], even]) * self.scale / self.loop_length_mm

    def report(self, x: Array, converged: bool, certified: bool) -> BezierMinimum:
        """Multipliers by least squares give the force along a held size of the cell."""
        lower, upper = self.bounds()
        at_bound = (x - lower < 1e-9) | (upper - x < 1e-9)
        inner = ~at_bound
        inner[-2:] = [
            self.constraints.cell_course_mm is None,
            self.constraints.cell_wale_mm is None,
        ]
        normals = self.equal_jacobian(x)
        active = self.above(x) < 1e-7
        if np.any(active):
            normals = np.vstack([normals, self.above_jacobian(x)[active]])
        gradient = self.gradient(x)
        multipliers = np.linalg.lstsq(normals[:, inner].T, gradient[inner], rcond=None)[0]
        lagrangian = gradient - multipliers @ normals
        evaluation = self.evaluate(x)
        violation = float(np.max(np.abs(self.equal(x)), initial=0.0))
        return BezierMinimum(
            x * self.scale,
            evaluation,
            lagrangian[-2:] * self.energy_scale / self.loop_length_mm,
            float(np.max(np.abs(lagrangian[inner]), initial=0.0)),
            self.evaluations,
            converged and violation < 1e-6 and bool(np.isfinite(evaluation.energy_n_mm)),
            certified,
        )
