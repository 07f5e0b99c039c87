"""What is quick for a small chart is work for a limited process with a large one."""

from __future__ import annotations

from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.api.operations import MOST_LIGHT
from app.models.charts import size_of
from app.operations.predict import PredictRequest

SMALL = {"fabric": "garter", "columns": 10, "rows": MOST_LIGHT // 10 - 10}
LARGE = {"fabric": "garter", "columns": 101, "rows": MOST_LIGHT // 100}
TEXT = "\n".join(["KP" * 60] * 90)


@pytest.mark.parametrize(("chart", "computed"), [(SMALL, 0), (LARGE, 1), (TEXT, 1)])
def test_a_large_chart_is_predicted_in_a_worker(
    client: TestClient, monkeypatch: pytest.MonkeyPatch, chart: Any, computed: int
) -> None:
    compute = client.app.state.compute  # type: ignore[attr-defined]
    asked, run = [], compute.run

    async def counted(*args: Any, **turn: Any) -> Any:
        asked.append(args)
        return await run(*args, **turn)

    monkeypatch.setattr(compute, "run", counted)
    answer = client.post("/api/v1/predict", json={"chart": chart, "material": "acrylic"})
    assert answer.status_code == 200
    assert answer.json()["modulus_course_n_per_mm"] > 0
    assert len(asked) == computed


def test_the_size_of_a_request_counts_texts_and_named_fabrics() -> None:
    request = PredictRequest(chart="KP", material="acrylic", outline="xx")
    assert size_of(request) == len("KP" + "acrylic" + "xx")
    assert size_of(PredictRequest(chart=LARGE, material="")) == 101 * (MOST_LIGHT // 100)
