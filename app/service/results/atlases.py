"""Atlases of materials, kept in memory and in the data folder."""

import logging
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Literal

from knitcore.base.errors import InputError
from knitcore.chart.repeats import known_larger_repeats, repeats_up_to, striped_repeats
from knitcore.chart.stitch_chart import StitchChart
from knitcore.design.atlas import Atlas, load_atlas, save_atlas
from knitcore.design.atlas_build import build_atlas, material_fingerprint
from knitcore.materials import Material
from knitcore.yarn.library.fingerprint import code_version

log = logging.getLogger("knitcore.atlas")

FOLDER = "atlases"
"""Folder of atlases in the data folder; it may be emptied at any time."""
DECIDING = ("knitcore.design.atlas_build", "knitcore.chart.repeats")
"""Modules whose code and data decide an atlas."""

Extent = Literal["small", "all"]
EXTENTS = "small: up to 3x3 and a choice of larger ones; all: up to 4x4 and stripes of two fabrics."


def repeats_of(extent: Extent) -> tuple[StitchChart, ...]:
    """The repeats of an atlas."""
    larger = known_larger_repeats()
    if extent == "small":
        return tuple(dict.fromkeys((*repeats_up_to(3, 3), *larger)))
    return tuple(dict.fromkeys((*repeats_up_to(4, 4), *larger, *striped_repeats())))


def atlas_of(
    material: Material,
    extent: Extent,
    data_dir: Path,
    *,
    cancelled: Callable[[], bool],
    progress: Callable[[float, float], None],
) -> Atlas:
    """The atlas of a material, from memory or the data folder if it is there."""
    key = f"{material.identifier}-{extent}-{material_fingerprint(material)}"
    built = built_here()
    if key not in built:
        cached = data_dir / FOLDER / f"{key}-{code_version(*DECIDING)[:8]}.npz"
        repeats = repeats_of(extent)
        atlas = _load(cached, len(repeats))
        if atlas is None:
            atlas = build_atlas(material, repeats, cancelled=cancelled, progress=progress)
            _save(atlas, cached)
        built[key] = atlas
    return built[key]


@lru_cache(maxsize=1)
def built_here() -> dict[str, Atlas]:
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
        file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        save_atlas(atlas, file)
        for older in set(file.parent.glob(f"{file.stem.rpartition('-')[0]}-*.npz")) - {file}:
            older.unlink(missing_ok=True)
    except OSError as error:
        log.warning("the atlas cannot be kept for the next run: %s", error)
