"""Homogenisation against exact laminates, bounds and the laws themselves."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import Direction, Fabric, StitchChart, material
from knitcore.materials import load_library
from knitcore.mechanics.homogenisation import MAX_CELLS, homogenise, modulus_of, phase_grid
from knitcore.mechanics.lamination import SheetGrid, coarsened
from tests.knitcore.charts import stitch_charts


@pytest.mark.parametrize("identifier", load_library())
@pytest.mark.parametrize("fabric", Fabric)
def test_pure_fabrics_come_out_exactly(identifier, fabric):
    yarn = material(identifier)
    law = yarn.law(fabric)
    sheet = homogenise(StitchChart.of_fabric(fabric, 2, 2), yarn)
    for direction in Direction:
        assert sheet.modulus_n_per_mm(direction) == pytest.approx(law.modulus(direction))
        np.testing.assert_allclose(
            sheet.bounds_n_per_mm(direction), law.modulus(direction), rtol=1e-9
        )
    assert sheet.poisson_yx == pytest.approx(law.poisson_yx)
    assert sheet.poisson_xy == pytest.approx(law.poisson_xy)
    assert sheet.shear_modulus_n_per_mm == pytest.approx(law.shear_modulus)


def test_a_rib_is_an_exact_laminate():
    """Columns of two sheets: Backus' formulas, here by the laminate code on a 1 x 2 grid."""
    acrylic = material("acrylic")
    laws = [acrylic.law(f).symmetrised() for f in (Fabric.STOCKINETTE, Fabric.RIB)]
    widths = [acrylic.record(f).stitch_course_mm for f in (Fabric.STOCKINETTE, Fabric.RIB)]
    constants = "stiffness_xxxx", "stiffness_yyyy", "stiffness_xxyy", "shear_modulus"
    rows = (np.array([[getattr(law, name) for law in laws]]) for name in constants)
    grid = SheetGrid(*rows, np.array(widths), np.array([1.0])).merged_along_x()
    sheet = homogenise(StitchChart.parse("KKPP"), acrylic)
    np.testing.assert_allclose(
        sheet.stiffness_n_per_mm, grid.stiffness()[0, 0], rtol=1e-9, atol=1e-12
    )


@settings(max_examples=25)
@given(stitch_charts(5), st.sampled_from([*load_library()]))
def test_effective_stiffness_lies_between_the_bounds(chart, identifier):
    sheet = homogenise(chart, material(identifier))
    for upper, lower in (
        (sheet.voigt_n_per_mm, sheet.stiffness_n_per_mm),
        (sheet.stiffness_n_per_mm, sheet.reuss_n_per_mm),
    ):
        assert np.linalg.eigvalsh(upper - lower).min() > -1e-9


@settings(max_examples=25)
@given(stitch_charts(5), st.data())
@pytest.mark.slow
def test_the_same_cloth_has_the_same_tensor(chart, data):
    yarn = material("cotton")
    shift = data.draw(st.tuples(st.integers(0, 4), st.integers(0, 4)))
    reference = homogenise(chart, yarn).stiffness_n_per_mm
    moved = StitchChart(np.roll(chart.purl, shift, axis=(0, 1)))
    shifted = homogenise(moved, yarn).stiffness_n_per_mm
    np.testing.assert_allclose(shifted, reference, rtol=1e-8, atol=1e-11)
    np.testing.assert_allclose(
        homogenise(chart.swap(), yarn).stiffness_n_per_mm, reference, rtol=1e-12, atol=1e-15
    )
    mirrored = homogenise(chart.mirror(), yarn).stiffness_n_per_mm
    sign = np.array([[1, 1, -1], [1, 1, -1], [-1, -1, 1]])
    np.testing.assert_allclose(mirrored * sign, reference, rtol=1e-8, atol=1e-11)


def test_coarsening_keeps_layers_exactly():
    yarn = material("lace-acrylic")
    stripes = StitchChart.parse("KKPP").tile(1, 150)
    assert 4 * stripes.rows * stripes.columns > MAX_CELLS
    np.testing.assert_allclose(
        homogenise(stripes, yarn).stiffness_n_per_mm,
        homogenise(StitchChart.parse("KKPP"), yarn).stiffness_n_per_mm,
        rtol=1e-6,
        atol=1e-9,
    )


@pytest.mark.slow
def test_coarsening_is_close_for_noise():
    """32 x 32 random stitches: the coarsened grid against all 4096 quarter cells."""
    yarn = material("acrylic")
    chart = StitchChart(np.random.default_rng(0).random((32, 32)) < 0.5)
    coarse, full = homogenise(chart, yarn), homogenise(chart, yarn, most_cells=10**6)
    for direction in Direction:
        assert coarse.modulus_n_per_mm(direction) == pytest.approx(
            full.modulus_n_per_mm(direction), rel=0.10
        )


def test_laminates_lie_between_the_bounds():
    rng = np.random.default_rng(1)
    stiff = rng.uniform(0.01, 1, (8, 6))
    grid = SheetGrid(stiff, 2 * stiff, 0.3 * stiff, 0.1 * stiff, np.ones(6), np.ones(8))
    small = coarsened(grid, 1).stiffness()[0, 0]
    for axis in Direction:
        low, high = modulus_of(grid.reuss(), axis), modulus_of(grid.voigt(), axis)
        assert low < modulus_of(small, axis) < high


def test_columns_of_one_phase_keep_its_size():
    acrylic = material("acrylic")
    grid = phase_grid(StitchChart.parse("KKPP"), acrylic)
    rib, plain = (acrylic.record(f).stitch_course_mm / 2 for f in (Fabric.RIB, Fabric.STOCKINETTE))
    np.testing.assert_allclose(grid.width_mm, [rib, plain, plain, rib, rib, plain, plain, rib])
    assert grid.shares.sum() == pytest.approx(1)
