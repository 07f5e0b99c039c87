"""Two pieces side by side, the pressure on a limb, own yarns: all with a clean console."""

import json
from pathlib import Path

import pytest
from playwright.sync_api import Page, Route, expect

from knitcore import Fabric, material
from tests.browser.conftest import wait_for_numbers
from tests.browser.page import complaints, keep_version

pytestmark = pytest.mark.slow

EXAMPLES = Path(__file__).parents[3] / "app" / "examples"


def test_pieces_and_limbs_leave_the_console_clean(flat_studio: Page) -> None:
    said = complaints(flat_studio)
    flat_studio.click("#tab-limb")
    expect(flat_studio.locator(".limb-pressure")).to_contain_text("mmHg")

    flat_studio.focus("#chart")
    flat_studio.keyboard.press("Shift+C")
    flat_studio.select_option("#compare-b", "now")  # other tests' designs are offered, too
    numbers = flat_studio.locator("#compare-numbers tbody tr")
    expect(numbers.first).to_contain_text("the same")
    flat_studio.select_option("#compare-b-yarn", "cotton")
    expect(numbers.first).not_to_contain_text("the same")
    flat_studio.keyboard.press("Escape")
    assert said == []


def test_a_piece_has_the_yarn_of_its_design_until_another_is_chosen(flat_studio: Page) -> None:
    page = flat_studio
    page.focus("#chart")
    page.keyboard.press("Shift+C")
    expect(page.locator("#compare-a-yarn")).to_have_value("acrylic")
    page.select_option("#compare-b", "now")
    page.select_option("#compare-b-yarn", "glove-wool")
    page.keyboard.press("Escape")
    page.keyboard.press("Control+k")
    page.fill("#command-search", "yarn pearl")
    page.keyboard.press("Enter")
    wait_for_numbers(page)
    page.focus("#chart")
    page.keyboard.press("Shift+C")
    expect(page.locator("#compare-a-yarn")).to_have_value("cotton")
    expect(page.locator("#compare-b-yarn")).to_have_value("glove-wool")


def test_a_version_is_set_beside_the_whole_chart_as_it_is_now(flat_studio: Page) -> None:
    page = flat_studio
    keep_version(page, "All knit")
    page.keyboard.press("Escape")
    page.click("#ink-garter")
    page.click("#fill-all")
    wait_for_numbers(page)
    page.focus("#chart")
    page.keyboard.press("Control+s")
    page.get_by_label("Compare with All knit").click()
    rows = page.locator("#compare-dialog:not(.busy) #compare-numbers tr")
    modulus = rows.filter(has_text="Stiffness, rows")
    expect(modulus).to_be_visible()
    chosen = page.locator("#compare-dialog select option:checked").all_inner_texts()
    assert chosen[0] == "Whole chart"
    assert chosen[2].startswith("1. All knit (")
    for value, fabric in zip(
        modulus.locator(".value").all_inner_texts(),
        (Fabric.GARTER, Fabric.STOCKINETTE),
        strict=True,
    ):
        law = material("acrylic").law(fabric)
        assert float(value) == pytest.approx(law.modulus_course, rel=0.01)
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    page.focus("#chart")
    page.keyboard.press("Shift+C")  # what was compared last
    expect(page.locator("#compare-b option:checked")).to_contain_text("All knit")


def test_an_own_yarn_is_added_measured_and_changed(flat_studio: Page) -> None:
    page, said = flat_studio, complaints(flat_studio)
    file = page.evaluate("fetch('/api/v1/materials/acrylic/document').then((a) => a.json())")
    file |= {"identifier": "aunts-wool", "name": "My aunt's wool"}
    wool = {"name": "wool.json", "mimeType": "application/json"}
    page.focus("#chart")
    page.keyboard.press("Shift+Y")
    page.set_input_files("#yarn-file", files=[{**wool, "buffer": json.dumps(file).encode()}])
    expect(page.locator("#material-button")).to_contain_text("My aunt's wool")
    wait_for_numbers(page)

    page.focus("#chart")
    page.keyboard.press("Shift+Y")
    page.click("#yarn-new")
    page.fill("#yarn-name", "Plain cotton")
    page.click("#yarn-bend summary")
    page.set_input_files("#yarn-photos", EXAMPLES / "photo.png")
    page.fill("#yarn-weight", "0.5")
    page.fill("#yarn-hanging", "120")
    page.click("#yarn-bend-run")
    expect(page.locator("#yarn-bend")).to_contain_text("mN·mm² from 1 photo.")
    page.fill("#yarn-loop", "12")
    page.fill("#yarn-rib-stitches", "40")
    page.click("#yarn-make")
    expect(page.locator("#yarn-maker .problem")).to_contain_text("both its stitches and its rows")
    page.fill("#yarn-rib-rows", "30")
    page.click("#yarn-make")
    expect(page.locator("#material-button")).to_contain_text("Plain cotton")

    page.focus("#chart")
    page.keyboard.press("Shift+Y")
    page.get_by_label("Change Plain cotton").click()
    expect(page.locator("#yarn-rib-stitches")).to_have_value("40")
    page.fill("#yarn-name", "Soft cotton")
    page.click("#yarn-make")
    expect(page.locator("#material-button")).to_contain_text("Soft cotton")
    page.focus("#chart")
    page.keyboard.press("Shift+Y")
    expect(page.locator("#yarns-list")).not_to_contain_text("Plain cotton")
    page.locator("#yarns-list li", has_text="Soft cotton").get_by_text("Evidence").click()
    expect(page.locator("#yarns-list")).to_contain_text("mN·mm² from 1 photo.")
    expect(page.locator("#yarns-list")).to_contain_text("garter: estimated from")

    def as_if_others_added(route: Route) -> None:
        answer = route.fetch()
        theirs = [yarn | {"added_by_you": False} for yarn in answer.json()["materials"]]
        route.fulfill(response=answer, json={"materials": theirs})

    page.route("**/api/v1/materials", as_if_others_added)
    expect(page.locator("#kept")).to_contain_text("Saved")  # or its answer is lost on the way
    page.reload()
    wait_for_numbers(page)
    page.focus("#chart")
    page.keyboard.press("Shift+Y")
    expect(page.get_by_label("Save Soft cotton as a file")).to_be_visible()
    for offer in ("Change", "Remove"):
        expect(page.get_by_label(f"{offer} Soft cotton")).to_have_count(0)
    assert said == []
