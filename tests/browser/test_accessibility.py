"""Everybody can use the page: axe finds nothing serious, keys reach everything."""

import io
from collections.abc import Callable

import pytest
from PIL import Image
from playwright.sync_api import Page, ViewportSize, expect

from tests.browser.axe import violations_in_both_themes
from tests.browser.conftest import flat, wait_for_numbers
from tests.browser.page import drop, kept_chart, purls, settle


def open_yarn_form(page: Page) -> None:
    """Own yarns, with all that can be told of a new one."""
    page.keyboard.press("Shift+Y")
    page.click("#yarn-new")
    for summary in page.locator("#yarn-maker summary").all():
        summary.click()


def open_swatch_form(page: Page) -> None:
    """A yarn measured at home, at its photos."""
    page.keyboard.press("Shift+Y")
    page.click("#yarn-swatch")
    for field, value in (("name", "Mine"), ("stitches", "20"), ("rows", "28")):
        page.locator(f"#swatch-{field}").evaluate("(field, value) => (field.value = value)", value)
    page.click("#swatch-step-4")


def open_planner(page: Page) -> None:
    """A plan with an own gauge, which has the widest rows."""
    page.keyboard.press("Control+Shift+G")
    page.check("#planner-own-gauge")


MENUS = ["designs", "material", "export"]
PANELS: dict[str, Callable[[Page], None]] = {
    "help-dialog": lambda page: page.keyboard.press("?"),
    "palette-dialog": lambda page: page.keyboard.press("Control+k"),
    "resize-dialog": lambda page: page.click("#chart-size"),
    "import-dialog": lambda page: page.click("#action-import"),
    "designs-dialog": lambda page: page.keyboard.press("Control+o"),
    "gallery-dialog": lambda page: page.keyboard.press("Shift+N"),
    "versions-dialog": lambda page: page.keyboard.press("Control+s"),
    "share-dialog": lambda page: page.click("#action-share"),
    "planner-dialog": open_planner,
    "export-dialog": lambda page: page.keyboard.press("Control+e"),
    "panel-stitches": lambda page: page.keyboard.press("c"),
    "panel-regions": lambda page: page.keyboard.press("Shift+A"),
    "panel-repeats": lambda page: page.keyboard.press("Shift+L"),
    "compare-dialog": lambda page: page.keyboard.press("Shift+C"),
    "yarns-dialog": open_yarn_form,
    "inverse": lambda page: page.keyboard.press("a"),
}


@pytest.mark.slow
def test_nothing_serious_is_wrong_in_any_panel_in_both_themes(flat_studio: Page) -> None:
    page, faults = flat_studio, []

    def look(name: str, within: str) -> None:
        faults.extend(f"{name}, {wrong}" for wrong in violations_in_both_themes(page, within))

    look("page", "body")
    page.click("#tab-limb")
    expect(page.locator(".limb-pressure")).to_contain_text("mmHg")
    look("limb", "#inspector")
    page.click("#tab-drape")
    look("drape", "#inspector")
    page.click("#tab-curve")
    expect(page.locator("#plot-curve .main-svg").first).to_be_visible()
    page.click("#provenance")
    page.click("#inspector-details summary")
    look("source", "#inspector")
    page.focus("#chart")
    for name in MENUS:
        page.click(f"#{name}-button")
        look(name, f"#{name}-menu")
        page.keyboard.press("Escape")
    for name, open_panel in PANELS.items():
        open_panel(page)
        expect(page.locator(f"#{name}")).to_be_visible()
        expect(page.locator(f"#{name} .busy, #{name}.busy")).to_have_count(0)  # greyed till known
        look(name, f"#{name}")
        page.locator(f"#{name} header").get_by_label("Close").click()
        expect(page.locator(f"#{name}")).to_be_hidden()
    assert not faults, "\n".join(faults)


@pytest.mark.slow
def test_nothing_serious_is_wrong_where_targets_and_pictures_are_given(flat_studio: Page) -> None:
    page, faults = flat_studio, []
    picture = io.BytesIO()
    Image.effect_mandelbrot((60, 40), (-2, -1, 1, 1), 20).save(picture, "PNG")
    page.keyboard.press("Shift+F")
    expect(page.locator("#inverse-find-content")).to_be_visible()
    faults += violations_in_both_themes(page, "#inverse")
    page.click("#inverse-close")
    page.keyboard.press("Shift+W")
    for way in ("outline", "stiffness"):
        page.click(f"#fill-{way}")
        faults += violations_in_both_themes(page, "#panel-fill")
    page.keyboard.press("Escape")
    page.click("#stretch-more")
    faults += violations_in_both_themes(page, "#stretch-options")
    page.keyboard.press("Escape")
    drop(page, "purls.png", "image/png", picture.getvalue())
    expect(page.locator("#picture-dialog")).to_be_visible()
    faults += violations_in_both_themes(page, "#picture-dialog")
    assert not faults, "\n".join(faults)


