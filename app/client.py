"""A typed client of the REST API, for scripts and notebooks.

It is part of the service and not of ``knitcore``, which has no network code. Every operation is a
method by its name, made from :mod:`app.operations.registry`; it takes the fields of the request
(files as paths) and returns the result's model.

Examples
--------
::

    from app.client import Client

    with Client("http://127.0.0.1:8737", token="…") as knit:
        print(knit.predict(chart="KPKP", material="acrylic").modulus_course_n_per_mm)
        law = knit.fit(test_course=Path("course.csv"), test_wale=Path("wale.csv"))
        design = knit.create("Cuff", "acrylic", "KPKP\\nKPKP")
        design = knit.save(design.id, design.document, design.revision)
        job = knit.submit("stretch", chart=design.document.chart, material="acrylic",
                          direction="wale", strain=0.3)
        for status in knit.follow(job.id):
            print(status.state, status.progress)
        curve = knit.result(job.id)
"""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TypeVar

import httpx2 as httpx
from pydantic import BaseModel

from app.designs.document import (
    Design,
    DesignDocument,
    DesignPage,
    DesignPatch,
    DesignSummary,
    NewShare,
    Painted,
    Run,
    SharedDesign,
    ShareMode,
    Shares,
    Strokes,
    Version,
    Versions,
    VersionSummary,
)
from app.http.problems import Problem
from app.jobs.document import JobPage, JobStatus
from app.models.uploads import UploadedFile
from app.operations.registry import Operation, operations

ATTEMPTS = 4
LONGEST_WAIT_S = 60.0
"""Longest wait that is accepted before a request is repeated."""

Model = TypeVar("Model", bound=BaseModel)
Request = TypeVar("Request", bound=BaseModel)
Result = TypeVar("Result", bound=BaseModel)


class ProblemError(Exception):
    """The service refused or failed.

    Attributes
    ----------
    problem : the service's answer.
    """

    def __init__(self, problem: Problem) -> None:
        super().__init__(f"{problem.title}: {problem.detail} {problem.remedy or ''}".strip())
        self.problem = problem


