import os
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest
import zstandard
from fastapi.testclient import TestClient

from app.service.api import views as views_api
from app.service.limits.user_limits import USER_LIMITS
from tests.app.clients import state_of, watching
from tests.app.operations.cloth.test_stretch import GARTER, pulled
from tests.app.rest import draw

DESIGN = "a-design-of-mine"


def _messages(client: TestClient, design: str, enough: bytes) -> bytes:
    """All that a browser gets when it opens the view, until ``enough`` is among it."""
    seen = b""
    with watching(client, f"/view/{design}") as socket:
        while enough not in seen:
            frame = socket.receive_bytes()
            size = int.from_bytes(frame[8:16], "little")
            seen += zstandard.decompress(frame[16 : 16 + size])
    return seen


def test_a_design_is_drawn_and_reaches_the_browser(client: TestClient) -> None:
    shown = draw(client, DESIGN, GARTER, colour="course", rectangles=True)
    assert shown.pop("url").startswith(f"/view/{DESIGN}/#")
    assert shown == {
        "stitches": 54,
        "source": "relaxed curves of the four fabrics in acrylic",
        "scale_mm": 5.0,
    }
    seen = _messages(client, DESIGN, b"SetCameraPositionMessage")
    assert b"/fabric/" in seen
    assert b"/rectangles" in seen
    assert b"SetCameraLookAtMessage" in seen


def test_two_designs_are_two_scenes(client: TestClient) -> None:
    for design, columns in (("first-design", 3), ("second-design", 5)):
        chart = {"fabric": "rib", "columns": columns, "rows": 2}
        assert draw(client, design, chart)["stitches"] == 2 * columns
    views = state_of(client).views
    assert views.open("local/first-design").port != views.open("local/second-design").port


def test_the_same_design_twice_is_one_scene(client: TestClient) -> None:
    draw(client, "shared-design", "KP\nPK", colour="wale")
    first, second = (_messages(client, "shared-design", b"batched_colors") for _ in range(2))
    assert b"/fabric/1" in first
    assert b"/fabric/1" in second


def test_a_cloth_of_many_stitches_gets_pictures_of_its_face_and_then_its_back(
    client: TestClient,
) -> None:
    draw(client, "large-design", {"fabric": "seed", "columns": 40, "rows": 30}, colour="yarn")
    assert b"/face" in _messages(client, "large-design", b"/back")


def test_a_closed_view_is_drawn_again_by_the_next_request(client: TestClient) -> None:
    for _ in range(2):
        assert draw(client, "design-that-slept", "KP\nPK")["stitches"] == 4
        assert b"/fabric/" in _messages(client, "design-that-slept", b"/fabric/")
        state_of(client).views.close()


def test_a_stretched_state_can_be_shown(client: TestClient) -> None:
    test = pulled(client)["id"]
    body = {"chart": GARTER, "material": "acrylic", "colour": "strain"}
    for identifier, step, field in (
        (test, 3, None),
        (test, 9, "stretch.step"),
        ("gone", 0, "stretch.id"),
    ):
        stretch = {"stretch": {"id": identifier, "step": step}}
        answer = client.put(f"/api/v1/views/{DESIGN}", json=body | stretch)
        assert (answer.status_code, answer.json().get("field")) == (422 if field else 200, field)
        assert field is None or answer.json()["remedy"]


def test_the_view_page_comes_from_here(client: TestClient) -> None:
    page = client.get(f"/view/{DESIGN}")
    assert page.url.path == f"/view/{DESIGN}/"
    assert "<html" in page.text
    assert client.get("/view/..%2f..%2fetc/").status_code == 404
    assert client.get("/view/a b/").status_code == 404


def test_a_browser_says_that_it_has_no_gpu(client: TestClient) -> None:
    draw(client, "a-coarse-view")
    view = state_of(client).views.get("local/a-coarse-view")
    for query, coarse in (("", False), ("?coarse=1", True)):
        with watching(client, f"/view/a-coarse-view{query}"):
            assert view.writer.coarse is coarse


@pytest.mark.parametrize("colour", ["fabric", "course", "wale", "anisotropy"])
def test_every_colour_field_works(client: TestClient, colour: str) -> None:
    assert draw(client, DESIGN, "KKP\nPPK", "glove-wool", colour=colour)["stitches"] == 6


def test_pictures_that_no_browser_sends_do_not_delay_others(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    draw(client, "hidden-tab")
    waiting, over = threading.Semaphore(0), threading.Event()

    def never(*_: object) -> bytes:
        waiting.release()
        over.wait()
        return b""

    monkeypatch.setattr(views_api, "picture_png", never)
    count = min(32, (os.cpu_count() or 1) + 4)  # as many threads as asyncio has for all
    with ThreadPoolExecutor(count) as browsers:
        try:
            for _ in range(count):
                browsers.submit(client.get, "/api/v1/views/hidden-tab/picture")
            for _ in range(USER_LIMITS.pictures):  # the others are refused
                assert waiting.acquire(timeout=60)
            jobs = ThreadPoolExecutor(1).submit(client.get, "/api/v1/jobs")
            assert jobs.result(60).status_code == 200
        finally:
            over.set()
