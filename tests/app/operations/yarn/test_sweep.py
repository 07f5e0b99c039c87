"""``sweep`` on the command line and over REST."""

import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import run
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
