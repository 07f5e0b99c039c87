"""Materials of users in the database: everybody uses them, and who added one changes it.

The state that a user replaced last is kept, because a computation may be using it.
"""

from collections.abc import Iterable

from sqlalchemy import Connection, delete, select, update

from knitcore.materials import Material
from knitcore.materials.material_document import MaterialDocument

from ..limits.user_limits import USER_LIMITS, OverLimitError
from ..results.own_materials import GivenMaterials, is_identifier, marked, own_material
from .database import Database
from .tables import now, own_materials

_MINE = own_materials.c
_PRESENT = _MINE.replaced_at.is_(None)


class MaterialStore:
    """The materials of all users.

    Parameters
    ----------
    database : where they are.
    """

    def __init__(self, database: Database) -> None:
        self._database = database

    def find(self, identifier: str) -> Material:
        """A user's own material.

        Raises
        ------
        InputError
            If there is none of that identifier.
        """
        return GivenMaterials(self.documents([identifier])).find(identifier)

    def documents(self, identifiers: Iterable[str]) -> dict[str, str]:
        """Documents by identifier; empty text for one that its user has changed since.

        Of different materials under one identifier, the earliest counts.
        """
        names = [name for name in identifiers if is_identifier(name)]
        stems = {name: name.partition(":")[2].rpartition(".")[0] for name in names}
        chosen = select(_MINE.id, _MINE.document).where(_MINE.id.in_(names))
        ordered = chosen.order_by(_PRESENT, _MINE.added_at.desc())
        others = select(_MINE.identifier).where(_PRESENT, _MINE.identifier.in_(stems.values()))
        with self._database.read() as connection:
            documents = {row.id: row.document for row in connection.execute(ordered)}
            changed = (
                set(connection.execute(others).scalars()) if len(documents) < len(names) else ()
            )
        return {name: "" for name, stem in stems.items() if stem in changed} | documents

    def listed(self, user: str) -> list[tuple[Material, bool]]:
        """All materials, each with whether it is this user's; those come first."""
        chosen = select(_MINE.id, _MINE.document, (_MINE.owner == user).label("mine"))
        with self._database.read() as connection:
            rows = connection.execute(chosen.where(_PRESENT).order_by(_MINE.added_at)).all()
        ordered = sorted(rows, key=lambda row: not row.mine)
        return [(own_material(row.id, row.document), bool(row.mine)) for row in ordered]

    def count(self, user: str) -> int:
        """Number of materials that a user keeps."""
        with self._database.read() as connection:
            return len(_present(connection, user))

    def keep(self, document: MaterialDocument, owner: str) -> Material:
        """Add a user's material. Another one of the same user and identifier is replaced.

        Raises
        ------
        InputError
            If the document is not a material.
        OverLimitError
            If the user keeps too many.
        """
        document.to_material()
        content = _content(document)
        identifier = marked(document.identifier, content.encode())

        def action(connection: Connection) -> None:
            self._database.backend.take_turns(connection, f"materials of {owner}")
            present = _present(connection, owner)
            held, most = len(present), USER_LIMITS.materials
            if document.identifier not in present.values() and held >= most:
                raise OverLimitError(
                    f"You have {held} of {most} yarns.",
                    field="materials",
                    remedy="Remove one of them first.",
                )
            if identifier not in present:
                self._replace(connection, owner, document.identifier)
                self._add(connection, owner, identifier, document)

        self._database.write(action)
        return own_material(identifier, content)

    def remove(self, identifier: str, owner: str) -> bool:
        """Remove a user's material, with what it had replaced; False if the user keeps none of that
        identifier."""

        def action(connection: Connection) -> bool:
            stem = _present(connection, owner).get(identifier)
            gone = delete(own_materials).where(_MINE.owner == owner, _MINE.identifier == stem)
            return stem is not None and connection.execute(gone).rowcount > 0

        return self._database.write(action)

    def _replace(self, connection: Connection, owner: str, identifier: str) -> None:
        """Mark the present state as replaced, and forget what it had replaced itself."""
        those = _MINE.owner == owner, _MINE.identifier == identifier
        connection.execute(delete(own_materials).where(*those, _MINE.replaced_at.is_not(None)))
        connection.execute(update(own_materials).where(*those).values(replaced_at=now()))

    def _add(
        self, connection: Connection, owner: str, identifier: str, document: MaterialDocument
    ) -> None:
        values = {
            "owner": owner,
            "id": identifier,
            "identifier": document.identifier,
            "document": _content(document),
            "added_at": now(),
        }
        connection.execute(self._database.backend.insert_new(own_materials).values(values))


def _content(document: MaterialDocument) -> str:
    return document.model_dump_json(indent=1, exclude_defaults=True)


def _present(connection: Connection, owner: str) -> dict[str, str]:
    """Identifiers of a user's materials, with their marks and without."""
    rows = connection.execute(
        select(_MINE.id, _MINE.identifier).where(_MINE.owner == owner, _PRESENT)
    )
    return {row.id: row.identifier for row in rows}
