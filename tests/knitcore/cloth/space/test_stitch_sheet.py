"""Energy of a sheet of stitches: derivatives, symmetries, known solutions."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation
from scipy.special import ellipe, ellipk

from knitcore import Fabric, RelaxedSize, StitchChart, material
from knitcore.base.arrays import Array
from knitcore.chart.phases import continued
from knitcore.cloth.space import sheet_kernels as kernels
from knitcore.cloth.space.bending_constants import bends_of, computed
from knitcore.cloth.space.sheet_shape import settle, shake_mm
from knitcore.cloth.space.stitch_sheet import StitchSheet, sheet_of
from knitcore.cloth.space.tangent import Tangent
from knitcore.garment.shaped import outline_marks
from knitcore.prediction.neighbourhood import neighbourhood_sizes
from tests.knitcore.cloth.space.outlines import OUTLINES

MIXED = StitchChart.parse("KKPK\nKPPK\nPPKK\nKPKP\nKKKK")
ACRYLIC = material("acrylic")
SHEETS = pytest.mark.parametrize(
    "outline", [*OUTLINES.values(), "xxxxxx\n" * 4], ids=[*OUTLINES, "whole"]
)


def _crumpled(sheet: StitchSheet, size_mm: float = 0.7) -> tuple[Array, NDArray[np.int64]]:
    """A rough shape in which a few points touch."""
    noise = np.random.default_rng(0).standard_normal(sheet.flat_mm.shape)
    x = sheet.flat_mm + size_mm * noise
    x[20] = x[0] + 1.1
    return x, np.array([[0, 20], [1, 25], [31, 3]])


def _cut(outline: str, size_mm: float) -> tuple[StitchSheet, Array, NDArray[np.int64]]:
    """A mixed sheet of an outline in a rough shape, with points that touch."""
    stitches = outline_marks(outline)
    chart = continued(StitchChart.parse("KKPKPP\nKPPKKP\nPPKKPK\nKPKPKK"), stitches)
    sheet = sheet_of(chart, ACRYLIC, stitches).cut(stitches)
    x = sheet.flat_mm + size_mm * np.random.default_rng(0).standard_normal(sheet.flat_mm.shape)
    x[29] = x[3] + 1.1
    return sheet, x, np.array([[0, 18]])


@SHEETS
def test_gradient_is_the_derivative_of_the_energy(outline: str) -> None:
    sheet, x, pairs = _cut(outline, 0.5)
    way, h = np.random.default_rng(1).standard_normal(x.shape), 1e-6
    rise = sheet.energy(x + h * way, pairs)[0] - sheet.energy(x - h * way, pairs)[0]
    gradient = sheet.energy(x, pairs)[1]
    assert rise / (2 * h) == pytest.approx((gradient * way).sum(), rel=1e-7)
    assert not gradient[~sheet.used].any()


@SHEETS
@pytest.mark.parametrize("rough_mm", [0.3, 1.2], ids=["rough", "crumpled"])
def test_hessian_is_the_derivative_of_the_gradient(rough_mm: float, outline: str) -> None:
    sheet, x, pairs = _cut(outline, rough_mm)
    matrix = Tangent(sheet).matrix(x, pairs, np.ones(x.shape, bool), convex=False)
    way, h = np.random.default_rng(1).standard_normal(x.shape), 1e-6
    change = sheet.energy(x + h * way, pairs)[1] - sheet.energy(x - h * way, pairs)[1]
    assert np.allclose(matrix @ way.ravel(), change.ravel() / (2 * h), rtol=1e-5, atol=1e-6)
    assert abs(matrix - matrix.T).max() < 1e-12


def test_a_part_of_a_sheet_feels_the_forces_of_the_whole_but_on_its_rim() -> None:
    sheet = sheet_of(MIXED.tile(2, 3), ACRYLIC)
    x = sheet.flat_mm + 0.2 * np.random.default_rng(0).standard_normal(sheet.flat_mm.shape)
    part, corners, rim = sheet.part(slice(2, 9), slice(0, 8))
    assert (part.rows, part.columns) == (6, 7)
    none = np.empty((0, 2), np.int64)
    whole, alone = sheet.energy(x, none)[1][corners], part.energy(x[corners], none)[1]
    assert np.allclose(alone[~rim], whole[~rim])
    assert not np.isclose(alone[rim], whole[rim]).all(axis=1).any()
    assert rim.reshape(7, 8).tolist() == [
        [r in (0, 1, 5, 6) or c > 5 for c in range(8)] for r in range(7)
    ]


def test_a_touch_is_soft_at_first_and_firm_at_its_usual_depth() -> None:
    thickness, stiffness = 2.5, 0.2
    energy, force, along = kernels.pressed(0.0, thickness, stiffness)
    assert energy == force == along == 0.0
    firm = (kernels.NAP + kernels.FIRM) * thickness
    _, force, along = kernels.pressed(firm, thickness, stiffness)
    assert force == pytest.approx(stiffness * kernels.FIRM * thickness)
    assert along == pytest.approx(2.0 * force / firm)


def test_convex_part_of_the_hessian_is_convex() -> None:
    sheet = sheet_of(MIXED, ACRYLIC)
    x, pairs = _crumpled(sheet)
    matrix = Tangent(sheet).matrix(x, pairs, np.ones(x.shape, bool), convex=True)
    assert np.linalg.eigvalsh(matrix.toarray()).min() > -1e-12


def test_held_corners_have_rows_of_the_unit_matrix() -> None:
    sheet = sheet_of(MIXED, ACRYLIC)
    free = np.ones(sheet.flat_mm.shape, bool)
    free[:5] = False
    matrix = Tangent(sheet).matrix(sheet.flat_mm, np.zeros((0, 2), int), free, convex=True)
    assert np.array_equal(matrix.toarray()[:15], np.eye(15, 3 * len(free)))


@SHEETS
@settings(max_examples=10)
@given(seed=st.integers(0, 2**32 - 1))
def test_motion_of_the_whole_costs_nothing(outline: str, seed: int) -> None:
    sheet, x, pairs = _cut(outline, 0.3)
    rng = np.random.default_rng(seed)
    moved = x @ Rotation.random(rng=rng).as_matrix().T + rng.standard_normal(3)
    assert sheet.energy(moved, pairs)[0] == pytest.approx(sheet.energy(x, pairs)[0], rel=1e-10)


def test_knits_and_purls_are_each_others_backs() -> None:
    """The back of a chart seen through it: K and P swapped, z reversed."""
    sheet, back = sheet_of(MIXED, ACRYLIC), sheet_of(MIXED.swap(), ACRYLIC)
    x, pairs = _crumpled(sheet, 0.3)
    turned = back.energy(x * (1.0, 1.0, -1.0), pairs)[0]
    assert turned == pytest.approx(sheet.energy(x, pairs)[0], rel=1e-10)


def test_even_stretch_has_the_energy_of_the_law() -> None:
    """Patch test: C (λ² − 1 − 2 ln λ) / 4 over the whole piece."""
    sheet = sheet_of(StitchChart.of_fabric("garter", rows=6, columns=4), ACRYLIC)
    law = ACRYLIC.law(Fabric.GARTER)
    stretched = sheet.flat_mm * (1.1, 1.0, 1.0)
    density = 0.25 * law.stiffness_xxxx * (1.1**2 - 1.0 - 2.0 * np.log(1.1))
    width, height, _ = np.ptp(sheet.flat_mm, axis=0)
    energy, gradient = sheet.energy(stretched, np.zeros((0, 2), int))
    assert energy == pytest.approx(density * width * height, rel=1e-9)
    inner = np.abs(stretched[:, 0]) < 0.4 * 1.1 * width
    inner &= np.abs(stretched[:, 1]) < 0.4 * height
    assert np.abs(gradient[inner]).max() < 1e-10  # sizes have eleven digits


def test_a_free_strip_turns_as_its_stitches_want() -> None:
    sheet = sheet_of(StitchChart.parse("KK"), ACRYLIC)
    shape = settle(sheet, sheet.flat_mm)
    assert shape.converged
    lower = shape.x[:3]
    edges = np.diff(lower, axis=0)
    cosine = (edges[0] @ edges[1]) / np.linalg.norm(edges[0]) / np.linalg.norm(edges[1])
    assert np.arccos(cosine) == pytest.approx(sheet.turning[0, 1], rel=1e-3)
    assert lower[[0, -1], 2].mean() < lower[1:-1, 2].mean()  # to the back


def _elastica(shortened: float) -> float:
    """Height over length of a pinned strip whose ends are nearer by a share of its length."""
    k = brentq(lambda q: 2 * ellipe(q**2) / ellipk(q**2) - 1 - (1 - shortened), 1e-6, 0.99)
    return float(k / ellipk(k**2))


def _pushed_together(rows: int, shortened: float) -> float:
    """Height over length of a strip of garter that is pushed together."""
    plain = sheet_of(StitchChart.of_fabric("garter", rows=rows, columns=2), ACRYLIC)
    sheet = replace(plain, touch_n_per_mm=0.0)
    length = np.ptp(sheet.flat_mm[:, 1])
    x = sheet.flat_mm * (1.0, 1.0 - shortened, 1.0)
    x[:, 2] = 0.3 * length * np.cos(np.pi * sheet.flat_mm[:, 1] / length)
    ends = np.isin(np.arange(len(x)) // 3, (0, rows))
    x[ends, 2] = 0.0
    shape = settle(sheet, x, held=ends)
    assert shape.converged
    return float(np.ptp(shape.x[:, 2]) / length)


@pytest.mark.parametrize("shortened", [0.1, 0.3])
def test_a_strip_pushed_together_is_an_elastica(shortened: float) -> None:
    assert _pushed_together(40, shortened) == pytest.approx(_elastica(shortened), rel=2e-3)


def test_a_strip_of_more_stitches_is_nearer_to_the_elastica() -> None:
    """The error falls with the square of their size."""
    errors = [abs(_pushed_together(rows, 0.3) / _elastica(0.3) - 1.0) for rows in (10, 20, 40)]
    assert errors[1] < 0.35 * errors[0]
    assert errors[2] < 0.35 * errors[1]


def test_a_strip_sags_under_its_weight_as_a_beam() -> None:
    """Clamped at one end, small deflection: w L⁴ / (8 D)."""
    sheet = sheet_of(StitchChart.of_fabric("garter", rows=20, columns=2), ACRYLIC)
    length, width = np.ptp(sheet.flat_mm[:, 1]), np.ptp(sheet.flat_mm[:, 0])
    rigidity = bends_of(ACRYLIC)[Fabric.GARTER].rigidity_wale_n_mm
    stitch = length / 20
    free_length = length - 0.5 * stitch  # the held line turns as half a stitch does
    weight = 0.02 * free_length * 8.0 * rigidity / free_length**4  # N/mm²
    load = np.zeros_like(sheet.flat_mm)
    load[:, 2] = -weight * stitch * width / 3
    load[-3:, 2] *= 0.5
    clamped = np.arange(len(load)) < 6
    shape = settle(sheet, sheet.flat_mm, held=clamped, load_n=load)
    assert shape.converged
    assert -shape.x[-3:, 2].mean() == pytest.approx(0.02 * free_length, rel=0.1)


def test_the_stored_table_is_that_of_the_yarn_level() -> None:
    lace = material("lace-bamboo")
    stored = bends_of(lace)[Fabric.STOCKINETTE]
    fresh = computed(Fabric.STOCKINETTE, lace)
    assert stored.curvature_course_per_mm == pytest.approx(fresh.curvature_course_per_mm, rel=0.02)
    assert stored.rigidity_wale_n_mm == pytest.approx(fresh.rigidity_wale_n_mm, rel=0.02)


def _held_at(sheet: StitchSheet, held: NDArray[np.bool_]) -> Array:
    x = sheet.flat_mm + shake_mm(sheet.flat_mm.shape)
    x[held.ravel()] = sheet.flat_mm[held.ravel()]
    shape = settle(sheet.clamped(held.ravel()), x, held=held.ravel())
    assert shape.converged
    return shape.x.reshape(*held.shape, 3)


@pytest.mark.parametrize("axis", [0, 1], ids=["sides", "ends"])
def test_the_edge_of_a_hole_curls_like_a_free_edge(axis: int) -> None:
    """Stockinette three stitches wide beside a clamp, beyond it a free edge or a long hole."""
    beside, hole, length = 3, 6, 48
    whole = np.ones((length, 2 * (2 + beside) + hole), dtype=bool)
    holed = whole.copy()
    holed[2:-2, 2 + beside : -2 - beside] = False
    strip = whole[:, : 2 + beside]
    heights = []
    for stitches in (strip, holed):
        there = stitches.T if axis else stitches
        sheet = sheet_of(StitchChart.parse("K").tile(*there.shape), ACRYLIC, there).cut(there)
        held = np.zeros((stitches.shape[0] + 1, stitches.shape[1] + 1), dtype=bool)
        held[:, :3] = True
        if stitches is holed:
            held[:, -3:] = held[:3] = held[-3:] = True
        corners = _held_at(sheet, held.T if axis else held)
        line = corners[:, length // 2] if axis else corners[length // 2]
        heights.append(line[: 3 + beside, 2])
    free, edge = heights
    towards = 1.0 if axis else -1.0
    assert towards * edge[-1] > 0.5
    np.testing.assert_allclose(edge, free, atol=0.2)


def test_a_sheet_of_a_known_size_is_wider_and_higher() -> None:
    chart = StitchChart.parse("KKPP").tile(6, 3)
    computed, plain = (
        neighbourhood_sizes(chart, ACRYLIC).mean(axis=(0, 1)),
        sheet_of(chart, ACRYLIC),
    )
    for factor in (1.0, 0.9, 1.2):
        known = sheet_of(chart, ACRYLIC, size=RelaxedSize(*(factor * computed).tolist()))
        np.testing.assert_allclose(known.flat_mm, factor * plain.flat_mm, rtol=1e-5, atol=1e-9)
        np.testing.assert_allclose(known.membrane[:, :2], factor * plain.membrane[:, :2], rtol=1e-5)
