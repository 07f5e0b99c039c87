"""Every result on the page belongs to what it was made for, and says so when that is gone."""

import json
import re
from collections.abc import Callable
from dataclasses import replace

import pytest
from playwright.sync_api import Page, expect

from knitcore.materials import material
from knitcore.materials.material_document import MaterialDocument
from tests.browser.conftest import flat, open_small_chart, wait_for_numbers
from tests.browser.page import (
    Chart,
    cut_off,
    drop,
    expect_number,
    held,
    keep_version,
    kept_design,
    open_another,
    sent_view,
    settle,
    stretched,
    when_held,
)

RIBBED = "\n".join(["KPKPKPKPKPKP"] * 10)
OF_THE_CHART = {"stretch", "numbers", "rigidity", "curve", "limb", "drape", "fabric", "fill"}
OF_THE_YARN = ("atlas", "find", "outline")
RESULTS = OF_THE_CHART | {*OF_THE_YARN}
"""All parts of the page beside dialogs that show what somebody computed; a new one belongs here."""

STATES = """() => Object.fromEntries([...document.querySelectorAll("[data-result]")].map((shown) =>
{
    const { result, stale } = shown.dataset;
    const own = shown.data?.find(({ name }) => name.startsWith("this "));
    const values = [...shown.querySelectorAll(".value")].map((value) => value.textContent).join("");
    const text = result === "numbers" ? values : shown.textContent;
    const drawn = { rigidity: ".own-dot", atlas: "[data-count]:not([data-count='0'])" }[result];
    const empty = own ? !own.x.length : drawn ? !shown.querySelector(drawn) : !/\\d/.test(text);
    return [result, stale ?? (empty ? "empty" : "current")];
}))"""


def expect_stale(page: Page, why: str, *results: str) -> None:
    """Until results say why they do not count."""
    for result in results:
        expect(page.locator(f"[data-result={result}]")).to_have_attribute("data-stale", why)


def wait_until(page: Page, state: str, but: tuple[str, ...] = ()) -> None:
    """Until all results are, or none is, current."""
    page.wait_for_function(
        f"([state, but]) => Object.entries(({STATES})()).every(([name, words]) => "
        "but.includes(name) || (state === 'current') === (words === 'current'))",
        arg=[state, list(but)],
    )


@pytest.mark.slow
def test_no_result_outlives_what_it_was_made_for(visitor: Page, service: str) -> None:
    page = open_small_chart(flat(visitor), service, RIBBED)
    page.keyboard.press("Shift+W")
    page.click("#part-add")
    page.select_option("#part-0-like", "stockinette")
    page.click("#fill-run")
    expect(page.locator("#fill-answer")).to_contain_text("On the chart now")
    page.click("#fill-outline")
    page.fill("#outline-strain", "20")
    page.click("#outline-run")
    expect(page.locator("#outline-apply")).to_be_visible()
    page.keyboard.press("Shift+F")
    page.click("#find-run")
    expect(page.locator("#find-answer .candidate").first).to_be_visible()
    page.click("#inverse-atlas")
    page.locator("#inverse-scatter").focus()
    wait_for_atlas(page)
    page.keyboard.press("ArrowRight")
    page.click("#inverse-close")
    page.click("#tab-drape")
    page.click("#drape-overhang")
    expect(page.locator("#drape-answer")).to_contain_text("Bending length")
    page.click("#fabric-flat")
    page.click("#tab-limb")
    expect(page.locator("#limb-answer")).to_contain_text("mmHg")
    with sent_view(page, '"stretch":{'):
        stretched(page, "10")
    names = f"Object.keys(({STATES})()).sort().join()"
    page.wait_for_function(f"names => {names} === names", arg=",".join(sorted(RESULTS)))
    wait_until(page, "current")

    # From here on nothing can be made again.
    cut_off(page)
    page.mouse.click(*Chart(page).at(5, 5))
    wait_until(page, "stale", OF_THE_YARN)
    expect_stale(page, "Of the chart before it was changed", "drape")
    expect(page.locator(".fabric-caption")).to_contain_text("before the change")
    page.keyboard.press("Control+z")
    asked_anew = ("numbers", "rigidity", "fabric", "curve", "limb")
    wait_until(page, "current", asked_anew)
    page.click("#material-button")
    page.locator("[role=menuitemradio][aria-checked=false]:enabled").first.click()
    wait_until(page, "stale")
    expect_stale(page, "With another yarn", "drape", "find", "atlas")
    for barred in ("fill", "find", "outline"):
        expect(page.locator(f"#{barred}-answer")).to_have_js_property("inert", True)
    page.keyboard.press("Control+a")
    wait_until(page, "stale")


def wait_for_atlas(page: Page) -> None:
    """Until the dots of an atlas are there."""
    page.wait_for_function("() => +document.querySelector('.inverse-plot')?.dataset.count > 50")


