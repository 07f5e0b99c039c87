"""Periodic homogenisation of a chart's quarter grid: the effective law of a repeat.

The displacement is u = E x + v with v periodic. With T = [periodic shape functions | affine fields
of E_xx, E_yy, E_xy], the stiffness in these unknowns is T^T K T, and condensing the periodic part
out of it leaves area times the effective stiffness. Each quarter cell is one biquadratic element.

Every phase keeps its own law and relaxed size; where quarters of different phases meet in one
column (row) of the grid, the column takes their mean width (the row their mean height). The laws
are symmetrised geometrically, which keeps both Young's moduli of every phase; the ratio of the two
Poisson ratios is restored from the phases' own at the end.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.chart.fabric import PHASES, Direction
from knitcore.chart.phases import quarter_phases
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart, as_chart
from knitcore.materials import Material, as_material
from knitcore.mechanics.lamination import SheetGrid, coarsened

MAX_CELLS = 1024
"""Quarter cells solved as they are: a repeat of 16 x 16. Larger grids are first coarsened."""


@dataclass(frozen=True, eq=False)
class PhaseGrid:
    """The quarter grid of a chart in one material.

    Attributes
    ----------
    phases : uint8 (2 rows, 2 columns), phase codes.
    width_mm, height_mm : relaxed sizes of the grid's columns and rows.
    """

    phases: NDArray[np.uint8]
    width_mm: Array
    height_mm: Array

    @property
    def shares(self) -> Array:
        """(4,) area shares of the phases."""
        area = np.outer(self.height_mm, self.width_mm)
        total = np.bincount(self.phases.ravel(), weights=area.ravel(), minlength=4)
        shares: Array = total / total.sum()
        return shares


@dataclass(frozen=True, eq=False, repr=False)
class EffectiveSheet(Result):
    """Effective linear constants of a chart, small strain.

    Attributes
    ----------
    stiffness_n_per_mm : (3, 3), order xx, yy, xy (engineering shear). Symmetric; charts without a
        mirror axis couple stretch and shear.
    voigt_n_per_mm, reuss_n_per_mm : (3, 3), bounds of it.
    poisson_yx, poisson_xy : with the phases' own asymmetry restored.
    """

    stiffness_n_per_mm: Array
    voigt_n_per_mm: Array
    reuss_n_per_mm: Array
    poisson_yx: float
    poisson_xy: float

    def modulus_n_per_mm(self, direction: Direction) -> float:
        """Young's modulus with the transverse direction and shear free."""
        return modulus_of(self.stiffness_n_per_mm, direction)

    @property
    def shear_modulus_n_per_mm(self) -> float:
        """Shear modulus with the stretches free."""
        return float(1.0 / np.linalg.inv(self.stiffness_n_per_mm)[2, 2])

    def bounds_n_per_mm(self, direction: Direction) -> tuple[float, float]:
        """Reuss and Voigt bounds of Young's modulus."""
        return modulus_of(self.reuss_n_per_mm, direction), modulus_of(
            self.voigt_n_per_mm, direction
        )


def modulus_of(stiffness: Array, direction: Direction) -> float:
    """Young's modulus (N/mm) of a (3, 3) stiffness in a direction."""
    return float(1.0 / np.linalg.inv(stiffness)[direction.axis, direction.axis])


def phase_grid(chart: StitchChart, material: Material) -> PhaseGrid:
    """The quarter grid of a chart that repeats.

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.
    """
    phases = quarter_phases(chart, periodic=True)
    width, height = np.zeros(4), np.zeros(4)
    for phase in np.unique(phases):
        record = material.record(PHASES[phase])
        width[phase], height[phase] = record.stitch_course_mm / 2, record.stitch_wale_mm / 2
    return PhaseGrid(phases, width[phases].mean(axis=0), height[phases].mean(axis=1))


