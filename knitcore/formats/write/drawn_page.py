"""A page of simple shapes, written as SVG or PDF.

Lengths in mm; the origin is the top left corner, y points down.
"""

import base64
import io
import re
import unicodedata
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from xml.etree import ElementTree as ET

MM_PER_POINT = 25.4 / 72.0
CONDENSED = 0.87
"""Width of the letters of a PDF over their font's, which are wider than those of an SVG."""
REGULAR, BOLD = "DejaVuSans", "DejaVuSans-Bold"
"""Latin, Greek and Cyrillic letters with all their accents, fractions, arrows and signs."""
_FONTS = Path(__file__).parent / "fonts"


@dataclass(frozen=True)
class Rectangle:
    """A rectangle; ``fill`` and ``stroke`` are ``#rrggbb`` or None."""

    x: float
    y: float
    width: float
    height: float
    fill: str | None = None
    stroke: str | None = None
    line_width: float = 0.2


@dataclass(frozen=True)
class Lines:
    """Straight lines of one width and colour, each from (x, y) to (x, y)."""

    lines: tuple[tuple[float, float, float, float], ...]
    stroke: str
    line_width: float


@dataclass(frozen=True)
class Dots:
    """Filled circles of one size and colour."""

    centres: tuple[tuple[float, float], ...]
    radius: float
    fill: str


@dataclass(frozen=True)
class Label:
    """A line of text on its baseline; ``anchor`` is start, middle or end."""

    x: float
    y: float
    text: str
    size: float = 3.0
    anchor: str = "start"
    bold: bool = False


@dataclass(frozen=True)
class Photo:
    """A PNG picture, stretched to a box."""

    x: float
    y: float
    width: float
    height: float
    png: bytes


