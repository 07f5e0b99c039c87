"""Knitting along, row by row, on a phone."""

import re

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser import axe
from tests.browser.conftest import flat, open_small_chart, wait_for_numbers

CHART = "\n".join(["KKPPKKPPKKPP", "PPKKPPKKPPKK"] * 5)
PHONE = {"width": 390, "height": 844}


def opened(page: Page) -> Page:
    page.keyboard.press("Shift+K")
    expect(page.locator(".along-row")).not_to_be_empty()  # the rows have come
    return page


@pytest.mark.slow
def test_the_row_at_hand_is_large_and_kept(visitor: Page, service: str) -> None:
    page = opened(open_small_chart(flat(visitor), service, CHART))
    page.set_viewport_size(PHONE)
    heading, words = page.locator(".along-row"), page.locator(".along-words")
    expect(heading).to_have_text("Before row 1")
    expect(words).to_contain_text("Cast on 12 sts")
    turned_by_a_finger(page)
    page.keyboard.press("Home")
    expect(heading).to_have_text("Before row 1")
    page.locator("#along-next").click()
    expect(heading).to_have_text("Row 1 of 10")
    expect(page.locator(".along-repeat")).to_have_text("Repeat 1 of 5, row 1 of 2")
    for key, row in (("PageDown", 2), ("ArrowRight", 3), ("PageUp", 2), ("End", None), ("Home", 0)):
        page.keyboard.press(key)
        expected = {None: "After the last row", 0: "Before row 1"}.get(row, f"Row {row} of 10")
        expect(heading).to_have_text(expected)
    page.get_by_label("Go to row").fill("7")
    page.keyboard.press("Tab")
    expect(heading).to_have_text("Row 7 of 10")
    page.get_by_label("Count up").click()
    assert axe.violations_in_both_themes(page, "#along-dialog") == []
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")

    page.locator("#along-dialog select").select_option("brother-ribber")
    expect(heading).to_have_text("Before row 1")  # another way has a place of its own
    expect(words).to_contain_text("ribber")
    page.locator("#along-next").click()
    expect(page.locator(".along-side")).to_contain_text("Carriage at the right")
    page.locator("#along-dialog select").select_option("flat")
    expect(heading).to_have_text("Row 7 of 10")

    page.reload()
    wait_for_numbers(page)
    opened(page)
    expect(heading).to_have_text("Row 7 of 10")
    expect(page.get_by_label("Counted")).to_have_text("1")

    page.route("**/api/v1/**", lambda route: route.abort())  # the service is away
    page.keyboard.press("Escape")
    page.keyboard.press("Shift+K")
    expect(heading).to_have_text("Row 7 of 10")
    page.locator("#along-next").click()
    expect(heading).to_have_text("Row 8 of 10")


def turned_by_a_finger(page: Page) -> None:
    """Turn the rows on a touch screen, from row 0 to row 1."""
    swipe = """([from, to]) => {
        const row = document.querySelector(".along-reading");
        const at = (type, clientX) => row.dispatchEvent(
            new PointerEvent(type, {pointerType: "touch", clientX, clientY: 200, bubbles: true}));
        at("pointerdown", from);
        at("pointerup", to);
    }"""
    for way, row in (((300, 100), 1), ((300, 100), 2), ((300, 280), 2), ((100, 300), 1)):
        page.evaluate(swipe, list(way))
        expect(page.locator(".along-row")).to_have_text(f"Row {row} of 10")


@pytest.mark.slow
def test_another_device_goes_on_at_the_row(visitor: Page, service: str, browser: Browser) -> None:
    page = open_small_chart(flat(visitor), service, CHART)
    make = """async (chart) => {
        const body = JSON.stringify({ name: "Cuff", material: "acrylic", chart });
        const headers = { "Content-Type": "application/json" };
        const answer = await fetch("/api/v1/designs", { method: "POST", headers, body });
        return (await answer.json()).id;
    }"""
    address = f"{service}#design/{page.evaluate(make, CHART)}"
    page.goto(address)
    expect(page.locator(".design-name")).to_have_value("Cuff")
    heading = opened(page).locator(".along-row")
    for _ in range(2):
        with page.expect_response("**/places/flat"):
            page.locator("#along-next").click()
    context = browser.new_context(viewport=PHONE)
    phone = flat(context.new_page())
    phone.goto(address)
    expect(phone.locator(".design-name")).to_have_value("Cuff")
    there = opened(phone).locator(".along-row")
    expect(there).to_have_text("Row 2 of 10")
    expect(phone.locator(".along-main")).to_contain_text("kept with the design")
    with phone.expect_response("**/places/flat"):
        phone.locator("#along-next").click()
    page.evaluate("document.dispatchEvent(new Event('visibilitychange'))")  # looked at again
    expect(heading).to_have_text("Row 3 of 10")
    context.close()


def test_other_stitches_are_drawn_as_they_hang_on_the_needles(visitor: Page, service: str) -> None:
    runs = [
        {"row": 0, "column": 1, "codes": "O/"},
        {"row": 2, "column": 1, "codes": "[2/2R]"},
        {"row": 2, "column": 6, "codes": "VT"},
    ]
    plain = "\n".join(["K" * 12] * 4)
    page = opened(open_small_chart(flat(visitor), service, plain, other_stitches=runs))
    picture = page.locator(".along-picture svg")
    for row, count in ((1, 2), (3, 3)):
        page.get_by_label("Go to row").fill(str(row))
        page.keyboard.press("Tab")
        expect(picture).to_have_attribute("aria-label", re.compile(f", {count} of other kinds"))
        expect(picture.locator("path.sign").first).to_have_attribute("d", re.compile("L"))
    assert axe.violations_in_both_themes(page, "#along-dialog") == []
