"""``relax``, ``sweep`` and ``bend`` of any stitches, on the command line and over REST."""

import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import printed, refused, run
from tests.app.rest import post, refusal

MESH = "O/;KK"
ACRYLIC = ("--material", "acrylic")
WALE = ("--direction", "wale", "--max-strain", "0.1", "--points", "3")


def test_a_mesh_is_the_same_on_the_command_line_and_over_rest(client: TestClient) -> None:
    shape = run("relax", MESH, *ACRYLIC)
    assert shape["converged"]
    assert shape["pattern"] == MESH
    assert (shape["history"], shape["friction"]) == ("blocked", 0.26)
    assert shape["thickness_mm"] > 2.5
    assert not shape["folded"]
    assert shape["eyelet_mm2"] > 0 < shape["hole_share"] < 0.5
    assert shape["cell_course_interval_mm"] is None
    assert "history" in shape["notes"][0]
    body = {"chart": MESH, "material": "acrylic", "centre_lines": True}
    answer = post(client, "relax", body)
    assert answer["cell_course_mm"] == pytest.approx(shape["cell_course_mm"], rel=1e-6)
    assert len(answer["centre_lines_mm"]) == 2
    assert run("relax", MESH, *ACRYLIC) == shape | {"known": True}
    assert "an eyelet" in printed("relax", MESH, *ACRYLIC).output


def test_cloth_that_folds_has_no_size_no_stress_and_no_rigidity(client: TestClient) -> None:
    shape = run("relax", "BP", *ACRYLIC, "--history", "agitated")
    assert shape["folded"]
    assert shape["cell_course_mm"] is shape["cell_wale_mm"] is shape["hole_share"] is None
    assert "folds" in refused("sweep", "BP", *ACRYLIC, *WALE, "--history", "agitated")
    assert "folds" in refusal(client, "bend", {"chart": "BP", "material": "acrylic"})["detail"]


def test_a_twisted_stitch_is_stretched_and_bent(client: TestClient) -> None:
    rubbed, free = (
        run("sweep", "B", *ACRYLIC, *WALE, "--history", history)
        for history in ("blocked", "agitated")
    )
    assert rubbed["strain"] == pytest.approx([0.0, 0.05, 0.1])
    assert rubbed["stress_n_per_mm"][-1] > 1.1 * free["stress_n_per_mm"][-1] > 0.0
    assert (rubbed["friction"], free["friction"]) == (0.26, None)
    assert rubbed["law"]["modulus_wale_n_per_mm"] > 0.0
    assert "Nobody has measured" in rubbed["interval_source"]
    bent = post(client, "bend", {"chart": "B", "material": "acrylic"})
    assert bent["bending_course_n_mm"] > 0.0 < bent["bending_wale_n_mm"]
    assert "history" in bent["notes"][1]


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("relax", MESH, *ACRYLIC, "--flat"), "knits and purls only"),
        (("relax", MESH, *ACRYLIC, "--history", "stretched-wale"), "Use agitated"),
        (("relax", "KP", *ACRYLIC, "--history", "blocked"), "other stitches"),
        (("sweep", "K", *ACRYLIC, *WALE, "--history", "blocked"), "shaking"),
        (("sweep", MESH, *ACRYLIC, *WALE, "--there-and-back"), "knits and purls only"),
        (("relax", "OKK;KKK", *ACRYLIC), "row 2"),
    ],
)
def test_what_such_a_chart_does_not_have_is_refused(words: tuple[str, ...], says: str) -> None:
    assert says in refused(*words)


@pytest.mark.parametrize("name", ["relax", "bend"])
def test_a_repeat_that_is_too_large_is_refused(client: TestClient, name: str) -> None:
    body = {"chart": ";".join(["O/" + 6 * "K"] * 7 + [8 * "K"]), "material": "acrylic"}
    assert "64 stitches" in refusal(client, name, body)["detail"]


@pytest.mark.slow
def test_the_yarn_of_a_stitch_may_be_given() -> None:
    long, short = (run("relax", "BB", *ACRYLIC, "--loop-length-mm", mm) for mm in ("12", "11"))
    assert long["cell_course_mm"] > short["cell_course_mm"]
