"""Strain, stress and energy fields of a deformed sheet, at cells and at nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.cloth.flat.grid import QuarterGrid, sums_at_corners
from knitcore.cloth.flat.grid_sheet import Sheet, State
from knitcore.cloth.flat.sheet_models import EnergyModel
from knitcore.law.stiffening import CoupledStiffening, StiffeningForm, shear_response

_DIFFERENCES = np.array(
    [
        [[-1, 1, 0, 0, 0], [0, 1, 1, 0, -2], [0, 0, 1, -1, 0], [-1, 0, 0, -1, 2]],
        [[-1, -1, 0, 0, 2], [0, -1, 1, 0, 0], [0, 0, 1, 1, -2], [-1, 0, 0, 1, 0]],
    ],
    dtype=float,
)
"""Sums of a cell's corners and its centre that span it from side to side in each of its four
triangles, course-wise and wale-wise."""


@dataclass(frozen=True, eq=False)
class Fields:
    """Fields of one state on the corners of the cells; arrays (rows + 1, columns + 1), not a
    number (NaN) at corners without fabric.

    Attributes
    ----------
    x_mm, y_mm : rest positions;
    ux_mm, uy_mm : displacements.
    strain_xx, strain_yy, strain_xy : strains of the model. Of ``full``: elongations along course
        and wale and half the change of their angle; of ``published``: the linearised strain.
    principal_strain : (2, ...) larger and smaller principal value of the strain tensor.
    principal_angle : rad, direction of the larger one from the course direction.
    stress_xx, stress_yy, stress_xy : N/mm, force per rest width.
    energy_density : N·mm per mm² at rest.
    utilisation : alpha * strain, the larger of the two directions; 1 is the lock-up.
    """

    x_mm: Array
    y_mm: Array
    ux_mm: Array
    uy_mm: Array
    strain_xx: Array
    strain_yy: Array
    strain_xy: Array
    principal_strain: Array
    principal_angle: Array
    stress_xx: Array
    stress_yy: Array
    stress_xy: Array
    energy_density: Array
    utilisation: Array


@dataclass(frozen=True, eq=False)
class CellStrains:
    """Strains in the four triangles of every cell, (rows, columns, 4) each."""

    xx: Array
    yy: Array
    xy: Array

    @property
    def mean(self) -> tuple[Array, Array, Array]:
        """Cell means, (rows, columns) each."""
        return self.xx.mean(axis=2), self.yy.mean(axis=2), self.xy.mean(axis=2)


def cell_strains(sheet: Sheet, state: State) -> CellStrains:
    """Strains of the sheet's model in every triangle."""
    grid = sheet.grid
    strains = fibre_strains(sheet.model.energy, *_triangle_fibres(grid, state))
    return CellStrains(*(s.reshape(grid.rows, grid.columns, 4) for s in strains))


def strain_slopes(sheet: Sheet, state: State) -> scipy.sparse.csr_array:
    """Derivatives of the cells' mean strains, course-wise and then wale-wise, by the positions of
    all nodes, the corners first: (2 * cells, 2 * nodes).
    """
    grid = sheet.grid
    fibres = _triangle_fibres(grid, state)
    if sheet.model.energy is EnergyModel.PUBLISHED:
        units = [np.broadcast_to(unit, fibres[0].shape) for unit in np.eye(2)]
    else:
        units = [fibre / np.linalg.norm(fibre, axis=2, keepdims=True) for fibre in fibres]
    slopes = [
        (differences.T @ unit) / (4 * size.reshape(-1, 1, 1))
        for differences, unit, size in zip(_DIFFERENCES, units, grid.cell_size, strict=True)
    ]
    unknowns = (2 * _cell_nodes(grid)[:, :, None] + np.arange(2)).reshape(-1, 10)
    ends = np.arange(0, 2 * unknowns.size + 1, 10)
    columns = np.concatenate([unknowns, unknowns]).ravel()
    return scipy.sparse.csr_array((np.concatenate(slopes).ravel(), columns, ends))


def _triangle_fibres(grid: QuarterGrid, state: State) -> tuple[Array, Array]:
    """Images (cells, 4, 2) of the unit vectors along course and wale in every triangle."""
    nodes = np.concatenate(state)[_cell_nodes(grid)]
    course, wale = (differences @ nodes for differences in _DIFFERENCES)
    width, height = (size.reshape(-1, 1, 1) for size in grid.cell_size)
    return course / width, wale / height


def _cell_nodes(grid: QuarterGrid) -> NDArray[np.int64]:
    """Numbers (cells, 5) of each cell's corners and centre; centres follow all corners."""
    centres = len(grid.corners) + np.arange(len(grid.centres))
    return np.column_stack([grid.cell_corners, centres])


