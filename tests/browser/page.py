"""Steps that a person takes on the page, and views of it."""

import io
import json
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

import numpy as np
from PIL import Image
from playwright.sync_api import Download, Locator, Page, Route, expect


def kept_chart(page: Page) -> str:
    """The chart as the browser keeps it, once it is kept."""
    page.wait_for_function("() => !('unsaved' in document.documentElement.dataset)")
    return str(json.loads(page.evaluate("localStorage['knitcore.design']"))["chart"])


def middle(page: Page) -> tuple[float, float]:
    """The middle of the chart on the screen."""
    box = page.locator("#chart").bounding_box()
    assert box
    rulers = 9  # there is more room for rulers below the chart than above it
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2 - rulers


def drag(page: Page, dx: float, dy: float, *, start: tuple[float, float] = (0, 0)) -> None:
    """A stroke with the left button; offsets in pixels from the chart's middle."""
    x, y = middle(page)
    x, y = x + start[0], y + start[1]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + dx, y + dy, steps=6)
    page.mouse.up()


def pixels(page: Page, selector: str) -> np.ndarray:
    """Picture of a part of the page, (height, width, 3)."""
    box = page.locator(selector).bounding_box()
    assert box
    picture = page.screenshot(clip=box)
    return np.asarray(Image.open(io.BytesIO(picture)).convert("RGB")).astype(int)


def coloured(picture: np.ndarray) -> int:
    """Number of pixels that are clearly not grey, nor the page's warm neutrals."""
    return int(((picture.max(axis=-1) - picture.min(axis=-1)) > 22).sum())


def wait_for_picture(
    page: Page, selector: str, measure: Callable[[np.ndarray], float], least: float
) -> np.ndarray:
    """The picture of a part of the page once something measured in it is as large as wanted."""
    for _ in range(150):
        picture = pixels(page, selector)
        if (measured := measure(picture)) >= least:
            return picture
        page.wait_for_timeout(700)
    raise AssertionError(f"{selector}: {measured} in its picture, not {least}")


def wait_for_colour(page: Page, selector: str, least: int) -> np.ndarray:
    """The picture of a part of the page once it has so many coloured pixels."""
    return wait_for_picture(page, selector, coloured, least)


def wait_for_change(page: Page, selector: str, before: np.ndarray, least: int) -> None:
    """Until a part of the page looks otherwise than before: some pixel differs by more."""

    def change(picture: np.ndarray) -> float:
        return float(np.abs(picture - before).max()) if picture.shape == before.shape else 0.0

    wait_for_picture(page, selector, change, least + 1)


def settle(page: Page) -> None:
    """Until what has changed is laid out and drawn."""
    page.evaluate(
        """async () => {
            for (let k = 0; k < 4; k++) await new Promise(requestAnimationFrame);
        }"""
    )


def keep_messages(page: Page) -> None:
    """Messages stay for as long as a test may take to look at them."""
    page.evaluate(
        """() => {
            const later = window.setTimeout;
            window.setTimeout = (act, ms) => (ms === 5000 ? 0 : later(act, ms));
        }"""
    )


def number(page: Page, selector: str) -> float:
    """A number in the inspector, whether its fold is open or not."""
    return float((page.locator(f"{selector} .value").text_content() or "").replace("−", "-"))


def expect_number(page: Page, selector: str, low: float, high: float) -> None:
    """Until the number that a part of the page shows lies between two others."""
    page.wait_for_function(
        """([selector, low, high]) => {
            const shown = document.querySelector(selector).textContent.replace("−", "-");
            return shown && low <= Number(shown) && Number(shown) <= high;
        }""",
        arg=[selector, low, high],
    )


def kept_design(page: Page) -> dict[str, Any]:
    """The design as the browser keeps it, once it is kept."""
    page.wait_for_function("() => !('unsaved' in document.documentElement.dataset)")
    design = json.loads(page.evaluate("localStorage['knitcore.design']"))
    assert isinstance(design, dict)
    return design


def sent_view(page: Page, words: str = "") -> AbstractContextManager[Any]:
    """Wait, at the end of a block, for the answer to a view that has these words."""
    return page.expect_response(
        lambda r: (
            "/api/v1/views/" in r.url
            and r.request.method == "PUT"
            and words in (r.request.post_data or "")
        )
    )


def stretched(page: Page, percent: str | None = None) -> Locator:
    """Pull the chart, by default as far as the field says; the slider, once it can be moved."""
    if percent is not None:
        page.fill("#stretch-amount", percent)
    page.click("#stretch-run")
    slider = page.locator("#stretch-slider")
    expect(slider).to_be_enabled()
    return slider


def keep_version(page: Page, name: str) -> None:
    """Keep the design as a version, and leave its list open."""
    page.focus("#chart")
    page.keyboard.press("Control+s")
    page.fill("#version-name", name)
    page.click("#version-keep")
    expect(page.locator("#versions-list")).to_contain_text(name)


def exported(page: Page, kind: str) -> Download:
    """The file that the page's export panel makes."""
    page.keyboard.press("Control+E")
    page.locator(f"input[name=export-kind][value={kind}]").check()
    with page.expect_download() as caught:
        page.locator("#export-make").click()
    return caught.value


