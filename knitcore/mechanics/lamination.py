"""Mixing orthotropic sheets: exact laminates, Voigt and Reuss bounds, and coarsening by lamination.

A laminate of sheets joined edge to edge has an exact effective stiffness: across the joints the
stress is common, along them the strain. Merging the cells of a grid pair by pair, once along x
first and once along y first, and taking the mean of the two (they are close bounds of a 2 x 2
checker) makes a large chart into a small grid of stiffnesses in milliseconds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array


@dataclass(frozen=True, eq=False)
class SheetGrid:
    """Symmetric orthotropic stiffnesses on a grid of cells, N/mm.

    Attributes
    ----------
    xxxx, yyyy, xxyy, xyxy : (rows, columns) components (xyxy for engineering shear).
    width_mm : (columns,) widths of the cells.
    height_mm : (rows,) heights of the cells.
    """

    xxxx: Array
    yyyy: Array
    xxyy: Array
    xyxy: Array
    width_mm: Array
    height_mm: Array

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        rows, columns = self.xxxx.shape
        return int(rows), int(columns)

    def stiffness(self) -> Array:
        """(rows, columns, 3, 3) matrices in the order xx, yy, xy."""
        full = np.zeros((*self.shape, 3, 3))
        full[..., 0, 0], full[..., 1, 1], full[..., 2, 2] = self.xxxx, self.yyyy, self.xyxy
        full[..., 0, 1] = full[..., 1, 0] = self.xxyy
        return full

    def voigt(self) -> Array:
        """Area-weighted mean stiffness (3, 3): an upper bound of the moduli."""
        mean: Array = np.einsum("rc,rcij->ij", self._area(), self.stiffness())
        return mean

    def reuss(self) -> Array:
        """Inverse of the area-weighted mean compliance (3, 3): a lower bound of the moduli."""
        determinant = self.xxxx * self.yyyy - self.xxyy**2
        compliance: Array = np.zeros((3, 3))
        compliance[0, 0] = (self._area() * self.yyyy / determinant).sum()
        compliance[1, 1] = (self._area() * self.xxxx / determinant).sum()
        compliance[0, 1] = compliance[1, 0] = -(self._area() * self.xxyy / determinant).sum()
        compliance[2, 2] = (self._area() / self.xyxy).sum()
        return np.asarray(np.linalg.inv(compliance), dtype=float)

    def _area(self) -> Array:
        area = np.outer(self.height_mm, self.width_mm)
        share: Array = area / area.sum()
        return share

    def transposed(self) -> SheetGrid:
        """The grid with x and y exchanged."""
        return SheetGrid(
            self.yyyy.T, self.xxxx.T, self.xxyy.T, self.xyxy.T, self.height_mm, self.width_mm
        )

    def merged_along_x(self) -> SheetGrid:
        """Neighbouring columns joined in pairs, as exact laminates; an odd last one is kept."""
        missing = self.shape[1] % 2
        width = np.append(self.width_mm, np.zeros(missing)).reshape(-1, 2)
        total = width.sum(axis=1)

        def pairs(values: Array) -> Array:
            padded = np.concatenate([values, values[:, -1:]], axis=1) if missing else values
            return padded.reshape(len(values), -1, 2)

        share = width / total[:, None]
        stiffness = laminated(pairs(self.xxxx), pairs(self.yyyy), pairs(self.xxyy), share)
        shear = 1.0 / (share / pairs(self.xyxy)).sum(axis=-1)
        return SheetGrid(*stiffness, shear, total, self.height_mm)

    def merged_along_y(self) -> SheetGrid:
        """Neighbouring rows joined in pairs."""
        return self.transposed().merged_along_x().transposed()


def laminated(
    across: Array, along: Array, coupling: Array, share: Array
) -> tuple[Array, Array, Array]:
    """Stiffnesses across and along the joints, and their coupling, of sheets joined edge to edge.

    Parameters
    ----------
    across, along, coupling : (..., sheets) stiffnesses, N/mm.
    share : (..., sheets) of the widths, across the joints.
    """
    crosswise = 1.0 / (share / across).sum(axis=-1)
    mixed = crosswise * (share * coupling / across).sum(axis=-1)
    lengthwise = (share * (along - coupling**2 / across)).sum(axis=-1) + mixed**2 / crosswise
    return crosswise, lengthwise, mixed


def coarsened(grid: SheetGrid, most_cells: int) -> SheetGrid:
    """The grid with cells merged until there are at most ``most_cells``."""
    while grid.xxxx.size > most_cells:
        rows, columns = grid.shape
        if columns > 2 * rows:
            grid = grid.merged_along_x()
        elif rows > 2 * columns:
            grid = grid.merged_along_y()
        else:
            grid = _mean(
                grid.merged_along_x().merged_along_y(), grid.merged_along_y().merged_along_x()
            )
    return grid


def _mean(first: SheetGrid, second: SheetGrid) -> SheetGrid:
    """Average two estimates; the geometric mean of the moduli keeps ratios unbiased."""

    def mean(a: Array, b: Array) -> Array:
        return np.sqrt(a * b)

    return SheetGrid(
        mean(first.xxxx, second.xxxx),
        mean(first.yyyy, second.yyyy),
        (first.xxyy + second.xxyy) / 2,
        mean(first.xyxy, second.xyxy),
        first.width_mm,
        first.height_mm,
    )
