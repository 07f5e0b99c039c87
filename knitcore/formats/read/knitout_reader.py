"""Knitout programs executed on a virtual machine and read back as charts.

The one place that runs the package ``knitout-interpreter``. The interpreter checks every
instruction against a machine's state and links the loops to a knit graph; the chart is read from
that graph alone (which loop was pulled through which, from which bed and by which carrier), not
from the program: :mod:`knitcore.formats.write.knit_graph`.
"""

import re
import sys
import typing
import warnings
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from knitcore.base.errors import InputError, KnitcoreError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.formats.write.knit_graph import carrier_of as _carrier
from knitcore.formats.write.knit_graph import piece_of_loops
from knitcore.formats.write.knit_graph import time_of as _time
from knitcore.formats.write.knitout import MAX_NEEDLES, Finish, KnitoutProgram, knitout_program
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn

MAX_BYTES = 4_000_000
_HOLDS = re.compile(r"^; carrier (\d{1,2}) knits (#[0-9a-f]{6}) (.+)$", re.MULTILINE)


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
    return KnittedChart(piece_of_loops(loops, yarns), (*notes, *said))


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
