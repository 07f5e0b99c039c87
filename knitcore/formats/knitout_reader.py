"""What a knitout program knits: interpreted on a virtual machine, read back as a chart.

The one place that knows the package ``knitout-interpreter``. The interpreter checks every
instruction against a machine's state and links the loops to a knit graph; the chart is read from
that graph alone (which loop was pulled through which, from which bed), not from the program.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from knitcore.chart import StitchChart
from knitcore.errors import InputError, KnitcoreError
from knitcore.formats.knitout import Finish, KnitoutProgram, knitout_program

MAXIMUM_BYTES = 4_000_000


class KnitoutMismatchError(KnitcoreError):
    """A program that we wrote does not knit its chart: our mistake, so nothing is exported."""


@dataclass(frozen=True)
class KnittedChart:
    """The face of what a program knits.

    Attributes
    ----------
    chart : without cast-on, bind-off and waste.
    notes : what was left out, and what the machine warned of.
    """

    chart: StitchChart
    notes: tuple[str, ...]


def knitted_chart(program: str) -> KnittedChart:
    """The face grid of a flat program of knits and purls.

    The chart is knitted by the yarn that comes first; its wales run from their cast-on loops up
    to a bind-off or to another yarn, which is taken as waste.

    Raises
    ------
    InputError
        If the program is too long, breaks the language or the machine, or knits anything but a
        rectangle of knits and purls.
    """
    if len(program.encode()) > MAXIMUM_BYTES:
        raise InputError("knitout", "the program is too long.", f"Use at most {MAXIMUM_BYTES} B.")
    loops, said = _interpreted(program)
    if not loops:
        raise InputError("knitout", "the program makes no loops.", "Give one that knits.")
    carrier = _carrier(min(loops, key=lambda loop: loop.loop_count_on_machine))
    others = sorted({_carrier(loop) for loop in loops} - {carrier})
    children = {parent: loop for loop in loops for parent in loop.parent_loops}
    bases = [loop for loop in loops if _carrier(loop) == carrier and not loop.parent_loops]
    wales = [_wale(base, children, carrier) for base in sorted(bases, key=_needle)]
    _check([_needle(base) for base in sorted(bases, key=_needle)], wales)
    purl = [[not loop.source_needle.is_front for loop in wale] for wale in wales]
    notes = [f"Yarn of carrier {c} was taken as waste." for c in others]
    return KnittedChart(StitchChart(np.array(purl, dtype=bool).T), (*notes, *said))


def verified(
    chart: StitchChart, *, finish: Finish = Finish.WASTE, needles: int | None = None
) -> KnitoutProgram:
    """The program of a chart, after the virtual machine has knitted exactly this chart from it.

    Raises
    ------
    InputError
        If the chart is wider than the machine.
    KnitoutMismatchError
        If the machine refuses the program, warns, or knits something else.
    """
    made = (
        knitout_program(chart, finish=finish)
        if needles is None
        else knitout_program(chart, finish=finish, needles=needles)
    )
    try:
        knitted = knitted_chart(made.text)
    except InputError as error:
        raise KnitoutMismatchError(f"the program was refused: {error}") from error
    if knitted.chart != chart:
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
        # The interpreter lets some mistakes in a program through as errors of Python itself.
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
                "knitout", f"{_one_line(error)}.", "Mend that line: the machine stops there."
            ) from None
    return list(graph.sorted_loops), [_one_line(w.message) for w in caught]


@lru_cache(maxsize=1)
def _parser() -> Any:
    from knitout_interpreter.knitout_language.Knitout_Parser import Knitout_Parser

    return Knitout_Parser()


def _wale(base: Any, children: dict[Any, Any], carrier: int) -> list[Any]:
    """Loops above a cast-on loop, each pulled through the one before it and no other."""
    wale = []
    loop = children.get(base)
    while loop is not None and len(loop.parent_loops) == 1 and _carrier(loop) == carrier:
        if _needle(loop) != _needle(base):
            raise InputError(
                "knitout",
                f"a loop wanders from needle {_needle(base)} to {_needle(loop)}.",
                "Only knits and purls are read: no lace, cables or shaping.",
            )
        wale.append(loop)
        loop = children.get(loop)
    return wale


def _check(needles: Sequence[int], wales: Sequence[Sequence[Any]]) -> None:
    """Refuse what is no rectangle, knitted course by course."""
    remedy = "Give a flat rectangle of knits and purls without tucks, misses and short rows."
    if list(needles) != list(range(needles[0], needles[0] + len(needles))):
        raise InputError("knitout", "its cast-on skips needles or uses one twice.", remedy)
    heights = [len(wale) for wale in wales]
    if min(heights) == 0 or min(heights) != max(heights):
        shortest = needles[heights.index(min(heights))]
        raise InputError(
            "knitout",
            f"the wale on needle {shortest} has {min(heights)} stitches, another {max(heights)}.",
            remedy,
        )
    made = np.array([[loop.loop_count_on_machine for loop in wale] for wale in wales])
    if (made[:, :-1].max(axis=0) >= made[:, 1:].min(axis=0)).any():
        raise InputError("knitout", "its courses are not knitted one after another.", remedy)


def _carrier(loop: Any) -> int:
    return int(loop.yarn.carrier.carrier_id)


def _needle(loop: Any) -> int:
    return int(loop.source_needle.position)


def _one_line(message: object) -> str:
    return " ".join(str(message).split()).rstrip(".")[:300]
