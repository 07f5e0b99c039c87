"""The page as users experience it: first paint and cloth, strokes, shapes, yarn, size of scripts.

Headless Chromium without a GPU, against its own service on this machine. The time from an event to
its paint is the browser's (Event Timing, in steps of 8 ms, shorter ones count as 8). Strokes are
timed twice: with Chromium's default compositing without a GPU (changed regions only, WebGL in
software), and forced to draw every frame whole through a software GPU.

    make bench                             (RUNS=5 STROKES=20)
"""

import json
import os
import random
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, Page, sync_playwright

from scripts.serving import CHROMIUM, FLAGS, FORCED, Service

ROOT = Path(__file__).resolve().parents[2]
RUNS = int(os.environ.get("RUNS", "5"))
STROKES = int(os.environ.get("STROKES", "20"))
MIN_MS = 8.0
FIRST_MS = 10_000

WATCH = """() => {
    window.measured = [];
    new PerformanceObserver((list) => {
        for (const { name, startTime, duration } of list.getEntries())
            window.measured.push([name, startTime, duration]);
    }).observe({ type: "event", durationThreshold: 16 });
}"""
FROM_THE_START = """if (parent === window) {
    window.cloth = {};
    window.blocked = [];
    const note = (what) =>
        requestAnimationFrame(() => setTimeout(() => (cloth[what] ??= performance.now())));
    const loaded = ({ target }) => target.classList.contains("fabric-still") && note("still");
    document.addEventListener("load", loaded, true);
    const shown = () => document.querySelector(".fabric[data-live]") && note("live");
    const all = { subtree: true, childList: true, attributeFilter: ["data-live"] };
    new MutationObserver(shown).observe(document, all);
    new PerformanceObserver((list) => {
        for (const { duration } of list.getEntries()) blocked.push(duration);
    }).observe({ type: "longtask", buffered: true });
}"""
READY = """new Promise((done) => {
    const look = () => performance.getEntriesByName("studio").length
        ? done(document.querySelector("#chart").getBoundingClientRect().toJSON())
        : setTimeout(look, 20);
    look();
})"""
"""Where the chart is, once it may be painted on."""
PAINTED = """() => ({
    first: performance.getEntriesByName("first-contentful-paint")[0]?.startTime,
    studio: performance.getEntriesByName("studio")[0]?.startTime,
    still: cloth.still ?? cloth.live,
    live: cloth.live,
})"""

PLAIN = """{
    const { shaderSource } = WebGL2RenderingContext.prototype;
    const kept = { get: () => shaderSource, set: () => {} };
    Object.defineProperty(WebGL2RenderingContext.prototype, "shaderSource", kept);
}"""
"""Before the page's scripts: viser's shaders stay as they are, and yarn is plain tubes."""
FRAMES = """async (number) => {
    const gl = [...document.querySelectorAll("canvas")].find((c) => c.width).getContext("webgl2");
    const times = [];
    const request = window.requestAnimationFrame;
    window.requestAnimationFrame = (callback) => request((time) => {
        const start = performance.now();
        callback(time);
        const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        gl.flush();
        const look = () => {
            if (gl.getSyncParameter(sync, gl.SYNC_STATUS) !== gl.SIGNALED) setTimeout(look, 1);
            else times.push(performance.now() - start);
        };
        setTimeout(look);
    });
    while (times.length < number) {
        dispatchEvent(new Event("resize")); // news: idle frames wait without a GPU
        window.__viserMutable.requestRender();
        await new Promise((done) => setTimeout(done, 5));
    }
    window.requestAnimationFrame = request;
    return times.sort((a, b) => a - b);
}"""


ENDED = """() => {
    performance.setResourceTimingBufferSize(5000);
    addEventListener("pointerdown", () => (window.begun = performance.now()), true);
    addEventListener("pointerup", () => (window.ended = performance.now()), true);
    window.firstShapes = [];
    const own = window.fetch;
    window.fetch = async (address, options) => {
        const start = performance.now();
        const answer = await own(address, options); // throws where the next change came first
        if (address === "/api/v1/curl" && JSON.parse(options.body).time_limit_s < 1) {
            firstShapes.push({ start, end: performance.now() });
        }
        return answer;
    };
}"""
FIRST_SHAPE = """async () => {
    while (performance.now() < window.ended + 1500) {
        await new Promise((done) => setTimeout(done, 50));
    }
    const shape = firstShapes.findLast(({ start }) => start > window.begun);
    const shown = shape && performance.getEntriesByType("resource").find((entry) =>
        entry.startTime >= shape.end && entry.responseEnd && entry.name.includes("/api/v1/views/"));
    return shown
        ? [shape.start, shape.end, shown.responseEnd].map((ms) => ms - window.ended)
        : null;
}"""
"""Milliseconds from the end of a stroke until its first shape is asked for (which may be sooner,
after its last change), answered, and in the view; null if it changed nothing."""


