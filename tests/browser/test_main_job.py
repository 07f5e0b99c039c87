"""The main job: paint, see, stretch."""

import re

import pytest
from playwright.sync_api import Page, expect

from knitcore import Fabric, material
from tests.browser.conftest import CHART, COLUMNS, ROWS, wait_for_numbers
from tests.browser.page import (
    drag,
    expect_number,
    kept_chart,
    number,
    pixels,
    sent_view,
    settle,
    stretched,
    wait_for_change,
    wait_for_colour,
)


def test_first_visit_opens_on_a_painted_and_stretched_example(visitor: Page, service: str) -> None:
    visitor.goto(service)
    wait_for_numbers(visitor)
    expect(visitor.locator("#stretch-slider")).to_be_enabled()
    expect(visitor.locator("#stretch-figures")).to_contain_text("30 %")
    expect(visitor.locator("#overlay-strain")).to_have_attribute("aria-checked", "true")
    expect(visitor.locator("#plot-curve .main-svg").first).to_be_visible()
    wait_for_colour(visitor, "#chart", 10_000)


def test_pure_fabric_shows_the_numbers_of_its_law(flat_studio: Page) -> None:
    flat_studio.click("#ink-garter")
    flat_studio.click("#fill-all")
    expect(flat_studio.locator("#segments-wale")).to_contain_text(f"{(ROWS - 1) * COLUMNS} odd")
    law = material("acrylic").law(Fabric.GARTER)
    for way, modulus in (("course", law.modulus_course), ("wale", law.modulus_wale)):
        expect_number(flat_studio, f"#modulus-{way} .value", 0.99 * modulus, 1.01 * modulus)
    expect(flat_studio.locator("#provenance")).not_to_be_empty()


def test_painting_changes_chart_segments_and_moduli(flat_studio: Page) -> None:
    flat_studio.click("#overlay-modulus-course")
    before = pixels(flat_studio, "#chart")
    modulus = number(flat_studio, "#modulus-course")
    expect(flat_studio.locator("#segments-course")).not_to_contain_text("odd")

    drag(flat_studio, 90, 40)

    expect(flat_studio.locator("#segments-course")).to_contain_text("odd")
    wait_for_change(flat_studio, "#chart", before, 60)
    expect_number(flat_studio, "#modulus-course .value", 0.0, 0.999 * modulus)
    assert "P" in kept_chart(flat_studio)


def test_buttons_say_what_they_do_now_and_the_whole_chart_is_undone_and_redone(
    flat_studio: Page,
) -> None:
    run, tip = flat_studio.locator("#stretch-run"), flat_studio.locator(".tip")
    run.hover()
    expect(tip).to_contain_text("Pull the chart")
    run.evaluate("button => { button.title = 'Cancel the test (J)' }")
    expect(tip).to_contain_text("Cancel the test")
    flat_studio.mouse.move(5, 5)
    expect(tip).to_be_hidden()
    expect(run).to_have_attribute("title", "Cancel the test (J)")

    drag(flat_studio, 60, 0)
    drag(flat_studio, 0, 60, start=(-60, -40))
    flat_studio.keyboard.press("x")
    after = kept_chart(flat_studio)
    for _ in range(3):
        flat_studio.keyboard.press("Control+z")
    assert kept_chart(flat_studio) == CHART
    expect(flat_studio.locator("#action-undo")).to_be_disabled()
    for _ in range(3):
        flat_studio.keyboard.press("Control+Shift+Z")
    assert kept_chart(flat_studio) == after != CHART


