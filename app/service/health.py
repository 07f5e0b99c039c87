"""Health, readiness and metrics."""

import asyncio
from typing import Any

from fastapi import APIRouter, Request, Response
from fastapi.concurrency import run_in_threadpool
from prometheus_client import CONTENT_TYPE_LATEST, generate_latest
from pydantic import BaseModel, Field

from .doctor import Checks, examine
from .identity import LOCAL_USER, current_user
from .limits.fair_queue import FairLock
from .problems import Problem, RefusedError, UnavailableError
from .store.database import Database
from .web.bodies import BoundedRoute
from .web.sessions import Tokens

router = APIRouter(route_class=BoundedRoute, tags=["service"])

PATIENCE_S = 5.0
NEEDED = frozenset({"database", "free space", "cluster"})
"""Checks without which the service cannot work."""
PROBE = "readyz"
"""Who takes a thread for the checks: nobody's requests are in line before them."""


class Health(BaseModel):
    """The service answers."""

    status: str = "ok"


class Readiness(Health):
    """The service can work."""

    checks: dict[str, bool] = Field(description="Checks by name; true if the check passed.")


class NotReadyError(UnavailableError):
    """The service is up, but something it needs is not."""

    title = "Not ready"


@router.get("/healthz", summary="Check that the service is up")
async def healthz() -> Health:
    """Answer without database, disk or cluster: if this fails, restart the process."""
    return Health()


@router.get(
    "/readyz",
    summary="Check that the service can work",
    responses={503: {"model": Problem, "description": "What is missing."}},
)
async def readyz(request: Request) -> Readiness:
    """Run the checks of `knitcore doctor`: while this fails, send requests elsewhere.

    It fails without database, disk or cluster, and where no thread is free: it takes one in turn,
    looks for a login and waits for its turn to write, as requests do. `knitcore doctor` reports
    the rest.
    """
    threads: FairLock = request.app.state.threads
    database: Database = request.app.state.database
    try:
        async with asyncio.timeout(PATIENCE_S):
            async with threads.turn(PROBE):
                report = await run_in_threadpool(_examined, request.app.state)
            await database.written(lambda _: None)
    except TimeoutError:
        raise NotReadyError(
            "The database, the cluster or a thread of the service does not answer."
        ) from None
    return Readiness(checks={check.name: check.ok for check in report.checks})


def _examined(state: Any) -> Checks:
    """The checks, none of those that are needed failed, and after them a look for a login."""
    report = examine(state.settings, state.database, state.cluster)
    for check in report.failed:
        if check.name in NEEDED:
            raise NotReadyError(check.problem or check.name, remedy=check.remedy)
    Tokens(state.database).find(identifier="")
    return report


@router.get("/metrics", summary="Numbers for Prometheus", response_class=Response)
def metrics(request: Request) -> Response:
    """Report requests, times, jobs, views and the process itself.

    Where users have logins of their own, they need the token of the settings.
    """
    if current_user.get() != LOCAL_USER:
        raise RefusedError(
            "Numbers about all users are for the operator of the service.",
            remedy="Send the token of KNITCORE_TOKEN.",
        )
    registry = request.app.state.metrics.registry
    return Response(generate_latest(registry), media_type=CONTENT_TYPE_LATEST)
