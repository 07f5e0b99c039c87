"""Shapes that a knitter knows."""

import io
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from knitcore import CancelledError, Direction, Fabric, InputError, StitchChart, material, predict
from knitcore.base.arrays import Array
from knitcore.cloth.space.curl import UNBALANCED_NOTE, CurledPiece, Pull, curl
from knitcore.cloth.space.sheet_shape import settle
from knitcore.cloth.space.stitch_sheet import sheet_of
from knitcore.formats.write.yarn_mesh import write_curled_glb
from knitcore.garment.shaped import outline_marks
from tests.knitcore.charts import flipped
from tests.knitcore.cloth.space.outlines import OUTLINES
from tests.knitcore.refusals import refuses

ACRYLIC = material("acrylic")
Ints = NDArray[np.int64]


def _piece(repeat: str, across: int, up: int) -> CurledPiece:
    return _at_rest(StitchChart.parse(repeat).tile(up, across))


def _at_rest(
    chart: StitchChart, *, pull: Pull | None = None, stitches: NDArray[np.bool_] | None = None
) -> CurledPiece:
    piece = curl(chart, ACRYLIC, pull=pull, stitches=stitches)
    assert piece.converged
    return piece


def test_the_sides_of_stockinette_roll_to_the_back_and_its_ends_to_the_front() -> None:
    piece = _piece("K", 12, 12)
    assert piece.curl_course_mm < 0.0 < piece.curl_wale_mm
    tall, wide = _piece("K", 6, 20), _piece("K", 16, 4)
    assert tall.curl_course_mm < -0.5 * tall.thickness_mm
    assert wide.curl_wale_mm > 0.5 * wide.thickness_mm

    reverse = _piece("P", 6, 20)
    assert reverse.curl_course_mm > 0.5 * reverse.thickness_mm


@pytest.mark.parametrize("holed", [False, True])
@pytest.mark.parametrize("fabric", [Fabric.GARTER, Fabric.RIB, Fabric.SEED])
def test_balanced_fabrics_lie_flat_at_their_size(fabric: Fabric, holed: bool) -> None:
    """Around a hole, too: its edge takes its parity from within the cloth."""
    stitches = np.ones((16, 16), dtype=bool)
    stitches[5:10, 6:11] = not holed  # odd, so that the chart's parity differs at its sides
    chart = StitchChart.of_fabric(fabric, rows=16, columns=16)
    purl = chart.purl ^ ~stitches & (np.random.default_rng(0).random((16, 16)) < 0.5)
    piece = _at_rest(StitchChart(purl), stitches=stitches if holed else None)
    record = ACRYLIC.record(fabric)
    assert piece.depth_mm < 0.1
    assert piece.width_mm == pytest.approx(16 * record.stitch_course_mm, rel=1e-3)
    assert piece.height_mm == pytest.approx(16 * record.stitch_wale_mm, rel=1e-3)


def test_a_strip_rolls_up_into_scrolls_as_tight_as_it_can() -> None:
    """From both ends: each holds half of its length, π R² = length times thickness."""
    piece = _piece("K", 30, 2)
    length = float(np.ptp(piece.flat_mm[..., 0]))
    expected = np.sqrt(0.5 * length * piece.thickness_mm / np.pi)
    assert 0.5 * piece.depth_mm == pytest.approx(expected, rel=0.2)


def _block(knits: int) -> str:
    wide = "K" * knits + "P" * knits
    return "/".join([wide] * knits + [wide[::-1]] * knits)


@pytest.mark.parametrize(
    ("repeat", "up", "across"),
    [
        ("KKPP", 20, 6),
        ("KKKPPP", 20, 4),
        ("KKKKKKPPPPPP", 20, 3),
        ("K/K/P/P", 6, 16),
        ("K/K/K/P/P/P", 4, 16),
        (_block(3), 3, 3),
        (_block(4), 3, 3),
    ],
    ids=["2x2 rib", "3x3 rib", "6x6 rib", "2-2 welt", "3-3 welt", "3x3 basket", "4x4 basket"],
)
def test_folds_are_as_wide_and_high_as_the_relaxed_fabric(
    repeat: str, up: int, across: int
) -> None:
    """Extent of the inner repeats, over that of the answer."""
    chart = StitchChart.parse(repeat)
    piece = _at_rest(chart.tile(up, across))
    answer = predict(chart, ACRYLIC)
    for axis, along in ((1, answer.course), (0, answer.wale)):
        line = piece.corners_mm.mean(axis=1 - axis)
        ends = line[[chart.purl.shape[axis], -1 - chart.purl.shape[axis]]]
        count = len(line) - 1 - 2 * chart.purl.shape[axis]
        assert np.linalg.norm(ends[1] - ends[0]) / count == pytest.approx(along.relaxed_mm, rel=0.1)


