"""Values of every stitch, for ParaView (VTU) and spreadsheets (CSV)."""

import csv
import io
import tempfile
from pathlib import Path

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.stitch_chart import StitchChart
from knitcore.draw.laid_out import laid_corners_mm
from knitcore.garment.piece import Piece
from knitcore.materials import Material
from knitcore.mechanics.local_moduli import local_moduli


def stitch_values(chart: StitchChart | Piece, material: Material) -> dict[str, Array]:
    """Local values by name with their units, each (rows, columns), bottom row first."""
    local = local_moduli(Piece.of(chart).shaped.continued(), material)
    return {
        "modulus_course_n_per_mm": local.modulus_course_n_per_mm,
        "modulus_wale_n_per_mm": local.modulus_wale_n_per_mm,
        "extensibility_course_mm_per_n": local.extensibility_course_mm_per_n,
        "extensibility_wale_mm_per_n": local.extensibility_wale_mm_per_n,
    }


def write_csv(chart: StitchChart | Piece, material: Material) -> str:
    """One line a stitch; rows and columns count from 1 at the bottom left of the face."""
    values, piece = stitch_values(chart, material), Piece.of(chart)
    several = len(piece.yarns) > 1
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(["row", "column", "stitch", *values, *(["yarn"] if several else [])])
    for row, column in np.argwhere(piece.shaped.stitch).tolist():
        stitch = "P" if piece.chart.purl[row, column] else "K"
        numbers = [f"{float(v[row, column]):.6g}" for v in values.values()]
        yarn = [_as_text(piece.yarns[piece.yarn_of[row, column]].name)] if several else []
        writer.writerow([row + 1, column + 1, stitch, *numbers, *yarn])
    return buffer.getvalue()


def _as_text(name: str) -> str:
    """A name that spreadsheets do not read as a formula."""
    return f"'{name}" if name.startswith(("=", "+", "-", "@", "\t", "\r")) else name


def write_vtu(chart: StitchChart | Piece, material: Material) -> bytes:
    """Stitches in mm, laid flat at rest, with their values as cell data."""
    import meshio

    piece = Piece.of(chart)
    corners = laid_corners_mm(piece.shaped, material, piece.gauge)
    points = np.pad(corners.reshape(-1, 2), ((0, 0), (0, 1)))
    row, column = np.nonzero(piece.shaped.stitch)
    corner = row * (piece.chart.columns + 1) + column
    above = corner + piece.chart.columns + 1
    quads = np.stack([corner, corner + 1, above + 1, above], axis=1)
    inside = piece.shaped.stitch
    data = {name: [value[inside]] for name, value in stitch_values(chart, material).items()}
    data["purl"] = [piece.chart.purl[inside].astype(np.int32)]
    if len(piece.yarns) > 1:
        data["yarn"] = [piece.yarn_of[inside].astype(np.int32)]
    with tempfile.TemporaryDirectory(prefix="knitcore-") as folder:
        file = Path(folder) / "chart.vtu"
        meshio.Mesh(points, [("quad", quads)], cell_data=data).write(file, file_format="vtu")
        return file.read_bytes()
