"""Two pieces side by side, the pressure on a limb, own yarns: all with a clean console."""

from __future__ import annotations

import json

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import wait_for_numbers

pytestmark = pytest.mark.slow


def test_pieces_limbs_and_yarns_leave_the_console_clean(flat_studio: Page) -> None:
    said: list[str] = []
    flat_studio.on("console", lambda m: said.append(m.text) if m.type != "log" else None)
    flat_studio.on("response", lambda r: said.append(r.url) if r.status >= 400 else None)

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

    file = flat_studio.evaluate(
        "fetch('/api/v1/materials/acrylic/document').then((answer) => answer.json())"
    )
    file |= {"identifier": "aunts-wool", "name": "My aunt's wool"}
    flat_studio.focus("#chart")
    flat_studio.keyboard.press("Shift+Y")
    flat_studio.set_input_files(
        "#yarn-file",
        files=[
            {
                "name": "wool.json",
                "mimeType": "application/json",
                "buffer": json.dumps(file).encode(),
            }
        ],
    )
    expect(flat_studio.locator("#material-button")).to_contain_text("My aunt's wool")
    wait_for_numbers(flat_studio)
    assert said == []