def homogenise(
    chart: StitchChart | str, material: Material | str, *, most_cells: int = MAX_CELLS
) -> EffectiveSheet:
    """Effective linear constants of a chart that repeats indefinitely.

    Parameters
    ----------
    chart : one repeat.
    material : laws and relaxed sizes of the phases.
    most_cells : grids with more quarter cells are coarsened by lamination first: exact for layers
        and inside large patches, in random charts up to 7 % off (one level) to 28 % (three).

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> sheet = homogenise(StitchChart.parse("KKPP"), material("acrylic"))
    >>> round(sheet.modulus_n_per_mm(Direction.COURSE), 4)
    0.0301
    """
    chart, material = as_chart(chart), as_material(material)
    grid = phase_grid(chart, material)
    fine = _sheet_grid(grid, material)
    stiffness = _solve(coarsened(fine, most_cells))
    nu_yx, nu_xy = _poisson(stiffness, grid, material)
    return EffectiveSheet(stiffness, fine.voigt(), fine.reuss(), nu_yx, nu_xy)


def _sheet_grid(grid: PhaseGrid, material: Material) -> SheetGrid:
    constants = np.ones((4, 4))
    for phase in np.unique(grid.phases):
        law = material.law(PHASES[phase]).symmetrised()
        constants[:, phase] = (
            law.stiffness_xxxx,
            law.stiffness_yyyy,
            law.stiffness_xxyy,
            law.shear_modulus,
        )
    xxxx, yyyy, xxyy, xyxy = (row[grid.phases] for row in constants)
    return SheetGrid(xxxx, yyyy, xxyy, xyxy, grid.width_mm, grid.height_mm)


def _stiffness_density(u: Any, v: Any, w: Any) -> Any:
    """Virtual work of an orthotropic sheet; its constants are fields at the quadrature points."""
    shear = u.grad[0, 1] + u.grad[1, 0]
    return (
        (w.xxxx * u.grad[0, 0] + w.xxyy * u.grad[1, 1]) * v.grad[0, 0]
        + (w.xxyy * u.grad[0, 0] + w.yyyy * u.grad[1, 1]) * v.grad[1, 1]
        + w.xyxy * shear * (v.grad[0, 1] + v.grad[1, 0])
    )


class _PeriodicMesh:
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
        import skfem  # slow to import

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
        shape = scipy.sparse.csr_matrix((np.ones(size), (np.arange(size), periodic.ravel())))
        self.map = scipy.sparse.hstack([shape, scipy.sparse.csr_matrix(affine)]).tocsr()
        held = [periodic.ravel()[np.flatnonzero(component == c)[0]] for c in (0, 1)]
        self.free = np.setdiff1d(np.arange(count), held)
        self.macro = np.arange(count, count + 3)


def _solve(grid: SheetGrid) -> Array:
    """Effective stiffness (3, 3)."""
    import skfem

    mesh = _PeriodicMesh(grid.width_mm, grid.height_mm)
    fields = {
        name: mesh.cell_field(getattr(grid, name)) for name in ("xxxx", "yyyy", "xxyy", "xyxy")
    }
    form = skfem.BilinearForm(_stiffness_density)
    full = form.assemble(mesh.basis, **fields)
    reduced = (mesh.map.T @ full @ mesh.map).tocsc()
    free, macro = mesh.free, mesh.macro
    coupling = reduced[free][:, macro].toarray()
    factor = scipy.sparse.linalg.splu(
        reduced[free][:, free].tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    response = -factor.solve(coupling)
    condensed = reduced[macro][:, macro].toarray() + coupling.T @ response
    return np.asarray((condensed + condensed.T) / (2 * mesh.area_mm2))


def poisson_asymmetry(grid: PhaseGrid, material: Material) -> float:
    """sqrt(C_yyxx / C_xxyy) of a composite: the area-weighted geometric mean of its phases.

    Multiplying a symmetric law's Poisson ratio nu_yx by it and dividing nu_xy restores the
    measured asymmetry; pure fabrics get their own ratios back exactly.
    """
    logarithm = 0.0
    for phase in np.unique(grid.phases):
        law = material.law(PHASES[phase])
        if law.stiffness_xxyy != 0:
            ratio = law.stiffness_yyxx / law.stiffness_xxyy
            logarithm += float(grid.shares[phase]) * math.log(ratio)
    return math.exp(logarithm / 2)


def _poisson(stiffness: Array, grid: PhaseGrid, material: Material) -> tuple[float, float]:
    compliance = np.linalg.inv(stiffness)
    root = poisson_asymmetry(grid, material)
    nu_yx = -float(compliance[1, 0] / compliance[0, 0])
    nu_xy = -float(compliance[0, 1] / compliance[1, 1])
    return nu_yx * root, nu_xy / root
