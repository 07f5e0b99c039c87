"""Files of a 3D view to give away, and events between the view and the page."""

import asyncio
import json
import threading

import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.drawing.colours import MAKERS_COLOURS, rgb
from app.service.listeners import Listeners
from app.viewer.views import Cell, clicked_stitch
from tests.app.clients import state_of
from tests.app.drawing.test_design_view import SMALL, scene_of
from tests.app.operations.cloth.test_stretch import GARTER, pulled
from tests.app.rest import draw, solid
from tests.app.running import threads_of_no_pool

DESIGN = "a-design-to-share"


@pytest.fixture
def stretched(client: TestClient) -> dict[str, object]:
    step = {"id": pulled(client)["id"], "step": 1}
    return {"chart": GARTER, "material": "acrylic", "colour": "strain", "stretch": step}


def test_a_page_needs_nothing_but_itself(client: TestClient) -> None:
    answer = client.post("/api/v1/views/page", json=SMALL)
    assert answer.headers["content-type"].startswith("text/html")
    assert 'filename="fabric.html"' in answer.headers["content-disposition"]
    assert "<html" in answer.text
    assert 'src="http' not in answer.text
    assert "<title>Knitted fabric in 3D</title>" in answer.text
    assert "default-src 'none'" in answer.text.split("<script", 1)[0]


def test_an_animation_holds_every_step_once(
    client: TestClient, stretched: dict[str, object]
) -> None:
    still = client.post("/api/v1/views/recording", json=stretched).content
    moving = client.post("/api/v1/views/recording", json=stretched | {"animated": True}).content
    assert len(still) < len(moving) < 20 * len(still)


def test_sharing_leaves_the_watched_view_alone(
    client: TestClient, stretched: dict[str, object]
) -> None:
    draw(client, DESIGN, **SMALL)
    views = state_of(client).views
    view = views.get(f"local/{DESIGN}")
    before, threads, count = view.writer.drawing, len(threads_of_no_pool()), len(views)
    client.post("/api/v1/views/recording", json=stretched | {"animated": True})
    assert view.writer.drawing is before
    assert len(views) == count
    assert len(threads_of_no_pool()) <= threads


def test_a_solid_is_the_yarn_in_metres_with_its_colours(client: TestClient) -> None:
    mesh = solid(client, SMALL | {"colour": "yarn"})
    across = 0.001 * scene_of(SMALL).shapes.lattice.sizes_mm[0, :, 0].sum()
    assert np.ptp(mesh.vertices[:, 0]) == pytest.approx(across, rel=0.15)
    colours = np.unique(mesh.visual.vertex_colors[:, :3], axis=0)
    np.testing.assert_array_equal(colours, [rgb(MAKERS_COLOURS["white"])])


def test_an_empty_cell_is_not_drawn_clicked_or_exported(client: TestClient) -> None:
    shaped = SMALL | {"outline": "xx..\nxxxx\nxxxx", "rectangles": True}
    assert draw(client, DESIGN, **shaped)["stitches"] == 10
    view = state_of(client).views.get(f"local/{DESIGN}")
    part, ground = view.writer.drawing.part, view.writer.drawing.ground
    assert len(part.rectangles_mm) == 10
    x, y = ground.centres_mm[2, 3] - ground.middle_mm
    assert ground.stitch_at(x, y) is None
    assert ground.stitch_at(*(ground.centres_mm[2, 1] - ground.middle_mm)) == (2, 1)
    assert draw(client, DESIGN, **SMALL)["stitches"] == 12
    sizes = [len(client.post("/api/v1/views/solid", json=body).content) for body in (shaped, SMALL)]
    assert sizes[0] == pytest.approx(sizes[1] * 10 / 12, rel=0.02)


def test_a_picture_needs_an_open_view(client: TestClient) -> None:
    design = "a-design-unseen"
    address = f"/api/v1/views/{design}/picture"
    assert client.get(address).status_code == 404
    draw(client, design)
    problem = client.get(address)
    assert problem.status_code == 409
    assert "No browser shows" in problem.json()["detail"]
    assert client.get(f"{address}?width=9000").status_code == 422


def test_marks_and_cameras_need_an_open_view(client: TestClient) -> None:
    design = "a-design-to-turn"
    box = {"row0": 0, "column0": 1, "row1": 2, "column1": 9}
    requests = [("mark", {"box": value}) for value in (box, None)]
    requests += [("camera", {"side": side}) for side in ("back", "edge")]
    for status in (404, 204):
        for path, body in requests:
            answer = client.put(f"/api/v1/views/{design}/{path}", json=body)
            assert answer.status_code == status
        draw(client, design)
    box |= {"column1": 3}
    for part, status in (("x.\n.x", 204), ("x..", 422)):
        body = {"box": box, "part": part}
        assert client.put(f"/api/v1/views/{design}/mark", json=body).status_code == status


@pytest.mark.parametrize("chart", ["K", "KPPK\nKKPP\nPKPK"])
def test_a_click_finds_its_stitch(chart: str) -> None:
    ground = scene_of({"chart": chart, "material": "cotton"}).ground
    for row, column in np.ndindex(*ground.shape):
        x, y = ground.centres_mm[row, column] - ground.middle_mm
        eye = (x + 20.0, y - 10.0, 60.0)
        assert clicked_stitch(ground, eye, (-20.0, 10.0, -60.0)) == (row, column)
        assert clicked_stitch(ground, (x, y, -50.0), (0.0, 0.0, 1.0)) == (row, column)
    assert clicked_stitch(ground, (500.0, 0.0, 50.0), (0.0, 0.0, -1.0)) is None
    assert clicked_stitch(ground, (0.0, 0.0, 50.0), (0.0, 0.0, 1.0)) is None
    assert clicked_stitch(ground, (0.0, 0.0, 50.0), (1.0, 0.0, 0.0)) is None


def test_clicks_reach_only_listeners_of_the_design() -> None:
    clicks = Listeners[Cell]()

    async def listen() -> list[tuple[int, int]]:
        with (
            clicks.listen("mine") as mine,
            clicks.listen("mine") as again,
            clicks.listen("hers") as hers,
        ):
            thread = threading.Thread(target=clicks.tell, args=("mine", (3, 4)))
            thread.start()
            heard = [await asyncio.wait_for(queue.get(), 60) for queue in (mine, again)]
            thread.join()
            assert hers.empty()
        return heard

    assert asyncio.run(listen()) == [(3, 4), (3, 4)]
    assert len(clicks) == 0
    clicks.tell("mine", (1, 1))


def test_a_click_in_the_view_is_an_event_of_the_page(client: TestClient) -> None:
    assert client.get("/api/v1/views/a-design-unknown/events").status_code == 404
    draw(client, DESIGN)
    state = state_of(client)
    with client.stream("GET", f"/api/v1/views/{DESIGN}/events") as stream:
        lines = stream.iter_lines()
        assert next(lines).startswith("retry")  # from now on the page listens
        state.views.clicks.tell(f"local/{DESIGN}", (2, 1))
        data = next(line for line in lines if line.startswith("data: "))
    assert json.loads(data.removeprefix("data: ")) == {"row": 2, "column": 1}
