"""Designs over REST: saved, listed, changed, versioned and shared."""

from typing import Annotated

from fastapi import APIRouter, Depends, Header, Path, Query, Request, Response
from fastapi.responses import StreamingResponse

from ..designs.conditions import etag, knows
from ..designs.document import (
    Design,
    DesignDocument,
    DesignPage,
    DesignPatch,
    KnittingPlace,
    KnittingPlaces,
    NewShare,
    Painted,
    PlaceRequest,
    SharedDesign,
    ShareRequest,
    Shares,
    Strokes,
    Version,
    VersionRequest,
    Versions,
    VersionSummary,
)
from ..designs.parameters import MISSING, Cursor, DesignId, Limit, Owner, Responses, RetryOf
from ..designs.places import Places
from ..designs.sharing import Sharing
from ..designs.store import DesignStore
from ..designs.watching import PERIOD_S, QUIET_S
from ..problems import Problem
from ..web.bodies import BoundedRoute
from ..web.events import event_stream, stream_of

CONFLICT: Responses = {
    409: {"model": Problem, "description": "It conflicts with the present state."}
}
CONDITIONAL: Responses = {
    412: {"model": Problem, "description": "The design was changed in the meantime."},
    428: {"model": Problem, "description": "If-Match is missing."},
}

router = APIRouter(route_class=BoundedRoute, tags=["designs"], responses=MISSING)

IfMatch = Annotated[
    str | None, Header(description="The ETag of the state that was changed.", max_length=200)
]
Number = Annotated[int, Path(ge=1, le=1_000_000, description="Number of a version.")]
Token = Annotated[str, Path(min_length=1, max_length=100, pattern=r"^[A-Za-z0-9_-]+$")]
ShareId = Annotated[str, Path(min_length=1, max_length=64, pattern=r"^[A-Za-z0-9_-]+$")]


async def _store(request: Request) -> DesignStore:
    return DesignStore(request.app.state.database, request.app.state.watched.changed)


async def _sharing(request: Request) -> Sharing:
    return Sharing(request.app.state.database)


async def _places(request: Request) -> Places:
    return Places(request.app.state.database)


Store = Annotated[DesignStore, Depends(_store)]
Links = Annotated[Sharing, Depends(_sharing)]
KnittedTo = Annotated[Places, Depends(_places)]
Way = Annotated[
    str,
    Path(
        pattern=r"^[a-z0-9][a-z0-9-]{0,39}$",
        description="`flat`, `round`, or the identifier of a machine.",
    ),
]


def _tagged(response: Response, design: Design) -> Design:
    response.headers["ETag"] = etag(design.revision)
    return design


def _created(response: Response, design: Design) -> Design:
    response.headers["Location"] = f"/api/v1/designs/{design.id}"
    return _tagged(response, design)


@router.get("/designs", summary="Your designs, the latest changes first")
def get_designs(
    store: Store,
    owner: Owner,
    limit: Limit = 50,
    cursor: Cursor = None,
    deleted: Annotated[
        bool, Query(description="List deleted designs that can be recovered instead.")
    ] = False,
    q: Annotated[
        str, Query(max_length=200, description="List only designs whose name contains this.")
    ] = "",
) -> DesignPage:
    """Return a page of summaries; `next_cursor` gets the next one."""
    return store.page(owner, limit=limit, cursor=cursor, deleted=deleted, part=q)


@router.post("/designs", status_code=201, summary="Save a new design", responses=CONFLICT)
def post_design(
    body: DesignDocument, store: Store, owner: Owner, response: Response, retry: RetryOf
) -> Design:
    """Save the document of a design file; its chart is kept in canonical text."""
    return _created(response, store.create(owner, body, retry(body)))


@router.get(
    "/designs/{design}",
    summary="A design",
    response_model=Design,
    responses={304: {"description": "It is still the state of If-None-Match."}},
)
def get_design(
    design: DesignId,
    store: Store,
    owner: Owner,
    response: Response,
    if_none_match: Annotated[str | None, Header(max_length=200)] = None,
) -> Design | Response:
    """Return the document and its ETag, or 304 if the caller has it already."""
    stored = store.get(owner, design)
    if if_none_match is not None and knows(if_none_match, stored.revision):
        return Response(status_code=304, headers={"ETag": etag(stored.revision)})
    return _tagged(response, stored)


@router.get(
    "/designs/{design}/events",
    summary="Follow a design",
    **stream_of("Events `others`, `changed`."),
)
def get_design_events(
    design: DesignId, store: Store, owner: Owner, request: Request
) -> StreamingResponse:
    """Server-sent events: `others`, how many more follow it at this process, and `changed`, its
    new revision.
    """
    store.get(owner, design)
    state = request.app.state
    news = state.watched.events(owner, design, lambda: state.stopping)
    return event_stream(request, news, PERIOD_S, QUIET_S)


@router.put("/designs/{design}", summary="Replace a design", responses=CONDITIONAL)
def put_design(
    design: DesignId,
    body: DesignDocument,
    store: Store,
    owner: Owner,
    response: Response,
    if_match: IfMatch = None,
) -> Design:
    """Replace the document. Refused with 412 if somebody else changed the design meanwhile;
    nothing is lost then."""
    return _tagged(response, store.replace(owner, design, body, if_match))


