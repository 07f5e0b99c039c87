import csv
import io

import numpy as np
import pytest

from knitcore import StitchChart, material
from knitcore.formats.write.stitch_values import write_csv
from knitcore.garment.piece import Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart


@pytest.mark.parametrize("name", ["=cmd|calc!A0", "+1", "-1", "@x", "cream, dark"])
def test_names_of_yarns_are_not_read_as_formulas(name: str) -> None:
    yarns = (PieceYarn("white", "#ffffff"), PieceYarn(name, "#0000ff"))
    piece = Piece(ShapedChart.rectangle(StitchChart.parse("KP")), yarns, np.array([[0, 1]]))
    lines = list(csv.DictReader(io.StringIO(write_csv(piece, material("acrylic")))))
    assert [line["yarn"] for line in lines] == ["white", name if name[0] == "c" else f"'{name}"]
