"""Health, readiness and metrics."""

from __future__ import annotations

import asyncio

from fastapi import APIRouter, Request, Response
from prometheus_client import CONTENT_TYPE_LATEST, generate_latest
from pydantic import BaseModel

from app.doctor import check_space
from app.http.problems import Problem, UnavailableError
from knitcore.errors import InputError

router = APIRouter(tags=["service"])

PATIENCE_S = 5.0


class Health(BaseModel):
    """The service answers."""

    status: str = "ok"


class NotReadyError(UnavailableError):
    """The service is up, but something it needs is not."""

    title = "Not ready"


@router.get("/healthz", summary="Whether the service is up")
async def healthz() -> Health:
    """Depends on nothing else: if this fails, restart the process."""
    return Health()


@router.get(
    "/readyz",
    summary="Whether the service can work",
    responses={503: {"model": Problem, "description": "What is missing."}},
)
async def readyz(request: Request) -> Health:
    """Checks database, disk and cluster: while this fails, send requests elsewhere."""
    state = request.app.state
    try:
        async with asyncio.timeout(PATIENCE_S):
            await asyncio.to_thread(state.database.check)
            if state.database.is_sqlite:
                check_space(state.settings.folder)
            if state.cluster is not None:
                await asyncio.to_thread(state.cluster.check)
    except TimeoutError:
        raise NotReadyError("The database or the cluster does not answer.") from None
    except InputError as error:
        raise NotReadyError(error.problem, remedy=error.remedy) from None
    return Health()


@router.get("/metrics", summary="Numbers for Prometheus", response_class=Response)
def metrics(request: Request) -> Response:
    """Requests, times, jobs, views and the process itself."""
    registry = request.app.state.metrics.registry
    return Response(generate_latest(registry), media_type=CONTENT_TYPE_LATEST)
