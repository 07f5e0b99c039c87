"""The typed clients against the real service."""

import asyncio
import re
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import httpx2 as httpx
import knitcore_client
import pytest
from knitcore_client import AsyncClient, Client, ProblemError
from knitcore_client.aio import AsyncClient as Awaited
from knitcore_client.models import JobStatus

from app.operations.registry import operations
from app.service.main import create_app
from tests.app.running import Service, python

FOLDER = Path(knitcore_client.__file__).parent
TOKEN = "a-token-of-this-test"


def awaited(script: Coroutine[Any, Any, None]) -> None:
    """Run a script in a thread: Playwright's loop runs on in this one after the browser tests."""
    with ThreadPoolExecutor(1) as pool:
        pool.submit(asyncio.run, script).result()


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    with Service(tmp_path_factory.mktemp("client"), token=TOKEN) as service:
        yield service


@pytest.fixture(scope="module")
def knit(service: Service) -> Iterator[Client]:
    with Client(service.url, token=TOKEN) as client:
        yield client


def test_a_design_from_a_script(knit: Client) -> None:
    made = knit.create("Cuff", "acrylic", "KPKP\nKPKP")
    painted = knit.paint(made.id, 2, 4, [{"row": 0, "column": 0, "stitches": "PP"}])
    assert painted.revision == 2
    saved = knit.design(made.id)
    assert saved.document.chart == "KPKP\nPPKP"
    wide = saved.document.model_copy(update={"name": "Wide"})
    assert knit.save(made.id, wide, saved.revision).name == "Wide"
    with pytest.raises(ProblemError, match="changed in the meantime") as refused:
        knit.save(made.id, wide, saved.revision)
    assert refused.value.problem.type == "/problems/stale"
    assert made.id in [d.id for d in knit.designs()]
    kept = knit.keep(made.id, "first")
    assert [version.number for version in knit.versions(made.id)] == [kept.number]
    link = knit.share(made.id, "copy")
    assert knit.shared(link.token).document.name == "Wide"
    assert knit.copy(link.token).id != made.id
    knit.unshare(made.id, link.id)
    assert knit.shares(made.id).shares == []
    back = knit.restore(made.id, kept.number, knit.design(made.id).revision)
    assert knit.patch(made.id, back.revision, {"name": "Narrow"}).name == "Narrow"
    knit.delete(made.id)
    assert made.id in [d.id for d in knit.designs(deleted=True)]
    assert knit.recover(made.id).name == "Narrow"


def test_every_operation_is_a_method(knit: Client, tmp_path: Path) -> None:
    for name, operation in operations().items():
        assert hasattr(knit, name) or hasattr(knit, f"{name}_") or operation.path is None
    assert knit.predict(chart="KPKP\nKPKP", material="acrylic").columns == 4
    assert knit.material(identifier="acrylic").name
    assert knit.version().api == "v1"
    assert knit.signed_in().user
    file = tmp_path / "chart.txt"
    file.write_text("KP")
    read = knit.import_(file=file)
    assert read == knit.import_(file={"name": "chart.txt", "content": "S1A="})
    with pytest.raises(ProblemError, match="material") as refused:
        knit.predict(chart="KP")  # type: ignore[call-arg]
    assert [fault.field for fault in refused.value.problem.errors] == ["material"]


def test_a_view_from_a_script(knit: Client) -> None:
    shown = knit.show("of-a-script", chart="KP\nPK", material="acrylic", colour="phase")
    assert shown.stitches == 4
    assert shown.url.startswith("/view/of-a-script/#")
    knit.mark("of-a-script", {"row0": 0, "column0": 0, "row1": 1, "column1": 2})
    knit.mark("of-a-script")
    knit.look("of-a-script", "back")
    with pytest.raises(ProblemError, match="No browser"):
        knit.picture("of-a-script", width=64, height=64)
    with pytest.raises(ProblemError, match="not open"):
        next(iter(knit.clicks("no-such-view")))
    view = {"chart": "KP\nPK", "material": "acrylic"}
    assert knit.solid(**view).startswith(b"glTF")  # type: ignore[arg-type]
    assert b"<html" in knit.page(**view)[:2000]  # type: ignore[arg-type]
    assert knit.recording(**view)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("method", "events", "expected"),
    [
        (
            Client.clicks,
            'event: stitch\ndata: {"row": 1, "column": 2}\n\n: still there\n\n',
            [{"row": 1, "column": 2}],
        ),
        (
            Client.watch,
            "event: others\ndata: 1\n\n: still there\n\nevent: changed\ndata: 3\n\n",
            [("others", 1), ("changed", 3)],
        ),
    ],
)
def test_events_come_as_stitches_or_as_kinds_and_numbers(
    method: Callable[[Client, str], Iterator[Any]], events: str, expected: list[Any]
) -> None:
    answers = httpx.MockTransport(lambda _: httpx.Response(200, text=events))
    with Client("http://knit.example", transport=answers) as client:
        assert list(method(client, "a-design")) == expected


