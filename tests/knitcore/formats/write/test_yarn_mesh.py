from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given

from knitcore import StitchChart
from knitcore.formats.write.yarn_mesh import ABOVE, LEFT, RIGHT, SELF, loop_centre_line, loop_kinds
from tests.knitcore.charts import stitch_charts


@given(stitch_charts(6))
def test_neighbouring_loops_join(chart: StitchChart) -> None:
    kinds = loop_kinds(chart)
    for row in kinds:
        for left, right in pairwise(row):
            end, start = loop_centre_line(int(left))[-1], loop_centre_line(int(right))[0]
            np.testing.assert_allclose(end[1:], start[1:], atol=1e-12)
            np.testing.assert_allclose(end[0] - start[0], 1.0)


@pytest.mark.parametrize("kind", range(16))
def test_the_other_side_is_the_mirror_image(kind: int) -> None:
    turned = kind ^ (SELF | LEFT | RIGHT | ABOVE)
    line, back = loop_centre_line(kind), loop_centre_line(turned)
    np.testing.assert_allclose(back, line * [1, 1, -1], atol=1e-12)


def test_a_knit_shows_its_legs_on_the_face_and_its_head_behind() -> None:
    line = loop_centre_line(0, 97)
    leg = np.argmin(np.abs(line[:48, 1]))
    assert line[leg, 2] > 0.5
    assert line[48, 2] < -0.5
