"""Repeats relaxed in the round."""

from dataclasses import replace

import numpy as np
import pytest

from knitcore import CancelledError, ConvergenceError, Fabric, InputError
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.study import yarn_tube as tube
from knitcore.yarn.study.bending import bending_response
from knitcore.yarn.study.relax import RelaxedRepeat
from knitcore.yarn.study.yarn_tube import in_the_round
from tests.knitcore.yarn.relaxed import relaxed


@pytest.fixture(scope="module")
def stockinette() -> RelaxedRepeat:
    return relaxed("K", sample("cotton", Fabric.STOCKINETTE))


@pytest.mark.parametrize("face_outside", [True, False])
def test_a_wide_tube_follows_the_linear_response(
    stockinette: RelaxedRepeat, face_outside: bool
) -> None:
    wide = in_the_round(stockinette, 2000, face_outside=face_outside)
    curvature = (1.0 if face_outside else -1.0) * 2.0 / wide.diameter_mm
    response = bending_response(stockinette).course
    higher = wide.cell_wale_mm / wide.flat_wale_mm - 1.0
    assert higher / curvature == pytest.approx(response.strain_across_mm, rel=5e-3)
    area = wide.flat_course_mm * wide.flat_wale_mm
    moment = (wide.energy_n_mm - wide.flat_energy_n_mm) / area / curvature
    assert moment == pytest.approx(response.moment_n, rel=5e-3)


REPEATS = "KP", "PK"


def test_stockinette_curls_the_way_of_its_tube(stockinette: RelaxedRepeat) -> None:
    outside, inside = (in_the_round(stockinette, 60, face_outside=side) for side in (True, False))
    assert outside.energy_n_mm < outside.flat_energy_n_mm < inside.energy_n_mm
    assert outside.cell_wale_mm > outside.flat_wale_mm > inside.cell_wale_mm
    assert outside.diameter_mm == pytest.approx(60 * outside.cell_course_mm / np.pi)


@pytest.mark.parametrize(
    "wales",
    [80, pytest.param(24, marks=pytest.mark.slow)],  # in a tube of 24 a step fails and is halved
)
@pytest.mark.slow
def test_a_shifted_repeat_makes_the_same_tube(wales: int) -> None:
    repeats = (relaxed(text, sample("cotton", Fabric.RIB), branch="mirrored") for text in REPEATS)
    tubes = [in_the_round(repeat, wales) for repeat in repeats]
    sizes = [(tube.cell_course_mm, tube.cell_wale_mm, tube.energy_n_mm) for tube in tubes]
    np.testing.assert_allclose(*sizes, rtol=1e-5)


def test_a_tube_without_an_equilibrium_says_where_its_shape_gives_way(
    stockinette: RelaxedRepeat, monkeypatch: pytest.MonkeyPatch
) -> None:
    turned = tube._turned
    monkeypatch.setattr(
        tube,
        "_turned",
        lambda begin, turn, *rest: None if turn > 0.1 else turned(begin, turn, *rest),
    )
    with pytest.raises(ConvergenceError, match="of fewer than 64 wales"):
        in_the_round(stockinette, 32)


def test_wrong_tubes_are_refused(stockinette: RelaxedRepeat) -> None:
    with pytest.raises(InputError, match="wales"):
        in_the_round(stockinette, 2)
    rib = relaxed("KP", sample("acrylic", Fabric.RIB), branch="mirrored")
    with pytest.raises(InputError, match="not a multiple"):
        in_the_round(rib, 25)
    with pytest.raises(InputError, match="held flat"):
        in_the_round(replace(stockinette, flat=True), 24)


def test_a_tube_can_be_cancelled(stockinette: RelaxedRepeat) -> None:
    with pytest.raises(CancelledError):
        in_the_round(stockinette, 60, cancelled=lambda: True)
