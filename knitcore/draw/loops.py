"""The centre line of one stitch as a drawn loop, of which solids for files are made.

The loop has the right topology for any neighbours: feet go behind the loops of the row below, legs
pass in front, the head passes behind the legs of the row above; a purl is the mirror image. Only
its proportions are drawn, not computed: lengths and contacts are those of the stitch cell and the
yarn's diameter.
"""

from functools import lru_cache

import numpy as np
from scipy.interpolate import PchipInterpolator

from knitcore.base.arrays import Array, Codes
from knitcore.chart.stitch_chart import StitchChart

SELF, LEFT, RIGHT, ABOVE = 1, 2, 4, 8
"""Bits of a kind of loop; a bit is set if that stitch is a purl."""

_NECK = 0.17
"""Lean of the legs, out at the head and in at the neck, in stitch widths (0: a cosine)."""
_REACH = 0.78
"""Half the height of a loop in row heights: loops reach through those of the row below."""
_KNOTS = np.array([0.0, 0.08, 0.21, 0.29, 0.42, 0.5])
"""Foot centre, foot end, lower leg, upper leg, head end, head centre; fractions of a stitch."""


def loop_kinds(chart: StitchChart) -> Codes:
    """Kind of loop of each stitch, 0 to 15, shape (rows, columns).

    The stitch itself, its left and right neighbours and the one above decide how the yarn runs; at
    an edge the stitch itself stands in for the missing neighbour.
    """
    purl = chart.purl.astype(np.uint8)
    left = np.concatenate([purl[:, :1], purl[:, :-1]], axis=1)
    right = np.concatenate([purl[:, 1:], purl[:, -1:]], axis=1)
    above = np.concatenate([purl[1:], purl[-1:]], axis=0)
    kinds: Codes = purl * SELF | left * LEFT | right * RIGHT | above * ABOVE
    return kinds


@lru_cache(maxsize=256)
def loop_centre_line(kind: int, points: int = 48) -> Array:
    """Centre line of one kind of loop, shape (points, 3).

    x and y are in units of stitch width and row height, from the centre of the cell, z in units of
    the yarn's radius, positive towards the face. It begins and ends on the cell's left and right
    edges, where it meets the neighbours' loops. The array is cached and read-only.
    """
    u = np.linspace(0.0, 1.0, points)
    side, left, right, above = (1.0 - 2.0 * bool(kind & bit) for bit in (SELF, LEFT, RIGHT, ABOVE))
    x = u - 0.5 + _NECK * np.sin(4 * np.pi * u)
    y = -_REACH * np.cos(2 * np.pi * u)
    half_left = PchipInterpolator(_KNOTS, [(side + left) / 2, side, -side, -above, above, above])
    half_right = PchipInterpolator(_KNOTS, [(side + right) / 2, side, -side, -above, above, above])
    z = np.where(u <= 0.5, half_left(np.minimum(u, 0.5)), half_right(np.minimum(1 - u, 0.5)))
    line = np.stack([x, y, -z], axis=1)
    line.setflags(write=False)
    return line
