"""Friction between yarns: its potential, its laws, and its limits."""

from dataclasses import replace

import numpy as np
import pytest

from knitcore.base.errors import InputError
from knitcore.yarn.kernels.curve_samples import laid_out
from knitcore.yarn.kernels.friction_kernels import Sliding, slides
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.solve.friction import agitated, rubbed
from knitcore.yarn.solve.newton import COURSE
from knitcore.yarn.study.hysteresis import at_rest
from knitcore.yarn.study.relax import relax
from tests.knitcore.yarn.model.test_energy import CASES, energy_of
from tests.knitcore.yarn.relaxed import relaxed

GRID = SplineGrid(12, 3)


@pytest.fixture(scope="module")
def stockinette():
    return relaxed("K", sample("acrylic", "stockinette"), grid=GRID)


def walk(relaxed, strains, coefficient):
    """States at the strains along the course, one after the other."""
    state, states = agitated(relaxed), []
    for strain in strains:
        size = relaxed.cell_course_mm * (1.0 + strain)
        state = rubbed(state, coefficient, fixed=(COURSE,), target=np.array([size, size]))
        states.append(state)
    return states


def forces(states):
    return np.array([s.cell.force_n[0] for s in states])


@pytest.mark.parametrize(("text", "kind"), CASES)
def test_gradient_and_hessian_agree_with_differences(text, kind):
    energy, state = energy_of(text, kind)
    curve = energy.curve(state)
    size = state[-2], state[-1]
    pairs, _ = energy.pairs(curve, state, 2.0)
    slide, cosine = slides(curve, *size, pairs, energy.cell.layout, energy.speeds)
    rng = np.random.default_rng(3)
    # about half of the pairs slip
    rest = slide + 0.03 * rng.standard_normal(slide.shape)
    limit = 1.0 + rng.random(len(pairs))
    slip = np.full(len(pairs), 0.03)
    sliding = Sliding(pairs, limit, rest, 1.0 / np.sqrt(1.0 + cosine**2), slip)
    # no contact: its stiff cores would hide the friction
    empty = pairs[:0]
    rubbing = replace(energy, sliding=sliding)

    def value(y):
        terms = rubbing.value(y, rubbing.curve(y), empty)
        return terms.energy + terms.spacing + terms.friction

    start = np.zeros(len(curve) + 1, np.int64)
    none = np.zeros(energy.constraints)

    def derivatives(y, hessian, sparse=False):
        curve = rubbing.curve(y)
        return rubbing.derivatives(y, curve, empty, start, none, hessian=hessian, sparse=sparse)

    slope = derivatives(state, hessian=True)
    tiles = derivatives(state, hessian=True, sparse=True).sparse
    np.testing.assert_allclose(tiles.times(state), slope.hessian @ state, rtol=1e-9, atol=1e-9)
    h = 1e-6
    for direction in (*rng.standard_normal((2, len(state))), *np.eye(len(state))[-2:]):
        on, back = state + h * direction, state - h * direction
        assert slope.gradient @ direction == pytest.approx(
            (value(on) - value(back)) / (2 * h), rel=1e-5, abs=1e-6
        )
        bent = slope.hessian @ direction
        by_slope = (derivatives(on, False).gradient - derivatives(back, False).gradient) / (2 * h)
        # a pair at the edge of slipping turns its stiffness between the two
        np.testing.assert_allclose(bent, by_slope, atol=2e-3 * np.abs(bent).max())


def test_turning_the_fabric_rubs_nothing():
    energy, state = energy_of("KKP\nPKK", CASES[3][1])
    curve = energy.curve(state)
    pairs, _ = energy.pairs(curve, state, 2.0)
    # an image across would not turn with the cell
    pairs = pairs[(pairs[:, 2] == 0) & (pairs[:, 3] == 0)]
    place, layout = energy.cell.place, energy.cell.layout
    at = laid_out(curve, place, state[-2], state[-1])[:, :3]
    angle = 0.4
    turn = np.array(
        [[1, 0, 0], [0, np.cos(angle), -np.sin(angle)], [0, np.sin(angle), np.cos(angle)]]
    )
    turned = curve @ turn.T
    drift = at - curve[:, 0]
    turned[:, 0] = at @ turn.T - drift
    before, _ = slides(curve, *state[-2:], pairs, layout, energy.speeds)
    after, _ = slides(turned, *state[-2:], pairs, layout, energy.speeds)
    np.testing.assert_allclose(after, before, atol=1e-12)


def test_without_friction_the_states_are_todays(stockinette):
    free = walk(stockinette, [0.1, 0.2], 0.0)
    alone = relax(
        stockinette.chart, stockinette.yarn, stockinette.loop_lengths_mm, grid=GRID,
        cell_course_mm=1.2 * stockinette.cell_course_mm,
    )  # fmt: skip
    assert free[-1].cell.force_n[0] == pytest.approx(alone.force_n[0], rel=1e-4)
    assert free[-1].lost_n_mm == 0.0
    slight = walk(stockinette, [0.1, 0.2], 1e-5)
    assert slight[-1].cell.force_n[0] == pytest.approx(alone.force_n[0], rel=1e-3)


def test_smaller_steps_give_the_same_curve(stockinette):
    coarse = forces(walk(stockinette, np.linspace(0, 0.2, 9)[1:], 0.25))
    fine = forces(walk(stockinette, np.linspace(0, 0.2, 17)[1:], 0.25))[1::2]
    np.testing.assert_allclose(fine[1:], coarse[1:], rtol=0.03)
    without = forces(walk(stockinette, [0.2], 0.0))
    assert coarse[-1] > 1.15 * without[-1]


def test_waiting_changes_nothing(stockinette):
    moved = walk(stockinette, [0.05, 0.1, 0.1, 0.1, 0.1], 0.25)
    force = forces(moved)
    np.testing.assert_allclose(force[2:], force[1], rtol=2e-3)


def test_friction_takes_energy_in_every_step_but_the_first_one_back(stockinette):
    there = np.linspace(0, 0.15, 6)[1:]
    states = walk(stockinette, [*there, *there[-2::-1]], 0.25)
    lost = [s.lost_n_mm for s in states]
    assert lost[0] > 0.0
    step = np.diff(lost)
    turn = len(there) - 1
    assert np.all(np.delete(step, turn) > 0.0)
    # there the contacts give back what they hold elastically
    assert step[turn] < 0.0 < step[turn - 1 : turn + 1].sum()


@pytest.mark.parametrize("coefficient", [-0.1, 3.0, np.nan])
def test_coefficients_out_of_range_are_refused(stockinette, coefficient):
    with pytest.raises(InputError, match="friction"):
        rubbed(agitated(stockinette), coefficient)
    with pytest.raises(InputError, match="friction"):
        at_rest(stockinette, "agitated", coefficient)


def test_yarn_that_is_held_flat_is_refused(stockinette):
    with pytest.raises(InputError, match="flat"):
        agitated(replace(stockinette, flat=True))
