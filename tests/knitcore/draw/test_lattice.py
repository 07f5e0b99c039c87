import numpy as np
import pytest

from knitcore import Fabric, StitchChart, material
from knitcore.draw.lattice import flat_lattice, resting_lattice, stretched_sizes_mm


@pytest.mark.parametrize("fabric", list(Fabric))
def test_a_pure_fabric_is_a_regular_lattice(fabric: Fabric) -> None:
    record = material("acrylic").record(fabric)
    lattice = flat_lattice(StitchChart.of_fabric(fabric, rows=4, columns=6), material("acrylic"))
    np.testing.assert_allclose(lattice.sizes_mm[..., 0], record.stitch_course_mm)
    np.testing.assert_allclose(lattice.sizes_mm[..., 1], record.stitch_wale_mm)
    np.testing.assert_allclose(np.diff(lattice.centres_mm[..., 0], axis=1), record.stitch_course_mm)
    np.testing.assert_allclose(np.diff(lattice.centres_mm[..., 1], axis=0), record.stitch_wale_mm)


def test_stretched_stitches_grow_with_their_distances() -> None:
    chart = StitchChart.parse("KKPP\nKPKP\nPPKK")
    lattice = flat_lattice(chart, material("cotton"))
    stretched = stretched_sizes_mm(lattice.centres_mm * [0.8, 1.5], lattice)
    np.testing.assert_allclose(stretched, lattice.sizes_mm * [0.8, 1.5])


def test_a_lone_stitch_keeps_its_size() -> None:
    lattice = flat_lattice(StitchChart.parse("K"), material("acrylic"))
    np.testing.assert_allclose(stretched_sizes_mm(lattice.centres_mm, lattice), lattice.sizes_mm)


@pytest.mark.parametrize("above", ["K", "KP/PK", "K/P", "KKPP/KKPP/PPKK/PPKK"])
def test_a_ribbed_hem_pulls_in_beside_any_texture(above: str) -> None:
    """Gradually, and less where the texture above holds it."""
    rib, texture = (StitchChart.parse(text) for text in ("KKPP", above))
    piece = StitchChart(np.vstack([rib.resized(20, 60).purl, texture.resized(60, 60).purl]))
    lattice = resting_lattice(piece, material("glove-wool"))
    widths = lattice.sizes_mm[..., 0].sum(axis=1)
    assert widths[0] < 0.8 * widths[-1]
    assert np.all(np.diff(widths) > -1e-3 * widths[-1])
    assert np.abs(np.diff(np.log(widths))).max() < 0.05
    x = lattice.centres_mm[..., 0]
    np.testing.assert_allclose(x + x[:, ::-1], x[0, 0] + x[0, -1], rtol=2e-2)


def test_welts_shorten_the_columns_that_have_them() -> None:
    welt, plain = (StitchChart.parse(text).resized(40, 30).purl for text in ("KK/PP", "K"))
    heights = resting_lattice(StitchChart(np.hstack([welt, plain])), material("acrylic")).sizes_mm
    total = heights[..., 1].sum(axis=0)
    assert total[0] < 0.95 * total[-1]


def test_a_repeat_lies_straight_and_a_pure_fabric_as_before() -> None:
    basket = StitchChart.parse("KKPP/KKPP/PPKK/PPKK").resized(32, 32)
    lattice = resting_lattice(basket, material("acrylic"))
    np.testing.assert_allclose(np.diff(lattice.centres_mm[..., 0], axis=0), 0, atol=1e-6)
    seed = StitchChart.of_fabric("seed", 6, 9)
    straight, drawn = (f(seed, material("acrylic")) for f in (flat_lattice, resting_lattice))
    np.testing.assert_array_equal(straight.centres_mm, drawn.centres_mm)


@pytest.mark.parametrize("text", ["KP/PK", "KKPP", "K/P/K/K"])
def test_neighbouring_stitches_share_their_corners(text: str) -> None:
    lattice = resting_lattice(StitchChart.parse(text).resized(9, 12), material("acrylic"))
    corners = lattice.corners_mm
    assert corners.shape == (10, 13, 2)
    middles = (corners[1:, 1:] + corners[1:, :-1] + corners[:-1, 1:] + corners[:-1, :-1]) / 4
    spread = lattice.sizes_mm.min(axis=(0, 1)).min()
    np.testing.assert_allclose(middles, lattice.centres_mm, atol=0.1 * spread)
    sizes = lattice.sizes_mm.sum(axis=(0, 1))
    span = np.ptp(corners[..., 0], axis=1).sum(), np.ptp(corners[..., 1], axis=0).sum()
    np.testing.assert_allclose(np.array(span) * [9 / 10, 12 / 13], sizes, rtol=0.02)
