"""A law fitted to simulated tests gives back what made them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from knitcore import CancelledError, Direction
from knitcore.fit.measured_strip import LEVELS, MeasuredStrip
from knitcore.fit.pull_fit import Reduction
from knitcore.fit.strip_fit import fit_strips, fit_tests, flattening
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.measure.uniaxial_files import read_stretch_test
from tests.knitcore.measure.synthetic import LAW, csv_pair, h5_pair

SYMMETRIC = ConstitutiveLaw(0.15, 0.09, 0.042, 0.042, 1.25, 1.0, 0.015, 0.015, 0.02)
TRUTH = replace(SYMMETRIC, kappa_xx=0.1, kappa_yy=0.3, shear_stiffening=4.0)
CLAMPED = {Direction.COURSE: (60.0, 92.0), Direction.WALE: (120.0, 40.0)}
EVEN = {Direction.COURSE: (60.0, None), Direction.WALE: (120.0, None)}


def made_strip(
    direction: Direction, sizes: dict[Direction, tuple[float, float | None]], noise: float = 0.0
) -> MeasuredStrip:
    """A simulated test of TRUTH, every pull a little stiffer or softer."""
    strain = np.linspace(0.08, 0.995, LEVELS) * 0.7
    blank = np.zeros((3, LEVELS))
    strip = MeasuredStrip(direction, *sizes[direction], strain, blank, blank)
    stress, waist = strip.simulate(TRUTH)
    scale = 1 + noise * np.linspace(-1, 1, 3)[:, None]
    waists = np.repeat(waist[None], 3, axis=0)
    return replace(strip, stress_n_per_mm=scale * stress, waist=waists)


@pytest.mark.parametrize(
    "sizes", [EVEN, pytest.param(CLAMPED, marks=pytest.mark.slow)], ids=["even", "clamped"]
)
@pytest.mark.slow
def test_a_law_is_recovered_from_simulated_strips(
    sizes: dict[Direction, tuple[float, float | None]],
) -> None:
    strips = [made_strip(d, sizes) for d in Direction]
    fit = fit_strips(strips)
    assert fit.law.modulus_course == pytest.approx(TRUTH.modulus_course, rel=0.02)
    assert fit.law.modulus_wale == pytest.approx(TRUTH.modulus_wale, rel=0.02)
    assert fit.law.alpha_xx == pytest.approx(TRUTH.alpha_xx, rel=0.03)
    assert fit.law.kappa_yy == pytest.approx(TRUTH.kappa_yy, abs=0.05)
    for strip, stress in zip(strips, fit.stress, strict=True):
        assert stress == pytest.approx(strip.means[0], rel=0.01)


@pytest.mark.slow
def test_cloth_that_flattens_first_has_the_same_law() -> None:
    """A constant in the reading of the waist is found, and leaves Poisson's ratios alone."""
    strips = [made_strip(d, EVEN) for d in Direction]
    wavy = [replace(strip, waist=strip.waist + 0.02) for strip in strips]
    flat, uneven = fit_strips(strips), fit_strips(wavy)
    assert flat.flattening == pytest.approx((0, 0), abs=0.002)
    assert uneven.flattening == pytest.approx((0.02, 0.02), abs=0.01)
    assert uneven.law.poisson_yx == pytest.approx(flat.law.poisson_yx, rel=0.08)
    assert uneven.uncertainty.poisson_yx > flat.uncertainty.poisson_yx + 0.01


def test_a_wide_strip_narrows_more_at_its_edges_than_between_points_inside() -> None:
    strip = made_strip(Direction.WALE, CLAMPED)
    inside, edges = (
        replace(strip, across_mm=across).simulate(TRUTH, strip.strain[-1:])[1][0]
        for across in (80.0, 120.0)
    )
    assert edges == pytest.approx(strip.waist[0, -1], abs=1e-6)
    assert edges < 1.8 * inside < 0


def test_the_constant_of_a_waist_is_drawn_towards_none() -> None:
    simulated = -0.3 * np.linspace(0, 0.5, LEVELS)
    assert 0.018 < flattening(simulated, simulated + 0.02) < 0.02
    few = np.where(np.arange(LEVELS) < 1, 0.02, np.nan) + simulated
    assert flattening(simulated, few) == pytest.approx(0.01)


@pytest.mark.slow
def test_pulls_that_differ_make_the_law_less_sure() -> None:
    same, apart = (
        fit_strips([made_strip(d, EVEN, noise=noise) for d in Direction]).uncertainty
        for noise in (0.0, 0.2)
    )
    assert apart.log_modulus_course > same.log_modulus_course + 0.03


@pytest.mark.slow
def test_a_test_without_the_clamps_distance_strains_evenly(tmp_path: Path) -> None:
    files = csv_pair(tmp_path)
    fit = fit_tests(files[0], files[1])
    assert fit.reduction is Reduction.RECOMMENDED
    assert fit.law.modulus_course == pytest.approx(LAW.modulus_course, rel=0.03)
    assert any("length_mm" in note for note in fit.notes)


def test_a_sparse_test_is_read_to_its_last_point(tmp_path: Path) -> None:
    """The levels of a fit are nearer to each other than 25 points are."""
    strain = np.linspace(0.0, 0.6, 25)
    rows = [f"{e},{-0.3 * e},{10 * e},50,70" for e in strain]
    (tmp_path / "wale.csv").write_text(
        "\n".join(["strain_along,strain_across,force_n,width_mm,length_mm", *rows])
    )
    strip = MeasuredStrip.of(read_stretch_test(tmp_path / "wale.csv"), Direction.WALE)
    stress, waist = strip.means
    assert strip.strain[-1] == pytest.approx(0.597)
    assert stress == pytest.approx(10 * strip.strain / 50)
    assert waist == pytest.approx(-0.3 * strip.strain)


def test_four_tracked_points_are_enough(tmp_path: Path) -> None:
    """Right and left are found by their place, whatever their order."""
    import h5py

    files = h5_pair(tmp_path)
    for path in files:
        with h5py.File(path, "r+") as file:
            for video in [name for name in file if name.startswith("video")]:
                points = file[f"{video}/traj"][()]
                del file[f"{video}/traj"]
                file[f"{video}/traj"] = points[[2, 0, 3, 1]]
    test = read_stretch_test(files[0])
    assert any("Four points" in note for note in test.notes)
    assert test.length_mm == pytest.approx(0.9 * 90, rel=0.01)
    assert fit_tests(files[0], files[1], reduction=Reduction.UNIFORM).law.alpha_xx == (
        pytest.approx(LAW.alpha_xx, rel=0.02)
    )


def test_a_corrected_width_scales_the_stress(tmp_path: Path) -> None:
    files = csv_pair(tmp_path)
    as_read, wider = (
        fit_tests(*files, reduction=Reduction.UNIFORM, width_course_mm=width)
        for width in (None, 140.0)
    )
    assert wider.law.stiffness_xxxx == pytest.approx(as_read.law.stiffness_xxxx / 2, rel=1e-6)
    assert wider.law.stiffness_yyyy == pytest.approx(as_read.law.stiffness_yyyy, rel=1e-6)


def test_a_fit_can_be_stopped() -> None:
    with pytest.raises(CancelledError):
        fit_strips([made_strip(d, EVEN) for d in Direction], cancelled=lambda: True)
