"""Uncertainty of the forces and motions of a piece, from that of its cloth's laws.

By the delta method, as for a strip (:mod:`knitcore.cloth.flat.strip_uncertainty`): a parameter p of
the laws moves the nodes by du/dp = -K⁻¹ dR/dp and changes the forces at the edges by dR/dp + K
du/dp. Variances of independent parameters add up.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import make_interp_spline

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.cloth.cut.cut_results import PieceTest
from knitcore.cloth.flat.margins import sampled_steps
from knitcore.cloth.flat.strip_uncertainty import STEP, law_parameters
from knitcore.linear.direct_factor import positive_definite_factor
from knitcore.materials.material import Material
from knitcore.prediction.quarter_laws import SPREAD_AT


@dataclass(frozen=True, eq=False)
class PieceSpread:
    """Standard deviations at one load step, (conditions, 2) each: of x and y.

    Attributes
    ----------
    force_n : of the forces on the edges.
    moved_mm : of the mean displacements of the edges.
    """

    force_n: Array
    moved_mm: Array


def piece_spread(test: PieceTest, material: Material, step: int = -1) -> PieceSpread:
    """Standard deviations of a test at a load step (the last one by default).

    Raises
    ------
    InputError
        If the cloth may wrinkle (``tension_field``): its forces are not linear in the laws.
    """
    constraints = test.constraints
    force, moved = np.zeros((2, len(test.conditions), 2))
    for change, motion in _changes(test, material, step):
        force += constraints.forces(change, 0.0) ** 2
        moved += np.array([motion[:, nodes].mean(axis=1) for nodes in constraints.nodes]) ** 2
    own = _model_log_sd(test, step)
    force += (own * constraints.forces(test.equilibria[step].internal, 0.0)) ** 2
    return PieceSpread(np.sqrt(force), np.sqrt(moved))


def piece_spreads(test: PieceTest, material: Material) -> Array:
    """Standard deviations at every step, (2, steps, conditions, 2): of the forces in N and of the
    mean displacements in mm, along x and y.

    They are computed at a few steps, and interpolated between them.

    Raises
    ------
    InputError
        As :func:`piece_spread`.
    """
    steps = sampled_steps(len(test.equilibria))
    if not steps:
        return np.empty((2, 0, len(test.conditions), 2))
    spreads = [piece_spread(test, material, step) for step in steps]
    known = np.array([[at.force_n for at in spreads], [at.moved_mm for at in spreads]])
    between = make_interp_spline(steps, known, k=min(1, len(steps) - 1), axis=1)
    return np.asarray(between(np.arange(len(test.equilibria))))


def force_log_sd(
    test: PieceTest, material: Material, force: Callable[[Array, int], float]
) -> Array:
    """Standard deviation per step of the logarithm of a force, or of work.

    Parameters
    ----------
    test, material : as for :func:`piece_spread`, which raises the same errors.
    force : of the internal forces (2, nodes) at a step (from 0), and linear in them. It is
        computed at a few steps, and interpolated between them.
    """
    steps = sampled_steps(len(test.equilibria))
    deviations = []
    for step in steps:
        value = force(test.equilibria[step].internal, step)
        parts = [force(change, step) / value for change, _ in _changes(test, material, step)]
        deviations.append(np.linalg.norm([*parts, _model_log_sd(test, step)]))
    return np.interp(np.arange(len(test.equilibria)), steps, deviations) if steps else np.empty(0)


def _changes(test: PieceTest, material: Material, step: int) -> Iterator[tuple[Array, Array]]:
    """Changes of the internal forces and of the displacements (2, nodes) by one standard deviation
    of each parameter of the laws.
    """
    sheet = test.energy.cloth.sheet
    if sheet.model.tension_field:
        raise InputError(
            "tension_field", "there are no intervals for cloth that wrinkles.", "Turn it off."
        )
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
