"""A knitted tube on a limb whose girth changes along its length: a sleeve, a sock, a wrist."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from knitcore.answer.answer import Along
from knitcore.answer.tube import TubePressure, tube_pressure
from knitcore.errors import InputError
from knitcore.law.response import MAX_STRESS_N_PER_MM

PLACES = 21
"""Places along the limb, evenly spaced."""
MAX_GIRTHS = 100


@dataclass(frozen=True)
class LimbPlace:
    """One place along the limb.

    Attributes
    ----------
    at_mm : along the limb.
    rest_mm, girth_mm : circumferences of the unworn tube, and of the limb.
    lock_up_share : strain around the limb over that at which the chart is locked.
    pressure : None where there is none.
    problem : why there is none, such as a loose fit; else empty.
    """

    at_mm: float
    rest_mm: float
    girth_mm: float
    lock_up_share: float
    pressure: TubePressure | None
    problem: str = ""

    @property
    def ease(self) -> float:
        """Circumference of the tube over that of the limb, minus one: negative where stretched."""
        return self.rest_mm / self.girth_mm - 1.0


def on_limb(
    along: Along,
    at_mm: Sequence[float],
    girths_mm: Sequence[float],
    rests_mm: Sequence[float],
    *,
    places: int = PLACES,
) -> tuple[LimbPlace, ...]:
    """Fit and pressure of a tube along a limb; girths change evenly between those given.

    Parameters
    ----------
    along : the chart's answer for a pull around the limb.
    at_mm : increasing places along the limb at which girths are given, two at least.
    girths_mm, rests_mm : of the limb and of the unworn tube there.
    places : at which the fit is told.

    Raises
    ------
    InputError
        If the lists do not fit each other or their places do not increase.
    """
    known = [np.asarray(values, dtype=float) for values in (at_mm, girths_mm, rests_mm)]
    if len({len(values) for values in known}) > 1 or not 2 <= len(known[0]) <= MAX_GIRTHS:
        raise InputError(
            "girths", "they do not fit each other.", f"Give 2 to {MAX_GIRTHS} of each, all alike."
        )
    if not (np.diff(known[0]) > 0.0).all() or not all((v > 0.0).all() for v in known[1:]):
        raise InputError(
            "girths", "a place or a size is out of order.", "Give increasing places and sizes."
        )
    lock = float(along.strain(MAX_STRESS_N_PER_MM))
    at = np.linspace(known[0][0], known[0][-1], places)
    girths, rests = (np.interp(at, known[0], values) for values in known[1:])
    return tuple(
        _place(along, lock, *(float(value) for value in place))
        for place in zip(at, girths, rests, strict=True)
    )


def _place(along: Along, lock: float, at_mm: float, girth_mm: float, rest_mm: float) -> LimbPlace:
    share = max(girth_mm / rest_mm - 1.0, 0.0) / lock
    try:
        found = tube_pressure(along, rest_mm, girth_mm)
    except InputError as error:
        problem = f"{error.problem} {error.remedy}"
        return LimbPlace(at_mm, rest_mm, girth_mm, share, None, problem)
    return LimbPlace(at_mm, rest_mm, girth_mm, share, found)
