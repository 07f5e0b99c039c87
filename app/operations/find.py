"""Fabrics that do what is wanted, in one yarn or across many."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from pydantic import BaseModel, ConfigDict, Field

from app.operations.atlas import Cancelled, Extent, Progress, cached_atlas
from knitcore.design.atlas import Atlas
from knitcore.design.cost import CostLimits
from knitcore.design.find import Candidate, FoundFabrics, find_fabric
from knitcore.design.targets import USUAL_LOAD_N_PER_MM, Limb, Quantity, Target
from knitcore.materials import Interval, load_library

MAX_MATERIALS = 16
MAX_TARGETS = 20
ELSEWHERE = 3
"""Fabrics of other yarns that are offered where the wanted ones reach nothing."""


class LimbInput(BaseModel):
    """A tube on a limb."""

    model_config = ConfigDict(extra="forbid")

    rest_mm: float = Field(gt=0, le=5000, allow_inf_nan=False, description="Of the unworn tube.")
    worn_mm: float = Field(gt=0, le=5000, allow_inf_nan=False, description="Of the limb.")


class TargetInput(BaseModel):
    """One wish for a fabric."""

    model_config = ConfigDict(extra="forbid")

    quantity: Quantity
    value: float = Field(
        ge=-10, le=1e6, allow_inf_nan=False, description="Stretch as a strain: 0.5 is 50 %."
    )
    tolerance: float = Field(
        0.10, gt=0, le=10, description="Relative (0.1 is 10 %); a difference for Poisson's ratios."
    )
    weight: float = Field(1.0, gt=0, le=1000)
    load_n_per_mm: float = Field(
        USUAL_LOAD_N_PER_MM, gt=0, le=0.5, description="For a stretch, per width of the cloth."
    )
    limb: LimbInput | None = Field(None, description="For a pressure.")

    def target(self) -> Target:
        """As the library knows it."""
        limb = None if self.limb is None else Limb(self.limb.rest_mm, self.limb.worn_mm)
        return Target(
            self.quantity, self.value, self.tolerance, self.weight, self.load_n_per_mm, limb
        )


class LimitsInput(BaseModel):
    """The most that knitting may ask; null is no limit."""

    model_config = ConfigDict(extra="forbid")

    transfers_per_stitch: float | None = Field(None, ge=0, le=1)
    crossings_per_stitch: float | None = Field(None, ge=0, le=1)
    curl: float | None = Field(
        None, ge=0, le=1, description="Knits minus purls over all stitches, either way."
    )

    def limits(self) -> CostLimits:
        """As the library knows them."""
        return CostLimits(self.transfers_per_stitch, self.crossings_per_stitch, self.curl)


class FindRequest(BaseModel):
    """Wishes, and the yarns to search."""

    model_config = ConfigDict(extra="forbid")

    materials: list[str] = Field(min_length=1, max_length=MAX_MATERIALS)
    targets: list[TargetInput] = Field(min_length=1, max_length=MAX_TARGETS)
    limits: LimitsInput | None = None
    repeats: Extent = Field(
        "small",
        description="small: up to 3x3 and a choice of larger ones; all: up to 4x4 and stripes of "
        "two fabrics.",
    )
    count: int = Field(10, ge=1, le=100)
    elsewhere: bool = Field(
        True, description="Where nothing reaches the wishes, look into the other yarns too."
    )


class CandidateResult(BaseModel):
    """A repeat and how near it comes."""

    material: str
    chart: str = Field(description="K/P lines of one repeat, the top row first.")
    values: dict[str, float | None] = Field(
        description="By quantity, with @load or @rest/worn; null beyond the lock-up."
    )
    intervals: dict[str, tuple[float | None, float | None]] = Field(
        description="90 % intervals; null where an end lies beyond the computed curve."
    )
    deviations: dict[str, float | None] = Field(
        description="Predicted over wanted, minus one; the difference for Poisson's ratios."
    )
    misfit: float | None = Field(
        description="Weighted rms of deviations in units of their tolerances."
    )
    reached: bool
    provenance: str
    transfers_per_stitch: float
    crossings_per_stitch: float = Field(description="Between face and back, or beds.")
    curl: float = Field(description="Knits minus purls over all stitches; far from 0 it curls.")


class FindResult(BaseModel):
    """Ranked repeats; the best first."""

    reached: bool
    message: str
    searched: int
    ranges: dict[str, tuple[float, float]] = Field(description="What all repeats span.")
    candidates: list[CandidateResult]
    elsewhere: list[CandidateResult] = Field(
        description="Nearest in yarns that were not asked for, if those asked for reach nothing."
    )


def run_find(
    request: FindRequest, *, cancelled: Cancelled, progress: Progress | None = None
) -> FindResult:
    """Find fabrics for the service."""
    names = tuple(dict.fromkeys(request.materials))
    targets = [target.target() for target in request.targets]
    limits = request.limits.limits() if request.limits else None
    others = [name for name in load_library() if name not in names] if request.elsewhere else []
    steps = len(names) + len(others)
    atlases = _atlases(names, request.repeats, cancelled, progress, (0, steps))
    found = find_fabric(atlases, targets, count=request.count, limits=limits)
    if found.reached or not others:
        return find_result(atlases, found)
    more = _atlases(others, request.repeats, cancelled, progress, (len(names), steps))
    return find_result(atlases, found, nearest_elsewhere(more, targets, limits))


def find_in(
    atlases: Sequence[Atlas],
    targets: Sequence[Target],
    count: int,
    limits: CostLimits | None = None,
) -> FindResult:
    """Find fabrics in atlases."""
    return find_result(atlases, find_fabric(atlases, targets, count=count, limits=limits))


def nearest_elsewhere(
    atlases: Sequence[Atlas], targets: Sequence[Target], limits: CostLimits | None
) -> list[Candidate]:
    """The best fabric of each other yarn, the nearest first."""
    best = [
        find_fabric([atlas], targets, count=1, limits=limits).candidates[0] for atlas in atlases
    ]
    return sorted(best, key=lambda c: (not c.reached, c.misfit))[:ELSEWHERE]


def find_result(
    atlases: Sequence[Atlas], found: FoundFabrics, others: Sequence[Candidate] = ()
) -> FindResult:
    """The answer at the border."""
    message = found.message
    if others and others[0].reached:
        message += f" In {others[0].material}, {others[0].repeat} is within all tolerances."
    elif others:
        message += " Nor does any other yarn of the library reach it."
    return FindResult(
        reached=found.reached,
        message=message,
        searched=sum(len(atlas) for atlas in atlases),
        ranges={label: (i.low, i.high) for label, i in found.ranges.items()},
        candidates=[candidate_result(c) for c in found.candidates],
        elsewhere=[candidate_result(c) for c in others],
    )


def candidate_result(c: Candidate) -> CandidateResult:
    """A candidate at the border."""
    return CandidateResult(
        material=c.material,
        chart=c.repeat.replace("/", "\n"),
        values={label: _number(v) for label, v in c.values.items()},
        intervals={label: _ends(i) for label, i in c.intervals.items()},
        deviations={label: _number(v) for label, v in c.deviations.items()},
        misfit=_number(c.misfit),
        reached=c.reached,
        provenance=c.provenance,
        transfers_per_stitch=c.cost.transfers_per_stitch,
        crossings_per_stitch=c.cost.crossings_per_stitch,
        curl=c.cost.curl,
    )


def _atlases(
    names: Sequence[str],
    extent: Extent,
    cancelled: Cancelled,
    progress: Progress | None,
    steps: tuple[int, int],
) -> list[Atlas]:
    """Atlases of some yarns; ``steps`` are those done before and in all."""
    before, total = steps

    def part(number: int) -> Callable[[int, int], None] | None:
        if progress is None:
            return None
        return lambda done, of: progress(100 * (before + number) + 100 * done // of, 100 * total)

    return [cached_atlas(name, extent, cancelled, part(k)) for k, name in enumerate(names)]


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _ends(interval: Interval) -> tuple[float | None, float | None]:
    return _number(interval.low), _number(interval.high)
