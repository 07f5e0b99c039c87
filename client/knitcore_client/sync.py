"""The client that waits (made by scripts/client_code.py)."""

from __future__ import annotations

import json
import secrets
import time
from collections.abc import Iterator
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
from knitcore_client.operations import Operations
from knitcore_client.wire import ATTEMPTS, PAUSE_S, sent, wait_s

Model = TypeVar("Model", bound=BaseModel)
_JOB_RESULT: TypeAdapter[JobResult] = TypeAdapter(JobResult)


class Client(Operations):
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
        transport: httpx.BaseTransport | None = None,
    ) -> None:
        self._http = httpx.Client(
            base_url=f"{address.rstrip('/')}/api/v1",
            headers={"Authorization": f"Bearer {token}"} if token else {},
            timeout=timeout_s,
            transport=transport,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    def signed_in(self) -> SignedIn:
        """Who you are, where you are signed in, and how much of your limits you use."""
        return self._get(SignedIn, "/session")

    def sign_out(self) -> None:
        """End the session of this request; a token stays as it is."""
        self._send("DELETE", "/session")

    def end_session(self, session: str) -> None:
        """End another session of yours."""
        self._send("DELETE", f"/sessions/{session}")

    # designs

    def designs(self, *, deleted: bool = False) -> Iterator[DesignSummary]:
        """All designs, the latest changes first; or those that can be recovered."""
        for page in self._pages(DesignPage, "/designs", deleted=deleted):
            for design in page.designs:
                yield design

    def create(self, name: str, material: str, chart: str, note: str = "") -> Design:
        """Keep a new design."""
        document = DesignDocument(name=name, material=material, chart=chart, note=note)
        return self._make(Design, "/designs", document)

    def design(self, design: str) -> Design:
        """A design."""
        return self._get(Design, f"/designs/{design}")

    def save(self, design: str, document: DesignDocument, revision: int) -> Design:
        """Replace a design that was at ``revision``; refused as stale if it is at another."""
        return self._change(Design, "PUT", f"/designs/{design}", revision, document)

    def patch(self, design: str, revision: int, fields: DesignPatch) -> Design:
        """Change its name, material or note."""
        return self._change(Design, "PATCH", f"/designs/{design}", revision, fields)

    def paint(self, design: str, rows: int, columns: int, runs: list[Run]) -> Painted:
        """Merge strokes into a design."""
        strokes = {"rows": rows, "columns": columns, "runs": runs}
        return self._post(Painted, f"/designs/{design}/strokes", strokes)

    def watch(self, design: str) -> Iterator[tuple[str, int]]:
        """What happens to a design: ``others`` and how many more follow it, or ``changed`` and its
        new revision.
        """
        for kind, number in self._events(f"/designs/{design}/events"):
            yield kind, int(number)

    def duplicate(self, design: str) -> Design:
        """A new design with the same content."""
        return self._make(Design, f"/designs/{design}/duplicate")

    def delete(self, design: str) -> None:
        """Delete a design; it can be recovered for 30 days."""
        self._send("DELETE", f"/designs/{design}")

    def recover(self, design: str) -> Design:
        """Bring a deleted design back."""
        return self._post(Design, f"/designs/{design}/recover")

    def versions(self, design: str) -> list[VersionSummary]:
        """Kept states of a design, oldest first."""
        return (self._get(Versions, f"/designs/{design}/versions")).versions

    def kept(self, design: str, number: int) -> Version:
        """A kept state."""
        return self._get(Version, f"/designs/{design}/versions/{number}")

    def keep(self, design: str, name: str) -> VersionSummary:
        """Keep the present state under a name."""
        return self._make(VersionSummary, f"/designs/{design}/versions", {"name": name})

    def restore(self, design: str, number: int, revision: int) -> Design:
        """Go back to a kept state; the present one, at ``revision``, is kept first."""
        path = f"/designs/{design}/versions/{number}/restore"
        return self._change(Design, "POST", path, revision)

    def shares(self, design: str) -> Shares:
        """Links to a design."""
        return self._get(Shares, f"/designs/{design}/shares")

    def share(self, design: str, mode: ShareMode = "read") -> NewShare:
        """A link for reading, or for copying; its token is shown only here."""
        return self._post(NewShare, f"/designs/{design}/shares", {"mode": mode})

    def unshare(self, design: str, share: str) -> None:
        """Take a link back."""
        self._send("DELETE", f"/designs/{design}/shares/{share}")

    def shared(self, token: str) -> SharedDesign:
        """The design that a link shows."""
        return self._get(SharedDesign, f"/shared/{token}")

    def copy(self, token: str) -> Design:
        """Copy the design that a link shows."""
        return self._make(Design, f"/shared/{token}/copy")

    # jobs

    def jobs(self) -> Iterator[JobStatus]:
        """All jobs, latest first."""
        for page in self._pages(JobPage, "/jobs"):
            for job in page.jobs:
                yield job

    def job(self, job: str) -> JobStatus:
        """Where a job stands."""
        return self._get(JobStatus, f"/jobs/{job}")

    def follow(self, job: str) -> Iterator[JobStatus]:
        """A job's states and progress until it ends."""
        while True:
            for _, data in self._events(f"/jobs/{job}/events"):
                status = JobStatus.model_validate_json(data)
                yield status
                if status.state not in ("waiting", "running"):
                    return
            time.sleep(PAUSE_S)

    def result(self, job: str) -> JobResult:
        """The result of a job; its ``kind`` says which."""
        answer = self._send("GET", f"/jobs/{job}/result")
        return _JOB_RESULT.validate_json(answer.content)

    def cancel(self, job: str) -> JobStatus:
        """Stop a job."""
        return JobStatus.model_validate_json((self._send("DELETE", f"/jobs/{job}")).content)

    def again(self, job: str) -> JobStatus:
        """Run a job again."""
        return self._post(JobStatus, f"/jobs/{job}/again")

    # materials of your own

    def add_material(self, document: MaterialDocument) -> MaterialSummary:
        """Add a material, or replace the one that you added under its identifier."""
        return self._post(MaterialSummary, "/materials", document)

    def material_document(self, identifier: str) -> MaterialDocument:
        """A material as a file."""
        return self._get(MaterialDocument, f"/materials/{identifier}/document")

    def remove_material(self, identifier: str) -> None:
        """Remove a material that you added."""
        self._send("DELETE", f"/materials/{identifier}")

    # the 3D view

    def show(self, design: str, **view: Unpack[ViewRequest]) -> ViewResult:
        """Draw a design; whoever watches the view's address sees it."""
        answer = self._send("PUT", f"/views/{design}", json=sent(view))
        return ViewResult.model_validate_json(answer.content)

    def mark(self, design: str, box: BoxInput | None = None) -> None:
        """Outline stitches in the view; without a box, none."""
        self._send("PUT", f"/views/{design}/mark", json={"box": box})

    def look(self, design: str, side: CameraSide) -> None:
        """Turn the camera of everybody who watches."""
        self._send("PUT", f"/views/{design}/camera", json={"side": side})

    def clicks(self, design: str) -> Iterator[Focus]:
        """Stitches that somebody clicks in the view, until it is closed."""
        for _, data in self._events(f"/views/{design}/events"):
            stitch: Focus = json.loads(data)
            yield stitch

    def picture(self, design: str, width: int = 1600, height: int = 1200) -> bytes:
        """The view as PNG, as a browser that watches it draws it."""
        size = {"width": width, "height": height}
        return (self._send("GET", f"/views/{design}/picture", params=size)).content

    def still(self, width: int = 800, height: int = 600, **view: Unpack[ViewRequest]) -> bytes:
        """A PNG of the fabric's face, drawn by the service."""
        size = {"width": width, "height": height}
        return (self._send("POST", "/views/still", json=sent(view), params=size)).content

    def page(self, **view: Unpack[SharedViewRequest]) -> bytes:
        """The view as one HTML file that needs nothing else."""
        return (self._send("POST", "/views/page", json=sent(view))).content

    def recording(self, **view: Unpack[SharedViewRequest]) -> bytes:
        """The view as a ``.viser`` file."""
        return (self._send("POST", "/views/recording", json=sent(view))).content

    def solid(self, **view: Unpack[SharedViewRequest]) -> bytes:
        """The yarn as binary glTF."""
        return (self._send("POST", "/views/solid", json=sent(view))).content

    # on the wire

    def _ask(self, result: type[Model], method: str, path: str, request: Any) -> Model:
        if method == "GET":
            return self._get(result, path.format(**request))
        return self._post(result, path, request)

    def _submit(self, kind: str, request: Any) -> JobStatus:
        return self._make(JobStatus, "/jobs", {"kind": kind, "request": request})

    def _run(self, kind: str, request: Any) -> JobResult:
        job = (self._submit(kind, request)).id
        ended = False
        try:
            for _ in self.follow(job):
                pass
            ended = True
        finally:
            if not ended:
                self.cancel(job)
        return self.result(job)

    def _events(self, path: str) -> Iterator[tuple[str, str]]:
        """Kind and data of server-sent events, until the service ends them."""
        attempt = 1
        while True:
            try:
                with self._http.stream("GET", path, timeout=None) as stream:
                    if stream.is_error:
                        stream.read()
                        time.sleep(wait_s(stream, attempt))
                    else:
                        kind = ""
                        for line in stream.iter_lines():
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

    def _get(self, model: type[Model], path: str, **query: Any) -> Model:
        return model.model_validate_json((self._send("GET", path, params=query)).content)

    def _pages(self, model: type[Model], path: str, **query: Any) -> Iterator[Model]:
        while True:
            page = self._get(model, path, limit=200, **query)
            yield page
            query["cursor"] = getattr(page, "next_cursor", None)
            if query["cursor"] is None:
                return

    def _post(self, model: type[Model], path: str, body: Any = None, **more: Any) -> Model:
        answer = self._send("POST", path, json=sent(body), **more)
        return model.model_validate_json(answer.content)

    def _make(self, model: type[Model], path: str, body: Any = None) -> Model:
        key = {"Idempotency-Key": secrets.token_urlsafe(16)}
        return self._post(model, path, body, headers=key)

    def _change(
        self, model: type[Model], method: str, path: str, revision: int, body: Any = None
    ) -> Model:
        state = {"If-Match": f'"{revision}"'}
        answer = self._send(method, path, json=sent(body), headers=state)
        return model.model_validate_json(answer.content)

    def _send(self, method: str, path: str, **options: Any) -> httpx.Response:
        send = partial(self._http.request, method, path, **options)
        for attempt in range(1, ATTEMPTS + 1):
            try:
                answer = send()
            except httpx.TransportError:
                if attempt == ATTEMPTS:  # repeat until then: the key lets it take effect only once
                    raise
                continue
            if not answer.is_error:
                return answer
            time.sleep(wait_s(answer, attempt))
        raise AssertionError("unreachable")
