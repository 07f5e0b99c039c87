import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore import Fabric, InputError, material
from knitcore.garment.gauge import Gauge, GaugeLength


@pytest.mark.parametrize("per", list(GaugeLength))
def test_counted_gauges_are_returned(per: GaugeLength) -> None:
    gauge = Gauge.of_count(22, 30, per)
    assert gauge.counts(per) == pytest.approx((22, 30))
    assert gauge.stitches_for(per.value) == 22


def test_four_inches_hold_a_little_more_than_ten_centimetres() -> None:
    gauge = Gauge.of_swatch(stitches=44, rows=60, width_mm=200, height_mm=200)
    assert gauge.counts() == pytest.approx((22, 30))
    assert gauge.counts(GaugeLength.FOUR_INCHES) == pytest.approx((22.352, 30.48))


def test_the_gauge_of_a_material_is_its_stitch() -> None:
    record = material("acrylic:published").record(Fabric.SEED)
    gauge = Gauge.of_material(material("acrylic:published"), Fabric.SEED)
    assert gauge.counts(GaugeLength.FIVE_CM)[0] == pytest.approx(50 / record.stitch_course_mm)


@given(width=st.floats(20, 2000), multiple=st.integers(1, 12), extra=st.integers(0, 5))
def test_sizes_are_whole_repeats_next_to_the_width(width: float, multiple: int, extra: int) -> None:
    gauge = Gauge.of_count(22, 30)
    stitches = gauge.stitches_for(width, multiple=multiple, extra=extra)
    assert (stitches - extra) % multiple == 0
    assert stitches >= multiple + extra
    if stitches > multiple + extra:
        assert abs(stitches - 0.22 * width) <= multiple / 2 + 1e-9


@pytest.mark.parametrize("bad", [(0.0, 3.0), (3.0, float("nan")), (3.0, 500.0)])
def test_impossible_gauges(bad: tuple[float, float]) -> None:
    with pytest.raises(InputError, match="not a stitch size"):
        Gauge(*bad)


def test_a_length_must_be_positive() -> None:
    with pytest.raises(InputError, match="positive"):
        Gauge.of_count(22, 30).rows_for(0.0)
