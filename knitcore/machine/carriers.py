"""Carriers of a machine for the stitches of a piece: one for each block of colour (intarsia)."""

from dataclasses import dataclass

from knitcore.base.errors import InputError
from knitcore.garment.piece import Piece, YarnRun
from knitcore.machine.profile import CarrierPark


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
    """The carriers of all rows, and which yarn (an index) each holds.

    Attributes
    ----------
    waste : the carrier of waste yarn and separate strands.
    draw : the carrier of the draw thread; that of waste yarn if all others hold yarns.
    """

    rows: tuple[CarrierRow, ...]
    yarns: dict[int, int]
    waste: int
    draw: int | None = None

    def next_row(self, carrier: int, first: int) -> int | None:
        """The row from ``first`` on that brings a carrier in; it may be that which ends its block.

        None if no row does.
        """
        rows = range(first, len(self.rows))
        return next((row for row in rows if carrier in self.rows[row].new), None)


def plan_carriers(piece: Piece, park: CarrierPark) -> CarrierPlan:
    """Carriers that stay with a block of a colour for as long as it continues.

    A block takes over the carrier of the run below it that it shares most columns with. The draw
    thread's carrier is the last to be used: waste yarn can take its place.

    Raises
    ------
    InputError
        If the machine has too few carriers.
    """
    yarns: dict[int, int] = {}
    names = [c for c in range(1, park.count + 1) if c not in (park.waste, park.draw)]
    if park.waste is None:
        del names[-1]
    if park.draw is not None:
        names.append(park.draw)
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
                if not waiting and len(yarns) == len(names):
                    blocks = len(yarns) + len(runs) - len(taken)
                    raise InputError(
                        "regions",
                        f"row {row + 1} brings the blocks of colour to {blocks}, each with a "
                        f"carrier of its own; the machine has {park.count}, one of them for waste.",
                        "Use fewer or larger blocks, or knit it by hand from the written rows.",
                    )
                taken[index] = waiting.pop() if waiting else names[len(yarns)]
                yarns[taken[index]] = run.yarn
                new.add(taken[index])
        active = {taken[index]: run for index, run in enumerate(runs)}
        placed = tuple((run, taken[index]) for index, run in enumerate(runs))
        rows.append(CarrierRow(placed, frozenset(new), ended))
    waste = park.waste or next(c for c in range(1, park.count + 1) if c not in yarns)
    return CarrierPlan(tuple(rows), yarns, waste, waste if park.draw in yarns else park.draw)


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
