"""Punch cards on paper."""

import numpy as np
import pytest

from knitcore import StitchChart
from knitcore.formats.write.chart_drawing import A4_MM
from knitcore.formats.write.chart_key import INK
from knitcore.formats.write.drawn_page import Dots, Label, Lines, Rectangle
from knitcore.formats.write.sheets.card_sheet import HOLE_MM, card_pages
from knitcore.machine.home.punch_card import punch_card
from knitcore.machine.profile import profile


def test_a_card_is_drawn_at_true_size() -> None:
    card = punch_card(StitchChart.parse("PKK\nKPK").resized(4, 24), profile("brother"))
    _, page = card_pages(card, "Card")
    (outline,) = (shape for shape in page.shapes if isinstance(shape, Rectangle))
    assert (outline.width, outline.height) == (142.0, 200.0)
    assert outline.x + outline.width < A4_MM[0]
    (dots,) = (s for s in page.shapes if isinstance(s, Dots) and s.fill == INK)
    assert dots.radius == HOLE_MM / 2
    assert len(dots.centres) == card.holes.sum() + 4 * 24
    across = np.unique([x for x, _ in dots.centres])
    assert np.diff(across) == pytest.approx(4.5)
    (scale,) = (s for s in page.shapes if isinstance(s, Lines))
    left, _, right, _ = scale.lines[0]
    assert right - left == pytest.approx(100)


def test_the_numbers_are_in_sight_when_their_row_is_read() -> None:
    card = punch_card(StitchChart.of_fabric("rib", rows=4, columns=24), profile("brother"))
    _, page = card_pages(card, "Card")
    numbers = {s.text: s.y for s in page.shapes if isinstance(s, Label) and s.text.isdigit()}
    assert len(numbers) == 36
    assert numbers["1"] > numbers["2"]
    lowest = max(y for _, y in next(s for s in page.shapes if isinstance(s, Dots)).centres)
    assert lowest - numbers["1"] == pytest.approx((2 + 7) * 5.0, abs=1.0)


def test_long_cards_go_over_several_pages() -> None:
    purl = np.random.default_rng(1).random((100, 24)) < 0.4
    pages = card_pages(punch_card(StitchChart(purl), profile("brother")), "Card")
    assert len(pages) == 1 + 3
