"""``relax-stitches`` on the command line and over REST."""

import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import refused, run
from tests.app.rest import post, refusal

MESH = "O/;KK"


@pytest.mark.slow
def test_a_mesh_is_the_same_on_the_command_line_and_over_rest(client: TestClient) -> None:
    shape = run("relax-stitches", MESH, "--material", "acrylic")
    assert shape["converged"]
    assert shape["pattern"] == MESH
    assert shape["thickness_mm"] > 2.5
    assert not shape["folded"]
    assert shape["eyelet_mm2"] > 0 < shape["hole_share"] < 0.5
    assert "history" in shape["notes"][0]
    body = {"chart": MESH, "material": "acrylic", "centre_lines": True}
    answer = post(client, "relax-stitches", body)
    assert answer["cell_course_mm"] == pytest.approx(shape["cell_course_mm"], rel=1e-6)
    assert len(answer["centre_lines_mm"]) == 2
    assert run("relax-stitches", MESH, "--material", "acrylic") == shape | {"known": True}


@pytest.mark.slow
def test_the_yarn_of_a_stitch_may_be_given() -> None:
    long = run("relax-stitches", "BB", "--material", "acrylic", "--loop-length-mm", "12")
    short = run("relax-stitches", "BB", "--material", "acrylic", "--loop-length-mm", "11")
    assert long["cell_course_mm"] > short["cell_course_mm"]


def test_a_repeat_that_is_too_large_or_does_not_balance_is_refused(client: TestClient) -> None:
    body = {"chart": ";".join(["O/" + 6 * "K"] * 8), "material": "acrylic"}
    assert "64 stitches" in refusal(client, "relax-stitches", body)["detail"]
    assert "row 2" in refused("relax-stitches", "OKK;KKK", "--material", "acrylic")
