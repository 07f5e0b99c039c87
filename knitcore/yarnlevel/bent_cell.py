"""The response of a relaxed cell that is bent into a cylinder or skewed.

The periodic cell is bent into a cylinder: its neighbours become rotated images instead of shifted
ones. In unrolled coordinates (s the bent direction, o across it, z the height) the yarn stays
exactly periodic, and with g = 1 + κz its derivatives in the local frame of the cylinder are

    D1 = (g s′, o′, z′)
    D2 = (g s″ + 2κ z′s′, o″, z″ − κ g s′²)
    D3 = (g s‴ + 3κ(z′s″ + z″s′) − κ² g s′³, o‴, z‴ − 3κ² z′s′² − 3κ g s′s″)

from which the rod's energy follows as in the flat cell. κ > 0 puts the face (+z) outside, and κ is
measured on the surface of mean height zero.

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
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, cho_factor, lu_factor, lu_solve

from knitcore.arrays import Array
from knitcore.errors import ConvergenceError
from knitcore.threads import one_blas_thread
from knitcore.yarnlevel import kernels
from knitcore.yarnlevel.cell import plain_cell
from knitcore.yarnlevel.energy import CellEnergy
from knitcore.yarnlevel.spline import SplineGrid
from knitcore.yarnlevel.splines import RelaxedRepeat, refined
from knitcore.yarnlevel.tiling import refined_state, tiled_state

_STEP = 1e-3
"""Curvature times loop length of the central differences."""
_SKEW_STEP = 1e-5
"""Skew of the central differences, small because hard cores leave the yarn little room."""
_REACH = 1.05
"""Pairs are listed to this many diameters, so that none is missed in the bent cell."""
GRID = SplineGrid(controls=24, per_span=5)
"""On this grid rigidities are within 2 % of those on finer ones (garter is the worst)."""
_STEPS = 20
"""Most Newton steps from the relaxed state to its minimum."""
_STRIDE = 0.5
"""Longest of these steps, in radii: a longer one leads elsewhere."""
_SETTLED = 1e-7
"""Step, in radii, after which the state counts as settled."""
_COURSE, _WALE = -2, -1
"""Places of the sizes of a stitch among the unknowns."""


@dataclass(frozen=True)
class Deformation:
    """A bending along a direction (angle from the course), or a skew."""

    angle: float = 0.0
    curvature_per_mm: float = 0.0
    skew: float = 0.0


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
        """The same with front and back exchanged."""
        turned = {"moment_n": 0.0 - self.moment_n, "strain_across_mm": 0.0 - self.strain_across_mm}
        return replace(self, **turned)  # without -0.0


def settled(relaxed: RelaxedRepeat) -> BentCell:
    """The whole repeat without symmetries, in equilibrium and at mean height zero.

    Raises
    ------
    ConvergenceError, UnravelledError
        If it has no equilibrium nearby, also after it relaxed again on a finer grid.
    """
    found = _by_newton(relaxed)
    if found is None and relaxed.cell.grid.samples < GRID.samples:
        found = _by_newton(refined(relaxed, GRID))
    if found is None:
        raise ConvergenceError("Its shape changes when its symmetries are dropped.")
    return found


def _by_newton(relaxed: RelaxedRepeat) -> BentCell | None:
    """Steps from the relaxed state; None if one of them leads away from it."""
    cell = plain_cell(relaxed.chart, relaxed.cell.grid)
    state = tiled_state(relaxed.cell, relaxed.state, cell)
    heights = cell.dof[..., 2]
    state[heights] -= state[heights].mean()
    if cell.grid.samples < GRID.samples:
        finer = plain_cell(relaxed.chart, GRID)
        state, cell = refined_state(cell, state, finer), finer
    repeats = cell.rows // relaxed.cell.rows
    lengths = np.tile(
        relaxed.loop_lengths_mm.reshape(relaxed.cell.rows, -1),
        (repeats, cell.wales // relaxed.cell.wales if relaxed.loop_lengths_mm.ndim == 2 else 1),
    )
    energy = CellEnergy(
        cell, relaxed.yarn, lengths if lengths.shape[1] > 1 else lengths[:, 0], relaxed.convention
    )
    tension = np.tile(relaxed.tension_n[: relaxed.loop_lengths_mm.size], repeats)
    tension = np.resize(tension, len(energy.prescribed_mm))
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
    of each yarn along itself. ``reach`` is that of the pairs, in diameters of the flat cell.
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
            lower_upper, pivots = lu_factor(matrix)
        return lower_upper, pivots

    def is_minimum(self) -> bool:
        """Whether no small motion lowers the energy."""
        stiff = self._hessian + self.energy.penalty * self.rows.T @ self.rows
        with one_blas_thread():
            try:
                cho_factor(stiff, lower=True, overwrite_a=True)
            except LinAlgError:
                return False
        return True

    @property
    def area_mm2(self) -> float:
        """Area of the cell."""
        return float(self.energy.cell.stitches * self.state[_COURSE] * self.state[_WALE])

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
        course, wale = float(self.state[_COURSE]), float(self.state[_WALE])
        cos, sin = np.cos(angle), np.sin(angle)
        stitch = np.hypot(cos * course, sin * wale)  # the angle κ · stitch is prescribed
        first, second, by_state, by_length = self._differences(
            lambda q: Deformation(angle, curvature_per_mm=q), _STEP / self.energy.mean_loop_mm
        )
        by_state[_COURSE] -= first * cos**2 * course / stitch**2
        by_state[_WALE] -= first * sin**2 * wale / stitch**2
        free, moved = self._stiffness(second, by_state, by_length, None)
        held, _ = self._stiffness(second, by_state, by_length, _WALE if cos > abs(sin) else _COURSE)
        strains = np.array([moved[_COURSE] / course, moved[_WALE] / wale])
        area = self.area_mm2
        across = float(strains @ (sin**2, cos**2))
        return BendingResponse(
            moment_n=first / area,
            rigidity_n_mm=(free - first * across) / area,
            held_n_mm=held / area,
            strain_across_mm=across,
        )

    def sheared(self) -> float:
        """Shear modulus, N/mm."""
        _, second, by_state, by_length = self._differences(
            lambda q: Deformation(skew=q), _SKEW_STEP
        )
        stiffness, _ = self._stiffness(second, by_state, by_length, None)
        return stiffness / self.area_mm2

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
            found, push = lu_solve(self._factor, right).T
        if held is not None:
            found = found - push * (found[: len(by_state)][held] / push[: len(by_state)][held])
        return -found[: len(by_state)], -found[len(by_state) :]

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
        energy, cell, kappa = self.energy, self.energy.cell, d.curvature_per_mm
        frame = _Frame(self.curve, d.angle, kappa)
        speeds = np.linalg.norm(frame.bent[:, 1], axis=1)
        value, force, by_speed = kernels.bent_contact(
            self.curve, self.state[_COURSE], self.state[_WALE], self._pairs, cell.layout,
            energy.contact_law, speeds, kappa, (np.cos(d.angle), np.sin(d.angle)), d.skew,
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


class _Frame:
    """Derivatives of the yarn on the cylinder, and back (see the module's docstring)."""

    def __init__(self, curve: Array, angle: float, curvature_per_mm: float) -> None:
        cos, sin = np.cos(angle), np.sin(angle)
        self._turn = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
        self._curvature = k = curvature_per_mm
        flat = curve @ self._turn.T
        self._s, self._z = flat[:, 1:, 0].T, flat[:, 1:, 2].T
        self._g = g = 1.0 + k * curve[:, 0, 2]
        (s1, s2, s3), (z1, z2, _) = self._s, self._z
        self.bent = flat.copy()
        self.bent[:, 1, 0] = g * s1
        self.bent[:, 2, 0] = g * s2 + 2.0 * k * z1 * s1
        self.bent[:, 2, 2] -= k * g * s1**2
        self.bent[:, 3, 0] = g * s3 + 3.0 * k * (z1 * s2 + z2 * s1) - k**2 * g * s1**3
        self.bent[:, 3, 2] -= 3.0 * k * (k * z1 * s1**2 + g * s1 * s2)

    def pulled_back(self, slopes: Array) -> tuple[Array, Array]:
        """Slopes by D1, D2, D3 (n, 3, 3) as slopes by the height (n,) and by d1, d2, d3."""
        k, g = self._curvature, self._g
        (s1, s2, s3), (z1, z2, _) = self._s, self._z
        (a1, a2, a3), (c1, c2, c3) = slopes[:, :, 0].T, slopes[:, :, 2].T
        by_height = k * (
            a1 * s1 + a2 * s2 + a3 * (s3 - k**2 * s1**3) - c2 * k * s1**2 - 3.0 * k * c3 * s1 * s2
        )
        out = slopes.copy()
        out[:, 0, 0] = g * a1 + 2.0 * k * (z1 * a2 - g * s1 * c2)
        out[:, 0, 0] += 3.0 * k * (a3 * (z2 - k * g * s1**2) - c3 * (2.0 * k * z1 * s1 + g * s2))
        out[:, 1, 0] = g * a2 + 3.0 * k * (z1 * a3 - g * s1 * c3)
        out[:, 2, 0] = g * a3
        out[:, 0, 2] = c1 + 2.0 * k * s1 * a2 + 3.0 * k * (s2 * a3 - k * s1**2 * c3)
        out[:, 1, 2] = c2 + 3.0 * k * s1 * a3
        return by_height, np.asarray(out @ self._turn)
