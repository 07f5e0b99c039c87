"""A whole piece worn as a tube."""

from pathlib import Path

import meshio
import numpy as np
import pytest

from knitcore import Direction, InputError, RelaxedSize, StitchChart, material, predict
from knitcore.cloth.space.limb_tube import worn_tube
from knitcore.draw.placing import lying
from knitcore.garment.glove import Hand, glove
from knitcore.garment.limb import MeasuredLimb, place_on
from knitcore.garment.templates import Girth, limb_tube
from tests.knitcore.refusals import refuses

ACRYLIC = material("acrylic")
PLAIN = StitchChart.parse("K").tile(6, 40)


def _radius_mm(corners: np.ndarray) -> np.ndarray:
    return np.hypot(corners[..., 0], corners[..., 2])


def test_every_row_fits_as_a_tube_of_its_repeat_does() -> None:
    girth = 170.0
    tube = worn_tube(PLAIN, ACRYLIC, MeasuredLimb((0.0, 300.0), (girth, girth)))
    along = predict(StitchChart.parse("K"), ACRYLIC).along(Direction.COURSE)
    alone = place_on(along, 0.0, girth, 40 * along.relaxed_mm)
    for place in tube.places:
        assert place.pressure.kpa.high == pytest.approx(alone.pressure.kpa.high, rel=1e-6)
    assert _radius_mm(tube.corners_mm) == pytest.approx(girth / (2 * np.pi))
    assert tube.length_mm == pytest.approx(
        tube.relaxed_length_mm * (1 + alone.pressure.axial_strain_free)
    )
    assert np.ptp(tube.corners_mm[..., 1]) == pytest.approx(tube.length_mm)


def test_a_loose_tube_keeps_its_own_size() -> None:
    tube = worn_tube(PLAIN, ACRYLIC, MeasuredLimb((0.0, 300.0), (50.0, 60.0)))
    assert all(place.pressure is None for place in tube.places)
    assert tube.length_mm == pytest.approx(tube.relaxed_length_mm)
    assert _radius_mm(tube.corners_mm).min() > _radius_mm(tube.limb_mm).max()


def test_the_face_is_outside_and_the_tube_is_closed() -> None:
    tube = worn_tube(PLAIN, ACRYLIC, MeasuredLimb((0.0, 20.0), (170.0, 200.0)))
    frames = lying(tube.corners_mm).frames
    centres = 0.25 * (
        tube.corners_mm[1:, 1:]
        + tube.corners_mm[:-1, 1:]
        + tube.corners_mm[1:, :-1]
        + tube.corners_mm[:-1, :-1]
    )
    outwards = (frames[..., 2] * centres * (1, 0, 1)).sum(axis=-1)
    assert (outwards > 0.9 * _radius_mm(centres)).all()
    np.testing.assert_allclose(tube.corners_mm[:, 0], tube.corners_mm[:, -1], atol=1e-9)


def test_a_ribbed_cuff_is_narrower_at_rest_and_presses_less() -> None:
    cuff = np.tile([[False, False, True, True]], (20, 12))
    sleeve = StitchChart(np.vstack([cuff, np.zeros((24, 48), dtype=bool)]))
    tube = worn_tube(sleeve, ACRYLIC, MeasuredLimb((0.0, 300.0), (200.0, 200.0)))
    first, last = tube.places[3], tube.places[-3]
    assert first.rest_mm < 0.8 * last.rest_mm
    assert first.pressure.kpa.high < last.pressure.kpa.low


@pytest.mark.parametrize("size", [None, RelaxedSize(3.0, 2.0)], ids=["computed", "counted"])
def test_an_unworn_tube_has_the_predicted_size(size: RelaxedSize | None) -> None:
    purl = np.vstack([np.tile([False, True], (6, 15)), np.zeros((14, 30), dtype=bool)])
    purl[12:18, 8:22] = StitchChart.parse("KP/PK").tile(3, 7).purl
    chart = StitchChart(purl)
    for piece in (chart, chart.region(slice(3, 18), slice(5, 25))):
        answer = predict(piece, ACRYLIC, size)
        for around in Direction:
            tube = worn_tube(
                piece, ACRYLIC, MeasuredLimb((0.0, 300.0), (90.0, 90.0)), around, size=size
            )
            along, across = answer.along(around), answer.along(around.other)
            lines, stitches = around.of((piece.rows, piece.columns), (piece.columns, piece.rows))
            assert tube.relaxed_length_mm == pytest.approx(lines * across.relaxed_mm)
            mean = np.mean([place.rest_mm for place in tube.places])
            assert mean == pytest.approx(stitches * along.relaxed_mm)


def test_at_a_hem_the_pressure_changes_from_row_to_row_and_not_at_once() -> None:
    cuff = np.tile([[False, False, True, True]], (20, 16))
    sleeve = StitchChart(np.vstack([cuff, np.zeros((50, 64), dtype=bool)]))
    along = worn_tube(sleeve, ACRYLIC, MeasuredLimb((0.0, 600.0), (260.0, 260.0)))
    limb = MeasuredLimb((0.0, 600.0), (160.0, 160.0))
    across = worn_tube(StitchChart(sleeve.purl.T), ACRYLIC, limb, Direction.WALE)
    for tube in (along, across):
        kpa = np.array([place.pressure.kpa.low for place in tube.places if place.pressure])
        assert len(kpa) == 70
        assert kpa.max() > 1.9 * kpa.min()
        assert np.abs(np.diff(np.log(kpa))).max() < np.log(1.45)


