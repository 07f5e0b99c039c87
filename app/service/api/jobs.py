"""Long computations in the background over REST."""

import asyncio
import contextlib
from collections.abc import AsyncGenerator, AsyncIterator, Iterator
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Path, Request, Response
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import StreamingResponse
from starlette.types import Receive, Scope, Send

from ...requests.uploads import has_files
from ..compute.answers import Answers
from ..designs.conditions import ConflictError
from ..designs.parameters import MISSING, Cursor, Limit, Owner, RetryOf
from ..identity import current_user
from ..jobs.document import JobPage, JobState, JobStatus
from ..jobs.kinds import JobRequest, JobResult, accepted, read_job
from ..jobs.runner import JobRunner
from ..limits.fair_queue import FairLock
from ..limits.user_limits import ConcurrencyLimit
from ..problems import NotFoundError, Problem, StoreError
from ..web.bodies import OrUndecoded, Undecoded, WorkerRoute
from ..web.events import event_stream, stream_of
from ..web.packed import ASKED_WITH_TAG, TAGGED, is_known, takes_gzip

EVENT_PERIOD_S = 0.25

router = APIRouter(route_class=WorkerRoute, tags=["jobs"], responses=MISSING)

JobId = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$")]


async def _runner(request: Request) -> JobRunner:
    runner: JobRunner = request.app.state.jobs
    return runner


Runner = Annotated[JobRunner, Depends(_runner)]


@router.post("/jobs", status_code=202, summary="Run an operation in the background")
async def post_job(
    body: Annotated[JobRequest, OrUndecoded],
    runner: Runner,
    owner: Owner,
    request: Request,
    response: Response,
    retry: RetryOf,
) -> JobStatus:
    """Queue a job, which waits for its turn among all users. If the result is known, the job is
    done immediately."""
    answers: Answers = request.app.state.answers
    if isinstance(body, Undecoded) or has_files(body.request):
        content = await request.body()
        supplies = await answers.supplies(content)
        kind, text = await answers.compute.run(request.is_disconnected, read_job, content, supplies)
    else:
        lock: FairLock = request.app.state.light_work
        async with lock.turn(owner):
            kind, text = await run_in_threadpool(accepted, body, answers.context())
    status = await runner.submit(owner, kind, text, retry(kind, text))
    response.headers["Location"] = f"/api/v1/jobs/{status.id}"
    return status


@router.get("/jobs", summary="Your jobs, latest first")
async def get_jobs(
    runner: Runner, owner: Owner, limit: Limit = 50, cursor: Cursor = None
) -> JobPage:
    """List your jobs. They are kept for 30 days."""
    return await asyncio.to_thread(runner.store.page, owner, limit=limit, cursor=cursor)


@router.get("/jobs/{job}", summary="The state of a job")
async def get_job(job: JobId, runner: Runner, owner: Owner) -> JobStatus:
    """Return the state, the progress, and the problem if there is one."""
    return await runner.status(owner, job)


@router.get("/jobs/{job}/events", summary="Follow a job", **stream_of("Events `status`."))
async def get_job_events(
    job: JobId, runner: Runner, owner: Owner, request: Request
) -> StreamingResponse:
    """Send an event for each change, as `GET /jobs/{job}` answers; the stream ends with the job."""
    first = await runner.status(owner, job)
    states = _states(first, job, request, runner, owner)
    return event_stream(request, states, EVENT_PERIOD_S)


async def _states(
    status: JobStatus, job: str, request: Request, runner: JobRunner, owner: str
) -> AsyncGenerator[str | None]:
    sent = ""
    with contextlib.suppress(NotFoundError):  # deleted while it was followed
        while not request.app.state.stopping:
            text = status.model_dump_json()
            yield None if text == sent else f"event: status\ndata: {text}\n\n"
            sent = text
            if status.state.is_final:
                return
            await asyncio.sleep(EVENT_PERIOD_S)
            with contextlib.suppress(StoreError):  # the stream outlasts a lost database
                status = await runner.status(owner, job)


class _HeldResponse(StreamingResponse):
    """A streamed answer that is counted until it ends."""

    def __init__(
        self, held: contextlib.ExitStack, parts: AsyncIterator[bytes], **more: Any
    ) -> None:
        super().__init__(parts, **more)
        self._held = held

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        with self._held:
            await super().__call__(scope, receive, send)


@router.get(
    "/jobs/{job}/result",
    summary="The result of a job",
    response_model=JobResult,
    responses=TAGGED | {409: {"model": Problem, "description": "The job is not done."}},
    openapi_extra=ASKED_WITH_TAG,
)
async def get_result(job: JobId, runner: Runner, owner: Owner, request: Request) -> Response:
    """Return the same JSON as the operation's own address; `kind` names the operation."""
    uses: ConcurrencyLimit = request.app.state.concurrency
    with contextlib.ExitStack() as held:
        held.enter_context(uses.hold("results", owner))
        return await _result(job, runner, owner, request, held)


async def _result(
    job: str, runner: JobRunner, owner: str, request: Request, held: contextlib.ExitStack
) -> Response:
    status = await runner.status(owner, job)
    if status.state is not JobState.DONE:
        raise ConflictError(
            f"The job is {status.state}; it has no result.",
            field="job",
            remedy="Follow its events until it is done."
            if not status.state.is_final
            else "Run it again.",
        )
    result = await asyncio.to_thread(runner.store.result, owner, job)
    if result is None:
        raise _gone()
    headers = {"ETag": f'W/"{result.key[:32]}"', "Vary": "Accept-Encoding"}
    if is_known(headers["ETag"], request.headers):
        return Response(status_code=304, headers=headers)
    if takes_gzip(request.headers):
        parts, size = result.packed(), result.size_bytes
        headers["Content-Encoding"] = "gzip"
    else:
        parts, size = result.unpacked(), await asyncio.to_thread(lambda: result.unpacked_bytes)
    headers["Content-Length"] = str(size)
    first = await asyncio.to_thread(next, parts, b"")  # what fails here can still be answered
    if not first:
        raise _gone()
    sent = _sent(first, parts, request.app.state.result_parts)
    return _HeldResponse(held.pop_all(), sent, media_type="application/json", headers=headers)


async def _sent(
    part: bytes | None, others: Iterator[bytes], lock: FairLock
) -> AsyncIterator[bytes]:
    """Parts of a result, each read in its user's turn."""
    while part is not None:
        yield part
        async with lock.turn(current_user.get()):
            part = await asyncio.to_thread(next, others, None)


def _gone() -> NotFoundError:
    return NotFoundError(
        "The result is no longer stored.", field="job", remedy="Run the job again."
    )


@router.delete("/jobs/{job}", summary="Cancel a job")
async def delete_job(job: JobId, runner: Runner, owner: Owner) -> JobStatus:
    """Stop a job that waits or runs; a job that has ended stays as it is."""
    return await runner.cancel(owner, job)


@router.post("/jobs/{job}/again", status_code=202, summary="Run a job again")
async def post_again(job: JobId, runner: Runner, owner: Owner, response: Response) -> JobStatus:
    """Start a new job with the same request, for instance after an interruption."""
    status = await runner.again(owner, job)
    response.headers["Location"] = f"/api/v1/jobs/{status.id}"
    return status
