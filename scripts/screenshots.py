"""Take the screenshots in docs/images: the page and each of its panels, light and dark.

``python -m scripts.screenshots [NAME …]`` needs Chromium and Node; names make only these pictures.
"""

from __future__ import annotations

import io
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Literal

import numpy as np
from PIL import Image
from playwright.sync_api import Browser, Page, ViewportSize, sync_playwright

from scripts.serving import CHROMIUM, FLAGS, FORCED, serving

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
MAX_BYTES = 200_000
SCREEN: ViewportSize = {"width": 1440, "height": 900}
THEMES: tuple[Literal["light", "dark"], ...] = ("light", "dark")
ALIKE = 10
"""Difference, of 255, below which colours are one to a palette."""

Scene = Callable[[Page], str | None]
"""Brings the page into a state and names the part to picture; all of it if None."""


def drawn(page: Page) -> None:
    """Wait for the 3D view, which takes long without a GPU, and for its last frames."""
    page.locator(".fabric[data-live]").wait_for(timeout=120_000)
    page.wait_for_timeout(10_000)  # the words of its scale come last


def page(page: Page) -> str | None:
    """The first visit: the example is stretched."""
    drawn(page)
    return None


def clicked(button: str, part: str, wait_ms: int) -> Scene:
    """A part of the page, some time after a button was clicked."""

    def scene(page: Page) -> str | None:
        page.click(button)
        page.wait_for_timeout(wait_ms)
        return part

    return scene


def stiffness(page: Page) -> str | None:
    page.click("#overlay-modulus-course")
    page.click("#overlay-rectangles")
    page.wait_for_timeout(800)
    page.evaluate("document.activeElement.blur()")
    return ".chart-pane"


def fabric(page: Page) -> str | None:
    drawn(page)
    return "#fabric"


def stretch(page: Page) -> str | None:
    page.locator("#stretch-slider").wait_for()
    return "#stretch"


def opened(action: str, panel: str, settled: str | None = None) -> Scene:
    """A panel that an action opens."""

    def scene(page: Page) -> str | None:
        page.keyboard.press("Control+k")
        page.fill("#command-search", action)
        page.keyboard.press("Enter")
        page.locator(panel).wait_for()
        if settled:
            page.locator(settled).first.wait_for()
        page.wait_for_timeout(1200)
        return panel

    return scene


def regions(page: Page) -> str | None:
    page.keyboard.press("Shift+N")
    page.click("#gallery-glove")
    page.keyboard.press("Shift+A")
    page.locator("#panel-regions").wait_for()
    page.click("#overlay-fabrics")
    page.wait_for_timeout(1000)
    return ".chart-pane"


def repeats(page: Page) -> str | None:
    page.keyboard.press("Shift+N")
    page.click("#gallery-diamonds")
    page.keyboard.press("m")
    box = page.locator("#chart").bounding_box()
    assert box
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 130, y + 90, steps=5)
    page.mouse.up()
    page.keyboard.press("Shift+L")
    page.click("#repeat-from-selection")
    page.wait_for_timeout(1000)
    return ".chart-pane"


def commands(page: Page) -> str | None:
    page.keyboard.press("Control+k")
    page.locator("#palette-dialog").wait_for()
    return "#palette-dialog"


def designs(page: Page) -> str | None:
    for name in ("seed", "diamonds", "basket", "wrist-brace"):
        page.keyboard.press("Shift+N")
        page.click(f"#gallery-{name}")
        page.wait_for_timeout(600)
        page.keyboard.press("Control+s")  # the versions need it at the service
        page.locator("#version-keep").click()
        page.locator("#versions-list .row").wait_for()
        page.keyboard.press("Escape")
    page.keyboard.press("Control+o")
    page.locator("#designs-list .card canvas").nth(3).wait_for()
    page.wait_for_timeout(600)
    return "#designs-dialog"


