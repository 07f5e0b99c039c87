"""Files dropped on the page: pictures with a preview, projects, and what is broken."""

import io
import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image
from playwright.sync_api import Page, expect

from app.cli.main import main
from knitcore.formats.read.chart_files import read_noted_chart
from tests.browser.page import drop, kept_chart, kept_design


def picture(cells: np.ndarray, size: int) -> bytes:
    """PNG of a chart, each cell as large, dark for 1."""
    grey = np.where(np.kron(cells, np.ones((size, size))) > 0, 40, 225).astype(np.uint8)
    file = io.BytesIO()
    Image.fromarray(grey).save(file, "PNG")
    return file.getvalue()


CELLS = np.array([[0, 1, 0, 0, 1], [1, 0, 0, 1, 1], [0, 0, 1, 0, 1]])
TEXT = "\n".join("".join("KP"[c] for c in row) for row in CELLS)


@pytest.mark.slow
def test_pictures_are_previewed_and_imported(flat_studio: Page) -> None:
    drop(flat_studio, "chart.png", "image/png", picture(CELLS, 12))
    dialog = flat_studio.locator("#picture-dialog")
    expect(dialog).to_contain_text("Grid found: 5 × 3")
    expect(flat_studio.locator("#picture-columns")).to_have_value("5")
    expect(dialog.locator("output")).to_have_text("47 % purl")
    flat_studio.check("#picture-inverted")
    expect(dialog.locator("output")).to_have_text("53 % purl")
    flat_studio.uncheck("#picture-inverted")
    flat_studio.fill("#picture-columns", "0")
    expect(flat_studio.locator("#picture-apply")).to_be_disabled()
    flat_studio.click("#picture-found")
    expect(flat_studio.locator("#picture-apply")).to_be_enabled()
    before = kept_design(flat_studio)["id"]
    flat_studio.press("#picture-columns", "Enter")
    assert kept_chart(flat_studio) == TEXT
    assert kept_design(flat_studio)["id"] != before
    expect(flat_studio.locator(".design-name")).to_have_value("chart")

    drop(flat_studio, "small.png", "image/png", picture(CELLS, 1))
    expect(flat_studio.locator("#picture-rows")).to_have_value("3")
    flat_studio.fill("#picture-columns", "10")
    expect(flat_studio.locator("#picture-rows")).to_have_value("6")  # proportions are kept
    flat_studio.check("#picture-knitted")
    expect(flat_studio.locator("#picture-rows")).not_to_have_value("6")
    knitted = int(flat_studio.input_value("#picture-rows"))
    assert knitted > 6  # a stitch is wider than high
    expect(flat_studio.locator("#picture-as-knitted")).to_have_attribute(
        "aria-label", re.compile(f"As it is knitted: 10 stitches × {knitted} rows")
    )
    flat_studio.uncheck("#picture-locked")
    flat_studio.fill("#picture-columns", "4")
    expect(flat_studio.locator("#picture-rows")).to_have_value(str(knitted))
    expect(flat_studio.locator("#picture-preview")).to_have_attribute(
        "aria-label", re.compile(f"4 stitches × {knitted} rows")
    )
    flat_studio.click("#picture-replace")
    expect(dialog).to_have_count(0)
    assert kept_chart(flat_studio) != TEXT
    flat_studio.click("#action-undo")
    assert kept_chart(flat_studio) == TEXT


@pytest.mark.slow
def test_the_page_reads_a_picture_as_the_command_line_does(
    flat_studio: Page, tmp_path: Path
) -> None:
    colours = np.where(CELLS[..., None] > 0, (255, 182, 193), (255, 255, 255)).astype(np.uint8)
    framed = np.full((3 * 20 + 60, 5 * 20 + 60, 3), 255, np.uint8)  # a margin around drawn cells
    framed[29:-30, 29:-30] = 90
    for row, column in np.ndindex(CELLS.shape):
        top, left = 30 + 20 * row, 30 + 20 * column
        framed[top : top + 19, left : left + 19] = colours[row, column]
    for name, pixels in (("two-light.png", colours), ("framed.png", framed)):
        Image.fromarray(pixels).save(tmp_path / name)
        chart, notes = read_noted_chart(tmp_path / name)
        assert chart.text == TEXT
        drop(flat_studio, name, "image/png", (tmp_path / name).read_bytes())
        dialog = flat_studio.locator("#picture-dialog")
        for note in notes:
            expect(dialog).to_contain_text(note)
        flat_studio.click("#picture-replace")
        assert kept_chart(flat_studio) == TEXT


