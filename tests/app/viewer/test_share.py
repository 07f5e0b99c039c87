"""What can be given away of a 3D view, and what travels between it and the page."""

import asyncio
import io
import json
import threading
from pathlib import Path

import numpy as np
import pytest
import trimesh
from fastapi.testclient import TestClient

from app.context import Context
from app.drawing.colours import MAKERS_COLOURS, rgb
from app.drawing.design_view import ViewRequest, build_scene
from app.drawing.fabric import RECTANGLE, Box
from app.service.listeners import Listeners
from app.viewer.views import Cell, clicked_stitch
from knitcore.base.errors import InputError
from tests.app.clients import state_of
from tests.app.operations.cloth.test_stretch import ASKED, GARTER
from tests.app.threads import threads_of_no_pool

HERE = Context(Path())
DESIGN = "a-design-to-share"
SMALL = {"chart": "KPKP\nPKPK\nKPKP", "material": "acrylic"}


@pytest.fixture
def stretched(client: TestClient) -> dict[str, object]:
    run = client.post("/api/v1/stretch", json=ASKED).json()
    return {
        "chart": GARTER,
        "material": "acrylic",
        "colour": "strain",
        "stretch": {"id": run["id"], "step": 1},
    }


def test_a_page_needs_nothing_but_itself(client: TestClient) -> None:
    answer = client.post("/api/v1/views/page", json=SMALL)
    assert answer.headers["content-type"].startswith("text/html")
    assert 'filename="fabric.html"' in answer.headers["content-disposition"]
    assert "<html" in answer.text
    assert 'src="http' not in answer.text
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
    client.put(f"/api/v1/views/{DESIGN}", json=SMALL)
    views = state_of(client).views
    view = views.get(f"local/{DESIGN}")
    before, threads, count = view.writer.drawing, len(threads_of_no_pool()), len(views)
    client.post("/api/v1/views/recording", json=stretched | {"animated": True})
    assert view.writer.drawing is before
    assert len(views) == count
    assert len(threads_of_no_pool()) <= threads


def test_a_solid_is_the_yarn_in_metres_with_its_colours(client: TestClient) -> None:
    content = client.post("/api/v1/views/solid", json=SMALL | {"colour": "yarn"}).content
    scene = trimesh.load(io.BytesIO(content), file_type="glb")
    solid = scene.to_geometry()
    expected = build_scene(ViewRequest.model_validate(SMALL), None, HERE)
    across = 0.001 * expected.shapes.lattice.sizes_mm[0, :, 0].sum()
    assert np.ptp(solid.vertices[:, 0]) == pytest.approx(across, rel=0.15)
    colours = np.unique(solid.visual.vertex_colors[:, :3], axis=0)
    np.testing.assert_array_equal(colours, [rgb(MAKERS_COLOURS["white"])])


def test_an_empty_cell_is_not_drawn_clicked_or_exported(client: TestClient) -> None:
    shaped = SMALL | {"outline": "xx..\nxxxx\nxxxx", "rectangles": True}
    answer = client.put(f"/api/v1/views/{DESIGN}", json=shaped).json()
    assert answer["stitches"] == 10
    view = state_of(client).views.get(f"local/{DESIGN}")
    part, ground = view.writer.drawing.part, view.writer.drawing.ground
    assert len(part.rectangles_mm) == 10
    x, y = ground.centres_mm[2, 3] - ground.middle_mm
    assert ground.stitch_at(x, y) is None
    assert ground.stitch_at(*(ground.centres_mm[2, 1] - ground.middle_mm)) == (2, 1)
    whole = client.put(f"/api/v1/views/{DESIGN}", json=SMALL).json()
    assert whole["stitches"] == 12
    sizes = [len(client.post("/api/v1/views/solid", json=body).content) for body in (shaped, SMALL)]
    assert sizes[0] == pytest.approx(sizes[1] * 10 / 12, rel=0.02)
    problem = client.put(f"/api/v1/views/{DESIGN}", json=SMALL | {"outline": "xx"}).json()
    assert problem["field"] == "outline"


def test_a_view_too_large_to_share_is_refused(client: TestClient) -> None:
    large = {"chart": {"fabric": "rib", "columns": 120, "rows": 100}, "material": "acrylic"}
    problem = client.post("/api/v1/views/solid", json=large).json()
    assert problem["field"] == "chart"
    assert "at most 10000" in problem["remedy"]


def test_a_picture_needs_an_open_view(client: TestClient) -> None:
    design = "a-design-unseen"
    address = f"/api/v1/views/{design}/picture"
    assert client.get(address).status_code == 404
    client.put(f"/api/v1/views/{design}", json=SMALL)
    problem = client.get(address)
    assert problem.status_code == 409
    assert "No browser shows" in problem.json()["detail"]
    assert client.get(f"{address}?width=9000").status_code == 422


def test_marks_and_cameras_need_an_open_view(client: TestClient) -> None:
    design = "a-design-to-turn"
    box = {"row0": 0, "column0": 1, "row1": 2, "column1": 9}
    for path, body in (("mark", {"box": box}), ("camera", {"side": "back"})):
        assert client.put(f"/api/v1/views/{design}/{path}", json=body).status_code == 404
    client.put(f"/api/v1/views/{design}", json=SMALL)
    for path, body in (
        ("mark", {"box": box}),
        ("mark", {"box": None}),
        ("camera", {"side": "back"}),
        ("camera", {"side": "edge"}),
    ):
        assert client.put(f"/api/v1/views/{design}/{path}", json=body).status_code == 204


