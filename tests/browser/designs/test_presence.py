"""Two windows with one design: each knows of the other, and shows its strokes."""

import pytest
from playwright.sync_api import Page, Route, expect

from tests.browser.conftest import flat, second_window, wait_for_numbers
from tests.browser.page import drag

pytestmark = pytest.mark.slow


def test_a_stroke_in_one_window_is_seen_in_the_other_which_nobody_touches(
    flat_studio: Page,
) -> None:
    first = flat_studio
    expect(first.locator("#others")).to_be_hidden()
    drag(first, 60, 0)
    expect(first.locator("#kept")).to_have_attribute("data-state", "kept")
    second = second_window(first, first.url)
    expect(first.locator("#others")).to_contain_text("open in another window")
    expect(second.locator("#others")).to_contain_text("open in another window")
    theirs, ours = (page.locator("#segments-course") for page in (second, first))
    expect(theirs).to_have_text(ours.text_content() or "")
    before = theirs.text_content() or ""
    drag(first, 0, 60, start=(-60, -40))
    expect(theirs).not_to_have_text(before)
    expect(theirs).to_have_text(ours.text_content() or "")

    second.close()
    expect(first.locator("#others")).to_be_hidden()


def test_windows_opened_before_the_first_stroke_share_one_design(flat_studio: Page) -> None:
    first = flat_studio
    second = second_window(first, first.url)
    ours, theirs = (page.locator("#segments-course") for page in (first, second))
    before = ours.text_content() or ""
    drag(first, 60, 0)
    expect(theirs).not_to_have_text(before)
    expect(second.locator("#others")).to_contain_text("open in another window")
    between = ours.text_content() or ""
    drag(second, 0, 60, start=(-60, -40))
    expect(ours).not_to_have_text(between)
    for page in (first, second):
        expect(page.locator("#kept")).to_have_attribute("data-state", "kept")
    expect(ours).to_have_text(theirs.text_content() or "")
    assert first.evaluate("location.hash") == second.evaluate("location.hash") != ""


def test_windows_that_both_paint_before_the_first_delivery_share_one_design(
    flat_studio: Page,
) -> None:
    first = flat_studio
    second = second_window(first, first.url)
    held: list[Route] = []

    def hold(route: Route) -> None:
        held.append(route)

    first.context.route("**/api/v1/designs", hold)
    drag(first, 60, 0)
    drag(second, 0, 60, start=(-60, -40))
    for page in (first, second):
        expect(page.locator("#kept")).to_have_attribute("data-state", "sending")
    segments = [page.locator("#segments-course") for page in (first, second)]
    own_strokes = [shown.text_content() or "" for shown in segments]
    for route in held:
        route.continue_()
    first.context.unroute("**/api/v1/designs")
    for page, shown, own in zip((first, second), segments, own_strokes, strict=True):
        expect(page.locator("#others")).to_contain_text("open in another window")
        expect(shown).not_to_have_text(own)  # the other's stroke has come
        expect(page.locator("#kept")).to_have_attribute("data-state", "kept")
    expect(segments[0]).to_have_text(segments[1].text_content() or "")
    assert first.evaluate("location.hash") == second.evaluate("location.hash") != ""


def test_another_browser_with_the_design_is_told_of_and_its_strokes_are_seen(
    flat_studio: Page,
) -> None:
    first = flat_studio
    drag(first, 60, 0)
    expect(first.locator("#kept")).to_have_attribute("data-state", "kept")
    assert first.context.browser is not None
    elsewhere = first.context.browser.new_context()
    try:
        second = flat(elsewhere.new_page())
        second.goto(first.url)
        wait_for_numbers(second)
        for page in (first, second):
            expect(page.locator("#others")).to_contain_text("open in another window")
        theirs, ours = (page.locator("#segments-course") for page in (second, first))
        before = theirs.text_content() or ""
        drag(first, 0, 60, start=(-60, -40))
        expect(theirs).not_to_have_text(before)
        expect(theirs).to_have_text(ours.text_content() or "")
    finally:
        elsewhere.close()
    expect(first.locator("#others")).to_be_hidden()
