"""Energy of a cell: exact cases, derivatives by differences, and sizes that must agree."""

import numpy as np
import pytest

from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.kernels.curve_samples import sample_curve
from knitcore.yarn.kernels.rod import rod_energy
from knitcore.yarn.kernels.structures import RodLaw
from knitcore.yarn.model.cell import mirrored_cell, plain_cell
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.start_shape import start_state
from knitcore.yarn.model.tiling import tiled_state
from knitcore.yarn.model.yarn_model import YarnModel

YARN = YarnModel(0.046, 6e-4, 2.4, 0.74, 0.1)
CASES = [
    ("K", mirrored_cell),
    ("KP", mirrored_cell),
    ("PK\nKP", mirrored_cell),
    ("KKP\nPKK", plain_cell),
    ("P\nK\nK", mirrored_cell),
    ("KKPP\nKPPK", mirrored_cell),
]


def energy_of(text, kind):
    cell = kind(StitchChart.parse(text), SplineGrid(8, 3))
    energy = CellEnergy(cell, YARN, np.full(cell.rows, 11.3), Convention.PUBLISHED)
    state = start_state(cell, 11.3, 0.6)
    state[:-2] += 0.02 * np.random.default_rng(0).standard_normal(len(state) - 2)
    return energy, state


@pytest.mark.parametrize(("bend", "regular", "exact"), [(1, 0, np.pi), (0, 1, np.pi / 4)])
def test_a_circle_has_its_known_bending_and_regularisation(bend, regular, exact):
    grid, radius = SplineGrid(64, 3), 2.0
    t = np.arange(64) / 64
    points = np.zeros((1, 64, 3))
    points[0, :, 0] = grid.interpolate(radius * np.cos(2 * np.pi * t))
    points[0, :, 1] = grid.interpolate(radius * np.sin(2 * np.pi * t))
    curve = sample_curve(points, 0.0, 1, grid.basis).reshape(-1, 4, 3)
    law = RodLaw(bend, regular, 0.0, 1.0 / grid.samples)
    rod, _ = rod_energy(curve, law, np.ones(len(curve)))
    assert rod == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("wobble", [0.02, 0.05])
def test_regularisation_does_not_depend_on_the_parametrisation(wobble):
    assert _rod_of_ellipse(wobble) == pytest.approx(_rod_of_ellipse(0.0), rel=1e-4)


def _rod_of_ellipse(wobble):
    """Rod energy of a bent ellipse whose parameter runs unevenly."""
    n, step = 4000, 1e-3
    t = (np.arange(n) + 0.5) / n

    def place(t):
        angle = 2 * np.pi * t + wobble * np.sin(2 * np.pi * t)
        return np.stack([np.cos(angle), 0.5 * np.sin(angle), 0.2 * np.cos(2 * angle)], axis=-1)

    far_back, back, here, on, far_on = (place(t + k * step) for k in range(-2, 3))
    curve = np.stack(
        [
            here,
            (on - back) / (2 * step),
            (on - 2 * here + back) / step**2,
            (far_on - 2 * on + 2 * back - far_back) / (2 * step**3),
        ],
        axis=1,
    )
    return rod_energy(curve, RodLaw(0.3, 0.1, 0.0, 1 / n), np.ones(n))[0]


