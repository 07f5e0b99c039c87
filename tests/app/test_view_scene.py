"""There is always a cloth to look at, and close-ups stay where they are."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from app.context import Context
from app.drawing.design_view import ViewRequest, build_scene
from app.viewer import scene as scene_module
from app.viewer.camera import CameraSide
from app.viewer.cloth import FINEST, Cloth
from app.viewer.views import View, new_view

SMALL = {"chart": "KPKP\nPKPK\nKPKP", "material": "acrylic"}
OTHER = SMALL | {"chart": "KKKK\nPKPK\nKPKP"}


@pytest.fixture
def view(monkeypatch: pytest.MonkeyPatch) -> Iterator[View]:
    """A view at which somebody looks."""
    found = new_view()
    camera = SimpleNamespace(position=np.zeros(3))
    client = SimpleNamespace(camera=camera, atomic=contextlib.nullcontext)
    monkeypatch.setattr(found.server, "get_clients", lambda: {0: client})
    yield found
    found.stop()


def _show(view: View, request: dict[str, str]) -> None:
    view.show(build_scene(ViewRequest.model_validate(request), None, Context(Path())).drawing())


def test_the_old_cloth_stays_until_the_new_one_is_drawn(
    view: View, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scene_module, "BUILD_S", 0.01)
    events: list[tuple[str, Cloth]] = []
    removed = threading.Event()

    def remove(cloth: Cloth) -> None:
        events.append(("gone", cloth))
        removed.set()

    monkeypatch.setattr(Cloth, "show", lambda cloth: events.append(("there", cloth)))
    monkeypatch.setattr(Cloth, "remove", remove)
    _show(view, SMALL)
    _show(view, OTHER)
    assert removed.wait(10)
    (_, first), (what, second), gone = events
    assert what == "there"
    assert second is not first
    assert gone == ("gone", first)


def test_a_moved_camera_keeps_its_place_until_reset(view: View) -> None:
    _show(view, SMALL)
    (client,) = view.server.get_clients().values()
    close = np.array([0.01, 0.02, 0.05])
    client.camera.position = close
    _show(view, SMALL | {"chart": "KPKP\nPKPK\nKPKP\nKPKP"})
    np.testing.assert_array_equal(client.camera.position, close)
    view.writer.look(CameraSide.FACE)
    assert np.linalg.norm(client.camera.position) > 2 * np.linalg.norm(close)


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
