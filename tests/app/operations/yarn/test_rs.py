import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import run


@pytest.mark.parametrize("material", ["acrylic", "cotton"])
def test_even_values_are_the_papers(client: TestClient, material: str) -> None:
    """Tables 17 and 18 print three digits: within 0.6 %."""
    values = run("rs", "--material", material)
    assert values == client.get(f"/api/v1/rs/{material}").json()
    even = [
        segment
        for fabric in values["fabrics"].values()
        for segment in fabric["segments"].values()
        if segment["parity"] == "even"
    ]
    assert len(even) == 4
    for segment in even:
        assert segment["modulus_n_per_mm"] == pytest.approx(segment["published_n_per_mm"], rel=6e-3)


def test_other_yarns_have_no_geometry(client: TestClient) -> None:
    assert client.get("/api/v1/rs/glove-wool").json()["field"] == "material"
