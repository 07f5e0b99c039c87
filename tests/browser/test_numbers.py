"""Mechanics on the page: stretch tests, their intervals, measured curves, targets."""

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import pytest
from playwright.sync_api import Page, expect

from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import MeasuredCurve, material
from knitcore.materials.material_document import MaterialDocument
from tests.browser.conftest import flat, open_small_chart
from tests.browser.page import Chart, drag, kept_chart

NUMBER = r"−?\d+(\.\d+)?"
LEARNED = "How sure? Estimated from simulations"
INTERVAL = rf"{NUMBER}( – | to ){NUMBER}"
WAISTED = "\n".join(["x" * 12] * 3 + ["..xxxxxxxx.."] * 4 + ["x" * 12] * 3)
RIBBED = "\n".join(["KPKPKPKKKKKK"] * 5 + ["KKKKKKKPKPKP"] * 5)
LEFT = {
    "id": "left",
    "name": "Left",
    "colour": "#8a5a9e",
    "runs": [[row, 0, 6] for row in range(10)],
}


def open_design(page: Page, service: str, **content: object) -> Page:
    """Show a design, by default a ribbed one, with an empty 3D view."""
    whole = {"format": "knitcore-design", "version": 2, "chart": RIBBED} | content
    return open_small_chart(flat(page), service, **whole)


@pytest.mark.slow
def test_a_shaped_piece_is_stretched_and_every_number_has_its_interval(
    visitor: Page, service: str
) -> None:
    page = open_design(visitor, service, outline=WAISTED)
    expect(page.locator("#inspector h2")).to_contain_text("12 × 10")
    expect(page.locator("#inspector h2")).to_have_attribute(
        "title", re.compile("largest rectangle inside the outline, 8 x 10")
    )
    for number in ("modulus-course", "extensibility-wale", "poisson-yx"):
        expect(page.locator(f"#{number} .interval")).to_have_text(re.compile(INTERVAL))
    page.click("#stretch-run")
    figures = page.locator("#stretch-figures .interval")
    expect(figures).to_have_count(3)  # force, stress and waist
    for k in range(3):
        expect(figures.nth(k)).to_have_text(re.compile(rf"{INTERVAL}|times less or more"))
    chart = Chart(page)
    readout = page.locator("#readout")
    page.mouse.move(*chart.at(5, 6))
    expect(readout).to_have_text(re.compile(rf"stretch {NUMBER} % \({INTERVAL}\)"))
    page.click("#overlay-utilisation")
    page.mouse.move(*chart.at(6, 6))
    expect(readout).to_have_text(re.compile(rf"\d+ % \({INTERVAL}\) of its stretch used"))


@pytest.mark.slow
def test_ones_own_gauge_makes_the_numbers_of_its_cloth_more_certain(
    visitor: Page, service: str
) -> None:
    """Painting leaves it behind, undoing brings it back; stretch tests and files have its size."""
    page = open_design(visitor, service)
    source, size = page.locator("#provenance"), page.locator("#size-course .value")
    expect(source).to_have_text(LEARNED)
    guessed = size.inner_text()
    source.click()
    page.get_by_role("button", name="Count the gauge of your swatch").click()
    expect(page.locator("#own-gauge-stitches")).to_be_focused()
    page.fill("#own-gauge-stitches", "25")
    page.fill("#own-gauge-rows", "36")
    page.press("#own-gauge-rows", "Enter")
    expect(source).to_have_text(f"{LEARNED} and a known size")
    expect(size).to_have_text("4.80")  # 12 stitches
    expect(page.locator("#narrower")).not_to_contain_text("Count the gauge")
    with page.expect_request("**/api/v1/jobs") as sent:
        page.click("#stretch-run")
    counted = {"stitches_per_10_cm": 25, "rows_per_10_cm": 36}
    assert sent.value.post_data_json["request"]["gauge"] == counted
    page.keyboard.press("Control+E")
    with page.expect_request("**/api/v1/export") as exported:
        page.click("#export-make")
    assert exported.value.post_data_json["gauge"] == counted
    page.keyboard.press("Escape")
    page.mouse.click(*Chart(page).at(4, 4))
    expect(source).to_have_text(LEARNED)
    expect(page.locator("#own-gauge-stitches")).to_have_value("")
    page.keyboard.press("Control+z")
    expect(source).to_have_text(f"{LEARNED} and a known size")
    expect(page.locator("#own-gauge-stitches")).to_have_value("25")
    page.reload()
    expect(source).to_have_text(f"{LEARNED} and a known size")
    source.click()
    for field in ("stitches", "rows"):
        page.fill(f"#own-gauge-{field}", "")
        page.press(f"#own-gauge-{field}", "Enter")
    expect(size).to_have_text(guessed)


