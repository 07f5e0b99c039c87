"""Whether the service is up, whether it can work, and its numbers."""

from __future__ import annotations

import asyncio
import shutil

from fastapi import APIRouter, Request, Response
from prometheus_client import CONTENT_TYPE_LATEST, generate_latest
from pydantic import BaseModel
from sqlalchemy import text

from app.http.problems import Problem, UnavailableError
from app.settings import Settings
from app.store.database import Database

router = APIRouter(tags=["service"])

LEAST_FREE_BYTES = 100_000_000
PATIENCE_S = 5.0


class Health(BaseModel):
    """The service answers."""

    status: str = "ok"


class NotReadyError(UnavailableError):
    """The service is up, but something it needs is not."""

    title = "Not ready"


@router.get("/healthz", summary="Whether the service is up")
async def healthz() -> Health:
    """Asks nothing of anything else: if this fails, restart the process."""
    return Health()


@router.get(
    "/readyz",
    summary="Whether the service can work",
    responses={503: {"model": Problem, "description": "What is missing."}},
)
async def readyz(request: Request) -> Health:
    """Asks the database and the disk: while this fails, send requests elsewhere."""
    database: Database = request.app.state.database
    try:
        async with asyncio.timeout(PATIENCE_S):
            await asyncio.to_thread(_ask, database)
    except TimeoutError:
        raise NotReadyError("The database does not answer.") from None
    _check_disk(request.app.state.settings, database)
    return Health()


@router.get("/metrics", summary="Numbers for Prometheus", response_class=Response)
def metrics(request: Request) -> Response:
    """Requests, times, jobs, views and the process itself."""
    registry = request.app.state.metrics.registry
    return Response(generate_latest(registry), media_type=CONTENT_TYPE_LATEST)


def _ask(database: Database) -> None:
    with database.read() as connection:
        connection.execute(text("SELECT 1 FROM alembic_version"))


def _check_disk(settings: Settings, database: Database) -> None:
    if not database.is_sqlite or not settings.data_dir.is_dir():
        return
    free = shutil.disk_usage(settings.data_dir).free
    if free < LEAST_FREE_BYTES:
        raise NotReadyError(
            f"The disk of the designs has {free / 1e6:.0f} MB left.",
            remedy="Make room; nothing that was acknowledged is lost.",
        )