@pytest.mark.parametrize(("text", "kind"), CASES)
def test_gradient_and_hessian_agree_with_differences(text, kind):
    energy, state = energy_of(text, kind)
    curve = energy.curve(state)
    pairs, start = energy.pairs(curve, state, 2.4)
    tension = np.linspace(-0.1, 0.2, energy.cell.rows)

    def lagrangian(y):
        terms = energy.value(y, energy.curve(y), pairs)
        return terms.energy + terms.spacing + tension @ terms.excess_mm

    def gradient_at(y):
        c = energy.curve(y)
        return energy.derivatives(y, c, pairs, start, tension, hessian=False).gradient

    def excess(y):
        return energy.excess(y, energy.curve(y))

    slope = energy.derivatives(state, curve, pairs, start, tension)
    gradient, hessian = slope.gradient, slope.hessian
    rng = np.random.default_rng(1)
    for direction in (*rng.standard_normal((3, len(state))), *np.eye(len(state))[-2:]):
        h = 1e-7
        by_value = (lagrangian(state + h * direction) - lagrangian(state - h * direction)) / (2 * h)
        assert gradient @ direction == pytest.approx(by_value, rel=1e-4, abs=1e-5)
        longer = (excess(state + h * direction) - excess(state - h * direction)) / (2 * h)
        np.testing.assert_allclose(slope.lengths @ direction, longer, rtol=1e-4, atol=1e-6)
        by_slope = (gradient_at(state + h * direction) - gradient_at(state - h * direction)) / (
            2 * h
        )
        scale = np.abs(hessian @ direction).max()
        np.testing.assert_allclose(hessian @ direction, by_slope, atol=1e-4 * scale)
    np.testing.assert_allclose(hessian, hessian.T, atol=1e-9 * np.abs(hessian).max())
    tiled = energy.derivatives(state, curve, pairs, start, tension, sparse=True).sparse
    for direction in (*rng.standard_normal((3, len(state))), *np.eye(len(state))[-2:]):
        expected = hessian @ direction
        np.testing.assert_allclose(
            tiled.times(direction), expected, atol=1e-9 * np.abs(expected).max()
        )


@pytest.mark.parametrize("text", ["K", "KP", "PK\nKP", "KKPP", "PPKK\nPPKK\nKKPP\nKKPP"])
def test_the_mirrored_cell_has_the_energy_of_the_whole_repeat(text):
    small, state = energy_of(text, mirrored_cell)
    chart = StitchChart.parse(text)
    whole = plain_cell(chart.tile(1, 2) if chart.columns == 1 else chart, SplineGrid(8, 3))
    large = CellEnergy(whole, YARN, np.full(whole.rows, 11.3), Convention.PUBLISHED)
    tiled = tiled_state(small.cell, state, whole)
    per_stitch = []
    for energy, y in ((small, state), (large, tiled)):
        curve = energy.curve(y)
        pairs, _ = energy.pairs(curve, y, 2.0)
        terms = energy.value(y, curve, pairs)
        per_stitch.append([terms.rod / energy.cell.stitches, terms.contact / energy.cell.stitches])
    np.testing.assert_allclose(per_stitch[0], per_stitch[1], rtol=1e-10)


def test_neighbours_are_complete_and_listed_once():
    energy, state = energy_of("KKP\nPKK", plain_cell)
    cell, curve = energy.cell, energy.curve(state)
    reach = 1.9
    pairs, start = energy.pairs(curve, state, reach)
    listed = {tuple(p[:4]) for p in pairs.tolist()}
    assert len(listed) == len(pairs)
    assert start[-1] == len(pairs)
    position = curve[:, 0].copy()
    samples = len(cell.place)
    position[:, 0] += state[-2] * np.tile(cell.place, cell.rows)
    position[:, 1] += state[-1] * np.repeat(np.arange(cell.rows), samples)
    step = np.array([state[-2] * cell.wales, state[-1] * cell.rows, 0.0])
    exclusion = 2.1 * YARN.radius_mm / 11.3
    expected = set()
    for a in range(-2, 3):
        for b in range(-3, 4):
            vector = position[None] + np.array([a, b, 0]) * step - position[:, None]
            near = np.argwhere(np.linalg.norm(vector, axis=2) < reach)
            for i, j in near.tolist():
                same = j // samples + b * cell.rows == i // samples
                along = abs(cell.place[j % samples] + a * cell.wales - cell.place[i % samples])
                if same and along <= exclusion:
                    continue
                if j > i or (j == i and (a, b) > (0, 0)):
                    expected.add((i, j, a, b))
    assert listed == expected


def test_thin_yarn_is_not_stiffened_by_the_constant_of_worsted_yarn():
    energy, _ = energy_of("K", mirrored_cell)
    assert energy.regularisation_n_mm4 == 0.002
    lace = CellEnergy(
        energy.cell, YarnModel(0.0035, 6e-3, 2.6, 0.3, 0.1), np.array([5.5]), Convention.PUBLISHED
    )
    assert lace.regularisation_n_mm4 < 0.02 * 0.002 * 5
