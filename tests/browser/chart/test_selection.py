"""Selections: made, combined, moved, copied, turned; rows and columns."""

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import CHART
from tests.browser.page import Chart, block, kept_chart, kept_design, purls


@pytest.mark.slow
def test_selections_are_combined_with_keys(flat_studio: Page) -> None:
    chart = Chart(flat_studio)
    bar = flat_studio.locator("#selection-bar")
    flat_studio.click("#tool-select")
    chart.drag((1, 1), (4, 4))
    expect(bar).to_contain_text("4 × 4")
    flat_studio.keyboard.down("Shift")
    chart.drag((6, 6), (7, 7))
    flat_studio.keyboard.up("Shift")
    expect(bar).to_contain_text("20 sts")
    flat_studio.keyboard.down("Alt")
    chart.drag((1, 1), (2, 4))
    flat_studio.keyboard.up("Alt")
    expect(bar).to_contain_text("12 sts")
    flat_studio.click("#tool-lasso")
    flat_studio.keyboard.down("Shift")
    flat_studio.keyboard.down("Alt")
    chart.drag((3, 1), (3, 4), (5, 4), (5, 1), (3, 1))
    flat_studio.keyboard.up("Alt")
    flat_studio.keyboard.up("Shift")
    expect(bar).to_contain_text("4 × 2")
    chart.click(9, 9)
    expect(bar).to_be_hidden()
    flat_studio.click("#tool-wand")
    chart.click(9, 9)
    expect(bar).to_contain_text("12 × 10")


def test_what_is_selected_and_whole_rows_and_columns_are_moved_and_all_undone(
    flat_studio: Page,
) -> None:
    """They are copied, turned, inserted and deleted, too; resizing keeps the chosen corner."""
    chart = Chart(flat_studio)
    flat_studio.click("#ink-purl")
    chart.drag((2, 2), (2, 4))
    flat_studio.click("#tool-select")
    chart.drag((2, 2), (3, 4))
    flat_studio.keyboard.press("Shift+M")
    chart.drag((2, 3), (6, 5))
    assert purls(kept_chart(flat_studio)) == block((6, 6), (4, 6))
    flat_studio.keyboard.press("ArrowDown")
    assert purls(kept_chart(flat_studio)) == block((5, 5), (4, 6))
    flat_studio.keyboard.press("Control+c")
    flat_studio.mouse.move(*chart.at(9, 12))
    expect(flat_studio.locator("#readout")).to_contain_text("Row 9 RS, stitch 12")
    flat_studio.keyboard.press("Control+v")
    assert purls(kept_chart(flat_studio)) == block((5, 5), (4, 6)) | block((9, 9), (10, 12))
    flat_studio.click("#selection-flip")
    assert block((10, 10), (10, 12)) < purls(kept_chart(flat_studio))
    flat_studio.click("#selection-cut")
    assert purls(kept_chart(flat_studio)) == block((5, 5), (4, 6))
    for _ in range(6):
        flat_studio.keyboard.press("Control+z")
    assert kept_chart(flat_studio) == CHART

    flat_studio.keyboard.press("Escape")
    flat_studio.click("#tool-pencil")
    chart.look()
    chart.drag((3, 1), (3, 12))
    flat_studio.click("#tool-select")
    chart.drag((3, 1), (4, 2))
    flat_studio.click("#selection-insert-row-above")
    assert len(kept_chart(flat_studio).splitlines()) == 12
    flat_studio.click("#selection-delete-columns")
    assert purls(kept_chart(flat_studio)) == block((3, 3), (1, 10))
    expect(flat_studio.locator("#chart-size")).to_contain_text("10 × 12")
    for _ in range(3):
        flat_studio.keyboard.press("Control+z")
    assert kept_chart(flat_studio) == CHART

    flat_studio.keyboard.press("Escape")
    flat_studio.click("#tool-pencil")
    chart.look()
    chart.click(10, 1)
    flat_studio.click("#chart-size")
    flat_studio.fill("#new-columns", "14")
    flat_studio.fill("#new-rows", "11")
    flat_studio.check("#anchor-top-right")
    flat_studio.click("#resize-apply")
    assert purls(kept_chart(flat_studio)) == {(11, 1)}


@pytest.mark.slow
def test_own_patterns_stay_in_the_design_and_in_the_browser(flat_studio: Page) -> None:
    chart = Chart(flat_studio)
    flat_studio.click("#ink-purl")
    chart.click(2, 2)
    flat_studio.click("#tool-select")
    chart.drag((2, 2), (3, 3))
    flat_studio.click("#selection-keep-pattern")
    chart.click(6, 6)
    assert (6, 5) in purls(kept_chart(flat_studio))
    assert kept_design(flat_studio)["shelf"] == [{"name": "Mine 1", "motif": "KK/KP"}]
    flat_studio.reload()
    own = flat_studio.get_by_role("radio", name="Mine 1")
    own.click()
    flat_studio.click("#shelf-remove")
    expect(own).to_have_count(0)
    assert kept_design(flat_studio)["shelf"] == []