def test_columns_run_around_as_rows_do() -> None:
    rib = StitchChart.parse("KP").tile(40, 3)
    tube = worn_tube(rib, ACRYLIC, MeasuredLimb((0.0, 300.0), (120.0, 120.0)), Direction.WALE)
    assert tube.corners_mm.shape == (41, 7, 3)
    assert len(tube.places) == 6
    assert np.ptp(tube.corners_mm[..., 0]) == pytest.approx(tube.length_mm)
    np.testing.assert_allclose(tube.corners_mm[0], tube.corners_mm[-1], atol=1e-9)


def test_on_a_cone_lengths_are_measured_along_the_skin() -> None:
    tube = worn_tube(PLAIN, ACRYLIC, MeasuredLimb((0.0, 20.0), (170.0, 230.0)))
    front = tube.corners_mm[:, 20]
    skin = np.linalg.norm(np.diff(front[:, 1:], axis=0), axis=1).sum()
    assert skin == pytest.approx(tube.length_mm, rel=0.05)
    assert np.ptp(front[:, 1]) < tube.length_mm


def test_too_few_stitches_make_no_tube() -> None:
    with pytest.raises(InputError, match="at least 4 stitches, or"):
        worn_tube(StitchChart.parse("KK/KK"), ACRYLIC, MeasuredLimb((0.0, 9.0), (50.0, 60.0)))


@pytest.mark.parametrize(
    ("at", "girths"), [((0.0,), (9.0,)), ((5.0, 5.0), (9.0, 9.0)), ((0.0, 5.0), (9.0, 0.0))]
)
def test_impossible_limbs_are_refused(at: tuple[float, ...], girths: tuple[float, ...]) -> None:
    with pytest.raises(InputError):
        MeasuredLimb(at, girths)


SLEEVE = limb_tube("sleeve", [Girth(0, 180), Girth(120, 250)], ACRYLIC)


def test_a_shaped_tube_has_the_stitches_of_its_rows(tmp_path: Path) -> None:
    stitch = SLEEVE.shaped.stitch
    plain = StitchChart(np.zeros_like(stitch))
    limb = MeasuredLimb((0.0, 300.0), (260.0, 260.0))
    tube = worn_tube(plain, ACRYLIC, limb, stitches=stitch)
    tube.write(tmp_path / "x.vtu")
    assert len(meshio.read(tmp_path / "x.vtu").cells[0].data) == np.count_nonzero(stitch)
    counts = stitch.sum(axis=1)
    rests = np.array([place.rest_mm for place in tube.places])
    assert np.ptp(counts) > 10
    assert rests / counts == pytest.approx(np.full(len(counts), rests[0] / counts[0]))
    assert np.isfinite(lying(tube.corners_mm).frames).all()
    edges = stitch.argmax(axis=1)
    around = np.arctan2(tube.corners_mm[..., 0], tube.corners_mm[..., 2])
    steps = [2 * np.pi / counts[row] for row in (0, -1)]
    assert abs(around[0, edges[0]] + np.pi) < steps[0]
    assert abs(around[-1, edges[-1]] + np.pi) < steps[1]


def test_cells_outside_an_outline_change_nothing() -> None:
    shaped = SLEEVE.shaped
    limb = MeasuredLimb((0.0, 300.0), (200.0, 260.0))
    other = StitchChart(shaped.chart.purl ^ ~shaped.stitch)
    first, second = (
        worn_tube(chart, ACRYLIC, limb, stitches=shaped.stitch) for chart in (shaped.chart, other)
    )
    assert first.places == second.places


@pytest.mark.parametrize("around", Direction)
def test_a_glove_is_no_tube(around: Direction) -> None:
    glove_chart = glove(Hand(), ACRYLIC).shaped
    limb = MeasuredLimb((0.0, 300.0), (200.0, 260.0))
    with refuses("outline"):
        worn_tube(glove_chart.chart, ACRYLIC, limb, around, stitches=glove_chart.stitch)


@pytest.mark.parametrize("around", Direction)
def test_a_tube_of_a_counted_gauge_is_as_large_and_presses_as_its_gauge_says(
    around: Direction,
) -> None:
    chart, size = StitchChart.parse("KKPP").tile(10, 10), RelaxedSize(3.0, 3.5)
    limb = MeasuredLimb((0.0, 300.0), (190.0, 190.0))
    tube = worn_tube(chart, ACRYLIC, limb, around, size=size)
    along, lines = predict(chart, ACRYLIC, size).along(around), len(tube.places)
    rests = [place.rest_mm for place in tube.places]
    assert np.mean(rests) == pytest.approx(400 / lines * size.extent_mm(around))
    assert tube.relaxed_length_mm == pytest.approx(lines * size.extent_mm(around.other))
    place = tube.places[lines // 2]
    alone = place_on(along, 0.0, 190.0, place.rest_mm)
    assert place.highest_mmhg == pytest.approx(alone.highest_mmhg, rel=0.05)
