"""Mirrored states without their mirrors."""

from dataclasses import replace

import pytest

from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Fabric
from knitcore.yarnlevel import lowest as lowest_module
from knitcore.yarnlevel.lowest import Followed, can_be_followed, lowest, without_mirrors
from knitcore.yarnlevel.relax import relax
from knitcore.yarnlevel.results import Branch
from knitcore.yarnlevel.samples import sample
from knitcore.yarnlevel.splines import COARSE


def mirrored(yarn, fabric):
    entry = sample(yarn, fabric)
    chart = StitchChart.of_fabric(Fabric(fabric), 2, 2)
    return relax(chart, entry.yarn, entry.loop_length_mm, grid=COARSE, branch="mirrored")


def test_stockinette_needs_no_mirrors():
    relaxed = mirrored("acrylic", "stockinette")
    found = without_mirrors(relaxed)
    assert found.minimum
    assert found.state.energy_n_mm == pytest.approx(relaxed.energy_n_mm, rel=1e-3)
    assert found.state.branch is Branch.FREE


def test_an_instability_is_followed_to_a_lower_minimum():
    found = without_mirrors(mirrored("cotton", "garter"))
    assert not found.minimum
    assert found.lower > 0.005
    # what it leads to has no instability left
    again = without_mirrors(found.state)
    assert again.minimum
    assert again.state.energy_n_mm == pytest.approx(found.state.energy_n_mm, rel=1e-4)


@pytest.mark.parametrize("lower", [1e-5, 0.1])
def test_a_shape_that_is_not_known_to_be_a_minimum_is_not_called_one(monkeypatch, lower):
    relaxed = mirrored("acrylic", "stockinette")
    saddle = replace(without_mirrors(relaxed).state, minimum=False)
    monkeypatch.setattr(
        lowest_module, "without_mirrors", lambda *_, **__: Followed(False, saddle, lower)
    )
    found = lowest(relaxed)
    assert found.minimum is False
    assert (found.mirrored is relaxed) == (lower == 0.1)


@pytest.mark.slow
def test_the_free_branch_is_not_above_what_an_instability_leads_to():
    entry = sample("acrylic", "rib")
    chart = StitchChart.of_fabric(Fabric.RIB, 2, 2)
    followed = without_mirrors(mirrored("acrylic", "rib"))
    free = relax(chart, entry.yarn, entry.loop_length_mm, branch="free", grid=COARSE)
    assert free.energy_n_mm < followed.state.energy_n_mm * (1.0 + 1e-4)
    assert free.starts[0].name == "mirrored, followed"


def test_a_state_that_is_held_is_refused():
    with pytest.raises(InputError, match="held"):
        without_mirrors(replace(mirrored("acrylic", "stockinette"), flat=True))
    entry = sample("acrylic", "stockinette")
    wide = relax(StitchChart.parse("K"), entry.yarn, entry.loop_length_mm, cell_course_mm=4.0)
    assert wide.held
    assert not can_be_followed(wide)
    with pytest.raises(InputError, match="size is held"):
        without_mirrors(wide)
