"""The energy of a cell of yarn as a function of its unknowns, with gradient and Hessian."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from knitcore.yarnlevel import kernels
from knitcore.yarnlevel.cell import YarnCell
from knitcore.yarnlevel.conventions import REGULARISATION_N_MM4, Convention
from knitcore.yarnlevel.neighbours import EXCLUSION_RADII, neighbour_pairs
from knitcore.yarnlevel.yarn import YarnModel

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

GAUGE_PER_BENDING = 100.0
"""Stiffness of the gauge penalty in units of B / L: keeps the samples evenly spread."""
PENALTY_PER_BENDING = 3e4
"""Stiffness of the augmented length constraint in units of B / L³."""

REGULARISATION_PER_BENDING = 4e-4
"""Most that C may be, in units of B L²: the constant C of the paper belongs to worsted yarn, and
would be stiffer than the bending of a lace yarn. None of the paper's samples reaches the limit."""


@dataclass(frozen=True)
class Terms:
    """Parts of a cell's energy, N·mm, and its lengths."""

    rod: float
    contact: float
    gauge: float
    excess_mm: Array
    """Length of each course beyond the prescribed one."""

    @property
    def energy(self) -> float:
        """Physical energy: bending, regularisation and contact."""
        return self.rod + self.contact


@dataclass(frozen=True, eq=False)
class Slope:
    """Derivatives at a state by the unknowns.

    Attributes
    ----------
    gradient : (unknowns,) of the Lagrangian.
    lengths : (rows, unknowns), of the length of each course.
    hessian : (unknowns, unknowns) of the Lagrangian; empty where it was not wanted.
    """

    gradient: Array
    lengths: Array
    hessian: Array


