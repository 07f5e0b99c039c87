"""The four pure fabrics, named by the symmetry of the yarn between neighbouring stitches."""

from __future__ import annotations

from typing import Self, TypeVar

from knitcore.base.choice import Choice

Item = TypeVar("Item")


class Direction(Choice):
    """A material direction: course = along rows (x), wale = along columns (y)."""

    COURSE = "course"
    WALE = "wale"

    @property
    def axis(self) -> int:
        """0 for course (x), 1 for wale (y)."""
        return 0 if self is Direction.COURSE else 1

    @property
    def other(self) -> Direction:
        """The transverse direction."""
        return Direction.WALE if self is Direction.COURSE else Direction.COURSE

    def of(self, course: Item, wale: Item) -> Item:
        """The one of two things that is of this direction.

        Examples
        --------
        >>> Direction.WALE.of("row", "column")
        'column'
        """
        return course if self is Direction.COURSE else wale


class Fabric(Choice):
    """A pure fabric: connecting segments are all alike course-wise, and all alike wale-wise.

    The paper's Fig. 3c-j: stockinette has even segments both ways, garter odd ones wale-wise, rib
    (1x1) odd ones course-wise, seed odd ones both ways.
    """

    STOCKINETTE = "stockinette"
    GARTER = "garter"
    RIB = "rib"
    SEED = "seed"

    @property
    def course_odd(self) -> bool:
        """Say whether neighbours in a row differ in kind (one knit, one purl)."""
        return self in (Fabric.RIB, Fabric.SEED)

    @property
    def wale_odd(self) -> bool:
        """Say whether neighbours in a column differ in kind (one knit, one purl)."""
        return self in (Fabric.GARTER, Fabric.SEED)

    @property
    def phase(self) -> int:
        """Code of the phase of a quarter cell: ``2 * course_odd + wale_odd``."""
        return 2 * self.course_odd + self.wale_odd

    @classmethod
    def parse(cls, name: str) -> Self:
        """A fabric by its name, whatever the case.

        Raises
        ------
        InputError
            If no pure fabric has this name.
        """
        return super().parse(name.strip().lower() if isinstance(name, str) else name)


PHASES = (Fabric.STOCKINETTE, Fabric.GARTER, Fabric.RIB, Fabric.SEED)
"""Fabrics in the order of their phase codes."""
