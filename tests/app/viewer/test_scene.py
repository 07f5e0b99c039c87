"""Messages to browsers about a cloth that changes, and close-ups that stay where they are."""

import contextlib
import threading
from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from app.viewer import cloth
from app.viewer import scene as scene_module
from app.viewer.camera import ASPECT, CameraSide
from app.viewer.cloth import FINEST, UNITS_PER_MM, ShownStitches
from app.viewer.views import View, new_view
from tests.app.drawing.test_design_view import SMALL, scene_of


@pytest.fixture
def view(monkeypatch: pytest.MonkeyPatch) -> Iterator[View]:
    """A view at which somebody looks."""
    view = new_view()
    camera = SimpleNamespace(position=np.zeros(3), aspect=ASPECT)
    client = SimpleNamespace(camera=camera, client_id=0, atomic=contextlib.nullcontext)
    monkeypatch.setattr(view.server, "get_clients", lambda: {0: client})
    yield view
    view.stop()


def _show(view: View, request: dict[str, str]) -> None:
    view.show(scene_of(request).drawing())


def _handles(view: View) -> list[Any]:
    """Nodes of stitches that browsers have."""
    handles = view.server.scene._handle_from_node_name
    return [handle for name, handle in handles.items() if name.startswith("/fabric/")]


def _nodes(view: View) -> dict[str, int]:
    """Copies in every node of stitches that browsers have."""
    handles = view.server.scene._handle_from_node_name
    return {
        name: len(handle.batched_positions)
        for name, handle in handles.items()
        if name.startswith("/fabric/")
    }


def test_a_stroke_moves_stitches_between_the_shapes_that_are_there(view: View) -> None:
    rows = ["K" * 12] * 12
    _show(view, SMALL | {"chart": "\n".join(rows)})
    ((plain, count),) = _nodes(view).items()
    assert count == 144
    rows[6] = "KKKKKPKKKKKK"
    _show(view, SMALL | {"chart": "\n".join(rows)})
    painted = _nodes(view)
    assert 120 < painted[plain] < 144
    assert sum(painted.values()) == 144
    _show(view, SMALL | {"chart": "\n".join(["K" * 12] * 12)})
    assert _nodes(view) == {plain: 144}


def test_stitches_that_are_all_different_are_a_mesh_for_each_colour(
    view: View, monkeypatch: pytest.MonkeyPatch
) -> None:
    lace = SMALL | {"chart": "KKKKKK\nKO/\\OK", "colour": "yarn"}
    _show(view, lace)
    parts = _nodes(view)
    tube = len(_handles(view)[0].vertices)
    with monkeypatch.context() as few:
        few.setattr(cloth, "MOST_SHAPES", len(parts) - 1)
        for _ in range(2):
            _show(view, lace)
            (whole,) = _handles(view)
            assert len(whole.vertices) == 12 * tube
            assert whole.faces.max() == 12 * tube - 1
    drawing = view.writer.drawing
    assert drawing is not None
    assert (np.ptp(whole.vertices, axis=0)[:2] > 0.9 * drawing.ground.extent_mm).all()
    _show(view, lace)
    assert sum(_nodes(view).values()) == 12


def test_another_size_of_the_chart_needs_no_new_shapes(view: View) -> None:
    _show(view, SMALL | {"chart": "\n".join(["K" * 9] * 9)})
    before = _nodes(view)
    _show(view, SMALL | {"chart": "\n".join(["K" * 10] * 10)})
    assert _nodes(view).keys() == before.keys()
    assert sum(_nodes(view).values()) == 100


def test_a_yarn_of_another_thickness_is_drawn_anew(view: View) -> None:
    _show(view, SMALL)
    before = _nodes(view)
    _show(view, SMALL | {"material": "lace-acrylic"})
    assert not before.keys() & _nodes(view).keys()


