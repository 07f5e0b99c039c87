from fastapi.testclient import TestClient

from knitcore import StitchChart
from knitcore.chart.patterns import PATTERNS


def test_a_text_is_read_and_its_repeat_found(client: TestClient) -> None:
    answer = client.post("/api/v1/charts/parse", json={"text": "kpkpk\n• | • | •"}).json()
    assert (answer["rows"], answer["columns"]) == (2, 5)
    assert answer["text"] == "KPKPK\nPKPKP"
    assert answer["repeat"] == "KP/PK"


def test_patterns_are_repeats_without_a_smaller_one(client: TestClient) -> None:
    shelf = client.get("/api/v1/patterns").json()["patterns"]
    assert [p["id"] for p in shelf] == [p.identifier for p in PATTERNS]
    for pattern in shelf:
        chart = StitchChart.parse(pattern["repeat"])
        assert chart.repeat() == chart


def test_malformed_json_is_reported_as_such(client: TestClient) -> None:
    response = client.post(
        "/api/v1/charts/parse", content=b'{"text": ', headers={"content-type": "application/json"}
    )
    assert response.status_code == 422
    assert "not valid JSON" in response.json()["detail"]


def test_a_missing_page_is_a_problem(client: TestClient) -> None:
    response = client.get("/api/v1/nothing")
    assert response.status_code == 404
    assert response.json()["type"] == "/problems/http"
