"""On a tablet, 1024 x 768: nothing is cut off, and what needs scrolling shows that it is there."""

from typing import Literal

import pytest
from playwright.sync_api import Page, ViewportSize, expect

from tests.browser.page import Chart, keep_messages, settle

pytestmark = pytest.mark.slow

TABLET: ViewportSize = {"width": 1024, "height": 768}
AXES: tuple[tuple[Literal["x", "y"], Literal["width", "height"]], ...] = (
    ("x", "width"),
    ("y", "height"),
)
ROUNDING_PX = 0.5


def inside(page: Page, part: str, whole: str) -> bool:
    """Return whether a part lies within another on the screen, horizontally and vertically."""
    inner, outer = page.locator(part).bounding_box(), page.locator(whole).bounding_box()
    assert inner
    assert outer
    return all(
        inner[at] >= outer[at] - ROUNDING_PX
        and inner[at] + inner[size] <= outer[at] + outer[size] + ROUNDING_PX
        for at, size in AXES
    )


def comes_inside(page: Page, part: str, whole: str) -> bool:
    """Return whether a part comes to lie within another in a minute."""
    for _ in range(600):
        if inside(page, part, whole):
            return True
        page.wait_for_timeout(100)
    return False


@pytest.mark.parametrize("dock", [False, True])
def test_all_buttons_of_a_selection_fit(flat_studio: Page, dock: bool) -> None:
    if dock:
        flat_studio.click("#open-regions")
        expect(flat_studio.locator("#panel-regions")).to_be_visible()
    flat_studio.keyboard.press("Control+a")
    expect(flat_studio.locator("#selection-bar")).to_be_visible()
    for width in (1024, 1100, 1280, 1400, 1550):
        flat_studio.set_viewport_size({"width": width, "height": 768})
        settle(flat_studio)
        assert comes_inside(flat_studio, "#selection-bar", "#chart-host"), width
        flat_studio.wait_for_function(
            """() => {
                const [key, bar] = [".chart-key", "#selection-bar"].map((part) =>
                    document.querySelector(part).getBoundingClientRect());
                return key.width === 0 || key.right <= bar.left;
            }"""
        )


def test_the_plots_are_one_click_away(flat_studio: Page) -> None:
    flat_studio.set_viewport_size(TABLET)
    flat_studio.click("#open-regions")
    expect(flat_studio.locator("#panel-regions")).to_be_visible()
    assert comes_inside(flat_studio, "#tab-rigidity", "#inspector")
    assert not inside(flat_studio, "#plot-rigidity", "#inspector")
    flat_studio.click("#tab-rigidity")
    assert comes_inside(flat_studio, "#plot-rigidity", "#inspector")
    flat_studio.click("#tab-curve")
    assert comes_inside(flat_studio, "#plot-curve", "#inspector")
    assert comes_inside(flat_studio, ".curve-pulls", "#plot-curve")
    assert comes_inside(flat_studio, "#tab-curve", "#inspector")


def test_a_verb_in_a_sentence_breaks_with_its_line(flat_studio: Page) -> None:
    """Its first words begin the line, and the rest of the sentence goes on beside its last ones."""
    flat_studio.click("#provenance")
    for width in (390, 820, 1280):
        flat_studio.set_viewport_size({"width": width, "height": 844})
        settle(flat_studio)
        lines = flat_studio.locator("#narrower .link").evaluate_all(
            """(links) => links.map((link) => {
                const rest = document.createRange();
                rest.setStart(link.nextSibling, 0);
                rest.setEnd(link.nextSibling, 1);
                const [words, box] = [[...link.getClientRects()], link.parentElement];
                return [words[0].left - box.getBoundingClientRect().left,
                        rest.getBoundingClientRect().top - words.at(-1).top];
            })"""
        )
        assert lines
        assert all(abs(start) < 1 and abs(below) < 1 for start, below in lines), width


def test_the_readout_is_whole_and_the_chart_keeps_still(flat_studio: Page) -> None:
    flat_studio.set_viewport_size(TABLET)
    settle(flat_studio)
    before = flat_studio.locator("#chart").bounding_box()
    chart = Chart(flat_studio)
    flat_studio.mouse.move(*chart.at(10, 12))
    readout = flat_studio.locator("#readout")
    expect(readout).to_contain_text("N/mm")
    assert readout.evaluate(
        "({ scrollWidth: w, clientWidth: W, scrollHeight: h, clientHeight: H }) => w <= W && h <= H"
    )
    assert flat_studio.locator("#chart").bounding_box() == before


def test_messages_cover_neither_stitches_nor_a_dock(flat_studio: Page) -> None:
    keep_messages(flat_studio)
    flat_studio.keyboard.press("Control+a")
    flat_studio.click("#selection-make-repeat")
    expect(flat_studio.locator(".message")).to_be_visible()
    assert comes_inside(flat_studio, ".message", "#overlays")


def test_the_label_in_the_stiffness_map_stays_off_the_axis(flat_studio: Page) -> None:
    chart = Chart(flat_studio)
    flat_studio.click("#ink-purl")
    chart.drag((4, 10), (2, 10), (2, 8))
    flat_studio.click("#tool-select")
    chart.drag((2, 10), (4, 8))
    expect(flat_studio.locator(".own-label")).to_have_text("this selection")
    flat_studio.wait_for_function(
        """() => {
            const plot = document.querySelector("#plot-rigidity");
            const label = plot.querySelector(".own-label").getBoundingClientRect();
            return [...plot.querySelectorAll(".axis, .tick.end")].every((other) => {
                const { right, top, bottom } = other.getBoundingClientRect();
                return right <= label.left || bottom <= label.top || top >= label.bottom;
            });
        }"""
    )
