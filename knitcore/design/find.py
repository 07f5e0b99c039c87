"""Find a fabric: the repeats of one or more atlases that meet the targets most surely."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from knitcore.base.arrays import Array, Indices
from knitcore.base.errors import InputError
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart
from knitcore.design.atlas import Atlas
from knitcore.design.cost import CostLimits, KnittingCost
from knitcore.design.targets import Quantity, Target, WornTube, values_of
from knitcore.materials import Interval, Laws
from knitcore.materials.library import INCONSISTENT

__all__ = ["Candidate", "FabricMatches", "Quantity", "Target", "WornTube", "find_fabric"]

_LONG = 24
"""Most characters of a repeat that a sentence spells out."""


@dataclass(frozen=True, repr=False)
class Candidate(Result):
    """A repeat, and how near it comes to the targets.

    Attributes
    ----------
    material : whose atlas.
    repeat : key of the repeat.
    values : predictions by the targets' labels; NaN where there is none, such as a pressure beyond
        the lock-up.
    intervals : 90 % intervals of these.
    deviations : predicted over target, minus one; the difference for Poisson's ratios.
    chance : that all quantities are within their tolerances, by their intervals and as if
        independent.
    misfit : weighted rms of the deviations in units of their tolerances (logarithms).
    reached : whether all deviations are within their tolerances.
    provenance : where the law comes from.
    cost : of knitting it.
    """

    material: str
    repeat: str
    values: dict[str, float]
    intervals: dict[str, Interval]
    deviations: dict[str, float]
    chance: float
    misfit: float
    reached: bool
    provenance: str
    cost: KnittingCost


@dataclass(frozen=True, repr=False)
class FabricMatches(Result):
    """The result of a search.

    Attributes
    ----------
    candidates : the surest first.
    reached : whether any repeat is predicted within all tolerances.
    ranges : what all repeats together span, by label.
    message : the result in words.
    """

    candidates: tuple[Candidate, ...]
    reached: bool
    ranges: dict[str, Interval]
    message: str


def find_fabric(
    atlases: Atlas | Sequence[Atlas],
    targets: Target | Sequence[Target],
    *,
    count: int = 10,
    limits: CostLimits | None = None,
) -> FabricMatches:
    """Rank all repeats by how surely they meet the targets.

    Repeats are sorted by their chance to the nearest per cent, then by the weighted rms of their
    deviations; of equals the smaller repeat comes first.

    Parameters
    ----------
    atlases : one, or several to search across yarns and needles.
    targets : one or several, at most one for each quantity (at one load, on one limb).
    count : how many candidates to return.
    limits : repeats that cost more are left out.

    Raises
    ------
    InputError
        If there is no atlas or no target, a target is given twice, or no repeat keeps within the
        limits.
    """
    atlases = [atlases] if isinstance(atlases, Atlas) else atlases
    targets = [targets] if isinstance(targets, Target) else targets
    if not atlases or not any(len(atlas) for atlas in atlases):
        raise InputError(
            "atlas",
            "there is no repeat to choose from.",
            "Build an atlas with `knitcore atlas`, and give it.",
        )
    labels = [target.label for target in targets]
    if not targets or len(set(labels)) < len(labels):
        raise InputError(
            "targets", "targets are missing or given twice.", "Give each quantity once."
        )
    allowed = [_allowed(atlas, limits) for atlas in atlases]
    if not any(len(indices) for indices in allowed):
        raise InputError("limits", "no repeat is within all of them.", _easiest(atlases))
    tables = [
        {target.label: np.stack(values_of(atlas, target))[:, indices] for target in targets}
        for atlas, indices in zip(atlases, allowed, strict=True)
    ]
    owner = np.concatenate([np.full(len(rows), k) for k, rows in enumerate(allowed)])
    index = np.concatenate(allowed)
    values = {
        t.label: np.concatenate([table[t.label] for table in tables], axis=1) for t in targets
    }
    misfit, worst = _misfit(values, targets)
    chance = np.prod([target.chance(*values[target.label]) for target in targets], axis=0)
    stitches = np.concatenate([a.stitches[rows] for a, rows in zip(atlases, allowed, strict=True)])
    doubtful = np.array(
        [_doubtful(atlases[k], int(i), targets) for k, i in zip(owner, index, strict=True)]
    )
    # What rests on contradictory figures never comes first.
    order = np.lexsort((stitches, misfit.round(3), -chance.round(2), doubtful))[:count]
    candidates = tuple(
        _candidate(
            atlases[owner[k]],
            int(index[k]),
            {label: table[:, k] for label, table in values.items()},
            targets,
            float(chance[k]),
            float(misfit[k]),
        )
        for k in order
    )
    ranges = {
        label: Interval(float(table[0, known].min()), float(table[0, known].max()))
        for label, table in values.items()
        if (known := ~np.isnan(table[0])).any()
    }
    reached = bool(np.any(worst <= 1))
    message = _most_surely(candidates[0]) if reached else _nothing(candidates[0], targets, ranges)
    return FabricMatches(candidates, reached, ranges, message)


def _doubtful(atlas: Atlas, index: int, targets: Sequence[Target]) -> bool:
    """Say whether a repeat's published figures contradict each other in a targeted direction."""
    targeted = {target.quantity.direction for target in targets}
    return any(
        atlas.material == Laws.PUBLISHED.of(yarn)
        and bool(targeted & directions)
        and _canonical(atlas.keys[index]) == StitchChart.of_fabric(fabric).canonical().key
        for (yarn, fabric), directions in INCONSISTENT.items()
    )


