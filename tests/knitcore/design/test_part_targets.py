import math
from dataclasses import replace

import numpy as np
import pytest

from knitcore import Direction, InputError, RelaxedSize, StitchChart, material, predict
from knitcore.design.part_targets import PartsNow, PartTarget, target_maps, target_parts


def box(
    name: str, rows: range, columns: range, course: float | None, wale: float | None
) -> PartTarget:
    runs = tuple((row, columns.start, len(columns)) for row in rows)
    return PartTarget(name, runs, course, wale)


def test_parts_become_maps() -> None:
    slope = PartTarget("slope", tuple((row, row, 6 - row) for row in range(6)), 0.1, None)
    course, wale = target_maps([slope, box("top", range(6, 8), range(8), None, 0.2)], 8, 8)
    assert np.nansum(course) == pytest.approx(0.1 * 21)
    assert np.isnan(wale[:6]).all()
    assert (wale[6:] == 0.2).all()


def test_the_same_target_twice_is_not_a_contradiction() -> None:
    """And stitches of the same targets are one part."""
    first = box("first", range(4), range(4), 0.1, None)
    second = box("second", range(2, 6), range(2, 6), 0.1, 0.2)
    course, wale = target_maps([first, second], 8, 8)
    assert np.count_nonzero(~np.isnan(course)) == 28
    assert np.count_nonzero(~np.isnan(wale)) == 16
    parts = target_parts([first, second], 8, 8)
    assert sorted(np.bincount(parts.ravel()).tolist()) == [4, 12, 12, 36]
    assert parts[2, 2] == parts[3, 3] != parts[0, 0]


def test_contradictions_are_named_with_both_parts_and_where() -> None:
    palm = box("palm", range(4), range(4), 0.1, None)
    thumb = box("thumb", range(2, 6), range(2, 6), 0.2, None)
    problem = r"“palm” and “thumb” contradict .* in 4 stitches"
    with pytest.raises(InputError, match=problem) as error:
        target_maps([palm, thumb], 8, 8)
    assert "row 3, column 3" in error.value.problem
    assert "0.1 and 0.2 N/mm course-wise" in error.value.problem


@pytest.mark.parametrize(
    ("target", "says"),
    [
        (box("far", range(6, 9), range(3), 0.1, None), "reaches row 9"),
        (PartTarget("empty", (), 0.1, None), "covers no stitch"),
        (box("odd", range(4), range(4), -0.1, None), "not positive"),
    ],
)
def test_unusable_targets_are_refused(target: PartTarget, says: str) -> None:
    with pytest.raises(InputError, match=says):
        target_maps([target], 8, 8)


def test_a_counted_part_does_before_it_is_filled_what_its_gauge_says() -> None:
    """Nobody has counted what it is filled with."""
    acrylic, chart = material("acrylic"), StitchChart.parse("KKPP").tile(8, 2)
    size = RelaxedSize(2.9, 2.7)
    part = replace(box("rib", range(8), range(8), 0.1, None), size=size)
    now = PartsNow([part], np.ones_like(chart.purl), chart, acrylic)
    counted, computed = (
        [math.log(predict(chart, acrylic, known).modulus_n_per_mm(d)) for d in Direction]
        for known in (size, None)
    )
    assert now.log_now[0] == pytest.approx(counted)
    assert now.log_moduli(chart)[0] == pytest.approx(computed)
    assert counted[0] != pytest.approx(computed[0])
