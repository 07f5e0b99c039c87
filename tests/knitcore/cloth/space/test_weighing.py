"""Tests by weight: the heavy elastica, theory of plates, Cusick's cloth, borders on a table."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from knitcore import InputError, StitchChart, material
from knitcore.cloth.space.even_cloth import EvenCloth, cloth_of
from knitcore.cloth.space.weighing import (
    DISC_MM,
    PIECE_MM,
    RULE_STITCHES,
    advice,
    drape,
    on_table,
    overhang,
)
from knitcore.measure.heavy_elastica import heavy_elastica

WEIGHT, LENGTH = 3e-6, 12.0
CLOTH = EvenCloth(
    stitch_mm=(3.0, 2.0),
    membrane_n_per_mm=(0.3, 0.2, 0.05, 0.03),
    rigidity_n_mm=(WEIGHT * LENGTH**3, 8.0 * WEIGHT * LENGTH**3),
    twist_n_mm=0.004,
    curvature_per_mm=(0.0, 0.0),
    thickness_mm=2.0,
    weight_n_per_mm2=WEIGHT,
)


@pytest.mark.parametrize("times", [1.0, 2.0, 4.0])
def test_a_strip_hangs_as_the_heavy_elastica(times: float) -> None:
    strip = overhang(CLOTH, 0, times * LENGTH)
    _, reach, fall = heavy_elastica(times**3)
    assert strip.converged
    assert strip.reach_mm == pytest.approx(times * LENGTH * reach[-1], abs=0.005 * times * LENGTH)
    assert strip.fall_mm == pytest.approx(times * LENGTH * fall[-1], abs=0.005 * times * LENGTH)


def test_two_bending_lengths_fall_by_the_angle_of_the_test() -> None:
    strip = overhang(CLOTH, 0)
    assert strip.overhang_mm == pytest.approx(2 * LENGTH)
    assert np.degrees(strip.angle_rad) == pytest.approx(41.5, abs=0.2)
    rolled = replace(CLOTH, curvature_per_mm=(0.7, -0.4))  # the curl is left out
    assert overhang(rolled, 0).angle_rad == pytest.approx(strip.angle_rad, rel=1e-6)


def test_the_rigidity_that_is_read_is_the_one_that_went_in() -> None:
    """Within the error of Peirce's formula, 2 % of the length."""
    strip = overhang(CLOTH, 1)
    assert strip.rigidity_n_mm == pytest.approx(CLOTH.rigidity_n_mm[1], rel=0.07)


@pytest.mark.parametrize(("length", "problem"), [(1e-9, "do not bend"), (61.0, "straight down")])
def test_a_strip_that_does_not_bend_or_hangs_straight_down_is_refused(
    length: float, problem: str
) -> None:
    with pytest.raises(InputError, match=problem):
        overhang(CLOTH, 0, length)


def _isotropic(bending_length_mm: float) -> EvenCloth:
    """A plate without contraction across: D₆₆ is half of D, G half of C. Its stiffness in
    the plane is so low that rectangles of 7.5 mm do not lock, and still stretches by 1 % only."""
    weight = 2e-6
    rigidity = weight * bending_length_mm**3
    return replace(
        CLOTH,
        weight_n_per_mm2=weight,
        membrane_n_per_mm=(0.02, 0.02, 0.0, 0.01),
        rigidity_n_mm=(rigidity, rigidity),
        twist_n_mm=0.5 * rigidity,
        thickness_mm=1.0,
    )


def _ring_fall(cloth: EvenCloth) -> float:
    """Fall of the rim of a ring clamped inside, small deflection (Timoshenko, Woinowsky-Krieger,
    "Theory of plates and shells", chapter 3): w = q r⁴ / 64 D + A + B ln r + C r² + E r² ln r."""
    inner, outer = 0.5 * DISC_MM, 0.5 * PIECE_MM
    load = cloth.weight_n_per_mm2 / cloth.rigidity_n_mm[0]
    deflection = np.array([1.0, np.log(inner), inner**2, inner**2 * np.log(inner)])
    slope = np.array([0.0, 1 / inner, 2 * inner, inner * (2 * np.log(inner) + 1)])
    bending = np.array([0.0, -1 / outer**2, 2.0, 2 * np.log(outer) + 3])
    shear = np.array([0.0, 0.0, 0.0, 4 / outer])
    own = load * np.array([inner**4 / 64, inner**3 / 16, 3 * outer**2 / 16, outer / 2])
    a, b, c, e = np.linalg.solve([deflection, slope, bending, shear], -own)
    edge = load * outer**4 / 64 + a + b * np.log(outer) + c * outer**2
    return float(edge + e * outer**2 * np.log(outer))


