"""A sheet: a grid, its laws and an energy model, with energy, forces and tangent at any state."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from numpy.typing import NDArray

from knitcore.errors import InputError
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.swatch import kernel
from knitcore.swatch.grid import QuarterGrid
from knitcore.swatch.models import SheetModel

Array = NDArray[np.float64]

_NO_TANGENT = np.empty((0, 8, 8)), np.empty((0, 2, 8)), np.empty((0, 3))


@dataclass(frozen=True, eq=False)
class State:
    """Positions (mm) of a sheet's nodes: corners (n, 2) and cell centres (cells, 2)."""

    corners: Array
    centres: Array

    def moved(self, corner_step: Array, centre_step: Array, share: float = 1.0) -> State:
        """The state after a share of a step."""
        return State(self.corners + share * corner_step, self.centres + share * centre_step)


@dataclass(frozen=True, eq=False)
class Linearisation:
    """Energy, forces and tangent of a sheet in one state.

    Attributes
    ----------
    energy : N·mm.
    corner_force, centre_force : N, gradient of the energy, (corners, 2) and (cells, 2).
    matrix : N/mm, (cells, 8, 8), tangents of the cells with their centres eliminated.
    centre_rows, centre_inverse : what recovers the centres; see :mod:`knitcore.swatch.kernel`.
    columns : of the grid.
    """

    energy: float
    corner_force: Array
    centre_force: Array
    matrix: Array
    centre_rows: Array
    centre_inverse: Array
    columns: int

    def with_force(self, corner_force: Array, centre_force: Array) -> Linearisation:
        """The same tangent beside other forces."""
        return replace(self, corner_force=corner_force, centre_force=centre_force)

    def condensed_force(self) -> Array:
        """Gradient on the corners (corners, 2) with the centres in balance to first order."""
        return np.asarray(
            kernel.condense(
                self.columns,
                self.corner_force,
                self.centre_force,
                self.centre_rows,
                self.centre_inverse,
            )
        )

    def centre_step(self, corner_step: Array) -> Array:
        """Newton step of the centres (cells, 2) that goes with a step of the corners."""
        return np.asarray(
            kernel.centre_step(
                self.columns, corner_step, self.centre_force, self.centre_rows, self.centre_inverse
            )
        )

    def apply(self, corner_step: Array) -> Array:
        """Condensed tangent times a step of the corners, (corners, 2)."""
        out = np.zeros_like(corner_step)
        _apply(self.matrix, self.columns, corner_step, out)
        return out


