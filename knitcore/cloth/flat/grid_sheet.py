"""A sheet: a grid, its laws and an energy model, with energy, forces and tangent at any state."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.base.threads import side_by_side
from knitcore.cloth.flat import grid_kernel as kernel
from knitcore.cloth.flat.grid import QuarterGrid
from knitcore.cloth.flat.grid_kernel import Cells, CellTangents, Nodes
from knitcore.cloth.flat.sheet_models import EnergyModel, SheetModel
from knitcore.law.constitutive import ConstitutiveLaw

SIDE_BY_SIDE = 5_000
"""Fewest cells that are assembled in two threads."""


class State(Nodes):
    """Positions (mm) of a sheet's nodes."""

    def moved(self, step: Nodes, share: float = 1.0) -> State:
        """The state after a share of a step."""
        return State(self.corners + share * step.corners, self.centres + share * step.centres)


@dataclass(frozen=True, eq=False)
class Linearisation:
    """Energy, forces and tangent of a sheet in one state.

    Attributes
    ----------
    energy : N·mm.
    force : N, gradient of the energy.
    tangent : of the cells, their centres eliminated.
    columns : of the grid.
    """

    energy: float
    force: Nodes
    tangent: CellTangents
    columns: int

    def condensed_force(self) -> Array:
        """Gradient on the corners (corners, 2) with the centres in balance to first order."""
        return np.asarray(kernel.condense(self.columns, self.force, self.tangent))

    def newton_step(self, corners: Array) -> Nodes:
        """Newton's step of all nodes, given that of the corners (corners, 2)."""
        return Nodes(corners, kernel.centre_step(self.columns, corners, self.force, self.tangent))

    def apply(self, corner_step: Array) -> Array:
        """Condensed tangent times a step of the corners, (corners, 2)."""
        return np.asarray(kernel.apply(self.columns, self.tangent, corner_step))


class Sheet:
    """A sheet with one law per law code of its grid, or a mixture of laws.

    Parameters
    ----------
    grid : the mesh.
    laws : laws by code (``grid.law_of_cell``); codes that do not occur may repeat any law.
    model : the energy model and its assumptions.
    mixing : (codes, laws) shares of the laws in the constants of each code, if laws are mixed.
    log_sd : gives :attr:`stress_log_sd`, as in
        :class:`knitcore.prediction.quarter_laws.QuarterLaws`.
    quarters : the quarters that the cells stand for, where a cell holds several.
    block : stitches a side of the blocks of which a cell is a quarter.

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
        mixing: scipy.sparse.csr_array | None = None,
        log_sd: Callable[[], Array] | None = None,
        quarters: QuarterGrid | None = None,
        block: int = 1,
    ) -> None:
        codes = len(laws) if mixing is None else mixing.shape[0]
        if int(grid.law_of_cell.max()) >= codes:
            raise InputError("laws", "a cell has no law.", "Give a law for every code of the grid.")
        self.grid = grid
        self.quarters = quarters or grid
        self.block = block
        self.model = model
        self._log_sd = log_sd
        self._mixing = mixing
        self.laws = tuple(model.prepare(law) for law in laws)
        self.parameters = self.by_code(model.parameters(laws))
        self._cells = Cells(
            columns=grid.columns,
            law=grid.law_of_cell.ravel().astype(np.int32),
            cloth=grid.cloth.ravel(),
            width=grid.cell_size[0].ravel(),
            height=grid.cell_size[1].ravel(),
            published=model.energy is EnergyModel.PUBLISHED,
        )

    @cached_property
    def stress_log_sd(self) -> Array | None:
        """Model error of the laws of a chart's cells, (2, stresses), beyond the uncertainty of
        their material; None where there is none.
        """
        return None if self._log_sd is None else self._log_sd()

    @property
    def reference(self) -> State:
        """The nodes as laid out."""
        return State(self.grid.corners.copy(), self.grid.centres.copy())

    def by_code(self, laws: NDArray[np.void]) -> NDArray[np.void]:
        """Records of the sheet's codes from those of its laws, mixed where the sheet mixes them.

        Means of cube roots lie between laws in series and side by side, and keep signs and
        stability.
        """
        if self._mixing is None:
            return laws
        roots = np.cbrt(laws.view(float).reshape(len(laws), -1))
        return np.ascontiguousarray((self._mixing @ roots) ** 3).view(laws.dtype).ravel()

    def energy(self, state: State) -> float:
        """Stored energy, N·mm."""
        return self._assemble(self.parameters, state, _empty_like(state), None)

    def law_force(self, laws: NDArray[np.void], state: State) -> Nodes:
        """Force (N) under other laws.

        Parameters
        ----------
        laws : (codes,), as :meth:`by_code` gives them; all 0 for no law.
        state : positions.
        """
        force = _empty_like(state)
        self._assemble(laws, state, force, None)
        return force

    def linearise(self, state: State, reuse: Linearisation | None = None) -> Linearisation:
        """Energy, forces and tangent; the arrays of ``reuse`` are overwritten."""
        if reuse is None:
            cells = len(state.centres)
            force, tangent = (
                _empty_like(state),
                CellTangents(np.empty((cells, 36)), np.empty((cells, 2, 8)), np.empty((cells, 3))),
            )
        else:
            force, tangent = reuse.force, reuse.tangent
        energy = self._assemble(self.parameters, state, force, tangent)
        return Linearisation(energy, force, tangent, self.grid.columns)

    def _assemble(
        self, laws: NDArray[np.void], state: State, force: Nodes, tangent: CellTangents | None
    ) -> float:
        count = len(state.centres)

        def assemble(to: Nodes, first: int, last: int) -> float:
            to.corners[:] = 0.0
            return float(kernel.assemble(self._cells, laws, state, to, tangent, first, last))

        if count < SIDE_BY_SIDE:
            return assemble(force, 0, count)
        # both halves add to the corners between them, so each has an array of its own
        other = Nodes(np.empty_like(force.corners), force.centres)
        lower, upper = side_by_side(
            lambda: assemble(force, 0, count // 2), lambda: assemble(other, count // 2, count)
        )
        force.corners[:] += other.corners
        return lower + upper


def _empty_like(nodes: Nodes) -> Nodes:
    return Nodes(np.empty_like(nodes.corners), np.empty_like(nodes.centres))
