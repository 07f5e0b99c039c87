"""The typed client against the real service."""

from __future__ import annotations

from collections.abc import Iterator

import httpx2 as httpx
import pytest

from app.client import Client, ProblemError
from app.designs.document import Run
from app.jobs.document import JobState
from tests.app.service import Service


@pytest.fixture(scope="module")
def knit(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    service = Service(tmp_path_factory.mktemp("client"), token="a-token-of-this-test")
    service.start().close()
    with Client(service.url, token="a-token-of-this-test") as client:
        yield client
    service.kill()


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
    assert refused.value.problem.type == "stale"
    assert made.id in [d.id for d in knit.designs()]
    assert knit.predict("KPKP\nKPKP", "acrylic").columns == 4


def test_a_job_from_a_script(knit: Client) -> None:
    wish = {"chart": "KP\nPK", "material": "acrylic", "direction": "wale", "strain": 0.1}
    job = knit.submit("stretch", wish | {"steps": 2})
    states = [status.state for status in knit.follow(job.id)]
    assert states[-1] is JobState.DONE
    assert len(knit.result(job.id)["strain"]) == 2
    assert knit.cancel(job.id).state is JobState.DONE
    with pytest.raises(ProblemError, match="no job"):
        list(knit.follow("no-such-job"))


def test_a_lost_answer_makes_no_second_design(
    knit: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    real, lost = knit._http.request, []

    def flaky(*args: object, **options: object) -> httpx.Response:
        answer = real(*args, **options)  # type: ignore[arg-type]
        if not lost:
            lost.append(answer)
            raise httpx.ReadError("the answer was lost")
        return answer

    monkeypatch.setattr(knit._http, "request", flaky)
    made = knit.create("Once", "acrylic", "K")
    assert [d.id for d in knit.designs() if d.name == "Once"] == [made.id]
