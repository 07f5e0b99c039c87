"""Tables of stretch tests from other hands: what is in them, and what is doubtful about them."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from knitcore.chart.fabric import Direction
from tests.browser.axe import violations_in_both_themes
from tests.browser.page import complaints, drop
from tests.knitcore.measure.synthetic import WIDTH_MM, write_csv

pytestmark = pytest.mark.slow


def channels(stiffness: float) -> bytes:
    """A tester's table whose columns are numbered."""
    strain = np.linspace(0.0, 0.6, 60)
    force = stiffness * (strain + 2 * strain**3)
    rows = [f"{100 * e:.4f},{f:.5f}" for e, f in zip(strain, force, strict=True)]
    return "\n".join(["Ch 1,Ch 2 (N)", *rows]).encode()


def test_a_table_of_a_tester_is_mapped_once_and_known_again(flat_studio: Page) -> None:
    page, said = flat_studio, complaints(flat_studio)
    drop(page, "pull.csv", "text/csv", channels(4.0))
    page.select_option("#yarn-dropped-fabric", "rib")
    page.click("#yarn-dropped-use")
    half = page.locator("#yarn-rib-reading .test-half")
    expect(half).to_contain_text(
        "Still needed: a column of strain or extension, a column of force, the width."
    )
    page.get_by_label("Ch 1 holds").select_option("extension_mm")
    expect(half).to_contain_text("the width, the distance of the clamps")
    page.get_by_label("Ch 2 (N) holds").select_option("force_n")
    expect(page.get_by_label("Unit of Ch 1")).to_contain_text("mm, not stated")
    assert violations_in_both_themes(page, "#yarns-dialog") == []
    page.fill("#yarn-rib-course-width", "70")
    page.fill("#yarn-rib-course-length", "100")
    page.press("#yarn-rib-course-length", "Tab")
    expect(half.locator(".pulls-plot")).to_contain_text("60")  # per cent
    with page.expect_download() as caught:
        half.get_by_text("Save how it is read").click()
    template = json.loads(Path(caught.value.path()).read_text())
    assert template["columns"] == {"extension_mm": "Ch 1", "force_n": "Ch 2 (N)"}
    assert (template["width_mm"], template["length_mm"]) == (70, 100)
    assert caught.value.suggested_filename == "pull-template.json"

    other = {"name": "other.csv", "mimeType": "text/csv", "buffer": channels(9.0)}
    page.set_input_files("#yarn-rib-along-columns", files=[other])
    again = page.get_by_label("other.csv, along the columns")
    expect(again).to_contain_text("Read as a table with the same heads was")
    expect(again.locator(".pulls-plot")).to_be_visible()
    again.get_by_text("Read it as it stands").click()
    expect(again).to_contain_text("Still needed: a column of strain or extension")
    page.fill("#yarn-name", "Mine")
    page.fill("#yarn-rib-stitches", "20")
    page.fill("#yarn-rib-rows", "25")
    page.click("#yarn-make")
    expect(page.locator("#yarn-maker .problem").last).to_contain_text("strain or extension")
    assert said == []


def test_a_width_in_cm_and_exchanged_files_are_asked_about(
    flat_studio: Page, tmp_path: Path
) -> None:
    page = flat_studio
    course, wale = (write_csv(tmp_path / f"{d}.csv", d, runs=1) for d in Direction)
    course.write_text(course.read_text().replace(f",{WIDTH_MM}\n", f",{WIDTH_MM / 10}\n"))
    page.focus("#chart")
    page.keyboard.press("Shift+Y")
    page.click("#yarn-new")
    page.set_input_files("#yarn-garter-along-rows", wale)
    page.set_input_files("#yarn-garter-along-columns", course)
    reading = page.locator("#yarn-garter-reading")
    expect(reading).to_contain_text("states that it was pulled")
    expect(reading).to_contain_text("7 beside 70 looks like cm, not mm")
    page.get_by_label("exchange the two files").check()
    expect(reading).not_to_contain_text("states that it was pulled")
    page.get_by_label("cm: 70 mm").check()
    expect(page.locator("#yarn-garter-course-width")).to_have_value("70")
    expect(reading.locator(".test-question.open")).to_have_count(0)
    expect(reading.get_by_label("course.csv, along the rows")).to_contain_text("70 mm wide")


Rows = list[list[float]]
DOUBTS: dict[str, tuple[Callable[[Rows], Rows], str]] = {
    "looks like a stretch ratio": (
        lambda rows: [[r[0], 1 + r[1], 1 + r[2], *r[3:]] for r in rows],
        "stretch ratio:",
    ),
    "knitted fabric carries": (lambda rows: [[*r[:3], 100 * r[3], r[4]] for r in rows], "cN"),
    "wider at a strain of": (lambda rows: [[*r[:2], -r[2], *r[3:]] for r in rows], "it narrows by"),
    "force begins to rise at a strain of": (
        lambda rows: [
            *([0.0, strain, 0.0, 0.0, rows[0][4]] for strain in np.linspace(0.0, 0.05, 12)),
            *([r[0], r[1] + 0.055, *r[2:]] for r in rows),
        ],
        "it unfolds",
    ),
}


def test_what_can_be_read_in_two_ways_is_a_question(flat_studio: Page, tmp_path: Path) -> None:
    page = flat_studio
    course, wale = (write_csv(tmp_path / f"{d}.csv", d, runs=1) for d in Direction)
    head, *lines = course.read_text().splitlines()
    rows = [[float(cell) for cell in line.split(",")] for line in lines]
    page.focus("#chart")
    page.keyboard.press("Shift+Y")
    page.click("#yarn-new")
    page.set_input_files("#yarn-rib-along-columns", wale)
    half = page.locator("#yarn-rib-reading").get_by_label("csv, along the rows")
    for number, (problem, (change, answer)) in enumerate(DOUBTS.items()):
        changed = [",".join(f"{v:.6f}" for v in row) for row in change(rows)]
        file = tmp_path / f"test-{number}.csv"
        file.write_text("\n".join([head, *changed]))
        page.set_input_files("#yarn-rib-along-rows", file)
        expect(half.locator(".test-question")).to_contain_text(problem)
        half.locator(".test-question label", has_text=answer).click()
        expect(half).to_contain_text("Read with what you said")
        expect(half.locator(".test-question.open")).to_have_count(0)
        expect(half.locator(".pulls-plot")).to_be_visible()
        half.get_by_text("Read it as it stands").click()
        expect(half.locator(".test-question")).to_contain_text(problem)


def test_a_table_without_names_is_mapped_and_not_taken_for_another(flat_studio: Page) -> None:
    page = flat_studio
    bare = channels(4.0).split(b"\n", 1)[1]
    drop(page, "bare.csv", "text/csv", bare)
    page.select_option("#yarn-dropped-fabric", "rib")
    page.click("#yarn-dropped-use")
    page.get_by_label("column 1 holds").select_option("extension_mm")
    page.get_by_label("column 2 holds").select_option("force_n")
    page.fill("#yarn-rib-course-width", "70")
    page.fill("#yarn-rib-course-length", "100")
    page.press("#yarn-rib-course-length", "Tab")
    expect(page.locator("#yarn-rib-reading .pulls-plot")).to_be_visible()
    other = {"name": "other.csv", "mimeType": "text/csv", "buffer": bare}
    page.set_input_files("#yarn-rib-along-columns", files=[other])
    again = page.get_by_label("other.csv, along the columns")
    expect(again).to_contain_text("Still needed: a column of strain or extension")
