"""Planning a garment and exporting it, on the page."""

from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from knitcore.formats.designs.design_file import design_from_mapping
from knitcore.formats.read.chart_files import read_noted_piece
from tests.browser.axe import violations
from tests.browser.page import exported, kept_design


def _plan(page: Page, template: str) -> None:
    page.keyboard.press("Control+Shift+G")
    _plan_again(page, template)


def _plan_again(page: Page, template: str) -> None:
    page.locator(f"input[name=planner-template][value={template}]").check(force=True)
    page.wait_for_function("() => !document.querySelector('#planner-make').disabled")


@pytest.mark.slow
def test_a_glove_becomes_a_design_with_its_regions(flat_studio: Page, tmp_path: Path) -> None:
    page = flat_studio
    _plan(page, "glove")
    page.locator("#planner-intarsia").check()
    facts = page.locator("#planner-facts")
    expect(facts).to_contain_text("wrist support")
    expect(facts).to_contain_text("To close: graft")
    page.locator("input[name=planner-unit][value=in]").check(force=True)
    expect(page.get_by_label("Thumb: length")).to_have_value("2.17")
    with page.expect_response("**/garment"):
        page.get_by_label("Thumb: length").fill("3")
    expect(page.locator("#planner-make")).to_be_enabled()
    page.locator("#planner-make").click()
    expect(page.locator("#planner-dialog")).not_to_be_visible()
    exported(page, "written").save_as(tmp_path / "glove.txt")
    piece = read_noted_piece(tmp_path / "glove.txt").piece
    assert {yarn.name for yarn in piece.yarns} == {"blue", "orange", "green", "purple"}
    written = {field: kept_design(page)[field] for field in ("name", "chart", "outline", "regions")}
    kept = design_from_mapping({"format": "knitcore-design", "version": 2} | written)
    assert kept.to_piece() == piece
    assert {region.name for region in kept.regions} >= {"thumb", "thumb gusset", "fingers"}


def test_a_brace_for_a_pressure_shows_its_pressure(flat_studio: Page) -> None:
    page = flat_studio
    _plan(page, "wrist-brace")
    support = page.locator("#planner-pressure tbody tr").nth(1)
    expect(page.locator("#planner-facts")).to_contain_text("edge at the hand does not keep to the")
    expect(support).to_contain_text("mmHg")
    expect(support).to_contain_text("170")
    by_pressure = support.inner_text()
    with page.expect_response("**/garment"):
        page.locator("input[name=planner-fit][value=ease]").check(force=True)
    expect(support).to_contain_text("−15 %")
    expect(support).not_to_have_text(by_pressure)
    page.get_by_label("Around the wrist").fill("5000")
    problem = page.locator("#planner-dialog .problem")
    expect(problem).to_contain_text("Around the wrist: enter 80 to 350 mm.")
    expect(page.locator("#planner-make")).to_be_disabled()
    page.get_by_label("Around the wrist").fill("170")
    page.get_by_label("Ease, %").fill("")
    expect(problem).to_contain_text("Ease, %: enter -60 to 100.")
    page.locator("input[name=planner-fit][value=pressure]").check(force=True)
    expect(page.locator("#planner-make")).to_be_enabled()
    page.fill("#planner-target", "900")
    expect(problem).to_contain_text("Target pressure, mmHg: enter 1 to 300.")
    expect(problem).to_be_in_viewport()


def test_a_glove_tells_where_it_is_too_tight(flat_studio: Page) -> None:
    """Its default does not; every part is in the table."""
    page = flat_studio
    _plan(page, "glove")
    places = page.locator("#planner-pressure tbody tr")
    expect(places).to_have_count(9)
    page.set_viewport_size({"width": 390, "height": 844})
    inside = "({ scrollWidth, clientWidth }) => [scrollWidth, clientWidth]"
    wide, room = page.locator("#planner-dialog > .planner").evaluate(inside)
    assert wide == room, "a table is cut at the edge of a phone"
    page.set_viewport_size({"width": 1280, "height": 720})
    warning = page.locator("#planner-facts [role=alert]")
    expect(warning).to_have_count(0)
    page.get_by_label("Ease of fingers and thumb, %").fill("-15")
    expect(warning).to_contain_text("little finger. It may press by up to")
    expect(places.last).to_contain_text("mmHg")


@pytest.mark.slow
def test_every_place_of_a_sleeve_is_shown_and_choices_outlast_another_garment(
    flat_studio: Page,
) -> None:
    page = flat_studio
    _plan(page, "limb")
    for girth in (280, 290, 300, 310, 320):
        page.click("#planner-add")
        page.get_by_label("Circumference there").last.fill(str(girth))
    with page.expect_response("**/garment") as planned:
        page.locator("input[name=planner-fit][value=ease]").check(force=True)
    page.get_by_label("Ease, %").fill("-20")
    page.get_by_label("Body", exact=True).select_option("garter")
    page.select_option("#planner-material", "cotton")
    expect(page.locator("#planner-make")).to_be_enabled()
    count = len(planned.value.json()["worn"])
    assert count > 9
    expect(page.locator("#planner-pressure tbody tr")).to_have_count(count)
    _plan_again(page, "sock-leg")
    expect(page.get_by_label("Body", exact=True)).to_have_value("garter")
    expect(page.get_by_label("Ease, %")).to_have_value("-20")
    _plan_again(page, "glove")
    expect(page.get_by_label("Ease of fingers and thumb, %")).to_have_value("5")
    expect(page.locator("#planner-material")).to_have_value("cotton")


