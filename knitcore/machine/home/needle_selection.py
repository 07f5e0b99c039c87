"""Needles that a patterning machine selects for a piece, row by row: for AYAB and for punch cards.

A home machine selects needles; what they do then depends on its buttons. Two kinds of design make
sense:

- colours: all stitches are alike and several yarns are used. In a row the selected needles knit the
  second yarn (Fair Isle), or with a ribber each yarn in turn (jacquard).
- work by hand: purls of one yarn. No button makes a purl, so none is pressed: all needles knit, and
  the selected ones show which stitches are re-formed, or hung onto the ribber, by hand.

Tuck and slip make other stitches than knits and purls; a design of knits and purls has none.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from knitcore.base.arrays import Indices, Mask
from knitcore.base.errors import InputError
from knitcore.garment.piece import Piece
from knitcore.machine.home.needle_places import (
    check_home,
    facing,
    on_needles,
    other_stitches,
    side_words,
)
from knitcore.machine.profile import MachineProfile


class Selected(StrEnum):
    """The meaning of selected needles."""

    COLOURS = "colours"
    HAND = "hand"


@dataclass(frozen=True, eq=False)
class NeedleSelection:
    """The needles by row.

    Attributes
    ----------
    levels : int (rows, places), row 0 at the bottom, places from the knitter's left: 1 for selected
        needles, more for further yarns, 0 for all others.
    yarns : names of the yarns by level; none where the selection is for work by hand.
    notes : for the knitter.
    """

    selected: Selected
    levels: Indices
    yarns: tuple[str, ...]
    notes: tuple[str, ...]


def needle_selection(piece: Piece, profile: MachineProfile) -> NeedleSelection:
    """Choose what is selected, and mirror it as the knitter sees the needles.

    Raises
    ------
    InputError
        If there is nothing to select, or a picture cannot hold it; the remedy names another way.
    """
    piece = piece.cropped()
    check_home(piece, profile)
    toward = facing(piece)
    other = other_stitches(piece, toward)
    if len(piece.yarns) == 1:
        if not other.any():
            problem = "every stitch is alike and of one yarn: there is nothing to select."
            raise InputError("chart", problem, "Knit it plain, without a pattern.")
        return NeedleSelection(
            Selected.HAND, other.astype(np.intp), (), _hand_notes(profile, toward)
        )
    if other.any():
        raise InputError(
            "chart",
            "it has purls and several yarns, and a selected needle can mean only one of them.",
            "Make all stitches knits for a picture of the colours, give it one yarn for one of the "
            "purls, or export the hand plan, which has both.",
        )
    if profile.beds == 1 and len(piece.yarns) > 2:
        problem = f"it has {len(piece.yarns)} yarns; one bed selects between two in a row."
        raise InputError("yarns", problem, "Use two yarns, or a machine with a ribber.")
    counts = [np.count_nonzero(piece.cells(index)) for index in range(len(piece.yarns))]
    order = sorted(range(len(counts)), key=lambda index: -counts[index])
    level = np.argsort(order)
    levels = on_needles(level[piece.yarn_of] * piece.shaped.stitch, toward)
    names = tuple(piece.yarns[index].name for index in order)
    return NeedleSelection(Selected.COLOURS, levels, names, _colour_notes(piece, profile))


def _hand_notes(profile: MachineProfile, toward: Mask) -> tuple[str, ...]:
    hand = "latch up their stitches as knits after the row."
    if profile.beds > 1:
        hand = "they belong on the ribber; transfer where the selection changes."
    return (
        "One bed cannot purl by itself: this is a guide for work by hand.",
        f"Press no button, so that all needles knit. Where needles come forward, {hand}",
        side_words(toward),
        "Tuck and slip would make other stitches than this chart has.",
    )


def _colour_notes(piece: Piece, profile: MachineProfile) -> tuple[str, ...]:
    if profile.beds > 1:
        return ("Jacquard: each row is knitted once or twice with each yarn.",)
    longest = max(
        (
            run.stop - run.start
            for row in range(piece.chart.rows)
            for run in piece.runs(row)
            if len({other.yarn for other in piece.runs(row)}) > 1
        ),
        default=0,
    )
    notes = ["Fair Isle: press the Fair Isle button; the yarn that does not knit floats behind."]
    if longest > profile.longest_float_needles:
        notes.append(
            f"The longest float passes {longest} needles; over {profile.longest_float_needles} it "
            "catches: hang it up by hand, or break the area with single stitches."
        )
    return tuple(notes)
