"""A small typed client of the REST API, for scripts and notebooks.

It lives beside the service and not in ``knitcore``, which knows no network; it needs only httpx2
and the service's own request and answer types.

Examples
--------
::

    from app.client import Client

    with Client("http://127.0.0.1:8737", token="…") as knit:
        design = knit.create("Cuff", "acrylic", "KPKP\\nKPKP")
        design = knit.save(design.id, design.document, design.revision)
        job = knit.submit("stretch", {"chart": design.document.chart, "material": "acrylic",
                                      "direction": "wale", "strain": 0.3})
        for status in knit.follow(job.id):
            print(status.state, status.progress)
        curve = knit.result(job.id)
"""

from __future__ import annotations

import json
import secrets
from collections.abc import Iterator, Mapping
from types import TracebackType
from typing import Any, Self

import httpx2 as httpx

from app.designs.document import Design, DesignDocument, DesignSummary, Painted, Run, Strokes
from app.http.problems import Problem
from app.jobs.document import JobStatus
from app.operations.predict import PredictRequest, PredictResult

ATTEMPTS = 3


class ProblemError(Exception):
    """The service refused or failed.

    Attributes
    ----------
    problem : what it said.
    """

    def __init__(self, problem: Problem) -> None:
        super().__init__(f"{problem.title}: {problem.detail} {problem.remedy or ''}".strip())
        self.problem = problem


class Client:
    """The service at an address.

    Parameters
    ----------
    address : where it is, such as ``http://127.0.0.1:8737``.
    token : of the user, where the service asks for one.
    timeout_s : longest wait for an answer.
    """

    def __init__(self, address: str, token: str | None = None, timeout_s: float = 60.0) -> None:
        headers = {"Authorization": f"Bearer {token}"} if token else {}
        self._http = httpx.Client(
            base_url=f"{address.rstrip('/')}/api/v1", headers=headers, timeout=timeout_s
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
        """Let go of the connections."""
        self._http.close()

    def designs(self) -> Iterator[DesignSummary]:
        """All designs, the latest changes first."""
        cursor = None
        while True:
            query = {"limit": 200} | ({} if cursor is None else {"cursor": cursor})
            page = self._ask("GET", "/designs", params=query).json()
            yield from (DesignSummary.model_validate(d) for d in page["designs"])
            cursor = page["next_cursor"]
            if cursor is None:
                return

    def create(self, name: str, material: str, chart: str, note: str = "") -> Design:
        """Keep a new design; sent again if the answer does not arrive, and made once."""
        document = DesignDocument(name=name, material=material, chart=chart, note=note)
        headers = {"Idempotency-Key": secrets.token_urlsafe(16)}
        answer = self._ask("POST", "/designs", json=document.model_dump(), headers=headers)
        return Design.model_validate_json(answer.content)

    def design(self, design: str) -> Design:
        """A design."""
        return Design.model_validate_json(self._ask("GET", f"/designs/{design}").content)

    def save(self, design: str, document: DesignDocument, revision: int) -> Design:
        """Replace a design that was at ``revision``; a ProblemError of type ``stale`` otherwise."""
        answer = self._ask(
            "PUT",
            f"/designs/{design}",
            json=document.model_dump(),
            headers={"If-Match": f'"{revision}"'},
        )
        return Design.model_validate_json(answer.content)

    def paint(self, design: str, rows: int, columns: int, runs: list[Run]) -> Painted:
        """Merge strokes into a design."""
        strokes = Strokes(rows=rows, columns=columns, runs=runs)
        answer = self._ask("POST", f"/designs/{design}/strokes", json=strokes.model_dump())
        return Painted.model_validate_json(answer.content)

    def predict(self, chart: str, material: str) -> PredictResult:
        """Moduli and extensibility of a chart."""
        request = PredictRequest(chart=chart, material=material)
        answer = self._ask("POST", "/predict", json=request.model_dump())
        return PredictResult.model_validate_json(answer.content)

    def submit(self, kind: str, request: Mapping[str, Any]) -> JobStatus:
        """Run something in the background."""
        answer = self._ask(
            "POST",
            "/jobs",
            json={"kind": kind, "request": dict(request)},
            headers={"Idempotency-Key": secrets.token_urlsafe(16)},
        )
        return JobStatus.model_validate_json(answer.content)

    def follow(self, job: str) -> Iterator[JobStatus]:
        """A job's states and progress until it ends."""
        with self._http.stream("GET", f"/jobs/{job}/events", timeout=None) as stream:
            if stream.is_error:
                stream.read()
                raise _problem(stream)
            for line in stream.iter_lines():
                if line.startswith("data: "):
                    yield JobStatus.model_validate_json(line.removeprefix("data: "))

    def result(self, job: str) -> dict[str, Any]:
        """What a job gave."""
        found: dict[str, Any] = self._ask("GET", f"/jobs/{job}/result").json()
        return found

    def cancel(self, job: str) -> JobStatus:
        """Stop a job."""
        return JobStatus.model_validate_json(self._ask("DELETE", f"/jobs/{job}").content)

    def _ask(self, method: str, path: str, **options: Any) -> httpx.Response:
        for attempt in range(1, ATTEMPTS + 1):
            try:
                answer = self._http.request(method, path, **options)
            except httpx.TransportError:
                if attempt == ATTEMPTS:  # until then again: it takes effect once, or is refused
                    raise
                continue
            if answer.is_error:
                raise _problem(answer)
            return answer
        raise AssertionError("unreachable")


def _problem(answer: httpx.Response) -> ProblemError:
    try:
        return ProblemError(Problem.model_validate(answer.json()))
    except (json.JSONDecodeError, ValueError):
        told = f"The answer {answer.status_code} does not come from this service."
        problem = Problem(type="http", title="No answer", status=answer.status_code, detail=told)
        return ProblemError(problem)
