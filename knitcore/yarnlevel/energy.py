"""The energy of a cell of yarn as a function of its unknowns, with gradient and Hessian."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from knitcore.yarnlevel import kernels
from knitcore.yarnlevel.cell import YarnCell
from knitcore.yarnlevel.conventions import REGULARISATION_N_MM4, Convention
from knitcore.yarnlevel.grip import Grip
from knitcore.yarnlevel.held import foot_rows, plane_rows
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
    """Lengths beyond the prescribed ones, and what else is held over its value."""

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
    lengths : (constraints, unknowns), of the prescribed lengths and of what else is held.
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
    loop_length_mm : (rows,) mean length of yarn per stitch of each course, or (rows, wales), that
        of each stitch from foot to foot.
    convention : factors of the terms.
    flat : the middles of all stitches are held in one plane.
    grips : where the yarn may not slide.
    """

    cell: YarnCell
    yarn: YarnModel
    loop_length_mm: Array
    convention: Convention
    flat: bool = False
    grips: tuple[Grip, ...] = ()

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

    @property
    def per_stitch(self) -> bool:
        """Whether every stitch has a length of its own."""
        return self.loop_length_mm.ndim == 2

    @cached_property
    def prescribed_mm(self) -> Array:
        """(m,) the lengths that are prescribed: of courses, or of stitches."""
        if self.per_stitch:
            return self.loop_length_mm.ravel()
        return self.cell.wales * self.loop_length_mm

    @cached_property
    def stretch_of(self) -> Ints:
        """Which of the prescribed lengths each sample belongs to."""
        course: Ints = np.repeat(np.arange(self.cell.rows), len(self.cell.place))
        if not self.per_stitch:
            return course
        stitch: Ints = np.tile(self.cell.place.astype(np.int64), self.cell.rows)
        return np.asarray(course * self.cell.wales + stitch)

    @cached_property
    def held(self) -> Array:
        """(k, unknowns): linear rules besides the lengths."""
        rules = [np.zeros((0, self.cell.unknowns))]
        if self.per_stitch:
            rules.append(foot_rows(self.cell))
        if self.flat:
            rules.append(plane_rows(self.cell))
        return np.concatenate(rules)

    @property
    def constraints(self) -> int:
        """Number of prescribed lengths, linear rules and grips."""
        return len(self.prescribed_mm) + len(self.held) + len(self.grips)

    @cached_property
    def penalty(self) -> float:
        """Stiffness of the constraints, N/mm."""
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

    @cached_property
    def _speeds(self) -> Array:
        """What |d1| should be at each sample: the length of its stitch."""
        return np.repeat(
            self.loop_length_mm.ravel(), len(self.stretch_of) // self.loop_length_mm.size
        )

    def excess(self, state: Array, curve: Array) -> Array:
        """What is held over its value: lengths, linear rules, grips, mm."""
        speed = np.sqrt(np.einsum("im,im->i", curve[:, 1], curve[:, 1]))
        lengths = np.bincount(self.stretch_of, speed) / self.cell.grid.samples
        slid = np.array([grip.value(state) for grip in self.grips])
        return np.concatenate([lengths - self.prescribed_mm, self.held @ state, slid])

    def value(self, state: Array, curve: Array, pairs: Ints) -> Terms:
        """Parts of the energy."""
        cell = self.cell
        none = np.zeros((0, 3)), np.zeros(0)
        contact = kernels.contact(
            curve, state[-2], state[-1], pairs, cell.place, cell.wales, cell.rows,
            self.contact_parameters, 0, *none,
        )  # fmt: skip
        rod, gauge = kernels.rod(
            curve, self._rod_parameters, self._speeds, np.zeros(0), np.zeros(0), 0,
            np.zeros((0, 3, 3)), np.zeros((0, 9, 9)),
        )  # fmt: skip
        return Terms(rod, contact, gauge, self.excess(state, curve))

    def merit(self, terms: Terms, tension: Array) -> float:
        """Augmented Lagrangian with the given tensions (multipliers of what is held), N."""
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
            curve, self._rod_parameters, self._speeds, tension[self.stretch_of], weight_slope,
            2 if hessian else 1, slopes, local,
        )  # fmt: skip
        gradient = np.zeros(size)
        gradient[-2:] = force[n, :2]
        kernels.scatter_gradient(force, slopes, *self._layout, gradient)
        slides = np.array([grip.gradient(state) for grip in self.grips]).reshape(-1, size)
        lengths = np.concatenate([self.length_gradients(curve), self.held, slides])
        beside = len(self.prescribed_mm)
        gradient += tension[beside:] @ lengths[beside:]
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
        for force_of_grip, grip in zip(tension[beside + len(self.held) :], self.grips, strict=True):
            matrix += force_of_grip * grip.hessian()
        return Slope(gradient, lengths, matrix)

    def along_yarn(
        self, curve: Array, tension: Array, weight_slope: Array
    ) -> tuple[float, float, Array]:
        """What the yarn has by itself: rod and gauge energy, and slopes (n, 3, 3) by d1, d2, d3.

        The slopes include the tensions and ``weight_slope``, that of the contact by |d1|.
        """
        slopes = np.zeros((len(curve), 3, 3))
        rod, gauge = kernels.rod(
            curve, self._rod_parameters, self._speeds, tension[self.stretch_of], weight_slope, 1,
            slopes, np.zeros((0, 9, 9)),
        )  # fmt: skip
        return rod, gauge, slopes

    def gathered(self, force: Array, slopes: Array) -> Array:
        """(unknowns,) gradient from slopes (n, 3) by the positions and (n, 3, 3) by d1, d2, d3."""
        out = np.zeros(self.cell.unknowns)
        kernels.scatter_gradient(force, slopes, *self._layout, out)
        return out

    def length_gradients(self, curve: Array) -> Array:
        """(m, unknowns): gradient of each prescribed length."""
        cell = self.cell
        tangent = curve[:, 1] / np.linalg.norm(curve[:, 1], axis=1)[:, None] / cell.grid.samples
        rows = np.zeros((len(self.prescribed_mm), cell.unknowns))
        if self.per_stitch:
            for k, row in enumerate(rows):
                self._scatter(np.where((self.stretch_of == k)[:, None], tangent, 0.0), row)
            return rows
        every = np.zeros(cell.unknowns)
        self._scatter(tangent, every)
        for row, dof, sign in zip(rows, cell.dof, cell.sign, strict=True):
            own = dof[sign != 0.0]  # no unknown belongs to two courses
            row[own] = every[own]
        rows[:, -2] = tangent[:, 0].reshape(cell.rows, -1).sum(axis=1)
        return rows

    def _scatter(self, by_speed: Array, out: Array) -> None:
        """Gradient by the unknowns of what depends on d1 as given."""
        slopes = np.zeros((len(by_speed), 3, 3))
        slopes[:, 0] = by_speed
        kernels.scatter_gradient(np.zeros((len(by_speed), 3)), slopes, *self._layout, out)

    @property
    def _layout(self) -> tuple[int, int, int, Array, Ints, Array]:
        cell = self.cell
        return (
            cell.rows, cell.controls_per_course, cell.mirror[0], cell.grid.basis,
            cell.dof, cell.sign,
        )  # fmt: skip
