"""``sweep`` on the command line and over REST."""

import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import printed, run
from tests.app.rest import refusal


def test_sweep_on_the_command_line_and_over_rest_agree(client: TestClient) -> None:
    told = run(
        "sweep", "stockinette", "--size", "2x2", "--material", "cotton", "--direction", "course",
        "--max-strain", "0.2", "--points", "5",
    )  # fmt: skip
    assert told["strain"] == pytest.approx([0.0, 0.05, 0.1, 0.15, 0.2])
    assert len(told["stress_n_per_mm"]) == len(told["transverse_strain"]) == 5
    assert told["law"]["modulus_course_n_per_mm"] == pytest.approx(0.298, rel=0.2)
    body = {
        "chart": "K", "material": "cotton", "direction": "course", "max_strain": 0.2, "points": 5,
    }  # fmt: skip
    answer = client.post("/api/v1/sweep", json=body).json()
    assert answer["stress_n_per_mm"] == pytest.approx(told["stress_n_per_mm"], rel=1e-6, abs=1e-6)
    held = client.post("/api/v1/sweep", json=body | {"slide_quenching": True}).json()
    assert held["stress_n_per_mm"][-1] >= answer["stress_n_per_mm"][-1]
    assert any("Slide quenching" in note for note in held["notes"])


ACRYLIC = ("--material", "acrylic")


def test_a_sweep_there_and_back_loses_energy_to_friction(client: TestClient) -> None:
    told = run(
        "sweep", "stockinette", *ACRYLIC, "--direction", "course", "--max-strain", "0.2",
        "--points", "5", "--friction", "0.26", "--there-and-back",
    )  # fmt: skip
    turn, stress = told["turn"], told["stress_n_per_mm"]
    assert turn == 4
    assert told["strain"][: turn + 1] == pytest.approx([0.0, 0.05, 0.1, 0.15, 0.2])
    assert told["strain"][turn + 1 : -1] == pytest.approx([0.15, 0.1, 0.05])
    assert told["strain"][-1] == told["left_strain"] > 0.01
    assert stress[-1] == pytest.approx(0.0, abs=1e-6)
    for there, back in zip(stress[1:turn], stress[-2:turn:-1], strict=True):
        assert 0.0 < back < 0.8 * there
    assert told["lost_per_cycle_n_per_mm"] > 0.0
    assert 0.1 < told["lost_share"] < 0.5
    for name in ("transverse_strain", "energy_n_mm", "bending_share", "contact_share"):
        assert len(told[name]) == len(told["strain"])
    assert told["converged"]
    low, high = told["strain_interval"]
    assert all(a <= b for a, b in zip(low, high, strict=True))
    body = {
        "chart": "K", "material": "acrylic", "direction": "course", "max_strain": 0.2, "points": 5,
    }  # fmt: skip
    answer = client.post("/api/v1/sweep", json=body | {"there_and_back": True}).json()
    assert answer["friction"] == told["friction"]
    assert answer["stress_n_per_mm"] == pytest.approx(stress, rel=1e-6, abs=1e-9)


def test_friction_stiffens_the_pull_and_its_law() -> None:
    asked = ["sweep", "stockinette", *ACRYLIC, "--direction", "course", "--max-strain", "0.2"]
    free = run(*asked, "--points", "5")
    rubbed = run(*asked, "--points", "5", "--friction", "0.26")
    assert len(rubbed["strain"]) == 5
    assert rubbed["stress_n_per_mm"][-1] > 1.1 * free["stress_n_per_mm"][-1]
    assert rubbed["law"]["modulus_course_n_per_mm"] > 1.1 * free["law"]["modulus_course_n_per_mm"]
    for told, friction in ((free, None), (rubbed, 0.26)):
        assert told["friction"] == friction
        assert told["turn"] is told["lost_share"] is told["left_strain"] is None


def test_without_friction_the_way_back_retraces_the_way_there(client: TestClient) -> None:
    body = {
        "chart": "K", "material": "cotton", "direction": "wale", "max_strain": 0.2, "points": 4,
    }  # fmt: skip
    loop = client.post("/api/v1/sweep", json=body | {"there_and_back": True, "friction": 0}).json()
    free = client.post("/api/v1/sweep", json=body).json()
    for name in ("strain", "transverse_strain", "stress_n_per_mm", "energy_n_mm"):
        there, back = loop[name][:4], loop[name][3:]
        assert there == pytest.approx(free[name], rel=1e-5, abs=1e-6)
        assert back[::-1] == pytest.approx(there, rel=1e-5, abs=1e-6)
    assert loop["lost_share"] == pytest.approx(0.0, abs=1e-4)
    assert loop["law"]["alpha_xx"] == pytest.approx(free["law"]["alpha_xx"], rel=1e-2)


def test_a_loop_is_printed_with_what_it_loses() -> None:
    asked = ["sweep", "stockinette", *ACRYLIC, "--direction", "wale", "--max-strain", "0.1"]
    told = printed(*asked, "--points", "3", "--there-and-back")
    assert "lost there and back" in told.stdout
    assert "released until free of force" in told.stderr


def test_yarn_that_may_not_slide_cannot_have_friction(client: TestClient) -> None:
    body = {
        "chart": "K", "material": "acrylic", "direction": "course", "max_strain": 0.2,
        "there_and_back": True, "slide_quenching": True, "flat": True,
    }  # fmt: skip
    answer = refusal(client, "sweep", body)
    fields = [error["field"] for error in answer["errors"]]
    assert fields == ["flat", "slide_quenching"]
