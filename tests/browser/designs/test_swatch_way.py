"""A yarn without a tester, in five steps."""

import json
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tests.browser.axe import violations_in_both_themes
from tests.browser.page import complaints

pytestmark = pytest.mark.slow

EXAMPLES = Path(__file__).parents[3] / "app" / "examples"


def test_a_yarn_is_made_from_a_ruler_a_scale_and_photos(flat_studio: Page) -> None:
    page, said = flat_studio, complaints(flat_studio)
    page.focus("#chart")
    page.keyboard.press("Shift+Y")
    page.click("#yarn-swatch")
    page.click("#swatch-next")
    status = page.locator("#swatch-way > .dialog-status")
    expect(status).to_contain_text("a name")
    page.fill("#swatch-name", "Bottle wool")
    page.fill("#swatch-fibre", "100 % wool")
    page.fill("#swatch-ball-grams", "50")
    page.fill("#swatch-ball-metres", "125")
    page.click("#swatch-next")
    page.click("#swatch-step-5")
    expect(status).to_contain_text("per 10 cm")
    for field, value in (("stitches", "20"), ("rows", "28"), ("weight", "5.5"), ("width", "110")):
        page.fill(f"#swatch-{field}", value)
    page.fill("#swatch-height", "150")
    page.click("#swatch-next")
    page.fill("#swatch-ten", "150")
    page.click("#swatch-next")

    assert violations_in_both_themes(page, "#yarns-dialog") == []
    with page.expect_download() as sheet:
        page.click("#swatch-sheet")
    assert sheet.value.suggested_filename == "knitcore-marks.pdf"
    page.fill("#swatch-wale-clamped", "110")
    page.set_input_files("#swatch-wale-photo-0", EXAMPLES / "swatch-rest.jpg")
    page.set_input_files("#swatch-wale-photo-1", EXAMPLES / "photo.png")
    page.fill("#swatch-wale-grams-1", "1500")
    page.click("#swatch-wale-read")
    expect(page.locator("#swatch-way fieldset .problem").first).to_contain_text("photo.png")
    page.click("#swatch-next")
    expect(status).to_contain_text("Read the photos")
    page.set_input_files("#swatch-wale-photo-1", EXAMPLES / "swatch-500g.jpg")
    page.click("#swatch-wale-read")
    expect(page.locator("#swatch-way fieldset").first).to_contain_text("30.0 %")
    page.click("#swatch-next")

    rows = page.locator("#swatch-steps tbody tr")
    expect(rows).to_have_count(5)
    expect(rows.last).to_contain_text("Photos, pulled along the columns")
    expect(rows.last.locator(".swatch-brought")).to_have_count(2)
    expect(page.locator("#swatch-way")).to_contain_text("pulled along the columns only")
    expect(page.locator(".yarn-use").first).to_contain_text("Roughly: charts on the page")
    assert violations_in_both_themes(page, "#yarns-dialog") == []
    page.click("#swatch-next")
    expect(page.locator("#material-button")).to_contain_text("Bottle wool")
    assert [line for line in said if "422" not in line] == []


def test_one_tested_fabric_makes_a_yarn_for_any_chart_that_says_what_it_lacks(
    flat_studio: Page,
) -> None:
    page = flat_studio
    file = page.evaluate("fetch('/api/v1/materials/acrylic/document').then((a) => a.json())")
    garter = file["fabrics"]["garter"] | {"loop_length_mm": None}
    file |= {"identifier": "twice", "name": "Tested twice", "yarn": {}}
    file |= {"fabrics": {"garter": garter}}
    page.focus("#chart")
    page.keyboard.press("Shift+Y")
    content = {"name": "twice.json", "mimeType": "application/json"}
    page.set_input_files("#yarn-file", files=[{**content, "buffer": json.dumps(file).encode()}])
    expect(page.locator("#yarns-dialog")).to_be_hidden()
    expect(page.locator("#material-button")).to_contain_text("Worsted acrylic")
    page.focus("#chart")
    page.keyboard.press("Shift+Y")
    page.get_by_label("Change Tested twice").click()
    page.click("#yarn-make")
    uses = page.locator("#yarn-maker .yarn-use")
    expect(uses.last).to_contain_text("the bending stiffness")
    expect(uses.first).not_to_contain_text("No")
    page.click("#yarn-make")
    expect(page.locator("#material-button")).to_contain_text("Tested twice")
