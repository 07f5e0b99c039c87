"""Regions and linked repeats."""

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import CHART
from tests.browser.page import Chart, block, keep_messages, kept_chart, kept_design, purls


def test_a_region_is_made_filled_painted_locked_and_undone(flat_studio: Page) -> None:
    chart = Chart(flat_studio)
    flat_studio.click("#tool-select")
    chart.drag((1, 1), (4, 4))
    flat_studio.click("#selection-make-region")
    panel = flat_studio.locator("#panel-regions")
    expect(panel).to_contain_text("16 sts")
    flat_studio.fill("#region-1-name", "Cuff")
    flat_studio.keyboard.press("Enter")
    flat_studio.select_option("#region-1-fill", label="Garter")
    garter = {(r, s) for r, s in block((1, 4), (1, 4)) if r % 2 == 0}
    assert purls(kept_chart(flat_studio)) == garter

    chart.look()
    flat_studio.click("#region-1-paint")
    flat_studio.click("#tool-pencil")
    chart.drag((2, 5), (2, 6))
    expect(panel).to_contain_text("18 sts")
    assert purls(kept_chart(flat_studio)) == garter | {(2, 5), (2, 6)}, "the fill grows along"

    keep_messages(flat_studio)
    flat_studio.click("#region-1-lock")
    flat_studio.click("#ink-purl")
    chart.drag((1, 3), (1, 7))
    assert purls(kept_chart(flat_studio)) == garter | {(2, 5), (2, 6), (1, 5), (1, 6), (1, 7)}
    expect(flat_studio.locator("#messages")).to_contain_text("Locked: Cuff")

    region = kept_design(flat_studio)["regions"][0]
    assert (region["name"], region["fill"], region["locked"]) == ("Cuff", "P/K", True)
    flat_studio.reload()
    for _ in range(6):
        flat_studio.click("#action-undo")
    design = kept_design(flat_studio)
    assert (design["regions"], design["chart"]) == ([], CHART)


def test_regions_are_ordered_hidden_and_removed(flat_studio: Page) -> None:
    flat_studio.click("#open-regions")
    panel = flat_studio.locator("#panel-regions")
    expect(panel).to_contain_text("Regions name parts")
    flat_studio.click("#region-new")
    flat_studio.click("#region-new")
    flat_studio.click("#region-2-down")
    assert [r["name"] for r in kept_design(flat_studio)["regions"]] == ["Region 2", "Region 1"]
    flat_studio.click("#region-2-hide")
    assert kept_design(flat_studio)["regions"][0]["hidden"]
    flat_studio.click("#region-2-remove")
    assert [r["name"] for r in kept_design(flat_studio)["regions"]] == ["Region 1"]
    expect(panel.locator(".part")).to_have_count(1)


@pytest.mark.slow
def test_copies_of_a_repeat_follow_each_other(flat_studio: Page) -> None:
    chart = Chart(flat_studio)
    flat_studio.click("#ink-purl")
    chart.click(1, 1)
    flat_studio.click("#tool-select")
    chart.drag((1, 1), (2, 3))
    flat_studio.click("#selection-make-repeat")
    panel = flat_studio.locator("#panel-repeats")
    expect(panel).to_contain_text("ultiple of 3 sts × 2 rows")
    chart.look()
    chart.drag((5, 12), (8, 7))
    copies = {(5, 7), (5, 10), (7, 7), (7, 10)}
    assert purls(kept_chart(flat_studio)) == copies | {(1, 1)}

    flat_studio.click("#tool-pencil")
    chart.click(6, 9)
    followed = {(r + 1, s + 2) for r, s in copies | {(1, 1)}}
    assert purls(kept_chart(flat_studio)) == copies | {(1, 1)} | followed
    assert kept_design(flat_studio)["repeats"][0]["motif"] == "PKK/KKP"

    flat_studio.click("#repeat-1-1-columns-less")
    flat_studio.click("#repeat-1-0-unlink")
    chart.click(1, 2)
    assert (5, 8) not in purls(kept_chart(flat_studio)), "unlinked"
    places = kept_design(flat_studio)["repeats"][0]["placements"]
    assert places == [{"row": 4, "column": 0, "rows": 4, "columns": 3}]

    flat_studio.reload()
    for _ in range(7):
        flat_studio.click("#action-undo")
    design = kept_design(flat_studio)
    assert (design["repeats"], design["chart"]) == ([], CHART)


@pytest.mark.slow
def test_a_chart_filled_with_a_repeat_grows_by_whole_motifs(flat_studio: Page) -> None:
    chart = Chart(flat_studio)
    flat_studio.click("#ink-purl")
    chart.click(1, 12)
    flat_studio.click("#tool-select")
    chart.drag((1, 12), (1, 9))
    flat_studio.click("#selection-make-repeat")
    flat_studio.click("#repeat-1-fill")
    assert kept_chart(flat_studio).splitlines()[0] == "PKKK" * 3
    assert len(kept_design(flat_studio)["repeats"][0]["placements"]) == 1, "the first is covered"
    flat_studio.click("#chart-size")
    flat_studio.fill("#new-columns", "15")
    flat_studio.get_by_role("button", name="Keep it whole: 16 × 10").click()
    flat_studio.click("#resize-apply")
    assert kept_chart(flat_studio).splitlines()[0] == "PKKK" * 4
    assert kept_design(flat_studio)["repeats"][0]["placements"][0]["columns"] == 16
