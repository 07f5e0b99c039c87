"""Segments of the reduced-symmetry model measured on relaxed stitches."""

import pytest

from knitcore import Direction, Fabric, InputError
from knitcore.mechanics.elastica import Parity
from knitcore.mechanics.reduced_symmetry import rs_fabrics
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.paper.bezier_relax import relax_published
from knitcore.yarn.study.rs_geometry import (
    entangled_regions,
    published_segment_geometry,
    segment_geometry,
)
from tests.knitcore.yarn.relaxed import relaxed


@pytest.mark.parametrize("fabric", list(Fabric))
@pytest.mark.parametrize("yarn", ["acrylic", "cotton"])
def test_the_papers_own_curves_give_its_tables(yarn, fabric):
    """Tables 15 and 16, erratum applied: all 16 slopes, and lengths but for acrylic stockinette."""
    entry = sample(yarn, fabric)
    cell = relax_published(fabric, entry.yarn, entry.loop_length_mm)
    segments = published_segment_geometry(fabric, entry.yarn, cell)
    published = rs_fabrics(yarn)[fabric]
    for direction, segment in segments.items():
        table = published.segment(direction).geometry
        assert segment.parity is table.parity
        assert segment.slope == pytest.approx(table.slope, abs=0.1)
        if (yarn, fabric) != ("cotton", Fabric.RIB):
            assert segment.separation_mm == pytest.approx(table.separation_mm, rel=0.1)
        if fabric is not Fabric.STOCKINETTE:
            assert segment.length_mm == pytest.approx(table.length_mm, rel=0.1)
        if segment.angle_rad is not None and (fabric, direction) != (Fabric.SEED, Direction.WALE):
            assert segment.angle_rad == pytest.approx(table.angle_rad, abs=0.1)


@pytest.mark.parametrize("fabric", list(Fabric))
def test_a_spline_has_much_the_same_feet(fabric):
    """It has no explicit crossovers, so that the edges of the regions differ more wale-wise."""
    stitch = relaxed(fabric, sample("acrylic", fabric), branch="mirrored")
    segments = segment_geometry(stitch)
    assert (segments[Direction.COURSE].parity is Parity.ODD) == fabric.course_odd
    assert (segments[Direction.WALE].parity is Parity.ODD) == fabric.wale_odd
    published = rs_fabrics("acrylic")[fabric]
    for direction, far in ((Direction.COURSE, 0.04), (Direction.WALE, 0.25)):
        table = published.segment(direction).geometry
        assert segments[direction].separation_mm == pytest.approx(table.separation_mm, rel=far)
        assert segments[direction].slope == pytest.approx(table.slope, abs=0.3)


def test_entangled_regions_mirror_each_other_about_the_wale_axis():
    stitch = relaxed("K", sample("cotton", "stockinette"), branch="mirrored")
    first, second, third, fourth = entangled_regions(stitch)
    assert third == pytest.approx((1 - second[1], 1 - second[0]), abs=1e-6)
    assert fourth == pytest.approx((1 - first[1], 1 - first[0]), abs=1e-6)


def test_a_mixed_repeat_is_refused():
    stitch = relaxed("KKP", sample("cotton", "stockinette"), branch="mirrored")
    with pytest.raises(InputError, match="single stitch"):
        segment_geometry(stitch)
