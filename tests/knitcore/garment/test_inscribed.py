"""The largest rectangle inside an outline, against trying them all."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from knitcore.garment.inscribed import largest_rectangle

outlines = arrays(bool, array_shapes(min_dims=2, max_dims=2, max_side=7), elements=st.booleans())


@given(outlines)
def test_none_that_lies_inside_has_more_stitches(stitch: np.ndarray) -> None:
    rows, columns = stitch.shape
    most = max(
        (bottom - top) * (right - left)
        for top in range(rows)
        for bottom in range(top, rows + 1)
        for left in range(columns)
        for right in range(left, columns + 1)
        if stitch[top:bottom, left:right].all()
    )
    found = stitch[largest_rectangle(stitch)]
    assert found.all()
    assert found.size == most


def test_a_glove_s_largest_part_is_its_palm() -> None:
    marks = ["x.x.x", "x.x.x", "xxxxx", "xxxxx", "xxxxx"][::-1]
    stitch = np.array([[mark == "x" for mark in line] for line in marks])
    assert largest_rectangle(stitch) == (slice(0, 3), slice(0, 5))
