"""Repeats relaxed in the round."""

from dataclasses import replace

import numpy as np
import pytest

from knitcore.chart import StitchChart
from knitcore.errors import CancelledError, InputError
from knitcore.fabric import Fabric
from knitcore.yarnlevel.bending import bending_response
from knitcore.yarnlevel.relax import RelaxedRepeat, relax
from knitcore.yarnlevel.samples import sample
from knitcore.yarnlevel.tube import in_the_round


@pytest.fixture(scope="module")
def stockinette() -> RelaxedRepeat:
    entry = sample("cotton", Fabric.STOCKINETTE)
    return relax(StitchChart.parse("K"), entry.yarn, entry.loop_length_mm)


@pytest.mark.parametrize("face_outside", [True, False])
def test_a_wide_tube_follows_the_linear_response(
    stockinette: RelaxedRepeat, face_outside: bool
) -> None:
    tube = in_the_round(stockinette, 2000, face_outside=face_outside)
    curvature = (1.0 if face_outside else -1.0) * 2.0 / tube.diameter_mm
    response = bending_response(stockinette).course
    higher = tube.cell_wale_mm / tube.flat_wale_mm - 1.0
    assert higher / curvature == pytest.approx(response.strain_across_mm, rel=5e-3)
    area = tube.flat_course_mm * tube.flat_wale_mm
    moment = (tube.energy_n_mm - tube.flat_energy_n_mm) / area / curvature
    assert moment == pytest.approx(response.moment_n, rel=5e-3)


def test_stockinette_curls_the_way_of_its_tube(stockinette: RelaxedRepeat) -> None:
    outside, inside = (in_the_round(stockinette, 60, face_outside=side) for side in (True, False))
    assert outside.energy_n_mm < outside.flat_energy_n_mm < inside.energy_n_mm
    assert outside.cell_wale_mm > outside.flat_wale_mm > inside.cell_wale_mm
    assert outside.diameter_mm == pytest.approx(60 * outside.cell_course_mm / np.pi)


def test_wrong_tubes_are_refused(stockinette: RelaxedRepeat) -> None:
    with pytest.raises(InputError, match="wales"):
        in_the_round(stockinette, 2)
    entry = sample("acrylic", Fabric.RIB)
    rib = relax(StitchChart.parse("KP"), entry.yarn, entry.loop_length_mm, branch="mirrored")
    with pytest.raises(InputError, match="not a multiple"):
        in_the_round(rib, 25)
    with pytest.raises(InputError, match="held flat"):
        in_the_round(replace(stockinette, flat=True), 24)


def test_a_tube_can_be_cancelled(stockinette: RelaxedRepeat) -> None:
    with pytest.raises(CancelledError):
        in_the_round(stockinette, 60, cancelled=lambda: True)
