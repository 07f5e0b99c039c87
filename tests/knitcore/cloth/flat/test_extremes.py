"""Sizes and stiffnesses beyond what numbers can hold end in words, not in a traceback."""

from __future__ import annotations

import pytest

from knitcore import StitchChart
from knitcore.cloth.flat import strip_test
from knitcore.materials import material


def test_a_checkerboard_is_stretched_up_to_its_lock_up() -> None:
    """Corners between clamp and free edge narrow most, and must not fold over."""
    test = strip_test(
        StitchChart.parse("KP\nPK").resized(16, 16), material("acrylic"), "course", 0.75
    )
    assert test.converged, test.problem


@pytest.mark.parametrize("extreme", [{"shear_modulus": 1e300}, {"width_mm": 1e-9}])
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_sheet_that_numbers_cannot_hold_gives_no_result(extreme: dict[str, float]) -> None:
    chart = StitchChart.parse("KKPP\nKKPP\nPPKK\nPPKK")
    test = strip_test(chart, material("acrylic:published"), "wale", 0.1, steps=2, **extreme)
    assert not test.converged
    assert test.problem
    assert test.steps == len(test.strain) == 0