def test_sessions_from_a_script(knit: Client) -> None:
    with pytest.raises(ProblemError, match="no session"):
        knit.end_session("no-such-session")
    knit.sign_out()
    assert knit.signed_in().sessions == []  # a token needs none, and goes on


def test_a_material_of_ones_own_from_a_script(knit: Client) -> None:
    document = knit.material_document("cotton").model_copy(update={"identifier": "mine"})
    added = knit.add_material(document)
    assert added.id in [material.id for material in knit.materials().materials]
    assert knit.predict(chart="K", material=added.id).columns == 1
    knit.remove_material(added.id)
    with pytest.raises(ProblemError, match="no material"):
        knit.remove_material(added.id)


def test_every_address_of_the_service_has_its_method() -> None:
    written = "".join(Path(FOLDER / name).read_text() for name in ("aio.py", "operations.py"))
    known = {re.sub(r"{\w+}", "{}", path) for path in re.findall(r'f?"(/[^"]*)"', written)}
    paths = {path.removeprefix("/api/v1") for path in create_app().openapi()["paths"]}
    for_operators = {"/healthz", "/readyz", "/metrics"}
    assert {re.sub(r"{\w+}", "{}", path) for path in paths - for_operators} <= known


def test_a_job_from_a_script(knit: Client) -> None:
    pull: Any = {"chart": "KP", "material": "acrylic", "direction": "wale", "strain": 0.1}
    job = knit.submit("stretch", **pull, steps=2)
    states = [status.state for status in knit.follow(job.id)]
    assert states[-1] == "done"
    result = knit.result(job.id)
    assert result.kind == "stretch"
    assert len(result.strain) == 2
    assert knit.run("stretch", **pull, steps=2) == result
    assert knit.cancel(job.id).state == "done"
    with pytest.raises(ProblemError, match="no job"):
        list(knit.follow("no-such-job"))


def test_the_same_awaited(service: Service) -> None:
    async def script() -> None:
        async with AsyncClient(service.url, token=TOKEN) as knit:
            both = await asyncio.gather(
                *(knit.predict(chart=chart, material="acrylic") for chart in ("KP", "KKPP"))
            )
            assert [answer.columns for answer in both] == [2, 4]
            made = await knit.create("Awaited", "acrylic", "K")
            assert made.id in [design.id async for design in knit.designs()]
            curve = await knit.run(
                "curve", chart="KP", material="acrylic", direction="wale", stress_n_per_mm=[0.1]
            )
            assert len(curve.strain) == 1
            with pytest.raises(ProblemError, match="no design"):
                await knit.design("no-such-design")
            shown = await knit.show("awaited", chart="KP", material="acrylic")
            assert shown.stitches == 2
            with pytest.raises(ProblemError, match="not open"):
                async for _ in knit.clicks("no-such-view"):
                    pass

    awaited(script())


def test_a_job_given_up_is_cancelled() -> None:
    cancelled = []

    class Endless(Awaited):
        async def _submit(self, kind: str, request: object) -> JobStatus:
            return JobStatus.model_construct(id="a-job")

        async def follow(self, job: str) -> AsyncIterator[JobStatus]:
            while True:
                await asyncio.sleep(0)
                yield JobStatus.model_construct(id=job)

        async def cancel(self, job: str) -> JobStatus:
            cancelled.append(job)
            return JobStatus.model_construct(id=job)

    async def script() -> None:
        async with Endless("http://127.0.0.1:9") as knit:
            with pytest.raises(TimeoutError):
                async with asyncio.timeout(0.01):
                    await knit.run("bend", chart="K", material="acrylic")

    awaited(script())
    assert cancelled == ["a-job"]


def test_it_needs_neither_numpy_nor_the_service() -> None:
    script = "import sys, knitcore_client; print(*sys.modules)"
    imported = python("-c", script, env={"PYTHONPATH": str(FOLDER.parent)}).stdout.split()
    loaded = {name.partition(".")[0] for name in imported}
    assert "knitcore_client" in loaded
    assert not loaded & {"numpy", "scipy", "fastapi", "starlette", "app", "knitcore"}


class Unsteady(httpx.HTTPTransport):
    """A network that loses the first answer, and a service that is busy the second time."""

    requests = 0

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        self.requests += 1
        answer = super().handle_request(request)
        if self.requests == 1:
            answer.read()
            raise httpx.ReadError("the answer was lost")
        if self.requests == 2:
            answer.read()
            return httpx.Response(429, headers={"Retry-After": "0"})
        return answer


def test_a_repeated_request_takes_effect_once(service: Service, knit: Client) -> None:
    unsteady = Unsteady()
    with Client(service.url, token=TOKEN, transport=unsteady) as client:
        made = client.create("Once", "acrylic", "K")
    assert unsteady.requests == 3
    assert [d.id for d in knit.designs() if d.name == "Once"] == [made.id]
