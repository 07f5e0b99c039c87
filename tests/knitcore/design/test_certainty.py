"""Sources of intervals, and that what is promised to narrow them does."""

import math

import numpy as np
import pytest

from knitcore import RelaxedSize, StitchChart, material, predict
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.design.certainty import Narrowing, Remedy, narrowings, unexpected
from knitcore.materials import Interval, Material
from knitcore.materials.estimate.pulled import pulled
from knitcore.materials.estimate.without_tester import (
    KnownSwatch,
    points_of_law,
    yarn_without_tester,
)
from knitcore.materials.interval_parts import Part, deviation
from knitcore.materials.law_uncertainty import Z_SCORE
from knitcore.materials.yarn_per_stitch import MeasuredYarn, mean_yarn
from knitcore.measure.stretch_points import StretchPoint
from knitcore.prediction.prediction import Prediction

STRESSES = [0.03, 0.1, 0.3]
CHARTS: dict[str, StitchChart | SymbolChart] = {
    "pure": StitchChart.parse("KP"),
    "rib": StitchChart.parse("KKPP"),
    "2-D": StitchChart.parse("KPKK/KKKP"),
    "patches": StitchChart(np.random.default_rng(0).random((20, 24)) < 0.3),
    "lace": SymbolChart.parse("VK;KK"),
}


def of(
    chart: StitchChart | SymbolChart, yarn: Material, prediction: Prediction | None = None
) -> dict[tuple[str, float | None], Narrowing]:
    predicted = predict(chart, yarn) if prediction is None else prediction
    return {(n.quantity, n.n_per_mm): n for n in narrowings(chart, yarn, predicted)}


def kept(promised: Interval | None, given: Interval) -> bool:
    """Say whether an interval is as wide as promised within 3 %."""
    assert promised is not None
    ratio = math.log(given.high / given.low) / math.log(promised.high / promised.low)
    return abs(ratio - 1) < 0.03


@pytest.mark.parametrize("chart", CHARTS.values(), ids=CHARTS)
@pytest.mark.parametrize("identifier", ["acrylic", "cotton"])
def test_parts_add_up_to_the_interval(chart: StitchChart | SymbolChart, identifier: str) -> None:
    predicted = predict(chart, material(identifier))
    for direction in Direction:
        along = predicted.along(direction)
        low, high = along.strain_interval(STRESSES)
        whole = np.log(high / low) / (2 * Z_SCORE)
        np.testing.assert_allclose(deviation(along.strain_parts(STRESSES)), whole, rtol=0.02)
    for narrowing in narrowings(chart, material(identifier), predicted):
        assert sum(narrowing.shares.values()) == pytest.approx(1)
        assert (narrowing.act is None) == (narrowing.left is None) == (not narrowing.how)


def test_a_counted_gauge_leaves_what_was_promised() -> None:
    chart, cotton = CHARTS["rib"], material("cotton")
    before = of(chart, cotton)
    first = predict(chart, cotton)
    size = RelaxedSize.from_gauge(100 / first.relaxed_course_mm, 100 / first.relaxed_wale_mm)
    counted = predict(chart, cotton, size)
    for direction in Direction:
        along = counted.along(direction)
        width, strain = (
            before[key] for key in ((f"relaxed_{direction}_mm", None), (f"strain_{direction}", 0.1))
        )
        assert width.act is strain.act is Remedy.COUNT
        assert next(iter(width.shares)) is next(iter(strain.shares)) is Part.SIZE
        assert kept(width.left, along.relaxed_interval_mm)
        assert kept(strain.left, Interval(*map(float, along.strain_interval(0.1))))
    again = of(chart, cotton, counted)
    assert not any(narrowing.act is Remedy.COUNT for narrowing in again.values())


@pytest.mark.parametrize("name", ["pure", "rib"])
def test_a_pulled_strip_leaves_what_was_promised(name: str) -> None:
    chart, cotton = CHARTS[name], material("cotton")
    promised = of(chart, cotton)["strain_course", 0.03]
    assert promised.how == "pull one strip of rib along its rows"
    points = points_of_law(Fabric.RIB, cotton.law(Fabric.RIB))
    along_rows = [point for point in points if point.direction is Direction.COURSE]
    given = predict(chart, pulled(cotton, along_rows)).course.strain_interval(0.03)
    assert kept(promised.left, Interval(*map(float, given)))


def test_one_pull_of_a_yarn_that_was_estimated_narrows_all_its_fabrics() -> None:
    stockinette = material("cotton").record(Fabric.STOCKINETTE)
    swatch = KnownSwatch(Fabric.STOCKINETTE, *(100 / mm for mm in stockinette.stitch_mm))
    own = yarn_without_tester(swatch).material("mine")
    points = points_of_law(Fabric.RIB, material("cotton").law(Fabric.RIB))
    after = pulled(own, points)
    for fabric in Fabric:
        for d in Direction:
            before, left = (m.record(fabric).uncertainty.log_stress(d, 0.1) for m in (own, after))
            assert left < before
    low, high = predict(CHARTS["pure"], after).course.strain_interval(0.1)
    truth = predict(CHARTS["pure"], material("cotton")).course.strain(0.1)
    assert low < truth < high
    assert Part.YARN in of(CHARTS["pure"], own)["strain_course", 0.1].shares


def test_a_weighed_swatch_leaves_what_was_promised() -> None:
    chart, acrylic = CHARTS["rib"], material("acrylic")
    promised = of(chart, acrylic)["yarn_per_stitch_mm", None]
    mean = mean_yarn(chart, acrylic)[0]
    weighed = MeasuredYarn.weighed(2000 * mean * 0.5e-3, 2000, 500)
    assert promised.act is Remedy.WEIGH
    assert kept(promised.left, mean_yarn(chart, acrylic, weighed)[1])


def test_what_nobody_has_measured_cannot_be_narrowed() -> None:
    lace = of(CHARTS["lace"], material("acrylic"))["strain_course", 0.1]
    assert next(iter(lace.shares)) is Part.OTHER_STITCHES
    assert lace.act is None


@pytest.mark.parametrize("part", [0.02, 0.5, 0.98])
def test_a_pull_inside_its_interval_is_expected(part: float) -> None:
    low, high = predict("KP", material("cotton")).course.strain_interval(0.1)
    inside = low * (high / low) ** part
    point = StretchPoint(Fabric.RIB, Direction.COURSE, 0.1, inside, 0.0, 0.0, 0.0)
    assert unexpected([point], material("cotton")) == ""


@pytest.mark.parametrize("times", [0.25, 4.0])
def test_a_pull_far_outside_says_what_to_check(times: float) -> None:
    strain = times * float(predict("KP", material("cotton")).course.strain(0.1))
    point = StretchPoint(Fabric.RIB, Direction.COURSE, 0.1, strain, 0.0, 0.0, 0.0)
    text = unexpected([point], material("cotton"))
    assert f"stretched {strain:.0%} along its rows" in text
    assert "fabric, direction" in text
