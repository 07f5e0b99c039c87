"""Segments of the reduced-symmetry model measured on relaxed stitches."""

import pytest

from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.mechanics.elastica import Parity
from knitcore.yarnlevel.relax import relax
from knitcore.yarnlevel.rs_geometry import entangled_regions, segment_geometry
from knitcore.yarnlevel.samples import sample

PUBLISHED_SEPARATION_MM = {
    (Fabric.STOCKINETTE, Direction.COURSE): 2.187,
    (Fabric.STOCKINETTE, Direction.WALE): 3.550,
    (Fabric.GARTER, Direction.COURSE): 2.120,
    (Fabric.GARTER, Direction.WALE): 3.499,
    (Fabric.RIB, Direction.COURSE): 3.093,
    (Fabric.RIB, Direction.WALE): 4.846,
    (Fabric.SEED, Direction.COURSE): 3.053,
    (Fabric.SEED, Direction.WALE): 3.776,
}
"""Supplementary Table 15 (acrylic), with the erratum of stockinette wale-wise."""


@pytest.mark.parametrize("fabric", list(Fabric))
def test_separations_are_near_the_published_ones(fabric):
    """The spline has no explicit crossovers, so that the edges of the regions differ."""
    entry = sample("acrylic", fabric)
    relaxed = relax(StitchChart.of_fabric(fabric, 2, 2), entry.yarn, entry.loop_length_mm)
    found = segment_geometry(relaxed)
    assert (found[Direction.COURSE].parity is Parity.ODD) == fabric.course_odd
    assert (found[Direction.WALE].parity is Parity.ODD) == fabric.wale_odd
    for direction in Direction:
        published = PUBLISHED_SEPARATION_MM[fabric, direction]
        assert found[direction].separation_mm == pytest.approx(published, rel=0.4)


def test_entangled_regions_mirror_each_other_about_the_wale_axis():
    entry = sample("cotton", "stockinette")
    relaxed = relax(StitchChart.parse("K"), entry.yarn, entry.loop_length_mm)
    first, second, third, fourth = entangled_regions(relaxed)
    assert third == pytest.approx((1 - second[1], 1 - second[0]), abs=1e-6)
    assert fourth == pytest.approx((1 - first[1], 1 - first[0]), abs=1e-6)


def test_a_mixed_repeat_is_refused():
    entry = sample("cotton", "stockinette")
    relaxed = relax(StitchChart.parse("KKP"), entry.yarn, entry.loop_length_mm)
    with pytest.raises(InputError, match="single stitch"):
        segment_geometry(relaxed)
