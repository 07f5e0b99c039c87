"""Other stitches beside a chart of knits and purls."""

import pytest
from pydantic import ValidationError

from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.designs.design_file import design_from_mapping, write_design
from knitcore.formats.designs.layout import DesignLayout, check_layout
from knitcore.formats.designs.other_stitches import StitchRun, composed, painted_over, taken_apart
from tests.knitcore.refusals import refuses

CHARTS = (
    "O/\\O;KKKK",
    "P[2/2R]P;PKKKKP",
    "KKVPVK;KPKPKP",
    "PTPt;PKPK",
    "B^OOb;KKPKP",
    "[1/1L][1/1R]O)(O;KKKKPKKP",
)
DESIGN = {"format": "knitcore-design", "version": 2}


@pytest.mark.parametrize("text", CHARTS)
def test_a_chart_is_taken_apart_and_composed_again(text: str) -> None:
    chart = SymbolChart.parse(text)
    plain, runs = taken_apart(chart)
    assert plain == chart.plain
    assert composed(plain, runs) == chart
    check_layout(plain, DesignLayout(other_stitches=runs))


def test_neighbours_are_one_run_and_a_chart_of_knits_and_purls_has_none() -> None:
    _, runs = taken_apart(SymbolChart.parse("O/K[2/2R]V;KKKKKKKK"))
    assert [(run.row, run.column, run.codes) for run in runs] == [(1, 0, "O/"), (1, 3, "[2/2R]V")]
    plain = StitchChart.parse("KP/PK")
    assert taken_apart(SymbolChart.of(plain)) == (plain, [])
    assert composed(plain, []) is plain


def test_what_lies_outside_on_another_or_is_unknown_is_refused() -> None:
    plain = StitchChart.parse("KKK/KKK")
    beyond = [StitchRun(row=0, column=1, codes="[2/2R]")]
    with refuses("other_stitches", "2/2 right cross in row 1, stitch 2 leaves the chart"):
        composed(plain, beyond)
    twice = [StitchRun(row=0, column=0, codes="[1/1R]"), StitchRun(row=0, column=1, codes="O")]
    with refuses("other_stitches", "lies on another one"):
        check_layout(plain, DesignLayout(other_stitches=twice))
    for codes in ("K", "O?", "[9/9R]", "", "O /"):
        with pytest.raises(ValidationError):
            StitchRun(row=0, column=0, codes=codes)


def test_a_file_keeps_a_design_that_does_not_balance_and_says_so_when_it_computes() -> None:
    run = {"row": 1, "column": 0, "codes": "O"}
    design = design_from_mapping({**DESIGN, "chart": "KK\nKP", "other_stitches": [run]})
    assert '"other_stitches": [\n  {"row": 1, "column": 0, "codes": "O"}\n ]' in write_design(
        design
    )
    with refuses("chart", "row 2 takes 1 stitches"):
        design.to_stitches()
    assert design.to_purl_map() == StitchChart.parse("KK/KP")


def test_a_file_of_lace_is_no_chart_of_knits_and_purls() -> None:
    run = {"row": 1, "column": 0, "codes": "O/"}
    design = design_from_mapping({**DESIGN, "chart": "KK\nKP", "other_stitches": [run]})
    assert str(design.to_stitches()) == "O/\nKP"
    with refuses("chart", "yarn over and knit 2 together"):
        design.to_chart()
    assert "other_stitches" not in write_design(design_from_mapping({**DESIGN, "chart": "KP"}))


def test_painting_takes_away_what_it_hits_and_a_wide_stitch_whole() -> None:
    runs = [StitchRun(row=0, column=1, codes="O/[2/2R]V"), StitchRun(row=1, column=0, codes="T")]
    left = painted_over(runs, {(0, 4), (1, 5)})
    assert left == [
        StitchRun(row=0, column=1, codes="O/"),
        StitchRun(row=0, column=7, codes="V"),
        StitchRun(row=1, column=0, codes="T"),
    ]
    assert painted_over(runs, set()) == runs
