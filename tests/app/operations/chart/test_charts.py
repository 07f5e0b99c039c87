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
