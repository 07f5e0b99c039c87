"""The energy of a cell of yarn as a function of its unknowns, with gradient and Hessian."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array, sum_in_order
from knitcore.base.threads import on_halves
from knitcore.linear.dense import dot, times
from knitcore.yarn.kernels.contact import contact_energy, contact_hessian, contact_slopes
from knitcore.yarn.kernels.couplings import add_transposed
from knitcore.yarn.kernels.curve_samples import laid_out, sample_curve
from knitcore.yarn.kernels.friction_kernels import (
    Sliding,
    friction_energy,
    friction_hessian,
    friction_slopes,
)
from knitcore.yarn.kernels.rod import rod_energy, rod_hessian, rod_slopes
from knitcore.yarn.kernels.scatter import scatter_gradient, scatter_local
from knitcore.yarn.kernels.structures import ContactLaw, Ints, Pairs, RodLaw
from knitcore.yarn.kernels.tiles import (
    TiledMatrix,
    empty_tiles,
    one_tile,
    tiled_product,
    touching_blocks,
)
from knitcore.yarn.model.cell import YarnCell
from knitcore.yarn.model.constraints import foot_rows, plane_rows, posture_rows
from knitcore.yarn.model.conventions import REGULARISATION_N_MM4, Convention
from knitcore.yarn.model.neighbours import EXCLUSION_RADII, neighbour_pairs
from knitcore.yarn.model.slides import SlideConstraint
from knitcore.yarn.model.yarn_model import YarnModel

SPACING_PER_BENDING = 100.0
"""Stiffness of the spacing penalty in units of B / L: keeps the samples evenly spread."""
STIFF_SPACING_PER_BENDING = 1000.0
"""Stiffness on the way to a large cell's shape: the sparse Hessian, which leaves out the penalty of
the lengths, is then convex in them. It costs 1e-4 of the energy, so the fine grid goes without."""
PAIRS_TO_SHARE = 1_000_000
"""Fewest pairs of samples for which a second thread saves time."""
BLOCK = 12
"""Unknowns in a block of the sparse Hessian: those of four control points."""
PENALTY_PER_BENDING = 3e4
"""Stiffness of the augmented length constraint in units of B / L³."""

REGULARISATION_PER_BENDING = 4e-4
"""Largest C, in units of B L²: the paper's constant C is for worsted yarn and would exceed the
bending stiffness of a lace yarn. None of the paper's samples reaches the limit."""