@pytest.mark.parametrize("repeat", ["KKP", "KKKKPP", "KKKKKP"])
def test_ribs_that_do_not_balance_are_as_wide_as_predicted_when_laid_flat(repeat: str) -> None:
    """One column in every repeat is kept in the plane; as it lies such a rib rolls to the back."""
    wide, chart = len(repeat), StitchChart.parse(repeat).tile(8, 4)
    sheet = sheet_of(chart, ACRYLIC)
    held = np.zeros((chart.rows + 1, chart.columns + 1, 3), dtype=bool)
    held[:, ::wide, 2] = True
    held = held.reshape(-1, 3)
    begin = sheet.flat_mm + 1e-3 * np.random.default_rng(0).standard_normal(sheet.flat_mm.shape)
    begin[held] = 0.0
    flat = settle(sheet, begin, held=held)
    assert flat.converged
    line = flat.x.reshape(chart.rows + 1, chart.columns + 1, 3)[:, :, 0].mean(axis=0)
    width = (line[3 * wide] - line[wide]) / (2 * wide)
    predicted = predict(StitchChart.parse(repeat), ACRYLIC).course.relaxed_mm
    assert width == pytest.approx(predicted, rel=0.1)
    piece = _at_rest(chart)
    assert piece.curl_course_mm < 0.0
    assert UNBALANCED_NOTE in piece.notes


def test_welts_draw_in_along_the_columns() -> None:
    piece = _piece("P\nP\nP\nK\nK\nK", 12, 3)
    flat = np.ptp(piece.flat_mm, axis=(0, 1))
    assert piece.height_mm < 0.85 * flat[1]
    assert piece.width_mm > 0.9 * flat[0]


def test_a_basket_pillows() -> None:
    piece = _piece(_block(4), 2, 2)
    assert piece.depth_mm > 2.0 * piece.thickness_mm


def test_a_single_stitch_is_flat() -> None:
    piece = _at_rest(StitchChart.parse("K"))
    assert piece.curl_course_mm == pytest.approx(0.0, abs=1e-6)


def test_a_test_that_did_not_converge_is_marked() -> None:
    piece = curl(StitchChart.parse("K").tile(20, 20), ACRYLIC, time_limit_s=0.0)
    assert not piece.converged


@pytest.mark.parametrize(
    ("size", "options", "problem"),
    [
        ((101, 100), {}, "stitches"),
        ((4, 4), {"stitches": np.ones((3, 4), dtype=bool)}, "does not fit"),
        ((4, 4), {"begin": np.zeros((4, 5, 3))}, "another size"),
        ((1, 2), {"pull": Pull(Direction.WALE, 0.1)}, "too small for clamps"),
    ],
)
def test_impossible_pieces_are_refused(
    size: tuple[int, int], options: dict[str, Any], problem: str
) -> None:
    with pytest.raises(InputError, match=problem):
        curl(StitchChart.parse("K").tile(*size), ACRYLIC, **options)


def test_it_can_be_cancelled() -> None:
    with pytest.raises(CancelledError):
        curl(StitchChart.parse("K").tile(9, 9), ACRYLIC, cancelled=lambda: True)


def test_pulled_between_clamps_the_free_sides_curl_and_the_more_so_the_less_it_is_pulled() -> None:
    chart = StitchChart.parse("K").tile(20, 12)
    little, much = (
        curl(chart, ACRYLIC, pull=Pull(Direction.WALE, strain)) for strain in (0.05, 0.3)
    )
    assert little.converged
    assert much.converged
    assert little.curl_course_mm < much.curl_course_mm < -0.5 * much.thickness_mm
    ends = much.corners_mm[[0, 1, -2, -1]]
    np.testing.assert_allclose(ends[..., 2], 0.0, atol=1e-12)
    flat = much.flat_mm[..., 1]
    between = 0.5 * (flat[-1, 0] + flat[-2, 0] - flat[0, 0] - flat[1, 0])
    assert np.ptp(much.corners_mm[..., 1]) == pytest.approx(np.ptp(flat) + 0.3 * between)