@pytest.mark.slow
def test_a_photo_becomes_the_same_chart_on_the_page_and_on_the_command_line(
    flat_studio: Page, tmp_path: Path
) -> None:
    page, file = flat_studio, tmp_path / "photo.jpg"
    Image.effect_mandelbrot((130, 97), (-2, -1, 1, 1), 20).save(file)

    def rows(count: int) -> None:
        page.uncheck("#picture-knitted")
        page.fill("#picture-rows", str(count))

    def tones() -> None:
        page.check("#picture-inverted")
        page.fill("#picture-threshold", "90")

    def free() -> None:
        page.uncheck("#picture-locked")
        page.fill("#picture-columns", "20")
        page.fill("#picture-rows", "31")

    for act, *options in (
        (lambda: None, "--columns=60", "--aspect=as-knitted"),
        (lambda: page.fill("#picture-columns", "33"), "--columns=33", "--aspect=as-knitted"),
        (lambda: rows(31), "--rows=31"),
        (tones, "--columns=60", "--aspect=as-knitted", "--light-is-purl", "--dark-below=90"),
        (free, "--columns=20", "--rows=31", "--aspect=free"),
    ):
        drop(page, file.name, "image/jpeg", file.read_bytes())
        expect(page.locator("#picture-apply")).to_be_enabled()
        act()
        page.click("#picture-replace")
        expected = CliRunner().invoke(main, ["import", str(file), *options]).stdout
        assert kept_chart(page) == expected.strip()


@pytest.mark.slow
def test_broken_files_are_explained_and_nothing_is_lost(flat_studio: Page) -> None:
    before = kept_design(flat_studio)
    messages = flat_studio.locator("#messages")
    old = {"format": "knitcore-design", "version": 2, "name": "Old", "material": "cotton"}
    for name, kind, content, message in (
        ("broken.png", "image/png", b"\x89PNG nonsense", "not a readable PNG"),
        ("empty.txt", "text/plain", b"", "is empty"),
        ("ragged.txt", "text/plain", b"KP\nKPK", "Line 2 has 3 stitches"),
        ("program.bin", "", b"\x00\x01\x02", "is not a text file"),
        ("half.json", "application/json", b'{"format": "knitcore-des', "damaged or not complete"),
        ("other.json", "application/json", b'{"a": 1}', "not a design"),
        ("new.json", "", json.dumps(old | {"version": 9, "chart": "K"}).encode(), "version 9"),
        ("ragged.json", "", json.dumps(old | {"chart": "KP\nK"}).encode(), "rows of K and P"),
    ):
        drop(flat_studio, name, kind, content)
        expect(messages).to_contain_text(message)
    assert kept_design(flat_studio) == before


def test_project_files_open_and_notes_of_the_reader_are_shown(flat_studio: Page) -> None:
    old = {
        "format": "knitcore-design",
        "version": 2,
        "name": "Old cuff",
        "material": "cotton",
        "chart": "KPKP\nKPKP",
    }
    drop(flat_studio, "old.json", "application/json", json.dumps(old).encode())
    expect(flat_studio.locator(".design-name")).to_have_value("Old cuff")
    assert kept_chart(flat_studio) == old["chart"]
    region = {
        "id": "r",
        "name": "Edge",
        "colour": "#336699",
        "yarn": None,
        "fill": None,
        "runs": [[0, 0, 4]],
        "locked": False,
        "hidden": False,
    }
    new = old | {"name": "New cuff", "outline": "xxx.\nxxxx", "regions": [region]}
    drop(flat_studio, "new.json", "application/json", json.dumps(new).encode())
    expect(flat_studio.locator(".design-name")).to_have_value("New cuff")
    design = kept_design(flat_studio)
    assert (design["outline"], design["regions"]) == ("xxx.\nxxxx", [region])

    drop(flat_studio, "blank.txt", "text/plain", b"P P P \n P P P\nP P P \n P P P\n")
    messages = flat_studio.locator("#messages")
    expect(messages).to_contain_text("blank squares are read as knits")
    assert kept_chart(flat_studio) == "PKPKPK\nKPKPKP\nPKPKPK\nKPKPKP"
