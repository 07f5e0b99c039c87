"""A second opinion on programs: the package ``knitout-interpreter`` executes every instruction."""

import re
import sys
import typing
import warnings
from functools import cache
from typing import Any

from knitout_interpreter.knitout_execution import Knitout_Executer
from knitout_interpreter.knitout_language.Knitout_Parser import Knitout_Parser
from virtual_knitting_machine.knitting_machine_warnings.Yarn_Carrier_System_Warning import (
    In_Loose_Carrier_Warning,
)

from knitcore.formats.read.knitout_reader import verified
from knitcore.machine.knitout_machine import knitting_of
from knitcore.machine.program import KnitoutProgram

_OF_MACHINE = re.compile(r"^(?:x-|;;(?!Carriers)).*\n", re.MULTILINE)
"""Extension operations and headers that the package's only machine does not know."""


def verified_twice(*args: Any, **options: Any) -> KnitoutProgram:
    """The program of a chart, which both machines knit without a warning, loop by loop alike."""
    made = verified(*args, **options)
    check_loops(made.text)
    return made


def check_loops(program: str) -> None:
    """Compare the needle, the carrier and the parents of each loop."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # A machine without a hook holds the end of a yarn by waste yarn.
        warnings.simplefilter("ignore", In_Loose_Carrier_Warning)
        warnings.simplefilter("ignore", DeprecationWarning)
        lines = _parser().parse_knitout_to_instructions(_OF_MACHINE.sub("", program))
        graph: Any = Knitout_Executer(lines).resulting_knit_graph
    loops = sorted(graph.sorted_loops, key=lambda loop: loop.loop_count_on_machine)
    number = {loop: index for index, loop in enumerate(loops)}
    assert [
        (o.name, o.carriers, sorted(p.number for p in o.parents))
        for o in knitting_of(program).loops
    ] == [
        (
            f"{'f' if o.source_needle.is_front else 'b'}{o.source_needle.position}",
            (str(o.yarn.carrier.carrier_id),),
            sorted(number[parent] for parent in o.parent_loops),
        )
        for o in loops
    ]


@cache
def _parser() -> Any:
    """The parser of the language; made once, with what makes the machine fast."""
    if sys.version_info < (3, 12):  # lists a protocol's members at each isinstance: 3/4 of a run
        for name in ("_get_protocol_attrs", "_is_callable_members_only"):
            setattr(typing, name, cache(getattr(typing, name)))
    return Knitout_Parser()
