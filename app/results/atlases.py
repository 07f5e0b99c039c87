"""Atlases of materials, kept in memory and in the user's cache folder."""

from __future__ import annotations

import logging
import os
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from knitcore.chart import StitchChart
from knitcore.design.atlas import Atlas, load_atlas, save_atlas
from knitcore.design.atlas_build import build_atlas, material_fingerprint
from knitcore.design.repeats import known_larger_repeats, repeats_up_to, striped_repeats
from knitcore.errors import InputError
from knitcore.yarnlibrary.fingerprint import code_version

if TYPE_CHECKING:
    from app.operations.context import Context

log = logging.getLogger("knitcore.atlas")

DECIDING = ("knitcore.design.atlas_build", "knitcore.design.repeats")
"""Modules whose code and data decide an atlas."""

Extent = Literal["small", "all"]
EXTENTS = "small: up to 3x3 and a choice of larger ones; all: up to 4x4 and stripes of two fabrics."


def repeats_of(extent: Extent) -> tuple[StitchChart, ...]:
    """The repeats of an atlas."""
    larger = known_larger_repeats()
    if extent == "small":
        return tuple(dict.fromkeys((*repeats_up_to(3, 3), *larger)))
    return tuple(dict.fromkeys((*repeats_up_to(4, 4), *larger, *striped_repeats())))


def atlas_of(name: str, extent: Extent, context: Context) -> Atlas:
    """The atlas of a material, from memory or the user's cache folder if it is there."""
    material = context.material(name)
    key = f"{material.identifier}-{extent}-{material_fingerprint(material)}"
    built = _built()
    if key not in built:
        file = cache_folder() / f"{key}-{code_version(*DECIDING)[:8]}.npz"
        repeats = repeats_of(extent)
        found = _load(file, len(repeats))
        if found is None:
            found = build_atlas(
                material, repeats, cancelled=context.cancelled, progress=context.progress
            )
            _save(found, file)
        built[key] = found
    return built[key]


def cache_folder() -> Path:
    """Where atlases are kept between runs; it may be emptied at any time."""
    home = os.environ.get("XDG_CACHE_HOME")
    return (Path(home) if home else Path.home() / ".cache") / "knitcore" / "atlas"


@lru_cache(maxsize=1)
def _built() -> dict[str, Atlas]:
    """Atlases that this process has built; at most two of each material."""
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
