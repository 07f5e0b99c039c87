"""The response of a relaxed cell that is curved or skewed.

The fabric turns by κ δ on the way along δ: its neighbours become rotated images instead of shifted
ones. κ is the symmetric matrix of the curvatures along courses and wales and of the twist between
them; bent into a cylinder, κ has one direction. Seen from a point of the yarn, points at δ from it
in the plane and at the height z are at

    δ + z m − (δ·m + z |m|²) m / 6 + …   in the plane, and   z − (δ·m + z |m|²) / 2 + …   above it

with m = κ δ, where the fabric is carried along at a constant rate of rotation. With p, q, c the
first three derivatives of the yarn in the plane, z₁, z₂, z₃ those of its height, P = κ p, Q = κ q,
C = κ c and b = P·(p + z P), its derivatives in that local frame are

    D1 = (p + z P,                              z₁)
    D2 = (q + z Q + 2 z₁ P,                     z₂ − b)
    D3 = (c + z C + 3 z₁ Q + 3 z₂ P − b P,      z₃ − 3 p·Q − 3 z₁ |P|² − 3 z P·Q)

from which the rod's energy follows as in the flat cell. Curvatures > 0 put the face (+z) outside,
and are measured on the surface of mean height zero. A cylinder is exact. A fabric with curvatures
in both directions, or twisted, has no flat plan: its repeats are alike to second order in κ, which
is what linear response needs.

At the relaxed flat state the response is linear. With L the Lagrangian of the cell (energy and
held lengths c), r = (∂²L/∂x∂κ, ∂c/∂κ) and K the matrix of the relaxed state,

    m₀ = L_κ / A,    D = (L_κκ − rᵀ K⁻¹ r) / A − m₀ ε,    dx/dκ = −K⁻¹ r

with A the area of the cell: the moment per width, N, that holds the fabric flat, and the change of
that moment with the curvature, the bending rigidity, N·mm (ε is the strain across per curvature:
the width that a moment refers to changes). In the bent direction the angle of a stitch is
prescribed, so its size along it is free; the other size is free in a strip or a tube, and held
inside a wide sheet.
Shear is the same with a skewed cell: the next course is moved sideways.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import ConvergenceError
from knitcore.base.threads import one_blas_thread
from knitcore.yarn.kernels.bent import bent_contact
from knitcore.yarn.model.cell import plain_cell
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.tiling import refined_state, tiled_state
from knitcore.yarn.solve.newton import COURSE, WALE
from knitcore.yarn.solve.splines import RelaxedRepeat, check_unheld, refined

_STEP = 2e-3
"""Curvature times loop length of the central differences: half of it leaves the coupling of some
ribs, 2e-4 of their rigidity, at the mercy of rounding (1e-4 of itself)."""
_SKEW_STEP = 1e-5
"""Skew of the central differences, small because hard cores leave the yarn little room."""
_REACH = 1.05
"""Pairs are listed up to this many yarn diameters, so that none is missed in the bent cell."""
GRID = SplineGrid(controls=24, per_span=5)
"""On this grid rigidities are within 2 % of those on finer ones (garter is the worst)."""
_STEPS = 20
"""Most Newton steps from the relaxed state to its minimum."""
_STRIDE = 0.5
"""Longest of these steps, in radii: a longer one leads elsewhere."""
_SETTLED = 1e-7
"""Step, in radii, after which the state counts as settled."""


@dataclass(frozen=True)
class Deformation:
    """Curvatures along courses and wales, the twist between them, 1/mm, and a skew."""

    course_per_mm: float = 0.0
    wale_per_mm: float = 0.0
    twist_per_mm: float = 0.0
    skew: float = 0.0

    @classmethod
    def cylinder(cls, angle: float, curvature_per_mm: float) -> Deformation:
        """Bent along one direction, at an angle from the course, rad."""
        cos, sin = np.cos(angle), np.sin(angle)
        along, up = cos * cos * curvature_per_mm, sin * sin * curvature_per_mm
        return cls(along, up, cos * sin * curvature_per_mm)

    @property
    def curvature_per_mm(self) -> tuple[float, float, float]:
        """Along courses, along wales, and the twist."""
        return self.course_per_mm, self.wale_per_mm, self.twist_per_mm


@dataclass(frozen=True)
class BendingResponse:
    """Response of a fabric to bending in one direction.

    Parameters
    ----------
    moment_n : derivative of the energy per area by the curvature at the flat state, N (N·mm per
        mm of width). Negative: left free, the fabric curves with its face outside.
    rigidity_n_mm : bending rigidity with the size across free, N·mm.
    held_n_mm : the same with the size across held.
    strain_across_mm : strain of the surface of mean height across the bend, per curvature, with the
        size across free, mm.
    """

    moment_n: float
    rigidity_n_mm: float
    held_n_mm: float
    strain_across_mm: float

    @property
    def curvature_per_mm(self) -> float:
        """Curvature at which the linear moment vanishes, 1/mm; positive has the face outside."""
        return -self.moment_n / self.rigidity_n_mm

    def swapped(self) -> BendingResponse:
        """Exchange front and back."""
        turned = {"moment_n": 0.0 - self.moment_n, "strain_across_mm": 0.0 - self.strain_across_mm}
        return replace(self, **turned)  # without -0.0


def settled(relaxed: RelaxedRepeat) -> BentCell:
    """The whole repeat without symmetries, in equilibrium and at mean height zero.

    Raises
    ------
    InputError
        If it is held.
    ConvergenceError, UnravelledError
        If it has no equilibrium nearby, not even relaxed again on a finer grid.
    """
    check_unheld(relaxed)
    cell = _by_newton(relaxed)
    if cell is None and relaxed.cell.grid.samples < GRID.samples:
        cell = _by_newton(refined(relaxed, GRID))
    if cell is None:
        raise ConvergenceError("Its shape changes when its symmetries are dropped.")
    return cell


def _by_newton(relaxed: RelaxedRepeat) -> BentCell | None:
    """Steps from the relaxed state; None if one of them leads away from it."""
    cell = plain_cell(relaxed.chart, relaxed.cell.grid)
    state = tiled_state(relaxed.cell, relaxed.state, cell)
    heights = cell.dof[..., 2]
    state[heights] -= state[heights].mean()
    if cell.grid.samples < GRID.samples:
        finer = plain_cell(relaxed.chart, GRID)
        state, cell = refined_state(cell, state, finer), finer
    lengths = np.resize(relaxed.loop_lengths_mm, cell.rows)
    energy = replace(relaxed.energy, cell=cell, loop_length_mm=lengths)
    tension = np.resize(relaxed.tension_n, cell.rows)
    radius = relaxed.yarn.radius_mm
    for _ in range(_STEPS):
        here = BentCell(energy, state, tension)
        step, change = here.newton()
        longest = float(np.abs(step).max()) / radius
        if longest < _SETTLED:
            return here
        if longest > _STRIDE:
            break
        state, tension = state + step, tension + change
    return None


class BentCell:
    """A cell at a state, with the factors of its linear response.

    Besides the lengths the rules hold the motions that cost no energy: of the cell as a whole, and
    of each yarn along itself. Pairs nearer than ``reach`` yarn diameters in the flat cell count.
    """

    def __init__(
        self, energy: CellEnergy, state: Array, tension: Array, reach: float = _REACH
    ) -> None:
        self.energy, self.state, self.tension = energy, state, tension
        self.curve = energy.curve(state)
        reach *= 2.0 * energy.yarn.radius_mm
        self._pairs, start = energy.pairs(self.curve, state, reach)
        slope = energy.derivatives(state, self.curve, self._pairs, start, tension)
        self._gradient, self._hessian = slope.gradient, slope.hessian
        self.rows = np.concatenate([slope.lengths, self._rules()])

    @cached_property
    def _factor(self) -> tuple[Array, NDArray[np.int32]]:
        none = np.zeros((len(self.rows), len(self.rows)))
        with one_blas_thread():
            matrix = np.block([[self._hessian, self.rows.T], [self.rows, none]])
            lower_upper, pivots = scipy.linalg.lu_factor(matrix)
        return lower_upper, pivots

    def is_minimum(self) -> bool:
        """Tell whether no small motion lowers the energy."""
        stiff = self._hessian + self.energy.penalty * self.rows.T @ self.rows
        with one_blas_thread():
            try:
                scipy.linalg.cho_factor(stiff, lower=True, overwrite_a=True)
            except scipy.linalg.LinAlgError:
                return False
        return True

    @property
    def area_mm2(self) -> float:
        """Area of the cell."""
        return float(self.energy.cell.stitches * self.state[COURSE] * self.state[WALE])

    def newton(self) -> tuple[Array, Array]:
        """Step to equilibrium at mean height zero, and change of the tensions."""
        excess = self.energy.excess(self.state, self.curve)
        off = np.zeros(len(self.rows))
        off[: len(excess)] = excess
        off[len(excess)] = self.rows[len(excess)] @ self.state
        step, force = self.solve(self._gradient, off, None)
        return step, force[: len(excess)]

    def bent(self, angle: float) -> BendingResponse:
        """Bending with the direction ``angle`` from the course, rad."""
        course, wale = float(self.state[COURSE]), float(self.state[WALE])
        cos, sin = np.cos(angle), np.sin(angle)
        stitch = np.hypot(cos * course, sin * wale)  # the angle κ · stitch is prescribed
        first, second, by_state, by_length = self._differences(
            lambda q: Deformation.cylinder(angle, q), _STEP / self.energy.mean_loop_mm
        )
        by_state[COURSE] -= first * cos**2 * course / stitch**2
        by_state[WALE] -= first * sin**2 * wale / stitch**2
        free, moved = self._stiffness(second, by_state, by_length, None)
        held, _ = self._stiffness(second, by_state, by_length, WALE if cos > abs(sin) else COURSE)
        strains = np.array([moved[COURSE] / course, moved[WALE] / wale])
        area = self.area_mm2
        across = float(strains @ (sin**2, cos**2))
        return BendingResponse(
            moment_n=first / area,
            rigidity_n_mm=(free - first * across) / area,
            held_n_mm=held / area,
            strain_across_mm=across,
        )

    def twisted(self) -> float:
        """Rigidity of twist D₆₆, N·mm: twisting by κ_xy costs 2 D₆₆ κ_xy² per area, both sizes
        free."""
        return 0.25 * self.curved(lambda q: Deformation(twist_per_mm=q))

    def coupled(self) -> float:
        """Coupling D₁ of the two curvatures, N·mm: D₁ κ_x κ_y of the energy per area."""
        bowl = self.curved(lambda q: Deformation(q, q))
        saddle = self.curved(lambda q: Deformation(q, -q))
        return 0.25 * (bowl - saddle)

    def curved(self, deformation: Callable[[float], Deformation]) -> float:
        """Second derivative of the relaxed energy per area by a curvature of any kind, N·mm."""
        return self._relaxed_stiffness(deformation, _STEP / self.energy.mean_loop_mm)

    def sheared(self) -> float:
        """Shear modulus, N/mm."""
        return self._relaxed_stiffness(lambda q: Deformation(skew=q), _SKEW_STEP)

    def _relaxed_stiffness(self, deformation: Callable[[float], Deformation], h: float) -> float:
        _, second, by_state, by_length = self._differences(deformation, h)
        return self._stiffness(second, by_state, by_length, None)[0] / self.area_mm2

    def _rules(self) -> Array:
        cell = self.energy.cell
        rules = np.zeros((3 + cell.rows, cell.unknowns))
        for place, axis in enumerate((2, 0, 1)):
            rules[place, cell.dof[..., axis]] = 1.0
        knots = self.curve.reshape(cell.rows, -1, 4, 3)[:, :: cell.grid.per_span, 1]
        for row in range(cell.rows):
            rules[3 + row, cell.dof[row]] = knots[row]
        return np.asarray(rules / np.linalg.norm(rules, axis=1)[:, None])

    def solve(self, by_state: Array, off: Array, held: int | None) -> tuple[Array, Array]:
        """-K⁻¹ (by_state, off): change of the unknowns and of the forces of the rules."""
        right = np.zeros((len(by_state) + len(off), 2))
        right[:, 0] = np.concatenate([by_state, off])
        if held is not None:
            right[held % len(by_state), 1] = 1.0
        with one_blas_thread():
            moved, push = scipy.linalg.lu_solve(self._factor, right).T
        if held is not None:
            moved = moved - push * (moved[: len(by_state)][held] / push[: len(by_state)][held])
        return -moved[: len(by_state)], -moved[len(by_state) :]

    def _stiffness(
        self, second: float, by_state: Array, by_length: Array, held: int | None
    ) -> tuple[float, Array]:
        """Second derivative of the relaxed energy, and the change of the unknowns."""
        off = np.zeros(len(self.rows))
        off[: len(by_length)] = by_length
        step, force = self.solve(by_state, off, held)
        return float(second + by_state @ step + by_length @ force[: len(by_length)]), step

    def _differences(
        self, deformation: Callable[[float], Deformation], h: float
    ) -> tuple[float, float, Array, Array]:
        """L_q and L_qq, and the derivatives by q of the gradient and of the lengths."""
        plus, minus = self.lagrangian(deformation(h)), self.lagrangian(deformation(-h))
        here = self.lagrangian(deformation(0.0))
        return (
            (plus.value - minus.value) / (2.0 * h),
            (plus.value - 2.0 * here.value + minus.value) / h**2,
            (plus.gradient - minus.gradient) / (2.0 * h),
            (plus.excess_mm - minus.excess_mm) / (2.0 * h),
        )

    def lagrangian(self, d: Deformation) -> Lagrangian:
        """Energy with the tensions' work in the deformed cell."""
        energy, cell = self.energy, self.energy.cell
        frame = Curved(self.curve, d.curvature_per_mm)
        speeds = np.linalg.norm(frame.bent[:, 1], axis=1)
        value, force, by_speed = bent_contact(
            self.curve, self.state[COURSE], self.state[WALE], self._pairs, cell.layout,
            energy.contact_law, speeds, d.curvature_per_mm, d.skew,
        )  # fmt: skip
        rod, spacing, slopes = energy.along_yarn(frame.bent, self.tension, by_speed)
        lengths = np.bincount(energy.stretch_of, speeds) / cell.grid.samples
        excess = lengths - energy.prescribed_mm
        by_height, slopes = frame.pulled_back(slopes)
        force[:-1, 2] += by_height
        gradient = energy.gathered(force[:-1], slopes)
        gradient[-2:] += force[-1, :2]
        return Lagrangian(value + rod + spacing + float(self.tension @ excess), gradient, excess)


