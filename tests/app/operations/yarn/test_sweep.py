"""``sweep`` on the command line and over REST."""

import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import printed, run
from tests.app.rest import post

ACRYLIC = ("--material", "acrylic")
COURSE = ("--direction", "course", "--max-strain", "0.2", "--points", "5")
PULL = {"chart": "K", "direction": "course", "max_strain": 0.2, "points": 5}


def test_sweep_on_the_command_line_and_over_rest_agree(client: TestClient) -> None:
    swept = run("sweep", "stockinette", "--material", "cotton", *COURSE)
    assert swept["strain"] == pytest.approx([0.0, 0.05, 0.1, 0.15, 0.2])
    assert len(swept["stress_n_per_mm"]) == len(swept["transverse_strain"]) == 5
    assert swept["law"]["modulus_course_n_per_mm"] == pytest.approx(0.298, rel=0.2)
    answer = post(client, "sweep", PULL | {"material": "cotton"})
    assert answer["stress_n_per_mm"] == pytest.approx(swept["stress_n_per_mm"], rel=1e-6, abs=1e-6)
    held = post(client, "sweep", PULL | {"material": "cotton", "slide_quenching": True})
    assert held["stress_n_per_mm"][-1] >= answer["stress_n_per_mm"][-1]
    assert any("Slide quenching" in note for note in held["notes"])


@pytest.mark.slow
def test_a_sweep_there_and_back_loses_energy_to_friction(client: TestClient) -> None:
    rubbed = "--friction", "0.26", "--there-and-back"
    swept = run("sweep", "stockinette", *ACRYLIC, *COURSE, *rubbed)
    turn, stress = swept["turn"], swept["stress_n_per_mm"]
    assert turn == 4
    assert swept["strain"][: turn + 1] == pytest.approx([0.0, 0.05, 0.1, 0.15, 0.2])
    assert swept["strain"][turn + 1 : -1] == pytest.approx([0.15, 0.1, 0.05])
    assert swept["strain"][-1] == swept["left_strain"] > 0.01
    assert stress[-1] == pytest.approx(0.0, abs=1e-6)
    for there, back in zip(stress[1:turn], stress[-2:turn:-1], strict=True):
        assert 0.0 < back < 0.8 * there
    assert swept["lost_per_cycle_n_per_mm"] > 0.0
    assert 0.1 < swept["lost_share"] < 0.5
    for name in ("transverse_strain", "energy_n_mm", "bending_share", "contact_share"):
        assert len(swept[name]) == len(swept["strain"])
    assert swept["converged"]
    low, high = swept["strain_interval"]
    assert all(a <= b for a, b in zip(low, high, strict=True))
    answer = post(client, "sweep", PULL | {"material": "acrylic", "there_and_back": True})
    assert answer["friction"] == swept["friction"]
    assert answer["stress_n_per_mm"] == pytest.approx(stress, rel=1e-6, abs=1e-9)


@pytest.mark.slow
def test_friction_stiffens_the_pull_and_its_law() -> None:
    free, rubbed = (
        run("sweep", "stockinette", *ACRYLIC, *COURSE, *friction)
        for friction in ((), ("--friction", "0.26"))
    )
    assert len(rubbed["strain"]) == 5
    assert rubbed["stress_n_per_mm"][-1] > 1.1 * free["stress_n_per_mm"][-1]
    assert rubbed["law"]["modulus_course_n_per_mm"] > 1.1 * free["law"]["modulus_course_n_per_mm"]
    for swept, friction in ((free, None), (rubbed, 0.26)):
        assert swept["friction"] == friction
        assert swept["turn"] is swept["lost_share"] is swept["left_strain"] is None


@pytest.mark.slow
def test_without_friction_the_way_back_retraces_the_way_there(client: TestClient) -> None:
    body = PULL | {"material": "cotton", "direction": "wale", "points": 4}
    loop = post(client, "sweep", body | {"there_and_back": True, "friction": 0})
    free = post(client, "sweep", body)
    for name in ("strain", "transverse_strain", "stress_n_per_mm", "energy_n_mm"):
        there, back = loop[name][:4], loop[name][3:]
        assert there == pytest.approx(free[name], rel=1e-5, abs=1e-6)
        assert back[::-1] == pytest.approx(there, rel=1e-5, abs=1e-6)
    assert loop["lost_share"] == pytest.approx(0.0, abs=1e-4)
    assert loop["law"]["alpha_xx"] == pytest.approx(free["law"]["alpha_xx"], rel=1e-2)


@pytest.mark.slow
def test_a_loop_is_printed_with_what_it_loses() -> None:
    words = ["sweep", "stockinette", *ACRYLIC, "--direction", "wale", "--max-strain", "0.1"]
    shown = printed(*words, "--points", "3", "--there-and-back")
    assert "lost there and back" in shown.stdout
    assert "released until free of force" in shown.stderr
