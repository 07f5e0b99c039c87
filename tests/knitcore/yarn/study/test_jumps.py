"""Abrupt changes of shape along a stretch."""

import numpy as np

from knitcore.yarn.study.jumps import find_jumps


def test_jumps_are_found_where_the_shape_changes_abruptly():
    line = np.linspace(0, 1, 50)
    lines = [
        np.stack([line, np.sin((3 + 0.05 * i + (2 if i > 5 else 0)) * line), 0 * line], 1)[None]
        for i in range(12)
    ]
    assert find_jumps(lines, 3.0) == (6,)
    assert find_jumps(lines[:5], 3.0) == ()