def versions(page: Page) -> str | None:
    page.keyboard.press("Control+s")
    for name in ("All knit so far", "With a rib cuff", "Softer panel"):
        page.fill("#version-name", name)
        page.click("#version-keep")
        page.locator("#versions-list", has_text=name).wait_for()
    page.wait_for_timeout(800)
    return "#versions-dialog"


def share(page: Page) -> str | None:
    page.click("#action-share")
    page.click("#share-make")
    page.locator("#share-list .row").wait_for()
    return "#share-dialog"


def tour(page: Page) -> str | None:
    page.click("#designs-button")
    page.click("#menu-tour")
    for _ in range(3):
        page.keyboard.press("ArrowRight")
    page.wait_for_timeout(500)
    return None


def offline(page: Page) -> str | None:
    drawn(page)
    page.route("**/api/**", lambda route: route.abort())
    page.route("**/healthz", lambda route: route.abort())
    page.keyboard.press("x")
    page.locator("#offline").wait_for()
    page.wait_for_timeout(2500)
    return None


def glove(page: Page) -> str | None:
    page.keyboard.press("Shift+N")
    page.click("#gallery-glove")
    page.click("#overlay-fabrics")
    drawn(page)
    return None


def fill(page: Page) -> str | None:
    """A part that was made softer, on the chart, with the fabric in sight."""
    page.keyboard.press("Shift+W")
    page.click("#part-add")
    page.wait_for_timeout(800)
    page.select_option("#part-0-like", "seed")
    page.click("#fill-run")
    page.locator("#fill-keep").wait_for(timeout=120_000)
    drawn(page)
    return None


def compare(page: Page) -> str | None:
    page.keyboard.press("Shift+C")
    page.locator("#compare-numbers tbody tr").first.wait_for()
    page.select_option("#compare-b", "now")
    page.select_option("#compare-b-yarn", "cotton")
    page.locator("#compare-dialog:not(.busy) #compare-plot .main-svg").first.wait_for()
    page.wait_for_timeout(1000)
    return "#compare-dialog"


def pattern(page: Page) -> str | None:
    """The first page of the pattern that the page exports."""
    drawn(page)
    page.keyboard.press("Control+e")
    page.check("input[value='pattern-svg']")
    with page.expect_download() as download:
        page.click("#export-make")
    drawing = download.value.path().read_text(encoding="utf-8")
    page.goto("about:blank")
    sheet = "<style>body { margin: 0 } #sheet { width: 800px; height: 1131px; overflow: hidden }"
    page.set_content(f"{sheet} svg {{ width: 800px; height: auto }}</style><div id=sheet>{drawing}")
    return "#sheet"


ATLAS = ".inverse-plot[data-count]:not([data-count='0'])"
WHOLE: dict[str, Scene] = {
    "page": page,
    "glove": glove,
    "fabric": fabric,
    "fill": fill,
    "pattern": pattern,
    "offline": offline,
}
"""Pictures with the fabric in 3D, each from its own visit."""

PARTS: dict[str, Scene] = {
    "stretch": stretch,
    "curve": clicked("#tab-curve", "#inspector", 1500),
    "inspector": clicked("#tab-rigidity", "#inspector", 1500),
    "tour": tour,
    "fabrics": clicked("#overlay-fabrics", ".chart-pane", 800),
    "segments": clicked("#overlay-segments", ".chart-pane", 800),
    "stiffness": stiffness,
    "gallery": opened("New design", "#gallery-dialog", "#gallery-glove canvas"),
    "versions": versions,
    "share": share,
    "help": opened("Keys and tools", "#help-dialog"),
    "commands": commands,
    "resize": opened("Size and new chart", "#resize-dialog"),
    "import": opened("Import a chart", "#import-dialog"),
    "exports": opened("Export, all formats", "#export-dialog"),
    "garments": opened("Plan a garment", "#planner-dialog", "#planner-facts:not(.busy) table"),
    "atlas": opened("Atlas of all repeats", "#inverse", ATLAS),
    "compare": compare,
    "designs": designs,
    "regions": regions,
    "repeats": repeats,
}
"""Pictures from one visit, without the fabric in 3D, which takes most of the time."""


