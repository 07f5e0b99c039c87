"""An owner's place in knitting a design: beside it, so that no undo and no version moves it."""

from sqlalchemy import Connection, delete, insert, select

from ..store.database import Database
from ..store.tables import knitting_places, now
from .document import KnittingPlace, KnittingPlaces, PlaceRequest
from .store import find_design

MAX_WAYS = 40
"""Ways to knit a design in which a place is kept; the latest stay."""
_PLACE = knitting_places.c


class Places:
    """Places in all designs."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def all(self, owner: str, design: str) -> KnittingPlaces:
        """The places in a design, one for each way to knit it, the latest first."""
        with self._database.read() as connection:
            find_design(connection, owner, design)
            rows = connection.execute(
                select(knitting_places)
                .where(_PLACE.design_id == design)
                .order_by(_PLACE.changed_at.desc(), _PLACE.way)
            ).all()
        places = [KnittingPlace.model_validate(row, from_attributes=True) for row in rows]
        return KnittingPlaces(places=places)

    def keep(self, owner: str, design: str, way: str, place: PlaceRequest) -> KnittingPlace:
        """Keep a place; the last that is sent counts."""
        values = {**place.model_dump(), "design_id": design, "way": way, "changed_at": now()}

        def action(connection: Connection) -> None:
            find_design(connection, owner, design, change=True)
            mine = _PLACE.design_id == design
            connection.execute(delete(knitting_places).where(mine, _PLACE.way == way))
            latest = select(_PLACE.way).where(mine).order_by(_PLACE.changed_at.desc())
            for (old,) in connection.execute(latest.offset(MAX_WAYS - 1)).all():
                connection.execute(delete(knitting_places).where(mine, _PLACE.way == old))
            connection.execute(insert(knitting_places).values(values))

        self._database.write(action)
        return KnittingPlace.model_validate(values)
