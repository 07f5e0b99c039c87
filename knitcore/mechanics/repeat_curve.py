"""Nonlinear uniaxial response of a repeat: Newton's method on the periodic quarter grid.

The same unknowns as in :mod:`knitcore.mechanics.homogenisation` (periodic displacement and macro
strains), with the full law of every phase. The strain along the pull is given; the transverse
strain and the shear come out free of stress, as in a wide strip. Strains are engineering strains
and stress is force per relaxed width, as in the law itself. This is the response of the flat
composite: the unfolding of a rib is in :mod:`knitcore.answer.composite`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import skfem
from numpy.typing import ArrayLike, NDArray
from scipy.sparse.linalg import splu

from knitcore.chart import StitchChart
from knitcore.errors import CancelledError, ConvergenceError, InputError
from knitcore.fabric import PHASES, Direction
from knitcore.law.stiffening import EXTENSION_START, StiffeningForm, stiffening
from knitcore.law.uniaxial import UniaxialCurve
from knitcore.materials import Material
from knitcore.mechanics.homogenisation import phase_grid, poisson_asymmetry, stiffness_form
from knitcore.mechanics.periodic_mesh import PeriodicMesh

Array = NDArray[np.float64]

MOST_STITCHES = 256
"""Largest repeat, 16 x 16."""

_TOLERANCE = 1e-9
_MOST_ITERATIONS = 60
_MOST_LOCKED = 0.01
"""Share of the area that may be in the law's continuation beyond its lock-up (at corners)."""


def repeat_curve(
    chart: StitchChart,
    material: Material,
    direction: Direction,
    strain: ArrayLike,
    *,
    form: StiffeningForm = StiffeningForm.FULL,
) -> UniaxialCurve:
    """Stress and transverse strain of a periodic repeat at given axial strains.

    Parameters
    ----------
    chart : one repeat, at most 16 x 16 stitches' worth.
    strain : increasing mean strains along the pull, from 0.

    Raises
    ------
    InputError
        If the repeat is too large, if the strains are not finite, increasing and at least 0, or
        if they go beyond the lock-up of the repeat.
    ConvergenceError
        If Newton's method stops short, naming the strain.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> curve = repeat_curve(
    ...     StitchChart.parse("KKPP"), material("acrylic"), Direction.COURSE, [0.0, 0.5, 1.0]
    ... )
    >>> [round(float(s), 4) for s in curve.stress]
    [0.0, 0.0197, 0.1083]
    """
    axial = _checked(strain, "strain")
    cell = _Cell(_small(chart), material, form)
    state = np.zeros(cell.unknowns)
    rows: list[tuple[float, float]] = []
    for value in axial:
        state = cell.solve(state, direction, strain=float(value))
        if form is StiffeningForm.FULL and cell.locked_share(state) > _MOST_LOCKED:
            raise InputError(
                "strain",
                f"{value:.3g} is beyond the lock-up of this repeat {direction}-wise.",
                f"Use at most {axial[len(rows) - 1] if rows else 0:.3g}.",
            )
        rows.append((cell.transverse_strain(state, direction), cell.stress(state, direction)))
    transverse, stress = np.array(rows).T
    return UniaxialCurve(strain=axial, transverse_strain=transverse, stress=stress)


def repeat_curve_at_stress(
    chart: StitchChart,
    material: Material,
    direction: Direction,
    stress: ArrayLike,
    *,
    cancelled: Callable[[], bool] | None = None,
) -> UniaxialCurve:
    """The same with the full law, at given mean stresses instead of strains.

    Parameters
    ----------
    stress : increasing, at least 0, N/mm.
    cancelled : asked before each stress.

    Raises
    ------
    InputError
        If the repeat is too large, or the stresses are not finite, increasing and at least 0.
    ConvergenceError
        If Newton's method stops short.
    CancelledError
        If ``cancelled`` returned True.
    """
    sigma = _checked(stress, "stress")
    cell = _Cell(_small(chart), material, StiffeningForm.FULL)
    state = np.zeros(cell.unknowns)
    rows: list[tuple[float, float]] = []
    for value in sigma:
        if cancelled is not None and cancelled():
            raise CancelledError("The caller stopped the curve.")
        state = cell.solve(state, direction, stress=float(value))
        rows.append((cell.strain(state, direction), cell.transverse_strain(state, direction)))
    strain, transverse = np.array(rows).T
    return UniaxialCurve(strain=strain, transverse_strain=transverse, stress=sigma)


