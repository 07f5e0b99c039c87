"""The atlas of a material, and the fabrics in it that do what is wanted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from knitcore.chart import StitchChart
from knitcore.design.atlas import Atlas, build_atlas
from knitcore.design.find import Candidate, FoundFabrics, Quantity, Target, find_fabric
from knitcore.design.repeats import known_larger_repeats, repeats_up_to
from knitcore.materials import Material
from knitcore.materials import material as find_material

Extent = Literal["small", "all"]
SMALL = (3, 3)
MAX_MATERIALS = 8


class TargetInput(BaseModel):
    """One wish for a fabric."""

    model_config = ConfigDict(extra="forbid")

    quantity: Quantity
    value: float = Field(gt=0, allow_inf_nan=False)
    tolerance: float = Field(0.10, gt=0, le=10, description="Relative; 0.1 is 10 %.")
    weight: float = Field(1.0, gt=0, le=1000)

    def target(self) -> Target:
        """As the library knows it."""
        return Target(self.quantity, self.value, self.tolerance, self.weight)


class FindRequest(BaseModel):
    """Wishes, and the yarns to search."""

    model_config = ConfigDict(extra="forbid")

    materials: list[str] = Field(min_length=1, max_length=MAX_MATERIALS)
    targets: list[TargetInput] = Field(min_length=1, max_length=len(Quantity))
    repeats: Extent = Field(
        "small", description="small: up to 3x3 and a choice of larger ones; all: also up to 4x4."
    )
    count: int = Field(10, ge=1, le=100)


class CandidateResult(BaseModel):
    """A repeat and how near it comes."""

    material: str
    chart: str = Field(description="K/P lines of one repeat, the top row first.")
    values: dict[Quantity, float]
    intervals: dict[Quantity, tuple[float, float]] = Field(description="90 % intervals.")
    deviations: dict[Quantity, float] = Field(description="Predicted over wanted, minus one.")
    misfit: float = Field(description="Weighted rms of deviations in units of their tolerances.")
    reached: bool
    provenance: str
    transfers_per_stitch: float
    curl: float = Field(description="Knits minus purls over all stitches; far from 0 it curls.")


class FindResult(BaseModel):
    """Ranked repeats; the best first."""

    reached: bool
    message: str
    searched: int
    ranges: dict[Quantity, tuple[float, float]] = Field(description="What all repeats span.")
    candidates: list[CandidateResult]


class AtlasRequest(BaseModel):
    """Which atlas."""

    model_config = ConfigDict(extra="forbid")

    material: str = Field(max_length=80, examples=["acrylic"])
    repeats: Extent = "small"


class AtlasResult(BaseModel):
    """An atlas as columns, for the rigidity-rigidity scatter."""

    material: str
    repeats: list[str] = Field(description="Rows from the top, separated by /.")
    modulus_course_n_per_mm: list[float]
    modulus_wale_n_per_mm: list[float]
    poisson_yx: list[float]
    poisson_xy: list[float]
    provenance: list[str]


def repeats_of(extent: Extent) -> tuple[StitchChart, ...]:
    """The repeats of an atlas."""
    sides = SMALL if extent == "small" else (4, 4)
    return tuple(dict.fromkeys((*repeats_up_to(*sides), *known_larger_repeats())))


def run_atlas(request: AtlasRequest, *, cancelled: Callable[[], bool]) -> AtlasResult:
    """The atlas of a library material; a process remembers those that it has built."""
    return atlas_result(cached_atlas(request.material, request.repeats, cancelled))


def run_find(request: FindRequest, *, cancelled: Callable[[], bool]) -> FindResult:
    """Find fabrics for the service."""
    names = dict.fromkeys(request.materials)
    atlases = [cached_atlas(name, request.repeats, cancelled) for name in names]
    return find_in(atlases, [t.target() for t in request.targets], request.count)


def find_in(atlases: Sequence[Atlas], targets: Sequence[Target], count: int) -> FindResult:
    """Find fabrics in atlases."""
    found: FoundFabrics = find_fabric(atlases, targets, count=count)
    return FindResult(
        reached=found.reached,
        message=found.message,
        searched=sum(len(atlas) for atlas in atlases),
        ranges={q: (i.low, i.high) for q, i in found.ranges.items()},
        candidates=[_candidate(c) for c in found.candidates],
    )


def atlas_result(atlas: Atlas) -> AtlasResult:
    """An atlas at the border."""
    return AtlasResult(
        material=atlas.material,
        repeats=list(atlas.keys),
        modulus_course_n_per_mm=atlas.column("modulus_course_n_per_mm").tolist(),
        modulus_wale_n_per_mm=atlas.column("modulus_wale_n_per_mm").tolist(),
        poisson_yx=atlas.column("poisson_yx").tolist(),
        poisson_xy=atlas.column("poisson_xy").tolist(),
        provenance=list(atlas.provenance),
    )


def make_atlas(
    material: Material,
    extent: Extent,
    file: Path,
    progress: Callable[[int, int], None] | None = None,
) -> Atlas:
    """Build an atlas into a file, or go on with one."""
    return build_atlas(material, repeats_of(extent), file=file, progress=progress)


def cached_atlas(name: str, extent: Extent, cancelled: Callable[[], bool]) -> Atlas:
    """The atlas of a library material; a process remembers those that it has built."""
    built = _built()
    if (name, extent) not in built:
        built[name, extent] = build_atlas(
            find_material(name), repeats_of(extent), cancelled=cancelled
        )
    return built[name, extent]


@lru_cache(maxsize=1)
def _built() -> dict[tuple[str, Extent], Atlas]:
    """Atlases of the library that this process has built; at most two of each material."""
    return {}


def _candidate(c: Candidate) -> CandidateResult:
    return CandidateResult(
        material=c.material,
        chart=c.repeat.replace("/", "\n"),
        values=c.values,
        intervals={q: (i.low, i.high) for q, i in c.intervals.items()},
        deviations=c.deviations,
        misfit=c.misfit,
        reached=c.reached,
        provenance=c.provenance,
        transfers_per_stitch=c.cost.transfers_per_stitch,
        curl=c.cost.curl,
    )
