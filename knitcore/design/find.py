"""Find a fabric: the repeats of one or more atlases that come nearest to what is wanted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from knitcore.design.atlas import Atlas, KnittingCost, knitting_cost
from knitcore.errors import InputError
from knitcore.materials import Interval

Array = NDArray[np.float64]


class Quantity(StrEnum):
    """What can be asked of a fabric."""

    MODULUS_COURSE = "modulus_course_n_per_mm"
    MODULUS_WALE = "modulus_wale_n_per_mm"
    EXTENSIBILITY_COURSE = "extensibility_course_mm_per_n"
    EXTENSIBILITY_WALE = "extensibility_wale_mm_per_n"
    ANISOTROPY = "anisotropy"


@dataclass(frozen=True)
class Target:
    """One wish.

    Attributes
    ----------
    quantity : of what; the anisotropy is Y_course / Y_wale.
    value : wanted, above 0.
    tolerance : relative deviation that still counts as reached (0.1 = 10 %).
    weight : beside other wishes.
    """

    quantity: Quantity
    value: float
    tolerance: float = 0.10
    weight: float = 1.0

    def __post_init__(self) -> None:
        for name in ("value", "tolerance", "weight"):
            number = getattr(self, name)
            if not (math.isfinite(number) and number > 0):
                raise InputError(
                    f"targets.{self.quantity}", f"its {name} is {number:g}.", "Give more than 0."
                )


@dataclass(frozen=True)
class Candidate:
    """A repeat and how near it comes.

    Attributes
    ----------
    material : whose atlas.
    repeat : key of the repeat.
    values : the wanted quantities, predicted.
    intervals : 90 % intervals of these.
    deviations : predicted over wanted, minus one.
    misfit : weighted rms of the deviations in units of their tolerances (logarithms).
    reached : whether all deviations are within their tolerances.
    provenance : where the law comes from.
    cost : of knitting it.
    """

    material: str
    repeat: str
    values: dict[Quantity, float]
    intervals: dict[Quantity, Interval]
    deviations: dict[Quantity, float]
    misfit: float
    reached: bool
    provenance: str
    cost: KnittingCost


@dataclass(frozen=True)
class FoundFabrics:
    """The answer to a search.

    Attributes
    ----------
    candidates : best first.
    reached : whether any repeat is within all tolerances.
    ranges : what all repeats together span, by quantity.
    message : the answer in words.
    """

    candidates: tuple[Candidate, ...]
    reached: bool
    ranges: dict[Quantity, Interval]
    message: str


def find_fabric(
    atlases: Sequence[Atlas], targets: Sequence[Target], *, count: int = 10
) -> FoundFabrics:
    """Rank all repeats by their distance from the wishes; ties go to the simpler knitting.

    Parameters
    ----------
    atlases : one, or several to search across yarns and needles.
    targets : at most one of a quantity.
    count : how many candidates to return.

    Raises
    ------
    InputError
        If there is no atlas or no wish, or a quantity is wanted twice.
    """
    if not atlases or not any(len(atlas) for atlas in atlases):
        raise InputError("atlas", "there is no repeat to choose from.", "Build an atlas first.")
    wanted = [target.quantity for target in targets]
    if not targets or len(set(wanted)) < len(wanted):
        raise InputError("targets", "wishes are missing or doubled.", "Give each quantity once.")
    owner = np.concatenate([np.full(len(a), i) for i, a in enumerate(atlases)])
    index = np.concatenate([np.arange(len(a)) for a in atlases])
    tables = {q: [_values(atlas, q) for atlas in atlases] for q in wanted}
    values = {q: np.concatenate([t[0] for t in tables[q]]) for q in wanted}
    misfit, worst = _misfit(values, targets)
    # What is within all tolerances comes first even if its mean deviation is larger.
    order = np.lexsort((_simplicity(atlases), misfit.round(3), worst > 1))[:count]
    candidates = tuple(
        _candidate(atlases[owner[k]], int(index[k]), targets, float(misfit[k])) for k in order
    )
    ranges = {q: Interval(float(v.min()), float(v.max())) for q, v in values.items()}
    reached = candidates[0].reached
    return FoundFabrics(candidates, reached, ranges, _message(candidates[0], targets, ranges))


def _values(atlas: Atlas, quantity: Quantity) -> tuple[Array, Array, Array]:
    """Predicted value and the ends of its interval for every repeat."""
    course, wale = (
        tuple(atlas.column(f"modulus_{d}_{part}") for part in ("n_per_mm", "low", "high"))
        for d in ("course", "wale")
    )
    match quantity:
        case Quantity.MODULUS_COURSE:
            return course[0], course[1], course[2]
        case Quantity.MODULUS_WALE:
            return wale[0], wale[1], wale[2]
        case Quantity.EXTENSIBILITY_COURSE:
            return 1 / course[0], 1 / course[2], 1 / course[1]
        case Quantity.EXTENSIBILITY_WALE:
            return 1 / wale[0], 1 / wale[2], 1 / wale[1]
        case Quantity.ANISOTROPY:
            ratio = course[0] / wale[0]
            spread = np.hypot(np.log(course[2] / course[0]), np.log(wale[2] / wale[0]))
            return ratio, ratio / np.exp(spread), ratio * np.exp(spread)


def _misfit(values: dict[Quantity, Array], targets: Sequence[Target]) -> tuple[Array, Array]:
    """Weighted rms and largest of the deviations, in units of their tolerances."""
    weights = np.array([t.weight for t in targets])
    off = np.array([_off(values[t.quantity], t) for t in targets])
    misfit: Array = np.sqrt(weights @ off**2 / weights.sum())
    worst: Array = off.max(axis=0)
    return misfit, worst


def _off(value: Array, target: Target) -> Array:
    """How many tolerances a value is away; a hair's breadth for rounding."""
    off: Array = np.abs(np.log(value / target.value)) / math.log1p(target.tolerance)
    return off - 1e-12


