"""A piece from a machine's knit graph: which loop was pulled through which, where, and when.

Loops are those of the package ``knitout-interpreter``. A stitch of the chart is a loop that was
pulled through others; loops that were pulled through none are cast on, or tucks that tie two yarns
together. A bind-off chain along an edge differs from stitches by its yarn: the next loop that the
machine makes is pulled through the chained one, on the next needle.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.formats.write.knitout import TAG_STITCHES
from knitcore.garment.piece import Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart

_REMEDY = "Give knits and purls, course by course, without tucks, misses, lace, cables, short rows."


def piece_of_loops(loops: Sequence[Any], yarns: Mapping[int, PieceYarn]) -> Piece:
    """The piece that carriers knit.

    Parameters
    ----------
    loops : all loops of a machine.
    yarns : the piece's yarns by carrier; loops of other carriers are waste or separate strands.

    Raises
    ------
    InputError
        If the loops make no chart of knits and purls.
    """
    courses = _courses(sorted(loops, key=time_of), frozenset(yarns))
    if not courses:
        raise InputError("knitout", "the program knits no stitch.", _REMEDY)
    for row, course in enumerate(courses):
        _check(row, course, courses[row - 1] if row else {})
    first = min(min(course) for course in courses)
    width = max(max(course) for course in courses) + 1 - first
    purl = np.zeros((len(courses), width), dtype=bool)
    stitch, yarn_of = purl.copy(), np.zeros(purl.shape, dtype=np.intp)
    known = list(dict.fromkeys(yarns.values()))
    for row, course in enumerate(courses):
        for needle, loop in course.items():
            purl[row, needle - first] = not loop.source_needle.is_front
            yarn_of[row, needle - first] = known.index(yarns[carrier_of(loop)])
            stitch[row, needle - first] = True
    return Piece(ShapedChart(StitchChart(purl), stitch), tuple(known), yarn_of)


def carrier_of(loop: Any) -> int:
    """Number of the carrier that made a loop."""
    return int(loop.yarn.carrier.carrier_id)


def time_of(loop: Any) -> int:
    """Number of a loop in the order in which a machine makes them."""
    return int(loop.loop_count_on_machine)


def _needle(loop: Any) -> int:
    return int(loop.source_needle.position)


def _courses(loops: Sequence[Any], carriers: frozenset[int]) -> list[dict[int, Any]]:
    """Stitches by needle, course by course.

    A course ends where a needle knits again, and where something else is cast on or bound off.
    """
    child = {parent: loop for loop in loops for parent in loop.parent_loops}
    courses: list[dict[int, Any]] = []
    course: dict[int, Any] = {}
    for loop in loops:
        if not loop.parent_loops and _ties(loop, child):
            continue
        mine = carrier_of(loop) in carriers
        if not mine or not loop.parent_loops or _is_chained(loop, child):
            courses, course = [*courses, course] if course else courses, {}
            continue
        if _needle(loop) in course:
            courses, course = [*courses, course], {}
        course[_needle(loop)] = loop
    courses = [*courses, course] if course else courses
    return courses if carrier_of(loops[-1]) not in carriers else _without_tag(courses)


def _ties(tuck: Any, child: Mapping[Any, Any]) -> bool:
    """Say whether a tuck was laid onto a needle that held a loop already."""
    stitch = child.get(tuck)
    return stitch is not None and any(
        other is not tuck and _needle(other) == _needle(tuck) and time_of(other) < time_of(tuck)
        for other in stitch.parent_loops
    )


def _is_chained(loop: Any, child: Mapping[Any, Any]) -> bool:
    before, after = loop.prior_loop_on_yarn, loop.next_loop_on_yarn
    return (
        before is not None
        and after is not None
        and before in loop.parent_loops
        and _needle(before) != _needle(loop)
        and child.get(loop) is after
        and time_of(after) == time_of(loop) + 1
        and _needle(after) != _needle(loop)
    )


def _without_tag(courses: list[dict[int, Any]]) -> list[dict[int, Any]]:
    """Remove the few stitches on one needle that hold a bind-off: its last chain, and a tag."""
    tag = TAG_STITCHES + 1
    end = courses[-tag:]
    wide_below = len(courses) > tag and len(courses[-tag - 1]) > 1
    if wide_below and {tuple(course) for course in end} == {tuple(end[0])} and len(end[0]) == 1:
        return courses[:-tag]
    return courses


def _check(row: int, course: Mapping[int, Any], below: Mapping[int, Any]) -> None:
    """Refuse a course that does not stand on the course below."""
    needles = sorted(course)
    gap = next((a for a, b in pairwise(needles) if b != a + 1), None)
    if gap is not None:
        raise InputError("knitout", f"course {row + 1} skips the needle after {gap}.", _REMEDY)
    for needle, loop in course.items():
        own = below.get(needle)
        if own is not None and own not in loop.parent_loops:
            raise InputError(
                "knitout",
                f"on needle {needle}, course {row + 1} is not pulled through course {row}.",
                _REMEDY,
            )
        places = {_needle(parent): parent for parent in loop.parent_loops}
        if any(n != needle and n in course and below.get(n) is p for n, p in places.items()):
            raise InputError(
                "knitout", f"a loop moves to needle {needle} in course {row + 1}.", _REMEDY
            )
        if own is None and any(parent.parent_loops for parent in loop.parent_loops):
            raise InputError(
                "knitout",
                f"needle {needle} begins in course {row + 1} with a loop from elsewhere.",
                _REMEDY,
            )
