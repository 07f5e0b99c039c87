import numpy as np
import pytest
from hypothesis import given, settings
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from knitcore import Fabric, RelaxedSize, StitchChart
from knitcore.draw.fabric_loops import POINTS, cell_lines, fabric_lines
from knitcore.draw.instances import COARSE_LEVELS, LEVELS, level_of, stitch_meshes
from knitcore.draw.lattice import flat_lattice
from knitcore.draw.placing import DEPTH, carried, placed_lines, unstretched
from knitcore.draw.stitches import StitchShapes, stitch_shapes
from knitcore.draw.tubes import resampled
from knitcore.materials import load_library, material
from knitcore.prediction.predict import predict
from knitcore.yarn.library.store import stored_stitch
from tests.knitcore.charts import stitch_charts

ACRYLIC = material("acrylic")
BASKET = StitchChart.parse("KKPP\nKKPP\nPPKK\nPPKK")
MIXED = StitchChart.parse(
    "KKKKPKPK\nKKKKPKPK\nKKKKPKPK\nKKKKKPKP\nPPPPPKPK\nKKKKKPKP\nPPPPPKPK\nKKKKKKKK"
)


def _strand_distance_mm(shapes: StitchShapes) -> float:
    """Smallest distance between yarn that is not the same strand, inside the chart."""
    lines = placed_lines(shapes, unstretched(shapes))[:, :, :-1]
    rows, columns, points = lines.shape[:3]
    row = np.repeat(np.arange(rows), columns * points)
    along = np.tile(np.arange(columns * points) / points, rows)
    flat = lines.reshape(-1, 3)
    first, second = cKDTree(flat).query_pairs(1.2, output_type="ndarray").T
    inside = (row[first] > 0) & (row[second] < rows - 1)
    other = (row[first] != row[second]) | (np.abs(along[first] - along[second]) > 0.3)
    chosen = inside & other
    return float(np.linalg.norm(flat[first[chosen]] - flat[second[chosen]], axis=1).min())


@given(stitch_charts(7))
@settings(max_examples=40)
def test_neighbours_in_a_course_join_without_gap_or_kink(chart: StitchChart) -> None:
    shapes = stitch_shapes(chart, ACRYLIC)
    lines = placed_lines(shapes, unstretched(shapes))
    gap = np.linalg.norm(lines[:, :-1, -1] - lines[:, 1:, 0], axis=-1)
    assert gap.max(initial=0.0) < 0.1 * shapes.yarn_radius_mm  # where textures draw each other in
    left, right = lines[:, :-1], lines[:, 1:]
    before = 3 * left[:, :, -1] - 4 * left[:, :, -2] + left[:, :, -3]
    after = -3 * right[:, :, 0] + 4 * right[:, :, 1] - right[:, :, 2]
    cosine = np.einsum("rcx,rcx->rc", before, after)
    cosine /= np.linalg.norm(before, axis=2) * np.linalg.norm(after, axis=2)
    # The limits are equal; what is left comes from the few points and the wales' widths.
    assert (cosine > np.cos(np.radians(25))).all()


@given(stitch_charts(6))
@settings(max_examples=40)
def test_turning_the_fabric_over_turns_its_yarn_over(chart: StitchChart) -> None:
    shapes, turned = (stitch_shapes(c, ACRYLIC) for c in (chart, chart.turn_over()))
    lines, back = (placed_lines(s, unstretched(s)) for s in (shapes, turned))
    width = sum(s.lattice.centres_mm[..., 0].mean() for s in (shapes, turned))
    expected = lines[:, ::-1, ::-1] * (-1.0, 1.0, -1.0) + (width, 0.0, 0.0)
    np.testing.assert_allclose(back, expected, atol=2e-3)  # as exactly as a cell is relaxed


@pytest.mark.parametrize("fabric", list(Fabric))
def test_a_pure_fabric_follows_its_relaxed_cell(fabric: Fabric) -> None:
    chart = StitchChart.of_fabric(fabric, rows=6, columns=6)
    stored = stored_stitch(chart, "acrylic")
    shapes = stitch_shapes(chart, ACRYLIC)
    record = ACRYLIC.record(fabric)
    scale = np.sqrt(np.prod(record.stitch_mm) / (stored.cell_course_mm * stored.cell_wale_mm))
    cell = np.tile(cell_lines(stored), (6, 6, 1, 1))[:6, :6] * (1.0, 1.0, scale)
    np.testing.assert_allclose(shapes.lines[shapes.index], cell, atol=2e-3)


def test_a_stored_repeat_is_shown_as_it_relaxed() -> None:
    shapes = stitch_shapes(BASKET.tile(8, 8), ACRYLIC)
    assert shapes.source == "relaxed cell of this repeat in acrylic"
    assert len(shapes.lines) == 16
    bulge = np.ptp(shapes.lines[..., 2])
    assert bulge > 4 * np.ptp(stitch_shapes(StitchChart.parse("K"), ACRYLIC).lines[..., 2])


@pytest.mark.parametrize("name", ["acrylic", "cotton"])
@pytest.mark.parametrize("repeat", ["KKPP", "KKKPPP", "KKKKPPPP", "KP\nKP\nPK\nPK", "K\nK\nP\nP"])
def test_a_stored_repeat_is_drawn_as_large_as_it_is_predicted(repeat: str, name: str) -> None:
    chart, yarn = StitchChart.parse(repeat).tile(3, 3), material(name)
    shapes, predicted = stitch_shapes(chart, yarn), predict(chart, yarn)
    assert shapes.source.startswith("relaxed cell of this repeat")
    size = predicted.relaxed_course_mm, predicted.relaxed_wale_mm
    np.testing.assert_allclose(shapes.lattice.sizes_mm.mean(axis=(0, 1)), size, rtol=1e-9)


