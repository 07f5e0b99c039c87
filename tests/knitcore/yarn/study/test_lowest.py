"""Mirrored states without their mirrors."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from knitcore import Fabric, InputError, StitchChart
from knitcore.base.arrays import scattered
from knitcore.yarn.model.cell import free_cell
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.model.relaxed_cell import Branch
from knitcore.yarn.model.tiling import tiled_state
from knitcore.yarn.solve import newton as solver
from knitcore.yarn.solve.search import SAME_ENERGY, lowest_of
from knitcore.yarn.solve.splines import COARSE
from knitcore.yarn.study import lowest as lowest_module
from knitcore.yarn.study.lowest import Followed, can_be_followed, followed, lowest, without_mirrors
from tests.knitcore.yarn.relaxed import relaxed


def mirrored(yarn, fabric):
    chart = StitchChart.of_fabric(Fabric(fabric), 2, 2)
    return relaxed(chart, sample(yarn, fabric), grid=COARSE, branch="mirrored")


def test_stockinette_needs_no_mirrors():
    relaxed = mirrored("acrylic", "stockinette")
    free = without_mirrors(relaxed)
    assert free.minimum
    assert free.state.energy_n_mm == pytest.approx(relaxed.energy_n_mm, rel=1e-3)
    assert free.state.branch is Branch.FREE


def test_an_instability_is_followed_to_a_lower_minimum():
    free = without_mirrors(mirrored("cotton", "garter"))
    assert not free.minimum
    assert free.lower > 0.005
    # what it leads to has no instability left
    again = without_mirrors(free.state)
    assert again.minimum
    assert again.state.energy_n_mm == pytest.approx(free.state.energy_n_mm, rel=1e-4)


@pytest.mark.parametrize("text", ["KP", "KKP"])
@pytest.mark.slow
def test_where_a_saddle_leads_does_not_hang_on_the_last_digits(text, monkeypatch):
    """Nor on how far it is left: the start is shaken by a billionth of the radius."""
    entry = sample("cotton", "rib")
    chart = StitchChart.parse(text)
    rest = relaxed(chart, entry, branch="mirrored")
    cell = free_cell(chart, rest.cell.grid)
    lengths = np.resize(rest.loop_lengths_mm, cell.rows)
    energy = CellEnergy(cell, rest.yarn, lengths, rest.convention)
    state = tiled_state(rest.cell, rest.state, cell)
    tension = np.resize(rest.tension_n, cell.rows)
    first, _ = followed(energy, state, tension=tension)
    assert first.saddles > 0
    noise = scattered((len(state),), 1e-9 * entry.yarn.radius_mm, seed=3)
    again, _ = followed(energy, state + noise, tension=tension)
    monkeypatch.setattr(solver, "_NUDGE", 0.1)
    farther, _ = followed(energy, state, tension=tension)
    for other in (again, farther):
        assert other.terms.energy == pytest.approx(first.terms.energy, rel=SAME_ENERGY)


def test_of_states_as_low_the_first_counts_and_those_of_other_sizes_are_told():
    states = [
        SimpleNamespace(terms=SimpleNamespace(energy=e), state=np.array([0.0, wide, 1.0]))
        for e, wide in ((1.0004, 2.0), (1.0, 2.1), (1.0, 2.0001), (1.2, 3.0))
    ]
    first, others = lowest_of(states)
    assert first is states[0]
    assert others == [states[1]]
    assert lowest_of(states[::-1])[0] is states[2]


@pytest.mark.parametrize("lower", [1e-5, 0.1])
def test_a_shape_that_is_not_known_to_be_a_minimum_is_not_called_one(monkeypatch, lower):
    relaxed = mirrored("acrylic", "stockinette")
    saddle = replace(without_mirrors(relaxed).state, minimum=False)
    monkeypatch.setattr(
        lowest_module, "without_mirrors", lambda *_, **__: Followed(False, saddle, lower)
    )
    state = lowest(relaxed)
    assert state.minimum is False
    assert (state.mirrored is relaxed) == (lower == 0.1)


@pytest.mark.slow
def test_the_free_branch_is_not_above_what_an_instability_leads_to():
    chart = StitchChart.of_fabric(Fabric.RIB, 2, 2)
    followed = without_mirrors(mirrored("acrylic", "rib"))
    free = relaxed(chart, sample("acrylic", "rib"), branch="free", grid=COARSE)
    assert free.energy_n_mm < followed.state.energy_n_mm * (1.0 + 1e-4)
    assert free.starts[0].name == "mirrored, followed"


def test_a_state_that_is_held_is_refused():
    with pytest.raises(InputError, match="held"):
        without_mirrors(replace(mirrored("acrylic", "stockinette"), flat=True))
    wide = relaxed("K", sample("acrylic", "stockinette"), cell_course_mm=4.0)
    assert wide.held
    assert not can_be_followed(wide)
    with pytest.raises(InputError, match="size is held"):
        without_mirrors(wide)