@dataclass(frozen=True)
class Terms:
    """Parts of a cell's energy, N·mm, and its lengths."""

    rod: float
    contact: float
    spacing: float
    excess_mm: Array
    """Excess of the lengths, and of other constrained quantities, over their prescribed values."""
    friction: float = 0.0
    """Potential of the friction in this step."""

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
    lengths : (constraints, unknowns), of the prescribed lengths and the other constraints; without
        rows where they were not wanted.
    hessian : (unknowns, unknowns) of the Lagrangian; None where it was not wanted.
    sparse : the same in tiles, where that was wanted.
    """

    gradient: Array
    lengths: Array
    hessian: Array | None = None
    sparse: SparseHessian | None = None


@dataclass(frozen=True, eq=False)
class SparseHessian:
    """A Hessian in tiles.

    Attributes
    ----------
    touching : (blocks, blocks) the tiles that are not zero.
    matrix : its part in the control points, without the sizes.
    sizes : (2, unknowns) rows of the two sizes of a stitch.
    """

    touching: NDArray[np.bool_]
    matrix: TiledMatrix
    sizes: Array

    def times(self, vector: Array) -> Array:
        """The product with a vector (unknowns,)."""
        out = np.empty(len(vector))
        out[:-2] = tiled_product(self.matrix.tiles, self.matrix.where, vector[:-2])
        out[:-2] += vector[-2] * self.sizes[0, :-2] + vector[-1] * self.sizes[1, :-2]
        out[-2:] = times(self.sizes, vector)
        return out


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
    flat : the middles of all stitches are held in one plane, their feet at whole t, and stitches in
        like surroundings tip and lean alike.
    slides : where the yarn may not slide.
    spacing_per_bending : stiffness of the spacing penalty in units of B / L.
    sliding : pairs of samples that rub in this step; None without friction.
    """

    cell: YarnCell
    yarn: YarnModel
    loop_length_mm: Array
    convention: Convention
    flat: bool = False
    slides: tuple[SlideConstraint, ...] = ()
    spacing_per_bending: float = SPACING_PER_BENDING
    sliding: Sliding | None = None

    @cached_property
    def mean_loop_mm(self) -> float:
        """Mean loop length."""
        return float(np.mean(self.loop_length_mm))

    @property
    def stitch_of_yarn_mm(self) -> float:
        """Length of yarn that counts as one stitch where a yarn does not touch itself."""
        return self.mean_loop_mm

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
        """Tell whether every stitch has a length of its own."""
        return self.loop_length_mm.ndim == 2

    @cached_property
    def prescribed_mm(self) -> Array:
        """(m,) the lengths that are prescribed: of courses, or of stitches."""
        if self.per_stitch:
            return self.loop_length_mm.ravel()
        return self.cell.wales * self.loop_length_mm

    @cached_property
    def stretch_of(self) -> Ints:
        """Index of the prescribed length that each sample belongs to."""
        course: Ints = np.repeat(np.arange(self.cell.rows), len(self.cell.place))
        if not self.per_stitch:
            return course
        stitch: Ints = np.tile(self.cell.place.astype(np.int64), self.cell.rows)
        return np.asarray(course * self.cell.wales + stitch)

    @cached_property
    def held(self) -> Array:
        """(k, unknowns): linear rules besides the lengths."""
        rules = [np.zeros((0, self.cell.unknowns))]
        if self.per_stitch or self.flat:
            rules.append(foot_rows(self.cell))
        if self.flat:
            rules += [plane_rows(self.cell), posture_rows(self.cell)]
        return np.concatenate(rules)

    @property
    def constraints(self) -> int:
        """Number of prescribed lengths, linear rules and slides."""
        return len(self.prescribed_mm) + len(self.held) + len(self.slides)

    @cached_property
    def penalty(self) -> float:
        """Stiffness of the constraints, N/mm."""
        return PENALTY_PER_BENDING * self.unit / self.mean_loop_mm**2 / self.cell.wales

    @cached_property
    def contact_law(self) -> ContactLaw:
        """The contact's parameters for the kernels."""
        return ContactLaw(
            weight=self.convention.unordered_pair_factor / self.cell.grid.samples**2,
            stiffness=self.yarn.contact_stiffness_n_per_mm3,
            exponent=self.yarn.contact_exponent,
            radius=self.yarn.radius_mm,
            core=self.yarn.core_radius_mm,
        )

    @cached_property
    def rod_law(self) -> RodLaw:
        """Parameters of bending, regularisation and spacing penalty for the kernels."""
        return RodLaw(
            bend=self.convention.bending_factor * self.yarn.bending_modulus_n_mm2,
            regular=self.convention.regularisation_factor * self.regularisation_n_mm4,
            spacing=self.spacing_per_bending * self.unit,
            step=1.0 / self.cell.grid.samples,
        )

    def curve(self, state: Array) -> Array:
        """(rows * S, 4, 3): samples of all courses with three derivatives (see kernels)."""
        cell = self.cell
        sampled = sample_curve(cell.controls(state), state[-2], cell.mirror[0], cell.grid.basis)
        return sampled.reshape(-1, 4, 3)

    def pairs(self, curve: Array, state: Array, reach: float) -> tuple[Pairs, Ints]:
        """Pairs of samples nearer than ``reach`` (see neighbours)."""
        return self._near(curve, state, reach, np.ones(len(curve), bool), (False, False))

    def _near(
        self, curve: Array, state: Array, reach: float,
        moving: NDArray[np.bool_], cut: tuple[bool, bool],
    ) -> tuple[Pairs, Ints]:  # fmt: skip
        cell = self.cell
        sizes = float(state[-2]), float(state[-1])
        exclusion = EXCLUSION_RADII * self.yarn.radius_mm / self.stitch_of_yarn_mm
        return neighbour_pairs(
            curve, cell.place, sizes, (cell.rows, cell.wales), cell.mirror, reach, exclusion,
            moving, cut,
        )  # fmt: skip

    @cached_property
    def speeds(self) -> Array:
        """Target of |d1| at each sample: the length of its stitch."""
        return np.repeat(
            self.loop_length_mm.ravel(), len(self.stretch_of) // self.loop_length_mm.size
        )

    def excess(self, state: Array, curve: Array) -> Array:
        """(constraints,) lengths, linear rules and slides less their prescribed values, mm."""
        speed = np.sqrt(np.einsum("im,im->i", curve[:, 1], curve[:, 1]))
        lengths = np.bincount(self.stretch_of, speed) / self.cell.grid.samples
        slid = np.array([slide.value(state) for slide in self.slides])
        return np.concatenate([lengths - self.prescribed_mm, times(self.held, state), slid])

    def value(self, state: Array, curve: Array, pairs: Pairs) -> Terms:
        """Parts of the energy."""
        layout, law = self.cell.layout, self.contact_law
        contact = sum_in_order(
            on_halves(
                lambda of: contact_energy(curve, state[-2], state[-1], of, layout, law),
                pairs, PAIRS_TO_SHARE,
            )
        )  # fmt: skip
        rod, spacing = rod_energy(curve, self.rod_law, self.speeds)
        friction = 0.0
        if self.sliding is not None:
            friction = friction_energy(
                curve, state[-2], state[-1], self.sliding, self.cell.layout, self.speeds
            )
        return Terms(rod, contact, spacing, self.excess(state, curve), friction)

    def merit(self, terms: Terms, tension: Array) -> float:
        """Augmented Lagrangian, N·mm, with the given tensions (multipliers of constraints), N."""
        excess = terms.excess_mm
        return float(
            terms.energy
            + terms.spacing
            + terms.friction
            + dot(tension, excess)
            + 0.5 * self.penalty * dot(excess, excess)
        )

    def derivatives(
        self, state: Array, curve: Array, pairs: Pairs, start: Ints, tension: Array,
        *, hessian: bool = True, sparse: bool = False, lengths: bool = True,
    ) -> Slope:  # fmt: skip
        """Gradient and Hessian of the Lagrangian, ``merit`` without its penalty.

        A sparse Hessian leaves out slides, whose Hessians are dense. The gradients of the
        constraints are left out unless ``lengths``: a large sheet's are mostly zeros.
        """
        layout, law = self.cell.layout, self.contact_law
        pressed = on_halves(
            lambda of: contact_slopes(curve, state[-2], state[-1], of, layout, law),
            pairs, PAIRS_TO_SHARE,
        )  # fmt: skip
        force, by_speed = (sum_in_order(parts) for parts in zip(*pressed, strict=True))
        along = curve, self.rod_law, self.speeds, tension[self.stretch_of], by_speed
        if hessian:
            slopes, local = rod_hessian(*along)
        else:
            slopes = rod_slopes(*along)
        if self.sliding is not None:
            rubbing = curve, state[-2], state[-1], self.sliding, layout, self.speeds
            rubbed, by_d1 = friction_slopes(*rubbing)
            force += rubbed
            slopes[:, 0] += by_d1
        gradient = scatter_gradient(force, slopes, layout)
        gradient[-2:] += force[-1, :2]
        slides = np.array([slide.gradient(state) for slide in self.slides])
        rules = np.concatenate([self.held, slides.reshape(-1, len(gradient))])
        beside = len(self.prescribed_mm)
        gradient += times(rules.T, tension[beside:])
        rows = np.concatenate([self.length_gradients(curve), rules]) if lengths else rules[:0]
        if not hessian:
            return Slope(gradient, rows)
        size = self.cell.unknowns
        if sparse:
            at = laid_out(curve, layout.place, state[-2], state[-1])
            touching = touching_blocks(
                at, state[-2], state[-1], pairs, layout, BLOCK, 2.0 * law.radius
            )
            if self.sliding is not None:
                touching |= touching_blocks(
                    at, state[-2], state[-1], self.sliding.pairs, layout, BLOCK, np.inf
                )
            matrix = empty_tiles(touching, BLOCK, size - 2)
        else:
            matrix = one_tile(size)
        sizes, position, position_speed = contact_hessian(
            curve, state[-2], state[-1], pairs, start, layout, law, matrix.tiles, matrix.where
        )
        own = local, position, position_speed
        if self.sliding is not None:
            friction_hessian(*rubbing, *own, matrix.tiles, matrix.where, sizes)
        add_transposed(matrix.tiles, matrix.where)
        scatter_local(*own, layout, matrix.tiles, matrix.where, sizes)
        sizes[:, -2:] = 0.5 * (sizes[:, -2:] + sizes[:, -2:].T)
        if sparse:
            return Slope(gradient, rows, sparse=SparseHessian(touching, matrix, sizes))
        whole = matrix.tiles[0]
        whole[-2:] = sizes
        whole[:, -2:] = sizes.T
        for pull, slide in zip(tension[beside + len(self.held) :], self.slides, strict=True):
            whole += pull * slide.hessian()
        return Slope(gradient, rows, whole)

    def along_yarn(
        self, curve: Array, tension: Array, by_speed: Array
    ) -> tuple[float, float, Array]:
        """Rod and spacing energy, without contact, and their slopes (n, 3, 3) by d1, d2, d3.

        The slopes include the tensions and ``by_speed``, the slope of the contact by |d1|.
        """
        along = curve, self.rod_law, self.speeds
        rod, spacing = rod_energy(*along)
        return rod, spacing, rod_slopes(*along, tension[self.stretch_of], by_speed)

    def gathered(self, force: Array, slopes: Array) -> Array:
        """(unknowns,) gradient from slopes (n, 3) by the positions and (n, 3, 3) by d1, d2, d3."""
        return np.asarray(scatter_gradient(force, slopes, self.cell.layout))

    def length_gradients(self, curve: Array) -> Array:
        """(m, unknowns): gradient of each prescribed length."""
        cell, tangent = self.cell, self._tangent(curve)
        if self.per_stitch:
            own = self.stretch_of == np.arange(len(self.prescribed_mm))[:, None]
            return np.array([self._by_tangent(np.where(o[:, None], tangent, 0.0)) for o in own])
        every = self._by_tangent(tangent)
        rows = np.zeros((cell.rows, cell.unknowns))
        for row, dof, sign in zip(rows, cell.dof, cell.sign, strict=True):
            unknowns = dof[sign != 0.0]  # no unknown belongs to two courses
            row[unknowns] = every[unknowns]
        rows[:, -2] = tangent[:, 0].reshape(cell.rows, -1).sum(axis=1)
        return rows

    def pulled(self, curve: Array, pulls: Array) -> Array:
        """(unknowns,) gradient of the prescribed lengths, each times its pull (m,)."""
        return self._by_tangent(pulls[self.stretch_of, None] * self._tangent(curve))

    def _tangent(self, curve: Array) -> Array:
        """(rows * S, 3): gradient of the length of a sample by d1."""
        speed = np.linalg.norm(curve[:, 1], axis=1)[:, None]
        return np.asarray(curve[:, 1] / speed / self.cell.grid.samples)

    def _by_tangent(self, by_speed: Array) -> Array:
        """Gradient by the unknowns, given the slopes by d1."""
        slopes = np.zeros((len(by_speed), 3, 3))
        slopes[:, 0] = by_speed
        return self.gathered(np.zeros((len(by_speed), 3)), slopes)
