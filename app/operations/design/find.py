"""Fabrics with target properties, in one yarn or several."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import click
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.design.atlas import INTERVAL_SOURCE, Atlas, load_atlas
from knitcore.design.cost import CostLimits
from knitcore.design.find import Candidate, find_fabric
from knitcore.design.targets import USUAL_LOAD_N_PER_MM, Quantity, Target, WornTube
from knitcore.materials import load_library

from ...context import Context
from ...requests.base import Ends, IntervalResult, Known, KnownEnds, RequestModel, ResultModel
from ...requests.charts import MaterialName, RepeatText
from ...requests.fabrics import LawsRequest
from ...requests.faults import CheckedBy
from ...service.results.atlases import EXTENTS, Extent
from ..registry import Command, Operation

MAX_MATERIALS = 16
MAX_TARGETS = 20
ELSEWHERE = 3
"""Largest number of fabrics of other yarns to offer where none of those asked for meets the
targets."""


class LimbInput(RequestModel):
    """A tube on a limb."""

    rest_mm: float = Field(gt=0, le=5000, description="Circumference of the unworn tube.")
    worn_mm: float = Field(gt=0, le=5000, description="Circumference of the limb.")


class TargetInput(RequestModel):
    """One target property of a fabric."""

    quantity: Quantity
    value: float = Field(ge=-10, le=1e6, description="Stretch as a strain: 0.5 is 50 %.")
    tolerance: float = Field(
        0.10,
        gt=0,
        le=10,
        description="Relative tolerance (0.1 is 10 %); a difference for Poisson's ratios.",
    )
    weight: float = Field(1.0, gt=0, le=1000)
    load_n_per_mm: float = Field(
        USUAL_LOAD_N_PER_MM,
        gt=0,
        le=0.5,
        description="Load of a target stretch, per width of cloth.",
    )
    limb: LimbInput | None = Field(None, description="Tube and limb of a target pressure.")

    def target(self) -> Target:
        """The target as an object of the library."""
        return self.pass_to(Target, limb=self.limb.pass_to(WornTube) if self.limb else None)


class LimitsInput(RequestModel):
    """Limits on the effort of knitting; null for no limit."""

    transfers_per_stitch: float | None = Field(
        None, ge=0, le=1, description="Loops moved between the beds, per stitch."
    )
    crossings_per_stitch: float | None = Field(
        None, ge=0, le=1, description="Yarn between face and back, per stitch."
    )
    curl: float | None = Field(
        None, ge=0, le=1, description="Knits minus purls over all stitches, either way."
    )


class FindRequest(LawsRequest):
    """Target properties, and the yarns to search."""

    materials: list[MaterialName] = Field(min_length=1, max_length=MAX_MATERIALS)
    targets: list[Annotated[TargetInput, CheckedBy(lambda target, _: target.target())]] = Field(
        min_length=1, max_length=MAX_TARGETS
    )
    limits: LimitsInput | None = None
    repeats: Extent = Field("small", description=EXTENTS)
    count: int = Field(10, ge=1, le=100)
    elsewhere: bool = Field(
        True, description="Search the other yarns too if nothing meets the targets."
    )


class CandidateResult(ResultModel):
    """A repeat, and how near it comes to the targets."""

    material: str
    repeat: RepeatText
    values: dict[str, Known] = Field(
        description="Values by quantity, with @load or @rest/worn; null beyond the lock-up."
    )
    intervals: dict[str, KnownEnds] = Field(
        description="90 % intervals; null where an end lies beyond the computed curve."
    )
    deviations: dict[str, Known] = Field(
        description="Prediction over target, minus one; the difference for Poisson's ratios."
    )
    chance: float = Field(
        description="Probability that all quantities are within their tolerances, by the intervals."
    )
    misfit: Known = Field(description="Weighted rms of deviations in units of their tolerances.")
    reached: bool
    provenance: str
    transfers_per_stitch: float
    crossings_per_stitch: float = Field(
        description="Moves of the yarn between face and back, or between beds, per stitch."
    )
    curl: float = Field(description="Knits minus purls over all stitches; far from 0 it curls.")


class FindResult(IntervalResult):
    """Ranked repeats, the surest first."""

    kind: Literal["find"] = "find"
    reached: bool
    message: str
    searched: int
    ranges: dict[str, Ends] = Field(description="Range of each quantity over all repeats.")
    candidates: list[CandidateResult]
    elsewhere: list[CandidateResult] = Field(
        description="Nearest fabrics in other yarns, if none of those asked for meets the targets."
    )


def find(request: FindRequest, context: Context) -> FindResult:
    """Ranked repeats with intervals and knitting effort; says so when nothing meets the targets."""
    names = list(dict.fromkeys(request.materials))
    others = [name for name in load_library() if name not in names] if request.elsewhere else []
    share = len(names) / (len(names) + len(others))
    return _ranked(
        _atlases(names, request.repeats, context.within(0.0, share)),
        request,
        others,
        context.within(share, 1 - share),
    )


def _ranked(
    atlases: Sequence[Atlas], request: FindRequest, others: Sequence[str], context: Context
) -> FindResult:
    """The best of some atlases, and of other yarns if nothing in those meets the targets."""
    targets = [target.target() for target in request.targets]
    limits = request.limits.pass_to(CostLimits) if request.limits else None
    ranking = request.pass_to(find_fabric, atlases, targets, limits=limits)
    message, elsewhere = ranking.message, list[Candidate]()
    if others and not ranking.reached:
        best = [
            find_fabric([atlas], targets, count=1, limits=limits).candidates[0]
            for atlas in _atlases(others, request.repeats, context)
        ]
        elsewhere = sorted(best, key=lambda c: (-c.chance, c.misfit))[:ELSEWHERE]
        if first := next((c for c in elsewhere if c.reached), None):
            message += f" In {first.material}, {first.repeat} is within all tolerances."
        else:
            message += " Nor does any other yarn of the library reach it."
    return FindResult.of(
        ranking,
        message=message,
        interval_source=INTERVAL_SOURCE,
        searched=sum(len(atlas) for atlas in atlases),
        candidates=[CandidateResult.of(c, **vars(c.cost)) for c in ranking.candidates],
        elsewhere=[CandidateResult.of(c, **vars(c.cost)) for c in elsewhere],
    )


def _atlases(names: Sequence[str], extent: Extent, context: Context) -> list[Atlas]:
    for name in names:
        context.material(name)  # an unknown material is reported before any atlas is computed
    part = 1 / max(len(names), 1)
    return [
        context.within(number * part, part).atlas(name, extent) for number, name in enumerate(names)
    ]


_TARGET = re.compile(
    r"([a-z_]+)(?:@(?:([\d.]+)/([\d.]+)|([\d.]+)))?=(-?[\d.]+(?:[eE][+-]?\d+)?)"
    r"(?:~([\d.]+)(%)?)?(?:\*([\d.]+))?"
)
_SHORT = {
    "course": Quantity.MODULUS_COURSE,
    "wale": Quantity.MODULUS_WALE,
    "anisotropy": Quantity.ANISOTROPY,
    "pressure_course": Quantity.PRESSURE_COURSE,
    "pressure_wale": Quantity.PRESSURE_WALE,
}


@click.option("--material", "materials", multiple=True, help="Library id or file; repeatable.")
@click.option(
    "--target",
    "targets",
    multiple=True,
    required=True,
    metavar="QUANTITY[@LOAD|@REST/WORN]=VALUE[~TOLERANCE%][*WEIGHT]",
    help="Such as course=0.1~10%, stretch_wale@0.05=0.4 or pressure_course@180/240=20~15%*2.",
)
def _search_fields(
    materials: tuple[str, ...], targets: tuple[str, ...], atlases: tuple[Path, ...]
) -> dict[str, Any]:
    searched = [*(load_atlas(file).material for file in atlases), *materials]
    if not searched:
        raise InputError("material", "there is nothing to search.", "Add --material or --atlas.")
    return {"materials": searched, "targets": [_target(text) for text in targets]}


@click.option("--atlas", "atlases", multiple=True, type=click.Path(path_type=Path))
@click.option(
    "--elsewhere",
    is_flag=True,
    help="Search the library's other yarns if nothing meets the targets.",
)
def _command(
    request: FindRequest, context: Context, atlases: tuple[Path, ...], elsewhere: bool
) -> FindResult:
    named = request.materials[len(atlases) :]
    tables = [*map(load_atlas, atlases), *_atlases(named, request.repeats, context)]
    others = [name for name in load_library() if name not in request.materials]
    return _ranked(tables, request, others if elsewhere else [], context)


def _target(text: str) -> TargetInput:
    match = _TARGET.fullmatch(text.strip())
    if match is None or match[1] not in {*_SHORT, *Quantity}:
        names = ", ".join([*_SHORT, *(q for q in Quantity if q not in _SHORT.values())])
        raise InputError(
            "target", f"{text!r} cannot be read.", f"Write QUANTITY=VALUE~10%; known: {names}."
        )
    name, rest, worn, load, value, tolerance, percent, weight = match.groups()
    given = {"load_n_per_mm": float(load)} if load else {}
    return TargetInput(
        quantity=_SHORT.get(name) or Quantity(name),
        value=float(value),
        tolerance=float(tolerance) / (100 if percent else 1) if tolerance else 0.10,
        weight=float(weight) if weight else 1.0,
        limb=LimbInput(rest_mm=float(rest), worn_mm=float(worn)) if rest else None,
        **given,
    )


def _lines(r: FindResult) -> list[str]:
    lines = [r.message, "", *map(_line, r.candidates)]
    if r.elsewhere:
        lines += ["", "In other yarns:", *map(_line, r.elsewhere)]
    return lines


def _line(c: CandidateResult) -> str:
    values = "  ".join(_value(c, label) for label in c.values)
    return (
        f"{c.repeat:20} {c.chance:4.0%} sure  {c.material}: {values}; "
        f"{c.transfers_per_stitch:.2f} transfers and {c.crossings_per_stitch:.2f} crossings a "
        f"stitch, curl {c.curl:+.2f}; {c.provenance}"
    )


def _value(c: CandidateResult, label: str) -> str:
    value, off, (low, high) = c.values[label], c.deviations[label], c.intervals[label]
    if value is None or off is None:
        return f"{label} beyond the lock-up"
    shown = f"{off:+.2f}" if label.startswith("poisson") else f"{off:+.0%}"
    ends = [("beyond the curve" if end is None else f"{end:.3g}") for end in (low, high)]
    return f"{label} {value:.4g} ({shown}; {ends[0]} to {ends[1]})"


OPERATION = Operation(
    find,
    tag="design",
    summary="Fabrics with target properties",
    example={
        "materials": ["acrylic"],
        "targets": [{"quantity": "modulus_course_n_per_mm", "value": 0.2, "tolerance": 0.1}],
        "count": 1,
    },
    job=True,
    command=Command(
        _lines,
        more="They come from atlases, or, up to 3x3, from materials.",
        names=dict.fromkeys(("materials", "targets", "repeats", "elsewhere"))
        | {
            "transfers_per_stitch": "--most-transfers",
            "crossings_per_stitch": "--most-crossings",
            "curl": "--most-curl",
        },
        fields=_search_fields,
        run=_command,
    ),
)
