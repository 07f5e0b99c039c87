"""The asynchronous client. ``scripts/client_code.py`` makes the one that waits from it."""

import asyncio
import json
import secrets
from collections.abc import AsyncIterator
from functools import partial
from types import TracebackType
from typing import Any, Self, TypeVar, Unpack

import httpx2 as httpx
from pydantic import BaseModel, TypeAdapter

from knitcore_client.models import (
    BoxInput,
    CameraSide,
    Design,
    DesignDocument,
    DesignPage,
    DesignPatch,
    DesignSummary,
    Focus,
    JobPage,
    JobResult,
    JobStatus,
    MaterialDocument,
    MaterialSummary,
    NewShare,
    Painted,
    Run,
    SharedDesign,
    SharedViewRequest,
    ShareMode,
    Shares,
    SignedIn,
    Version,
    Versions,
    VersionSummary,
    ViewRequest,
    ViewResult,
)
from knitcore_client.operations import AsyncOperations
from knitcore_client.wire import ATTEMPTS, PAUSE_S, sent, wait_s

Model = TypeVar("Model", bound=BaseModel)
_JOB_RESULT: TypeAdapter[JobResult] = TypeAdapter(JobResult)


class AsyncClient(AsyncOperations):
    """The service at an address.

    A request whose answer is lost is sent again, as is one that the service asks to repeat later
    (``Retry-After``); requests that create something carry a key, so that it is created once.

    Parameters
    ----------
    address : where it is, such as ``http://127.0.0.1:8737``.
    token : of the user, where the service asks for one.
    timeout_s : longest wait for an answer.
    transport : replaces the network, for tests.

    Raises
    ------
    ProblemError
        In every method, if the service refuses or fails.
    """

    def __init__(
        self,
        address: str,
        token: str | None = None,
        timeout_s: float = 60.0,
        transport: httpx.AsyncBaseTransport | None = None,
    ) -> None:
        self._http = httpx.AsyncClient(
            base_url=f"{address.rstrip('/')}/api/v1",
            headers={"Authorization": f"Bearer {token}"} if token else {},
            timeout=timeout_s,
            transport=transport,
        )

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        await self.aclose()

    async def aclose(self) -> None:
        """Close the connections."""
        await self._http.aclose()

    async def signed_in(self) -> SignedIn:
        """Who you are, where you are signed in, and how much of your limits you use."""
        return await self._get(SignedIn, "/session")

    async def sign_out(self) -> None:
        """End the session of this request; a token stays as it is."""
        await self._send("DELETE", "/session")

    async def end_session(self, session: str) -> None:
        """End another session of yours."""
        await self._send("DELETE", f"/sessions/{session}")

    # designs

    async def designs(self, *, deleted: bool = False) -> AsyncIterator[DesignSummary]:
        """All designs, the latest changes first; or those that can be recovered."""
        async for page in self._pages(DesignPage, "/designs", deleted=deleted):
            for design in page.designs:
                yield design

    async def create(self, name: str, material: str, chart: str, note: str = "") -> Design:
        """Keep a new design."""
        document = DesignDocument(name=name, material=material, chart=chart, note=note)
        return await self._make(Design, "/designs", document)

    async def design(self, design: str) -> Design:
        """A design."""
        return await self._get(Design, f"/designs/{design}")

    async def save(self, design: str, document: DesignDocument, revision: int) -> Design:
        """Replace a design that was at ``revision``; refused as stale if it is at another."""
        return await self._change(Design, "PUT", f"/designs/{design}", revision, document)

    async def patch(self, design: str, revision: int, fields: DesignPatch) -> Design:
        """Change its name, material or note."""
        return await self._change(Design, "PATCH", f"/designs/{design}", revision, fields)

    async def paint(self, design: str, rows: int, columns: int, runs: list[Run]) -> Painted:
        """Merge strokes into a design."""
        strokes = {"rows": rows, "columns": columns, "runs": runs}
        return await self._post(Painted, f"/designs/{design}/strokes", strokes)

    async def watch(self, design: str) -> AsyncIterator[tuple[str, int]]:
        """What happens to a design: ``others`` and how many more follow it, or ``changed`` and its
        new revision.
        """
        async for kind, number in self._events(f"/designs/{design}/events"):
            yield kind, int(number)

    async def duplicate(self, design: str) -> Design:
        """A new design with the same content."""
        return await self._make(Design, f"/designs/{design}/duplicate")

    async def delete(self, design: str) -> None:
        """Delete a design; it can be recovered for 30 days."""
        await self._send("DELETE", f"/designs/{design}")

    async def recover(self, design: str) -> Design:
        """Bring a deleted design back."""
        return await self._post(Design, f"/designs/{design}/recover")

    async def versions(self, design: str) -> list[VersionSummary]:
        """Kept states of a design, oldest first."""
        return (await self._get(Versions, f"/designs/{design}/versions")).versions

    async def kept(self, design: str, number: int) -> Version:
        """A kept state."""
        return await self._get(Version, f"/designs/{design}/versions/{number}")

    async def keep(self, design: str, name: str) -> VersionSummary:
        """Keep the present state under a name."""
        return await self._make(VersionSummary, f"/designs/{design}/versions", {"name": name})

    async def restore(self, design: str, number: int, revision: int) -> Design:
        """Go back to a kept state; the present one, at ``revision``, is kept first."""
        path = f"/designs/{design}/versions/{number}/restore"
        return await self._change(Design, "POST", path, revision)

    async def shares(self, design: str) -> Shares:
        """Links to a design."""
        return await self._get(Shares, f"/designs/{design}/shares")

    async def share(self, design: str, mode: ShareMode = "read") -> NewShare:
        """A link for reading, or for copying; its token is shown only here."""
        return await self._post(NewShare, f"/designs/{design}/shares", {"mode": mode})

    async def unshare(self, design: str, share: str) -> None:
        """Take a link back."""
        await self._send("DELETE", f"/designs/{design}/shares/{share}")

    async def shared(self, token: str) -> SharedDesign:
        """The design that a link shows."""
        return await self._get(SharedDesign, f"/shared/{token}")

    async def copy(self, token: str) -> Design:
        """Copy the design that a link shows."""
        return await self._make(Design, f"/shared/{token}/copy")

    # jobs

    async def jobs(self) -> AsyncIterator[JobStatus]:
        """All jobs, latest first."""
        async for page in self._pages(JobPage, "/jobs"):
            for job in page.jobs:
                yield job

    async def job(self, job: str) -> JobStatus:
        """Where a job stands."""
        return await self._get(JobStatus, f"/jobs/{job}")

    async def follow(self, job: str) -> AsyncIterator[JobStatus]:
        """A job's states and progress until it ends."""
        while True:
            async for _, data in self._events(f"/jobs/{job}/events"):
                status = JobStatus.model_validate_json(data)
                yield status
                if status.state not in ("waiting", "running"):
                    return
            await asyncio.sleep(PAUSE_S)

    async def result(self, job: str) -> JobResult:
        """The result of a job; its ``kind`` says which."""
        answer = await self._send("GET", f"/jobs/{job}/result")
        return _JOB_RESULT.validate_json(answer.content)

    async def cancel(self, job: str) -> JobStatus:
        """Stop a job."""
        return JobStatus.model_validate_json((await self._send("DELETE", f"/jobs/{job}")).content)

    async def again(self, job: str) -> JobStatus:
        """Run a job again."""
        return await self._post(JobStatus, f"/jobs/{job}/again")

    # materials of your own

    async def add_material(self, document: MaterialDocument) -> MaterialSummary:
        """Add a material, or replace the one that you added under its identifier."""
        return await self._post(MaterialSummary, "/materials", document)

    async def material_document(self, identifier: str) -> MaterialDocument:
        """A material as a file."""
        return await self._get(MaterialDocument, f"/materials/{identifier}/document")

    async def remove_material(self, identifier: str) -> None:
        """Remove a material that you added."""
        await self._send("DELETE", f"/materials/{identifier}")

    # the 3D view

    async def show(self, design: str, **view: Unpack[ViewRequest]) -> ViewResult:
        """Draw a design; whoever watches the view's address sees it."""
        answer = await self._send("PUT", f"/views/{design}", json=sent(view))
        return ViewResult.model_validate_json(answer.content)

    async def mark(self, design: str, box: BoxInput | None = None) -> None:
        """Outline stitches in the view; without a box, none."""
        await self._send("PUT", f"/views/{design}/mark", json={"box": box})

    async def look(self, design: str, side: CameraSide) -> None:
        """Turn the camera of everybody who watches."""
        await self._send("PUT", f"/views/{design}/camera", json={"side": side})

    async def clicks(self, design: str) -> AsyncIterator[Focus]:
        """Stitches that somebody clicks in the view, until it is closed."""
        async for _, data in self._events(f"/views/{design}/events"):
            stitch: Focus = json.loads(data)
            yield stitch

    async def picture(self, design: str, width: int = 1600, height: int = 1200) -> bytes:
        """The view as PNG, as a browser that watches it draws it."""
        size = {"width": width, "height": height}
        return (await self._send("GET", f"/views/{design}/picture", params=size)).content

    async def still(
        self, width: int = 800, height: int = 600, **view: Unpack[ViewRequest]
    ) -> bytes:
        """A PNG of the fabric's face, drawn by the service."""
        size = {"width": width, "height": height}
        return (await self._send("POST", "/views/still", json=sent(view), params=size)).content

    async def page(self, **view: Unpack[SharedViewRequest]) -> bytes:
        """The view as one HTML file that needs nothing else."""
        return (await self._send("POST", "/views/page", json=sent(view))).content

    async def recording(self, **view: Unpack[SharedViewRequest]) -> bytes:
        """The view as a ``.viser`` file."""
        return (await self._send("POST", "/views/recording", json=sent(view))).content

    async def solid(self, **view: Unpack[SharedViewRequest]) -> bytes:
        """The yarn as binary glTF."""
        return (await self._send("POST", "/views/solid", json=sent(view))).content

    # on the wire

    async def _ask(self, result: type[Model], method: str, path: str, request: Any) -> Model:
        if method == "GET":
            return await self._get(result, path.format(**request))
        return await self._post(result, path, request)

    async def _submit(self, kind: str, request: Any) -> JobStatus:
        return await self._make(JobStatus, "/jobs", {"kind": kind, "request": request})

    async def _run(self, kind: str, request: Any) -> JobResult:
        job = (await self._submit(kind, request)).id
        ended = False
        try:
            async for _ in self.follow(job):
                pass
            ended = True
        finally:
            if not ended:
                await self.cancel(job)
        return await self.result(job)

    async def _events(self, path: str) -> AsyncIterator[tuple[str, str]]:
        """Kind and data of server-sent events, until the service ends them."""
        attempt = 1
        while True:
            try:
                async with self._http.stream("GET", path, timeout=None) as stream:
                    if stream.is_error:
                        await stream.aread()
                        await asyncio.sleep(wait_s(stream, attempt))
                    else:
                        kind = ""
                        async for line in stream.aiter_lines():
                            field, _, value = line.partition(": ")
                            if field == "event":
                                kind = value
                            elif field == "data":
                                yield kind, value
                                attempt = 0
                        return
            except httpx.TransportError:
                if attempt == ATTEMPTS:
                    raise
            attempt += 1

    async def _get(self, model: type[Model], path: str, **query: Any) -> Model:
        return model.model_validate_json((await self._send("GET", path, params=query)).content)

    async def _pages(self, model: type[Model], path: str, **query: Any) -> AsyncIterator[Model]:
        while True:
            page = await self._get(model, path, limit=200, **query)
            yield page
            query["cursor"] = getattr(page, "next_cursor", None)
            if query["cursor"] is None:
                return

    async def _post(self, model: type[Model], path: str, body: Any = None, **more: Any) -> Model:
        answer = await self._send("POST", path, json=sent(body), **more)
        return model.model_validate_json(answer.content)

    async def _make(self, model: type[Model], path: str, body: Any = None) -> Model:
        key = {"Idempotency-Key": secrets.token_urlsafe(16)}
        return await self._post(model, path, body, headers=key)

    async def _change(
        self, model: type[Model], method: str, path: str, revision: int, body: Any = None
    ) -> Model:
        state = {"If-Match": f'"{revision}"'}
        answer = await self._send(method, path, json=sent(body), headers=state)
        return model.model_validate_json(answer.content)

    async def _send(self, method: str, path: str, **options: Any) -> httpx.Response:
        send = partial(self._http.request, method, path, **options)
        for attempt in range(1, ATTEMPTS + 1):
            try:
                answer = await send()
            except httpx.TransportError:
                if attempt == ATTEMPTS:  # repeat until then: the key lets it take effect only once
                    raise
                continue
            if not answer.is_error:
                return answer
            await asyncio.sleep(wait_s(answer, attempt))
        raise AssertionError("unreachable")
