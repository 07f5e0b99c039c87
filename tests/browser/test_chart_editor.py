"""The notebook's chart editor in Chromium, with a stand-in for the notebook's model."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page, expect

from knitcore.notebook.editor import ChartEditor

HOST = """async ([source, text]) => {
  const address = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
  const { default: widget } = await import(address);
  const values = { text, most_stitches: 100 };
  window.model = {
    get: (name) => values[name],
    set: (name, value) => { values[name] = value; },
    save_changes: () => { window.saved = values.text; },
    on: (_, told) => { window.told = told; },
    off: () => {},
  };
  widget.render({ model: window.model, el: document.body });
}"""


@pytest.fixture
def editor(browser: Browser) -> Iterator[Page]:
    with browser.new_page() as page:
        widget = ChartEditor("KKK/KKK")
        page.set_content(f"<style>{widget._css}</style>")
        page.evaluate(HOST, [str(widget._esm), widget.text])
        yield page


def saved(page: Page) -> str:
    return str(page.evaluate("window.saved"))


def test_the_keyboard_paints(editor: Page) -> None:
    editor.get_by_label("row 1, column 1, knit").focus()
    for key in ("Space", "ArrowRight", "ArrowUp", "p", "End", "P", "k"):
        editor.keyboard.press(key)
    assert saved(editor) == "KPK\nPKK"
    expect(editor.get_by_label("row 2, column 3, knit")).to_be_focused()
    expect(editor.get_by_role("status")).to_have_text("row 2, column 3, knit")
    for _ in range(3):
        editor.keyboard.press("Control+z")
    assert saved(editor) == "KKK\nPKK"


def test_dragging_paints_what_the_first_stitch_becomes(editor: Page) -> None:
    editor.get_by_label("row 2, column 1, knit").hover()
    editor.mouse.down()
    editor.get_by_label("row 2, column 3, knit").hover()
    editor.mouse.up()
    assert saved(editor) in {"PPP\nKKK", "PKP\nKKK"}  # a fast pointer may pass over the middle


def test_the_size_grows_from_the_lower_left_up_to_a_limit(editor: Page) -> None:
    editor.get_by_label("row 1, column 1, knit").press("Space")
    editor.get_by_role("spinbutton", name="Columns").fill("4")
    editor.get_by_role("spinbutton", name="Columns").blur()
    assert saved(editor) == "KKKK\nPKKP"
    editor.get_by_role("spinbutton", name="Rows").fill("26")
    editor.get_by_role("spinbutton", name="Rows").blur()
    expect(editor.get_by_role("status")).to_have_text("Give 1 to 100 stitches.")
    assert saved(editor) == "KKKK\nPKKP"


def test_a_chart_set_in_python_is_shown(editor: Page) -> None:
    editor.evaluate("window.model.set('text', 'PK'); window.told()")
    expect(editor.get_by_role("gridcell")).to_have_count(2)
    editor.get_by_role("button", name="Mirror").click()
    assert saved(editor) == "KP"
