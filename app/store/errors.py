"""What can go wrong with the database, as the service answers it."""

from __future__ import annotations

from app.problems.errors import NoRoomError, UnavailableError


class StoreError(UnavailableError):
    """The database failed to read or write: it is gone, locked, or its disk is full."""


class StoreFullError(StoreError, NoRoomError):
    """The disk of the database is full."""


class DamagedError(StoreError):
    """The database is damaged."""

    default_remedy = "Stop the service and restore a backup."


class VanishedError(StoreError):
    """The database's file is gone or was replaced."""

    default_remedy = "Put the file back, or stop the service, restore a backup and start again."


class DispossessedError(StoreError):
    """The data is no longer this service's: what reserved it was removed or taken."""