def _simplicity(atlases: Sequence[Atlas]) -> Array:
    """Stitches of each repeat: a smaller one is easier to knit and to remember."""
    return np.array([float(len(key.replace("/", ""))) for atlas in atlases for key in atlas.keys])


def _candidate(atlas: Atlas, index: int, targets: Sequence[Target], misfit: float) -> Candidate:
    values, intervals, deviations = {}, {}, {}
    for target in targets:
        value, low, high = (float(v[index]) for v in _values(atlas, target.quantity))
        values[target.quantity] = value
        intervals[target.quantity] = Interval(low, high)
        deviations[target.quantity] = value / target.value - 1
    return Candidate(
        material=atlas.material,
        repeat=atlas.keys[index],
        values=values,
        intervals=intervals,
        deviations=deviations,
        misfit=misfit,
        reached=all(_off(np.array(values[t.quantity]), t) <= 1 for t in targets),
        provenance=atlas.provenance[index],
        cost=knitting_cost(atlas.chart(index)),
    )


def _message(best: Candidate, targets: Sequence[Target], ranges: dict[Quantity, Interval]) -> str:
    if best.reached:
        return f"{best.repeat} in {best.material} is within all tolerances."
    parts = []
    for target in targets:
        deviation = best.deviations[target.quantity]
        if _off(np.array(best.values[target.quantity]), target) <= 1:
            continue
        span = ranges[target.quantity]
        outside = not span.low <= target.value <= span.high
        reach = (
            f"all repeats span {span.low:.3g} to {span.high:.3g}"
            if outside
            else (
                "others reach it, but not together with the rest"
                if len(targets) > 1
                else "no repeat lies nearer"
            )
        )
        parts.append(f"{target.quantity} {deviation:+.0%} ({reach})")
    return (
        f"Nothing reaches this. Nearest is {best.repeat} in {best.material}: {'; '.join(parts)}. "
        "Widen a tolerance, or search more yarns and needles."
    )
