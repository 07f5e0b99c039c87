"""Conditional requests: every change says which state it was made on."""

from ..problems import ServiceError


class StaleError(ServiceError):
    """Someone else changed the design in the meantime."""

    status, type, title = 412, "stale", "The design has changed in the meantime"


class ConflictError(ServiceError):
    """The request conflicts with the current version."""

    status, type, title = 409, "conflict", "This conflicts with the current version"


class UnconditionalError(ServiceError):
    """The request must say which state it was made on."""

    status, type, title = 428, "condition", "Say which state you have changed"


def etag(revision: int) -> str:
    """The ETag of a revision."""
    return f'"{revision}"'


def knows(tags: str, revision: int) -> bool:
    """Return whether the ETags of an If-Match or If-None-Match name this revision, or any.

    A proxy that packs answers makes them weak.
    """
    offered = {tag.strip().removeprefix("W/") for tag in tags.split(",")}
    return "*" in offered or etag(revision) in offered


def check_match(if_match: str | None, revision: int) -> None:
    """Let a change through that was made on the present revision.

    Raises
    ------
    UnconditionalError
        Without If-Match.
    StaleError
        If it names another revision.
    """
    if if_match is None:
        raise UnconditionalError(
            "A change must say which state it was made on.",
            field="If-Match",
            remedy='Send the ETag of the design you have changed as If-Match, or "*" to overwrite.',
        )
    if not knows(if_match, revision):
        raise StaleError(
            f"The design is at revision {revision} now; your change was made on another one, and "
            "nothing was overwritten.",
            field="If-Match",
            remedy="Read the design again, apply your change to it, and send the result.",
        )