_FORBIDDEN = re.compile(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

Shape = Rectangle | Lines | Dots | Label | Photo


@dataclass(frozen=True)
class Page:
    """Shapes on paper, in the order in which they are drawn."""

    width: float
    height: float
    shapes: tuple[Shape, ...]


def to_svg(page: Page, title: str) -> str:
    """The page as an SVG document."""
    root = _svg_root(page.width, page.height, title)
    _svg_page(root, page)
    return ET.tostring(root, encoding="unicode") + "\n"


def to_long_svg(pages: Sequence[Page], title: str) -> str:
    """All pages as one SVG document, one below the other."""
    width, height = max(page.width for page in pages), sum(page.height for page in pages)
    root, top = _svg_root(width, height, title), 0.0
    for page in pages:
        _svg_page(ET.SubElement(root, "g", transform=f"translate(0 {top:g})"), page)
        top += page.height
    return ET.tostring(root, encoding="unicode") + "\n"


def _svg_root(width: float, height: float, title: str) -> ET.Element:
    root = ET.Element(
        "svg",
        xmlns="http://www.w3.org/2000/svg",
        width=f"{width:g}mm",
        height=f"{height:g}mm",
        viewBox=f"0 0 {width:g} {height:g}",
        role="img",
    )
    ET.SubElement(root, "title").text = _allowed(title)
    return root


def _svg_page(parent: ET.Element, page: Page) -> None:
    size = {"width": f"{page.width:g}", "height": f"{page.height:g}"}
    ET.SubElement(parent, "rect", size, fill="#ffffff")
    for shape in page.shapes:
        _svg(parent, shape)


def _svg(root: ET.Element, shape: Shape) -> None:
    match shape:
        case Rectangle():
            box = ET.SubElement(root, "rect", _place(shape), fill=shape.fill or "none")
            if shape.stroke:
                box.set("stroke", shape.stroke)
                box.set("stroke-width", f"{shape.line_width:g}")
        case Lines():
            drawn = "".join(f"M{a:.3f} {b:.3f}L{c:.3f} {d:.3f}" for a, b, c, d in shape.lines)
            path = ET.SubElement(root, "path", d=drawn, fill="none", stroke=shape.stroke)
            path.set("stroke-width", f"{shape.line_width:g}")
        case Dots():
            group = ET.SubElement(root, "g", fill=shape.fill)
            for x, y in shape.centres:
                ET.SubElement(group, "circle", cx=f"{x:.3f}", cy=f"{y:.3f}", r=f"{shape.radius:g}")
        case Label():
            size = {"text-anchor": shape.anchor, "font-size": f"{shape.size:g}"}
            place = {"x": f"{shape.x:.3f}", "y": f"{shape.y:.3f}", "fill": "#222222"}
            text = ET.SubElement(root, "text", size | place)
            text.set("font-family", "Helvetica, Arial, sans-serif")
            if shape.bold:
                text.set("font-weight", "bold")
            text.text = _allowed(shape.text)
        case Photo():
            data = "data:image/png;base64," + base64.b64encode(shape.png).decode()
            ET.SubElement(root, "image", _place(shape), href=data)


def _place(shape: Rectangle | Photo) -> dict[str, str]:
    sides = ("x", "y", "width", "height")
    return {side: f"{getattr(shape, side):.3f}" for side in sides}


def _allowed(text: str) -> str:
    """A text without the characters that XML forbids, even escaped."""
    return _FORBIDDEN.sub("\N{REPLACEMENT CHARACTER}", text)


def to_pdf(pages: Iterable[Page], title: str) -> bytes:
    """The pages as a PDF document, the same bytes every time."""
    from reportlab.pdfgen.canvas import Canvas

    buffer = io.BytesIO()
    canvas = Canvas(buffer, invariant=1, pageCompression=1, initialFontName=_embedded(REGULAR))
    canvas.setTitle(title)
    for page in pages:
        canvas.setPageSize((page.width / MM_PER_POINT, page.height / MM_PER_POINT))
        canvas.scale(1 / MM_PER_POINT, 1 / MM_PER_POINT)
        for shape in page.shapes:
            _pdf(canvas, shape, page.height)
        canvas.showPage()
    canvas.save()
    return buffer.getvalue()


def _pdf(canvas: object, shape: Shape, top: float) -> None:
    from reportlab.lib.colors import HexColor
    from reportlab.lib.utils import ImageReader
    from reportlab.pdfgen.canvas import Canvas

    assert isinstance(canvas, Canvas)  # noqa: S101 - reportlab has no types
    match shape:
        case Rectangle():
            if shape.fill:
                canvas.setFillColor(HexColor(shape.fill))
            if shape.stroke:
                canvas.setStrokeColor(HexColor(shape.stroke))
                canvas.setLineWidth(shape.line_width)
            canvas.rect(
                shape.x,
                top - shape.y - shape.height,
                shape.width,
                shape.height,
                fill=int(shape.fill is not None),
                stroke=int(shape.stroke is not None),
            )
        case Lines():
            canvas.setStrokeColor(HexColor(shape.stroke))
            canvas.setLineWidth(shape.line_width)
            canvas.lines([(a, top - b, c, top - d) for a, b, c, d in shape.lines])
        case Dots():
            canvas.setFillColor(HexColor(shape.fill))
            path = canvas.beginPath()
            for x, y in shape.centres:
                path.circle(x, top - y, shape.radius)
            canvas.drawPath(path, fill=1, stroke=0)
        case Label():
            font = _embedded(BOLD if shape.bold else REGULAR)
            width = CONDENSED * canvas.stringWidth(shape.text, font, shape.size)
            before = {"start": 0.0, "middle": width / 2, "end": width}[shape.anchor]
            line = canvas.beginText(shape.x - before, top - shape.y)
            line.setFont(font, shape.size)
            line.setHorizScale(100 * CONDENSED)
            line.setFillColor(HexColor("#222222"))
            line.textOut(shape.text)
            canvas.drawText(line)
        case Photo():
            bottom = top - shape.y - shape.height
            photo = ImageReader(io.BytesIO(shape.png))
            canvas.drawImage(photo, shape.x, bottom, shape.width, shape.height, mask="auto")


def letters_lacking(texts: Iterable[str]) -> str:
    """Letters that a PDF shows as empty boxes, or in the wrong order as it writes to the right."""
    from reportlab.pdfbase import pdfmetrics

    known = pdfmetrics.getFont(_embedded(REGULAR)).face.charToGlyph
    letters = dict.fromkeys(letter for text in texts for letter in text if letter.isprintable())
    leftward = ("R", "AL")
    return "".join(
        letter
        for letter in letters
        if ord(letter) not in known or unicodedata.bidirectional(letter) in leftward
    )


@lru_cache
def _embedded(font: str) -> str:
    """Register a font, of which the letters in use are embedded in the file; return its name.

    Printers ask for embedded fonts; the licence of DejaVu allows it.
    """
    from reportlab.pdfbase import pdfmetrics
    from reportlab.pdfbase.ttfonts import TTFont

    pdfmetrics.registerFont(TTFont(font, str(_FONTS / f"{font}.ttf")))
    return font
