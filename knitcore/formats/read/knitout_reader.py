"""Knitout programs read as charts.

A program is knitted (:mod:`knitcore.machine.knitout_machine`), the piece is told from waste
(:mod:`knitcore.formats.read.knitout_parts`), and its stitches are put into courses and wales
(:mod:`knitcore.formats.read.knitout_courses`): all from the graph of loops, not from names. A
program of this library is knitted and read in this way before it is exported. In the tests the
package ``knitout-interpreter`` executes the programs too, and must make the same loops.
"""

import re
from collections.abc import Mapping, Sequence
from itertools import cycle
from types import MappingProxyType

import numpy as np

from knitcore.base.errors import InputError, KnitcoreError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.read.chart_files import PieceInFile, StitchesInFile
from knitcore.formats.read.knitout_courses import KnittedCourses, fabric_of
from knitcore.formats.read.knitout_parts import KnittedPart, main_part, named, part_knitted_by
from knitcore.formats.read.knitout_stitches import chart_of_states
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart
from knitcore.machine.knitout_machine import knitting_of, states_of
from knitcore.machine.profile import DEFAULT, MachineProfile, profile
from knitcore.machine.program import Finish, KnitoutProgram
from knitcore.machine.program_check import check_program
from knitcore.machine.stitch_program import stitch_program
from knitcore.machine.tension import LoopYarn

MAX_BYTES = 4_000_000
_HOLDS = re.compile(r"^; carrier (\S+) knits (#[0-9a-f]{6}) (.+)$", re.MULTILINE)
_COURSES = re.compile(r"^; course 1\n(?:(?!; waste|; bind).*\n)*", re.MULTILINE)
"""The courses in a program of this library."""
_COLOURS = ("#efe9dd", "#1f3b70", "#b03a2e", "#2e7d5b", "#c99a2e", "#6b4a8a", "#3a8fb0", "#8a5a3c")


class KnitoutMismatchError(KnitcoreError):
    """Error for a program of this library that does not knit its chart: it is not exported."""


def knitted_chart(program: str) -> PieceInFile:
    """The face of a flat program of knits and purls, as by :func:`knitted_stitches`."""
    read = knitted_stitches(program, others=False)
    return PieceInFile(Piece.of(read.content), read.notes)


def knitted_stitches(program: str, *, others: bool = True) -> StitchesInFile:
    """The face of a flat program, without cast-on, bind-off and waste.

    Comments ``; carrier 1 knits #rrggbb name`` name the carriers that knit the chart. Without
    them the piece is told from waste by the loops.

    Parameters
    ----------
    program : its text.
    others : whether other stitches than knits and purls are read, too.

    Raises
    ------
    InputError
        If the program is too long, is not knitout, or makes neither knits and purls within an
        outline nor rows of stitches that all reach over the same wales; it names course, needle,
        line and kind.
    """
    if len(program.encode()) > MAX_BYTES:
        raise InputError("knitout", "the program is too long.", f"Use at most {MAX_BYTES} B.")
    knitting = knitting_of(program)
    if not knitting.loops:
        raise InputError("knitout", "the program makes no loops.", "Give one that knits.")
    yarns: dict[tuple[str, ...], PieceYarn] = {
        (m[1],): PieceYarn(m[3].strip(), m[2]) for m in _HOLDS.finditer(program)
    }
    part = part_knitted_by(knitting.loops, yarns) if yarns else main_part(knitting.loops)
    own = _COURSES.search(program) if yarns else None
    chart = None
    if own is not None and re.search(r"\n(?:miss|tuck|rack)", own[0]):
        begin = program.count("\n", 0, own.start()) + 1
        chart = _other_stitches(program, part, range(begin, begin + own[0].count("\n") + 1))
    if chart is not None:
        return StitchesInFile(chart, (*part.notes, *knitting.notes))
    try:
        fabric = fabric_of(knitting.loops, part.stitches)
    except InputError:
        chart = _other_stitches(program, part) if others else None
        if chart is None:
            raise
        return StitchesInFile(chart, (*part.notes, *knitting.notes))
    carriers = list(dict.fromkeys(loop.carriers for course in fabric.courses for loop in course))
    yarn_notes: list[str] = []
    if not yarns:
        yarns = _yarns(carriers, knitting.colours)
        if len(carriers) > 1:
            names = ", ".join(named(names) for names in carriers)
            yarn_notes.append(f"The piece is knitted by carriers {names}; each is a yarn of it.")
    notes = [*part.notes, *yarn_notes, *fabric.notes, *knitting.notes]
    if any(len(names) > 1 for names in carriers):
        notes.append("Yarns that knit together (plating) count as one yarn.")
    return StitchesInFile(_piece(fabric, yarns), tuple(notes))


