"""Designs are kept, listed, versioned and shared, and nothing is lost on the way."""

import json
import re
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser.axe import THEMES, violations
from tests.browser.conftest import CHART, flat, second_window, wait_for_numbers
from tests.browser.page import drag, keep_version, kept_chart, kept_design

SERVICE = "**/api/v1/designs**"
AT_THE_SERVICE = """async (expected) => {
    const { chart, remote } = JSON.parse(localStorage['knitcore.design']);
    const { document } = await (await fetch(`/api/v1/designs/${remote.id}`)).json();
    return Object.entries({ chart, ...expected }).every(([k, value]) => document[k] === value);
}"""
"""Return whether the service has the browser's chart and what else is expected of the design."""
LINK = re.compile(r"#shared/[\w-]{20,}$")


def painted(page: Page, dx: float = 60, dy: float = 30) -> str:
    """Paint a stroke and wait until the service has it; the chart then."""
    drag(page, dx, dy)
    saved(page)
    return kept_chart(page)


def saved(page: Page) -> None:
    expect(page.locator("#kept")).to_contain_text("Saved")


def renamed(page: Page, name: str) -> None:
    page.fill(".design-name", name)
    page.keyboard.press("Enter")


def test_strokes_and_names_reach_the_service(flat_studio: Page) -> None:
    chart = painted(flat_studio)
    renamed(flat_studio, "Cuff")
    assert chart != CHART
    flat_studio.wait_for_function(AT_THE_SERVICE, arg={"chart": chart, "name": "Cuff"})
    expect(flat_studio).to_have_url(re.compile("#design/"))


def test_what_is_painted_while_the_service_is_away_is_delivered_later(flat_studio: Page) -> None:
    painted(flat_studio)
    flat_studio.route(SERVICE, lambda route: route.abort())
    drag(flat_studio, 0, -50, start=(-80, -30))
    expect(flat_studio.locator("#kept")).to_contain_text("Saved here only")
    chart = kept_chart(flat_studio)
    flat_studio.reload()  # the page dies meanwhile
    wait_for_numbers(flat_studio)
    assert kept_chart(flat_studio) == chart
    flat_studio.unroute(SERVICE)
    flat_studio.wait_for_function(AT_THE_SERVICE, arg={"chart": chart})


def test_two_windows_merge_their_strokes(flat_studio: Page) -> None:
    painted(flat_studio)
    second = second_window(flat_studio, flat_studio.url)
    theirs = painted(second, 0, 50)
    flat_studio.bring_to_front()
    drag(flat_studio, 40, 0, start=(-120, 60))
    saved(flat_studio)
    flat_studio.wait_for_function(AT_THE_SERVICE)
    chart = kept_chart(flat_studio)
    assert all(mine == "P" for mine, other in zip(chart, theirs, strict=True) if other == "P")
    assert chart.count("P") > theirs.count("P")


@pytest.mark.slow
def test_what_cannot_be_merged_is_a_choice_that_loses_nothing(flat_studio: Page) -> None:
    painted(flat_studio)
    flat_studio.route(SERVICE, lambda route: route.abort())
    renamed(flat_studio, "Mine")
    expect(flat_studio.locator("#kept")).to_contain_text("Saved here only")
    second = second_window(flat_studio, flat_studio.url)
    renamed(second, "Theirs")
    saved(second)
    second.close()
    flat_studio.unroute(SERVICE)
    expect(flat_studio.locator("#conflict-dialog")).to_be_visible()
    expect(flat_studio.locator("#conflict-dialog")).to_contain_text("name")
    sent: list[str] = []
    flat_studio.on("request", lambda r: "/designs" in r.url and sent.append(r.method))
    flat_studio.evaluate("dispatchEvent(new Event('pagehide'))")  # would send what is unsent
    for theme in THEMES:
        flat_studio.emulate_media(color_scheme=theme)
        assert not violations(flat_studio), theme
    assert not set(sent) - {"GET"}, "something was sent before the choice"
    flat_studio.click("#conflict-both")
    expect(flat_studio.locator(".design-name")).to_have_value("Mine (mine)")
    saved(flat_studio)
    flat_studio.keyboard.press("Control+o")
    names = flat_studio.locator("#designs-list .card-name")
    expect(names.filter(has_text="Mine (mine)")).to_have_count(1)
    expect(names.filter(has_text="Theirs")).not_to_have_count(0)


