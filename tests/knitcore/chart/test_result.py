"""Results as plain values and as short texts."""

import json
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from knitcore import Direction, InputError, StitchChart, curve, predict, strip_test
from knitcore.base.arrays import Array
from knitcore.chart.result import Result
from knitcore.materials import Interval


@dataclass(frozen=True, eq=False, repr=False)
class Made(Result):
    """A result of every kind of field."""

    chart: StitchChart
    direction: Direction
    values: Array
    interval: Interval
    share: float
    inner: Result | None
    function: object = math.sin

    also_listed = ("total",)

    @property
    def total(self) -> float:
        return float(self.values.sum())


def _made(inner: Result | None = None) -> Made:
    chart, values = StitchChart.parse("KP/PK"), np.arange(300.0)
    return Made(chart, Direction.WALE, values, Interval(1.0, 2.0), math.nan, inner)


def test_a_result_becomes_plain_values() -> None:
    plain = _made(_made()).to_dict()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert plain["chart"] == "KP/PK"
    assert (plain["direction"], plain["interval"], plain["share"]) == ("wale", [1.0, 2.0], None)
    assert plain["values"][-1] == 299.0
    assert plain["total"] == plain["inner"]["total"] == 44850.0
    assert "function" not in plain


def test_its_text_gives_shapes_instead_of_numbers() -> None:
    text = repr(_made(_made()))
    assert "values=<300>" in text
    assert "chart=<2 x 2 stitches>" in text
    assert len(text) < 200


def test_predictions_curves_and_strip_tests_become_plain_values(tmp_path: Path) -> None:
    rib = predict("KKPP", "acrylic")
    plain = rib.to_dict()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert plain["modulus_wale_n_per_mm"] == rib.wale.modulus_n_per_mm
    assert plain["relaxed_course_interval_mm"] == [*rib.course.relaxed_interval_mm]
    drawn = curve("KKPP", "acrylic", "wale", [0.0, 0.1])
    assert drawn.to_dict()["strain"] == drawn.strain.tolist()
    test = strip_test("KP/PK", "acrylic", "wale", 0.2, steps=2)
    plain = test.to_dict()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert plain["force_n"] == test.force_n.tolist()
    with pytest.raises(InputError, match="suffix"):
        test.write(tmp_path / "x.xlsx")