@router.patch("/designs/{design}", summary="Rename a design", responses=CONDITIONAL)
def patch_design(
    design: DesignId,
    body: DesignPatch,
    store: Store,
    owner: Owner,
    response: Response,
    if_match: IfMatch = None,
) -> Design:
    """Change only its name, material or note."""
    return _tagged(response, store.patch(owner, design, body, if_match))


@router.post("/designs/{design}/strokes", summary="Paint on a design", responses=CONFLICT)
async def post_strokes(
    design: DesignId, body: Strokes, store: Store, owner: Owner, response: Response
) -> Painted:
    """Strokes of several people merge; sending the same strokes again changes nothing more.

    Refused with 409 if the chart has another size by now.
    """
    painted = await store.paint(owner, design, body)
    response.headers["ETag"] = etag(painted.revision)
    return painted


@router.post(
    "/designs/{design}/duplicate", status_code=201, summary="Copy a design", responses=CONFLICT
)
def post_duplicate(
    design: DesignId, store: Store, owner: Owner, response: Response, retry: RetryOf
) -> Design:
    """Make a new design with the same content."""
    return _created(response, store.duplicate(owner, design, retry()))


@router.delete(
    "/designs/{design}",
    status_code=204,
    summary="Delete a design",
    responses={412: CONDITIONAL[412]},
)
def delete_design(design: DesignId, store: Store, owner: Owner, if_match: IfMatch = None) -> None:
    """Delete a design. It can be recovered for 30 days."""
    store.delete(owner, design, if_match)


@router.post("/designs/{design}/recover", summary="Recover a deleted design")
def post_recover(design: DesignId, store: Store, owner: Owner, response: Response) -> Design:
    """Restore a deleted design as it was."""
    return _tagged(response, store.recover(owner, design))


@router.get("/designs/{design}/versions", summary="Saved versions of a design")
def get_versions(design: DesignId, store: Store, owner: Owner) -> Versions:
    """List the versions, oldest first."""
    return store.versions(owner, design)


@router.post(
    "/designs/{design}/versions",
    status_code=201,
    summary="Save the present state under a name",
    responses=CONFLICT,
)
def post_version(
    design: DesignId, body: VersionRequest, store: Store, owner: Owner, retry: RetryOf
) -> VersionSummary:
    """Save the present state as a version. Versions are never changed or overwritten."""
    return store.keep_version(owner, design, body.name, retry(body))


@router.get("/designs/{design}/versions/{number}", summary="A saved version")
def get_version(design: DesignId, number: Number, store: Store, owner: Owner) -> Version:
    """Return a version with its document."""
    return store.version(owner, design, number)


@router.post(
    "/designs/{design}/versions/{number}/restore",
    summary="Restore a saved version",
    responses=CONDITIONAL | CONFLICT,
)
def post_restore(
    design: DesignId,
    number: Number,
    store: Store,
    owner: Owner,
    response: Response,
    if_match: IfMatch = None,
) -> Design:
    """Restore a version. The present state is saved as a version first."""
    return _tagged(response, store.restore(owner, design, number, if_match))


@router.get("/designs/{design}/places", summary="Your places in knitting a design")
def get_places(design: DesignId, places: KnittedTo, owner: Owner) -> KnittingPlaces:
    """List the places, one for each way to knit it. Undo and versions leave them as they are."""
    return places.all(owner, design)


@router.put("/designs/{design}/places/{way}", summary="Keep your place in knitting a design")
def put_place(
    design: DesignId, way: Way, body: PlaceRequest, places: KnittedTo, owner: Owner
) -> KnittingPlace:
    """Keep the row at hand, so that another device goes on there."""
    return places.keep(owner, design, way, body)


@router.get("/designs/{design}/shares", summary="Links to a design")
def get_shares(design: DesignId, links: Links, owner: Owner) -> Shares:
    """List the links without their secrets, which are not stored."""
    return links.given(owner, design)


@router.post("/designs/{design}/shares", status_code=201, summary="Share a design")
def post_share(
    design: DesignId, body: ShareRequest, links: Links, owner: Owner, response: Response
) -> NewShare:
    """Make a link for reading, or for copying. Its token is shown only once."""
    response.headers["Cache-Control"] = "no-store"
    return links.give(owner, design, body.mode)


@router.delete("/designs/{design}/shares/{share}", status_code=204, summary="Revoke a link")
def delete_share(design: DesignId, share: ShareId, links: Links, owner: Owner) -> None:
    """Revoke the link immediately. This cannot be undone."""
    links.revoke(owner, design, share)


@router.get("/shared/{token}", summary="The design behind a link")
def get_shared(token: Token, links: Links) -> SharedDesign:
    """Return the design's present state, for anyone who has the link."""
    return links.open(token)


@router.post(
    "/shared/{token}/copy",
    status_code=201,
    summary="Copy the design behind a link",
    responses=CONFLICT,
)
def post_copy(
    token: Token, links: Links, owner: Owner, response: Response, retry: RetryOf
) -> Design:
    """Make a design of your own, if the link allows it."""
    return _created(response, links.copy(owner, token, retry()))
