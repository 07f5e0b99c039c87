"""The ten main tasks of a designer, without a pointer."""

import pytest
from playwright.sync_api import Page, expect

from knitcore import Fabric, material
from tests.browser.conftest import CHART
from tests.browser.page import expect_number, kept_chart

MAX_TABS = 90


def tab_to(page: Page, selector: str) -> None:
    """Press Tab until an element has the focus, as a person would."""
    for _ in range(MAX_TABS):
        if page.evaluate("selector => document.activeElement.matches(selector)", selector):
            return
        page.keyboard.press("Tab")
    raise AssertionError(f"{selector} is not reached with {MAX_TABS} tabs")


def command(page: Page, words: str) -> None:
    """Choose a command by its name."""
    page.keyboard.press("Control+k")
    expect(page.locator("#command-search")).to_be_focused()
    page.keyboard.type(words)
    first = page.locator("#palette-dialog [role=option]").first
    expect(first).to_contain_text(words, ignore_case=True)
    page.keyboard.press("Enter")
    expect(page.locator("#palette-dialog")).to_be_hidden()


@pytest.mark.slow
def test_ten_tasks_are_done_with_keys_alone(flat_studio: Page) -> None:
    page, keys = flat_studio, flat_studio.keyboard

    # 1 paint a stitch, 2 undo and redo it
    expect(page.locator("#ink-garter")).to_be_visible()
    tab_to(page, "#chart")
    keys.press("ArrowRight")
    keys.press("Enter")
    painted = kept_chart(page)
    assert painted.count("P") == 1
    keys.press("Control+z")
    assert kept_chart(page) == CHART
    keys.press("Control+Shift+Z")
    assert kept_chart(page) == painted

    # 3 fill the chart with a fabric, 4 read its numbers
    command(page, "Garter")
    tab_to(page, "#fill-all")
    keys.press("Enter")
    assert len(set(kept_chart(page).split("\n"))) == 2
    garter = material("acrylic").law(Fabric.GARTER).modulus_course
    expect_number(page, "#modulus-course .value", 0.99 * garter, 1.01 * garter)

    # 5 another yarn, 6 another colouring
    command(page, "Pearl cotton")
    expect(page.locator("#material-button")).to_contain_text("Pearl cotton")
    command(page, "Segments")
    expect(page.locator("#overlay-segments")).to_have_attribute("aria-checked", "true")

    # 7 stretch it and go back to rest
    tab_to(page, "#stretch-amount")
    keys.press("Control+a")
    keys.type("20")
    keys.press("Enter")
    slider = page.locator("#stretch-slider")
    expect(slider).to_be_enabled()
    expect(page.locator("#stretch-figures")).to_contain_text("20 %")
    tab_to(page, "#stretch-slider")
    keys.press("Home")
    expect(page.locator("#stretch-figures")).not_to_contain_text("20 %")

    # 8 keep a version
    keys.press("Control+s")
    tab_to(page, "#version-name")
    keys.type("Garter, tried")
    keys.press("Enter")
    expect(page.locator("#versions-list")).to_contain_text("Garter, tried")
    keys.press("Escape")

    # 9 compare it with another yarn
    page.focus("#chart")
    keys.press("Shift+C")
    expect(
        page.locator("#compare-dialog:not(.busy) #compare-numbers tbody tr").first
    ).to_be_visible()
    tab_to(page, "#compare-b-yarn")
    keys.type("Worsted")
    expect(page.locator("#compare-numbers tbody tr").first).not_to_contain_text("the same")
    keys.press("Escape")

    # 10 make the pattern to knit from
    keys.press("Control+e")
    tab_to(page, "#export-make")
    with page.expect_download() as download:
        keys.press("Enter")
    assert download.value.suggested_filename == "Test pattern.pdf"
    keys.press("Escape")
    expect(page.locator("dialog[open]")).to_have_count(0)