@pytest.mark.slow
def test_nothing_serious_is_wrong_in_any_stop_of_the_tour(flat_studio: Page) -> None:
    page, faults = flat_studio, []
    page.click("#designs-button")
    page.click("#menu-tour")
    expect(page.locator("#tour")).to_be_visible()
    stops = 0
    while page.locator("#tour").is_visible():
        title = page.locator("#tour-title").inner_text()
        faults += [f"{title}, {wrong}" for wrong in violations_in_both_themes(page, "#tour")]
        page.keyboard.press("ArrowRight")
        stops += 1
    assert stops >= 8
    assert not faults, "\n".join(faults)


def test_a_chart_is_painted_with_keys_alone(flat_studio: Page) -> None:
    page = flat_studio
    for _ in range(60):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement.id") == "chart":
            break
    expect(page.locator("#chart")).to_be_focused()
    for key in ("ArrowUp", "ArrowUp", "ArrowLeft", "Enter"):
        page.keyboard.press(key)
    assert purls(kept_chart(page)) == {(2, 2)}
    frame = "getComputedStyle(document.activeElement.parentElement).borderTopColor"
    focused = page.evaluate(frame)
    page.evaluate("document.querySelector('.design-name').focus()")
    left = page.evaluate(
        frame.replace("activeElement.parentElement", "querySelector('.chart-host')")
    )
    assert focused != left, "the focus cannot be seen"


def test_the_palette_finds_what_is_meant_and_keeps_its_keys(flat_studio: Page) -> None:
    """Enter does not press what had the focus before."""
    page = flat_studio
    page.focus("#chart-size")
    page.keyboard.press("Control+k")
    page.fill("#command-search", "Keys and tools")
    page.keyboard.press("Enter")
    expect(page.locator("#help-dialog")).to_be_visible()
    expect(page.locator("dialog[open]")).to_have_count(1)
    page.keyboard.press("Escape")
    expect(page.locator("dialog[open]")).to_have_count(0)
    page.focus("#chart")
    meant = {
        "2x2 rib": "Paint with 2×2 rib",
        "cotton yarn": "Yarn: Pearl cotton 3/2",
        "pressure": "Pressure on a limb",
        "strain": "Stress–strain curves",
        "colour fabrics": "Colour the chart by: fabrics",
        "rest": "Show the cloth: unpinned",
    }
    page.keyboard.press("Control+k")
    for typed, label in meant.items():
        page.fill("#command-search", typed)
        expect(page.get_by_role("option", name=label, exact=True)).to_be_visible()
    page.fill("#command-search", "rib")
    expect(page.get_by_role("option", name="Paint with Seed")).to_have_count(0)
    page.fill("#command-search", "pressure")
    page.keyboard.press("Enter")
    expect(page.locator("#plot-limb")).to_be_visible()


