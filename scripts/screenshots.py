"""Take the screenshots that the docs show: the page and each of its panels, light or dark.

``python -m scripts.screenshots [NAME …]`` needs Chromium and Node; names make only these pictures.
"""

import io
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from PIL import Image
from playwright.sync_api import Browser, Page, ViewportSize, sync_playwright

from scripts.serving import CHROMIUM, FLAGS, FORCED, Service

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
DOCS = "".join(file.read_text("utf-8") for file in (ROOT / "README.md", *ROOT.glob("docs/*.md")))
MAX_BYTES = 200_000
SCREEN: ViewportSize = {"width": 1440, "height": 900}
THEMES: tuple[Literal["light", "dark"], ...] = ("light", "dark")
ALIKE = 10
"""Difference, of 255, below which colours are one to a palette."""

Step = Callable[[Page], object]
"""Brings the page a step further."""


class Scene(NamedTuple):
    """The part of the page to picture, all of it if None, and the steps that lead there."""

    part: str | None
    steps: tuple[Step, ...]


def scene(part: str | None, *steps: Step) -> Scene:
    return Scene(part, steps)


def drawn(page: Page) -> None:
    """Wait for the 3D view, which takes long without a GPU, and for its last frames."""
    page.locator(".fabric[data-live]").wait_for(timeout=120_000)
    page.wait_for_timeout(10_000)  # the words of its scale come last


def press(keys: str) -> Step:
    return lambda page: page.keyboard.press(keys)


def click(selector: str) -> Step:
    return lambda page: page.click(selector)


def choose(selector: str, value: str) -> Step:
    return lambda page: page.select_option(selector, value)


def there(selector: str, timeout_ms: float = 60_000) -> Step:
    return lambda page: page.locator(selector).first.wait_for(timeout=timeout_ms)


def pause(wait_ms: int) -> Step:
    return lambda page: page.wait_for_timeout(wait_ms)


def overlay(*names: str) -> Scene:
    """The chart with maps on it."""
    return scene(".chart-pane", *(click(f"#overlay-{name}") for name in names), pause(800))


def blur(page: Page) -> None:
    page.evaluate("document.activeElement.blur()")


def opened(action: str, panel: str, settled: str | None = None) -> Scene:
    """A panel that an action opens."""

    def search(page: Page) -> None:
        page.fill("#command-search", action)

    steps = press("Control+k"), search, press("Enter"), there(panel)
    return scene(panel, *steps, *((there(settled),) if settled else ()), pause(1200))


def marked(page: Page) -> None:
    """Mark a rectangle from the middle of the chart."""
    page.keyboard.press("m")
    box = page.locator("#chart").bounding_box()
    assert box
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 130, y + 90, steps=5)
    page.mouse.up()


def kept(name: str) -> tuple[Step, ...]:
    """Begin a design of the gallery and keep a version of it at the service."""
    begin = press("Shift+N"), click(f"#gallery-{name}"), pause(600), press("Control+s")
    return *begin, click("#version-keep"), there("#versions-list .row"), press("Escape")


def named(version: str) -> Step:
    """Keep a version by a name."""

    def step(page: Page) -> None:
        page.fill("#version-name", version)
        page.click("#version-keep")
        page.locator("#versions-list", has_text=version).wait_for()

    return step


def cut_off(page: Page) -> None:
    """Let nothing reach the service."""
    for address in ("**/api/**", "**/healthz"):
        page.route(address, lambda route: route.abort())


ATLAS = ".inverse-plot[data-count]:not([data-count='0'])"
COMPARED = "#compare-dialog:not(.busy) #compare-plot .main-svg"
NEW = press("Shift+N")
WHOLE: dict[str, Scene] = {
    "page": scene(None, drawn),
    "glove": scene(None, NEW, click("#gallery-glove"), click("#overlay-fabrics"), drawn),
    "fabric": scene("#fabric", drawn),
    "offline": scene(None, drawn, cut_off, press("x"), there("#offline"), pause(2500)),
}  # fmt: skip
"""Pictures with the fabric in 3D, each from its own visit."""

