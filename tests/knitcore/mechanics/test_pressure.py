"""Laplace pressure on a limb."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import Direction, Fabric, InputError, material
from knitcore.law.constitutive import ConstitutiveLaw, Transverse
from knitcore.law.uniaxial import uniaxial_response
from knitcore.mechanics.pressure import MMHG_PER_KPA, limb_pressure, rest_circumference

LINEAR = ConstitutiveLaw(0.2, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
"""Without coupling and stiffening: sigma = 0.2 N/mm times the strain."""
GLOVE = material("glove-wool:glove:published").law(Fabric.STOCKINETTE)


def test_a_circular_limb_of_known_radius() -> None:
    """Strain 0.25, tension 0.05 N/mm, radius 200 / 2 pi mm: P = T / R = 1.571 kPa."""
    tube = limb_pressure(LINEAR, Direction.COURSE, 160, 200)
    expected = 0.05 / (200 / (2 * math.pi)) * 1000
    assert tube.kpa.low == tube.kpa.high == pytest.approx(expected)
    assert tube.mmhg.low == pytest.approx(expected * 7.50062, rel=1e-5)


def test_the_interval_is_axially_free_to_axially_fixed() -> None:
    tube = limb_pressure(GLOVE, Direction.WALE, 150, 180)
    free = uniaxial_response(GLOVE, Direction.WALE, 0.2)
    fixed = uniaxial_response(GLOVE, Direction.WALE, 0.2, transverse=Transverse.FIXED)
    unit = 2 * math.pi / 180 * 1000
    assert tube.kpa.low == pytest.approx(unit * free.stress[0] / (1 + free.transverse_strain[0]))
    assert tube.kpa.high == pytest.approx(unit * fixed.stress[0])
    assert tube.kpa.low < tube.kpa.high


def test_force_over_area_would_be_far_too_small() -> None:
    """The paper takes 28 mmHg for sigma w / (C w); Laplace gives 2 pi times as much and more."""
    target_kpa, worn = 28 / MMHG_PER_KPA, 180.0
    stress = target_kpa / 1000 * worn
    strain = next(
        e / 1000
        for e in range(400)
        if uniaxial_response(GLOVE, Direction.WALE, e / 1000).stress[0] >= stress
    )
    tube = limb_pressure(GLOVE, Direction.WALE, worn / (1 + strain), worn)
    assert tube.mmhg.low > 110


@settings(max_examples=30)
@given(mmhg=st.floats(1, 120), worn=st.floats(60, 1200))
def test_sizing_inverts_the_pressure(mmhg: float, worn: float) -> None:
    for law in (GLOVE, LINEAR):
        sizes = rest_circumference(law, Direction.WALE, worn, mmhg)
        # The looser tube reaches the target if it is held, the tighter one if it is free.
        assert limb_pressure(law, Direction.WALE, sizes.high, worn).mmhg.high == pytest.approx(
            mmhg, rel=1e-5
        )
        assert limb_pressure(law, Direction.WALE, sizes.low, worn).mmhg.low == pytest.approx(
            mmhg, rel=1e-5
        )


@settings(max_examples=30)
@given(st.floats(100, 199))
def test_a_tighter_tube_presses_more(rest: float) -> None:
    looser, tighter = (limb_pressure(LINEAR, Direction.WALE, r, 200) for r in (rest + 1, rest))
    assert tighter.mmhg.low > looser.mmhg.low


def test_near_lock_up_and_beyond_the_tests_are_warned_of() -> None:
    lock_up = GLOVE.lock_up_strain(Direction.WALE)

    def warnings(share: float, tested: float | None = None) -> str:
        rest = 200 / (1 + share * lock_up)
        return " ".join(
            limb_pressure(GLOVE, Direction.WALE, rest, 200, tested_strain=tested).warnings
        )

    assert "lock-up" not in warnings(0.5)
    assert "extrapolated" not in warnings(0.5)
    assert "extrapolated" in warnings(0.75)
    assert "lock-up" in warnings(0.9)
    assert "the tests reached" in warnings(0.5, tested=0.1)


def test_no_medical_class_is_named() -> None:
    tube = limb_pressure(GLOVE, Direction.WALE, 150, 180)
    assert "class" not in " ".join(tube.warnings).lower()


@pytest.mark.parametrize(
    ("rest", "worn", "says"),
    [
        (200, 150, "loose"),
        (0, 150, "rest_mm"),
        (math.nan, 150, "rest_mm"),
        (100, math.inf, "worn_mm"),
        (100, 9000, "worn_mm"),
        (100, 190, "lock-up"),
    ],
)
def test_impossible_sizes_are_refused(rest: float, worn: float, says: str) -> None:
    with pytest.raises(InputError, match=says):
        limb_pressure(GLOVE, Direction.WALE, rest, worn)


@pytest.mark.parametrize("mmhg", [0.0, -5.0, math.nan, 1e4])
def test_impossible_targets_are_refused(mmhg: float) -> None:
    with pytest.raises(InputError, match="mmhg"):
        rest_circumference(GLOVE, Direction.WALE, 200, mmhg)
