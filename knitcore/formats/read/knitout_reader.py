"""Knitout programs executed on a virtual machine and read back as charts.

The one place that runs the package ``knitout-interpreter``. The interpreter checks every
instruction against a machine's state and links the loops to a knit graph; the chart is read from
that graph alone (which loop was pulled through which, from which bed and by which carrier), not
from the program. A stitch of the chart is a loop that was pulled through others; loops that were
pulled through none are cast on, or tucks that tie two yarns together. A bind-off chain along an
edge differs from stitches by its yarn: the next loop that the machine makes is pulled through the
chained one, on the next needle.
"""

import re
import sys
import typing
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np

from knitcore.base.errors import InputError, KnitcoreError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.formats.write.knitout import (
    MAX_NEEDLES,
    TAG_STITCHES,
    Finish,
    KnitoutProgram,
    knitout_program,
)
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart

MAX_BYTES = 4_000_000
_HOLDS = re.compile(r"^; carrier (\d{1,2}) knits (#[0-9a-f]{6}) (.+)$", re.MULTILINE)
_REMEDY = "Give knits and purls, course by course, without tucks, misses, lace, cables, short rows."


class KnitoutMismatchError(KnitcoreError):
    """Error for a program of this library that does not knit its chart: it is not exported."""


@dataclass(frozen=True)
class KnittedChart:
    """The piece that a program knits.

    Attributes
    ----------
    piece : the face, its outline and its yarns, without cast-on, bind-off and waste.
    notes : omissions, and warnings of the machine.
    """

    piece: Piece
    notes: tuple[str, ...]

    @property
    def chart(self) -> StitchChart:
        """The face grid."""
        return self.piece.chart


def knitted_chart(program: str) -> KnittedChart:
    """The face of a flat program of knits and purls.

    The chart is knitted by the carriers that a comment ``; carrier 1 knits #rrggbb name`` names, or
    else by the carrier that comes first; others are taken as waste.

    Raises
    ------
    InputError
        If the program is too long, violates the language or the machine, or makes anything but
        knits and purls within an outline.
    """
    if len(program.encode()) > MAX_BYTES:
        raise InputError("knitout", "the program is too long.", f"Use at most {MAX_BYTES} B.")
    loops, said = _interpreted(program)
    if not loops:
        raise InputError("knitout", "the program makes no loops.", "Give one that knits.")
    yarns = {int(m[1]): PieceYarn(m[3], m[2]) for m in _HOLDS.finditer(program)}
    if not yarns:
        yarns = {_carrier(min(loops, key=_time)): MAIN_YARN}
    others = sorted({_carrier(loop) for loop in loops} - set(yarns))
    notes = [f"Yarn of carrier {c} counts as waste yarn." for c in others]
    return KnittedChart(_piece_of_loops(loops, yarns), (*notes, *said))


def verified(
    chart: StitchChart | Piece, *, finish: Finish = Finish.WASTE, needles: int | None = None
) -> KnitoutProgram:
    """The program of a piece, after the virtual machine has knitted exactly this piece from it.

    Raises
    ------
    InputError
        If the chart is wider than the machine, or has more blocks of colour than carriers.
    KnitoutMismatchError
        If the machine refuses the program, warns, or knits something else.
    """
    piece = Piece.of(chart).cropped()
    made = knitout_program(
        piece, finish=finish, needles=MAX_NEEDLES if needles is None else needles
    )
    try:
        knitted = knitted_chart(made.text)
    except InputError as error:
        raise KnitoutMismatchError(f"the program was refused: {error}") from error
    if knitted.piece != piece:
        raise KnitoutMismatchError("the virtual machine knitted another chart.")
    warned = [note for note in knitted.notes if "waste" not in note]
    if warned:
        raise KnitoutMismatchError(f"the virtual machine warned: {warned[0]}")
    return made


def _interpreted(program: str) -> tuple[list[Any], list[str]]:
    """All loops, and the warnings, of a program."""
    from knitout_interpreter.knitout_errors.Knitout_Error import Knitout_Error
    from knitout_interpreter.knitout_execution import Knitout_Executer
    from virtual_knitting_machine.knitting_machine_exceptions.Knitting_Machine_Error import (
        Knitting_Machine_Error,
    )

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            lines = _parser().parse_knitout_to_instructions(program)
            graph: Any = Knitout_Executer(lines).resulting_knit_graph
        # For some mistakes in a program the interpreter raises Python's own errors.
        except (
            Knitout_Error,
            Knitting_Machine_Error,
            ArithmeticError,
            AssertionError,
            AttributeError,
            LookupError,
            TypeError,
            ValueError,
        ) as error:
            raise InputError(
                "knitout", f"{_one_line(error)}.", "Correct that line: the machine stops there."
            ) from None
    return list(graph.sorted_loops), [_one_line(w.message) for w in caught]


@lru_cache(maxsize=1)
def _parser() -> Any:
    """The parser of the language; made once, with what makes the machine fast."""
    if sys.version_info < (3, 12):  # lists a protocol's members at each isinstance: 3/4 of a run
        for name in ("_get_protocol_attrs", "_is_callable_members_only"):
            setattr(typing, name, lru_cache(getattr(typing, name)))
    from knitout_interpreter.knitout_language.Knitout_Parser import Knitout_Parser

    return Knitout_Parser()


def _one_line(message: object) -> str:
    return " ".join(str(message).split()).rstrip(".")[:300]


def _piece_of_loops(loops: Sequence[Any], yarns: Mapping[int, PieceYarn]) -> Piece:
    """The piece that all loops of a machine make, with its yarns by carrier.

    Loops of other carriers are waste or separate strands.
    """
    courses = _courses(sorted(loops, key=_time), frozenset(yarns))
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
            yarn_of[row, needle - first] = known.index(yarns[_carrier(loop)])
            stitch[row, needle - first] = True
    return Piece(ShapedChart(StitchChart(purl), stitch), tuple(known), yarn_of)


def _carrier(loop: Any) -> int:
    """Number of the carrier that made a loop."""
    return int(loop.yarn.carrier.carrier_id)


def _time(loop: Any) -> int:
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
        mine = _carrier(loop) in carriers
        if not mine or not loop.parent_loops or _is_chained(loop, child):
            courses, course = [*courses, course] if course else courses, {}
            continue
        if _needle(loop) in course:
            courses, course = [*courses, course], {}
        course[_needle(loop)] = loop
    courses = [*courses, course] if course else courses
    return courses if _carrier(loops[-1]) not in carriers else _without_tag(courses)


def _ties(tuck: Any, child: Mapping[Any, Any]) -> bool:
    """Say whether a tuck was laid onto a needle that held a loop already."""
    stitch = child.get(tuck)
    return stitch is not None and any(
        other is not tuck and _needle(other) == _needle(tuck) and _time(other) < _time(tuck)
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
        and _time(after) == _time(loop) + 1
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
            problem = f"on needle {needle}, course {row + 1} is not pulled through course {row}."
            raise InputError("knitout", problem, _REMEDY)
        places = {_needle(parent): parent for parent in loop.parent_loops}
        if any(n != needle and n in course and below.get(n) is p for n, p in places.items()):
            raise InputError(
                "knitout", f"a loop moves to needle {needle} in course {row + 1}.", _REMEDY
            )
        if own is None and any(parent.parent_loops for parent in loop.parent_loops):
            problem = f"needle {needle} begins in course {row + 1} with a loop from elsewhere."
            raise InputError("knitout", problem, _REMEDY)
