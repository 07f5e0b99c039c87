"""Pictures for AYAB, which drives the needle selection of Brother's electronic machines.

One pixel is a stitch, the lowest line is row 1, and the picture is as the needles stand before the
knitter: AYAB 1.0 knits a picture so that the side which looks at the knitter shows it, unless "Knit
Side Image" is ticked. It takes two colours for one bed and two to six with a ribber, cuts what is
wider than the bed, and repeats nothing by itself to the sides.

Sources: AllYarnsAreBeautiful/ayab-desktop, ``engine/pattern.py`` (colours, places),
``engine/mode.py`` (modes and their numbers of colours), ``engine/control.py`` (what is cut), issues
604 and 613 (mirroring).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Codes
from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.garment.piece import Piece
from knitcore.machine.home.needle_selection import NeedleSelection, Selected, needle_selection
from knitcore.machine.profile import MachineProfile

NEEDLES = 200
MOST_COLOURS = 6


@dataclass(frozen=True, eq=False)
class AyabPicture:
    """A picture of needles.

    Attributes
    ----------
    grey : uint8 (rows, needles), the last row first: white for the main yarn, or for stitches
        without work by hand; black for the others; greys between for further yarns.
    mode : of AYAB's settings.
    notes : what to set, and what to do by hand.
    """

    grey: Codes
    mode: str
    notes: tuple[str, ...]


def ayab_picture(chart: StitchChart | Piece, profile: MachineProfile) -> AyabPicture:
    """Draw the needles that AYAB selects.

    Raises
    ------
    InputError
        If the piece is wider than the bed, has too many yarns, or selecting needles cannot knit it.

    Examples
    --------
    >>> from knitcore.machine.profile import profile
    >>> ayab_picture(StitchChart.parse("PKKK"), profile("ayab")).grey.tolist()
    [[255, 255, 255, 0]]
    """
    piece = Piece.of(chart)
    if profile.identifier.startswith("silver-reed"):
        problem = "AYAB drives Brother's electronic machines, not Silver Reed's."
        raise InputError("machine", problem, "Choose Brother, with or without ribber, or AYAB.")
    if piece.cropped().chart.columns > NEEDLES:
        problem = f"{piece.chart.columns} stitches are wider than the {NEEDLES} needles of AYAB."
        raise InputError("chart", problem, f"Knit pieces of at most {NEEDLES} and join them.")
    selection = needle_selection(piece, profile)
    colours = max(len(selection.yarns), 2)
    if colours > MOST_COLOURS:
        problem = f"AYAB takes at most {MOST_COLOURS} yarns, the design has {colours}."
        raise InputError("yarns", problem, f"Use {MOST_COLOURS} yarns or fewer.")
    levels = selection.levels[::-1]
    grey = np.rint(255 * (1 - levels / (colours - 1))).astype(np.uint8)
    ribber = profile.beds > 1 and selection.selected is Selected.COLOURS
    mode = "Ribber: Classic" if ribber else "Singlebed"
    return AyabPicture(grey, mode, _notes(selection, mode, colours))


def _notes(selection: NeedleSelection, mode: str, colours: int) -> tuple[str, ...]:
    columns = selection.levels.shape[1]
    left = (columns + 1) // 2
    stop = f"R{columns - left}" if columns > 1 else "L1"
    shades = ("white", "black") if colours == 2 else ("white", *("grey",) * (colours - 2), "black")
    yarns = "; ".join(
        f"{shade} {yarn}" for shade, yarn in zip(shades, selection.yarns, strict=False)
    )
    return (
        f"AYAB 1.0: mode {mode}, {colours} colours, needles L{left} to {stop}.",
        "Leave “Knit Side Image” unticked: the picture is drawn as the needles stand before you. "
        "Versions before 1.0 mirror every picture: mirror it once there.",
        *((f"Yarns: {yarns}.",) if yarns else ()),
        *selection.notes,
    )