@pytest.mark.slow
def test_a_deleted_design_can_be_recovered(flat_studio: Page) -> None:
    painted(flat_studio)
    renamed(flat_studio, "Dispensable")
    saved(flat_studio)
    flat_studio.keyboard.press("Control+o")
    card = flat_studio.locator("#designs-list .card", has_text="Dispensable")
    card.get_by_label("Delete: Dispensable").click()
    expect(card).to_have_count(0)
    flat_studio.click("#designs-undo")
    expect(card).to_have_count(1)


@pytest.mark.slow
def test_a_version_is_restored_and_the_state_before_it_kept(flat_studio: Page) -> None:
    first = painted(flat_studio)
    keep_version(flat_studio, "First stroke")
    expect(flat_studio.locator("#versions-list .row")).to_have_count(1)
    flat_studio.keyboard.press("Escape")
    second = painted(flat_studio, 0, 50)
    assert second != first
    flat_studio.keyboard.press("Control+s")
    flat_studio.get_by_label("Restore First stroke").click()
    expect(flat_studio.locator("#versions-dialog")).to_be_hidden()
    assert kept_chart(flat_studio) == first
    flat_studio.wait_for_function(AT_THE_SERVICE, arg={"chart": first})
    flat_studio.keyboard.press("Control+z")  # what is restored can be undone like any step
    assert kept_chart(flat_studio) == second


@pytest.mark.slow
def test_a_link_shows_the_design_to_others_and_lets_them_copy_it(
    flat_studio: Page, browser: Browser
) -> None:
    chart = painted(flat_studio)
    flat_studio.click("#action-share")
    flat_studio.check("#share-copy")
    flat_studio.click("#share-make")
    expect(flat_studio.locator("#share-link")).to_have_value(LINK)
    link = flat_studio.input_value("#share-link")
    stranger = browser.new_context(viewport={"width": 1280, "height": 720})
    page = flat(stranger.new_page())
    page.goto(link)
    expect(page.locator("#shared")).to_contain_text("Shared with you")
    drag(page, 0, 50, start=(-80, -30))
    flat_studio.wait_for_function(AT_THE_SERVICE, arg={"chart": chart})
    page.click("#shared-copy")
    expect(page.locator("#shared")).to_be_hidden()
    expect(page.locator(".design-name")).to_have_value(re.compile(r"\(copy\)$"))
    page.wait_for_function(AT_THE_SERVICE, arg={"name": page.input_value(".design-name")})
    assert kept_chart(page).count("P") > chart.count("P")
    stranger.close()


@pytest.mark.slow
def test_the_gallery_opens_a_glove_and_the_design_before_it_stays(flat_studio: Page) -> None:
    chart = painted(flat_studio)
    before = flat_studio.url
    flat_studio.keyboard.press("Shift+N")
    flat_studio.click("#gallery-glove")
    expect(flat_studio.locator(".design-name")).to_have_value("Therapeutic glove")
    design = kept_design(flat_studio)
    assert "." in design["outline"]
    assert {region["name"] for region in design["regions"]} >= {"cuff", "thumb", "fingers"}
    flat_studio.goto(before)
    expect(flat_studio.locator(".design-name")).to_have_value("Test")
    assert kept_chart(flat_studio) == chart


@pytest.mark.slow
def test_a_project_file_goes_out_and_comes_in(flat_studio: Page, tmp_path: Path) -> None:
    chart = painted(flat_studio)
    with flat_studio.expect_download() as download:
        flat_studio.keyboard.press("Control+Shift+E")
    file = tmp_path / "design.json"
    download.value.save_as(file)
    document = json.loads(file.read_text())
    assert document["format"] == "knitcore-design"
    assert document["chart"] == chart
    drag(flat_studio, 0, 50, start=(-80, -30))
    flat_studio.click("#action-import")
    flat_studio.set_input_files("#import-file", file)
    flat_studio.wait_for_function(
        "chart => JSON.parse(localStorage['knitcore.design']).chart === chart", arg=chart
    )


@pytest.mark.slow
def test_the_tour_is_walked_with_keys_and_ends(visitor: Page, service: str) -> None:
    flat(visitor).goto(service)
    visitor.get_by_role("button", name="Take the tour").click()
    expect(visitor.locator("#tour")).to_be_visible()
    seen = set()
    for _ in range(20):
        if not visitor.locator("#tour").is_visible():
            break
        seen.add(visitor.locator("#tour-title").inner_text())
        visitor.keyboard.press("ArrowRight")
    expect(visitor.locator("#tour")).to_be_hidden()
    assert len(seen) >= 8
    visitor.reload()
    wait_for_numbers(visitor)
    expect(visitor.get_by_role("button", name="Take the tour")).to_have_count(0)
