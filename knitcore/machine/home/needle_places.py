"""Needles of a home machine: their names, and where the stitches of a chart lie on them.

Places on the bed are counted from the knitter's left. The chart shows the right side: where that
side faces away from the knitter, the places are the chart's columns from the right.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Mask, runs
from knitcore.base.errors import InputError
from knitcore.garment.piece import Piece
from knitcore.machine.profile import Dialect, MachineProfile


def check_home(piece: Piece, profile: MachineProfile) -> None:
    """Refuse a machine that is not worked by hand, and a piece that is wider than its bed.

    Raises
    ------
    InputError
    """
    if profile.dialect is not Dialect.HAND:
        problem = f"{profile.name} is not worked by hand."
        raise InputError("machine", problem, "Choose a home machine, or export its program.")
    columns = piece.chart.columns
    if columns > profile.columns:
        parts = -(-columns // profile.columns)
        raise InputError(
            "chart",
            f"{columns} stitches are wider than the {profile.columns} needles of {profile.name}.",
            f"Knit {parts} pieces of at most {-(-columns // parts)} stitches and join them.",
        )


def facing(piece: Piece) -> Mask:
    """Choose the side that looks at the knitter in all rows: the right side if most are purls.

    Most stitches are then made by the main bed alone. The result has an entry for each row, True if
    the right side looks at the knitter.
    """
    purls = np.count_nonzero(piece.chart.purl & piece.shaped.stitch)
    return np.full(piece.chart.rows, 2 * purls > piece.shaped.stitches)


def other_stitches(piece: Piece, toward: Mask) -> Mask:
    """Stitches that the main bed does not make by itself, bool (rows, places).

    Parameters
    ----------
    toward : for each row, whether the right side looks at the knitter.
    """
    purl, stitch = piece.chart.purl, piece.shaped.stitch
    return on_needles((purl != toward[:, None]) & stitch, toward)


def on_needles(cells: NDArray[Any], toward: Mask) -> NDArray[Any]:
    """Values of the chart's cells by their places on the bed, from the knitter's left."""
    return np.where(toward[:, None], cells, cells[:, ::-1])


def side_words(toward: Mask) -> str:
    """Say which side of the fabric the knitter sees, and what this means for the needles."""
    if toward.all():
        return "The right side faces you: the needles are in the order of the chart."
    if not toward.any():
        return "The right side faces away from you: the needles mirror the chart."
    return "The work is turned: the needles follow or mirror the chart, as written here."


def needle_name(place: int, width: int) -> str:
    """A needle as knitters call it: counted from the middle to the left and to the right.

    Examples
    --------
    >>> [needle_name(place, 5) for place in range(5)]
    ['L3', 'L2', 'L1', 'R1', 'R2']
    """
    left = (width + 1) // 2
    return f"L{left - place}" if place < left else f"R{place - left + 1}"


def needle_words(places: Iterable[int], width: int) -> str:
    """Needles in words; those at equal distances together.

    Examples
    --------
    >>> needle_words([0, 1, 2, 7], 10), needle_words(range(0, 10, 2), 10)
    ('L5–L3 and R3', 'every 2nd needle from L5 to R4')
    """
    marked = np.zeros(width, dtype=int)
    marked[list(places)] = 1
    spans = [(start, stop) for start, stop, mark in runs(marked) if mark]
    lengths = {stop - start for start, stop in spans}
    steps = {after[0] - before[0] for before, after in pairwise(spans)}
    if len(spans) > 3 and len(lengths) == len(steps) == 1:
        (length,), (step,) = lengths, steps
        ends = needle_name(spans[0][0], width), needle_name(spans[-1][1] - 1, width)
        each = (
            f"every {_ordinal(step)} needle" if length == 1 else f"{length} of every {step} needles"
        )
        return f"{each} from {ends[0]} to {ends[1]}"
    words = []
    for start, stop in spans:
        first, last = needle_name(start, width), needle_name(stop - 1, width)
        words.append(first if first == last else f"{first}–{last}")
    return " and ".join(filter(None, [", ".join(words[:-1]), words[-1]]))


def _ordinal(number: int) -> str:
    ending = {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th") if number % 100 // 10 != 1 else "th"
    return f"{number}{ending}"
