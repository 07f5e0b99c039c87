"""The fabric in 3D: linked with the chart, stretched, private, and back after a lost connection."""

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect

from knitcore.draw.instances import COARSE_LEVELS
from tests.browser.conftest import (
    CHART,
    COLOURED_CLOTH,
    COLUMNS,
    ROWS,
    TIMEOUT_MS,
    open_small_chart,
)
from tests.browser.page import (
    coloured,
    complaints,
    drag,
    keep_version,
    pixels,
    sent_view,
    settle,
    stretched,
    wait_for_change,
    wait_for_colour,
    wait_for_picture,
)

YARN = 900
"""Coloured pixels of the small fabric at least."""
CLOTH = ".fabric-frame"
"""Where the cloth is: the caption below it has a red sign while a change is on its way."""


def _wait_for_live_cloth(page: Page) -> np.ndarray:
    """The frame once the live view has taken the place of the picture."""
    expect(page.locator(".fabric[data-live]")).to_be_visible()
    return wait_for_colour(page, CLOTH, YARN)


def _click_fabric(page: Page, x: float, y: float) -> None:
    """A click in the view, at shares of its width and height, once the pointer is felt there.

    For a while after a screenshot Chromium gives what the pointer does there to the page around.
    """
    box = page.locator(CLOTH).bounding_box()
    assert box
    place = box["x"] + x * box["width"], box["y"] + y * box["height"]
    view = next(frame for frame in page.frames if "/view/" in frame.url)
    view.evaluate("addEventListener('pointermove', () => (window.felt = true), { once: true })")
    for _ in range(200):
        page.mouse.move(*place)
        if view.evaluate("window.felt"):
            break
        page.wait_for_timeout(50)
    page.mouse.click(*place)


@pytest.mark.slow
def test_a_click_on_the_fabric_finds_its_stitch_and_marks_it(studio: Page) -> None:
    _wait_for_live_cloth(studio)
    before = pixels(studio, "#chart-host")
    readout = studio.locator("#readout")
    with studio.expect_response(lambda r: r.url.endswith("/mark") and r.ok):
        _click_fabric(studio, 0.5, 0.5)
    expect(readout).to_contain_text("Row ")
    row = int(readout.inner_text().split()[1])
    assert 1 < row < ROWS
    wait_for_change(studio, "#chart-host", before, 40)


@pytest.mark.slow
def test_the_live_view_is_framed_as_the_picture_before_it(studio: Page) -> None:
    still = _reach(wait_for_colour(studio, CLOTH, YARN))
    _wait_until_framed(studio, still)


@pytest.mark.slow
def test_a_large_chart_is_framed_flat_and_as_it_lies_at_first_and_after_strokes(
    visitor: Page, service: str
) -> None:
    page = open_small_chart(visitor, service, "\n".join(["KP" * 30, "PK" * 30] * 30))
    still = _reach(wait_for_colour(page, CLOTH, YARN))
    assert min(still[:2]) > 0.3
    view = "views/" + _design(page)
    for pose, caption, below in (
        ("flat", "Relaxed, pinned flat", 0),
        ("lying", "Unpinned (no friction with the table)", 50),
    ):
        before = pixels(page, CLOTH)
        page.click(f"#fabric-{pose}")
        expect(page.locator(".fabric-caption")).to_contain_text(caption)
        if pose == "lying":
            wait_for_picture(page, CLOTH, partial(_recoloured, before), 500)
        _wait_until_framed(page, still)
        before = pixels(page, CLOTH)
        with page.expect_response(lambda r: r.url.endswith(view) and r.request.method == "PUT"):
            drag(page, 180, 0, start=(0, below))  # a few stitches are hardly a pixel
        wait_for_picture(page, CLOTH, partial(_recoloured, before), 5)
        settle(page)
        _wait_until_framed(page, still)


@pytest.mark.slow
def test_a_large_cloth_is_upright_on_both_sides(visitor: Page, service: str) -> None:
    """A blue corner of stockinette at the upper left of the face."""
    seed = ["KP" * 20, "PK" * 20] * 20
    corner = ["K" * 14 + row[14:] for row in seed[:14]]
    page = open_small_chart(visitor, service, "\n".join(corner + seed[14:]))

    def corners(right: bool, picture: np.ndarray) -> float:
        """How far the blue lies above the middle, and to a side of it; the less of both."""
        blue = np.argwhere(_cloth(picture) & (picture[..., 1] > picture[..., 0] + 15))
        if len(blue) < 20:
            return 0.0
        up, left = np.argwhere(_cloth(picture)).mean(axis=0) - blue.mean(axis=0)
        return float(min(up, -left if right else left))

    for side in ("face", "back"):
        page.click(f"#look-{side}")
        _wait_for_live_cloth(page)
        wait_for_picture(page, CLOTH, partial(corners, side == "back"), 10)