@pytest.mark.parametrize("chart", ["K", "KPPK\nKKPP\nPKPK"])
def test_a_click_finds_its_stitch(chart: str) -> None:
    ground = build_scene(ViewRequest(chart=chart, material="cotton"), None, HERE).ground
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
    client.put(f"/api/v1/views/{DESIGN}", json=SMALL)
    state = state_of(client)
    with client.stream("GET", f"/api/v1/views/{DESIGN}/events") as stream:
        lines = stream.iter_lines()
        assert next(lines).startswith("retry")  # from now on the page listens
        state.views.clicks.tell(f"local/{DESIGN}", (2, 1))
        data = next(line for line in lines if line.startswith("data: "))
    assert json.loads(data.removeprefix("data: ")) == {"row": 2, "column": 1}


def test_outlines_stay_on_the_fabric() -> None:
    ground = build_scene(ViewRequest.model_validate(SMALL), None, HERE).ground
    corners = ground.box_corners_mm(Box(0, 0, 3, 4))
    np.testing.assert_allclose(np.ptp(corners, axis=0), ground.extent_mm, rtol=1e-6)
    np.testing.assert_allclose(ground.box_corners_mm(Box(0, 0, 99, 99)), corners)


def test_a_huge_chart_is_drawn_around_its_focus() -> None:
    chart = {"fabric": "stockinette", "columns": 400, "rows": 300}
    scene = build_scene(
        ViewRequest.model_validate(
            {"chart": chart, "material": "acrylic", "focus": {"row": 299, "column": 0}}
        ),
        None,
        HERE,
    )
    drawing = scene.drawing()
    assert drawing.part.shapes.index.size <= 40_000
    np.testing.assert_array_equal(
        drawing.part.placement.centres_mm[-1, 0], scene.placement.centres_mm[299, 0]
    )
    assert drawing.ground.shape == (300, 400)
    assert drawing.picture is not None


def test_every_way_to_colour_the_stitches() -> None:
    regions = [
        {"id": "a", "name": "A", "colour": "#ff0000", "yarn": "red", "runs": [[0, 0, 2]]},
        {"id": "b", "name": "B", "colour": "#00ff00", "runs": [[0, 1, 2], [1, 0, 1]]},
        {"id": "c", "name": "C", "colour": "#0000ff", "runs": [[2, 0, 4]], "hidden": True},
    ]

    def colours(colour: str, **more: object) -> np.ndarray:
        body = SMALL | {"colour": colour, "regions": regions, **more}
        return build_scene(ViewRequest.model_validate(body), None, HERE).colours

    palette = {"yarn": "#101010", "seed": "#123456"}
    plain = [0x10, 0x10, 0x10]
    by_yarn, by_region = (colours(c, palette=palette) for c in ("yarn", "region"))
    assert by_yarn[0].tolist() == [[255, 0, 0], [255, 0, 0], plain, plain]
    assert by_region[0].tolist() == [[255, 0, 0], [0, 255, 0], [0, 255, 0], plain]
    assert by_region[2].tolist() == [plain] * 4
    assert colours("phase", palette=palette)[1, 1].tolist() == [0x12, 0x34, 0x56]
    field = {"values": list(range(12)), "low": 0, "high": 11}
    assert colours("field", field=field)[0, 0].tolist() == [0x01, 0x19, 0x59]


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"colour": "field"}, "field"),
        ({"colour": "field", "field": {"values": [1.0], "low": 0, "high": 1}}, "field"),
        ({"colour": "strain"}, "colour"),
        (
            {
                "colour": "region",
                "regions": [{"id": "a", "name": "A", "colour": "#ff0000", "runs": [[7, 0, 1]]}],
            },
            "regions",
        ),
    ],
)
def test_impossible_colours_are_refused(
    client: TestClient, change: dict[str, object], field: str
) -> None:
    problem = client.put(f"/api/v1/views/{DESIGN}", json=SMALL | change).json()
    assert problem["field"] == field
    assert problem["remedy"]


@pytest.mark.parametrize(("groups", "count"), [("stitch", 12), ("block", 2), ("region", 1)])
def test_rectangles_stand_for_stitches_blocks_or_regions(groups: str, count: int) -> None:
    body = SMALL | {
        "rectangles": True,
        "rectangle_groups": groups,
        "rectangle_block": 3,
        "regions": [{"id": "a", "name": "A", "colour": "#ff0000", "runs": [[0, 0, 2]]}],
    }
    scene = build_scene(ViewRequest.model_validate(body), None, HERE)
    rectangles = scene.rectangles_mm
    assert rectangles is not None
    assert rectangles.shape == (count, 4, 2)
    assert scene.drawing().weight == 12 + RECTANGLE * count


def test_so_many_rectangles_are_drawn() -> None:
    chart = {"fabric": "stockinette", "columns": 1000, "rows": 1000}
    body = {"chart": chart, "material": "acrylic", "rectangles": True}
    with pytest.raises(InputError, match="Use blocks of 5 or more") as refused:
        build_scene(ViewRequest.model_validate(body), None, HERE)
    assert refused.value.field == "rectangle_block"
