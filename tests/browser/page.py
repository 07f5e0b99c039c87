"""What a person does and sees on the page."""

from __future__ import annotations

import io
import json

import numpy as np
from PIL import Image
from playwright.sync_api import Page


def kept_chart(page: Page) -> str:
    """The chart as the browser keeps it, once it is kept."""
    page.wait_for_function("() => !('unsaved' in document.documentElement.dataset)")
    return str(json.loads(page.evaluate("localStorage['knitcore.design']"))["chart"])


def middle(page: Page) -> tuple[float, float]:
    """The middle of the chart on the screen."""
    box = page.locator("#chart").bounding_box()
    assert box
    rulers = 9  # there is more room for rulers below the chart than above it
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2 - rulers


def drag(page: Page, dx: float, dy: float, *, start: tuple[float, float] = (0, 0)) -> None:
    """A stroke with the left button; offsets in pixels from the chart's middle."""
    x, y = middle(page)
    x, y = x + start[0], y + start[1]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + dx, y + dy, steps=6)
    page.mouse.up()


def pixels(page: Page, selector: str) -> np.ndarray:
    """Picture of a part of the page, (height, width, 3)."""
    box = page.locator(selector).bounding_box()
    assert box
    picture = page.screenshot(clip=box)
    return np.asarray(Image.open(io.BytesIO(picture)).convert("RGB")).astype(int)


def coloured(picture: np.ndarray) -> int:
    """Number of pixels that are clearly not grey, nor the page's warm neutrals."""
    return int(((picture.max(axis=-1) - picture.min(axis=-1)) > 22).sum())


def wait_for_colour(page: Page, selector: str, least: int) -> np.ndarray:
    """The picture of a part of the page once it has so many coloured pixels."""
    for _ in range(40):
        picture = pixels(page, selector)
        if coloured(picture) >= least:
            return picture
        page.wait_for_timeout(700)
    raise AssertionError(f"{selector} has {coloured(picture)} coloured pixels, not {least}")


def number(page: Page, selector: str) -> float:
    """A number on show."""
    return float(page.locator(f"{selector} .value").inner_text().replace("−", "-"))
