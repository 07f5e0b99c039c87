"""A knitted tube on a limb whose girth changes along its length: a sleeve, a sock, a wrist."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from knitcore.answer.answer import Along
from knitcore.answer.tube import TubePressure, tube_pressure
from knitcore.arrays import Array
from knitcore.errors import InputError

PLACES = 21
"""Places along the limb, evenly spaced."""
MAX_GIRTHS = 100
LEAST_GIRTH_MM = 10.0
"""Half of what the thinnest finger measures around."""


@dataclass(frozen=True)
class MeasuredLimb:
    """A limb by its girths, which change evenly between the places where they were taken.

    Attributes
    ----------
    at_mm : increasing places along the limb, two at least.
    girths_mm : there.

    Raises
    ------
    InputError
        If the lists do not fit each other, the places do not increase, or a girth is too small.
    """

    at_mm: tuple[float, ...]
    girths_mm: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.at_mm) != len(self.girths_mm) or not 2 <= len(self.at_mm) <= MAX_GIRTHS:
            raise InputError(
                "girths",
                "the lists differ in length.",
                f"Give 2 to {MAX_GIRTHS} places, and as many sizes.",
            )
        if min(np.diff(self.at_mm)) <= 0.0:
            raise InputError("girths", "the places do not increase.", "Give them in order.")
        if min(self.girths_mm) < LEAST_GIRTH_MM:
            raise InputError(
                "girths",
                f"{min(self.girths_mm):g} mm around is no limb and no tube.",
                f"Give {LEAST_GIRTH_MM:g} mm or more: the length around, not the width.",
            )

    def girth_mm(self, at_mm: Array) -> Array:
        """Circumference at places along the limb; beyond its ends that of the end."""
        return np.interp(at_mm, self.at_mm, self.girths_mm)


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

    @property
    def axial_strain(self) -> float:
        """Along the limb, where nothing holds the tube."""
        return 0.0 if self.pressure is None else self.pressure.axial_strain_free


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
    places : at which the fit is given.

    Raises
    ------
    InputError
        If the lists do not fit each other or their places do not increase.
    """
    limb = MeasuredLimb(tuple(at_mm), tuple(girths_mm))
    rest = MeasuredLimb(limb.at_mm, tuple(rests_mm))
    at = np.linspace(limb.at_mm[0], limb.at_mm[-1], places)
    sizes = zip(at.tolist(), limb.girth_mm(at).tolist(), rest.girth_mm(at).tolist(), strict=True)
    return tuple(place_on(along, *size) for size in sizes)


def place_on(along: Along, at_mm: float, girth_mm: float, rest_mm: float) -> LimbPlace:
    """Fit of a tube at one place of a limb.

    Parameters
    ----------
    along : the chart's answer for a pull around the limb.
    at_mm, girth_mm, rest_mm : as in :class:`LimbPlace`.
    """
    share = max(girth_mm / rest_mm - 1.0, 0.0) / along.response.lock_up_strain
    try:
        found = tube_pressure(along, rest_mm, girth_mm)
    except InputError as error:
        problem = f"{error.problem} {error.remedy}"
        return LimbPlace(at_mm, rest_mm, girth_mm, share, None, problem)
    return LimbPlace(at_mm, rest_mm, girth_mm, share, found)
