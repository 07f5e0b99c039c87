"""The sheet with four marks that gives photos of a swatch their scale, to print on A4.

The marks are those that :mod:`knitcore.measure.photos.photo_scale` looks for.
"""

from knitcore.formats.write.drawn_page import Dots, Label, Lines, Page
from knitcore.measure.photos.photo_scale import MARK_RADII_MM, MARKS_MM, SHEET_MM

TITLE = "Knitcore: scale for photos of a hanging swatch"
BAR_MM = 100.0
_INK, _PAPER = "#000000", "#ffffff"


def marks_sheet() -> Page:
    """The page: four marks, a bar to check the printer by, and a line of advice."""
    width, height = SHEET_MM
    rings = tuple(
        Dots(MARKS_MM, radius, ink)
        for radius, ink in zip(MARK_RADII_MM, (_INK, _PAPER, _INK), strict=True)
    )
    left, bar = (width - BAR_MM) / 2, height - 14
    ends = (left, left + BAR_MM)
    ruler = ((left, bar, left + BAR_MM, bar), *((x, bar - 2, x, bar + 2) for x in ends))
    words = "Print at 100 %: this bar is 100 mm. Hang the swatch in the middle, the marks free."
    return Page(
        width,
        height,
        (*rings, Lines(ruler, _INK, 0.3), Label(width / 2, height - 7, words, 2.8, "middle")),
    )
