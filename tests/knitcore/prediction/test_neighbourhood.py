"""Sizes that know their surroundings."""

import numpy as np
import pytest
from hypothesis import given, settings

from knitcore import RelaxedSize, StitchChart, material
from knitcore.chart.fabric import PHASES
from knitcore.prediction import neighbourhood
from knitcore.prediction.learned import learned
from knitcore.prediction.neighbourhood import counted_over_computed, neighbourhood_sizes
from tests.knitcore.charts import flipped, stitch_charts

ACRYLIC = material("acrylic:published")


@pytest.mark.parametrize("fabric", PHASES)
def test_a_piece_of_a_pure_fabric_has_its_size_up_to_the_edge(fabric: str) -> None:
    record = ACRYLIC.record(fabric)
    sizes = neighbourhood_sizes(StitchChart.of_fabric(fabric, 21, 30), ACRYLIC)
    expected = np.array([record.stitch_course_mm, record.stitch_wale_mm])
    assert np.abs(sizes / expected - 1).max() < 0.03


@settings(max_examples=10)
@given(stitch_charts(16))
def test_a_piece_and_its_back_have_the_same_sizes(piece: StitchChart) -> None:
    sizes = neighbourhood_sizes(piece, ACRYLIC)
    assert sizes.shape == (piece.rows, piece.columns, 2)
    assert np.allclose(neighbourhood_sizes(piece.swap(), ACRYLIC), sizes)
    assert np.allclose(neighbourhood_sizes(piece.turn_over(), ACRYLIC), sizes[:, ::-1])


@pytest.mark.parametrize("above", ["K", "KP/PK", "K/P"])
def test_a_ribbed_hem_is_narrower_than_any_texture_above_it(above: str) -> None:
    rib, texture = StitchChart.parse("KKPP"), StitchChart.parse(above)
    piece = StitchChart(np.vstack([rib.resized(40, 40).purl, texture.resized(40, 40).purl]))
    sizes = neighbourhood_sizes(piece, ACRYLIC)
    assert sizes[0, 20, 0] == pytest.approx(learned(rib, ACRYLIC).size_mm[0], rel=0.15)
    assert sizes[75, 20, 0] == pytest.approx(learned(texture, ACRYLIC).size_mm[0], rel=0.05)
    assert np.all(sizes[4, :, 0] < sizes[75, :, 0])
    steps = np.abs(np.diff(np.log(sizes[:, 20, 0])))
    assert steps.max() < 0.25  # it narrows over several rows


def test_sizes_do_not_depend_on_what_was_asked_before(monkeypatch: pytest.MonkeyPatch) -> None:
    """Values of windows are kept: those that a stroke leaves alone are not computed again."""
    chart = StitchChart(np.random.default_rng(4).random((30, 34)) < 0.5)
    changed = flipped(chart, 10, slice(12, 15))
    yarns = [material("acrylic"), material("cotton")]
    monkeypatch.setattr(neighbourhood, "MOST_KNOWN", 0)
    alone = [neighbourhood_sizes(changed, yarn) for yarn in yarns]
    monkeypatch.undo()
    for yarn in yarns:
        neighbourhood_sizes(chart, yarn)
    after = [neighbourhood_sizes(changed, yarn) for yarn in yarns]
    assert np.allclose(after, alone, rtol=1e-12)
    assert not np.allclose(alone[0], alone[1], rtol=1e-3)


@settings(max_examples=10)
@given(stitch_charts(9))
def test_a_counted_piece_has_the_mean_stitch_that_was_counted(piece: StitchChart) -> None:
    """Stitches outside its outline do not count."""
    known, sizes = RelaxedSize(4.0, 3.0), neighbourhood_sizes(piece, ACRYLIC)
    inside = np.ones_like(piece.purl)
    inside[0, 1:] = False
    counted = sizes * counted_over_computed(piece, ACRYLIC, known, inside)
    assert np.allclose(counted[inside].mean(axis=0), (4.0, 3.0))
    assert counted_over_computed(piece, ACRYLIC, None).tolist() == [1.0, 1.0]
