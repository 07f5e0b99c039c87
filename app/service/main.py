"""The application, put together from its parts."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import sys
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

from anyio.to_thread import current_default_thread_limiter
from fastapi import FastAPI

from knitcore.base.loading import loading

from ..context import Context
from ..operations.chart.predict import PredictRequest, predict
from ..viewer import relay
from ..viewer.incoming import MOST_OPENINGS, OPENINGS_PER_S
from ..viewer.views import Views
from . import VERSION, health, memory
from .api import routers
from .compute.answers import Answers, RecentResults
from .compute.compute import Compute
from .compute.processes import load, processes
from .compute.workers import Worker
from .designs.conditions import forget_old_keys
from .designs.store import DesignStore
from .designs.watching import Watched
from .jobs.runner import JobRunner
from .jobs.store import JobStore
from .limits.fair_queue import FairLock
from .limits.fair_threads import FairThreads
from .limits.user_limits import USER_LIMITS, ConcurrencyLimit, RateLimit
from .periodic import repeated
from .problems import PROBLEM_RESPONSES
from .settings import Settings
from .store.database import Database
from .store.material_store import MaterialStore
from .store.schema import migrate
from .web.bodies import BoundedRoute
from .web.errors import install_problem_handlers
from .web.observing import Metrics, Observer, configure_logging
from .web.page import serve_page
from .web.passes import ViewPasses
from .web.reference import serve_kinds, serve_reference
from .web.schema import install_schema
from .web.security import AccessControl
from .web.sessions import REMEMBERED_S, Login, Sessions, Tokens

if TYPE_CHECKING:
    from .compute.cluster import Cluster

log = logging.getLogger("knitcore.app")

JANITOR_PERIOD_S = 30.0
TIDY_PERIOD_S = 3600.0
READY_AFTER_S = 2.0
THREADS = 8
"""Threads of requests. Python runs one at a time: with FastAPI's 40, the event loop could wait for
all of them each time it returns from reading or sending."""
THREADS_EACH = 2
"""Most of these threads that one of several users takes at once."""
SPARE_THREADS = 2
"""Threads of FastAPI for what takes none of these in turn, such as light work, one at a time."""


@contextlib.asynccontextmanager
async def _running(app: FastAPI) -> AsyncIterator[None]:
    """Open what the service needs while it runs, and close it at the end."""
    chosen: Settings = app.state.settings
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")  # workers share the cores; see docs/swatch.md
    each = THREADS_EACH if chosen.asks_for_login else THREADS
    asyncio.get_running_loop().set_default_executor(FairThreads(THREADS, each))
    current_default_thread_limiter().total_tokens = THREADS + SPARE_THREADS  # FastAPI's
    given: Database | None = app.state.database
    app.state.database = given or await asyncio.to_thread(_open_database, chosen)
    token = chosen.token.get_secret_value() if chosen.token else None
    tokens, sessions = Tokens(app.state.database), Sessions(app.state.database)
    app.state.login = await asyncio.to_thread(Login, tokens, sessions, token)
    app.state.cluster = _cluster(chosen)
    app.state.compute = Compute(
        _workers(chosen, app.state.cluster), chosen.job_timeout_s, _most_each(chosen)
    )
    app.state.threads = FairLock(THREADS, most_each=each, most_waiting=sys.maxsize)
    app.state.large_bodies = FairLock()
    app.state.light_work = FairLock()
    app.state.drawing = FairLock()
    app.state.result_parts = FairLock(most_waiting=sys.maxsize)
    app.state.backs = set()  # tasks that draw the backs of cloths
    app.state.views = Views(chosen.max_viewers, chosen.viewer_idle_s)
    app.state.recent = RecentResults()
    app.state.answers = Answers(
        app.state.compute, app.state.recent, chosen.folder, MaterialStore(app.state.database)
    )
    app.state.viewer_page = relay.viewer_page()
    job_store = JobStore(app.state.database, chosen.process_name)
    app.state.jobs = JobRunner(job_store, app.state.answers, chosen.background_timeout_s)
    await app.state.jobs.resume()
    janitors = [
        asyncio.create_task(repeated(*chore)) for chore in _chores(app, chosen, tokens, job_store)
    ]
    app.state.visited = asyncio.Event()
    janitors.append(asyncio.create_task(_get_ready(app)))
    yield
    for task in (*janitors, *app.state.backs):
        task.cancel()
    await app.state.jobs.close()
    app.state.compute.close()
    await asyncio.to_thread(app.state.views.close)
    if given is None:
        await asyncio.to_thread(app.state.database.close)
    app.state.database = given


def create_app(settings: Settings | None = None, database: Database | None = None) -> FastAPI:
    """The service, ready for an ASGI server.

    Parameters
    ----------
    settings : those of the environment by default.
    database : of the settings, open and up to date, which the caller closes; opened by the service
        otherwise.

    Raises
    ------
    InputError
        If the settings would open the service to strangers.
    """
    chosen = (settings or Settings()).check()
    app = FastAPI(
        title="Knitcore",
        summary="Design the mechanics of knitted fabric, stitch by stitch.",
        version=VERSION,
        lifespan=_running,
        openapi_url=None,  # app.service.web.schema serves it, packed
        docs_url=None,  # FastAPI's pages ask other hosts for their scripts
        redoc_url=None,
        responses=PROBLEM_RESPONSES,
        generate_unique_id_function=lambda route: route.name,
    )
    app.state.settings = chosen
    app.state.database = database
    app.state.stopping = False
    app.state.concurrency = ConcurrencyLimit()
    app.state.view_openings = RateLimit(OPENINGS_PER_S, MOST_OPENINGS)
    app.state.watched = Watched()
    app.state.passes = ViewPasses()
    app.state.metrics = Metrics(_gauges(app))
    app.router.route_class = BoundedRoute
    install_problem_handlers(app)
    install_schema(app)
    for router in routers():
        app.include_router(router, prefix="/api/v1")
    app.include_router(relay.router)
    app.include_router(health.router)
    serve_reference(app)
    serve_kinds(app)
    serve_page(app)
    app.add_middleware(AccessControl, settings=chosen)
    app.add_middleware(Observer, metrics=app.state.metrics)
    return app


def _gauges(app: FastAPI) -> dict[str, tuple[str, Callable[[], float]]]:
    state = app.state
    return {
        "views_open": ("3D views kept open.", lambda: len(state.views)),
        "jobs_waiting": ("Jobs in line.", lambda: state.jobs.counts()["waiting"]),
        "jobs_running": ("Jobs at work.", lambda: state.jobs.counts()["running"]),
        "computations_running": (
            "Computations at work, of requests and of jobs.",
            lambda: state.compute.queue.taken,
        ),
        "computations_waiting": (
            "Requests that wait for a worker.",
            lambda: state.compute.queue.waiting(background=False),
        ),
    }


async def _get_ready(app: FastAPI) -> None:
    """Load what computations need, once the first page is sent or nobody opens it."""
    with contextlib.suppress(TimeoutError):
        await asyncio.wait_for(app.state.visited.wait(), READY_AFTER_S)
    if app.state.cluster is None:
        load()
    await asyncio.to_thread(_warm_up)


@cache
def _warm_up() -> None:
    """Read the learned answers, which the first prediction would wait a second for, and load what
    pressures and views need.
    """
    with loading():
        import scipy.ndimage
        import scipy.optimize  # noqa: F401

        from ..viewer import private_port  # noqa: F401

        mixed = PredictRequest(chart="KP/KK", material="acrylic")
        predict(mixed, Context(Path()))
    memory.give_back()


def _chores(
    app: FastAPI, chosen: Settings, tokens: Tokens, jobs: JobStore
) -> Iterator[tuple[str, Callable[[], Awaitable[None]], float]]:
    """Yield what is done beside requests: in words, the function, and its period in s."""
    close = partial(_close_idle_views, app.state.views)
    yield "closing idle views", close, min(JANITOR_PERIOD_S, chosen.viewer_idle_s)
    tidy = partial(_tidy_store, app.state.database, jobs, chosen.results_max_bytes)
    yield "tidying the store", tidy, TIDY_PERIOD_S
    if chosen.require_login:
        end = partial(_end_jobs_of_the_revoked, tokens, app.state.jobs)
        yield "ending jobs of users without a token", end, REMEMBERED_S


async def _close_idle_views(views: Views) -> None:
    closed = await asyncio.to_thread(views.close_idle)
    if closed:
        await asyncio.to_thread(memory.give_back)
        log.info("closed %d idle 3D views, %d left", closed, len(views))


def _cluster(settings: Settings) -> Cluster | None:
    if settings.scheduler is None:
        return None
    from .compute.cluster import Cluster  # its library is needed here only

    return Cluster(settings.scheduler)


def _workers(settings: Settings, cluster: Cluster | None) -> list[Worker]:
    """Workers that do the heavy work."""
    if cluster is not None:
        from .compute.cluster import ClusterWorker

        return [ClusterWorker(cluster) for _ in range(settings.workers)]
    return list(
        processes(
            settings.workers,
            settings.worker_memory_bytes,
            idle=settings.worker_priority == "idle",
            begin=partial(configure_logging, settings.log_format),
        )
    )


def _most_each(settings: Settings) -> int | None:
    """Workers that one user may hold, by their memory; no limit on a cluster."""
    if settings.scheduler is not None or not settings.asks_for_login:
        return None
    return max(1, USER_LIMITS.memory_bytes // settings.worker_memory_bytes)


def _open_database(settings: Settings) -> Database:
    settings.make_folder()
    database = Database(settings.store_url)
    migrate(database)
    return database


async def _end_jobs_of_the_revoked(tokens: Tokens, jobs: JobRunner) -> None:
    """End the jobs of users who no longer have an open token."""
    for user in await asyncio.to_thread(tokens.without_any, jobs.owners()):
        log.info("the jobs of %s are ended: no token is open any more", user)
        await jobs.cancel_all(user)


async def _tidy_store(database: Database, jobs: JobStore, results_max_bytes: int) -> None:
    """Delete what can no longer be requested."""
    await asyncio.to_thread(DesignStore(database).forget_deleted)
    await asyncio.to_thread(forget_old_keys, database)
    await asyncio.to_thread(Sessions(database).tidy)
    await asyncio.to_thread(jobs.tidy, results_max_bytes)
