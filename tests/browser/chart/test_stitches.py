"""Lace, cables and slips: painted, mended, predicted, kept and undone."""

from playwright.sync_api import Page, expect

from tests.browser.conftest import CHART, wait_for_numbers
from tests.browser.page import Chart, kept_chart, kept_design


def test_an_eyelet_is_painted_mended_predicted_kept_and_undone(flat_studio: Page) -> None:
    page, chart = flat_studio, Chart(flat_studio)
    page.keyboard.press("c")
    page.fill("#stitch-search", "yo")
    expect(page.locator(".stitch")).to_have_count(1)
    page.click("#stitch-O")
    chart.look()  # the panel has moved it
    chart.click(3, 5)
    expect(page.locator("#balance-words")).to_contain_text(
        "Row 3 takes 11 stitches, row 2 has 12: a yarn over too many."
    )
    expect(page.locator("#inspector .problem")).to_contain_text("cannot be knitted yet")
    page.click("#balance-remedy-1")
    expect(page.locator("#balance")).to_be_hidden()
    wait_for_numbers(page)
    expect(page.locator("#other-stitches")).to_contain_text("yarn overs")
    page.mouse.move(*chart.at(3, 5))
    expect(page.locator("#readout")).to_contain_text("yarn over (yo): makes a hole, 1 stitch more")
    kept = kept_design(page)["other_stitches"]
    assert "".join(run["codes"] for run in kept) in ("O\\", "/O")

    page.reload()
    wait_for_numbers(page)
    assert kept_design(page)["other_stitches"] == kept
    expect(page.locator("#other-stitches")).to_contain_text("yarn overs")
    page.click("#action-undo")
    expect(page.locator("#balance")).to_be_visible()
    page.click("#action-undo")
    expect(page.locator("#balance")).to_be_hidden()
    assert kept_chart(page) == CHART
    assert kept_design(page)["other_stitches"] == []


def test_a_motif_is_stamped_as_one_step_and_painted_over_whole(flat_studio: Page) -> None:
    page, chart = flat_studio, Chart(flat_studio)
    page.click("#open-stitches")
    page.fill("#stitch-search", "rope 2/2 right")
    page.click(".motif")
    chart.look()
    chart.click(2, 10)
    codes = [run["codes"] for run in kept_design(page)["other_stitches"]]
    assert codes == ["[2/2R]"]
    expect(page.locator("#balance")).to_be_hidden()
    page.keyboard.press("Shift+H")  # the whole chart mirrored
    assert [run["codes"] for run in kept_design(page)["other_stitches"]] == ["[2/2L]"]
    page.click("#action-undo")
    page.keyboard.press("b")
    page.click("#ink-purl")
    chart.click(2, 8)
    assert kept_design(page)["other_stitches"] == []
    page.click("#action-undo")
    page.click("#action-undo")
    assert kept_chart(page) == CHART