def _cloth(picture: np.ndarray) -> np.ndarray:
    """Where there is yarn."""
    return np.ptp(picture, axis=2) > 40


def _recoloured(before: np.ndarray, picture: np.ndarray) -> int:
    """Pixels of the cloth that have another colour than before."""
    changed = np.abs(picture - before).max(axis=2) > 20
    return int((changed & _cloth(before) & _cloth(picture)).sum())


def _wait_until_framed(page: Page, still: list[float]) -> None:
    """The live view reaches as far as a picture did; first frames may come before the camera."""
    _wait_for_live_cloth(page)

    def near(picture: np.ndarray) -> float:
        return -float(np.abs(np.subtract(_reach(picture), still)).max())

    wait_for_picture(page, CLOTH, near, -0.1)


def _reach(picture: np.ndarray) -> list[float]:
    """Height, width and middle of the cloth, in shares of the frame."""
    cloth = _cloth(picture)
    ends = [
        (where.min() / side, where.max() / side)
        for where, side in zip(np.nonzero(cloth), cloth.shape, strict=True)
    ]
    return [*(high - low for low, high in ends), *((low + high) / 2 for low, high in ends)]


WATCH = """() => {
    const canvas = [...document.querySelectorAll("canvas")].find((c) => c.width);
    const shown = canvas.getContext("2d"), size = 64;
    window.shares = [];
    const request = window.requestAnimationFrame;
    window.requestAnimationFrame = (callback) => request((time) => {
        callback(time);
        const [x, y] = [canvas.width - size, canvas.height - size];
        const { data } = shown.getImageData(x >> 1, y >> 1, size, size);
        shares.push(data.filter((value, k) => k % 4 === 3 && value).length / size ** 2);
    });
}"""
"""How much of the middle of each frame is cloth, from now on."""
SEVERAL = """() => new Promise((done) => {
    const look = () => (shares.length < 6 ? setTimeout(look, 20) : done(shares));
    look();
})"""
PUT = """async ([path, body]) => {
    const headers = { "Content-Type": "application/json" };
    return (await fetch(path, { method: "PUT", headers, body })).ok;
}"""


@pytest.mark.slow
def test_a_slow_browser_shows_cloth_in_every_frame(studio: Page) -> None:
    _wait_for_live_cloth(studio)
    frame = next(frame for frame in studio.frames if "/view/" in frame.url)
    frame.evaluate(WATCH)
    session = studio.context.new_cdp_session(frame)
    session.send("Emulation.setCPUThrottlingRate", {"rate": 8})
    for material in ("cotton", "acrylic"):  # nothing of the cloth before can stay
        frame.evaluate("shares.length = 0")
        shown = {"chart": CHART, "material": material}
        assert studio.evaluate(PUT, ["/api/v1/views/" + _design(studio), json.dumps(shown)])
        assert min(frame.evaluate(SEVERAL)) > 0.1


@pytest.mark.slow
def test_a_picture_stands_in_until_the_live_view_is_there(flat_studio: Page) -> None:
    wait_for_colour(flat_studio, CLOTH, YARN)
    expect(flat_studio.locator(".fabric-still")).to_be_visible()
    expect(flat_studio.locator(".fabric-status")).to_be_hidden()
    flat_studio.unroute_all()
    flat_studio.reload()
    expect(flat_studio.locator(".fabric[data-live]")).to_be_visible()
    expect(flat_studio.locator(".fabric-still")).to_be_hidden()
    wait_for_colour(flat_studio, CLOTH, YARN)


@pytest.mark.slow
def test_the_shaders_know_the_yarn_they_draw(studio: Page) -> None:
    """Corners of a tube, turns of its plies from ring to ring, radius in dm."""
    studio.add_init_script(
        """const set = WebGL2RenderingContext.prototype.uniform3fv;
        WebGL2RenderingContext.prototype.uniform3fv = function (place, values) {
            if (values.length === 3) (window.triples ??= []).push([...values]);
            set.call(this, place, values);
        };"""
    )
    studio.reload()
    _wait_for_live_cloth(studio)
    frame = next(frame for frame in studio.frames if "/view/" in frame.url)
    triples = frame.evaluate("triples")
    _, points, sides = COARSE_LEVELS[0]  # the tests' browser has no GPU
    turns, radius = next((turns, radius) for n, turns, radius in triples if n == sides)
    assert 2 <= round(turns * (points - 1), 3) <= 12
    assert 0.2 < 100 * radius < 5