def test_pulled_along_the_rows_top_and_bottom_curl_to_the_front() -> None:
    chart = StitchChart.parse("K").tile(16, 12)
    piece = _at_rest(chart, pull=Pull(Direction.COURSE, 0.2))
    assert piece.curl_wale_mm > 0.5 * piece.thickness_mm


def test_a_shaped_piece_is_the_rectangle_without_what_lies_outside() -> None:
    """Nothing changes if every stitch is there; without a corner the rest keeps its size."""
    chart = StitchChart.of_fabric(Fabric.GARTER, rows=10, columns=10)
    every = curl(chart, ACRYLIC, stitches=np.ones((10, 10), dtype=bool))
    np.testing.assert_allclose(every.corners_mm, curl(chart, ACRYLIC).corners_mm, atol=1e-9)
    inside = np.tri(10, dtype=bool)[:, ::-1]
    piece = _at_rest(chart, stitches=inside)
    assert np.isnan(piece.curl_course_mm)
    assert np.count_nonzero(piece.used) == 55 + 21
    steps = np.linalg.norm(np.diff(piece.corners_mm[:, -1], axis=0), axis=1)
    whole = np.linalg.norm(np.diff(every.corners_mm[:, -1], axis=0), axis=1)
    np.testing.assert_allclose(steps, whole, rtol=2e-3)


def test_after_a_change_a_descent_that_begins_at_the_old_shape_is_near_rest_at_once() -> None:
    chart = StitchChart.parse("KKKPPP").tile(12, 3)
    old, changed = curl(chart, ACRYLIC), flipped(chart, 5, slice(8, 10))
    rest = curl(changed, ACRYLIC)
    begun = curl(changed, ACRYLIC, begin=old.corners_mm)
    assert begun.converged
    assert begun.energy_n_mm == pytest.approx(rest.energy_n_mm, rel=0.02)
    soon = [curl(changed, ACRYLIC, begin=b, time_limit_s=1e-9) for b in (None, old.corners_mm)]
    assert not any(piece.converged for piece in soon)
    far = [piece.energy_n_mm - rest.energy_n_mm for piece in soon]
    assert 0.0 < far[1] < 0.3 * far[0]


def test_the_first_shape_after_a_change_moves_only_what_is_near_it() -> None:
    chart = StitchChart.parse("KKKPPP").tile(40, 5)
    old = curl(chart, ACRYLIC)
    changed = flipped(chart, 5, slice(8, 10))
    soon = curl(changed, ACRYLIC, begin=old.corners_mm, time_limit_s=1e-9)
    rise = np.linalg.norm(np.diff(soon.corners_mm - old.corners_mm, axis=0), axis=-1)
    assert rise[:12].max() > 0.01
    assert rise[30:].max() < 0.03 * rise.max()  # the whole is aligned anew


@pytest.mark.parametrize("outline", OUTLINES.values(), ids=OUTLINES)
def test_every_outline_comes_to_rest(outline: str) -> None:
    stitches = outline_marks(outline).repeat(2, axis=0).repeat(2, axis=1)
    piece = _at_rest(StitchChart.parse("K").tile(*stitches.shape), stitches=stitches)
    assert piece.depth_mm > piece.thickness_mm


def test_parts_that_nothing_holds_together_are_refused_by_name() -> None:
    stitches = outline_marks("xxxx.x\nxxxx.x\nxxxx..")
    with refuses("outline", "2 parts") as refused:
        curl(StitchChart.parse("K").tile(3, 6), ACRYLIC, stitches=stitches)
    assert "stitch 6 of row 2" in refused.value.problem
    assert "Join them" in refused.value.remedy


def test_a_hole_is_a_hole_in_the_file() -> None:
    stitches = np.ones((10, 12), dtype=bool)
    stitches[3:7, 4:8] = False
    piece = curl(
        StitchChart.of_fabric(Fabric.SEED, rows=10, columns=12), ACRYLIC, stitches=stitches
    )
    solid = write_curled_glb(piece.chart, piece.corners_mm, ACRYLIC, piece.stitches)
    mesh = trimesh.load_mesh(io.BytesIO(solid), file_type="glb")
    middle = 500.0 * (mesh.bounds[0] + mesh.bounds[1])
    size = ACRYLIC.record(Fabric.SEED).stitch_mm
    within = np.abs(1000.0 * mesh.vertices[:, :2] - middle[:2]) < np.array(size)
    assert not within.all(axis=1).any()