def report(what: str, value: float, unit: str, target: float) -> None:
    """Print a figure with its target."""
    verdict = "ok" if value <= target else "MISSED"
    print(f"{what:58s} {value:8.1f} {unit:3s} target {target:g} {unit:3s} {verdict}", flush=True)


def p95(values: list[float]) -> float:
    """The value that one in twenty exceeds."""
    return sorted(values)[max(0, -(-95 * len(values) // 100) - 1)]


def weight() -> None:
    """Build the page and report the size of its scripts."""
    subprocess.run(["node", "frontend/build.mjs"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    sizes = json.loads((ROOT / "frontend/dist/sizes.json").read_text())
    total, initial = sizes["total"], sizes["initial"]
    report("scripts of the first visit", initial["bytes"] / 1000, "kB", 200)
    report("… compressed, as transferred", initial["gzip_bytes"] / 1000, "kB", 200)
    report(
        "with every panel that loads when it is opened, compressed",
        total["gzip_bytes"] / 1000,
        "kB",
        200,
    )
    print(f"{'… as they are':58s} {total['bytes'] / 1000:8.1f} kB")


def first_paint(browser: Browser, url: str) -> None:
    """Cold visits: nothing is cached, the example is painted and stretched."""
    visits = []
    for _ in range(RUNS + 1):
        page = new_visit(browser, url)
        page.wait_for_function(
            f"() => Object.values(({PAINTED})()).every(Number.isFinite)", timeout=60_000
        )
        visits.append(page.evaluate(PAINTED))
        page.context.close()
    visits = visits[1:]  # the first one finds a service that has computed nothing yet
    report("first paint of a cold visit, median", median(visits, "first"), "ms", 1500)
    report("chart ready to paint on, median", median(visits, "studio"), "ms", 1500)
    for visit in visits:
        visit |= {what: visit[what] - visit["first"] for what in ("still", "live")}
    report("first cloth after first paint, median", median(visits, "still"), "ms", 1500)
    report("… that can be turned", median(visits, "live"), "ms", 3000)


def new_visit(browser: Browser, url: str) -> Page:
    """The page in a browser that was never here before."""
    page = browser.new_context(viewport={"width": 1440, "height": 900}).new_page()
    page.add_init_script(FROM_THE_START)
    page.goto(url)
    return page


def first_strokes(browser: Browser, url: str) -> None:
    """Strokes from the moment that the chart is ready until ten seconds after the visit began."""
    painted: list[float] = []
    blocked: list[float] = []
    for _ in range(RUNS):
        page = new_visit(browser, url)
        ask = questions(page)
        box = ask(READY)
        ask(f"({WATCH})()")
        rng = random.Random(3)
        while ask("performance.now()") < FIRST_MS:
            stroke(page, box, rng)
        events = page.evaluate("window.measured")
        painted += [max(ms, MIN_MS) for name, _, ms in events if name.startswith("pointer")]
        blocked += page.evaluate("window.blocked")
        page.context.close()
    report("events of strokes in the first ten seconds, p95", p95(painted or [MIN_MS]), "ms", 100)
    report("… the longest", max(painted, default=MIN_MS), "ms", 100)
    report("… longest task of the page's thread", max(blocked, default=0.0), "ms", 100)


def questions(page: Page) -> Callable[[str], Any]:
    """Evaluates in the page without Playwright's own scripts, whose 10 ms would be the page's."""
    session = page.context.new_cdp_session(page)

    def ask(expression: str) -> Any:
        how = {"expression": expression, "awaitPromise": True, "returnByValue": True}
        return session.send("Runtime.evaluate", how)["result"].get("value")

    return ask


def median(visits: list[dict[str, float]], what: str) -> float:
    return statistics.median(visit[what] for visit in visits)


def yarn(browser: Browser, url: str) -> None:
    """A frame of the 3D view of 100 x 100 stitches seen whole, with plies and as plain tubes."""
    took: dict[str, list[float]] = {"": [], PLAIN: []}
    for _ in range(RUNS):
        for script in took:
            page = open_chart(browser, url, 100, script)
            page.locator(".fabric[data-live]").wait_for(timeout=120_000)
            frame = next(frame for frame in page.frames if "/view/" in frame.url)
            took[script] += frame.evaluate(FRAMES, 10)
            page.context.close()
    dressed, plain = (statistics.median(times) for times in took.values())
    report("a frame of 100 x 100 stitches, yarn over plain tubes", dressed / plain, "", 1.1)


def shapes(browser: Browser, url: str) -> None:
    """From the end of a stroke to the first shape of 60 x 60 stitches as they lie."""
    page = open_chart(browser, url, 60)
    page.click("#fabric-lying")
    page.wait_for_timeout(6000)  # it lies
    page.evaluate(ENDED)
    box = page.evaluate(READY)
    rng = random.Random(1)
    parts = []
    for _ in range(STROKES):
        stroke(page, box, rng)
        if part := page.evaluate(FIRST_SHAPE):
            parts.append(part)
    asked_ms, answered_ms, first = (statistics.median(part) for part in zip(*parts, strict=True))
    print(
        f"a first shape is requested after {asked_ms:.0f} ms, answered after {answered_ms:.0f} ms"
    )
    report("end of a stroke to the first shape in the 3D view, median", first, "ms", 300)
    page.context.close()


def open_chart(browser: Browser, url: str, side: int, script: str = "") -> Page:
    """A mixed chart of side x side stitches with a map of moduli; a script for all its frames."""
    rng = random.Random(7)
    chart = "\n".join("".join(rng.choices("KP", k=side)) for _ in range(side))
    design = {"id": f"bench-{side}", "name": "Bench", "material": "acrylic", "chart": chart}
    page = browser.new_context(viewport={"width": 1440, "height": 900}).new_page()
    page.add_init_script(
        "if (parent === window) {"
        f"localStorage['knitcore.design'] ??= {json.dumps(json.dumps(design))};"
        'localStorage["knitcore.settings"] ??= \'{"overlay":"modulus-course"}\';'
        "}" + script
    )
    page.goto(url)
    page.wait_for_function(
        "() => document.querySelector('#modulus-course .value')?.textContent.match(/\\d/)",
        timeout=120_000,
    )
    page.wait_for_timeout(6000)  # the 3D view has settled
    return page


def stroke(page: Page, box: dict[str, float], rng: random.Random) -> float:
    """A short one somewhere in the middle of the chart; returns how long the browser took its
    six events in, in ms."""
    x = box["x"] + box["width"] * rng.uniform(0.3, 0.7)
    y = box["y"] + box["height"] * rng.uniform(0.3, 0.7)
    page.mouse.move(x, y)
    start = time.perf_counter()
    page.mouse.down()
    page.mouse.move(x + 30, y + 5, steps=4)
    page.mouse.up()
    taken = 1000 * (time.perf_counter() - start)
    page.wait_for_timeout(200)  # a moment to see it
    return taken


def strokes(page: Page) -> tuple[list[float], list[float]]:
    """From each event of a stroke to its paint: the whole strokes' worst, and the last event's."""
    page.evaluate(WATCH)
    box = page.evaluate(READY)
    rng = random.Random(1)
    worst, last = [], []
    for _ in range(STROKES):
        start = page.evaluate("performance.now()")
        stroke(page, box, rng)
        events = page.evaluate("start => window.measured.filter(([, at]) => at >= start)", start)
        painted = [ms for name, _, ms in events if name in ("pointerdown", "pointermove")]
        ended = [ms for name, _, ms in events if name == "pointerup"]
        worst.append(max(painted, default=MIN_MS))
        last.append(max(painted + ended, default=MIN_MS))
    return worst, last


def painting(browser: Browser, url: str) -> None:
    """Strokes with the map of moduli on show, the 3D view live and the stretch panel open."""
    for side, target in ((100, 60), (400, 120)):
        painted: list[float] = []
        mapped: list[float] = []
        for _ in range(RUNS):
            page = open_chart(browser, url, side)
            worst, last = strokes(page)
            painted += worst
            mapped += last
            page.context.close()
        size = f"{side} x {side}"
        report(f"stroke to painted cell at {size}, median", statistics.median(painted), "ms", 16)
        report(f"stroke to painted cell at {size}, p95", p95(painted), "ms", 24)
        report(f"stroke to the map at {size}, p95", p95(mapped), "ms", target)


def pauses(browser: Browser, url: str) -> None:
    """Strokes after pauses of all lengths, so that frames of the 3D view fall into them.

    Timed from outside: the browser's own timing begins only when it gets to an event, and leaves
    out moves. A stroke takes some time however fast the page is.
    """
    for side in (60, 400):
        page = open_chart(browser, url, side)
        page.wait_for_selector(".fabric[data-live]")
        box, rng = page.evaluate(READY), random.Random(5)
        taken = []
        for _ in range(STROKES):
            page.wait_for_timeout(rng.uniform(0, 2800))
            taken.append(stroke(page, box, rng))
        page.context.close()
        report(
            f"slowest over fastest stroke at {side} x {side}", max(taken) - min(taken), "ms", 100
        )


def main() -> None:
    weight()
    if not CHROMIUM.exists():
        print("needs Chromium for the rest (scripts/ensure-packages chromium)")
        return
    with (
        tempfile.TemporaryDirectory() as folder,
        Service(Path(folder), workers="2") as service,  # as `knitcore serve` on two cores
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS)
        first_paint(browser, service.url)
        first_strokes(browser, service.url)
        painting(browser, service.url)
        pauses(browser, service.url)
        shapes(browser, service.url)
        yarn(browser, service.url)
        browser.close()
        print(f"forced to draw whole frames ({FORCED})")
        browser = playwright.chromium.launch(executable_path=str(CHROMIUM), args=[*FLAGS, FORCED])
        painting(browser, service.url)
        browser.close()


if __name__ == "__main__":
    main()