@pytest.mark.slow
def test_the_words_of_the_scale_stand_on_the_page_in_its_colour(studio: Page) -> None:
    def light(picture: np.ndarray) -> int:
        high, wide, _ = picture.shape
        return int((picture[high // 2 :, wide // 2 :].min(axis=2) > 160).sum())

    _wait_for_live_cloth(studio)
    studio.evaluate("document.documentElement.dataset.theme = 'dark'")
    for _ in range(100):
        words = light(pixels(studio, CLOTH))
        if 5 < words < 150:  # the light page has many more, and a box around them 500
            break
        studio.wait_for_timeout(200)
    assert 5 < words < 150


@pytest.mark.slow
def test_what_is_selected_in_the_chart_is_outlined_on_the_fabric(studio: Page) -> None:
    _wait_for_live_cloth(studio)
    with studio.expect_request(
        lambda r: r.url.endswith("/mark") and '"row0":0' in (r.post_data or "")
    ) as sent:
        studio.keyboard.press("Control+a")
    assert json.loads(sent.value.post_data or "")["box"] == {
        "row0": 0,
        "column0": 0,
        "row1": ROWS,
        "column1": COLUMNS,
    }


@pytest.mark.slow
def test_sides_and_yarn_colours_change_the_picture(studio: Page) -> None:
    face = _wait_for_live_cloth(studio)
    with studio.expect_response(lambda r: r.url.endswith("/camera") and r.ok):
        studio.click("#look-edge")
    wait_for_change(studio, CLOTH, face, 60)
    wait_for_colour(studio, CLOTH, 300)
    with sent_view(studio) as answer:
        studio.click("#fabric-colours-button")
        studio.click("#yarn-yarn")
    assert answer.value.ok


@pytest.mark.slow
def test_a_stretch_is_scrubbed_by_keyboard_in_chart_curve_and_3d(studio: Page) -> None:
    studio.click("#stretch-course")
    studio.fill("#stretch-amount", "30")
    studio.focus("#chart")
    studio.keyboard.press("j")
    expect(studio.locator("#stretch-slider")).to_be_enabled()
    caption = studio.locator(".fabric-caption")
    expect(caption).to_contain_text("Stretched along the rows by 30 %")
    with studio.expect_response(lambda r: r.url.endswith("views/" + _design(studio)) and r.ok):
        for _ in range(5):
            studio.keyboard.press(",")
    expect(caption).not_to_contain_text("Stretched along the rows by 30 %")
    expect(studio.locator("#curve-course")).to_have_attribute("aria-checked", "true")
    expect(studio.locator("#plot-curve .main-svg").first).to_be_visible()
    studio.wait_for_function(
        """names => {
            const shown = document.querySelector("#plot-curve").data.map(({ name }) => name);
            return names.every((name) => shown.includes(name));
        }""",
        arg=["stockinette", "garter", "rib", "seed", "90 % interval", "stretch test"],
    )


@pytest.mark.slow
def test_a_fabric_that_was_stretched_is_also_shown_as_it_lies(flat_studio: Page) -> None:
    """Its stretch is no colour of the fabric at rest."""
    stretched(flat_studio)
    with sent_view(flat_studio, '"curl":{') as shown:
        flat_studio.click("#fabric-lying")
    assert shown.value.ok, shown.value.text()
    expect(flat_studio.locator(".fabric-caption")).to_contain_text(
        "Unpinned (no friction with the table)"
    )


@pytest.mark.slow
def test_the_weight_of_the_yarn_hangs_the_fabric_and_bends_it_over_an_edge(
    flat_studio: Page,
) -> None:
    flat_studio.click("#tab-drape")
    flat_studio.fill("#drape-weight", "0.4")
    flat_studio.click("#drape-overhang")
    expect(flat_studio.locator("#drape-answer")).to_contain_text("Bending length")
    flat_studio.click("#drape-hang")
    expect(flat_studio.locator(".fabric-caption")).to_contain_text("stitches")


@pytest.mark.slow
def test_the_free_edges_of_a_stretched_fabric_curl(flat_studio: Page) -> None:
    stretched(flat_studio)
    flat_studio.click("#stretch-more")
    with sent_view(flat_studio, '"curl":{'):
        flat_studio.check("#stretch-curling")
    expect(flat_studio.locator(".fabric-caption")).to_contain_text("free edges curl")
    with sent_view(flat_studio, '"curl":null'):
        flat_studio.uncheck("#stretch-curling")


@pytest.mark.slow
def test_the_chart_is_worn_on_a_limb_of_the_girths_given(flat_studio: Page) -> None:
    flat_studio.click("#tab-limb")
    expect(flat_studio.locator(".limb-girths input")).to_have_count(4)
    flat_studio.get_by_label("Girth 2", exact=True).fill("70")
    flat_studio.click("#fabric-colours-button")
    flat_studio.click("#yarn-chart")
    with sent_view(flat_studio, '"colour":"pressure"') as shown:
        flat_studio.click("#limb-wear")
    assert shown.value.ok, shown.value.text()
    caption = flat_studio.locator(".fabric-caption")
    expect(caption).to_contain_text("Pressure on the body")
    expect(caption.locator("[role=alert] summary")).to_contain_text("It may press by more")
    expect(flat_studio.locator(".pressure-plot")).to_be_attached()


@pytest.mark.slow
def test_a_test_can_be_cancelled(flat_studio: Page) -> None:
    flat_studio.route("**/api/v1/jobs/*/events", lambda route: None)  # its end is never heard
    flat_studio.click("#stretch-run")
    expect(flat_studio.locator("#stretch-run")).to_contain_text("Cancel")
    with flat_studio.expect_request(lambda r: "/jobs/" in r.url and r.method == "DELETE"):
        flat_studio.click("#stretch-run")
    expect(flat_studio.locator("#stretch-run")).to_contain_text("Stretch")


@pytest.mark.slow
def test_the_console_stays_clean_while_the_view_is_used(visitor: Page, service: str) -> None:
    page, said = visitor, complaints(visitor)
    open_small_chart(page, service)
    _wait_for_live_cloth(page)

    def shown(act: Callable[[], object], words: str = "") -> None:
        with sent_view(page, words):
            act()

    shown(lambda: drag(page, 90, 40))
    for side in ("back", "edge", "angle", "face"):
        shown(partial(page.click, f"#look-{side}"))
    stretched(page).focus()
    # What the stretch sent may still be on its way: it is no answer to either.
    shown(lambda: page.keyboard.press("Home"), '"stretch":null')
    shown(lambda: page.keyboard.press("End"), '"stretch":{')
    shown(lambda: page.click("#stretch-play"))
    for pose in ("lying", "worn", "flat"):
        shown(partial(page.click, f"#fabric-{pose}"))
    shown(lambda: page.click("#action-theme"))
    keep_version(page, "Clean")
    page.keyboard.press("Escape")
    page.wait_for_timeout(1_000)  # what is drawn late is complained of late
    assert not said, "\n".join(text[-160:] for text in said)


@pytest.mark.slow
def test_two_designs_never_show_each_other(browser: Browser, service: str) -> None:
    pictures = []
    contexts = []
    for chart in ("K" * 8, "KP" * 4):
        context = browser.new_context(
            viewport={"width": 1280, "height": 720}, reduced_motion="reduce"
        )
        context.set_default_timeout(TIMEOUT_MS)
        context.add_init_script(COLOURED_CLOTH)
        page = open_small_chart(context.new_page(), service, "\n".join([chart] * 8))
        contexts.append((context, page))
    for _, page in contexts:
        pictures.append(_wait_for_live_cloth(page))
    for context, _ in contexts:
        context.close()
    stockinette, rib = (picture.reshape(-1, 3) for picture in pictures)

    def blue(picture: np.ndarray) -> int:
        return int((picture[:, 2] > picture[:, 1] + 25).sum())

    def green(picture: np.ndarray) -> int:
        return int((picture[:, 1] > picture[:, 2] + 25).sum())

    assert blue(stockinette) > 5 * green(stockinette)
    assert green(rib) > 5 * blue(rib)


@pytest.mark.slow
def test_a_lost_view_is_restored_automatically(studio: Page) -> None:
    _wait_for_live_cloth(studio)
    with sent_view(studio):
        studio.context.set_offline(True)
        expect(studio.locator("#offline")).to_be_visible()
        studio.context.set_offline(False)
    _wait_for_live_cloth(studio)


@pytest.mark.slow
def test_a_view_whose_page_did_not_come_is_loaded_again(visitor: Page, service: str) -> None:
    visitor.route("**/view/**", lambda route: route.abort())
    open_small_chart(visitor, service)
    wait_for_colour(visitor, CLOTH, YARN)  # the picture
    visitor.unroute_all()
    _wait_for_live_cloth(visitor)


@pytest.mark.slow
def test_a_page_is_saved_that_needs_no_service(studio: Page, tmp_path: Path) -> None:
    _wait_for_live_cloth(studio)
    studio.click("#fabric-share-button")
    with studio.expect_download() as download:
        studio.click("#share-page")
    file = tmp_path / "fabric.html"
    download.value.save_as(file)
    text = file.read_text(encoding="utf-8")
    assert "<html" in text
    assert studio.evaluate("location.host") not in text
    given = studio.context.new_page()
    said = complaints(given)
    given.goto(file.as_uri())
    wait_for_colour(given, "body", YARN)
    stays = [coloured(pixels(given, "body")) for _ in range(6)]
    assert min(stays) >= YARN
    assert said == []


def _design(page: Page) -> str:
    return str(page.evaluate("JSON.parse(localStorage['knitcore.design']).id"))