class Client:
    """The service at an address.

    A request whose answer is lost is sent again, as is one that the service asks to repeat later
    (``Retry-After``); requests that create something carry a key, so that it is created once.

    Parameters
    ----------
    address : where it is, such as ``http://127.0.0.1:8737``.
    token : of the user, where the service asks for one.
    timeout_s : longest wait for an answer.
    transport : replaces the network, for tests.
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

    # operations

    def __getattr__(self, name: str) -> Callable[..., Any]:
        """The operation of that name, as a function of its request's fields."""
        operation = operations().get(name.removesuffix("_"))
        if operation is None or operation.path is None:
            raise AttributeError(f"there is no operation {name}")
        return lambda **fields: self.ask(operation, _request(operation, fields))

    def ask(self, operation: Operation[Request, Result], request: Request) -> Result:
        """The answer of an operation to a request."""
        fields = _sent(request)
        if operation.method == "GET":
            return self._get(operation.result, operation.address.format(**fields))
        return self._post(operation.result, operation.address, fields)

    # designs

    def designs(self, *, deleted: bool = False) -> Iterator[DesignSummary]:
        """All designs, the latest changes first; or those that can be recovered."""
        for page in self._pages(DesignPage, "/designs", deleted=deleted):
            yield from page.designs

    def create(self, name: str, material: str, chart: str, note: str = "") -> Design:
        """Keep a new design."""
        document = DesignDocument(name=name, material=material, chart=chart, note=note)
        return self._make(Design, "/designs", document)

    def design(self, design: str) -> Design:
        """A design."""
        return self._get(Design, f"/designs/{design}")

    def save(self, design: str, document: DesignDocument, revision: int) -> Design:
        """Replace a design that was at ``revision``; a ProblemError of type ``stale`` otherwise."""
        return self._change(Design, "PUT", f"/designs/{design}", revision, _sent(document))

    def patch(self, design: str, revision: int, **fields: str) -> Design:
        """Change its name, material or note."""
        body = _sent(DesignPatch.model_validate(fields))
        return self._change(Design, "PATCH", f"/designs/{design}", revision, body)

    def paint(self, design: str, rows: int, columns: int, runs: list[Run]) -> Painted:
        """Merge strokes into a design."""
        strokes = Strokes(rows=rows, columns=columns, runs=runs)
        return self._post(Painted, f"/designs/{design}/strokes", _sent(strokes))

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
        return self._get(Versions, f"/designs/{design}/versions").versions

    def version(self, design: str, number: int) -> Version:
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

    def share(self, design: str, mode: ShareMode = ShareMode.READ) -> NewShare:
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

    def submit(self, kind: str, **fields: Any) -> JobStatus:
        """Run an operation in the background."""
        request = _request(operations()[kind], fields)
        return self._make(JobStatus, "/jobs", {"kind": kind, "request": _sent(request)})

    def jobs(self) -> Iterator[JobStatus]:
        """All jobs, latest first."""
        for page in self._pages(JobPage, "/jobs"):
            yield from page.jobs

    def job(self, job: str) -> JobStatus:
        """Where a job stands."""
        return self._get(JobStatus, f"/jobs/{job}")

    def follow(self, job: str) -> Iterator[JobStatus]:
        """A job's states and progress until it ends."""
        with self._http.stream("GET", f"/jobs/{job}/events", timeout=None) as stream:
            if stream.is_error:
                stream.read()
                raise _problem(stream)
            for line in stream.iter_lines():
                if line.startswith("data: "):
                    yield JobStatus.model_validate_json(line.removeprefix("data: "))

    def result(self, job: str) -> Any:
        """The result of a job, as the model of its operation."""
        operation = operations()[self.job(job).kind]
        return self._get(operation.result, f"/jobs/{job}/result")

    def cancel(self, job: str) -> JobStatus:
        """Stop a job."""
        return JobStatus.model_validate_json(self._send("DELETE", f"/jobs/{job}").content)

    def again(self, job: str) -> JobStatus:
        """Run a job again."""
        return self._post(JobStatus, f"/jobs/{job}/again")

    # on the wire

    def _get(self, model: type[Model], path: str, **query: Any) -> Model:
        return model.model_validate_json(self._send("GET", path, params=query).content)

    def _pages(self, model: type[Model], path: str, **query: Any) -> Iterator[Model]:
        while True:
            page = self._get(model, path, limit=200, **query)
            yield page
            query["cursor"] = getattr(page, "next_cursor", None)
            if query["cursor"] is None:
                return

    def _post(self, model: type[Model], path: str, body: Any = None, **more: Any) -> Model:
        return model.model_validate_json(self._send("POST", path, json=body, **more).content)

    def _make(self, model: type[Model], path: str, body: Any = None) -> Model:
        sent = _sent(body) if isinstance(body, BaseModel) else body
        return self._post(model, path, sent, headers={"Idempotency-Key": secrets.token_urlsafe(16)})

    def _change(
        self, model: type[Model], method: str, path: str, revision: int, body: Any = None
    ) -> Model:
        headers = {"If-Match": f'"{revision}"'}
        return model.model_validate_json(
            self._send(method, path, json=body, headers=headers).content
        )

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
            wait = float(answer.headers.get("Retry-After", "inf"))
            if attempt == ATTEMPTS or wait > LONGEST_WAIT_S:
                raise _problem(answer)
            time.sleep(wait)
        raise AssertionError("unreachable")


def _request(operation: Operation[Request, Any], fields: dict[str, Any]) -> Request:
    return operation.request.model_validate({name: _file(of) for name, of in fields.items()})


def _file(value: Any) -> Any:
    """Paths as files to send."""
    if isinstance(value, Path):
        return UploadedFile.model_construct(name=value.name, content=value.read_bytes())
    return [_file(one) for one in value] if isinstance(value, list) else value


def _sent(request: BaseModel) -> dict[str, Any]:
    return request.model_dump(mode="json", exclude_unset=True)


def _problem(answer: httpx.Response) -> ProblemError:
    try:
        return ProblemError(Problem.model_validate_json(answer.content))
    except ValueError:
        detail = f"The answer {answer.status_code} does not come from this service."
        problem = Problem(type="http", title="No answer", status=answer.status_code, detail=detail)
        return ProblemError(problem)
