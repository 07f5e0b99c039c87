"""Kinds of problems, and the page of each: problems name it as their ``type`` (RFC 9457)."""

from __future__ import annotations

from typing import NamedTuple

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
