"""Reloads, bad input and an absent service leave the painting alone and say what to do."""

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import CHART, wait_for_numbers
from tests.browser.page import cut_off, drag, kept_chart, sent_view, stretched


def test_a_reload_at_once_after_a_stroke_keeps_painting_and_its_history(flat_studio: Page) -> None:
    drag(flat_studio, 0, 50, start=(-80, -30))
    first = kept_chart(flat_studio)
    drag(flat_studio, 60, 30)
    flat_studio.reload()
    wait_for_numbers(flat_studio)
    assert kept_chart(flat_studio).count("P") > first.count("P") > 0
    for earlier in (first, CHART):
        flat_studio.click("#action-undo")
        assert kept_chart(flat_studio) == earlier


def test_bad_text_is_explained_and_changes_nothing(flat_studio: Page) -> None:
    drag(flat_studio, 60, 30)
    painted = kept_chart(flat_studio)
    flat_studio.click("#action-import")
    flat_studio.fill("#import-text", "KPKX\nKPKP")
    flat_studio.click("#import-apply")
    problem = flat_studio.locator("#import-problem")
    expect(problem).to_be_visible()
    expect(problem).to_contain_text("stitch 4 is 'X'")
    expect(problem).to_contain_text("Write every stitch as K or P")
    assert kept_chart(flat_studio) == painted

    flat_studio.fill("#import-text", "KPK\nPKP")
    flat_studio.keyboard.press("Escape")
    flat_studio.click("#action-import")
    flat_studio.click("#import-apply")
    expect(flat_studio.locator("#import-dialog")).to_be_hidden()
    assert kept_chart(flat_studio) == "KPK\nPKP"
    flat_studio.click("#action-undo")
    assert kept_chart(flat_studio) == painted


def test_a_yarn_that_was_begun_outlasts_its_dialog(flat_studio: Page) -> None:
    for form, field in (("#yarn-new", "#yarn-rib-rows"), ("#yarn-swatch", "#swatch-ball-grams")):
        flat_studio.focus("#chart")
        flat_studio.keyboard.press("Shift+Y")
        flat_studio.click(form)
        flat_studio.fill(field, "31")
        flat_studio.mouse.click(2, 2)  # beside the dialog
        expect(flat_studio.locator("#yarns-dialog")).to_be_hidden()
        flat_studio.focus("#chart")
        flat_studio.keyboard.press("Shift+Y")
        flat_studio.click(form)
        expect(flat_studio.locator(field)).to_have_value("31")
        flat_studio.keyboard.press("Escape")


@pytest.mark.slow
def test_too_much_stretch_names_the_most_that_can_be(flat_studio: Page) -> None:
    flat_studio.fill("#stretch-amount", "390")
    flat_studio.click("#stretch-run")
    note = flat_studio.locator("#stretch-note")
    expect(note).to_contain_text("stitches run out of stretch before that")
    flat_studio.click("#stretch-most")
    expect(flat_studio.locator("#stretch-amount")).not_to_have_value("390")
    assert kept_chart(flat_studio) == CHART


def test_the_cloth_keeps_its_caption_while_the_service_is_unreachable(flat_studio: Page) -> None:
    with sent_view(flat_studio, '"stretch":{'):
        stretched(flat_studio, "20")
    caption = flat_studio.locator(".fabric-caption")
    expect(caption).to_contain_text("by 20 %")
    expect(flat_studio.locator(".fabric[data-sending]")).to_have_count(0)
    cut_off(flat_studio)
    drag(flat_studio, 60, 30)
    expect(flat_studio.locator("#offline")).to_be_visible()
    expect(caption).to_contain_text("by 20 %")


def test_painting_continues_while_the_service_is_unreachable(flat_studio: Page) -> None:
    cut_off(flat_studio)
    before = flat_studio.locator("#chart").bounding_box()
    drag(flat_studio, 60, 30)
    expect(flat_studio.locator("#offline")).to_be_visible()
    flat_studio.click("#stretch-run")
    expect(flat_studio.locator("#stretch-note")).to_contain_text("pull again when it is back")
    said = flat_studio.get_by_text("service cannot be reached").filter(visible=True)
    expect(said).to_have_count(1)
    assert flat_studio.locator("#chart").bounding_box() == before
    drag(flat_studio, 0, 50, start=(-80, -30))
    assert kept_chart(flat_studio).count("P") > 3
    expect(flat_studio.locator("#segments-course")).to_contain_text("odd")

    for path in ("**/api/**", "**/healthz"):
        flat_studio.unroute(path)
    expect(flat_studio.locator("#offline")).to_be_hidden()
    wait_for_numbers(flat_studio)
