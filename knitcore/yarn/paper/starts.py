"""First shapes for the published description.

``data/published_starts.csv`` holds one shape of least energy for each of the paper's eight samples,
divided by its loop length; this solver found them and a test shows that they are stationary.
"""

from __future__ import annotations

import csv
from functools import cache
from importlib.resources import files

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Fabric
from knitcore.yarn.paper.bezier_shape import unknown_names
from knitcore.yarn.paper.bezier_stitch import Stitch
from knitcore.yarn.paper.minimise import length_powers

_SPREAD = 0.03
"""Relative spread of the random starts."""


@cache
def _packaged() -> dict[Fabric, tuple[Array, ...]]:
    shapes: dict[tuple[Fabric, str], dict[str, float]] = {}
    path = files("knitcore.yarn.model") / "data" / "published_starts.csv"
    with path.open(encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            key = Fabric(row["fabric"]), row["yarn"]
            shapes.setdefault(key, {})[row["unknown"]] = float(row["value_per_loop_length"])
    return {
        fabric: tuple(
            np.array([values[name] for name in unknown_names(fabric)])
            for (owner, _), values in shapes.items()
            if owner is fabric
        )
        for fabric in Fabric
    }


def first_shapes(stitch: Stitch, loop_length_mm: float, count: int) -> list[Array]:
    """Starts for a minimisation: the packaged shape, then random ones near it.

    Parameters
    ----------
    stitch : whose unknowns are meant.
    loop_length_mm : length of yarn the shapes are scaled to, mm.
    count : how many; the same count gives the same shapes.
    """
    scale = loop_length_mm ** length_powers(stitch)
    packaged = _packaged()[stitch.fabric]
    shapes = [shape * scale for shape in packaged[:count]]
    generator = np.random.default_rng(20240226)
    while len(shapes) < count:
        base = packaged[len(shapes) % len(packaged)]
        noise = 1.0 + _SPREAD * generator.standard_normal(base.size)
        shapes.append(base * noise * scale)
    return shapes