def test_everything_is_still_and_in_reach_on_small_screens(flat_studio: Page) -> None:
    """Also at a zoom of 200 % and on a phone: nothing is cut off or scrolls sideways. The visitor
    wants reduced motion."""
    page = flat_studio
    moving = page.evaluate(
        """() => [...document.querySelectorAll('*')].filter((element) => {
            const { transitionDuration, animationName } = getComputedStyle(element);
            return Number.parseFloat(transitionDuration) > 0 || animationName !== 'none';
        }).map(({ id, className }) => `${id}.${className}`)"""
    )
    assert moving == []
    page.fill(".design-name", "Therapeutic glove for the right hand, to be tried in three yarns")
    sizes = [(1280, 720), (1024, 768), (820, 1180), (720, 450), (640, 400), (390, 844)]
    for width, height in sizes:
        page.set_viewport_size({"width": width, "height": height})
        settle(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        for part in ("#designs-button", "#action-undo", "#export-button", "#action-help", "#chart"):
            box = page.locator(part).bounding_box()
            assert box, f"{part} is not shown at {width}"
            assert box["x"] >= 0
            assert box["x"] + box["width"] <= width, f"{part} is cut off at {width}"
            assert box["x"] + box["width"] <= width + 0.5, f"{part} is cut off at {width}"
        chart = page.locator("#chart").bounding_box()
        assert chart
        assert chart["width"] > 300
        assert chart["height"] > 180


def test_chart_and_cloth_have_the_whole_screen_of_a_phone_and_panels_leave_them_in_sight(
    flat_studio: Page,
) -> None:
    """Their drawer is closed until it is needed."""
    page = flat_studio
    phone: ViewportSize = {"width": 390, "height": 844}
    page.set_viewport_size(phone)
    page.keyboard.press("Shift+A")
    dock, chart = (page.locator(part) for part in ("#panel-regions", "#chart"))
    expect(dock).to_be_visible()
    page.wait_for_function("() => document.querySelector('#chart').clientWidth > 300")
    below, above = dock.bounding_box(), chart.bounding_box()
    assert below
    assert above
    assert below["y"] >= above["y"] + above["height"] - 1
    page.focus("#chart")
    page.keyboard.press("Shift+W")
    expect(page.locator("#part-add")).to_be_in_viewport()
    page.reload()
    settle(page)
    expect(page.locator("#stretch-run")).to_be_hidden()
    page.click("#stretch-fold")
    expect(page.locator("#stretch-run")).to_be_visible()
    page.click("#stretch-fold")
    for part, whole in (("chart", ".studio"), ("cloth", "#fabric")):
        page.click(f"#full-{part}")
        expect(page.locator(f"#full-{part}")).to_have_attribute("aria-pressed", "true")
        box = page.locator(whole).bounding_box()
        assert box
        assert (box["width"], box["height"]) == (phone["width"], phone["height"])
        page.click(f"#full-{part}")
        expect(page.locator("#action-undo")).to_be_in_viewport()


def test_a_first_visit_on_a_phone_begins_with_the_chart(visitor: Page, service: str) -> None:
    """No drawer covers the patterns to paint with."""
    page = flat(visitor)
    page.set_viewport_size({"width": 390, "height": 844})
    page.goto(service)
    wait_for_numbers(page)
    expect(page.locator("#stretch-run")).to_be_hidden()
    expect(page.locator("#ink-purl")).to_be_in_viewport(ratio=1)


def test_a_menu_is_not_covered_by_the_name_of_its_button(flat_studio: Page) -> None:
    flat_studio.hover("#material-button .ellipsis")
    expect(flat_studio.locator(".tip")).to_be_visible()
    flat_studio.click("#material-button")
    expect(flat_studio.locator("#material-menu")).to_be_visible()
    flat_studio.mouse.move(600, 600)
    flat_studio.hover("#material-button .ellipsis")
    flat_studio.wait_for_timeout(300)
    expect(flat_studio.locator(".tip")).to_be_hidden()


CUT_OFF = """(id) => {
    const panel = document.getElementById(id);
    const { left, right } = panel.getBoundingClientRect();
    return [...panel.querySelectorAll("button, input:not([type=file]), select, textarea")]
        .filter((part) => part.checkVisibility() && !part.closest(".yarn-fabrics")) // that scrolls
        .filter((part) => {
            const box = part.getBoundingClientRect();
            const thin = part.matches(".text-field") && box.width < 80;
            return box.left < left || box.right > right || thin;
        })
        .map((part) => part.id || part.textContent);
}"""


@pytest.mark.slow
def test_panels_are_whole_and_do_not_scroll_sideways_on_a_phone(flat_studio: Page) -> None:
    page = flat_studio
    page.set_viewport_size({"width": 360, "height": 780})
    page.keyboard.press("x")  # a chart with something in it can be resized in three ways
    for name, open_panel in [*PANELS.items(), ("yarns-dialog", open_swatch_form)]:
        page.evaluate("document.activeElement.blur()")
        open_panel(page)
        expect(page.locator(f"#{name}")).to_be_visible()
        expect(page.locator(f"#{name} .busy, #{name}.busy")).to_have_count(0)
        assert page.evaluate(CUT_OFF, name) == [], name
        wide = page.evaluate(
            "(id) => [document.documentElement, document.getElementById(id)]"
            ".map((e) => e.scrollWidth - e.clientWidth)",
            name,
        )
        assert max(wide) <= 0, f"{name}: {wide}"
        page.locator(f"#{name} header").get_by_label("Close").click()
