"""Charts as KnitDB decodes them: each loop with those below that it is pulled through.

A file ``NAME.stitches.json`` holds ``{"rows": [[[symbol, parent, …], …], …]}`` in the order of
knitting, the cast-on first. A symbol is K or P, with a t if the loop below is twisted; parents are
places in the row below. A loop without parents is a yarn over, one with two or three a decrease,
whose parents are listed from the back to the front of the stitch, a purl's as its own side, the
back of the fabric, shows it. The rows are knitted back and
forth, or all one way: parents that fall along a row tell that it turned.

The format does not say which of crossing stitches pass in front: those that move to the right are
taken to.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, Field, StrictInt, ValidationError

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, check_chart_size
from knitcore.chart.stitch_kinds import Site, YarnAct
from knitcore.chart.symbol_chart import SymbolChart

ENDING = ".stitches.json"
CROSSINGS = (
    "The file does not say which stitches of a cable pass in front: those that move to the right "
    "are taken to."
)

Symbol = Literal["K", "P", "Kt", "Pt"]
Loop = Annotated[list[Symbol | StrictInt], Field(min_length=1, max_length=4)]
Line = Annotated[list[Loop], Field(min_length=1, max_length=MAX_STITCHES_PER_SIDE)]


class _Rows(BaseModel):
    rows: Annotated[list[Line], Field(min_length=2, max_length=MAX_STITCHES_PER_SIDE + 1)]


def is_parent_loops(text: str) -> bool:
    """Tell whether a JSON text is of this format, by its first name."""
    return text.lstrip("\ufeff \t\r\n{").startswith('"rows"')


def read_parent_loops(text: str) -> tuple[SymbolChart, tuple[str, ...]]:
    """The chart of a file, and what had to be assumed.

    Raises
    ------
    InputError
        If the text is not of this format, a row does not take every loop below once, or no stitch
        takes its loops as one of the rows does.

    Examples
    --------
    >>> rows = '[[["K"], ["K"]], [["K"], ["K", 1, 0]], [["P", 1], ["K", 0]]]'
    >>> print(read_parent_loops('{"rows": ' + rows + "}")[0])
    PK
    /O
    """
    try:
        rows = _Rows.model_validate_json(text).rows
    except ValidationError as error:
        fault = error.errors(include_url=False, include_input=False)[0]
        place = "".join(f"[{part}]" for part in fault["loc"][1:] if isinstance(part, int))
        raise InputError(
            "chart",
            f"rows{place}: {fault['msg']}.",
            'Give {"rows": [[["K"], …], [["K", 0], …], …]}, the cast-on first, at least two rows.',
        ) from None
    check_chart_size(len(rows) - 1, len(rows[0]))
    lines: list[list[Site]] = []
    turns = _turns(rows[1:])
    to_right = turns[0]  # the way of the cast-on: the first row is knitted to the left
    for row, (below, line) in enumerate(pairwise(rows), start=1):
        _check_taken(line, len(below), row)
        came_right, to_right = to_right, to_right != turns[row - 1]
        sites = [_site(loop, len(below), came_right) for loop in line]
        lines.append(_crossed(sites if to_right else sites[::-1]))
    chart = SymbolChart.of_sites(lines)
    crosses = bool((chart.graph.layer != 0).any())
    return chart, (CROSSINGS,) if crosses else ()


def _parents(loop: Sequence[str | int]) -> list[int]:
    return [part for part in loop[1:] if isinstance(part, int) and part >= 0]


def _turns(lines: Sequence[Line]) -> list[bool]:
    """Tell of each row whether it was knitted back, by whether parents fall along it.

    Rows that do not tell are as most others, which turn if none tells.
    """
    rises = []
    for line in lines:
        first = [parents[0] for loop in line if (parents := _parents(loop))]
        rises.append(sum(1 if after > before else -1 for before, after in pairwise(first)))
    most = sum(map(np.sign, rises)) <= 0
    return [most if rise == 0 else rise < 0 for rise in rises]


def _site(loop: Sequence[str | int], below: int, came_right: bool) -> Site:
    symbol = str(loop[0])
    parents = [p if came_right else below - 1 - p for p in _parents(loop)]
    act = YarnAct.THROUGH if parents else YarnAct.OVER
    purl = bool(parents) and symbol.startswith("P")
    if not purl:
        parents.reverse()
    return Site(act, tuple(parents), purl, turn=int(symbol.endswith("t") and bool(parents)))


def _check_taken(line: Line, below: int, row: int) -> None:
    """Refuse a row that does not take every loop below once."""
    taken = sorted(parent for loop in line for parent in _parents(loop))
    if taken == list(range(below)):
        return
    twice = next((a for a, b in pairwise(taken) if a == b), None)
    if taken and taken[-1] >= below:
        problem = f"names parent {taken[-1]}, and the last of the row below is {below - 1}"
    elif twice is not None:
        problem = f"names parent {twice} twice"
    else:
        problem = f"does not name parent {next(i for i in range(below) if i not in taken)}"
    raise InputError(
        "chart", f"row {row} {problem}.", "Give every loop of a row to one loop of the next."
    )


def _crossed(sites: Sequence[Site]) -> list[Site]:
    """The sites with layers, where their loops change places: those that move right in front."""
    takes = [i for i, site in enumerate(sites) if site.sources]
    lowest = np.array([min(sites[i].sources) for i in takes])
    highest = np.array([max(sites[i].sources) for i in takes])
    to_right = np.maximum.accumulate(highest) > highest
    to_left = np.minimum.accumulate(lowest[::-1])[::-1] < lowest
    layers = dict(zip(takes, (to_right.astype(int) - to_left).tolist(), strict=True))
    return [replace(site, layer=layers.get(i, 0)) for i, site in enumerate(sites)]
