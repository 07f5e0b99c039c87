"""Laws of the quarter cells of a piece."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter, minimum_filter

from knitcore import StitchChart, material, predict, strip_test
from knitcore.chart.fabric import PHASES, Direction, Fabric
from knitcore.chart.phases import quarter_phases
from knitcore.cloth.flat import chart_sheet
from knitcore.prediction.quarter_laws import quarter_laws


def test_patches_of_a_repeat_go_on_through_the_piece() -> None:
    """Garter beside rib repeats every two rows; every row has the laws and sizes of both halves."""
    garter, rib = (StitchChart.of_fabric(f, rows=10, columns=40) for f in ("garter", "rib"))
    piece = StitchChart([[*g, *r] for g, r in zip(garter.purl, rib.purl, strict=True)])
    acrylic = material("acrylic")
    quarters = quarter_laws(piece, acrylic)
    assert (quarters.place == quarters.place[0]).all()
    np.testing.assert_allclose(
        quarters.scale, np.broadcast_to(quarters.scale[0], quarters.scale.shape), rtol=0.01
    )
    for column, fabric in ((24, "garter"), (56, "rib")):
        own, code = acrylic.law(fabric), PHASES.index(Fabric(fabric))
        shares = quarters.mixing[[4 * int(quarters.place[0, column]) + code]].toarray()[0]
        law = quarters.laws[int(shares.argmax())]
        for direction in Direction:
            # the windows of both halves reach across the border
            assert law.modulus(direction) == pytest.approx(own.modulus(direction), rel=0.15)
    assert np.isfinite(quarters.scale).all()


def wide_stitches(piece: StitchChart) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Where a stitch and the next up, or to the right, lie in one phase, as do two around them."""
    cells = quarter_phases(piece)
    low, high = (filtered(cells, 11) for filtered in (minimum_filter, maximum_filter))
    wide = (low == high)[::2, ::2] & (low == high)[1::2, 1::2]
    return wide[1:] & wide[:-1], wide[:, 1:] & wide[:, :-1]


def in_one(
    cloth: str, background: str, rows: slice, columns: slice, shape: tuple[int, int]
) -> StitchChart:
    purl = StitchChart.parse(background).resized(*shape).purl.copy()
    purl[rows, columns] = StitchChart.parse(cloth).resized(*purl[rows, columns].shape).purl
    return StitchChart(purl)


ALL = slice(None)
PIECES = {
    "hem": in_one("KKPP", "K", slice(0, 10), ALL, (60, 40)),
    "block": in_one("KP/PK", "K", slice(12, 36), slice(12, 36), (48, 48)),
    "panels": in_one("KP", "K/P", ALL, slice(20, 41), (40, 61)),
    "a repeat that begins within a panel": in_one("KP", "K", ALL, slice(2, 14), (20, 24)).tile(
        1, 3
    ),
    "thin end": in_one("KP", "K", slice(0, 2), ALL, (100, 40)),
}


@pytest.mark.parametrize("name", PIECES)
@pytest.mark.parametrize("yarn", ["acrylic", "cotton"])
def test_laws_of_one_texture_have_no_steps(name: str, yarn: str) -> None:
    """Where the chart goes on alike, constants change by 12 % from stitch to stitch at most."""
    piece = PIECES[name]
    sheet = chart_sheet(piece, material(yarn))
    codes = sheet.grid.law_of_cell[::2, ::2]
    for constant in ("stiffness_xxxx", "stiffness_yyyy", "alpha_xx", "alpha_yy"):
        logs = np.log(sheet.parameters[constant])[codes]
        for axis, wide in enumerate(wide_stitches(piece)):
            assert np.abs(np.diff(logs, axis=axis))[wide].max() < 0.12


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("repeat", ["KKKP", "KPKK/KKKP", "KPPK/KKKK", "KKKP/PPKK"])
def test_phases_side_by_side_carry_together_what_their_patch_does(
    repeat: str, direction: Direction
) -> None:
    """A strip with sliding ends is as stiff as one with the patch's law in all quarters."""
    chart, acrylic = StitchChart.parse(repeat).resized(8, 8), material("acrylic")
    strains = predict(chart, acrylic).along(direction).strain([0.01, 0.03, 0.1]).tolist()
    own, even = (
        strip_test(
            chart, acrylic, direction, strains, clamps="sliding",
            laws=quarter_laws(chart, acrylic, even=even),
        ).stress_n_per_mm
        for even in (False, True)
    )  # fmt: skip
    np.testing.assert_allclose(own, even, rtol=0.08)


def test_stitches_fold_by_their_surroundings_and_on_average_like_the_answer() -> None:
    hem, body = (StitchChart.parse(text) for text in ("KKPP", "KP/PK"))
    piece = StitchChart(np.vstack([hem.resized(20, 40).purl, body.resized(40, 40).purl]))
    acrylic = material("acrylic")
    scale = quarter_laws(piece, acrylic).scale
    assert scale[2, :, 0].max() < 0.9 * scale[50, :, 0].min()
    assert np.abs(np.diff(np.log(scale[..., 0]), axis=0)).max() < 0.1
    sheet = chart_sheet(piece, acrylic)
    assert sheet.grid.width_mm == pytest.approx(
        40 * predict(piece, acrylic).relaxed_course_mm, rel=0.02
    )