@dataclass(frozen=True, eq=False)
class CellEnergy:
    """Energy of a cell, its length constraint included as an augmented Lagrangian.

    Parameters
    ----------
    cell : shape space.
    yarn : the yarn.
    loop_length_mm : (rows,) mean length of yarn per stitch of each course.
    convention : factors of the terms.
    """

    cell: YarnCell
    yarn: YarnModel
    loop_length_mm: Array
    convention: Convention

    @cached_property
    def mean_loop_mm(self) -> float:
        """Mean loop length."""
        return float(np.mean(self.loop_length_mm))

    @cached_property
    def unit(self) -> float:
        """B / L, the scale of energies, N·mm."""
        return self.yarn.bending_modulus_n_mm2 / self.mean_loop_mm

    @property
    def regularisation_n_mm4(self) -> float:
        """C, N·mm⁴."""
        limit = REGULARISATION_PER_BENDING * self.yarn.bending_modulus_n_mm2 * self.mean_loop_mm**2
        return min(REGULARISATION_N_MM4, limit)

    @cached_property
    def penalty(self) -> float:
        """Stiffness of the length constraint of a course, N/mm."""
        return PENALTY_PER_BENDING * self.unit / self.mean_loop_mm**2 / self.cell.wales

    @cached_property
    def contact_parameters(self) -> Array:
        """Factor of a pair, k, p, r, r_core and dt, as the kernels take them."""
        y = self.yarn
        return np.array(
            [
                self.convention.unordered_pair_factor,
                y.contact_stiffness_n_per_mm3,
                y.contact_exponent,
                y.radius_mm,
                y.core_radius_mm,
                1.0 / self.cell.grid.samples,
            ]
        )

    @cached_property
    def _rod_parameters(self) -> Array:
        return np.array(
            [
                self.convention.bending_factor * self.yarn.bending_modulus_n_mm2,
                self.convention.regularisation_factor * self.regularisation_n_mm4,
                GAUGE_PER_BENDING * self.unit,
                self.mean_loop_mm,
                1.0 / self.cell.grid.samples,
            ]
        )

    def curve(self, state: Array) -> Array:
        """(rows * S, 4, 3): samples of all courses with three derivatives (see kernels)."""
        cell = self.cell
        sampled = kernels.sample_curve(
            cell.controls(state), state[-2], cell.mirror[0], cell.grid.basis
        )
        return sampled.reshape(-1, 4, 3)

    def pairs(self, curve: Array, state: Array, reach: float) -> tuple[Ints, Ints]:
        """Pairs of samples nearer than ``reach`` (see neighbours)."""
        cell = self.cell
        pairs, start = neighbour_pairs(
            curve,
            cell.place,
            (float(state[-2]), float(state[-1])),
            (cell.rows, cell.wales),
            cell.mirror,
            reach,
            EXCLUSION_RADII * self.yarn.radius_mm / self.mean_loop_mm,
        )
        return pairs, start

    def excess(self, curve: Array) -> Array:
        """Length of each course beyond what it should have, mm."""
        cell = self.cell
        speed = np.sqrt(np.einsum("im,im->i", curve[:, 1], curve[:, 1]))
        lengths = speed.reshape(cell.rows, -1).sum(axis=1) / cell.grid.samples
        return np.asarray(lengths - cell.wales * self.loop_length_mm)

    def value(self, state: Array, curve: Array, pairs: Ints) -> Terms:
        """Parts of the energy."""
        cell = self.cell
        none = np.zeros((0, 3)), np.zeros(0)
        contact = kernels.contact(
            curve, state[-2], state[-1], pairs, cell.place, cell.wales, cell.rows,
            self.contact_parameters, 0, *none,
        )  # fmt: skip
        rod, gauge = kernels.rod(
            curve, len(cell.place), self._rod_parameters, np.zeros(cell.rows), np.zeros(0), 0,
            np.zeros((0, 3, 3)), np.zeros((0, 9, 9)),
        )  # fmt: skip
        return Terms(rod, contact, gauge, self.excess(curve))

    def merit(self, terms: Terms, tension: Array) -> float:
        """Augmented Lagrangian with the given tension of each course, N."""
        excess = terms.excess_mm
        return float(
            terms.energy + terms.gauge + tension @ excess + 0.5 * self.penalty * excess @ excess
        )

    def derivatives(
        self, state: Array, curve: Array, pairs: Ints, start: Ints, tension: Array,
        *, hessian: bool = True,
    ) -> Slope:  # fmt: skip
        """Gradient and Hessian of the Lagrangian, ``merit`` without its penalty."""
        cell = self.cell
        n, size = len(curve), cell.unknowns
        force = np.zeros((n + 1, 3))
        weight_slope = np.zeros(n)
        kernels.contact(
            curve, state[-2], state[-1], pairs, cell.place, cell.wales, cell.rows,
            self.contact_parameters, 1, force, weight_slope,
        )  # fmt: skip
        slopes = np.zeros((n, 3, 3))
        local = np.zeros((n if hessian else 0, 9, 9))
        kernels.rod(
            curve, len(cell.place), self._rod_parameters, tension, weight_slope,
            2 if hessian else 1, slopes, local,
        )  # fmt: skip
        gradient = np.zeros(size)
        gradient[-2:] = force[n, :2]
        kernels.scatter_gradient(force, slopes, *self._layout, gradient)
        lengths = self.length_gradients(curve)
        if not hessian:
            return Slope(gradient, lengths, np.zeros((0, 0)))
        matrix = np.zeros((size, size))
        position = np.zeros((n, 3, 3))
        position_speed = np.zeros((n, 3, 3))
        kernels.contact_hessian(
            curve, state[-2], state[-1], pairs, start, cell.place, cell.wales, cell.rows,
            cell.mirror[0], self.contact_parameters, cell.grid.basis, cell.dof, cell.sign,
            position, position_speed, matrix,
        )  # fmt: skip
        kernels.scatter_local(local, position, position_speed, *self._layout, matrix)
        return Slope(gradient, lengths, matrix)

    def length_gradients(self, curve: Array) -> Array:
        """(rows, unknowns): gradient of the length of each course."""
        cell = self.cell
        tangent = curve[:, 1] / np.linalg.norm(curve[:, 1], axis=1)[:, None]
        slopes = np.zeros((len(curve), 3, 3))
        slopes[:, 0] = tangent / cell.grid.samples
        every = np.zeros(cell.unknowns)
        kernels.scatter_gradient(np.zeros((len(curve), 3)), slopes, *self._layout, every)
        rows = np.zeros((cell.rows, cell.unknowns))
        for row, own in zip(rows, cell.dof, strict=True):  # no unknown belongs to two courses
            row[own] = every[own]
        rows[:, -2] = slopes[:, 0, 0].reshape(cell.rows, -1).sum(axis=1)
        return rows

    @property
    def _layout(self) -> tuple[int, int, int, Array, Ints, Array]:
        cell = self.cell
        return (
            cell.rows, cell.controls_per_course, cell.mirror[0], cell.grid.basis,
            cell.dof, cell.sign,
        )  # fmt: skip
