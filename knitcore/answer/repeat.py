"""A chart as a large cloth: its repeat, its phases and its windows, found once for all answers."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from knitcore.chart import StitchChart
from knitcore.fabric import PHASES, Fabric
from knitcore.phases import quarter_phases

WINDOW = 5
"""Rows and columns of a window."""

_BITS = WINDOW * WINDOW
_REVERSED = np.array(
    [int(f"{code:0{WINDOW}b}"[::-1], 2) for code in range(2**WINDOW)], dtype=np.int64
)


class Layout(StrEnum):
    """Whether a repeat is one-dimensional, and how."""

    RIB = "rib"
    WELT = "welt"


@dataclass(frozen=True, eq=False)
class Windows:
    """Which windows of :data:`WINDOW` x :data:`WINDOW` stitches a cloth shows, and how often.

    Attributes
    ----------
    codes : (windows,) increasing; a window, its mirror image and both seen from the back (K and P
        swapped) have one code.
    shares : (windows,) of the stitches, adding up to 1.
    """

    codes: NDArray[np.int64]
    shares: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Repeat:
    """A chart repeated for ever.

    Attributes
    ----------
    chart : the smallest repeat.
    fabric : the pure fabric that it is, if it is one.
    """

    chart: StitchChart
    fabric: Fabric | None

    @classmethod
    def of(cls, chart: StitchChart) -> Repeat:
        """The repeat of a chart, or of a swatch that may cut its last repeat off.

        Examples
        --------
        >>> Repeat.of(StitchChart.of_fabric("seed", 31, 31)).fabric
        <Fabric.SEED: 'seed'>
        >>> Repeat.of(StitchChart.parse("KKPPKKPPKK")).chart.text
        'KKPP'
        """
        found = np.unique(quarter_phases(chart))
        if len(found) == 1:
            fabric = PHASES[found[0]]
            return cls(StitchChart.of_fabric(fabric, 2, 2).repeat(), fabric)
        return cls(chart.repeat_cut(), None)

    @cached_property
    def phases(self) -> NDArray[np.uint8]:
        """(2 rows, 2 columns) phases of the quarter cells."""
        return quarter_phases(self.chart, periodic=True)

    @cached_property
    def shares(self) -> NDArray[np.float64]:
        """(4,) shares of the phases among the quarter cells."""
        return np.bincount(self.phases.ravel(), minlength=4) / self.phases.size

    @cached_property
    def present(self) -> tuple[Fabric, ...]:
        """The phases that it has."""
        return tuple(PHASES[phase] for phase in np.flatnonzero(self.shares))

    @property
    def layout(self) -> Layout | None:
        """Whether it is a rib, a welt, or neither."""
        if self.chart.rows == 1 and self.chart.columns > 1:
            return Layout.RIB
        if self.chart.columns == 1 and self.chart.rows > 1:
            return Layout.WELT
        return None

    @cached_property
    def windows(self) -> Windows:
        """Its windows."""
        rows = _packed(self.chart.purl.astype(np.int64), axis=1, bits=1)
        codes = _packed(rows, axis=0, bits=WINDOW)
        mirrored = _packed(_REVERSED[rows], axis=0, bits=WINDOW)
        swapped = 2**_BITS - 1
        least = np.minimum(
            np.minimum(codes, codes ^ swapped), np.minimum(mirrored, mirrored ^ swapped)
        )
        found, counts = np.unique(least, return_counts=True)
        return Windows(found, counts / counts.sum())


def _packed(values: NDArray[np.int64], axis: int, bits: int) -> NDArray[np.int64]:
    """WINDOW neighbours along an axis, periodically, as one number each."""
    total = np.zeros_like(values)
    for step in range(WINDOW):
        total |= np.roll(values, -step, axis=axis) << (bits * step)
    return total
