"""Problems as clients read them: their kinds, their fields, and the errors that become one."""

import math
from collections.abc import Mapping
from typing import Annotated, Any, NamedTuple

from pydantic import BaseModel, BeforeValidator, Field

FOLDER = "/problems"


class Kind(NamedTuple):
    """A kind of problem: the statuses that come with it, what it means, what to do."""

    statuses: str
    means: str
    remedy: str


KINDS = {
    "input": Kind(
        "422",
        "An input cannot be used. `errors` lists all that is wrong with the request; `field` "
        "and `remedy` are those of the first entry.",
        "Correct every field that is listed, and send the request again.",
    ),
    "unsolved": Kind(
        "422",
        "The inputs are valid, but the computation found no solution.",
        "Ask for less: a smaller strain, a smaller chart, more steps.",
    ),
    "sign-in": Kind(
        "401",
        "The service requires a token, and the request has none or an unknown one.",
        "Send the header `Authorization: Bearer …`, or open the page as `/?token=…`. Who runs the "
        "service makes tokens with `knitcore token`.",
    ),
    "refused": Kind(
        "400, 403, 413",
        "The request is not allowed: it uses a name that is not the service's, comes from a page "
        "of another site, asks a link for more than it gives, or is too large.",
        "Follow the `remedy`; the same request will be refused again.",
    ),
    "not-found": Kind(
        "404",
        "It does not exist, or it belongs to another user.",
        "Look it up in the list that it should be in.",
    ),
    "http": Kind(
        "404, 405",
        "The service has no such address, or the address does not support the method.",
        "Compare address and method with `/docs`.",
    ),
    "conflict": Kind(
        "409",
        "The request conflicts with the present state.",
        "Read the present state, and decide again.",
    ),
    "stale": Kind(
        "412",
        "Somebody else has changed the design since you read it. Nothing was overwritten.",
        "Read the design, make your change again, and send it with the new ETag as `If-Match`.",
    ),
    "condition": Kind(
        "428",
        "A change must say which state it was made on.",
        'Send the ETag of the design as `If-Match`, or `"*"` to overwrite whatever is there.',
    ),
    "too-many": Kind(
        "429",
        "You send requests too often, or have reached a limit of one user; `field` names it.",
        "Wait as many seconds as `Retry-After` says; without that header, close or delete "
        "something you do not need.",
    ),
    "busy": Kind(
        "503",
        "The service is busy, or something that it needs is not available.",
        "Wait as many seconds as `Retry-After` says, then send the request again.",
    ),
    "interrupted": Kind(
        "503", "The service was stopped or failed while a job ran.", "Run the job again."
    ),
    "full": Kind(
        "507",
        "The disk of the service is full. Nothing was changed; everything can still be read.",
        "Make room on the disk.",
    ),
    "internal": Kind(
        "500",
        "An unexpected error occurred in the service. Its log has the details under the "
        "request's id.",
        "Try again, or report it with those lines of the log.",
    ),
}


def type_uri(name: str) -> str:
    """The address of a kind's page; jobs that failed in earlier versions have bare names."""
    return name if name.startswith("/") else f"{FOLDER}/{name.replace(' ', '-')}"


PROBLEM_TYPE = "application/problem+json"
MAX_FAULTS = 100


class Fault(BaseModel):
    """One thing that is wrong with a request."""

    detail: str = Field(description="Problem, in words.")
    field: str | None = Field(None, description="Input that is to blame.")
    remedy: str | None = Field(None, description="Remedy: an input that would be accepted.")


class Problem(BaseModel):
    """Body of every error response."""

    type: Annotated[str, BeforeValidator(type_uri)] = Field(
        description="The kind of problem: the address of a page about it.",
        examples=["/problems/input"],
    )
    title: str
    status: int
    detail: str = Field(description="Problem, in words.")
    field: str | None = Field(None, description="Input that is to blame.")
    remedy: str | None = Field(None, description="Remedy: an input that would be accepted.")
    most: float | None = Field(
        None, description="The largest number that the field would accept, where that is known."
    )
    errors: list[Fault] = Field(
        [],
        description=f"Faults of inputs that cannot be used, at most {MAX_FAULTS}; `field`, "
        "`detail` and `remedy` above are those of the first.",
    )


PROBLEM_RESPONSES: dict[int | str, dict[str, Any]] = {
    status: {"model": Problem, "description": text}
    for status, text in {
        400: "The request cannot be read.",
        401: "The service requires a token, and there is none or an unknown one.",
        403: "The request comes from a page of another site.",
        405: "The address does not support this method.",
        413: "The request is too large.",
        422: "An input cannot be used; the problem names the field and the remedy.",
        429: "Too many requests; Retry-After says when to try again.",
        503: "The service is busy or the computation took too long.",
        507: "The disk of the service is full; nothing was changed.",
    }.items()
}


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


class UnsolvedError(ServiceError):
    """The computation found no solution."""

    status, type, title = 422, "unsolved", "No result was reached"
    default_remedy = "Ask for less: a smaller strain, a smaller chart or more steps."


class NotFoundError(ServiceError):
    """Error: the thing does not exist, or belongs to another user."""

    status, type, title = 404, "not-found", "Not found here"


class RefusedError(ServiceError):
    """The request is not allowed."""

    status, type, title = 403, "refused", "Refused"


class TooLargeError(RefusedError):
    """Error: the body of a request is too large."""

    status, title = 413, "The request is too large"


class TooManyError(ServiceError):
    """Requests come too often."""

    status, type, title = 429, "too-many", "Too many requests"

    def __init__(self, detail: str, wait_s: float) -> None:
        wait = math.ceil(wait_s)
        super().__init__(detail, remedy=f"Try again in {wait} s.")
        self.headers = {"Retry-After": str(wait)}


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