PARTS: dict[str, Scene] = {
    "stretch": scene("#stretch", there("#stretch-slider")),
    "curve": scene("#inspector", click("#tab-curve"), pause(1500)),
    "inspector": scene("#inspector", click("#tab-rigidity"), pause(1500)),
    "tour": scene(
        None, click("#designs-button"), click("#menu-tour"), *[press("ArrowRight")] * 3, pause(500),
    ),
    "fabrics": overlay("fabrics"),
    "segments": overlay("segments"),
    "stiffness": scene(".chart-pane", *overlay("modulus-course", "rectangles").steps, blur),
    "gallery": opened("New design", "#gallery-dialog", "#gallery-glove canvas"),
    "versions": scene(
        "#versions-dialog", press("Control+s"), named("All knit so far"), named("With a rib cuff"),
        named("Softer panel"), pause(800),
    ),
    "share": scene(
        "#share-dialog", click("#action-share"), click("#share-make"), there("#share-list .row"),
    ),
    "help": opened("Keys and tools", "#help-dialog"),
    "commands": scene("#palette-dialog", press("Control+k"), there("#palette-dialog")),
    "import": opened("Import a chart", "#import-dialog"),
    "exports": opened("Export, all formats", "#export-dialog"),
    "garments": opened("Plan a garment", "#planner-dialog", "#planner-facts:not(.busy) table"),
    "atlas": opened("Atlas of all repeats", "#inverse", ATLAS),
    "compare": scene(
        "#compare-dialog", press("Shift+C"), there("#compare-numbers tbody tr"),
        choose("#compare-b", "now"), choose("#compare-b-yarn", "cotton"), there(COMPARED),
        pause(1000),
    ),
    "designs": scene(
        "#designs-dialog", *kept("seed"), *kept("diamonds"), *kept("basket"), *kept("wrist-brace"),
        press("Control+o"), there("#designs-list .card canvas >> nth=3"), pause(600),
    ),
    "regions": scene(
        ".chart-pane", NEW, click("#gallery-glove"), press("Shift+A"), there("#panel-regions"),
        click("#overlay-fabrics"), pause(1000),
    ),
    "repeats": scene(
        ".chart-pane", NEW, click("#gallery-diamonds"), marked, press("Shift+L"),
        click("#repeat-from-selection"), pause(1000),
    ),
}  # fmt: skip
"""Pictures from one visit, without the fabric in 3D, which takes most of the time."""


def visit(browser: Browser, url: str, theme: Literal["light", "dark"], *, flat: bool) -> Page:
    """A first visit, with the example stretched and the offer of a tour declined."""
    context = browser.new_context(viewport=SCREEN, color_scheme=theme, reduced_motion="reduce")
    context.set_default_timeout(60_000)
    page = context.new_page()
    if flat:
        page.route("**/view/**", lambda route: route.fulfill(body="", content_type="text/html"))
    page.goto(url)
    page.click("#tour-offer [aria-label='Dismiss']")
    page.locator("#stretch-slider:enabled").wait_for(timeout=300_000)
    page.wait_for_timeout(1500)
    return page


def picture(page: Page, shown: Scene, name: str) -> None:
    """Bring the page into the state of a scene and keep a picture of its part."""
    for step in shown.steps:
        step(page)
    part = page.locator(shown.part).first if shown.part else page
    keep(name, part.screenshot())


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
    """All pictures of these names that the docs show in a theme."""
    names = [name for name in names if f"images/{name}-{theme}.png" in DOCS]
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
                Service(Path(folder), workers="1") as service,  # one that has no designs yet
            ):
                pictures(browser, service.url, theme, names)
        browser.close()


if __name__ == "__main__":
    main(sys.argv[1:] or [*WHOLE, *PARTS])
