"""The atlas of a material: every small repeat with what it will do."""

from __future__ import annotations

import hashlib
import logging
import os
from collections.abc import Callable
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from app.results.own_materials import find_material
from knitcore.chart import StitchChart
from knitcore.design.atlas import Atlas, load_atlas, save_atlas
from knitcore.design.atlas_build import build_atlas, material_fingerprint
from knitcore.design.repeats import known_larger_repeats, repeats_up_to, striped_repeats
from knitcore.design.targets import USUAL_LOAD_N_PER_MM
from knitcore.errors import InputError
from knitcore.fabric import Direction

log = logging.getLogger("knitcore.atlas")

Extent = Literal["small", "all"]
SMALL = (3, 3)
DIGITS = 5

Cancelled = Callable[[], bool]
Progress = Callable[[int, int], None]
Column = list[float]


class AtlasRequest(BaseModel):
    """Which atlas."""

    model_config = ConfigDict(extra="forbid")

    material: str = Field(max_length=80, examples=["acrylic"])
    repeats: Extent = Field(
        "small",
        description="small: up to 3x3 and a choice of larger ones; all: up to 4x4 and stripes of "
        "two fabrics.",
    )


class AtlasResult(BaseModel):
    """An atlas as columns, for the rigidity-rigidity scatter."""

    material: str
    repeats: list[str] = Field(description="Rows from the top, separated by /.")
    modulus_course_n_per_mm: Column
    modulus_course_low: Column = Field(description="Low and high: ends of 90 % intervals.")
    modulus_course_high: Column
    modulus_wale_n_per_mm: Column
    modulus_wale_low: Column
    modulus_wale_high: Column
    poisson_yx: Column
    poisson_xy: Column
    stretch_course: Column = Field(description="Strain at 0.1 N/mm.")
    stretch_wale: Column
    relaxed_course_mm: list[float] = Field(description="Width of the mean stitch at rest.")
    relaxed_wale_mm: list[float] = Field(description="Height of the mean stitch at rest.")
    transfers_per_stitch: Column
    crossings_per_stitch: Column
    curl: Column
    provenance: list[str]


def repeats_of(extent: Extent) -> tuple[StitchChart, ...]:
    """The repeats of an atlas."""
    if extent == "small":
        return tuple(dict.fromkeys((*repeats_up_to(*SMALL), *known_larger_repeats())))
    larger = (*known_larger_repeats(), *striped_repeats())
    return tuple(dict.fromkeys((*repeats_up_to(4, 4), *larger)))


def run_atlas(
    request: AtlasRequest, *, cancelled: Cancelled, progress: Progress | None = None
) -> AtlasResult:
    """The atlas of a library material."""
    return atlas_result(cached_atlas(request.material, request.repeats, cancelled, progress))


def atlas_result(atlas: Atlas) -> AtlasResult:
    """An atlas at the border."""
    names = (
        *(f"modulus_{d}_{part}" for d in Direction for part in ("n_per_mm", "low", "high")),
        "poisson_yx",
        "poisson_xy",
    )
    return AtlasResult(
        material=atlas.material,
        repeats=list(atlas.keys),
        **{name: _rounded(atlas.column(name)) for name in names},
        stretch_course=_rounded(atlas.strain_at(Direction.COURSE, USUAL_LOAD_N_PER_MM)),
        stretch_wale=_rounded(atlas.strain_at(Direction.WALE, USUAL_LOAD_N_PER_MM)),
        relaxed_course_mm=_rounded(atlas.column("relaxed_course_mm")),
        relaxed_wale_mm=_rounded(atlas.column("relaxed_wale_mm")),
        transfers_per_stitch=[round(c.transfers_per_stitch, DIGITS) for c in atlas.costs],
        crossings_per_stitch=[round(c.crossings_per_stitch, DIGITS) for c in atlas.costs],
        curl=[round(c.curl, DIGITS) for c in atlas.costs],
        provenance=list(atlas.provenance),
    )


def cached_atlas(
    name: str, extent: Extent, cancelled: Cancelled | None, progress: Progress | None = None
) -> Atlas:
    """The atlas of a library material, from memory or the user's cache folder if it is there."""
    built = _built()
    if (name, extent) not in built:
        material = find_material(name)
        version = f"{material_fingerprint(material)}-{_code_version()}"
        file = cache_folder() / f"{name}-{extent}-{version}.npz"
        repeats = repeats_of(extent)
        found = _load(file, len(repeats))
        if found is None:
            found = build_atlas(material, repeats, cancelled=cancelled, progress=progress)
            _save(found, file)
        built[name, extent] = found
    return built[name, extent]


def cache_folder() -> Path:
    """Where atlases of the library are kept between runs; it may be emptied at any time."""
    home = os.environ.get("XDG_CACHE_HOME")
    return (Path(home) if home else Path.home() / ".cache") / "knitcore" / "atlas"


@lru_cache(maxsize=1)
def _code_version() -> str:
    """Changes with whatever could change a prediction of the same laws."""
    digest = hashlib.sha256()
    for part in ("mechanics", "design"):
        sources = files("knitcore").joinpath(part).iterdir()
        for file in sorted(sources, key=lambda found: found.name):
            if file.name.endswith(".py"):
                digest.update(file.read_bytes())
    return digest.hexdigest()[:8]


@lru_cache(maxsize=1)
def _built() -> dict[tuple[str, Extent], Atlas]:
    """Atlases of the library that this process has built; at most two of each material."""
    return {}


def _load(file: Path, repeats: int) -> Atlas | None:
    if not file.is_file():
        return None
    try:
        atlas = load_atlas(file)
    except InputError as error:
        log.warning("the cached atlas is made again: %s", error)
        return None
    return atlas if len(atlas) == repeats else None


def _save(atlas: Atlas, file: Path) -> None:
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        save_atlas(atlas, file)
    except OSError as error:
        log.warning("the atlas cannot be kept for the next run: %s", error)


def _rounded(values: NDArray[np.float64]) -> Column:
    return [float(f"{value:.{DIGITS}g}") for value in values]
