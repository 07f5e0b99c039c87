"""Report the targets that a filled chart misses, patch by patch, and suggest alternatives."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction
from knitcore.design.atlas import Atlas
from knitcore.materials.law_uncertainty import Interval

OFF = 0.10
"""Relative deviation above which a stitch counts as off."""


@dataclass(frozen=True)
class Patch:
    """A region of one repeat.

    Attributes
    ----------
    part : name of the part that it fills; empty if the targets are a map.
    repeat : its key.
    stitches : number of its stitches.
    row, column : of its first stitch, from 0 at the bottom left.
    deviation_course, deviation_wale : the repeat's effective modulus over the median of the wanted
        ones, minus one; NaN without a target.
    swatch_course, swatch_wale : the same for the patch in the finite swatch, where its size and its
        neighbours have an effect; NaN without a target, or if it was not pulled.
    modulus_course_n_per_mm, modulus_wale_n_per_mm : of the patch in the swatch, if it was pulled;
        their 90 % intervals hold those of a large cloth of the repeat, too, which is cut off at
        the patch's edge.
    """

    part: str
    repeat: str
    stitches: int
    row: int
    column: int
    deviation_course: float
    deviation_wale: float
    swatch_course: float
    swatch_wale: float
    modulus_course_n_per_mm: float
    modulus_course_interval_n_per_mm: Interval
    modulus_wale_n_per_mm: float
    modulus_wale_interval_n_per_mm: Interval


def unreached(regions: Sequence[Patch], targets: Array, off: Array, have: Array) -> list[str]:
    """Write one message for each missed target, with an alternative; equal patches share it.

    Parameters
    ----------
    regions : the patches.
    targets : (patches, 2) logarithms of the wanted moduli, NaN where there is no target.
    off : (patches, 2) relative deviations.
    have : (repeats, 2) logarithms of the moduli of all repeats.
    """
    said = []
    reported = set()
    for region, target, away in zip(regions, targets, off, strict=True):
        for axis, direction in enumerate(Direction):
            alike = region.part, region.repeat, float(target[axis]), axis
            if abs(away[axis]) > OFF and alike not in reported:
                reported.add(alike)
                where = (
                    f"“{region.part}”"
                    if region.part
                    else f"The patch of {region.stitches} stitches that begins in row "
                    f"{region.row + 1}, column {region.column + 1}"
                )
                said.append(
                    f"{where} is {_compared(away[axis])} {direction}-wise than wanted. "
                    f"{region.repeat} comes nearest. {_reach(target, direction, have)}"
                )
    if len(regions) == 1:
        only = regions[0]
        there = np.array([only.swatch_course, only.swatch_wale])
        if (np.abs(there) > OFF).any():
            differs = [
                f"{_compared(away)} {direction}-wise"
                for away, direction in zip(there, Direction, strict=True)
                if not np.isnan(away)
            ]
            said.append(
                f"A swatch of just this size, with free edges, is {' and '.join(differs)} than "
                "wanted."
            )
    return said


@dataclass(frozen=True)
class Nearest:
    """The repeat of an atlas that is nearest to a target, whatever it was before.

    Attributes
    ----------
    repeat : its key.
    course_n_per_mm, wale_n_per_mm : moduli of a large cloth of it.
    """

    repeat: str
    course_n_per_mm: float
    wale_n_per_mm: float


def nearest_repeat(target: Array, atlas: Atlas) -> Nearest:
    """Choose the repeat nearest to a target.

    Parameters
    ----------
    target : (2,) logarithms of moduli; NaN where any value will do.
    atlas : repeats to choose from.
    """
    entry = int(np.nansum((atlas.log_moduli - target) ** 2, axis=1).argmin())
    return Nearest(atlas.keys[entry], *np.exp(atlas.log_moduli[entry]).tolist())


def left_alone(name: str, target: Array, now: Array, nearest: Nearest) -> str:
    """Say why a part stays as it is, and what comes nearest.

    Parameters
    ----------
    name : of the part.
    target, now : (2,) logarithms of its moduli; a target is NaN where any value will do.
    nearest : to the target.
    """
    off = np.nan_to_num(np.expm1(now - target))
    if (np.abs(off) <= OFF).all():
        return f"“{name}” is as wanted already, and stays as it is."
    differs = " and ".join(
        f"{_compared(away)} {direction}-wise"
        for away, direction in zip(off, Direction, strict=True)
        if abs(away) > OFF
    )
    no_farther = "" if np.isnan(target).any() else " without going away in the other direction"
    return (
        f"“{name}” stays as it is, {differs} than wanted: no repeat that was tried comes 10 % "
        f"nearer{no_farther}. The nearest, {nearest.repeat}, has {nearest.course_n_per_mm:.3g} "
        f"N/mm course-wise and {nearest.wale_n_per_mm:.3g} N/mm wale-wise in a large cloth."
    )


def _compared(away: float) -> str:
    times = max(1 + away, 1 / (1 + away))
    more = f"{times:.1f} times" if times >= 2 else f"{100 * (times - 1):.0f} %"
    return f"{more} {'stiffer' if away > 0 else 'softer'}"


def _reach(target: Array, direction: Direction, have: Array) -> str:
    """Describe the moduli that repeats of this yarn can reach."""
    own, other = direction.axis, direction.other.axis
    whole = np.exp(have[:, own])
    text = (
        f"In this yarn, repeats have {whole.min():.3g} to {whole.max():.3g} N/mm {direction}-wise"
    )
    if not np.isnan(target[other]):
        near = np.abs(have[:, other] - target[other]) < OFF
        condition = f"the wanted {np.exp(target[other]):.3g} N/mm {direction.other}-wise"
        if near.any():
            part = np.exp(have[near, own])
            text += f"; those with {condition} have {part.min():.3g} to {part.max():.3g}"
        else:
            text += f", and none has {condition}"
    return text + ". Other yarns or needles may come closer."
