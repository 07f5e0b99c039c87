"""The printed sheet is read back as a photo of it would be."""

from xml.etree import ElementTree as ET

import numpy as np
import pytest

from knitcore.formats.write.drawn_page import to_pdf, to_svg
from knitcore.formats.write.marks_sheet import TITLE, marks_sheet
from knitcore.measure.photos.photo_scale import SHEET_MM, sheet_scale

PX_PER_MM = 5.0


def test_the_sheet_gives_its_own_scale() -> None:
    root = ET.fromstring(to_svg(marks_sheet(), TITLE))  # noqa: S314 - our own
    v, u = np.mgrid[0 : SHEET_MM[1] : 1 / PX_PER_MM, 0 : SHEET_MM[0] : 1 / PX_PER_MM]
    picture = np.ones(u.shape)
    for group in root.iter("{http://www.w3.org/2000/svg}g"):
        for circle in group:
            x, y, radius = (float(circle.attrib[name]) for name in ("cx", "cy", "r"))
            picture[np.hypot(u - x, v - y) < radius] = group.attrib["fill"] == "#ffffff"
    scale = sheet_scale(picture)
    assert scale.px_per_mm == pytest.approx(PX_PER_MM, rel=2e-3)
    assert scale.tilt_deg < 1.5
    assert scale.blur_px < 0.6


def test_the_sheet_is_a_page_of_a_pdf() -> None:
    assert to_pdf([marks_sheet()], TITLE).startswith(b"%PDF")
