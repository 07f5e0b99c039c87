"""Every result on the page belongs to what it was made for, and says so when that is gone."""

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import flat, open_small_chart
from tests.browser.page import Chart, cut_off, sent_view, stretched

RIBBED = "\n".join(["KPKPKPKPKPKP"] * 10)
RESULTS = {"stretch", "numbers", "curve", "limb", "drape", "fabric", "fill", "find", "outline"}
"""All parts of the page beside dialogs that show what somebody computed; a new one belongs here."""

STATES = """() => Object.fromEntries([...document.querySelectorAll("[data-result]")].map((shown) =>
{
    const { result, stale } = shown.dataset;
    const own = shown.data?.find(({ name }) => name.startsWith("this "));
    const values = [...shown.querySelectorAll(".value")].map((value) => value.textContent).join("");
    const text = result === "numbers" ? values : shown.textContent;
    const empty = own ? !own.x.length : !/\\d/.test(text);
    return [result, stale ?? (empty ? "empty" : "current")];
}))"""


def results(page: Page) -> dict[str, str]:
    """Read why each result does not count, or that it is empty or current."""
    states = page.evaluate(STATES)
    assert isinstance(states, dict)
    return states


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
    page.click("#inverse-close")
    page.click("#tab-drape")
    page.click("#drape-overhang")
    expect(page.locator("#drape-answer")).to_contain_text("Bending length")
    page.click("#fabric-flat")
    page.click("#tab-limb")
    expect(page.locator("#limb-answer")).to_contain_text("mmHg")
    with sent_view(page, '"stretch":{'):
        stretched(page, "10")
    assert set(results(page)) == RESULTS
    wait_until(page, "current")

    # From here on nothing can be made again.
    cut_off(page)
    page.mouse.click(*Chart(page).at(5, 5))
    wait_until(page, "stale", ("find", "outline"))  # of the yarn, not of the chart
    assert results(page)["drape"] == "Of the chart before it was changed"
    expect(page.locator(".fabric-caption")).to_contain_text("before the change")
    page.keyboard.press("Control+z")
    wait_until(page, "current", ("numbers", "fabric", "curve", "limb"))  # asked anew
    page.click("#material-button")
    page.locator("[role=menuitemradio][aria-checked=false]:enabled").first.click()
    wait_until(page, "stale")
    assert results(page)["drape"] == results(page)["find"] == "With another yarn"
    page.keyboard.press("Control+a")
    wait_until(page, "stale")


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
