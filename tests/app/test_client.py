"""The typed client against the real service."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import httpx2 as httpx
import pytest
from pydantic import ValidationError

from app.client import Client, ProblemError
from app.designs.document import Run, ShareMode
from app.jobs.document import JobState
from app.models.uploads import UploadedFile
from app.operations.import_ import OPERATION as IMPORT
from app.operations.import_ import ImportRequest
from tests.app.service import Service

TOKEN = "a-token-of-this-test"


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    found = Service(tmp_path_factory.mktemp("client"), token=TOKEN)
    found.start().close()
    yield found
    found.kill()


@pytest.fixture(scope="module")
def knit(service: Service) -> Iterator[Client]:
    with Client(service.url, token=TOKEN) as client:
        yield client


def test_a_design_from_a_script(knit: Client) -> None:
    made = knit.create("Cuff", "acrylic", "KPKP\nKPKP")
    painted = knit.paint(made.id, 2, 4, [Run(row=0, column=0, stitches="PP")])
    assert painted.revision == 2
    found = knit.design(made.id)
    assert found.document.chart == "KPKP\nPPKP"
    wide = found.document.model_copy(update={"name": "Wide"})
    assert knit.save(made.id, wide, found.revision).name == "Wide"
    with pytest.raises(ProblemError, match="changed in the meantime") as refused:
        knit.save(made.id, wide, found.revision)
    assert refused.value.problem.type == "/problems/stale"
    assert made.id in [d.id for d in knit.designs()]
    kept = knit.keep(made.id, "first")
    assert [version.number for version in knit.versions(made.id)] == [kept.number]
    link = knit.share(made.id, ShareMode.COPY)
    assert knit.shared(link.token).document.name == "Wide"
    assert knit.copy(link.token).id != made.id
    knit.unshare(made.id, link.id)
    assert knit.shares(made.id).shares == []
    back = knit.restore(made.id, kept.number, knit.design(made.id).revision)
    assert knit.patch(made.id, back.revision, name="Narrow").name == "Narrow"
    knit.delete(made.id)
    assert made.id in [d.id for d in knit.designs(deleted=True)]
    assert knit.recover(made.id).name == "Narrow"


def test_every_operation_is_a_method(knit: Client, tmp_path: Path) -> None:
    assert knit.predict(chart="KPKP\nKPKP", material="acrylic").columns == 4
    assert knit.material(identifier="acrylic").name
    file = tmp_path / "chart.txt"
    file.write_text("KP")
    read = knit.import_(file=file)
    upload = UploadedFile(name="chart.txt", content=b"S1A=")
    assert read == knit.ask(IMPORT, ImportRequest(file=upload))
    assert read.chart == "KP"
    with pytest.raises(AttributeError):
        knit.knit_it()
    with pytest.raises(ValidationError):
        knit.predict(chart="KP")


def test_a_job_from_a_script(knit: Client) -> None:
    wish = {"chart": "KP\nPK", "material": "acrylic", "direction": "wale", "strain": 0.1}
    job = knit.submit("stretch", **wish, steps=2)
    states = [status.state for status in knit.follow(job.id)]
    assert states[-1] is JobState.DONE
    assert len(knit.result(job.id).strain) == 2
    assert knit.cancel(job.id).state is JobState.DONE
    with pytest.raises(ProblemError, match="no job"):
        list(knit.follow("no-such-job"))


class Unsteady(httpx.HTTPTransport):
    """A network that loses the first answer, and a service that is busy the second time."""

    asked = 0

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        self.asked += 1
        answer = super().handle_request(request)
        if self.asked == 1:
            answer.read()
            raise httpx.ReadError("the answer was lost")
        if self.asked == 2:
            answer.read()
            return httpx.Response(429, headers={"Retry-After": "0"})
        return answer


def test_what_is_sent_again_takes_effect_once(service: Service, knit: Client) -> None:
    unsteady = Unsteady()
    with Client(service.url, token=TOKEN, transport=unsteady) as client:
        made = client.create("Once", "acrylic", "K")
    assert unsteady.asked == 3
    assert [d.id for d in knit.designs() if d.name == "Once"] == [made.id]