SIDE = 48


def _zigzag(at: Ints, period: int) -> Ints:
    """Distance from the nearest multiple of a period."""
    return np.abs((at + period // 2) % period - period // 2)


PURL: dict[str, Callable[[Ints, Ints], NDArray[np.generic]]] = {
    "miura": lambda r, c: (c + _zigzag(r // 2, 12)) // 6 % 2,
    "chains": lambda r, c: (r % 6 < 2) | (c // 4 % 2 == 0),
    "columns": lambda r, c: np.where(
        _zigzag(c, 24) > 4 + _zigzag(r, 24) // 2, r // 6 % 2, c // 6 % 2
    ),
    "peaks": lambda r, c: np.where(_zigzag(c, 48) > _zigzag(r, 48), r // 4 % 2, c // 4 % 2),
    "squiggles": lambda r, c: ((c + 2 * (r // 5 % 2)) // 12 + r // 5) % 2,
    "bars": lambda r, c: _zigzag(c, 16) < 8 - r % 9,
    "weave": lambda r, c: np.where(r % 12 < 2, 0, (c // 12 + r // 12) % 2),
}
"""Where a stitch of a row and column is a purl in charts that fold themselves, of the seven kinds
that Niu, Dion and Kamien knitted (arXiv 2408.08409), each by a rule of its own."""


def _turns(corners_mm: Array) -> Array:
    """Turn between neighbours along the rows, (rows, columns - 1), rad, positive over a ridge."""
    diagonals = corners_mm[1:, 1:] - corners_mm[:-1, :-1], corners_mm[1:, :-1] - corners_mm[:-1, 1:]
    normal = np.cross(*diagonals)
    normal /= np.linalg.norm(normal, axis=2)[..., None]
    line = corners_mm[1:, 1:-1] - corners_mm[:-1, 1:-1]
    line /= np.linalg.norm(line, axis=2)[..., None]
    across = np.cross(normal[:, :-1], normal[:, 1:])
    sine = np.einsum("ijm,ijm->ij", across, line)
    return np.asarray(np.arctan2(sine, np.einsum("ijm,ijm->ij", normal[:, :-1], normal[:, 1:])))


def _folds(piece: CurledPiece) -> tuple[float, list[float]]:
    """Share of the folding that goes as the natural curvature does, and the mean fold of a panel.

    Folds are in degrees: knits and purls along the rows, then along the columns.
    """
    mean_folds, right, total = [], 0.0, 0.0
    for purl, corners, sign in (
        (piece.chart.purl, piece.corners_mm, 1.0),
        (piece.chart.purl.T, piece.corners_mm.transpose(1, 0, 2), -1.0),
    ):
        turn = sign * _turns(corners)
        inside = purl[:, 1:] == purl[:, :-1]
        for kind in (False, True):
            alike = inside & (purl[:, 1:] == kind)
            begins = alike & ~np.pad(alike, ((0, 0), (1, 0)))[:, :-1]
            panels = max(np.count_nonzero(begins), 1)
            mean_folds.append(float(np.degrees(turn[alike].sum() / panels)))
            natural = -sign if kind else sign
            right += float(np.maximum(natural * turn[alike], 0.0).sum())
            total += float(np.abs(turn[alike]).sum())
    return right / total, mean_folds


@pytest.mark.slow
@pytest.mark.parametrize("kind", PURL)
def test_panels_fold_as_their_natural_curvature_says(kind: str) -> None:
    """Knits into ridges along the wales and valleys along the courses, purls the other way, so
    that the sheet bends over where knits meet purls; half of the folding would be chance."""
    purl = np.asarray(PURL[kind](*np.indices((SIDE, SIDE))), dtype=bool)
    piece = _at_rest(StitchChart(purl))
    assert piece.depth_mm > 4.0 * piece.thickness_mm
    share, (knits_across, purls_across, knits_up, purls_up) = _folds(piece)
    assert share > (0.8 if kind == "miura" else 0.7)
    across, up = knits_across - purls_across, purls_up - knits_up
    assert max(across, up) > 30.0
    assert min(across, up) > -10.0
