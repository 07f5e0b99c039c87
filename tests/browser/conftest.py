"""The page in Chromium, against the real service."""

import json
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect, sync_playwright

from scripts.serving import CHROMIUM, FLAGS, FORCED, Service

ROOT = Path(__file__).resolve().parents[2]
TIMEOUT_MS = 120_000
"""Generous: a busy machine computes slowly, and without a GPU draws the 3D view slowly."""

expect.set_options(timeout=TIMEOUT_MS)

ROWS, COLUMNS = 10, 12
CHART = "\n".join(["K" * COLUMNS] * ROWS)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Everything in this folder needs Chromium, and comes last.

    Playwright keeps an event loop running, beside which no test of coroutines can run its own.
    """
    for item in items:
        if Path(__file__).parent in item.path.parents:
            item.add_marker(pytest.mark.browser)
    items.sort(key=lambda item: item.get_closest_marker("browser") is not None)


@pytest.fixture(scope="session")
def bundle() -> None:
    """The page as people get it; `make test` has bundled it already."""
    subprocess.run(["make", "--silent", "page"], cwd=ROOT, check=True)


COLOURED_CLOTH = """if (parent === window) // the frame of the view has no storage
    localStorage['knitcore.settings'] ??= '{"yarnColours": "fabric"}'"""
"""Cloth in the fabrics' colours, which tests find in a picture; a yarn may be as pale as paper."""


@pytest.fixture(scope="session")
def service(bundle: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Address of a running service, with the data folder of the tests."""
    data = os.environ["KNITCORE_DATA_DIR"]
    with Service(tmp_path_factory.mktemp("service"), data_dir=data) as service:
        yield f"{service.url}/"


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """One Chromium for all tests."""
    if not CHROMIUM.exists():
        pytest.skip("needs Debian's chromium (apt-get install --no-install-recommends chromium)")
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=str(CHROMIUM), args=[*FLAGS, FORCED])
        yield chromium
        chromium.close()


@pytest.fixture(scope="session")
def profile(browser: Browser) -> Iterator[BrowserContext]:
    """A profile that all visitors share: it compiles the page once."""
    context = browser.new_context(viewport={"width": 1280, "height": 720}, reduced_motion="reduce")
    context.set_default_timeout(TIMEOUT_MS)
    context.add_init_script(COLOURED_CLOTH)
    context.new_page()  # keeps Chromium's window, which takes as long to make as the page
    yield context
    context.close()


@pytest.fixture(scope="session")
def visited() -> set[str]:
    """Origins, such as http://127.0.0.1:8738, of which a profile keeps something."""
    return set()


@pytest.fixture
def visitor(profile: BrowserContext, visited: set[str]) -> Iterator[Page]:
    """A page in a browser that keeps nothing of earlier visits; scripts of ours must not fail."""
    page = profile.new_page()
    profile.clear_cookies()
    devtools = profile.new_cdp_session(page)
    for origin in visited:
        everything = {"origin": origin, "storageTypes": "all"}
        devtools.send("Storage.clearDataForOrigin", everything)
    devtools.detach()
    failures: list[str] = []
    page.on("pageerror", lambda error: failures.append(f"{error.message}\n{error.stack}"))
    yield page
    for window in profile.pages[1:]:
        address = urlsplit(window.url)
        if address.scheme == "http":
            visited.add(f"http://{address.netloc}")
        window.close()
    ours = [failure for failure in failures if "/static/" in failure]
    assert not ours, ours


@pytest.fixture
def studio(visitor: Page, service: str) -> Page:
    """The page with a small chart, all knit, ready to be painted."""
    return open_small_chart(visitor, service)


@pytest.fixture
def flat_studio(visitor: Page, service: str) -> Page:
    """The page with a small chart and an empty 3D view."""
    return open_small_chart(flat(visitor), service)


def flat(page: Page) -> Page:
    """The page with an empty 3D view: drawing it without a GPU takes most of a test's time."""
    page.route("**/view/**", lambda route: route.fulfill(body="", content_type="text/html"))
    return page


def second_window(page: Page, address: str) -> Page:
    """Show an address in another window of the same browser, with an empty 3D view."""
    window = flat(page.context.new_page())
    window.goto(address)
    wait_for_numbers(window)
    return window


def open_small_chart(visitor: Page, service: str, chart: str = CHART, **content: object) -> Page:
    """Show a design, by default one of 12 x 10 knits."""
    design = {
        "id": os.urandom(16).hex(),
        "name": "Test",
        "material": "acrylic",
        "chart": chart,
    } | content
    kept = f"localStorage['knitcore.design'] ??= {json.dumps(json.dumps(design))}"
    visitor.add_init_script(
        f"if (parent === window) {kept}"
    )  # the frame of the view has no storage
    visitor.goto(service)
    wait_for_numbers(visitor)
    return visitor


def wait_for_numbers(page: Page) -> None:
    """Until the service's answer to the latest change is on show."""
    page.wait_for_function(
        """() => document.querySelector('#modulus-course .value')?.textContent.match(/\\d/)
             && !document.querySelector('#inspector').classList.contains('busy')"""
    )
