"""Cloth in space: files for other programs, and where it is cloth."""

from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np
import pytest

from knitcore import InputError, StitchChart
from knitcore.base.arrays import Array
from knitcore.chart.in_space import ClothInSpace
from knitcore.cloth.space.curl import CurledPiece


@dataclass(frozen=True, eq=False, repr=False)
class Sheet(ClothInSpace):
    """Rectangles without a mask of their own."""

    corners_mm: Array


def test_cloth_without_a_mask_is_where_all_corners_are_numbers(tmp_path: Path) -> None:
    corners = np.zeros((3, 3, 3))
    corners[0, 0] = np.nan
    sheet = Sheet(corners)
    assert sheet.cloth.tolist() == [[False, True], [True, True]]
    assert np.count_nonzero(sheet.used) == 8
    sheet.write(tmp_path / "x.vtu")
    mesh = meshio.read(tmp_path / "x.vtu")
    assert len(mesh.cells[0].data) == 3
    assert np.isfinite(mesh.points).all()


def test_a_curled_piece_is_written_and_shown_in_brief(tmp_path: Path) -> None:
    corners = np.zeros((3, 4, 3))
    corners[..., 0], corners[..., 1] = np.meshgrid(np.arange(4.0), np.arange(3.0))
    stitches = np.array([[True, True, False], [True, True, True]])
    chart = StitchChart.parse("KKP/KKK")
    piece = CurledPiece(
        chart, corners, corners, 1.0, 3.0, 2.0, 0.0, 0.0, 0.0, 0.0, True, 0.0, 0.0, stitches
    )
    assert len(repr(piece)) < 400
    for name in ("x.npz", "x.vtu"):
        piece.write(tmp_path / name)
    mesh = meshio.read(tmp_path / "x.vtu")
    assert len(mesh.cells[0].data) == 5
    assert mesh.cell_data["purl"][0].tolist() == [0, 0, 0, 0, 1]
    with np.load(tmp_path / "x.npz") as stored:
        assert np.array_equal(stored["purl"], chart.purl)
    with pytest.raises(InputError, match="suffix"):
        piece.write(tmp_path / "x.obj")