@pytest.mark.slow
def test_numbers_come_with_the_title_of_their_part(visitor: Page, service: str) -> None:
    """Also where one region is chosen after another."""
    parts = [("Wide", [[0, 0, 9]]), ("High", [[row, 0, 2] for row in range(8)])]
    regions = [
        {"id": name, "name": name, "colour": "#cc4433", "runs": runs} for name, runs in parts
    ]
    page = open_small_chart(flat(visitor), service, RIBBED, regions=regions)
    head, width = page.locator("#inspector h2"), page.locator("#size-course .value")
    page.select_option("#inspector-scope", "Wide")
    expect(head).to_have_text("Wide 9 × 1")
    wide = width.inner_text()
    waiting = held(page, "**/api/v1/predict")
    page.select_option("#inspector-scope", "High")
    when_held(page, waiting)
    expect_stale(page, "Of another part of the chart", "numbers", "rigidity")
    expect(head).to_have_text("Wide 9 × 1")
    expect(width).to_have_text(wide)
    for route in waiting:
        route.continue_()
    expect(head).to_have_text("High 2 × 8")
    expect_number(page, "#size-course .value", 0.0, 0.5 * float(wide))
    wait_until(page, "current", tuple(RESULTS - {"numbers", "rigidity"}))


@pytest.mark.slow
def test_the_atlas_of_the_yarn_before_is_not_of_the_yarn_now(flat_studio: Page) -> None:
    page = flat_studio
    page.keyboard.press("a")
    wait_for_atlas(page)
    page.locator("#inverse-scatter").focus()
    page.keyboard.press("ArrowRight")
    waiting = held(page, "**/api/v1/jobs/*/events")
    page.click("#material-button")
    page.locator("[role=menuitemradio][aria-checked=false]:enabled").first.click()
    atlas = page.locator("[data-result=atlas]")
    expect(atlas).to_have_attribute("data-stale", "With another yarn")
    expect(atlas).to_have_js_property("inert", True)
    when_held(page, waiting).continue_()
    expect(atlas).not_to_have_attribute("data-stale", re.compile(""))
    expect(page.locator("#atlas-apply")).to_have_count(0)


@pytest.mark.slow
def test_no_picture_is_taken_of_the_cloth_before_a_change(flat_studio: Page) -> None:
    page, chart = flat_studio, Chart(flat_studio)
    with sent_view(page):
        chart.click(5, 5)
    settle(page)
    held(page, "**/api/v1/views/**")
    chart.click(3, 3)
    page.click("#fabric-share-button")
    page.click("#share-picture")
    expect(page.locator("#messages")).to_contain_text("The cloth is being made anew")


def paste(page: Page) -> None:
    page.evaluate(
        """() => {
            const data = new DataTransfer();
            data.setData("text/plain", "KPKP\\nPKPK");
            dispatchEvent(new ClipboardEvent("paste", { clipboardData: data, cancelable: true }));
        }"""
    )


def add_a_yarn(page: Page) -> None:
    mine = replace(material("acrylic"), identifier="late", name="Late")
    document = MaterialDocument.from_material(mine).model_dump(mode="json")
    drop(page, "late.json", "application/json", json.dumps(document).encode())


def hang_over_an_edge(page: Page) -> None:
    page.click("#tab-drape")
    page.click("#drape-overhang")


def restore(page: Page) -> None:
    page.mouse.click(*Chart(page).at(5, 5))
    keep_version(page, "Before")
    page.get_by_role("button", name="Restore Before").click()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("begin", "path"),
    [
        (paste, "**/api/v1/import"),
        (add_a_yarn, "**/api/v1/materials"),
        (hang_over_an_edge, "**/api/v1/overhang"),
        (restore, "**/versions/*/restore"),
    ],
)
def test_what_comes_late_does_not_touch_another_design(
    visitor: Page, service: str, begin: Callable[[Page], None], path: str
) -> None:
    page = open_small_chart(flat(visitor), service)
    waiting = held(page, path)
    begin(page)
    when_held(page, waiting)
    open_another(page, service, RIBBED)
    wait_for_numbers(page)
    page.unroute(path)
    for route in waiting:
        with page.expect_response(route.request.url):
            route.continue_()
    page.wait_for_load_state("networkidle")
    settle(page)
    another = kept_design(page)
    assert (another["name"], another["chart"]) == ("Another", RIBBED)
    assert another["material"] == "acrylic"
    expect(page.locator("#fabric-flat")).to_have_attribute("aria-checked", "true")


@pytest.mark.slow
def test_another_design_begins_without_what_the_one_before_left(flat_studio: Page) -> None:
    stretched(flat_studio)
    caption = flat_studio.locator(".fabric-caption")
    expect(caption).to_contain_text("Stretched")
    flat_studio.click("#fabric-colours-button")
    flat_studio.click("#yarn-chart")
    legend = flat_studio.locator("#fabric-legend")
    expect(legend).to_contain_text("Stretch along the columns")
    flat_studio.focus("#chart")
    flat_studio.keyboard.press("Shift+N")
    flat_studio.click("#gallery-seed")
    expect(caption).to_contain_text("Relaxed, pinned flat")
    expect(legend).to_have_count(0)
    expect(flat_studio.locator("[data-result=stretch]")).not_to_have_attribute(
        "data-stale", re.compile(".")
    )


@pytest.mark.slow
def test_a_garment_that_cannot_be_planned_leaves_no_plan(flat_studio: Page) -> None:
    page = flat_studio
    page.keyboard.press("Control+Shift+G")
    expect(page.locator("#planner-facts")).to_contain_text("stitches")
    page.fill("[aria-label='Around the wrist']", "1")
    expect(page.locator("#planner-dialog .problem")).to_contain_text("cannot be planned")
    expect(page.locator("#planner-facts")).to_be_empty()
    expect(page.locator("#planner-preview")).to_be_hidden()
    expect(page.locator("#planner-make")).to_be_disabled()