def _checked(values: ArrayLike, field: str) -> Array:
    array = np.atleast_1d(np.asarray(values, dtype=float))
    if not np.all(np.isfinite(array)) or np.any(np.diff(array) <= 0) or np.any(array < 0):
        raise InputError(
            field, "must be finite, increasing and at least 0.", "Give, say, 0, 0.1, 0.2."
        )
    return array


def _small(chart: StitchChart) -> StitchChart:
    if chart.rows * chart.columns > MOST_STITCHES:
        raise InputError(
            "chart",
            f"{chart.columns}x{chart.rows} is too large for a nonlinear repeat.",
            f"Give one repeat of at most {MOST_STITCHES} stitches.",
        )
    return chart


def _internal_work(v: Any, w: Any) -> Any:
    return (
        w.stress_xx * v.grad[0, 0]
        + w.stress_yy * v.grad[1, 1]
        + w.stress_xy * (v.grad[0, 1] + v.grad[1, 0])
    )


_WORK_FORM = skfem.LinearForm(_internal_work)


class _Cell:
    """One repeat with the full law of its phases."""

    def __init__(self, chart: StitchChart, material: Material, form: StiffeningForm) -> None:
        grid = phase_grid(chart, material)
        self._form = form
        self._asymmetry = poisson_asymmetry(grid, material)
        self._mesh = PeriodicMesh(grid.width_mm, grid.height_mm)
        constants = np.zeros((8, 4))
        for phase in np.unique(grid.phases):
            law = material.law(PHASES[phase]).symmetrised()
            constants[:, phase] = (
                law.stiffness_xxxx,
                law.stiffness_yyyy,
                law.stiffness_xxyy,
                law.shear_modulus,
                law.alpha_xx,
                law.alpha_yy,
                law.beta_xx,
                law.beta_yy,
            )
        fields = [self._mesh.cell_field(row[grid.phases]) for row in constants]
        self._xxxx, self._yyyy, self._xxyy, self._xyxy = fields[:4]
        self._alpha_x, self._alpha_y, self._beta_x, self._beta_y = fields[4:]
        self.unknowns = int(self._mesh.map.shape[1])

    def strain(self, state: Array, direction: Direction) -> float:
        """Mean strain along the pull."""
        return float(state[self._mesh.macro[direction.axis]])

    def transverse_strain(self, state: Array, direction: Direction) -> float:
        """Mean strain across the pull, with the phases' own asymmetry of the Poisson ratios."""
        strain = float(state[self._mesh.macro[direction.other.axis]])
        course = direction is Direction.COURSE
        return strain * self._asymmetry if course else strain / self._asymmetry

    def locked_share(self, state: Array) -> float:
        """Share of the area whose strain is where the law is only continued."""
        xx, yy, _ = self._gradient(state)
        locked = (self._alpha_x * xx > EXTENSION_START) | (self._alpha_y * yy > EXTENSION_START)
        return float((locked * self._mesh.basis.dx).sum() / self._mesh.area_mm2)

    def stress(self, state: Array, direction: Direction) -> float:
        """Mean stress along the pull, N/mm."""
        residual = self._residual(*self._gradient(state))
        return float(residual[self._mesh.macro[direction.axis]] / self._mesh.area_mm2)

    def solve(
        self,
        start: Array,
        direction: Direction,
        *,
        strain: float | None = None,
        stress: float = 0.0,
    ) -> Array:
        """Equilibrium at a mean strain, or at a mean stress, from that at a smaller one."""
        pulled = self._mesh.macro[direction.axis]
        load = np.zeros(self.unknowns)
        state = start.copy()
        if strain is None:
            load[pulled] = stress * self._mesh.area_mm2
            free = np.append(self._mesh.free, self._mesh.macro)
        else:
            free = np.append(self._mesh.free, np.delete(self._mesh.macro, direction.axis))
            if start[pulled] > 0:
                state *= strain / start[pulled]
            state[pulled] = strain
        scale = self._mesh.area_mm2 * max(float(self._xxxx.max()), float(self._yyyy.max()))
        tolerance = _TOLERANCE * scale * max(strain or 0.0, 1e-3)
        energy = self._energy(state) - float(load @ state)
        for _ in range(_MOST_ITERATIONS):
            gradient = self._gradient(state)
            residual = (self._residual(*gradient) - load)[free]
            if float(np.abs(residual).max()) <= tolerance:
                return state
            tangent = self._tangent(*gradient)[free][:, free].tocsc()
            step = np.zeros(self.unknowns)
            step[free] = -splu(tangent).solve(residual)
            slope = float(residual @ step[free])
            length, lowest = 1.0, energy
            # The energy is convex, so a shorter step always gets lower.
            while length > 1e-6:
                trial = state + length * step
                lowest = self._energy(trial) - float(load @ trial)
                if lowest <= energy + 1e-4 * length * slope + 1e-14 * abs(energy):
                    break
                length /= 2
            state, energy = state + length * step, lowest
        held = f"a strain of {strain:.3g}" if strain is not None else f"{stress:.3g} N/mm"
        raise ConvergenceError(f"The repeat found no equilibrium at {held}.")

    def _gradient(self, state: Array) -> tuple[Array, Array, Array]:
        gradient = self._mesh.basis.interpolate(self._mesh.map @ state).grad
        return gradient[0, 0], gradient[1, 1], gradient[0, 1] + gradient[1, 0]

    def _energy(self, state: Array) -> float:
        xx, yy, xy = self._gradient(state)
        density = 0.5 * (self._xxxx * xx**2 + self._yyyy * yy**2 + self._xyxy * xy**2)
        density = density + self._xxyy * xx * yy
        for alpha, beta, strain in (
            (self._alpha_x, self._beta_x, xx),
            (self._alpha_y, self._beta_y, yy),
        ):
            energy, _, _ = stiffening(alpha * strain, self._form)
            density = density + np.divide(
                beta * energy, alpha, out=np.zeros_like(energy), where=alpha > 0
            )
        return float((density * self._mesh.basis.dx).sum())

    def _residual(self, xx: Array, yy: Array, xy: Array) -> Array:
        _, slope_x, _ = stiffening(self._alpha_x * xx, self._form)
        _, slope_y, _ = stiffening(self._alpha_y * yy, self._form)
        work = _WORK_FORM.assemble(
            self._mesh.basis,
            stress_xx=self._xxxx * xx + self._xxyy * yy + self._beta_x * slope_x,
            stress_yy=self._yyyy * yy + self._xxyy * xx + self._beta_y * slope_y,
            stress_xy=self._xyxy * xy,
        )
        reduced: Array = self._mesh.map.T @ work
        return reduced

    def _tangent(self, xx: Array, yy: Array, xy: Array) -> Any:
        _, _, curvature_x = stiffening(self._alpha_x * xx, self._form)
        _, _, curvature_y = stiffening(self._alpha_y * yy, self._form)
        full = stiffness_form.assemble(
            self._mesh.basis,
            xxxx=self._xxxx + self._alpha_x * self._beta_x * curvature_x,
            yyyy=self._yyyy + self._alpha_y * self._beta_y * curvature_y,
            xxyy=self._xxyy,
            xyxy=self._xyxy,
        )
        return (self._mesh.map.T @ full @ self._mesh.map).tocsr()