@pytest.mark.slow
def test_a_counted_gauge_counts_in_3d_in_tests_and_in_a_fill(visitor: Page, service: str) -> None:
    """A part's own gauge counts for that part only, and the page says so."""
    page = open_design(visitor, service)

    counted = {"stitches_per_10_cm": 20, "rows_per_10_cm": 28}

    def is_sent(address: str, act: Callable[[], None]) -> None:
        """Wait for a request of the counted cloth."""
        with page.expect_request(
            lambda sent: address in sent.url and (sent.post_data_json or {}).get("gauge") == counted
        ):
            act()

    def count(stitches: str, rows: str) -> None:
        page.fill("#own-gauge-stitches", stitches)
        page.fill("#own-gauge-rows", rows)
        page.press("#own-gauge-rows", "Enter")

    is_sent("/views/", partial(count, "20", "28"))
    for operation, pose in (("curl", "lying"), ("limb", "worn")):
        is_sent(f"/{operation}", partial(page.click, f"#fabric-{pose}"))
    is_sent("/limb", partial(page.click, "#tab-limb"))
    expect(page.locator("#limb-answer")).to_contain_text("unworn")
    page.click("#tab-drape")
    is_sent("/overhang", partial(page.click, "#drape-overhang"))
    expect(page.locator("#drape-answer")).to_contain_text("Bending length")
    is_sent("/drape", partial(page.click, "#drape-drape"))
    is_sent("/hang", partial(page.click, "#drape-hang"))

    page.keyboard.press("Shift+W")
    page.click("#part-add")
    expect(page.locator("#part-0-course-now")).to_have_text(re.compile(NUMBER))
    expect(page.locator("#parts-uncounted")).to_be_hidden()
    page.fill("#part-0-course", "0.3")
    with page.expect_request("**/api/v1/jobs") as filling:
        page.click("#fill-run")
    assert filling.value.post_data_json["request"]["targets"][0]["gauge"] == counted
    expect(page.locator("#fill-answer")).to_contain_text("Before: with your gauge.")
    page.click("#fill-back")

    page.keyboard.press("m")
    drag(page, 60, 40)
    page.click("#part-add")
    expect(page.locator("#parts-uncounted")).to_contain_text("parts of it have their computed size")
    count("22", "30")
    expect(page.locator("#gauge-scope")).to_contain_text("of this part only")
    expect(page.locator("#parts-uncounted")).to_be_hidden()


@pytest.mark.slow
def test_a_repeat_of_a_simulated_material_is_relaxed_while_painting_pauses(
    visitor: Page, service: str
) -> None:
    """After any stretch test. Its size is then known, unless somebody counts a gauge."""
    chart = "\n".join(["KPPKK", "KKPPK", "PPPKP"])
    page = open_design(visitor, service, chart=chart, material="acrylic:simulation")
    source = page.locator("#provenance")
    expect(source).to_have_text(f"{LEARNED}, relaxing …")
    guessed = page.locator("#hand-course .interval").inner_text()
    with page.expect_request(lambda sent: sent.method == "DELETE" and "/jobs/" in sent.url):
        page.click("#stretch-run")
    expect(source).to_have_text(f"{LEARNED} and a known size")
    expect(page.locator("#hand-course .interval")).not_to_have_text(guessed)
    source.click()
    expect(page.locator(".source .notes")).to_contain_text("simulation of the yarn")
    expect(page.locator("#own-gauge-stitches")).to_have_value("")
    page.fill("#own-gauge-stitches", "25")
    page.fill("#own-gauge-rows", "36")
    page.press("#own-gauge-rows", "Enter")
    expect(page.locator(".source .notes")).not_to_contain_text("simulation of the yarn")


@pytest.fixture
def own_material(visitor: Page, service: str) -> Iterator[str]:
    """Name of a material of a user, with one measured curve."""
    acrylic = material("acrylic")
    curve = MeasuredCurve((0.0, 0.1, 0.2, 0.3), (0.0, 0.006, 0.013, 0.022), pulls=4)
    fabrics = {**acrylic.fabrics}
    fabrics[Fabric.GARTER] = replace(fabrics[Fabric.GARTER], measured={Direction.WALE: curve})
    mine = replace(acrylic, identifier="mine", name="My acrylic", fabrics=fabrics)
    document = MaterialDocument.from_material(mine).model_dump(mode="json")
    materials = f"{service}api/v1/materials"
    added = visitor.request.post(materials, data=document).json()
    yield mine.name
    visitor.request.delete(f"{materials}/{added['id']}")


