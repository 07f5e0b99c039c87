import pytest

from knitcore.errors import InputError
from knitcore.yarnlevel.published.relax import relax_published
from knitcore.yarnlevel.samples import sample
from knitcore.yarnlevel.tension import vary_loop_length
from tests.knitcore.yarnlevel.synthetic import cell


def test_less_yarn_makes_smaller_and_stiffer_stitches():
    # paper, Supplementary Fig. 9: stockinette with 10.5 and 12.5 mm of yarn
    yarn = sample("acrylic", "stockinette").yarn
    series = vary_loop_length(
        lambda length: relax_published("stockinette", yarn, length, starts=1), (10.5, 11.5, 12.5)
    )
    assert list(series.loop_length_mm) == [10.5, 11.5, 12.5]
    assert list(series.stitches_per_cm2) == sorted(series.stitches_per_cm2, reverse=True)
    assert list(series.energy_n_mm) == sorted(series.energy_n_mm, reverse=True)
    assert series.cell_course_mm[0] < series.cell_course_mm[-1]


def test_no_length_is_refused():
    with pytest.raises(InputError, match="empty"):
        vary_loop_length(lambda length: cell(), [])