def test_stretch_moves_chart_curve_and_3d_together(studio: Page) -> None:
    drag(studio, 90, 40)
    wait_for_colour(studio, "#fabric", 1_500)
    studio.click("#stretch-course")
    slider = stretched(studio, "20")
    expect(studio.locator("#stretch-figures")).to_contain_text("20 %")
    expect(studio.locator("#overlay-strain")).to_have_attribute("aria-checked", "true")
    expect(studio.locator("#plot-curve .main-svg").first).to_be_visible()
    caption = studio.locator(".fabric-caption")
    expect(caption).to_contain_text("Stretched along the rows by 20 %")
    settle(studio)
    chart, curve = pixels(studio, "#chart"), pixels(studio, "#plot-curve")
    figures = studio.locator("#stretch-figures").inner_text()
    with sent_view(studio) as answer:
        slider.focus()
        for _ in range(12):
            studio.keyboard.press("ArrowLeft")

    assert answer.value.ok
    expect(studio.locator("#stretch-figures")).not_to_have_text(figures)
    expect(caption).not_to_contain_text("Stretched along the rows by 20 %")
    wait_for_change(studio, "#chart", chart, 40)
    wait_for_change(studio, "#plot-curve", curve, 40)
    wait_for_colour(studio, "#fabric", 300)


@pytest.mark.slow
def test_a_change_marks_the_stretch_as_old_until_it_is_pulled_again(flat_studio: Page) -> None:
    flat_studio.select_option("#stretch-unit", "N")
    slider = stretched(flat_studio, "0.5")
    expect(flat_studio.locator("#stretch-figures")).to_contain_text("0.5")
    expect(flat_studio.locator("#stretch-note")).to_contain_text("No stitch runs out of stretch")
    flat_studio.evaluate("() => { window.fetch = () => new Promise(() => {}) }")
    drag(flat_studio, 30, 0)
    expect(flat_studio.locator("#stretch")).to_have_class(re.compile("busy"))
    expect(slider).to_be_disabled()
    strain = flat_studio.locator("#overlay-strain")
    expect(strain).to_be_disabled()
    expect(strain).to_have_attribute("aria-checked", "false")
    expect(flat_studio.locator("#overlay-fabrics")).to_have_attribute("aria-checked", "true")
    expect(flat_studio.locator("#readout")).not_to_contain_text("stretch")


@pytest.mark.slow
def test_a_stretch_close_to_the_lock_up_is_marked(flat_studio: Page) -> None:
    flat_studio.click("#stretch-course")
    flat_studio.fill("#stretch-amount", "60")
    flat_studio.click("#stretch-run")
    note = flat_studio.locator("#stretch-note")
    expect(note).to_contain_text("not a certified test.")
    expect(note).to_contain_text(re.compile(r"the tightest has used 9\d % of it"))
    with flat_studio.expect_download() as saved:
        flat_studio.click("#stretch-save")
    head, *steps = saved.value.path().read_text().splitlines()
    assert head.startswith("strain,force_n,")
    assert float(steps[-1].split(",")[0]) == pytest.approx(0.6)


@pytest.mark.slow
def test_the_slider_is_dragged_back_to_rest_and_the_colours_say_so(flat_studio: Page) -> None:
    page, failures = flat_studio, []
    page.on("pageerror", lambda error: failures.append(error.message))
    slider = stretched(page, "20")
    page.click("#tab-curve")
    expect(page.locator("#plot-curve .main-svg").first).to_be_visible()
    page.click("#overlay-strain")
    slider.evaluate(
        """slider => [3, 2, 1, 0, -1].forEach((step) => {
            slider.value = step;
            slider.dispatchEvent(new Event("input"));
        })"""
    )
    expect(page.locator("#stretch-figures")).to_contain_text("Unstretched")
    expect(page.locator("#overlay-fabrics")).to_have_attribute("aria-checked", "true")
    expect(page.locator(".legend")).to_contain_text("stockinette")
    expect(page.locator("#overlay-crosses")).to_be_disabled()
    slider.press("End")
    expect(page.locator("#overlay-strain")).to_have_attribute("aria-checked", "true")
    expect(page.locator(".legend")).to_contain_text("Stretch along")
    settle(page)  # plots are moved in tasks of their own
    assert not failures


@pytest.mark.slow
def test_another_design_does_not_show_this_one_s_stretch(flat_studio: Page) -> None:
    stretched(flat_studio, "10")
    flat_studio.keyboard.press("Shift+N")
    flat_studio.click("#gallery-seed")
    expect(flat_studio.locator("#stretch-slider")).to_be_disabled()
    expect(flat_studio.locator("#stretch-figures")).not_to_contain_text("10 %")