def _other_stitches(
    program: str, part: KnittedPart, lines: range | None = None
) -> SymbolChart | None:
    """The chart of other stitches that a part, or lines of a program, make, if they do."""
    if len({loop.carriers for loop in part.stitches}) != 1:
        return None
    knitting, states = states_of(program)
    made = part.stitches
    if lines is not None:
        made = tuple(loop for loop in knitting.loops if loop.line in lines)
    first, last = made[0].number, made[-1].number
    try:
        chart = chart_of_states(knitting.loops, states, first, last)
    except InputError:
        return None
    return None if chart.is_plain else chart


def _yarns(
    carriers: Sequence[tuple[str, ...]], colours: Mapping[str, str]
) -> dict[tuple[str, ...], PieceYarn]:
    """Yarns that a program does not name: the main yarn, or one for each carrier."""
    if len(carriers) == 1:
        return {carriers[0]: MAIN_YARN}
    palette = cycle(_COLOURS)
    return {
        names: PieceYarn(f"carrier {named(names)}", colours.get(names[0]) or next(palette))
        for names in carriers
    }


def _piece(fabric: KnittedCourses, yarns: Mapping[tuple[str, ...], PieceYarn]) -> Piece:
    rows, columns = len(fabric.courses), fabric.columns
    purl = np.zeros((rows, columns), dtype=bool)
    stitch, yarn_of = purl.copy(), np.zeros(purl.shape, dtype=np.intp)
    known = list(dict.fromkeys(yarns.values()))
    for row, course in enumerate(fabric.courses):
        for loop, column in course.items():
            purl[row, column] = loop.bed == "b"
            yarn_of[row, column] = known.index(yarns[loop.carriers])
            stitch[row, column] = True
    return Piece(ShapedChart(StitchChart(purl), stitch), tuple(known), yarn_of)


def verified(
    chart: StitchChart | Piece | SymbolChart,
    *,
    finish: Finish = Finish.WASTE,
    machine: MachineProfile | None = None,
    stitch_number: float | None = None,
    yarn: LoopYarn | None = None,
    looser: Mapping[float, LoopYarn] = MappingProxyType({}),
) -> KnitoutProgram:
    """The program of a piece, after the virtual machine has knitted exactly this piece from it.

    Parameters are those of :func:`knitcore.machine.stitch_program.stitch_program`.

    Raises
    ------
    InputError
        If the machine cannot knit the piece, or transfers would break the yarn.
    KnitoutMismatchError
        If the virtual machine refuses the program or knits something else, or the machine's
        profile does not allow it.
    """
    if not isinstance(chart, SymbolChart) or chart.is_plain:
        chart = Piece.of(chart).cropped()
    meant: Piece | SymbolChart = chart
    made = stitch_program(
        meant, finish=finish, machine=machine, stitch_number=stitch_number, yarn=yarn, looser=looser
    )
    try:
        knitted = knitted_stitches(made.text)
    except InputError as error:
        raise KnitoutMismatchError(f"the program was refused: {error}") from error
    if knitted.content != meant:
        raise KnitoutMismatchError("the virtual machine knitted another chart.")
    for problem in check_program(made.text, machine or profile(DEFAULT)):
        if problem.stops:
            raise KnitoutMismatchError(f"the machine's profile does not allow it: {problem}")
    return made
