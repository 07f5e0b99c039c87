"""Places in knitting a design, over REST."""

import pytest
from fastapi.testclient import TestClient

from app.service.designs.places import MAX_WAYS

DESIGNS = "/api/v1/designs"


@pytest.fixture
def design(client: TestClient) -> str:
    body = {"name": "Cuff", "material": "acrylic", "chart": "KPKP\nKPKP"}
    return f"{DESIGNS}/{client.post(DESIGNS, json=body).json()['id']}"


def rows(client: TestClient, design: str) -> list[tuple[str, int, int]]:
    places = client.get(f"{design}/places").json()["places"]
    return [(place["way"], place["row"], place["count"]) for place in places]


def test_another_device_goes_on_where_this_one_is(client: TestClient, design: str) -> None:
    assert rows(client, design) == []
    kept = client.put(f"{design}/places/flat", json={"row": 12, "count": 3}).json()
    assert (kept["way"], kept["row"], kept["count"]) == ("flat", 12, 3)
    client.put(f"{design}/places/brother", json={"row": 2})
    assert set(rows(client, design)) == {("brother", 2, 0), ("flat", 12, 3)}
    client.put(f"{design}/places/flat", json={"row": 13, "count": 3})
    assert rows(client, design)[0] == ("flat", 13, 3)


def test_a_place_is_no_change_of_the_design(client: TestClient, design: str) -> None:
    tag = client.get(design).headers["etag"]
    client.put(f"{design}/places/flat", json={"row": 12})
    assert client.get(design).headers["etag"] == tag
    version = client.post(f"{design}/versions", json={"name": "First"}).json()["number"]
    client.put(f"{design}/places/flat", json={"row": 20})
    restore = f"{design}/versions/{version}/restore"
    assert client.post(restore, headers={"If-Match": tag}).status_code == 200
    assert rows(client, design) == [("flat", 20, 0)]


def test_places_of_many_ways_make_room(client: TestClient, design: str) -> None:
    for number in range(MAX_WAYS + 2):
        client.put(f"{design}/places/machine-{number}", json={"row": number})
    kept = {way for way, _, _ in rows(client, design)}
    assert len(kept) == MAX_WAYS
    assert "machine-0" not in kept


@pytest.mark.parametrize(
    ("way", "place", "status"),
    [("flat", {"row": -1}, 422), ("Flat way", {"row": 1}, 404), ("flat", {}, 422)],
)
def test_places_that_cannot_be(
    client: TestClient, design: str, way: str, place: dict[str, int], status: int
) -> None:
    assert client.put(f"{design}/places/{way}", json=place).status_code == status


def test_nobody_elses_design_has_a_place(client: TestClient) -> None:
    assert client.get(f"{DESIGNS}/unknown/places").status_code == 404
    assert client.put(f"{DESIGNS}/unknown/places/flat", json={"row": 1}).status_code == 404