def test_a_stiff_plate_falls_as_in_theory() -> None:
    cloth = _isotropic(150.0)
    plate = drape(cloth, across=30, starts=(0,))
    assert plate.converged
    assert -plate.corners_mm[15, -1, 2] == pytest.approx(_ring_fall(cloth), rel=0.1)
    assert plate.coefficient > 0.99


@pytest.mark.slow
def test_softer_cloth_drapes_more_and_has_more_folds() -> None:
    drapes = [drape(_isotropic(length), across=16, starts=(6,)) for length in (15.0, 30.0, 60.0)]
    assert all(draped.converged for draped in drapes)
    assert all(low.coefficient < high.coefficient for low, high in pairwise(drapes))
    assert drapes[0].folds >= 4
    assert drapes[-1].folds <= 2


@pytest.mark.slow
@pytest.mark.parametrize("bending_length_cm", [1.0, 2.0])
def test_isotropic_cloth_drapes_as_cusick_measured(bending_length_cm: float) -> None:
    """His regression over 130 fabrics, DC = 35.6 c − 3.61 c² − 2.59 A + 0.0461 A² + 17.0 per cent,
    with a shear angle A of 10°, within 7 of 100."""
    c, angle = bending_length_cm, 10.0
    expected = 35.6 * c - 3.61 * c**2 - 2.59 * angle + 0.0461 * angle**2 + 17.0
    draped = drape(_isotropic(10.0 * c), across=40, starts=(6,))
    assert draped.converged
    assert 100.0 * draped.coefficient == pytest.approx(expected, abs=7.0)


def test_outside_the_draped_piece_there_is_nothing() -> None:
    draped = drape(_isotropic(30.0), across=12, starts=(4,))
    assert np.isnan(draped.corners_mm[0, 0]).all()
    assert np.isfinite(draped.corners_mm[6]).all()


@pytest.mark.parametrize(("disc", "across"), [(300.0, 20), (180.0, 200)])
def test_impossible_drapes_are_refused(disc: float, across: int) -> None:
    with pytest.raises(InputError):
        drape(_isotropic(30.0), disc_mm=disc, across=across)


def _cloth(chart: str) -> EvenCloth:
    return cloth_of(StitchChart.parse(chart), material("acrylic"), linear_density_g_per_m=0.5)


PIECE, GARTER = _cloth("K"), _cloth("K/P")


def test_the_weight_of_the_border_balances_the_moment_of_the_piece() -> None:
    border = advice(PIECE, GARTER, 0, time_limit_s=0.0)
    assert 0.5 * GARTER.weight_n_per_mm2 * border.width_mm**2 == pytest.approx(PIECE.moment_n[0])
    assert (border.stitches - 1) * GARTER.stitch_mm[0] < border.width_mm
    ruled = max(RULE_STITCHES) * GARTER.stitch_mm[0]
    assert border.rule_share == pytest.approx((ruled / border.width_mm) ** 2)


@pytest.mark.slow
def test_a_board_holds_from_that_width_on() -> None:
    """A border that does not bend: just wide enough it stays on the table, narrower it tips."""
    board = replace(GARTER, rigidity_n_mm=(20.0, 20.0))
    width = advice(PIECE, board, 0, time_limit_s=0.0).width_mm
    edges = []
    for share in (0.8, 1.2):
        sheet, shape = on_table(PIECE, board, 0, share * width)
        line = shape.x.reshape(2, sheet.columns + 1, 3)[0]
        edges.append(line[[0, -1], 2].max())
    assert edges[0] > 3.0
    assert edges[1] < 0.1


@pytest.mark.slow
def test_a_border_that_bends_rises_in_a_ridge_and_rolls_up() -> None:
    border = advice(PIECE, GARTER, 0)
    assert not border.holds
    assert border.ridge_mm > 3.0 * PIECE.thickness_mm
    assert border.line_mm[0, 1] == pytest.approx(0.0, abs=0.1)  # its own edge stays on the table


def test_what_does_not_curl_needs_no_border() -> None:
    border = advice(GARTER, GARTER, 1)
    assert (border.stitches, border.width_mm, border.holds) == (0, 0.0, True)


def test_a_strip_on_a_table_rests_on_it_with_its_weight() -> None:
    sheet, shape = on_table(GARTER, GARTER, 0, 20.0)
    depth = -np.minimum(shape.x[:, 2], 0.0)
    width = np.ptp(sheet.flat_mm, axis=0)
    weight = GARTER.weight_n_per_mm2 * width[0] * width[1]
    assert sheet.touch_n_per_mm * depth.sum() == pytest.approx(weight, rel=0.01)
