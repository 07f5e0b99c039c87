"""Text and pictures one below the other, on as many A4 pages as they take."""

from __future__ import annotations

import io
import textwrap
from collections.abc import Sequence
from dataclasses import replace

from PIL import Image, ImageChops

from knitcore.base.errors import InputError
from knitcore.formats.write.chart_drawing import A4_MM
from knitcore.formats.write.chart_key import GRID, MARGIN_MM, SMALL_MM
from knitcore.formats.write.drawn_page import Label, Page, Photo, Rectangle, Shape

TITLE_MM, HEADING_MM, BODY_MM = 9.0, 5.0, 3.2
LINE = 1.45
"""Distance of lines over the size of their type."""
FOOT_MM = 16.0
PHOTO_MM = (A4_MM[0] - 2 * MARGIN_MM, 100.0)
MAX_PHOTO_BYTES, MAX_PHOTO_PIXELS = 4_000_000, 4096
_FAINT = 16
"""Largest difference of a colour channel (of 255) that still counts as a photo's background."""
_EM = 0.5
"""Mean width of a letter over the size of its type."""


class Flow:
    """Text and pictures one below the other, on as many pages as they take.

    Parameters
    ----------
    body_mm : size of the text.
    """

    def __init__(self, body_mm: float = BODY_MM) -> None:
        self._pages: list[list[Shape]] = [[]]
        self._y = MARGIN_MM
        self._body = body_mm

    def pages(self) -> list[Page]:
        """All pages so far."""
        return [Page(*A4_MM, tuple(shapes)) for shapes in self._pages]

    def title(self, text: str) -> None:
        """The title of the whole."""
        for line in _wrapped(text, TITLE_MM, A4_MM[0] - 2 * MARGIN_MM):
            self._y += TITLE_MM
            self.draw(Label(MARGIN_MM, self._y, line, TITLE_MM, bold=True))
        self._y += 3.0

    def heading(self, text: str) -> None:
        """A heading, which stays with the lines below it."""
        self._room(HEADING_MM * 2 + 3 * self._body * LINE)
        self._y += HEADING_MM * 1.6
        self.draw(Label(MARGIN_MM, self._y, text, HEADING_MM, bold=True))
        self._y += 1.5

    def subheading(self, text: str, *, box: bool = False) -> None:
        """A smaller heading, which stays with the lines below it; with an empty box to tick."""
        self._room(4 * self._body * LINE)
        self._y += self._body * 0.6
        self.text(text, bold=True, colour="#ffffff" if box else None)

    def text(
        self, text: str, *, bold: bool = False, colour: str | None = None, bullet: bool = False
    ) -> None:
        """A paragraph; a box of a colour, or a bullet, in front of it if asked for."""
        indent = 6.0 if colour else 3.0 if bullet else 0.0
        for index, line in enumerate(_wrapped(text, self._body, A4_MM[0] - 2 * MARGIN_MM - indent)):
            self._room(self._body * LINE)
            self._y += self._body * LINE
            if colour and not index:
                self._patch(colour)
            if bullet and not index:
                self.draw(Label(MARGIN_MM, self._y, "•", self._body))
            self.draw(Label(MARGIN_MM + indent, self._y, line, self._body, bold=bold))

    def row(
        self,
        cells: Sequence[str],
        places: Sequence[float],
        *,
        bold: bool = False,
        colour: str | None = None,
    ) -> None:
        """Cells of a table, each at its place; a box in front of them if a colour is given."""
        self._room(self._body * LINE)
        self._y += self._body * LINE
        if colour:
            self._patch(colour)
            places = (places[0] + 6.0, *places[1:])
        for text, place in zip(cells, places, strict=True):
            self.draw(Label(MARGIN_MM + place, self._y, text, self._body, bold=bold))

    def photo(self, png: bytes, caption: str) -> None:
        """A picture as large as its box allows, and a line below it."""
        png, (width, height) = _photo(png)
        scale = min(PHOTO_MM[0] / width, PHOTO_MM[1] / height)
        self._y += 4.0
        left = (A4_MM[0] - scale * width) / 2
        self.draw(Photo(left, self._y, scale * width, scale * height, png))
        self._y += scale * height + 4.0
        self.draw(Label(A4_MM[0] / 2, self._y, caption, SMALL_MM, "middle"))

    def place(self, height: float) -> float:
        """Keep room for a drawing, and give its upper edge, mm from the top of the page."""
        self._room(height)
        self._y += height
        return self._y - height

    def draw(self, shape: Shape) -> None:
        """Draw on the page that is being filled."""
        self._pages[-1].append(shape)

    def _patch(self, colour: str) -> None:
        self.draw(Rectangle(MARGIN_MM, self._y - 3.0, 3.6, 3.6, fill=colour, stroke=GRID))

    def _room(self, height: float) -> None:
        if self._y + height > A4_MM[1] - FOOT_MM:
            self._pages.append([])
            self._y = MARGIN_MM


def _wrapped(text: str, size: float, width: float) -> list[str]:
    return textwrap.wrap(text, int(width / (_EM * size))) or [""]


def _photo(png: bytes) -> tuple[bytes, tuple[int, int]]:
    """The picture on white paper without its empty edges, and its size in pixels."""
    if len(png) > MAX_PHOTO_BYTES:
        raise InputError(
            "photo", f"it has {len(png)} bytes.", f"Send at most {MAX_PHOTO_BYTES:,} bytes."
        )
    try:
        with Image.open(io.BytesIO(png), formats=["PNG"]) as image:
            if max(image.size) > MAX_PHOTO_PIXELS:  # before any pixel is decoded
                problem = f"it has {image.width}x{image.height} pixels."
                raise InputError("photo", problem, f"Use at most {MAX_PHOTO_PIXELS} a side.")
            flat = Image.new("RGBA", image.size, "white")
            flat.alpha_composite(image.convert("RGBA"))
    except InputError:
        raise
    except (Image.DecompressionBombError, OSError, SyntaxError, ValueError):
        raise InputError("photo", "it is not a readable PNG.", "Send a PNG picture.") from None
    shown = _without_empty_edges(flat.convert("RGB"))
    buffer = io.BytesIO()
    shown.save(buffer, "PNG")
    return buffer.getvalue(), shown.size


def _without_empty_edges(image: Image.Image) -> Image.Image:
    """The part of a picture that differs from its corner, with a small margin."""
    ground = Image.new("RGB", image.size, image.getpixel((0, 0)))
    box = ImageChops.difference(image, ground).point(lambda value: 255 * (value > _FAINT)).getbbox()
    if box is None:
        return image
    left, top, right, bottom = box
    width, height = image.size
    rim = round(0.03 * max(width, height))
    return image.crop(
        (max(left - rim, 0), max(top - rim, 0), min(right + rim, width), min(bottom + rim, height))
    )


def numbered(pages: Sequence[Page], title: str) -> tuple[Page, ...]:
    """The pages with title and number at their feet."""
    count = len(pages)
    return tuple(
        _footed(page, f"{title}, page {number} of {count}")
        for number, page in enumerate(pages, start=1)
    )


def _footed(page: Page, text: str) -> Page:
    foot = Label(A4_MM[0] / 2, A4_MM[1] - 6.0, text, SMALL_MM, "middle")
    return replace(page, shapes=(*page.shapes, foot))
