"""Tools, keys and selections on the chart."""

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import wait_for_numbers
from tests.browser.page import drag, kept_chart


@pytest.mark.slow
def test_selection_shows_numbers_of_its_own(flat_studio: Page) -> None:
    flat_studio.click("#tool-select")
    drag(flat_studio, 70, 40)
    expect(flat_studio.locator("#inspector h2")).to_contain_text("Selection")
    wait_for_numbers(flat_studio)
    flat_studio.click("#ink-seed")
    flat_studio.click("#fill-all")
    wait_for_numbers(flat_studio)
    expect(flat_studio.locator("#share-fabrics")).to_contain_text("seed 100 %")
    flat_studio.keyboard.press("Escape")
    expect(flat_studio.locator("#inspector h2")).to_contain_text("Whole chart")


def test_right_button_paints_the_opposite_and_material_changes_the_numbers(
    flat_studio: Page,
) -> None:
    flat_studio.click("#ink-knit")
    flat_studio.locator("#chart").click(button="right")
    assert kept_chart(flat_studio).count("P") == 1
    wait_for_numbers(flat_studio)
    old = flat_studio.locator("#modulus-wale .value").text_content()
    flat_studio.click("#material-button")
    flat_studio.click("#material-cotton")
    expect(flat_studio.locator("#modulus-wale .value")).not_to_have_text(old)
    expect(flat_studio.locator("#material-button")).to_contain_text("otton")
