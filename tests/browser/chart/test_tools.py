"""Every tool of the chart, on both sides of the cloth, and back to the start."""

import re

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import CHART
from tests.browser.page import Chart, block, kept_chart, kept_design, purls


def test_every_tool_paints_and_keeps_symmetry_and_all_is_undone(flat_studio: Page) -> None:
    chart = Chart(flat_studio)
    flat_studio.click("#ink-purl")
    painted = [
        ("pencil", {(2, 2), (2, 3), (2, 4)}),
        ("line", {(4, 2), (5, 3), (6, 4)}),
        ("rectangle", block((2, 4), (6, 8))),
        ("ellipse", block((6, 8), (7, 9))),
    ]
    paths = {
        "pencil": [(2, 2), (2, 4)],
        "line": [(4, 2), (6, 4)],
        "rectangle": [(2, 6), (4, 8)],
        "ellipse": [(6, 7), (8, 9)],
    }
    drawn: set[tuple[int, int]] = set()
    for tool, cells in painted:
        flat_studio.click(f"#tool-{tool}")
        chart.drag(*paths[tool])
        after = purls(kept_chart(flat_studio))
        if tool == "ellipse":  # its corners may be left out
            assert drawn < after <= drawn | cells
        else:
            assert after == drawn | cells, tool
        drawn = after
    flat_studio.click("#tool-stamp")
    chart.click(10, 12)
    flat_studio.click("#tool-fill")
    chart.click(1, 1)
    assert len(purls(kept_chart(flat_studio))) == 120
    for _ in range(6):
        flat_studio.click("#action-undo")
    assert kept_chart(flat_studio) == CHART
    expect(flat_studio.locator("#action-undo")).to_be_disabled()

    chart.look()
    for _ in range(3):
        flat_studio.keyboard.press("y")
    for tool, path in (
        ("pencil", [(1, 1), (1, 2)]),
        ("line", [(2, 3), (4, 3)]),
        ("rectangle", [(3, 5), (4, 6)]),
        ("ellipse", [(1, 4), (2, 5)]),
    ):
        flat_studio.click(f"#tool-{tool}")
        chart.drag(*path)
        lines = kept_chart(flat_studio).splitlines()
        assert lines == lines[::-1] == [line[::-1] for line in lines], tool
    flat_studio.click("#tool-select")
    chart.drag((1, 1), (2, 2))
    expect(flat_studio.locator("#selection-bar")).to_contain_text("16 sts")


def test_the_back_is_mirrored_and_painting_it_paints_the_face(flat_studio: Page) -> None:
    chart = Chart(flat_studio)
    face = chart.at(1, 1)
    flat_studio.click("#choose-back")
    chart.look()
    assert chart.at(1, 12)[0] == pytest.approx(face[0], abs=3)
    flat_studio.click("#tool-pencil")
    flat_studio.click("#ink-purl")
    chart.drag((3, 2), (3, 4))
    assert purls(kept_chart(flat_studio)) == block((3, 3), (2, 4))
    flat_studio.reload()
    expect(flat_studio.locator("#choose-back")).to_have_attribute("aria-checked", "true")


def test_the_shelf_has_the_symbols_of_the_chart(flat_studio: Page) -> None:
    purl, knit = (flat_studio.locator(f"#ink-{ink} img") for ink in ("purl", "knit"))
    drawn: set[tuple[str | None, str | None]] = set()
    for look in ("both dots", "both dashes", "both japanese"):
        flat_studio.select_option("#look", look)
        expect(purl).to_have_attribute("src", re.compile("^data:"))
        flat_studio.wait_for_timeout(300)
        drawn.add((purl.get_attribute("src"), knit.get_attribute("src")))
    assert len(drawn) == 3


@pytest.mark.slow
def test_the_ink_without_stitches_cuts_out_puts_back_and_is_kept(flat_studio: Page) -> None:
    chart = Chart(flat_studio)
    flat_studio.click("#ink-no-stitch")
    flat_studio.click("#tool-rectangle")
    chart.drag((10, 1), (9, 3))
    outline = str(kept_design(flat_studio)["outline"]).splitlines()
    assert outline[:3] == ["x" * 9 + "...", "x" * 9 + "...", "x" * 12]
    expect(flat_studio.locator(".chart-key")).to_contain_text("no stitch")
    flat_studio.click("#ink-purl")
    chart.drag((10, 1), (8, 4))
    assert purls(kept_chart(flat_studio)) == block((8, 8), (1, 4)) | {(9, 4), (10, 4)}
    flat_studio.reload()
    for _ in range(2):
        flat_studio.click("#action-undo")
    design = kept_design(flat_studio)
    assert (design["outline"], design["chart"]) == (None, CHART)