def test_tubes_are_scaled_at_once_and_drawn_anew_once_they_keep_still(
    view: View, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scene_module, "STILL_S", 0.01)
    anew = threading.Event()
    lay = ShownStitches.lay

    def note(cloth: ShownStitches, *args: Any, exact: bool) -> bool:
        flattened = lay(cloth, *args, exact=exact)
        if exact:
            anew.set()
        return flattened

    monkeypatch.setattr(ShownStitches, "lay", note)
    scene = scene_of(SMALL)
    view.show(scene.drawing())
    before = _nodes(view)
    places = replace(scene.placement, sizes_mm=1.03 * scene.placement.sizes_mm)
    view.show(replace(scene, placement=places).drawing())
    assert not anew.is_set()
    places = replace(scene.placement, sizes_mm=1.2 * scene.placement.sizes_mm)
    with view.writer._lock:  # not yet
        view.show(replace(scene, placement=places).drawing())
        assert _nodes(view) == before
    assert anew.wait(60)
    assert not _nodes(view).keys() & before.keys()


def test_without_a_gpu_the_same_stitches_are_drawn_coarsely(view: View) -> None:
    _show(view, SMALL | {"chart": "\n".join(["KP" * 18, "PK" * 18] * 18)})
    fine, copies = _corners(view), sum(_nodes(view).values())
    view.writer.coarse = True
    view.writer.redraw()
    assert _corners(view) < fine / 2
    assert sum(_nodes(view).values()) == copies
    coarse = _nodes(view)
    view.writer.redraw()
    assert _nodes(view) == coarse
    view.writer.coarse = False
    view.writer.redraw()
    assert _corners(view) == fine


def _corners(view: View) -> int:
    handles = view.server.scene._handle_from_node_name
    return min(len(handles[name].vertices) for name in _nodes(view))


def test_without_a_gpu_less_of_a_large_chart_is_yarn(
    view: View, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scene_module, "COARSE_WINDOW", 6)
    scene = scene_of(SMALL)
    whole = scene.drawing()
    for drawing, stitches in ((whole, 12), (replace(whole, part=scene.window(9)), 6)):
        view.writer.coarse = True
        view.show(drawing)
        assert sum(_nodes(view).values()) == stitches


def test_a_back_is_shown_unless_the_cloth_was_changed_meanwhile(view: View) -> None:
    first, second = (scene_of(SMALL).drawing() for _ in range(2))
    layers = view.server.scene._handle_from_node_name
    picture = np.full((20, 30, 4), 200, np.uint8)
    view.show(first, picture)
    view.show(second, picture)
    assert "/face" in layers
    view.writer.show_back(first, picture)
    assert "/back" not in layers
    view.writer.show_back(second, picture)
    assert "/back" in layers
    view.show(first)
    assert not {"/face", "/back"} & set(layers)


def test_a_moved_camera_keeps_its_place_until_reset(view: View) -> None:
    _show(view, SMALL)
    (client,) = view.server.get_clients().values()
    close = np.array([0.01, 0.02, 0.05])
    client.camera.position = close
    _show(view, SMALL | {"chart": "KPKP\nPKPK\nKPKP\nKPKP"})
    np.testing.assert_array_equal(client.camera.position, close)
    view.writer.look(CameraSide.FACE)
    assert np.linalg.norm(client.camera.position) > 2 * np.linalg.norm(close)


def test_a_cloth_of_another_size_is_framed_again(view: View) -> None:
    (client,) = view.server.get_clients().values()
    rows = ["K" * 12] * 12

    def place_for(*lines: str) -> np.ndarray:
        _show(view, SMALL | {"chart": "\n".join(lines)})
        return np.array(client.camera.position)

    client.camera.position = np.array(view.server.initial_camera.position)
    plain = place_for(*rows)
    assert np.array_equal(plain, place_for("K" * 11 + "P", *rows[1:]))
    assert not np.allclose(plain, place_for(*["KP" * 6] * 12), rtol=0.05)


