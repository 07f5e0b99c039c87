"""Sides of the rows: right or wrong, as they are worked.

In flat knitting right-side (RS) rows are worked from the right edge of the face to the left, and
wrong-side (WS) rows from left to right with the opposite stitch, because the knitter looks at the
back. In the round every row is worked on the right side, from right to left. The rows themselves
are in :mod:`knitcore.garment.worked_piece`.
"""

from __future__ import annotations

from enum import StrEnum


class Construction(StrEnum):
    """Way of working the cloth: flat, turned after each row, or in the round."""

    FLAT = "flat"
    ROUND = "round"


class Side(StrEnum):
    """The side of the fabric that faces the knitter: right (RS) or wrong (WS)."""

    RS = "RS"
    WS = "WS"

    @property
    def other(self) -> Side:
        """The back of this side."""
        return Side.WS if self is Side.RS else Side.RS


def side_of_row(index: int, construction: Construction, first_side: Side) -> Side:
    """The side that faces the knitter in row ``index`` (from 0)."""
    if construction is Construction.ROUND or index % 2 == 0:
        return first_side
    return first_side.other