def complaints(page: Page) -> list[str]:
    """List what the console and the service complain of from now on."""
    heard: list[str] = []
    page.on("console", lambda m: heard.append(m.text) if m.type not in ("log", "info") else None)
    page.on("pageerror", lambda error: heard.append(error.message))
    page.on("response", lambda r: heard.append(f"{r.status} {r.url}") if r.status >= 400 else None)
    return heard


def held(page: Page, path: str) -> list[Route]:
    """Requests that wait from now on, until they are continued."""
    waiting: list[Route] = []

    def hold(route: Route) -> None:
        waiting.append(route)

    page.route(path, hold)
    return waiting


def when_held(page: Page, waiting: list[Route]) -> Route:
    """The first request that waits, as soon as there is one."""
    while not waiting:
        page.wait_for_timeout(20)
    return waiting[0]


def open_another(page: Page, service: str, chart: str) -> None:
    """Show another design of the service, as the back button does: also from a dialog."""
    document = {"format": "knitcore-design", "version": 2, "name": "Another", "chart": chart}
    address = f"{service}api/v1/designs"
    kept = page.request.post(address, data=document | {"material": "acrylic"}).json()
    page.evaluate("(id) => (location.hash = `#design/${id}`)", kept["id"])
    expect(page.locator(".design-name")).to_have_value("Another")


def cut_off(page: Page) -> None:
    """Let nothing reach the service."""
    for path in ("**/api/**", "**/healthz"):
        page.route(path, lambda route: route.abort())


class Chart:
    """Where the stitches are on the screen, found with the read-out under the pointer."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.look()

    def look(self) -> None:
        """Find the stitches again, after the chart has moved."""
        places = self.page.evaluate(
            """async () => {
                // A panel that has opened beside the chart moves it with the next frame, and what
                // the last move of the pointer shows comes a moment later.
                for (let k = 0; k < 2; k++) await new Promise(requestAnimationFrame);
                await new Promise((done) => setTimeout(done, 200));
                const canvas = document.querySelector("#chart");
                const readout = document.querySelector("#readout");
                const box = canvas.getBoundingClientRect();
                // The page waits a moment before it shows what is under the pointer: not here.
                const due = [];
                const later = window.setTimeout;
                window.setTimeout = (act, ms) => (ms <= 100 ? due.push(act) : later(act, ms));
                const at = (clientX, clientY) => {
                    canvas.dispatchEvent(new PointerEvent("pointermove", { clientX, clientY }));
                    while (due.length) due.shift()();
                    const found = readout.textContent.match(/row (\\d+).*?stitch (\\d+)/i);
                    return found && [Number(found[1]), Number(found[2])];
                };
                const rows = {}, stitches = {};
                const [x0, y0] = [box.x + box.width / 2, box.y + 5 + box.height / 2];
                for (let x = box.x; x < box.right; x += 2) {
                    const stitch = at(x, y0)?.[1];
                    if (stitch) (stitches[stitch] ??= []).push(x);
                }
                for (let y = box.y; y < box.bottom; y += 2) {
                    const row = at(x0, y)?.[0];
                    if (row) (rows[row] ??= []).push(y);
                }
                window.setTimeout = later;
                const middle = (list) => (list[0] + list[list.length - 1]) / 2;
                const middles = (lists) =>
                    Object.fromEntries(Object.entries(lists).map(([k, v]) => [k, middle(v)]));
                return { rows: middles(rows), stitches: middles(stitches) };
            }"""
        )
        self.rows = {int(row): float(y) for row, y in places["rows"].items()}
        self.stitches = {int(stitch): float(x) for stitch, x in places["stitches"].items()}

    def at(self, row: int, stitch: int) -> tuple[float, float]:
        """Middle of a stitch: row from the bottom, stitch from the right of the face, from 1."""
        return self.stitches[stitch], self.rows[row]

    def click(self, row: int, stitch: int, **options: Any) -> None:
        """Click on a stitch."""
        self.page.mouse.click(*self.at(row, stitch), **options)

    def drag(self, *path: tuple[int, int]) -> None:
        """Press on the first stitch, go along the others, let go on the last."""
        self.page.mouse.move(*self.at(*path[0]))
        self.page.mouse.down()
        for cell in path[1:]:
            self.page.mouse.move(*self.at(*cell), steps=3)
        self.page.mouse.up()


def purls(text: str) -> set[tuple[int, int]]:
    """The purls of a chart as (row, stitch), both from 1, stitches from the right."""
    lines = text.splitlines()
    return {
        (len(lines) - k, len(line) - column)
        for k, line in enumerate(lines)
        for column, mark in enumerate(line)
        if mark == "P"
    }


def block(rows: tuple[int, int], stitches: tuple[int, int]) -> set[tuple[int, int]]:
    """All (row, stitch) of a box, its ends included."""
    return {
        (r, s) for r in range(rows[0], rows[1] + 1) for s in range(stitches[0], stitches[1] + 1)
    }


def drop(page: Page, name: str, kind: str, content: bytes) -> None:
    """Drop a file on the page."""
    page.evaluate(
        """([name, type, bytes]) => {
            const data = new DataTransfer();
            data.items.add(new File([Uint8Array.from(bytes)], name, { type }));
            window.dispatchEvent(new DragEvent("drop", { dataTransfer: data, cancelable: true }));
        }""",
        [name, kind, list(content)],
    )