def test_a_narrow_view_is_seen_from_farther_and_a_turned_camera_stays(view: View) -> None:
    """The cloth stays whole as on the screen of a phone, and back."""
    (client,) = view.server.get_clients().values()
    client.camera.position = np.array(view.server.initial_camera.position)
    _show(view, SMALL | {"chart": "\n".join(["K" * 12] * 6)})
    wide = np.array(client.camera.position)
    for aspect, farther in ((0.46, True), (0.45, True), (2.0, False)):
        client.camera.aspect = aspect
        view.writer.fit(client)
        distance = np.linalg.norm(client.camera.position)
        assert (distance > 1.5 * np.linalg.norm(wide)) == farther
    np.testing.assert_allclose(client.camera.position, wide)
    client.camera.position = close = np.array([0.01, 0.02, 0.05])
    client.camera.aspect = 0.46
    view.writer.fit(client)
    np.testing.assert_array_equal(client.camera.position, close)


def test_a_view_that_opens_narrow_is_placed_once_its_camera_stands(view: View) -> None:
    """A client reports its shape before its camera stands where all do."""
    (client,) = view.server.get_clients().values()
    client.camera.aspect = 0.46
    client.camera.position = np.full(3, 3.0)
    _show(view, SMALL | {"chart": "\n".join(["K" * 12] * 6)})
    client.camera.position = start = np.array(view.server.initial_camera.position)
    view.writer.fit(client)
    assert np.linalg.norm(client.camera.position) > np.linalg.norm(start)


@pytest.mark.parametrize("heard", ["before the next", "after it"])
def test_a_late_report_of_a_camera_is_no_move_of_its_user(view: View, heard: str) -> None:
    """It is of where the camera stood before it was placed, and comes while cloths change."""
    (client,) = view.server.get_clients().values()

    def report(position: np.ndarray) -> None:
        client.camera.position = position
        view.writer.fit(client)

    starts = []
    for columns in (12, 20, 12):
        _show(view, SMALL | {"chart": "\n".join(["K" * columns] * 12)})
        starts.append(np.array(view.server.initial_camera.position))
        if columns == 12 or heard == "before the next":
            report(starts[0])
    small, large, _ = starts
    np.testing.assert_array_equal(client.camera.position, small)
    report(large)
    np.testing.assert_array_equal(client.camera.position, small)
    report(close := np.array([0.01, 0.02, 0.05]))
    np.testing.assert_array_equal(client.camera.position, close)


def test_a_browser_that_loaded_an_earlier_scene_sees_the_whole_cloth(
    view: View, monkeypatch: pytest.MonkeyPatch
) -> None:
    clients = view.server.get_clients()
    monkeypatch.setattr(view.server, "get_clients", dict)
    _show(view, SMALL | {"chart": "\n".join(["K" * 12] * 12)})
    clients[0].camera.position = np.array(view.server.initial_camera.position)
    _show(view, SMALL | {"chart": "\n".join(["K" * 30] * 12)})
    view.writer.fit(clients[0])
    np.testing.assert_array_equal(clients[0].camera.position, view.server.initial_camera.position)


def test_the_light_between_the_yarn_is_sent_with_its_corners(
    view: View, monkeypatch: pytest.MonkeyPatch
) -> None:
    sent: list[np.ndarray] = []
    scene = view.server.scene
    add = scene.add_batched_meshes_simple

    def note(*args: Any, **drawn: Any) -> object:
        sent.append(drawn["vertices"])
        return add(*args, **drawn)

    monkeypatch.setattr(scene, "add_batched_meshes_simple", note)
    _show(view, SMALL)
    beyond = FINEST * np.concatenate(sent) % 1
    assert not beyond[:, :2].any()
    assert 0 < beyond[:, 2].min() < 0.2
    assert 0.8 < beyond[:, 2].max() < 1


def test_the_scale_says_how_long_it_is(view: View) -> None:
    """A round length of about a fifth of the cloth's longer side, in its own words."""
    nodes = view.server.scene._handle_from_node_name
    sizes = ((4, 4, 2.0, "2 mm"), (30, 4, 20.0, "2 cm"), (200, 4, 100.0, "10 cm"))
    for columns, rows, length_mm, words in (*sizes, (4, 60, 20.0, "2 cm")):
        _show(view, SMALL | {"chart": "\n".join(["K" * columns] * rows)})
        (left, _, _), (right, _, _) = nodes["/scale"].points[0]
        assert right - left == pytest.approx(UNITS_PER_MM * length_mm, rel=1e-5)
        assert nodes["/scale/words"].text == words