def fibre_strains(energy: EnergyModel, a: Array, b: Array) -> tuple[Array, Array, Array]:
    """Strains xx, yy and xy of a model, given the images (..., 2) of the unit vectors along course
    and wale.
    """
    if energy is EnergyModel.PUBLISHED:
        return a[..., 0] - 1, b[..., 1] - 1, (a[..., 1] + b[..., 0]) / 2
    dot = np.sum(a * b, axis=-1)
    cross = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return (
        np.asarray(np.linalg.norm(a, axis=-1) - 1),
        np.asarray(np.linalg.norm(b, axis=-1) - 1),
        np.arctan2(dot, cross) / 2,
    )


def utilisation(sheet: Sheet, strains: CellStrains) -> Array:
    """alpha * strain of every cell and direction, (2, rows, columns); 0 without fabric."""
    return np.asarray(triangle_utilisation(sheet, strains).mean(axis=3))


def triangle_utilisation(sheet: Sheet, strains: CellStrains) -> Array:
    """alpha * strain of every triangle and direction, (2, rows, columns, 4)."""
    form = StiffeningForm(sheet.model.energy.value)
    codes = sheet.grid.law_of_cell[..., None]
    used = np.stack(stiffening_of(sheet, codes).arguments(strains.xx, strains.yy, form))
    return np.where(sheet.grid.cloth[..., None], used, 0.0)


def stiffening_of(sheet: Sheet, codes: NDArray[np.integer]) -> CoupledStiffening:
    """The stiffening of the laws with these codes (an array of any shape)."""
    names = ("alpha_xx", "alpha_yy", "beta_xx", "beta_yy", "kappa_xx", "kappa_yy")
    return CoupledStiffening(*(sheet.parameters[name][codes] for name in names))


def node_fields(sheet: Sheet, state: State) -> Fields:
    """All fields at the corners: means over the cells that meet there, weighted by rest area."""
    grid = sheet.grid
    strains = cell_strains(sheet, state)
    cells = {"strain_xx": strains.mean[0], "strain_yy": strains.mean[1]}
    cells["strain_xy"] = strains.mean[2]
    cells |= response(sheet, grid.law_of_cell, *strains.mean)
    cells["utilisation"] = utilisation(sheet, strains).max(axis=0)
    nodes = {name: corner_means(grid, value) for name, value in cells.items()}
    xx, yy, xy = nodes["strain_xx"], nodes["strain_yy"], nodes["strain_xy"]
    middle, radius = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    shape = xx.shape
    moved = np.where(grid.used_corners[:, None], state.corners - grid.corners, np.nan)
    return Fields(
        x_mm=grid.corners[:, 0].reshape(shape),
        y_mm=grid.corners[:, 1].reshape(shape),
        ux_mm=moved[:, 0].reshape(shape),
        uy_mm=moved[:, 1].reshape(shape),
        principal_strain=np.stack([middle + radius, middle - radius]),
        principal_angle=np.arctan2(2 * xy, xx - yy) / 2,
        **nodes,
    )


def response(
    sheet: Sheet, codes: NDArray[np.integer], xx: Array, yy: Array, xy: Array
) -> dict[str, Array]:
    """Stresses and energy density at strains, by the codes of the laws (wrinkling not considered);
    arrays of one shape.
    """
    stiff = stiffening_of(sheet, codes).response(xx, yy, StiffeningForm(sheet.model.energy.value))
    laws = sheet.parameters[codes]
    coupling = laws["stiffness_xxyy"]
    full = sheet.model.energy is EnergyModel.FULL
    growth = laws["shear_stiffening"] if full else 0.0
    sheared, stress_xy, _ = shear_response(2 * xy, laws["shear_modulus"], growth)
    linear_x = laws["stiffness_xxxx"] * xx + coupling * yy
    linear_y = laws["stiffness_yyyy"] * yy + coupling * xx
    return {
        "stress_xx": linear_x + stiff.stress_xx,
        "stress_yy": linear_y + stiff.stress_yy,
        "stress_xy": stress_xy,
        "energy_density": (xx * linear_x + yy * linear_y) / 2 + sheared + stiff.energy,
    }


def corner_means(grid: QuarterGrid, cells: Array) -> Array:
    """Means (rows + 1, columns + 1) of the fabric's cells that meet at each corner, weighted by
    rest area; NaN where there is none.
    """
    with np.errstate(invalid="ignore"):
        return np.asarray(sums_at_corners(grid.cell_area * cells) / grid.corner_area)