@pytest.mark.parametrize("name", ["acrylic", "cotton"])
def test_strands_keep_apart_as_they_do_in_the_relaxed_fabrics(name: str) -> None:
    chosen = material(name)
    for fabric in Fabric:
        chart = StitchChart.of_fabric(fabric, rows=4, columns=6)
        own = fabric_lines(chosen).strand_mm[list(Fabric).index(fabric)]
        assert _strand_distance_mm(stitch_shapes(chart, chosen)) == pytest.approx(own, rel=0.02)


@pytest.mark.parametrize("name", ["acrylic", "cotton"])
def test_no_yarn_passes_through_yarn_where_fabrics_meet(name: str) -> None:
    chosen = material(name)
    assert _strand_distance_mm(stitch_shapes(MIXED, chosen)) > 0.15
    rng = np.random.default_rng(3)
    wild = StitchChart(rng.random((10, 10)) < 0.5)
    assert _strand_distance_mm(stitch_shapes(wild, chosen)) > 0.08


@pytest.mark.parametrize("name", sorted(load_library()))
def test_every_material_has_stitches_with_a_source(name: str) -> None:
    shapes = stitch_shapes(MIXED, material(name))
    assert np.isfinite(shapes.lines).all()
    assert 0.1 < shapes.yarn_radius_mm < 0.4 * material(name).record(Fabric.SEED).stitch_course_mm
    assert ("an estimate" in shapes.source) == (name not in ("acrylic", "cotton"))


def test_a_wild_chart_has_no_more_shapes_than_a_browser_can_take() -> None:
    rng = np.random.default_rng(5)
    shapes = stitch_shapes(StitchChart(rng.random((60, 60)) < 0.5), ACRYLIC)
    assert len(shapes.lines) <= 128
    lines = placed_lines(shapes, unstretched(shapes))
    np.testing.assert_allclose(lines[:, :-1, -1], lines[:, 1:, 0], atol=0.05)


def test_a_stretched_fabric_keeps_its_yarn_and_becomes_thinner() -> None:
    shapes = stitch_shapes(StitchChart.parse("KP").tile(6, 8), ACRYLIC)
    sheet = shapes.lattice
    pulled = carried(shapes, sheet.centres_mm * [1.25, 1.0], sheet)
    assert DEPTH[0] <= pulled.depth < 1.0
    lengths: list[NDArray[np.float64]] = [
        np.linalg.norm(np.diff(placed_lines(shapes, p), axis=2), axis=-1).sum()
        for p in (unstretched(shapes), pulled)
    ]
    assert lengths[1] == pytest.approx(lengths[0], rel=0.02)


def test_a_turned_sheet_turns_its_stitches() -> None:
    shapes = stitch_shapes(StitchChart.parse("K").tile(5, 5), ACRYLIC)
    sheet, angle = flat_lattice(StitchChart.parse("K").tile(5, 5), ACRYLIC), 0.3
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    lines = placed_lines(shapes, carried(shapes, sheet.centres_mm @ turn, sheet))
    np.testing.assert_allclose(lines[:, :-1, -1], lines[:, 1:, 0], atol=0.03)


@pytest.mark.parametrize(("levels", "coarse"), [(LEVELS, False), (COARSE_LEVELS, True)])
def test_meshes_follow_the_chart_s_size(
    levels: tuple[tuple[int, int, int], ...], coarse: bool
) -> None:
    shapes = stitch_shapes(MIXED, ACRYLIC)
    for most, points, sides in levels:
        assert level_of(most, coarse=coarse) == (points, sides)
        meshes = stitch_meshes(shapes, unstretched(shapes), points, sides)
        assert meshes.vertices.shape == (len(shapes.lines), (points + 2) * sides, 3)
    assert resampled(shapes.lines, POINTS) == pytest.approx(shapes.lines)


def test_some_shapes_are_drawn_as_among_all() -> None:
    shapes = stitch_shapes(MIXED, ACRYLIC)
    every = stitch_meshes(shapes, unstretched(shapes), 14, 6)
    some = stitch_meshes(shapes, unstretched(shapes), 14, 6, [3, 1])
    np.testing.assert_allclose(some.vertices, every.vertices[[3, 1]], atol=1e-6)
    np.testing.assert_allclose(some.light, every.light[[3, 1]], atol=1e-6)
    assert stitch_meshes(shapes, unstretched(shapes), 14, 6, []).vertices.shape == (0, 96, 3)


@pytest.mark.parametrize("chart", [BASKET.tile(2, 2), MIXED])
def test_counted_stitches_are_as_large_as_counted_and_their_yarn_never_overlaps(
    chart: StitchChart,
) -> None:
    """Loops open in a loose piece; a tight one squeezes its yarn."""
    shapes = stitch_shapes(chart, ACRYLIC)
    width, height = shapes.lattice.sizes_mm.mean(axis=(0, 1)).tolist()
    for factor in (0.7, 1.3):
        counted = shapes.resized(RelaxedSize(factor * width, factor * height))
        np.testing.assert_allclose(counted.lattice.centres_mm, factor * shapes.lattice.centres_mm)
        thinner = min(factor, 1.0)
        assert counted.yarn_radius_mm == pytest.approx(thinner * shapes.yarn_radius_mm)
        apart = _strand_distance_mm(shapes)
        assert _strand_distance_mm(counted) > 0.99 * thinner * apart
