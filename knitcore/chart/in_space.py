"""Cloth in space: results that other programs can show."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Mask
from knitcore.base.errors import InputError
from knitcore.chart.result import Result


def corners_of(stitches: Mask) -> Mask:
    """Mask (rows + 1, columns + 1) of the corners that stitches (rows, columns) have."""
    around = np.pad(stitches, 1)
    return np.asarray(around[1:, 1:] | around[1:, :-1] | around[:-1, 1:] | around[:-1, :-1])


class ClothInSpace(Result):
    """A grid of stitches, or of other rectangles of cloth, in space.

    Attributes
    ----------
    corners_mm : (rows + 1, columns + 1, 3), without meaning where there is no cloth.
    """

    corners_mm: NDArray[np.floating]

    @property
    def cloth(self) -> Mask:
        """Mask (rows, columns) of the rectangles that are cloth.

        They are the result's ``stitches``, or else those all of whose corners are numbers.
        """
        stitches: Mask | None = getattr(self, "stitches", None)
        if stitches is not None:
            return stitches
        known = np.asarray(np.isfinite(self.corners_mm).all(axis=-1))
        return np.asarray(known[1:, 1:] & known[1:, :-1] & known[:-1, 1:] & known[:-1, :-1])

    @property
    def used(self) -> Mask:
        """Mask (rows + 1, columns + 1) of the corners that cloth has."""
        return corners_of(self.cloth)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Collect the shape as arrays.

        ``corners_mm`` is NaN where there is no cloth; ``stitch``, (rows, columns), says where there
        is.
        """
        corners = np.where(self.used[..., None], self.corners_mm, np.nan)
        return {"corners_mm": corners, "stitch": self.cloth}

    def write(self, path: Path | str) -> None:
        """Write by the file's suffix: ``.npz`` (:meth:`arrays`) or ``.vtu``.

        The latter has the stitches as quadrilaterals in space, with the arrays that have a value
        for each of them.

        Raises
        ------
        InputError
            If the suffix is neither of these.
        """
        target = Path(path)
        arrays = self.arrays()
        if target.suffix.lower() == ".npz":
            np.savez_compressed(target, allow_pickle=False, **arrays)
        elif target.suffix.lower() == ".vtu":
            import meshio

            cloth = arrays.pop("stitch")
            corner = np.arange(self.used.size).reshape(self.used.shape)
            around = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
            of_cells = {name: a[cloth] for name, a in arrays.items() if a.shape == cloth.shape}
            meshio.Mesh(
                np.nan_to_num(arrays["corners_mm"]).reshape(-1, 3),
                [("quad", np.stack(around, axis=-1)[cloth])],
                cell_data={
                    name: [a.astype(np.int8) if a.dtype == bool else a]
                    for name, a in of_cells.items()
                },
            ).write(target, file_format="vtu")
        else:
            raise InputError("out", f"{target.name} has an unknown suffix.", "Use .npz or .vtu.")
