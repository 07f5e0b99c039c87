"""A request that is quick for a small chart is work for a limited process with a large one."""

from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.operations.chart.predict import PredictRequest
from app.requests.charts import size_of
from app.service.api.operations import MAX_LIGHT
from app.viewer.share import shared_solid
from app.viewer.sheet import build_back, build_drawing
from tests.app.clients import state_of
from tests.app.rest import draw, post, solid

SMALL = {"fabric": "garter", "columns": 10, "rows": MAX_LIGHT // 10 - 10}
LARGE = {"fabric": "garter", "columns": 101, "rows": MAX_LIGHT // 100}
TEXT = "\n".join(["KP" * 60] * 90)


@pytest.mark.parametrize(("chart", "count"), [(SMALL, 0), (LARGE, 1), (TEXT, 1)])
def test_a_large_chart_is_predicted_in_a_worker(
    client: TestClient, computed: list[Any], chart: Any, count: int
) -> None:
    answer = post(client, "predict", {"chart": chart, "material": "acrylic"})
    assert answer["modulus_course_n_per_mm"] > 0
    assert len(computed) == count


@pytest.mark.parametrize(("columns", "count"), [(200, 0), (206, 1)])
@pytest.mark.slow
def test_a_large_chart_is_laid_in_a_worker(
    client: TestClient, computed: list[Any], columns: int, count: int
) -> None:
    chart = {"fabric": "garter", "columns": columns, "rows": 200}
    assert draw(client, "large-or-not", chart)["stitches"] == 40_000
    assert sum(job is build_drawing for job, *_ in computed) == count
    view = state_of(client).views.get("local/large-or-not")
    assert view.writer.drawing.ground.shape == (200, columns)


@pytest.mark.slow
def test_what_is_given_away_of_a_view_is_made_in_a_worker(
    client: TestClient, computed: list[Any]
) -> None:
    solid(client, {"chart": "KP", "material": "acrylic"})
    assert [job for job, *_ in computed if job is not build_back] == [shared_solid]


def test_the_size_of_a_request_counts_texts_and_named_fabrics() -> None:
    request = PredictRequest(chart="KP", material="acrylic", outline="xx")
    assert size_of(request) == len("KP" + "acrylic" + "xx")
    assert size_of(PredictRequest(chart=LARGE, material="")) == 101 * (MAX_LIGHT // 100)
