"""Results show themselves in a notebook: small pictures without scripts or addresses."""

import re
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from knitcore import InputError, StitchChart, curve, material, predict, strip_test
from knitcore.base import showing
from knitcore.garment.shaped import ShapedChart
from tests.knitcore.results import curled, relaxed_cell, sweep

ACRYLIC = material("acrylic")
GARTER = StitchChart.of_fabric("garter", rows=4, columns=6)


def shown(of: object) -> str:
    """The HTML by which something shows itself, checked."""
    html: str = of._repr_html_()  # type: ignore[attr-defined]
    ET.fromstring(html)  # noqa: S314 - our own
    assert not re.search(r"<script|https?://(?!www\.w3\.org/2000/svg)|nan|inf\b", html)
    assert len(html) < 110_000
    return html


def test_a_chart_draws_each_stitch_once() -> None:
    html = shown(StitchChart.parse("KPP/KKP"))
    knits, purls, dashes = re.findall(r'<path d="([^"]*)"', html)
    assert (knits.count("M"), purls.count("M"), dashes.count("M")) == (3, 3, 3)
    assert "M0 18" in knits  # the lower left stitch, 18 px a stitch
    assert "3 columns × 2 rows" in html


def test_a_large_chart_is_cut_with_a_note() -> None:
    html = shown(StitchChart.of_fabric("stockinette", rows=200, columns=90))
    assert html.count("M") - 1 <= showing.MAX_CELLS**2
    assert "lower left 80 × 80" in html


def test_an_outline_leaves_cells_out() -> None:
    html = shown(ShapedChart.parse("KPK/KKK".replace("/", "\n"), ".x.\nxxx"))
    knits, purls, _ = re.findall(r'<path d="([^"]*)"', html)
    assert (knits.count("M"), purls.count("M")) == (3, 1)


def test_a_material_lists_its_fabrics() -> None:
    html = shown(ACRYLIC)
    assert html.count("<tr>") == 1 + len(ACRYLIC.fabrics)
    assert f"{ACRYLIC.law(next(iter(ACRYLIC.fabrics))).modulus_course:.4f}" in html


def test_an_answer_gives_numbers_intervals_source_and_notes() -> None:
    answer = predict(StitchChart.parse("KKPP"), ACRYLIC)
    html = shown(answer)
    low = answer.course.modulus_interval_n_per_mm.low
    assert f"{answer.modulus_course_n_per_mm:.4f} ({low:.4f} to" in html
    assert "learned" in html
    assert answer.notes[0] in html


def test_a_curve_has_a_band() -> None:
    html = shown(curve(GARTER, ACRYLIC, "wale", [0.0, 0.1, 0.2]))
    assert "fill-opacity" in html


def test_a_strip_test_shows_its_curve_from_zero_and_its_net() -> None:
    test = strip_test(GARTER, ACRYLIC, "wale", 0.2, steps=1)
    html = shown(test)
    assert html.count("<svg") == 2
    assert f"{test.force_n[-1]:.3g} N" in html
    assert "M46.0 166.0L" in html  # the origin


def test_a_relaxed_cell_is_tiled_to_four_stitches_each_way() -> None:
    cell = relaxed_cell("KP")
    lines = cell.tiled_lines()
    assert len(lines) == 4
    assert np.allclose(np.ptp([line[0, 1] for line in lines]), 3 * cell.cell_wale_mm)
    assert "relaxed yarn" in shown(cell)


@pytest.mark.parametrize("made", [curled, sweep], ids=["curled piece", "sweep"])
def test_shapes_and_sweeps_show_themselves(made) -> None:  # type: ignore[no-untyped-def]
    assert "<svg" in shown(made())


def test_names_are_escaped() -> None:
    assert "<b>" not in showing.captioned("", "<b>bold</b>")
    assert "&lt;b&gt;" in showing.html_table(["<b>"], [])


def test_results_print_in_one_short_line() -> None:
    chart = StitchChart.parse("KKPP")
    answer = predict(chart, ACRYLIC)
    test = strip_test(GARTER, ACRYLIC, "course", [0.05])
    for of in (ACRYLIC, answer, answer.course, curve(chart, ACRYLIC, "course"), test):
        assert "\n" not in repr(of)
        assert len(repr(of)) < 160
    assert f"{answer.modulus_wale_n_per_mm:.3g} N/mm" in repr(answer)
    assert f"{test.force_n[-1]:.3g} N" in repr(test)


def test_an_answer_knows_directions_by_name() -> None:
    answer = predict(StitchChart.parse("KKPP"), ACRYLIC)
    assert answer.along("wale") is answer.wale
    with pytest.raises(InputError, match="not known"):
        answer.along("across")
