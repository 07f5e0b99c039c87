"""Writing the fields of a test to files: NumPy archives and VTU for ParaView."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from knitcore.base.errors import InputError
from knitcore.chart.fabric import PHASES
from knitcore.cloth.flat.strip_results import StripTest, SwatchTest

SUFFIXES = (".npz", ".vtu")


def write_fields(test: SwatchTest, path: Path | str) -> None:
    """Write by the file's suffix: ``.npz`` (all steps) or ``.vtu`` (the last step).

    Raises
    ------
    InputError
        If the suffix is neither of these, or there is no step to write.
    """
    target = Path(path)
    suffix = target.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError("out", f"{target.name} has an unknown suffix.", "Use .npz or .vtu.")
    if suffix == ".npz":
        _write_npz(test, target)
    else:
        _write_vtu(test, target)


def _write_npz(test: SwatchTest, path: Path) -> None:
    """Write all steps at the nodes.

    ``x_mm``, ``y_mm`` (rows + 1, columns + 1) are rest positions; ``ux_mm``, ``uy_mm``,
    ``strain_xx``, ``strain_yy``, ``strain_xy``, ``energy_density``, ``utilisation`` (steps,
    rows + 1, columns + 1). A strip test adds ``strain``, ``force_n``, ``stress_n_per_mm`` and
    ``waist_strain`` (steps,).
    """
    names = ("strain_xx", "strain_yy", "strain_xy", "energy_density", "utilisation")
    steps = [test.fields(step) for step in range(test.steps)]
    shape = (0, *test.x_mm.shape)
    arrays = {
        name: np.array([getattr(step, name) for step in steps]) if steps else np.empty(shape)
        for name in names
    }
    arrays |= {name: getattr(test, name) for name in ("x_mm", "y_mm", "ux_mm", "uy_mm")}
    if isinstance(test, StripTest):
        for name in ("strain", "force_n", "stress_n_per_mm", "waist_strain"):
            arrays[name] = getattr(test, name)
    # the stub of savez_compressed takes keywords for its own option
    np.savez_compressed(path, allow_pickle=False, **arrays)


def _write_vtu(test: SwatchTest, path: Path) -> None:
    """Write the last step on the rest shape: quarter cells as quadrilaterals, to be warped by
    ``displacement_mm``.

    Cells without fabric are left out.

    Raises
    ------
    InputError
        If no step converged.
    """
    import meshio

    if test.steps == 0:
        raise InputError("out", "no step converged, so there is no field.", "Use a smaller strain.")
    fields = test.fields(-1)
    grid = test.sheet.grid
    used, cloth = grid.used_corners, grid.cloth.ravel()
    flat = np.zeros(fields.x_mm.size)

    def column(*parts: np.ndarray) -> np.ndarray:
        return np.column_stack([np.asarray(part).ravel()[used] for part in parts])

    larger, smaller = fields.principal_strain
    meshio.Mesh(
        points=column(fields.x_mm, fields.y_mm, flat),
        cells=[("quad", (np.cumsum(used) - 1)[grid.cell_corners[cloth]])],
        point_data={
            "displacement_mm": column(fields.ux_mm, fields.uy_mm, flat),
            "strain_xx_yy_xy": column(fields.strain_xx, fields.strain_yy, fields.strain_xy),
            "principal_strain": column(larger, smaller),
            "principal_direction": column(
                np.cos(fields.principal_angle), np.sin(fields.principal_angle), flat
            ),
            "stress_xx_yy_xy_n_per_mm": column(
                fields.stress_xx, fields.stress_yy, fields.stress_xy
            ),
            "energy_density_n_per_mm": fields.energy_density.ravel()[used],
            "utilisation": fields.utilisation.ravel()[used],
        },
        cell_data={"phase": [(grid.law_of_cell.ravel()[cloth] % len(PHASES)).astype(np.int32)]},
    ).write(path, file_format="vtu")
