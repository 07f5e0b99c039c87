"""Bending and shear by linear response of the relaxed cell."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from knitcore.base.errors import InputError
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.solve.splines import refined
from knitcore.yarn.study.bending import FabricBending, bending_response, repeat_bending
from knitcore.yarn.study.bent_cell import GRID, BentCell, Deformation, settled
from knitcore.yarn.study.lowest import without_mirrors
from knitcore.yarn.study.relax import RelaxedRepeat
from tests.knitcore.yarn.relaxed import relaxed

REPEATS = {"stockinette": "K", "garter": "P\nK", "rib": "KP", "seed": "PK\nKP"}


@cache
def _relaxed(repeat: str, fabric: str = "stockinette") -> RelaxedRepeat:
    """A repeat of the paper's acrylic sample of a fabric."""
    return relaxed(repeat, sample("acrylic", fabric), branch="mirrored")


@cache
def _bending(repeat: str, fabric: str = "stockinette") -> FabricBending:
    return bending_response(_relaxed(repeat, fabric))


@cache
def _cell() -> BentCell:
    return settled(_relaxed("K"))


# Moments (N) and rigidities (N·mm) of an independent implementation, acrylic samples
EXPECTED = {
    "stockinette": (-0.0246, 0.0228, 0.033, 0.048),
    "garter": (0.0, 0.0, 0.0055, 0.0034),
    "rib": (0.0, 0.0, 0.177, 0.112),
    "seed": (0.0, 0.0, 0.030, 0.013),
}


@pytest.mark.parametrize("fabric", EXPECTED)
def test_moments_and_rigidities_of_the_four_fabrics(fabric: str) -> None:
    bending = _bending(REPEATS[fabric], fabric)
    moment_x, moment_y, rigidity_x, rigidity_y = EXPECTED[fabric]
    assert bending.course.moment_n == pytest.approx(moment_x, rel=0.01, abs=1e-6)
    assert bending.wale.moment_n == pytest.approx(moment_y, rel=0.01, abs=1e-6)
    assert bending.course.rigidity_n_mm == pytest.approx(rigidity_x, rel=0.03)
    assert bending.wale.rigidity_n_mm == pytest.approx(rigidity_y, rel=0.03)


def test_held_rigidities_are_those_of_long_waves_of_the_flat_sheet() -> None:
    """Waves of the flat fabric, extrapolated to infinite length: 0.0508 and 0.0483 N·mm."""
    bending = _bending("K")
    assert bending.course.held_n_mm == pytest.approx(0.0508, rel=0.02)
    assert bending.wale.held_n_mm == pytest.approx(0.0483, rel=0.02)


def test_a_purl_curls_as_a_knit_seen_from_the_back() -> None:
    knit, purl = _bending("K"), _bending("P")
    assert purl.course.moment_n == pytest.approx(-knit.course.moment_n, rel=1e-4)
    assert purl.wale.moment_n == pytest.approx(-knit.wale.moment_n, rel=1e-4)
    assert purl.course.rigidity_n_mm == pytest.approx(knit.course.rigidity_n_mm, rel=1e-3)
    assert purl.shear_modulus_n_per_mm == pytest.approx(knit.shear_modulus_n_per_mm, rel=1e-3)


@pytest.mark.parametrize(
    "deformation",
    [
        Deformation(),
        Deformation(course_per_mm=0.07),
        Deformation(wale_per_mm=-0.05),
        Deformation(twist_per_mm=0.06),
        Deformation(0.04, -0.08, 0.05, skew=0.2),
        replace(Deformation.cylinder(0.6, 0.1), skew=0.2),
    ],
    ids=["flat", "along rows", "along columns", "twisted", "saddle", "oblique and skewed"],
)
def test_gradient_of_the_bent_cell_is_the_derivative_of_its_energy(
    deformation: Deformation,
) -> None:
    cell = _cell()
    gradient = cell.lagrangian(deformation).gradient
    direction = np.random.default_rng(1).standard_normal(len(cell.state))
    direction[-2:] *= 3.0
    at, h = cell.state.copy(), 1e-6
    values = []
    for sign in (1.0, -1.0):
        moved = BentCell(cell.energy, at + sign * h * direction, cell.tension)
        values.append(moved.lagrangian(deformation).value)
    slope = (values[0] - values[1]) / (2 * h)
    assert slope == pytest.approx(gradient @ direction, rel=1e-5, abs=1e-4)


