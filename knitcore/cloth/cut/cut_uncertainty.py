"""Uncertainty of the forces and motions of a piece, from that of its cloth's laws.

By the delta method, as for a strip (:mod:`knitcore.cloth.flat.strip_uncertainty`): a parameter p of
the laws moves the nodes by du/dp = -K⁻¹ dR/dp and changes the forces at the edges by dR/dp + K
du/dp. Variances of independent parameters add up.
"""

from collections.abc import Callable, Iterator

import numpy as np

from knitcore.base.arrays import Array
from knitcore.cloth.cut.cut_results import PieceTest
from knitcore.cloth.flat.margins import sampled_steps
from knitcore.cloth.flat.strip_uncertainty import STEP, law_parameters
from knitcore.linear.grid_factor import positive_definite_factor
from knitcore.materials.material import Material
from knitcore.prediction.quarter_laws import SPREAD_AT


def piece_spreads(test: PieceTest, material: Material) -> Array:
    """Standard deviations at every step, (2, steps, conditions, 2): of the forces on the edges in N
    and of the edges' mean displacements in mm, along x and y.
    """
    constraints = test.constraints

    def at(step: int) -> Array:
        variances = np.zeros((2, len(test.conditions), 2))
        for change, motion in _changes(test, material, step):
            moved = np.array([motion[:, nodes].mean(axis=1) for nodes in constraints.nodes])
            variances += np.square([constraints.forces(change, 0.0), moved])
        force = constraints.forces(test.equilibria[step].internal, 0.0)
        variances[0] += (_model_log_sd(test, step) * force) ** 2
        return np.sqrt(variances)

    return np.moveaxis(_at_all_steps(test, at, (2, len(test.conditions), 2)), 1, 0)


def force_log_sd(
    test: PieceTest, material: Material, force: Callable[[Array, int], float]
) -> Array:
    """Standard deviation per step of the logarithm of a force, or of work.

    Parameters
    ----------
    test, material : as for :func:`piece_spreads`.
    force : of the internal forces (2, nodes) at a step (from 0), and linear in them.
    """

    def at(step: int) -> Array:
        value = force(test.equilibria[step].internal, step)
        parts = [force(change, step) / value for change, _ in _changes(test, material, step)]
        return np.asarray(np.linalg.norm([*parts, _model_log_sd(test, step)]))

    return _at_all_steps(test, at, ())


def _at_all_steps(test: PieceTest, at: Callable[[int], Array], shape: tuple[int, ...]) -> Array:
    """Values (steps, …) of every step, computed at a few and interpolated between them."""
    from scipy.interpolate import make_interp_spline  # slow to import

    count = len(test.equilibria)
    steps = sampled_steps(count)
    if not steps:
        return np.empty((0, *shape))
    known = np.array([at(step) for step in steps])
    between = make_interp_spline(steps, known, k=min(1, len(steps) - 1))
    return np.asarray(between(np.arange(count)))


def _changes(test: PieceTest, material: Material, step: int) -> Iterator[tuple[Array, Array]]:
    """Changes of the internal forces and of the displacements (2, nodes) by one standard deviation
    of each parameter of the laws.
    """
    sheet = test.energy.cloth.sheet
    u, spread = test.equilibria[step].displacement, test.constraints.spread
    tangent = test.energy.at(u, test.constraints.tapes).tangent
    solve = positive_definite_factor(spread.T @ tangent @ spread)
    for parameter in law_parameters(sheet, material, 0.0, _mean_stress(test, step)):
        raised, lowered = (test.energy.law_force(p, u) for p in (parameter.up, parameter.down))
        change = parameter.sd * (raised - lowered) / (2 * STEP)
        motion = spread @ solve(-(spread.T @ change.ravel()))
        yield change + (tangent @ motion).reshape(u.shape), motion.reshape(u.shape)


def _model_log_sd(test: PieceTest, step: int) -> float:
    """The model's own error of mixed cloth in the logarithm of stress."""
    sd = test.energy.cloth.sheet.stress_log_sd
    if sd is None:
        return 0.0
    return float(np.interp(_mean_stress(test, step), SPREAD_AT, sd.max(axis=0)))


def _mean_stress(test: PieceTest, step: int) -> float:
    """The larger of the two stresses along the fibres, N/mm."""
    fields = test.fields(step)
    return max(float(np.mean(np.maximum(fields.stress_course, fields.stress_wale))), 0.0)
