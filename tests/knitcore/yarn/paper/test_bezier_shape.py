from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore.chart.fabric import Fabric
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.paper.bezier_relax import first_shapes
from knitcore.yarn.paper.bezier_shape import COUNT, ties, unknown_names
from knitcore.yarn.paper.bezier_stitch import Stitch
from knitcore.yarn.paper.elastic import bernstein

FABRICS = list(Fabric)
ENDS = np.array([0.0, 1.0])


def shape(fabric, loop_length_mm=12.0):
    """Unknowns and control points of a random stitch, the third of the first shapes."""
    stitch = Stitch(fabric, sample("acrylic", fabric).yarn)
    unknowns = first_shapes(stitch, loop_length_mm, 3)[2]
    return unknowns, stitch.controls(unknowns)


def test_numbers_of_unknowns_are_the_authors():
    assert [ties(f).shape for f in FABRICS] == [(COUNT, n + 2) for n in (28, 29, 32, 32)]
    assert all(unknown_names(f)[-2:] == ("cell_course", "cell_wale") for f in FABRICS)


@pytest.mark.parametrize("fabric", FABRICS)
def test_curves_join_with_position_tangent_and_curvature_vector(fabric):
    unknowns, controls = shape(fabric)
    following = controls[0] * [1, 1, -1 if fabric.course_odd else 1]
    following[:, 0] += unknowns[-2]
    for before, after in pairwise([*controls, following]):
        assert before[-1] == pytest.approx(after[0], abs=1e-12)
        frames = []
        for curve, end in ((before, 1), (after, 0)):
            speed, second = (bernstein(ENDS, d)[end] @ curve for d in (1, 2))
            tangent = speed / np.linalg.norm(speed)
            frames.append((tangent, (second - second @ tangent * tangent) / (speed @ speed)))
        assert frames[0][0] == pytest.approx(frames[1][0], abs=1e-10)
        assert frames[0][1] == pytest.approx(frames[1][1], abs=1e-8)


@pytest.mark.parametrize("fabric", FABRICS)
def test_stitch_is_its_own_mirror_image(fabric):
    _, controls = shape(fabric)
    mirrored = controls[::-1, ::-1] * [-1, 1, 1]
    # B1 c11 A1 c12 A2 c22 B2 | c21, so curve i faces curve 6 - i; c21 joins the next stitch
    assert controls[:7] == pytest.approx(mirrored[1:], abs=1e-12)


@settings(max_examples=20)
@given(st.floats(0.3, 3.0), st.sampled_from(FABRICS))
def test_shape_scales_with_the_loop_length(factor, fabric):
    _, controls = shape(fabric, loop_length_mm=10.0)
    _, larger = shape(fabric, loop_length_mm=10.0 * factor)
    assert larger == pytest.approx(factor * controls, abs=1e-9)
