"""Errors that the service answers with, by kind."""

from __future__ import annotations

import math
from collections.abc import Mapping

from app.problems.problem import Problem


class ServiceError(Exception):
    """An error that the service answers with; subclasses name its kind.

    Parameters
    ----------
    detail : what is wrong, in words.
    field : the input to blame.
    remedy : what would be accepted.
    """

    status = 500
    type = "internal"
    title = "Something went wrong in the service"
    default_remedy: str | None = None
    headers: Mapping[str, str] = {}

    def __init__(self, detail: str, *, field: str | None = None, remedy: str | None = None) -> None:
        super().__init__(detail)
        self.detail = detail
        self.field = field
        self.remedy = remedy or self.default_remedy

    @property
    def problem(self) -> Problem:
        """The error as clients see it."""
        return Problem(
            type=self.type,
            title=self.title,
            status=self.status,
            detail=self.detail,
            field=self.field,
            remedy=self.remedy,
        )


class UnavailableError(ServiceError):
    """The service cannot do this now; the text says what to do."""

    status, type, title = 503, "busy", "Not now"
    default_remedy = "Try again in a moment, or ask for less."
    headers: Mapping[str, str] = {"Retry-After": "2"}


class StoppingError(UnavailableError):
    """The service is being stopped."""

    default_remedy = "Try again when it is back."


class NoRoomError(UnavailableError):
    """The disk is full."""

    status, type, title = 507, "full", "No room left"
    headers: Mapping[str, str] = {}
    default_remedy = (
        "Make room on the disk of the service, then try again; nothing that was acknowledged is "
        "lost."
    )


class NotFoundError(ServiceError):
    """It does not exist, or belongs to another user."""

    status, type, title = 404, "not-found", "Not found here"


class RefusedError(ServiceError):
    """The request is not allowed."""

    status, type, title = 403, "refused", "Refused"


class TooManyError(ServiceError):
    """Requests come too often."""

    status, type, title = 429, "too-many", "Too many requests"

    def __init__(self, detail: str, wait_s: float) -> None:
        wait = math.ceil(wait_s)
        super().__init__(detail, remedy=f"Try again in {wait} s.")
        self.headers = {"Retry-After": str(wait)}
