"""Patterns to knit from."""

import io
import re
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from knitcore import InputError, StitchChart, material
from knitcore.chart.row_sides import Construction
from knitcore.formats.read.written_reader import read_rows
from knitcore.formats.write.chart_key import ChartStyle, RegionMark
from knitcore.formats.write.drawn_page import Label, Page, Photo, to_long_svg
from knitcore.formats.write.export import ExportKind, ExportOptions, export_chart
from knitcore.formats.write.pattern import pattern_pages
from knitcore.formats.write.sheets.flow import MAX_PHOTO_PIXELS
from knitcore.formats.write.written_pattern import write_rows
from knitcore.garment.piece import Piece
from knitcore.garment.shaped import ShapedChart

ACRYLIC = material("acrylic")
CHART = StitchChart(np.arange(24)[None, :] % 2 * (np.arange(16)[:, None] < 6) > 0)
HEM = np.broadcast_to(np.arange(16)[:, None] < 6, CHART.purl.shape)
STYLE = ChartStyle(
    title="Cuff", note="Wash cold.", regions=(RegionMark("ribbed hem", "#336699", HEM),)
)


def png(width: int, height: int) -> bytes:
    buffer = io.BytesIO()
    Image.new("RGBA", (width, height), "#33669980").save(buffer, "PNG")
    return buffer.getvalue()


def labels(pages: tuple[Page, ...]) -> list[Label]:
    return [shape for page in pages for shape in page.shapes if isinstance(shape, Label)]


@pytest.fixture(scope="module")
def pages() -> tuple[Page, ...]:
    return pattern_pages(Piece.plain(CHART), ACRYLIC, STYLE, ("384 sts, 4.0 m",), png(40, 30))


def test_a_pattern_has_all_that_a_knitter_needs(pages: tuple[Page, ...]) -> None:
    words = "\n".join(label.text for label in labels(pages))
    headings = ("Materials", "Gauge and size", "Notes", "Parts", "Abbreviations", "Instructions")
    for part in (*headings, "Finishing", "Where the numbers come from", "Wash cold.", "4.0 m"):
        assert part in words
    assert re.search(r"Rows 1–6: ribbed hem\n.*k1, p1|Rows 1–6: ribbed hem\n.*p1, k1", words)
    assert re.search(r"\d+ % \(\d+ to \d+\)", words)
    assert "k2tog" not in words  # no row uses it
    assert re.search(r"\n\d+ stitches and \d+ rows to 10 cm", words)  # as a swatch shows it
    assert "modul" not in words  # mechanics are in the report
    assert "its sides roll to the purl side" in words
    assert words.count(f"page 1 of {len(pages)}") == 1


def test_nothing_in_a_pattern_is_smaller_than_7_points_or_off_its_page(
    pages: tuple[Page, ...],
) -> None:
    assert min(label.size for label in labels(pages)) >= 2.47
    for page in pages:
        for label in page.shapes:
            if isinstance(label, Label) and label.anchor == "start":
                assert label.y < page.height
                assert label.x + 0.5 * label.size * len(label.text) <= page.width


def test_the_rows_of_all_parts_together_are_the_chart(pages: tuple[Page, ...]) -> None:
    texts = [label.text for label in labels(pages) if not label.bold]
    rows = [text for text in texts if re.match(r"Rows? \d+(–\d+)?( \(..\))?: ", text)]
    text = "\n".join([write_rows(CHART).splitlines()[0], *rows, "Bind off."])
    assert read_rows(text) == CHART


def test_the_photo_keeps_its_proportions(pages: tuple[Page, ...]) -> None:
    (photo,) = (shape for shape in pages[0].shapes if isinstance(shape, Photo))
    assert photo.width / photo.height == pytest.approx(4 / 3)


def test_a_photo_loses_its_empty_edges() -> None:
    buffer = io.BytesIO()
    image = Image.new("RGB", (400, 300), "white")
    image.paste("#336699", (100, 100, 200, 150))
    image.save(buffer, "PNG")
    pages = pattern_pages(Piece.plain(CHART), ACRYLIC, STYLE, photo=buffer.getvalue())
    (photo,) = (shape for shape in pages[0].shapes if isinstance(shape, Photo))
    assert Image.open(io.BytesIO(photo.png)).size == (124, 74)


def test_an_outlined_piece_has_the_sizes_of_its_parts_alone() -> None:
    stitch = np.ones(CHART.purl.shape, dtype=bool)
    stitch[8:, :3] = False
    pages = pattern_pages(Piece.plain(ShapedChart(CHART, stitch)), ACRYLIC, STYLE)
    words = "\n".join(label.text for label in labels(pages))
    assert "at the widest and highest" in words
    assert "Stretch under" not in words
    assert "ribbed hem" in words


def test_a_pattern_in_the_round_speaks_of_rounds() -> None:
    round_ = replace(STYLE, construction=Construction.ROUND)
    words = [label.text for label in labels(pattern_pages(Piece.plain(CHART), ACRYLIC, round_))]
    assert "Rounds 1–6: ribbed hem" in words
    assert "In the round the width is the circumference." in words


def test_pdf_and_svg_have_the_same_pages(pages: tuple[Page, ...]) -> None:
    svg = to_long_svg(pages, "Cuff")
    options = ExportOptions(name="Cuff", photo=png(8, 8))
    pdf = export_chart(CHART, ExportKind.PATTERN, ACRYLIC, options).content
    drawn = export_chart(CHART, ExportKind.PATTERN_SVG, ACRYLIC, options).content.decode()
    assert svg.count("<g transform=") == len(pages)
    assert pdf.count(b"/Type /Page\n") == drawn.count("<g transform=")
    assert pdf.count(b"/Subtype /Image") >= 1
    assert drawn.count("data:image/png;base64,") == 1


@pytest.mark.parametrize(
    ("photo", "problem"),
    [
        (b"GIF89a" + bytes(30), "not a readable PNG"),
        (png(MAX_PHOTO_PIXELS + 1, 1), "pixels"),
        (bytes(4_000_001), "4000001 bytes"),
        (png(8, 8)[:40], "not a readable PNG"),
    ],
)
def test_other_photos_are_refused(photo: bytes, problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        pattern_pages(Piece.plain(CHART), ACRYLIC, STYLE, photo=photo)


def test_decreases_are_explained_as_they_are_worked() -> None:
    chart = StitchChart.parse("PPPPPP\nKKKKKK")
    outline = np.array([[True] * 6, [False, *[True] * 4, False]])
    piece = Piece.plain(ShapedChart(chart, outline))
    words = " ".join(label.text for label in labels(pattern_pages(piece, ACRYLIC, ChartStyle())))
    shown = re.search(r"ss[kp]: slip two stitches[^;]*", words)
    assert shown
    assert "together through the back loops" in shown[0]
