"""A periodic mesh of a grid of rectangular cells, and its unknowns."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
import skfem

from knitcore.base.arrays import Array


class PeriodicMesh:
    """Biquadratic elements on a rectangular grid, with the map to periodic and macro unknowns.

    Parameters
    ----------
    width_mm, height_mm : sizes of the grid's columns and rows.

    Attributes
    ----------
    basis : scikit-fem basis of the displacement.
    map : (dofs, unknowns) matrix T; the last three unknowns are E_xx, E_yy and the engineering
        shear.
    free, macro : indices of the periodic unknowns (one node held) and of the macro strains.
    """

    def __init__(self, width_mm: Array, height_mm: Array) -> None:
        self._x: Array = np.concatenate([[0.0], np.cumsum(width_mm)])
        self._y: Array = np.concatenate([[0.0], np.cumsum(height_mm)])
        mesh = skfem.MeshQuad.init_tensor(self._x, self._y)
        # Three Gauss points a side are exact for the work of biquadratic shapes on rectangles.
        self.basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad2()), intorder=5)
        centre = mesh.p[:, mesh.t].mean(axis=1)
        self._row = np.searchsorted(self._y, centre[1]) - 1
        self._column = np.searchsorted(self._x, centre[0]) - 1
        self._set_map()

    @property
    def area_mm2(self) -> float:
        """Area of the cell."""
        return float(self._x[-1] * self._y[-1])

    def cell_field(self, values: Array) -> Array:
        """Values by grid cell, as a field at the quadrature points."""
        by_element = values[self._row, self._column]
        return np.repeat(by_element[:, None], self.basis.dx.shape[1], axis=1)

    def _set_map(self) -> None:
        x, y = self.basis.doflocs
        size = self.basis.N
        component = np.empty(size, dtype=int)
        dofs = self.basis.dofs
        for group in (dofs.nodal_dofs, dofs.facet_dofs, dofs.interior_dofs):
            component[group[0::2]], component[group[1::2]] = 0, 1
        tolerance = 1e-9
        wrapped = [
            np.where(where > end * (1 - tolerance), 0.0, where) / end
            for where, end in ((x, self._x[-1]), (y, self._y[-1]))
        ]
        keys = np.round(np.column_stack([*wrapped, component]) / tolerance).astype(np.int64)
        _, first, periodic = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        count = len(first)
        affine = np.zeros((size, 3))
        along_x, along_y = component == 0, component == 1
        affine[along_x, 0], affine[along_y, 1] = x[along_x], y[along_y]
        affine[along_x, 2], affine[along_y, 2] = y[along_x] / 2, x[along_y] / 2
        shape = sp.csr_matrix((np.ones(size), (np.arange(size), periodic.ravel())))
        self.map = sp.hstack([shape, sp.csr_matrix(affine)]).tocsr()
        held = [periodic.ravel()[np.flatnonzero(component == c)[0]] for c in (0, 1)]
        self.free = np.setdiff1d(np.arange(count), held)
        self.macro = np.arange(count, count + 3)