@pytest.mark.slow
def test_measured_curves_of_an_own_material_are_drawn_as_points(
    visitor: Page, service: str, own_material: str
) -> None:
    page = open_design(visitor, service)
    page.click("#material-button")
    page.get_by_role("menuitemradio", name=own_material).click()
    expect(page.locator("#material-button")).to_contain_text(own_material)
    page.click("#tab-curve")
    page.click("#curve-wale")
    page.wait_for_function(
        """() => document.querySelector('#plot-curve')?.data?.some(
            ({ name, mode, x }) =>
                name === 'garter, measured' && mode === 'markers' && x.length === 4)"""
    )
    page.click("#curve-course")
    page.wait_for_function(
        """() => document.querySelector('#plot-curve').data.every(
            ({ name, x }) => !name.endsWith('measured') || x.length === 0)"""
    )


@pytest.mark.slow
def test_a_target_for_a_region_fills_only_that_region(visitor: Page, service: str) -> None:
    garter = material("acrylic").law(Fabric.GARTER)
    page = open_design(visitor, service, regions=[LEFT])
    page.keyboard.press("Shift+W")
    page.click("#part-regions")
    fill_first_part(page, garter)
    lines = kept_chart(page).split("\n")
    assert [line[6:] for line in lines] == [line[6:] for line in RIBBED.split("\n")]
    inner = {line[:5] for line in lines}
    assert inner == {"KKKKK", "PPPPP"}


@pytest.mark.slow
def test_a_target_for_a_selection_fills_only_the_selection(visitor: Page, service: str) -> None:
    garter = material("acrylic").law(Fabric.GARTER)
    page = open_design(visitor, service, outline=WAISTED)
    chart = Chart(page)
    page.click("#tool-select")
    page.mouse.move(*chart.at(3, 10))
    page.mouse.down()
    page.mouse.move(*chart.at(10, 5), steps=4)
    page.mouse.up()
    page.keyboard.press("Shift+W")
    page.click("#part-add")
    expect(page.locator(".part-count")).to_have_text("48 sts")
    fill_first_part(page, garter)
    before, after = RIBBED.split("\n"), kept_chart(page).split("\n")
    outside = [line[:2] + line[8:] for line in after]
    assert outside == [line[:2] + line[8:] for line in before]
    assert after[8:] == before[8:]
    assert after[:8] != before[:8]


def test_a_target_for_a_shaped_chart_covers_only_its_stitches(visitor: Page, service: str) -> None:
    page = open_design(visitor, service, outline=WAISTED)
    page.keyboard.press("Shift+W")
    page.click("#part-add")
    expect(page.locator(".part-count")).to_have_text("104 sts")


def fill_first_part(page: Page, law: ConstitutiveLaw) -> None:
    """Give the moduli of a law to the only part, fill it and keep that."""
    page.fill("#part-0-course", f"{law.modulus_course:.4f}")
    page.fill("#part-0-wale", f"{law.modulus_wale:.4f}")
    page.click("#fill-run")
    expect(page.locator("#fill-answer")).to_contain_text("On the chart now")
    page.click("#fill-keep")


@pytest.mark.slow
def test_what_a_chart_is_too_large_for_is_said_before_the_button(
    visitor: Page, service: str
) -> None:
    page = open_design(visitor, service, chart="\n".join(["K" * 250] * 200))
    expect(page.locator("#stretch-run")).to_be_enabled()
    page.keyboard.press("Shift+W")
    expect(page.locator("#fill-run")).to_be_disabled()
    page.click("#fill-outline")
    expect(page.locator("#outline-run")).to_be_disabled()
    expect(page.locator("#panel-fill")).to_contain_text("such as 100 × 100")
    page.keyboard.press("Escape")
    lying = page.locator("#fabric-lying")
    expect(lying).to_have_attribute("title", re.compile("too large"))
    lying.click(force=True)
    expect(page.locator("#messages")).to_contain_text("takes up to 10,000 stitches")
    expect(page.locator("#fabric-flat")).to_have_attribute("aria-checked", "true")


@pytest.mark.slow
def test_a_large_chart_is_pulled_in_blocks_and_each_stitch_has_a_value(
    visitor: Page, service: str
) -> None:
    page = open_design(visitor, service, chart="\n".join(["K" * 250] * 200))
    page.click("#stretch-run")
    expect(page.locator("#stretch-slider")).to_be_enabled()
    expect(page.locator(".stretch-note")).to_contain_text("3 × 3 stitches count as one")
    for share in (0.2, 0.5, 0.8):
        box = page.locator("#chart").bounding_box()
        assert box
        page.mouse.move(box["x"] + box["width"] / 2, box["y"] + share * box["height"])
        expect(page.locator("#readout")).to_contain_text(re.compile(rf"stretch {NUMBER} %"))