@cache
def _canonical(key: str) -> str:
    return StitchChart.parse(key).canonical().key


def _allowed(atlas: Atlas, limits: CostLimits | None) -> Indices:
    if limits is None:
        return np.arange(len(atlas))
    return np.flatnonzero([limits.allow(cost) for cost in atlas.costs])


def _easiest(atlases: Sequence[Atlas]) -> str:
    costs = [cost for atlas in atlases for cost in atlas.costs]
    return (
        "Relax one: the least of all repeats are "
        f"{min(c.transfers_per_stitch for c in costs):.2g} transfers and "
        f"{min(c.crossings_per_stitch for c in costs):.2g} crossings per stitch and a curl of "
        f"{min(abs(c.curl) for c in costs):.2g}, but no repeat has all three."
    )


def _misfit(values: Mapping[str, Array], targets: Sequence[Target]) -> tuple[Array, Array]:
    """Weighted rms of the deviations in tolerances, and the largest."""
    off = np.stack([target.off(values[target.label][0]) for target in targets])
    weight = np.array([target.weight for target in targets])
    mean = np.sqrt((weight[:, None] * off**2).sum(axis=0) / weight.sum())
    return mean, off.max(axis=0)


def _candidate(
    atlas: Atlas,
    index: int,
    rows: Mapping[str, Array],
    targets: Sequence[Target],
    chance: float,
    misfit: float,
) -> Candidate:
    values = {label: float(row[0]) for label, row in rows.items()}
    return Candidate(
        material=atlas.material,
        repeat=atlas.keys[index],
        values=values,
        intervals={label: Interval(float(r[1]), float(r[2])) for label, r in rows.items()},
        deviations={t.label: t.deviation(values[t.label]) for t in targets},
        chance=chance,
        misfit=misfit,
        reached=all(float(t.off(np.array(values[t.label]))) <= 1 for t in targets),
        provenance=atlas.provenance[index],
        cost=atlas.costs[index],
    )


def _most_surely(best: Candidate) -> str:
    return (
        f"{_short(best)} in {best.material} is the most likely to meet the targets, "
        f"with a probability of {best.chance:.0%}."
    )


def _nothing(best: Candidate, targets: Sequence[Target], ranges: dict[str, Interval]) -> str:
    parts = [
        f"{_departure(best, target)} ({_reach(target, ranges.get(target.label), len(targets) > 1)})"
        for target in targets
        if float(target.off(np.array(best.values[target.label]))) > 1
    ]
    return (
        f"No repeat meets this. The nearest is {_short(best)} in {best.material}: "
        f"{'; '.join(parts)}. "
        "Widen a tolerance, or search more yarns and needles."
    )


def _short(candidate: Candidate) -> str:
    rows = candidate.repeat.split("/")
    if len(candidate.repeat) <= _LONG:
        return candidate.repeat
    return f"a repeat of {len(rows[0])} x {len(rows)} stitches"


def _departure(best: Candidate, target: Target) -> str:
    deviation = best.deviations[target.label]
    if np.isnan(deviation):
        return f"{target.label} beyond the lock-up"
    if target.quantity.is_poisson:
        return f"{target.label} {deviation:+.2f}"
    return f"{target.label} {deviation:+.0%}"


def _reach(target: Target, span: Interval | None, together: bool) -> str:
    if span is None:
        return "no repeat stretches that far"
    if not span.low <= target.value <= span.high:
        return f"all repeats span {span.low:.3g} to {span.high:.3g}"
    return "others reach it, but not the other targets" if together else "no repeat is nearer"
