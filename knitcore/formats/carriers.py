"""Carriers of a machine for the stitches of a piece: one for each block of colour (intarsia)."""

from __future__ import annotations

from dataclasses import dataclass

from knitcore.errors import InputError
from knitcore.garment.piece import Piece, Stretch

MAX_CARRIERS = 10
"""Carriers of a Shima Seiki SWG091N2 and of the virtual machine; one is kept for waste yarn."""


@dataclass(frozen=True)
class CarrierRow:
    """A row's stretches, each with its carrier, from left to right.

    Attributes
    ----------
    stretches : with their carriers.
    new : carriers that are brought in for this row.
    ended : carriers that knitted the row below and are taken out.
    """

    stretches: tuple[tuple[Stretch, int], ...]
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

    A block takes over the carrier of the stretch below it that it shares most columns with.

    Raises
    ------
    InputError
        If the machine has too few carriers.
    """
    yarns: dict[int, int] = {}
    free: dict[int, list[int]] = {}
    active: dict[int, Stretch] = {}
    rows = []
    for row in range(piece.chart.rows):
        stretches = piece.stretches(row)
        taken = _inherited(active, stretches)
        ended = tuple(carrier for carrier in active if carrier not in taken.values())
        for carrier in ended:
            free.setdefault(yarns[carrier], []).append(carrier)
        new = set()
        for index, stretch in enumerate(stretches):
            if index not in taken:
                waiting = free.get(stretch.yarn)
                taken[index] = waiting.pop() if waiting else len(yarns) + 1
                yarns[taken[index]] = stretch.yarn
                new.add(taken[index])
        if len(yarns) >= MAX_CARRIERS:
            raise InputError(
                "regions",
                f"row {row + 1} brings the blocks of colour to {len(yarns)}, each with a carrier "
                f"of its own; the machine has {MAX_CARRIERS}, one of them for waste.",
                "Use fewer or larger blocks, or knit it by hand from the written rows.",
            )
        active = {taken[index]: stretch for index, stretch in enumerate(stretches)}
        placed = tuple((stretch, taken[index]) for index, stretch in enumerate(stretches))
        rows.append(CarrierRow(placed, frozenset(new), ended))
    return CarrierPlan(tuple(rows), yarns)


def _inherited(active: dict[int, Stretch], stretches: tuple[Stretch, ...]) -> dict[int, int]:
    """Carriers by the index of the stretch that continues with them."""
    shared = sorted(
        (
            (min(below.stop, stretch.stop) - max(below.start, stretch.start), index, carrier)
            for index, stretch in enumerate(stretches)
            for carrier, below in active.items()
            if carrier_fits(below, stretch)
        ),
        key=lambda found: (-found[0], found[1]),
    )
    taken: dict[int, int] = {}
    for _, index, carrier in shared:
        if index not in taken and carrier not in taken.values():
            taken[index] = carrier
    return taken


def carrier_fits(below: Stretch, stretch: Stretch) -> bool:
    """Whether a stretch of one row can continue with the yarn of one in the row below."""
    return below.yarn == stretch.yarn and below.start < stretch.stop and stretch.start < below.stop