class Sheet:
    """A sheet with one law per law code of its grid.

    Parameters
    ----------
    grid : the mesh.
    laws : laws by code (``grid.law_of_cell``); codes that do not occur may repeat any law.
    model : the energy model and its assumptions.
    stress_log_sd : (2, stresses) how unsure the laws of a chart's cells are beside their materials,
        as :class:`knitcore.answer.quarter_laws.QuarterLaws` has it; None where they are not.

    Examples
    --------
    >>> law = ConstitutiveLaw(0.241, 0.060, 0.036, 0.029, 1.17, 0.802, 0.022, 0.022)
    >>> sheet = Sheet(QuarterGrid.uniform(4, 4, 10.0, 10.0), [law], SheetModel())
    >>> sheet.energy(sheet.reference)
    0.0
    """

    def __init__(
        self,
        grid: QuarterGrid,
        laws: Sequence[ConstitutiveLaw],
        model: SheetModel,
        stress_log_sd: Array | None = None,
    ) -> None:
        if int(grid.law_of_cell.max()) >= len(laws):
            raise InputError("laws", "a cell has no law.", "Give a law for every code of the grid.")
        self.grid = grid
        self.model = model
        self.stress_log_sd = stress_log_sd
        self.laws = tuple(model.prepare(law) for law in laws)
        self.parameters = model.parameters(laws)
        self._law_of_cell = grid.law_of_cell.ravel()
        self._cloth = grid.cloth.ravel()
        self._width = grid.natural_width.ravel()
        self._height = grid.natural_height.ravel()

    def with_grid(self, grid: QuarterGrid) -> Sheet:
        """A sheet of the same laws and model on another grid."""
        return Sheet(grid, self.laws, self.model, self.stress_log_sd)

    def with_model(self, model: SheetModel) -> Sheet:
        """The same grid and laws (symmetric already) under another model."""
        return Sheet(self.grid, self.laws, model, self.stress_log_sd)

    @property
    def at_rest(self) -> Sheet:
        """The same sheet without misfit of gauges: stable as laid out."""
        return self.with_grid(self.grid.at_rest_as_laid_out)

    @property
    def reference(self) -> State:
        """The nodes as laid out."""
        return State(self.grid.corners.copy(), self.grid.centres.copy())

    def energy(self, state: State) -> float:
        """Stored energy, N·mm."""
        forces = np.empty_like(state.corners), np.empty_like(state.centres)
        return self._assemble(self.parameters, state, *forces, *_NO_TANGENT)

    def law_force(self, laws: Array, state: State) -> tuple[Array, Array]:
        """Force (N) on corners (corners, 2) and centres (cells, 2) that other laws would make.

        Parameters
        ----------
        laws : (laws, 11), kernel parameters as :meth:`SheetModel.parameters` gives them.
        state : positions.
        """
        forces = np.empty_like(state.corners), np.empty_like(state.centres)
        self._assemble(laws, state, *forces, *_NO_TANGENT)
        return forces

    def strain_change(self, state: State, corner_step: Array, centre_step: Array) -> Array:
        """Change of the cells' mean strains (2, rows, columns), course and wale, to first order in
        a step of the nodes.
        """
        change = kernel.strain_change(
            self.model.energy.code,
            self._cloth,
            self.grid.columns,
            self._width,
            self._height,
            state.corners,
            state.centres,
            corner_step,
            centre_step,
        )
        return np.asarray(change.reshape(2, self.grid.rows, self.grid.columns))

    def linearise(self, state: State, reuse: Linearisation | None = None) -> Linearisation:
        """Energy, forces and tangent; ``reuse`` gives its arrays away."""
        corners, cells = len(state.corners), len(state.centres)
        if reuse is None:
            arrays = (
                np.empty((corners, 2)),
                np.empty((cells, 2)),
                np.empty((cells, 8, 8)),
                np.empty((cells, 2, 8)),
                np.empty((cells, 3)),
            )
        else:
            arrays = (
                reuse.corner_force,
                reuse.centre_force,
                reuse.matrix,
                reuse.centre_rows,
                reuse.centre_inverse,
            )
        energy = self._assemble(self.parameters, state, *arrays)
        return Linearisation(energy, *arrays, columns=self.grid.columns)

    def _assemble(self, laws: Array, state: State, *arrays: Array) -> float:
        return float(
            kernel.assemble(
                self.model.energy.code,
                laws,
                self._law_of_cell,
                self._cloth,
                self.grid.columns,
                self._width,
                self._height,
                state.corners,
                state.centres,
                *arrays,
            )
        )


@njit(cache=True)
def _apply(matrix: Array, columns: int, step: Array, out: Array) -> None:
    v = np.empty(8)
    for cell in range(matrix.shape[0]):
        first = cell // columns * (columns + 1) + cell % columns
        nodes = (first, first + 1, first + columns + 2, first + columns + 1)
        for i in range(4):
            v[2 * i], v[2 * i + 1] = step[nodes[i], 0], step[nodes[i], 1]
        for i in range(4):
            s0 = s1 = 0.0
            for j in range(8):
                s0 += matrix[cell, 2 * i, j] * v[j]
                s1 += matrix[cell, 2 * i + 1, j] * v[j]
            out[nodes[i], 0] += s0
            out[nodes[i], 1] += s1
