"""The user's own materials: files in the folder ``materials`` of the data folder.

Every process reads them for itself, workers too. An identifier ends in a mark of the file's
content, because designs, atlases and results of jobs refer to it: a file that was changed is
another material. The state that a user replaced last is still found, because a computation may be
using it.
"""

from __future__ import annotations

import hashlib
import logging
import shutil
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from knitcore.base.errors import InputError
from knitcore.materials import Material, load_material_file

if TYPE_CHECKING:
    from knitcore.materials.material_document import MaterialDocument

FOLDER = "materials"
REPLACED = "replaced"
"""Folder within it of what users replaced last."""
PREFIX = "own:"
KINDS = (".json", ".yaml", ".yml")
MAX_KEPT = 40
"""Materials that one user keeps through the service."""
REMEMBERED = 10_000
"""Materials that are not read again while their files stay as they are."""

_log = logging.getLogger("knitcore.materials")


def find_own_material(identifier: str, data_dir: Path) -> Material:
    """A user's own material.

    Raises
    ------
    InputError
        If there is none of that identifier.
    """
    own = own_materials(data_dir)
    for materials in own, _materials_in(data_dir / FOLDER / REPLACED):
        if identifier in materials:
            return materials[identifier]
    stem = identifier.rpartition(".")[0]
    changed = any(other.rpartition(".")[0] == stem for other in own)
    raise InputError(
        "material",
        f"the file of {identifier} was changed since." if changed else f"{identifier} is gone.",
        "Choose it again." if changed else "Put it back, or choose another material.",
    )


def own_materials(data_dir: Path) -> dict[str, Material]:
    """All materials in the folder, by identifier; files that hold none are logged and left out."""
    return _materials_in(data_dir / FOLDER)


def _materials_in(folder: Path) -> dict[str, Material]:
    if not folder.is_dir():
        return {}
    return _readable(sorted(file for file in folder.iterdir() if file.suffix.lower() in KINDS))


def _readable(files: Sequence[Path]) -> dict[str, Material]:
    materials = {}
    for file in files:
        try:
            own = _read(file)
        except (InputError, OSError) as error:
            _log.warning("%s is not a material: %s", file, error)
            continue
        materials[own.identifier] = own
    return materials


def keep_material(document: MaterialDocument, owner: str, data_dir: Path) -> Material:
    """Add a user's material to the folder, where everybody finds it.

    Another one that the same user keeps under the identifier is replaced.

    Raises
    ------
    InputError
        If the document is not a material, or the user keeps too many.
    """
    document.to_material()
    mine = _kept_by(owner, data_dir)
    place = data_dir / FOLDER / f"{_tag(owner)}{document.identifier.replace(':', '_')}.json"
    if place not in mine and len(mine) >= MAX_KEPT:
        raise InputError(
            "identifier",
            f"you have {len(mine)} yarns, the most allowed.",
            "Remove one of them first.",
        )
    _replaced(place).parent.mkdir(parents=True, exist_ok=True)
    if place in mine:
        shutil.copyfile(place, _replaced(place))
    new = place.with_suffix(".new")
    new.write_text(document.model_dump_json(indent=1, exclude_defaults=True), encoding="utf-8")
    new.replace(place)
    return _read(place)


def added_by(owner: str, data_dir: Path) -> frozenset[str]:
    """Identifiers of the materials that a user keeps, and so may replace or remove."""
    return frozenset(_readable(_kept_by(owner, data_dir)))


def remove_material(identifier: str, owner: str, data_dir: Path) -> bool:
    """Take a user's material out of the folder; false if the user keeps none of that identifier."""
    for file in _kept_by(owner, data_dir):
        if _read(file).identifier == identifier:
            file.unlink()
            _replaced(file).unlink(missing_ok=True)
            return True
    return False


def _replaced(file: Path) -> Path:
    """Path of the material that ``file`` replaced."""
    return file.parent / REPLACED / file.name


def _kept_by(owner: str, data_dir: Path) -> list[Path]:
    return sorted((data_dir / FOLDER).glob(f"{_tag(owner)}*.json"))


def _tag(owner: str) -> str:
    """Beginning of the names of a user's files."""
    return f"kept-{hashlib.sha256(owner.encode()).hexdigest()[:12]}-"


def _read(file: Path) -> Material:
    facts = file.stat()
    return _state_of(file, facts.st_mtime_ns, facts.st_size)


@lru_cache(maxsize=REMEMBERED)
def _state_of(file: Path, _modified_ns: int, _size: int) -> Material:
    own = load_material_file(file)
    mark = hashlib.sha256(file.read_bytes()).hexdigest()[:6]
    return replace(own, identifier=f"{PREFIX}{own.identifier}.{mark}")
