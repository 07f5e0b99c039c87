"""The user of this request, and the browsers that are signed in."""

from typing import Annotated, Any

from fastapi import APIRouter, Path, Request, Response

from ..designs.parameters import Owner
from ..designs.sharing import Sharing
from ..designs.store import DesignStore
from ..identity import current_session
from ..limits.user_limits import USER_LIMITS, ConcurrencyLimit, Use
from ..problems import NotFoundError, Problem
from ..store.material_store import MaterialStore
from ..web.bodies import BoundedRoute
from ..web.security import OPENED_BY, SESSION_COOKIE
from ..web.sessions import Login, Sessions, SignedIn

router = APIRouter(route_class=BoundedRoute, tags=["session"])

SessionId = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$", description="Id of a session.")]


@router.get("/session", summary="Your name, sessions and limits")
def get_session(owner: Owner, request: Request) -> SignedIn:
    """Return the user's name (`local` without logins), the signed-in browsers, and the limits."""
    sessions = Sessions(request.app.state.database).of(owner, current_session.get())
    return SignedIn(user=owner, sessions=sessions, use=_use(owner, request.app.state))


def _use(owner: str, state: Any) -> dict[str, Use]:
    designs, kept_bytes = DesignStore(state.database).kept(owner)
    concurrency: ConcurrencyLimit = state.concurrency
    used = {
        name: float(concurrency.held(name, owner))
        for name in (
            "connections",
            "watchers",
            "streams",
            "pictures",
            "results",
            "body_bytes",
            "unsent_bytes",
        )
    }
    used |= {
        "memory_bytes": state.compute.queue.held(owner) * state.settings.worker_memory_bytes,
        "views": state.views.count(owner),
        "view_stitches": state.views.stitches(owner),
        "jobs": state.compute.queue.waiting_of(owner),
        "cpu_s": round(state.compute.cpu_time.used_s(owner), 1),
        "designs": designs,
        "kept_bytes": kept_bytes,
        "versions": DesignStore(state.database).most_versions(owner),
        "links": Sharing(state.database).most_given(owner),
        "materials": MaterialStore(state.database).count(owner),
        "job_bytes": state.jobs.store.kept_bytes(owner),
    }
    return {name: Use(used=value, most=getattr(USER_LIMITS, name)) for name, value in used.items()}


@router.delete("/session", status_code=204, summary="Sign out")
def delete_session(owner: Owner, request: Request, response: Response) -> None:
    """End the session of this browser."""
    _end(request, owner, current_session.get())
    response.delete_cookie(SESSION_COOKIE, httponly=True, samesite="strict")


@router.delete(
    "/sessions/{session}",
    status_code=204,
    summary="End a session",
    responses={404: {"model": Problem, "description": "The session is not one of yours."}},
)
def end_session(session: SessionId, owner: Owner, request: Request) -> None:
    """End the session of another of your browsers, for instance one on a lost machine."""
    if not _end(request, owner, session):
        raise NotFoundError(f"There is no session {session} of yours.", field="session")


def _end(request: Request, owner: str, session: str) -> bool:
    """End a session; False if the user has none of that id."""
    if session == current_session.get():
        request.scope.pop(OPENED_BY, None)  # this request is answered after its session
    login: Login = request.app.state.login
    return login.end(owner, session)
