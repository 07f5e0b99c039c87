"""Carriers of a machine for the stitches of a piece: one for each block of colour (intarsia)."""

from dataclasses import dataclass

from knitcore.base.errors import InputError
from knitcore.garment.piece import Piece, YarnRun

MAX_CARRIERS = 10
"""Carriers of a Shima Seiki SWG091N2 and of the virtual machine; one is kept for waste yarn."""


@dataclass(frozen=True)
class CarrierRow:
    """A row's runs, each with its carrier, from left to right.

    Attributes
    ----------
    runs : with their carriers.
    new : carriers that are brought in for this row.
    ended : carriers that knitted the row below and are taken out.
    """

    runs: tuple[tuple[YarnRun, int], ...]
    new: frozenset[int]
    ended: tuple[int, ...]


@dataclass(frozen=True)
class CarrierPlan:
    """The carriers of all rows, and which yarn (an index) each holds."""

    rows: tuple[CarrierRow, ...]
    yarns: dict[int, int]

    @property
    def waste(self) -> int:
        """The carrier of waste yarn and separate strands."""
        return len(self.yarns) + 1


def plan_carriers(piece: Piece) -> CarrierPlan:
    """Carriers that stay with a block of a colour for as long as it continues.

    A block takes over the carrier of the run below it that it shares most columns with.

    Raises
    ------
    InputError
        If the machine has too few carriers.
    """
    yarns: dict[int, int] = {}
    free: dict[int, list[int]] = {}
    active: dict[int, YarnRun] = {}
    rows = []
    for row in range(piece.chart.rows):
        runs = piece.runs(row)
        taken = _inherited(active, runs)
        ended = tuple(carrier for carrier in active if carrier not in taken.values())
        for carrier in ended:
            free.setdefault(yarns[carrier], []).append(carrier)
        new = set()
        for index, run in enumerate(runs):
            if index not in taken:
                waiting = free.get(run.yarn)
                taken[index] = waiting.pop() if waiting else len(yarns) + 1
                yarns[taken[index]] = run.yarn
                new.add(taken[index])
        if len(yarns) >= MAX_CARRIERS:
            raise InputError(
                "regions",
                f"row {row + 1} brings the blocks of colour to {len(yarns)}, each with a carrier "
                f"of its own; the machine has {MAX_CARRIERS}, one of them for waste.",
                "Use fewer or larger blocks, or knit it by hand from the written rows.",
            )
        active = {taken[index]: run for index, run in enumerate(runs)}
        placed = tuple((run, taken[index]) for index, run in enumerate(runs))
        rows.append(CarrierRow(placed, frozenset(new), ended))
    return CarrierPlan(tuple(rows), yarns)


def _inherited(active: dict[int, YarnRun], runs: tuple[YarnRun, ...]) -> dict[int, int]:
    """Carriers by the index of the run that continues with them."""
    shared = sorted(
        (
            (min(below.stop, run.stop) - max(below.start, run.start), index, carrier)
            for index, run in enumerate(runs)
            for carrier, below in active.items()
            if below.yarn == run.yarn and below.start < run.stop and run.start < below.stop
        ),
        key=lambda candidate: (-candidate[0], candidate[1]),
    )
    taken: dict[int, int] = {}
    for _, index, carrier in shared:
        if index not in taken and carrier not in taken.values():
            taken[index] = carrier
    return taken
