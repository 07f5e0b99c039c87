"""Fingers on a tablet: one paints, two move and zoom."""

from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser.conftest import CHART, TIMEOUT_MS, flat, open_small_chart
from tests.browser.page import Chart, kept_chart, purls

pytestmark = pytest.mark.slow

Finger = tuple[float, float]
Touch = Callable[..., None]
STEPS = 8


@pytest.fixture
def tablet(browser: Browser, service: str) -> Iterator[Page]:
    """The small chart on a tablet, with an empty 3D view."""
    context = browser.new_context(
        viewport={"width": 1024, "height": 768}, has_touch=True, reduced_motion="reduce"
    )
    context.set_default_timeout(TIMEOUT_MS)
    yield open_small_chart(flat(context.new_page()), service)
    context.close()


@pytest.fixture
def touch(tablet: Page) -> Touch:
    """Sends what the screen feels: fingers, counted from the first, start, move or end."""
    session = tablet.context.new_cdp_session(tablet)

    def send(kind: str, *fingers: Finger, first: int = 0) -> None:
        points = [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(fingers, first)]
        session.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": points})

    return send


def glide(touch: Touch, start: list[Finger], end: list[Finger]) -> None:
    """Move fingers that are on the screen evenly."""
    for step in range(1, STEPS + 1):
        share = step / STEPS
        touch(
            "Move",
            *(
                (a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share)
                for a, b in zip(start, end, strict=True)
            ),
        )


def place(page: Page) -> tuple[float, float, float, float]:
    """Middle of the stitch in row 5, stitch 6, and the width and height of a stitch, pixels."""
    chart = Chart(page)
    x, y = chart.at(5, 6)
    return x, y, chart.stitches[5] - chart.stitches[6], chart.rows[5] - chart.rows[6]


def test_one_finger_paints(tablet: Page, touch: Touch) -> None:
    tablet.tap("#ink-purl")
    chart = Chart(tablet)
    start, end = chart.at(3, 9), chart.at(3, 5)
    touch("Start", start)
    glide(touch, [start], [end])
    touch("End")
    assert purls(kept_chart(tablet)) == {(3, stitch) for stitch in range(5, 10)}


def test_two_fingers_move_the_chart_and_paint_nothing(tablet: Page, touch: Touch) -> None:
    tablet.click("#action-zoom-in")
    tablet.click("#action-zoom-in")
    x, y, wide, high = place(tablet)
    fingers = [(x - 40, y), (x + 40, y)]
    moved = [(a + 30, b + 20) for a, b in fingers]
    touch("Start", fingers[0])  # one finger is always first, and begins to paint
    touch("Start", *fingers)
    glide(touch, fingers, moved)
    touch("End", moved[1], first=1)
    glide(touch, moved[:1], fingers[:1])  # the finger that stays does not paint either
    touch("End")
    x1, y1, wide1, high1 = place(tablet)
    assert (x1 - x, y1 - y) == pytest.approx((30, 20), abs=3)
    assert (wide1, high1) == pytest.approx((wide, high), abs=1)
    assert kept_chart(tablet) == CHART
    expect(tablet.locator("#action-undo")).to_be_disabled()


def test_two_fingers_zoom_about_the_point_between_them(tablet: Page, touch: Touch) -> None:
    x, y, wide, _ = place(tablet)
    near, far = [(x - 40, y), (x + 40, y)], [(x - 60, y), (x + 60, y)]
    touch("Start", *near)
    glide(touch, near, far)
    touch("End")
    x1, y1, wide1, _ = place(tablet)
    assert wide1 / wide == pytest.approx(1.5, rel=0.05)
    assert (x1, y1) == pytest.approx((x, y), abs=4)
    assert kept_chart(tablet) == CHART

    touch("Start", *far)
    glide(touch, far, near)
    touch("End")
    x2, y2, wide2, _ = place(tablet)
    assert wide2 == pytest.approx(wide, rel=0.05)
    assert (x2, y2) == pytest.approx((x, y), abs=4)


def test_one_finger_paints_again_after_a_pinch(tablet: Page, touch: Touch) -> None:
    tablet.tap("#ink-purl")
    x, y, *_ = place(tablet)
    touch("Start", (x - 40, y), (x + 40, y))
    touch("End")
    touch("Start", (x, y))
    touch("End")
    assert purls(kept_chart(tablet)) == {(5, 6)}
