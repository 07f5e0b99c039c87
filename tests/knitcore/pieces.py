"""Random pieces for property tests."""

import numpy as np
from hypothesis import strategies as st

from knitcore import StitchChart
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart

YARNS = (MAIN_YARN, PieceYarn("blue, dark", "#1f3b70"), PieceYarn("rose (soft)", "#d98a9c"))


@st.composite
def pieces(
    draw: st.DrawFn, most_rows: int = 8, most_columns: int = 10, *, step: int = 4, yarns: int = 3
) -> Piece:
    """Pieces with outlines whose edges move by up to ``step`` stitches, and some yarns."""
    rows = draw(st.integers(1, most_rows))
    generator = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    spans = []
    low, high = 0, int(generator.integers(1, most_columns + 1))
    for _ in range(rows):
        spans.append((low, high))
        while True:
            moves = generator.integers(-step, step + 1, size=2)
            a, b = low + int(moves[0]), high + int(moves[1])
            if a < b and a < high and b > low and b - a <= most_columns:
                low, high = a, b
                break
    offset = min(a for a, _ in spans)
    width = max(b for _, b in spans) - offset
    column = np.arange(width) + offset
    stitch = np.array([(column >= a) & (column < b) for a, b in spans])
    chart = StitchChart(generator.random(stitch.shape) < 0.5)
    if draw(st.booleans()):  # blocks rather than single stitches of a yarn
        blocks = generator.integers(0, yarns, size=(rows // 3 + 1, width // 3 + 1))
        yarn_of = np.kron(blocks, np.ones((3, 3), dtype=int))[:rows, :width]
    else:
        yarn_of = generator.integers(0, yarns, size=stitch.shape)
    return Piece(ShapedChart(chart, stitch), YARNS[:yarns], yarn_of.astype(np.intp))
