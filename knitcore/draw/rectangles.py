"""Extensibility rectangles (Fig. 4d): extensibility along the fabric's two principal directions.

Stitches are orthotropic along course and wale, so the rectangles lie along them, and turn with the
cloth when it is stretched. A rectangle may represent a single stitch, a block of stitches or a
region.
"""

import numpy as np

from knitcore.base.arrays import Array, Indices
from knitcore.chart.fabric import Direction
from knitcore.chart.phases import surroundings
from knitcore.chart.stitch_chart import StitchChart
from knitcore.draw.placing import PlacedStitches
from knitcore.materials import Material
from knitcore.mechanics.local_moduli import stitch_table

FILL = 0.94
"""Largest side of a rectangle, over the size of the largest group."""
LARGEST = 12.0
"""Largest room of a rectangle, in stitches."""


def stitch_labels(rows: int, columns: int, block: int = 1) -> Indices:
    """Groups of ``block`` x ``block`` stitches, numbered from 0, shape (rows, columns).

    Examples
    --------
    >>> stitch_labels(2, 3, 2).tolist()
    [[0, 0, 1], [0, 0, 1]]
    """
    across = -(-columns // block)
    return np.arange(rows)[:, None] // block * across + np.arange(columns) // block


def extensibility_rectangles(
    chart: StitchChart, material: Material, placement: PlacedStitches, labels: Indices
) -> Array:
    """Corners of one rectangle for each group of stitches, (groups, 4, 2), mm.

    Sides are proportional to the square root of the mean extensibility 1/Y of the group, so that
    stiff fabrics stay visible next to ribs; the largest extensibility that the material has fills
    as many of the group's stitches as the largest group has.

    Parameters
    ----------
    placement : where the stitches are.
    labels : (rows, columns) group of each stitch; -1 for none.
    """
    table, codes = stitch_table(material), surroundings(chart)
    sides = np.stack([table.extensibility_mm_per_n(d) for d in Direction], axis=-1)
    chosen = labels.ravel() >= 0
    _, group = np.unique(labels.ravel()[chosen], return_inverse=True)
    count = np.bincount(group)

    def mean(values: Array) -> Array:
        flat = values.reshape(len(chosen), -1)[chosen]
        return np.stack([np.bincount(group, column) / count for column in flat.T], axis=-1)

    room = min(np.sqrt(count.max(initial=1)), LARGEST) * mean(placement.sizes_mm).min(axis=1)
    half = 0.5 * FILL * room[:, None] * np.sqrt(mean(sides[codes]) / np.nanmax(sides))
    angle = mean(placement.angles)
    signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    x, y = np.moveaxis(half[:, None] * signs, -1, 0)
    cos, sin = np.cos(angle), np.sin(angle)
    turned = np.stack([cos * x - sin * y, sin * x + cos * y], axis=-1)
    corners: Array = mean(placement.centres_mm)[:, None] + turned
    return corners
