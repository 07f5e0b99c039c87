"""Strokes and the map of what they change."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.service.designs.document import Run
from app.service.designs.painting import kinds_around, paint
from knitcore.chart.phases import surroundings
from knitcore.chart.stitch_chart import StitchChart

SIDES = st.integers(1, 9)


@st.composite
def painted(draw: st.DrawFn) -> tuple[StitchChart, list[Run]]:
    rows, columns = draw(SIDES), draw(SIDES)
    purl = draw(st.lists(st.booleans(), min_size=rows * columns, max_size=rows * columns))
    runs = []
    for _ in range(draw(st.integers(1, 4))):
        column = draw(st.integers(0, columns - 1))
        stitches = draw(st.text("KP", min_size=1, max_size=columns - column))
        runs.append(Run(row=draw(st.integers(0, rows - 1)), column=column, stitches=stitches))
    return StitchChart(np.array(purl).reshape(rows, columns)), runs


@given(painted())
def test_the_map_holds_every_stitch_whose_kind_changed(
    example: tuple[StitchChart, list[Run]],
) -> None:
    chart, runs = example
    after = StitchChart.parse(paint(chart.text, chart.rows, chart.columns, runs))
    expected = chart.purl.copy()
    for run in runs:
        purls = [stitch == "P" for stitch in run.stitches]
        expected[run.row, run.column : run.column + len(purls)] = purls
    np.testing.assert_array_equal(after.purl, expected)

    area = kinds_around(after.text, after.rows, after.columns, runs)
    codes = surroundings(chart).copy()
    box = np.array([[int(digit, 16) for digit in line] for line in area.kinds])
    codes[area.row : area.row + box.shape[0], area.column : area.column + box.shape[1]] = box
    np.testing.assert_array_equal(codes, surroundings(after))