def test_the_cell_that_is_bent_by_nothing_is_the_flat_cell() -> None:
    cell = _cell()
    pairs, _ = cell.energy.pairs(cell.curve, cell.state, 2.0 * cell.energy.yarn.radius_mm)
    terms = cell.energy.value(cell.state, cell.curve, pairs)
    expected = cell.energy.merit(terms, cell.tension)
    assert cell.lagrangian(Deformation()).value == pytest.approx(expected, rel=1e-12)


def test_linear_response_is_the_second_derivative_of_the_relaxed_energy() -> None:
    """A Newton step in a skewed cell: E(γ) - E(0) = G A γ² / 2."""
    cell, skew = _cell(), 2e-5
    first = cell.lagrangian(Deformation(skew=skew))
    off = np.zeros(len(cell.rows))
    off[: len(first.excess_mm)] = first.excess_mm
    step, _ = cell.solve(first.gradient, off, None)
    relaxed = BentCell(cell.energy, cell.state + step, cell.tension)
    rise = relaxed.lagrangian(Deformation(skew=skew)).value
    rise -= cell.lagrangian(Deformation()).value
    shear = _bending("K").shear_modulus_n_per_mm
    assert rise == pytest.approx(0.5 * shear * cell.area_mm2 * skew**2, rel=0.01)


@pytest.mark.parametrize("fabric", ["rib", "seed"])
@pytest.mark.slow
def test_coupling_and_twist_are_those_that_bending_along_the_diagonals_has(fabric: str) -> None:
    """D(45°) = (D_x + D_y) / 4 + (D₁ + 2 D₆₆) / 2, the mean over both diagonals."""
    bending = bending_response(without_mirrors(_relaxed(REPEATS[fabric], fabric)).state)
    diagonal = np.mean([response.rigidity_n_mm for response in bending.oblique])
    straight = bending.course.rigidity_n_mm + bending.wale.rigidity_n_mm
    both = bending.coupling_n_mm + 2.0 * bending.twist_n_mm
    assert diagonal == pytest.approx(0.25 * straight + 0.5 * both, rel=1e-3)


def test_a_state_that_is_not_a_minimum_without_mirrors_is_marked() -> None:
    seed = _bending(REPEATS["seed"], "seed")
    assert not seed.minimum
    assert seed.shear_modulus_n_per_mm is None
    assert seed.twist_n_mm is None
    assert seed.coupling_n_mm is None
    assert _bending("K").minimum


@pytest.mark.slow
def test_the_state_that_an_instability_leads_to_is_bent_too() -> None:
    bending = repeat_bending(_relaxed("KP", "rib"))
    assert not bending.mirrored.minimum  # it is one in its repeat, but not in two of them
    assert bending.mirrored.shear_modulus_n_per_mm is None
    assert bending.stable is bending.unmirrored
    assert bending.unmirrored.minimum
    assert bending.ratios == pytest.approx((0.82, 0.45), abs=0.01)


def test_a_finer_grid_finds_the_same_shape() -> None:
    coarse = _relaxed("KKP")
    fine = refined(coarse, GRID)
    assert fine.cell.grid == GRID
    assert fine.branch is coarse.branch
    assert fine.energy_n_mm == pytest.approx(coarse.energy_n_mm, rel=1e-3)
    assert fine.cell_course_mm == pytest.approx(coarse.cell_course_mm, rel=5e-3)


def test_a_minimum_has_no_other_state() -> None:
    bending = repeat_bending(_relaxed("K"))
    assert bending.unmirrored is None
    assert bending.ratios is None
    assert bending.stable is bending.shown is bending.mirrored
    assert bending.mirrored == _bending("K")


def test_a_repeat_that_is_held_flat_is_refused() -> None:
    held = relaxed("K", sample("acrylic", "stockinette"), flat=True, branch="mirrored")
    with pytest.raises(InputError, match="flat"):
        bending_response(held)


def test_stockinette_curls_as_in_real_fabric() -> None:
    bending = _bending("K")
    assert bending.curl == "the sides roll to the back, top and bottom roll to the front"
    assert _bending(REPEATS["garter"], "garter").curl == "lies flat"
