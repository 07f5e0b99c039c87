"""A piece cut from cloth: an outline in millimetres, holes, and the direction of its rows."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import shapely

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_positive
from knitcore.base.errors import InputError
from knitcore.base.kinds import as_numbers

Point = tuple[float, float]

MAX_CORNERS = 500
"""Largest number of corners of an outline and its holes together."""
MAX_SIZE_MM = 10_000.0


@dataclass(frozen=True)
class CutPiece:
    """A flat piece of cloth cut along a polygon, at any angle to its rows.

    Sides are numbered from 1 along the outline: side 1 goes from the first corner to the second.
    Those of the holes follow, hole by hole.

    Parameters
    ----------
    outline : corners (x, y) in mm, in order, either way round; at least three.
    holes : outlines of holes.
    grain_deg : angle from the x axis to the rows (the course direction), counter-clockwise.
    edges : names of parts of the boundary, by the numbers of their sides.

    Raises
    ------
    InputError
        If the outline crosses itself, a hole leaves it, or an edge names a side that does not
        exist.

    Examples
    --------
    >>> strip = CutPiece.rectangle(50.0, 200.0, grain_deg=45.0)
    >>> strip.area_mm2, strip.edges["top"]
    (10000.0, (3,))
    """

    outline: Sequence[Point]
    holes: Sequence[Sequence[Point]] = ()
    grain_deg: float = 0.0
    edges: Mapping[str, Sequence[int]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        rings = (self.outline, *self.holes)
        if not math.isfinite(self.grain_deg):
            raise InputError("grain_deg", f"{self.grain_deg} is not an angle.", "Give degrees.")
        for name, ring in zip(("outline", *("holes",) * len(self.holes)), rings, strict=True):
            if len(ring) < 3:
                raise InputError(name, f"{len(ring)} corners are too few.", "Give at least three.")
            remedy = f"Give x and y in mm, at most {MAX_SIZE_MM:g} from 0."
            places = as_numbers(name, ring, remedy)
            if places.shape[1:] != (2,) or not np.all(np.abs(places) <= MAX_SIZE_MM):
                raise InputError(name, "a corner has no usable coordinates.", remedy)
            if np.any(np.all(places == np.roll(places, -1, axis=0), axis=1)):
                raise InputError(
                    name,
                    "a corner is given twice in a row.",
                    "Give each corner once; the last side closes the outline.",
                )
        corners = sum(map(len, rings))
        if corners > MAX_CORNERS:
            raise InputError(
                "outline", f"{corners} corners are too many.", f"Use at most {MAX_CORNERS}."
            )
        shape = self.polygon
        if not (shape.is_valid and shape.area > 0):
            raise InputError(
                "outline",
                f"it is not one area with holes: {shapely.is_valid_reason(shape).lower()}.",
                "Let no side cross or touch another, and keep holes inside.",
            )
        for name, sides in self.edges.items():
            wrong = [side for side in sides if not 1 <= side <= corners]
            if wrong or not sides:
                raise InputError(
                    f"edges.{name}",
                    f"{wrong[0] if wrong else 'nothing'} is not a side.",
                    f"Use numbers from 1 to {corners}.",
                )

    @classmethod
    def rectangle(cls, width_mm: float, length_mm: float, *, grain_deg: float = 0.0) -> CutPiece:
        """A rectangle centred on the origin with the edges bottom, right, top and left."""
        for name, value in (("width_mm", width_mm), ("length_mm", length_mm)):
            check_positive(name, value, "mm", "a size", MAX_SIZE_MM)
        x, y = width_mm / 2, length_mm / 2
        return cls(
            ((-x, -y), (x, -y), (x, y), (-x, y)),
            grain_deg=grain_deg,
            edges={"bottom": (1,), "right": (2,), "top": (3,), "left": (4,)},
        )

    @cached_property
    def polygon(self) -> shapely.Polygon:
        """Outline and holes, mm."""
        return shapely.Polygon(self.outline, self.holes)

    @property
    def area_mm2(self) -> float:
        """Area of the cloth."""
        return float(self.polygon.area)

    @cached_property
    def sides(self) -> Array:
        """Ends (sides, 2, 2) of the straight sides, in the order of their numbers."""
        rings = [np.asarray(ring, dtype=float) for ring in (self.outline, *self.holes)]
        return np.concatenate([np.stack([r, np.roll(r, -1, axis=0)], axis=1) for r in rings])

    @property
    def is_upright_rectangle(self) -> bool:
        """True for a rectangle with sides along x and y."""
        box = shapely.box(*self.polygon.bounds)
        return len(self.outline) == 4 and not self.holes and bool(self.polygon.equals(box))

    @property
    def turn(self) -> Array:
        """(2, 2), its columns are the unit vectors along course and wale."""
        angle = math.radians(self.grain_deg)
        c, s = math.cos(angle), math.sin(angle)
        return np.array([[c, -s], [s, c]])

    def sides_of(self, edge: str) -> list[int]:
        """Indices (from 0) of an edge's sides.

        Raises
        ------
        InputError
            If there is no such edge.
        """
        if edge not in self.edges:
            known = ", ".join(self.edges) or "none"
            raise InputError(
                "edge", f"there is no edge {edge!r}.", f"Use one of these edges: {known}."
            )
        return [side - 1 for side in self.edges[edge]]