def visit(browser: Browser, url: str, theme: Literal["light", "dark"], *, flat: bool) -> Page:
    """A first visit, with the example stretched and the offer of a tour declined."""
    context = browser.new_context(viewport=SCREEN, color_scheme=theme, reduced_motion="reduce")
    context.set_default_timeout(60_000)
    page = context.new_page()
    if flat:
        page.route("**/view/**", lambda route: route.fulfill(body="", content_type="text/html"))
    page.goto(url)
    page.click("#tour-offer [aria-label='No tour']")
    page.locator("#stretch-slider:enabled").wait_for(timeout=300_000)
    page.wait_for_timeout(1500)
    return page


def picture(page: Page, scene: Scene, name: str) -> None:
    """Bring the page into the state of a scene and keep a picture of its part."""
    part = scene(page)
    keep(name, page.locator(part).first.screenshot() if part else page.screenshot())


def leave(page: Page) -> None:
    """Close the dialogs and panels that a scene has opened."""
    page.keyboard.press("Escape")
    page.wait_for_function("() => !document.querySelector('dialog[open]')")
    page.evaluate(
        """buttons => document.querySelectorAll(buttons).forEach(
            (button) => button.checkVisibility() && button.click())""",
        ".dock-panel:not([hidden]) header button, #inverse-close, #messages button,"
        " #overlay-rectangles[aria-pressed='true']",
    )


def keep(name: str, picture: bytes) -> None:
    """Write a picture with as many colours as fit into its size."""
    image = Image.open(io.BytesIO(picture)).convert("RGB")
    file = IMAGES / f"{name}.png"
    for colours in (256, 160, 96, 64, 32):
        packed = io.BytesIO()
        image.quantize(palette=palette(image, colours), dither=Image.Dither.NONE).save(
            packed, "PNG", optimize=True
        )
        if packed.tell() <= MAX_BYTES:
            break
    file.write_bytes(packed.getvalue())
    print(f"{file.relative_to(ROOT)}  {packed.tell() / 1000:.0f} kB", flush=True)


def palette(image: Image.Image, colours: int) -> Image.Image:
    """The colours that large areas have, exactly, and for the rest what covers them best.

    Of areas that look alike, as the cells of a map do, the largest stands for all: they would leave
    no place for the few pixels of a legend.
    """
    counted = sorted(image.getcolors(image.width * image.height) or [], reverse=True)
    large = np.array([colour for _, colour in counted])
    common: list[int] = []
    while len(large) and len(common) < 3 * (colours // 2):
        common += large[0].tolist()
        large = large[np.abs(large - large[0]).max(axis=1) > ALIKE]
    others = image.quantize(colours - len(common) // 3).getpalette() or []
    chosen = Image.new("P", (1, 1))
    chosen.putpalette(common + others)
    return chosen


def pictures(browser: Browser, url: str, theme: Literal["light", "dark"], names: list[str]) -> None:
    """All wanted pictures in one theme."""
    page = visit(browser, url, theme, flat=True)
    for name in [name for name in PARTS if name in names]:
        picture(page, PARTS[name], f"{name}-{theme}")
        leave(page)
    page.context.close()
    for name in [name for name in WHOLE if name in names]:
        page = visit(browser, url, theme, flat=False)
        picture(page, WHOLE[name], f"{name}-{theme}")
        page.context.close()


def main(names: list[str]) -> None:
    subprocess.run(["node", "frontend/build.mjs"], cwd=ROOT, check=True)
    IMAGES.mkdir(exist_ok=True)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(CHROMIUM), args=[*FLAGS, FORCED])
        for theme in THEMES:
            with (
                tempfile.TemporaryDirectory() as folder,
                serving(Path(folder), workers="1") as service,  # one that has no designs yet
            ):
                pictures(browser, service.url, theme, names)
        browser.close()


if __name__ == "__main__":
    main(sys.argv[1:] or [*WHOLE, *PARTS])
