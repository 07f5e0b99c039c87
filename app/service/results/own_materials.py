"""Materials of users, as operations see them: by identifiers that end in a mark of their content.

Designs, atlases and results of jobs refer to these identifiers, so a material that was changed is
another one. The database holds the materials (:mod:`app.service.store.material_store`); a worker
gets those that its request names.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Protocol

from knitcore.base.errors import InputError
from knitcore.materials import Material

PREFIX = "own:"
KINDS = (".json", ".yaml", ".yml")
MAX_NAMED = 200
"""Materials that are sent to a worker with one request."""
REMEMBERED = 10_000
"""Materials that are not read again from their documents."""
_NAMED = re.compile(rb"own:[a-z0-9._:-]{1,80}")


class OwnMaterials(Protocol):
    """The materials of users."""

    def find(self, identifier: str) -> Material:
        """A user's own material.

        Raises
        ------
        InputError
            If there is none of that identifier.
        """
        ...

    def listed(self, user: str) -> list[tuple[Material, bool]]:
        """All materials, each with whether it is this user's; those come first."""
        ...


@dataclass(frozen=True)
class GivenMaterials:
    """Materials that came with a request.

    Attributes
    ----------
    documents : JSON of material files by identifier; empty text for one that was changed since.
    """

    documents: Mapping[str, str] = field(default_factory=dict)

    def find(self, identifier: str) -> Material:
        """A user's own material.

        Raises
        ------
        InputError
            If there is none of that identifier.
        """
        document = self.documents.get(identifier)
        if document:
            return own_material(identifier, document)
        changed = document is not None
        raise InputError(
            "material",
            f"{identifier} was changed since." if changed else f"{identifier} is gone.",
            "Choose it again." if changed else "Put it back, or choose another material.",
        )

    def listed(self, user: str) -> list[tuple[Material, bool]]:
        """All materials that came with the request."""
        del user
        return [(self.find(name), False) for name, document in self.documents.items() if document]


@lru_cache(maxsize=REMEMBERED)
def own_material(identifier: str, document: str) -> Material:
    """The material of an identifier and a document."""
    # an operation on a yarn of the library needs no model of files
    from knitcore.materials.material_document import MaterialDocument

    material = MaterialDocument.model_validate_json(document).to_material()
    return replace(material, identifier=identifier)


def marked(identifier: str, content: bytes) -> str:
    """The identifier of a user's material with a mark of its content."""
    return f"{PREFIX}{identifier}.{hashlib.sha256(content).hexdigest()[:6]}"


def is_identifier(text: str) -> bool:
    """Tell whether a text can name a material of a user; others are no question for a database."""
    return text.isascii() and _NAMED.fullmatch(text.encode()) is not None


def named_in(content: bytes) -> list[str]:
    """Identifiers of users' materials in a JSON request, each once.

    Raises
    ------
    InputError
        If there are more than a worker is sent.
    """
    if PREFIX.encode() not in content:
        return []
    names = list(dict.fromkeys(name.decode() for name in _NAMED.findall(content)))
    if len(names) > MAX_NAMED:
        problem = f"the request names {len(names)} materials of users."
        raise InputError("material", problem, f"Name at most {MAX_NAMED} in one request.")
    return names