@dataclass(frozen=True, eq=False)
class Lagrangian:
    """Value, gradient by the unknowns, and lengths beyond the prescribed ones."""

    value: float
    gradient: Array
    excess_mm: Array


class Curved:
    """Derivatives of the yarn in the curved cell, and back (see the module's docstring).

    Parameters
    ----------
    curve : (n, 4, 3) points of the yarn in the flat cell and its three derivatives.
    curvature_per_mm : along courses, along wales, and the twist.

    Attributes
    ----------
    bent : (n, 4, 3) the same with D1, D2, D3.
    """

    def __init__(self, curve: Array, curvature_per_mm: tuple[float, float, float]) -> None:
        kx, ky, kxy = curvature_per_mm
        self._turn = turn = np.array([[kx, kxy], [kxy, ky]])
        self._height, self._z = curve[:, 0, 2, None], curve[:, 1:, 2].T[..., None]
        self._flat = p, q, _ = curve[:, 1:, :2].swapaxes(0, 1)
        self._turned = P, Q, C = self._flat @ turn
        z, (z1, z2, _) = self._height, self._z
        self._long = p + z * P
        self._bend = b = _dot(P, self._long)
        self.bent = curve.copy()
        self.bent[:, 1, :2] = self._long
        self.bent[:, 2, :2] = q + z * Q + 2.0 * z1 * P
        self.bent[:, 3, :2] += z * C + 3.0 * (z1 * Q + z2 * P) - b * P
        self.bent[:, 2, 2:] -= b
        self.bent[:, 3, 2:] -= 3.0 * (_dot(self._long, Q) + z1 * _dot(P, P))

    def pulled_back(self, slopes: Array) -> tuple[Array, Array]:
        """Slopes by D1, D2, D3 (n, 3, 3) as slopes by the height (n,) and by d1, d2, d3."""
        A1, A2, A3 = slopes[..., :2].swapaxes(0, 1)
        _, c2, c3 = slopes[..., 2:].swapaxes(0, 1)
        (p, _, _), (P, Q, C) = self._flat, self._turned
        z, (z1, z2, _) = self._height, self._z
        by_bend = _dot(A3, P) + c2
        square = _dot(P, P)
        by_height = _dot(A1, P) + _dot(A2, Q) + _dot(A3, C) - by_bend * square
        by_height -= 3.0 * c3 * _dot(P, Q)
        by_P = z * A1 + 2.0 * z1 * A2 + 3.0 * z2 * A3 - self._bend * A3
        by_P -= by_bend * (p + 2.0 * z * P) + 3.0 * c3 * (z * Q + 2.0 * z1 * P)
        by_Q = z * A2 + 3.0 * z1 * A3 - 3.0 * c3 * self._long
        out = slopes.copy()
        out[:, 0, :2] += by_P @ self._turn - by_bend * P - 3.0 * c3 * Q
        out[:, 1, :2] += by_Q @ self._turn
        out[:, 2, :2] += z * A3 @ self._turn
        out[:, 0, 2:] += 2.0 * _dot(A2, P) + 3.0 * _dot(A3, Q) - 3.0 * c3 * square
        out[:, 1, 2:] += 3.0 * _dot(A3, P)
        return by_height[:, 0], out


def _dot(first: Array, second: Array) -> Array:
    return np.asarray((first * second).sum(axis=-1, keepdims=True))
