"""Even cloth: its numbers are those of the answer and of the yarn level."""

import numpy as np
import pytest

from knitcore import Fabric, InputError, RelaxedSize, StitchChart, material, predict
from knitcore.cloth.space.bending_constants import bends_of
from knitcore.cloth.space.even_cloth import EvenCloth, cloth_of, stitch_weights_n, stitched
from knitcore.cloth.space.stitch_sheet import sheet_of
from knitcore.yarn.library.store import stored_stitch

ACRYLIC = material("acrylic")
GARTER = StitchChart.parse("K/P")
NONE = np.zeros((0, 2), dtype=np.int64)


def _cloth(chart: str) -> EvenCloth:
    return cloth_of(StitchChart.parse(chart), ACRYLIC, linear_density_g_per_m=0.5)


def test_a_pure_fabric_has_the_size_and_bending_of_its_stitches() -> None:
    cloth, bend = _cloth("K/P"), bends_of(ACRYLIC)[Fabric.GARTER]
    record = ACRYLIC.record(Fabric.GARTER)
    assert cloth.stitch_mm == pytest.approx((record.stitch_course_mm, record.stitch_wale_mm))
    assert cloth.rigidity_n_mm == (bend.rigidity_course_n_mm, bend.rigidity_wale_n_mm)
    assert not cloth.curls


def test_packaged_repeats_are_bent_from_the_store(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("knitcore.cloth.space.bending_constants.relax", None)
    stored = stored_stitch(StitchChart.parse("PPK"), "acrylic")
    bent, cloth = stored.bending.shown, _cloth("PPK")
    assert cloth.rigidity_n_mm == (bent.course.rigidity_n_mm, bent.wale.rigidity_n_mm)
    assert cloth.curvature_per_mm == (bent.course.curvature_per_mm, bent.wale.curvature_per_mm)


def test_stretched_it_has_the_modulus_of_the_answer() -> None:
    """Free to narrow, C₁₁ − C₁₂² / C₂₂."""
    cloth, answer = _cloth("KP/PK"), predict(StitchChart.parse("KP/PK"), ACRYLIC)
    c11, c22, c12, _ = cloth.membrane_n_per_mm
    assert c11 - c12**2 / c22 == pytest.approx(answer.course.modulus_n_per_mm)
    assert c22 - c12**2 / c11 == pytest.approx(answer.wale.modulus_n_per_mm)


def test_knits_and_purls_curl_to_opposite_sides() -> None:
    knit, purl = _cloth("K"), _cloth("P")
    assert knit.curls
    assert knit.curvature_per_mm == tuple(-c for c in purl.curvature_per_mm)


def test_a_large_rectangle_stands_for_several_stitches() -> None:
    """The energy of an even shape is that of the stitches."""
    cloth, stitches = _cloth("K/P"), sheet_of(GARTER.tile(12, 24), ACRYLIC)
    width, height = cloth.stitch_mm
    coarse = cloth.sheet(12, 12, (2 * width, 2 * height))
    energy = []
    for sheet in (stitches, coarse):
        x = sheet.flat_mm * (1.05, 1.0, 1.0)
        energy.append(sheet.energy(x, NONE)[0])
    assert energy[1] == pytest.approx(energy[0], rel=0.02)  # the law's mean of C₁₂ and C₂₁


def test_weight_is_that_of_the_yarn_in_the_stitches() -> None:
    weights = stitch_weights_n(GARTER.tile(3, 4), ACRYLIC, 0.5)
    loop = ACRYLIC.record(Fabric.GARTER).loop_length_mm
    assert weights.sum() == pytest.approx(weights.size * loop * 0.5e-6 * 9.80665)
    sheet = sheet_of(GARTER.tile(3, 4), ACRYLIC)
    assert sheet.shared(weights.ravel()).sum() == pytest.approx(weights.sum())


def test_impossible_yarns_are_refused() -> None:
    with pytest.raises(InputError, match="not in range"):
        stitch_weights_n(GARTER, ACRYLIC, 0.0)


def test_cloth_of_a_large_repeat_bends_as_the_mean_of_its_quarters() -> None:
    halves = StitchChart.parse("\n".join(["K"] * 20 + ["P"] * 20))
    cloth = cloth_of(halves, ACRYLIC, linear_density_g_per_m=0.5)
    assert cloth.from_quarters
    plain = _cloth("K")
    # all but the quarters at the borders of the halves are stockinette, knits against purls
    assert cloth.rigidity_n_mm[0] == pytest.approx(plain.rigidity_n_mm[0], rel=0.1)
    assert cloth.curvature_per_mm == pytest.approx((0.0, 0.0), abs=1e-12)


def test_stitches_lie_evenly_on_the_rectangles_of_a_sheet() -> None:
    x, y = np.meshgrid(np.arange(0.0, 21.0, 2.0), np.arange(0.0, 13.0, 3.0))
    sheet = np.stack([x, y, x * 0.0], axis=-1)
    sheet[0, 0] = np.nan
    laid = stitched(sheet, (2.0, 3.0), (2.5, 1.5), GARTER)
    corners, stitches = laid.corners_mm, laid.stitches
    assert laid.chart == GARTER.tile(4, 8)
    assert stitches.shape == (8, 8)
    assert not stitches[0, 0]
    assert stitches[2:, 1:].all()
    assert np.allclose(np.diff(corners[4, :, 0]), 2.5)
    assert np.allclose(np.diff(corners[:, 4, 1]), 1.5)


def test_counted_cloth_has_the_size_stretch_and_weight_of_its_gauge() -> None:
    plain, chart = _cloth("KKPP"), StitchChart.parse("KKPP")
    size = RelaxedSize(1.1 * plain.stitch_mm[0], 1.1 * plain.stitch_mm[1])
    counted = cloth_of(chart, ACRYLIC, linear_density_g_per_m=0.5, size=size)
    answer = predict(chart, ACRYLIC, size)
    c11, c22, c12, _ = counted.membrane_n_per_mm
    assert counted.stitch_mm == pytest.approx((size.course_mm, size.wale_mm))
    assert c11 - c12**2 / c22 == pytest.approx(answer.course.modulus_n_per_mm)
    assert counted.weight_g_per_m2 == pytest.approx(plain.weight_g_per_m2 / 1.1)
