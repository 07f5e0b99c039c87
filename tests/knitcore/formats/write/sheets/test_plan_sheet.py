"""Plans for home machines on paper."""

import numpy as np
import pytest

from knitcore import StitchChart
from knitcore.formats.write.chart_drawing import A4_MM
from knitcore.formats.write.chart_key import INK
from knitcore.formats.write.drawn_page import Label, Rectangle
from knitcore.formats.write.sheets.plan_sheet import plan_pages
from knitcore.machine.home.hand_plan import hand_plan
from knitcore.machine.profile import profile


@pytest.mark.parametrize("machine", ["brother", "silver-reed-ribber"])
@pytest.mark.parametrize("columns", [5, 60, 200])
def test_a_plan_has_all_words_and_stays_on_its_pages(machine: str, columns: int) -> None:
    purl = np.random.default_rng(3).random((20, columns)) < 0.3
    plan = hand_plan(StitchChart(purl), profile(machine))
    pages = plan_pages(plan, "Scarf")
    labels = [s for page in pages for s in page.shapes if isinstance(s, Label)]
    words = " ".join(label.text for label in labels)
    for section in plan.sections:
        assert section.heading in words
    assert f"page {len(pages)} of {len(pages)}" in words
    for shape in (shape for page in pages for shape in page.shapes):
        if isinstance(shape, Label | Rectangle):
            assert 0 <= shape.x <= A4_MM[0]
            assert 0 <= shape.y <= A4_MM[1]
        if isinstance(shape, Label):
            assert shape.size >= 2.5


def test_the_needles_are_drawn_from_the_knitters_left() -> None:
    plan = hand_plan(StitchChart.parse("PKKK"), profile("brother"))
    boxes = [
        shape
        for page in plan_pages(plan, "Scarf")
        for shape in page.shapes
        if isinstance(shape, Rectangle) and shape.fill in (None, INK)
    ]
    assert [box.fill for box in sorted(boxes, key=lambda box: box.x)] == [None, None, None, INK]