@pytest.mark.slow
def test_a_sleeve_has_graded_pressure_fabrics_and_sizes(flat_studio: Page) -> None:
    """Measurements are still there after a look at another garment."""
    page = flat_studio
    _plan(page, "wrist-brace")
    page.get_by_label("Around the wrist").fill("181")
    _plan_again(page, "limb")
    page.get_by_label("Body", exact=True).select_option("garter")
    with page.expect_request(
        lambda sent: "/garment" in sent.url and "mmhg_profile" in (sent.post_data or "")
    ) as planned:
        page.fill("#planner-target", "15")
        page.fill("#planner-graded", "8")
    garment = planned.value.post_data_json["garment"]
    assert garment["body"] == "garter"
    assert [mmhg for _, mmhg in garment["mmhg_profile"]][-1] == 8
    expect(page.locator("#planner-make")).to_be_enabled()
    expect(page.locator("#planner-facts")).to_contain_text("does not keep to")
    page.check("#planner-sizes-shown")
    rows = page.locator("#planner-sizes tbody tr")
    expect(rows).to_have_count(5)
    expect(rows.first).not_to_have_text(rows.last.inner_text())
    page.get_by_label("Wider by, in percent").fill("9")
    expect(page.locator("#planner-make")).to_be_enabled()
    expect(rows).to_have_count(5)
    _plan_again(page, "wrist-brace")
    expect(page.get_by_label("Around the wrist")).to_have_value("181")


def test_knitout_is_checked_and_a_pattern_has_a_picture_where_nothing_is_drawn_in_3d(
    flat_studio: Page,
) -> None:
    page = flat_studio
    assert exported(page, "knitout").suggested_filename.endswith(".k")
    expect(page.locator("#export-outcome")).to_contain_text("Knitted on a virtual V-bed machine")
    expect(page.locator("#program-report")).to_contain_text("min without stops")
    page.keyboard.press("Escape")
    with page.expect_request("**/api/v1/export") as request:
        pattern = exported(page, "pattern-svg")
    assert request.value.post_data_json["photo"]
    assert "data:image/png" in pattern.path().read_text(encoding="utf-8")


@pytest.mark.slow
def test_options_and_result_are_in_sight_with_the_last_format(flat_studio: Page) -> None:
    page = flat_studio
    for width, height in ((1280, 720), (820, 1180), (390, 844)):
        page.set_viewport_size({"width": width, "height": height})
        page.focus("#chart")
        page.keyboard.press("Control+E")
        page.locator("input[name=export-kind][value=punch-card]").check()
        expect(page.locator("#export-dialog select:visible")).to_be_in_viewport()
        page.locator("input[name=export-kind][value=csv]").check()
        with page.expect_download():
            page.locator("#export-make").click()
        expect(page.locator("#export-outcome li").first).to_be_in_viewport()
        page.keyboard.press("Escape")


def test_written_rows_are_opened_as_a_design(flat_studio: Page, tmp_path: Path) -> None:
    page = flat_studio
    file = tmp_path / "scarf.txt"
    file.write_text("Cast on 4 sts. Worked flat.\nRow 1: Knit.\nRow 2: Bind off 2 sts, k2.\n")
    page.keyboard.press("i")
    page.locator("#import-file").set_input_files(file)
    expect(page.locator("#chart-size")).to_contain_text("4 × 2")
    assert kept_design(page)["outline"] == "..xx\nxxxx"


@pytest.mark.slow
def test_both_panels_are_accessible(flat_studio: Page) -> None:
    page = flat_studio
    _plan(page, "limb")
    assert not violations(page)
    page.keyboard.press("Escape")
    page.keyboard.press("Control+E")
    assert not violations(page)


def test_formats_of_extensions_are_offered(flat_studio: Page) -> None:
    page = flat_studio
    house = {"name": "house", "package": "knit-house 1.0", "problem": None}
    card = house | {"group": "knitcore.exporters", "offers": ["punchcard"]}
    page.route(
        "**/api/v1/extensions",
        lambda route: route.fulfill(
            json={"extensions": [card], "largest_exports": {}, "largest_charts": {}}
        ),
    )
    page.keyboard.press("Control+E")
    expect(page.get_by_role("group", name="From extensions")).to_contain_text("knit-house 1.0")
    page.get_by_label("punchcard").check()
    with page.expect_request("**/api/v1/export") as request:
        page.locator("#export-make").click()
    assert request.value.post_data_json["to"] == "punchcard"
    expect(page.locator("#export-dialog .dialog-status")).to_contain_text("is not a format")
