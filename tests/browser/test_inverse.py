"""From a target to a fabric, in the page."""

import re

import pytest
from playwright.sync_api import Page, Route, expect

from knitcore import Fabric, material
from tests.browser.axe import violations
from tests.browser.conftest import CHART, COLUMNS, ROWS, flat, open_small_chart
from tests.browser.page import (
    Chart,
    expect_number,
    held,
    kept_chart,
    middle,
    open_another,
    purls,
    when_held,
)

HALVES = {
    name: [[row, first, COLUMNS // 2] for row in range(ROWS)]
    for name, first in (("soft", 0), ("stiff", COLUMNS // 2))
}


def open_atlas(page: Page) -> None:
    """Show the atlas and wait for its repeats."""
    page.keyboard.press("a")
    page.wait_for_function("() => +document.querySelector('.inverse-plot')?.dataset.count > 50")


@pytest.mark.slow
def test_a_repeat_of_the_atlas_is_shown_applied_and_dragged_onto_the_chart(
    flat_studio: Page,
) -> None:
    open_atlas(flat_studio)
    scatter = flat_studio.locator("#inverse-scatter")
    scatter.focus()
    for _ in range(3):
        flat_studio.keyboard.press("ArrowRight")
    expect(flat_studio.locator("#inverse-detail")).to_contain_text("Along rows")
    expect(flat_studio.locator("#inverse-detail")).to_contain_text("moves between beds")
    flat_studio.click("#atlas-apply")
    filled = kept_chart(flat_studio)
    assert filled != CHART
    flat_studio.keyboard.press("Control+z")
    assert kept_chart(flat_studio) == CHART

    handle = flat_studio.locator(".inverse-chosen .inverse-handle")
    handle.hover(position={"x": 20, "y": 20})
    flat_studio.mouse.down()
    flat_studio.mouse.move(*middle(flat_studio), steps=5)
    expect(flat_studio.locator(".inverse-ghost")).to_contain_text("the whole chart")
    flat_studio.mouse.up()
    assert kept_chart(flat_studio) == filled
    flat_studio.keyboard.press("Escape")


@pytest.mark.slow
def test_a_fabric_is_found_by_its_numbers(flat_studio: Page) -> None:
    flat_studio.keyboard.press("Shift+F")
    values = flat_studio.locator(".target-value")
    garter = material("acrylic").law(Fabric.GARTER)
    values.nth(0).fill(f"{garter.modulus_course:.4f}")
    values.nth(1).fill(f"{garter.modulus_wale:.4f}")
    flat_studio.click("#find-run")
    first = flat_studio.locator(".candidate").first
    expect(first).to_contain_text("garter")
    expect(first).to_contain_text("% chance of meeting")
    assert not violations(flat_studio, "#inverse")
    first.get_by_role("button", name="Fill with garter").click()
    assert len(set(kept_chart(flat_studio).split("\n"))) == 2


def test_a_part_is_made_softer_tried_on_the_chart_and_taken_back(flat_studio: Page) -> None:
    flat_studio.keyboard.press("Shift+W")
    for beside in ("#chart", "#fabric", "#inspector", "#fill-run"):
        expect(flat_studio.locator(beside)).to_be_in_viewport(ratio=1)
    flat_studio.click("#fill-run")
    expect(flat_studio.locator("#panel-fill")).to_contain_text("There is no target")
    flat_studio.click("#part-add")
    now = flat_studio.locator("#part-0-course-now")
    modulus = material("acrylic").law(Fabric.STOCKINETTE).modulus_course
    expect(now).to_have_text(f"{modulus:.3f}")
    flat_studio.select_option("#part-0-like", "much softer")
    expect(flat_studio.locator("#part-0-course")).to_have_value(f"{0.4 * modulus:.3f}")
    expect(flat_studio.locator("#parts")).to_contain_text("2.5 times too stiff")
    rib = material("acrylic").law(Fabric.RIB)
    flat_studio.fill("#part-0-course", f"{rib.modulus_course:.4f}")
    flat_studio.fill("#part-0-wale", f"{rib.modulus_wale:.4f}")
    flat_studio.click("#fill-run")
    expect(flat_studio.locator("#fill-parts")).to_contain_text("Whole chart: as wanted.")
    expect(flat_studio.locator("#fill-answer .good")).to_have_text("On the chart now.")
    expect(flat_studio.locator("#fill-parts")).to_contain_text(f"rows {modulus:.3f} →")
    assert {line[:2] for line in kept_chart(flat_studio).split("\n")} <= {"KP", "PK"}
    expect(flat_studio.locator("#parts")).to_contain_text("as wanted")
    near = 0.9 * rib.modulus_course, 1.1 * rib.modulus_course
    expect_number(flat_studio, "#part-0-course-now", *near)
    assert not violations(flat_studio, "#panel-fill")
    flat_studio.click("#fill-back")
    assert kept_chart(flat_studio) == CHART
    flat_studio.click("#fill-outline")
    assert not violations(flat_studio, "#panel-fill")


def test_a_wish_waits_for_the_numbers_it_goes_by(flat_studio: Page) -> None:
    waiting = held(flat_studio, "**/api/v1/predict")
    flat_studio.keyboard.press("Shift+W")
    flat_studio.click("#part-add")
    flat_studio.select_option("#part-0-like", "much softer")
    expect(flat_studio.locator("#part-0-course-now")).to_have_text("–")
    expect(flat_studio.locator("#part-0-like")).to_have_value("much softer")
    for route in waiting:
        route.continue_()
    modulus = material("acrylic").law(Fabric.STOCKINETTE).modulus_course
    expect(flat_studio.locator("#part-0-course")).to_have_value(f"{0.4 * modulus:.3g}")
    expect(flat_studio.locator("#part-0-like")).to_have_value("")


def fill_softer(page: Page, service: str) -> Route:
    """Begin to fill two halves; only the left one can come nearer. Its end is held back."""
    halves = [
        {"id": f"region-{k}", "name": name, "colour": "#cc4433", "runs": runs}
        for k, (name, runs) in enumerate(HALVES.items())
    ]
    open_small_chart(page, service, regions=halves)
    page.keyboard.press("Shift+W")
    page.click("#part-regions")
    expect(page.locator("#part-1-course-now")).to_have_text(re.compile(r"\d"))
    for at, like in enumerate(("much softer", "much stiffer")):
        page.select_option(f"#part-{at}-like", like)
    waiting = held(page, "**/api/v1/jobs/*/events")
    page.click("#fill-run")
    return when_held(page, waiting)


@pytest.mark.slow
def test_each_part_is_judged_in_a_sentence(visitor: Page, service: str) -> None:
    page = flat(visitor)
    fill_softer(page, service).continue_()
    expect(page.locator("#fill-parts li")).to_have_count(2)
    soft, stiff = page.locator("#fill-parts li").all()
    expect(soft).to_contain_text(re.compile(r"soft: (as wanted\.|nearer, but )"))
    expect(stiff).to_contain_text("stiff: left as it was, 2.5 times too soft along rows and 2.5")
    expect(stiff).to_contain_text(
        "Nothing tried comes 10 % nearer without going away in the other direction. "
        "Nearest in a large cloth: "
    )
    expect(page.locator("#fill-answer .good")).to_have_count(0)
    expect(page.locator("#fill-answer")).to_contain_text("not all parts were changed")


def test_a_fill_ends_with_its_design(visitor: Page, service: str) -> None:
    page = flat(visitor)
    fill_softer(page, service)
    with page.expect_request(lambda sent: sent.method == "DELETE" and "/jobs/" in sent.url):
        open_another(page, service, CHART)
    expect(page.locator("#panel-fill progress").first).to_be_hidden()
    expect(page.locator("#parts")).to_contain_text("Select stitches in the chart")
    assert kept_chart(page) == CHART


@pytest.mark.slow
def test_a_fill_leaves_what_is_painted_meanwhile(visitor: Page, service: str) -> None:
    """Also an unfinished stroke; its numbers are then of another chart."""
    page = flat(visitor)
    end = fill_softer(page, service)
    chart = Chart(page)
    chart.click(5, 2)  # in the part that is left as it was
    page.fill("#part-1-wale", "0.3")
    page.mouse.move(*chart.at(9, 1))
    page.mouse.down()
    end.continue_()
    expect(page.locator("#panel-fill progress").first).to_be_hidden()
    expect(page.locator("#fill-answer")).to_be_empty()
    page.mouse.up()
    answer = page.locator("#fill-answer")
    expect(answer).to_contain_text("On the chart now")
    expect(answer).to_have_attribute("data-stale", "Of the chart before it was changed")
    expect(answer).to_have_js_property("inert", True)
    right = {(row, stitch) for row, stitch in purls(kept_chart(page)) if stitch <= 6}
    assert right == {(5, 2), (9, 1)}
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    assert purls(kept_chart(page)) == {(5, 2)}
    page.keyboard.press("Control+z")
    assert kept_chart(page) == CHART


@pytest.mark.slow
def test_names_in_the_atlas_do_not_cover_each_other(flat_studio: Page) -> None:
    """A 2x2 rib lies just above the 1x1 rib."""
    flat_studio.evaluate(
        """() => {
            const { prototype } = CanvasRenderingContext2D;
            const fill = prototype.fillText;
            window.names = {};
            prototype.fillText = function (text, x, y) {
                window.names[text] = [x, y, this.measureText(text).width];
                fill.call(this, text, x, y);
            };
        }"""
    )
    flat_studio.click("#ink-rib-2-2")
    flat_studio.click("#fill-all")
    expect(flat_studio.locator("#provenance")).to_contain_text("Estimated from simulations")
    open_atlas(flat_studio)
    flat_studio.wait_for_function("() => 'this chart' in window.names")
    (x, y, wide), (x1, y1, wide1) = flat_studio.evaluate(
        "() => [window.names['this chart'], window.names['1×1 rib']]"
    )
    assert abs(y - y1) > 13 or abs(x - x1) > (wide + wide1) / 2


@pytest.mark.slow
def test_how_far_a_fill_is_stays_in_sight_below_many_parts(flat_studio: Page) -> None:
    for slow in ("predict", "jobs/*/events"):
        flat_studio.route(f"**/api/v1/{slow}", lambda route: None)  # its end is never heard
    flat_studio.keyboard.press("Shift+W")
    for _ in range(6):
        flat_studio.click("#part-add")
    flat_studio.select_option("#part-0-like", "much softer")
    flat_studio.click("#fill-run")
    expect(flat_studio.locator(".filling .inverse-run:visible")).to_be_in_viewport()
    flat_studio.fill("#part-0-course", "0.2")
    flat_studio.click("#fill-run")
    expect(flat_studio.locator(".filling .inverse-run:visible")).to_be_in_viewport()
    flat_studio.locator(".filling").get_by_role("button", name="Cancel").click()
    expect(flat_studio.locator(".filling .inverse-run:visible")).to_have_count(0)
