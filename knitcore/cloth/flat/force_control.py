"""The strain of a sheet between clamps under a given force."""

from typing import NamedTuple

import numpy as np

from knitcore.base.errors import Cancelled, ConvergenceError, InputError
from knitcore.chart.fabric import Direction
from knitcore.cloth.flat.equilibrium_path import run_path
from knitcore.cloth.flat.grid_sheet import Sheet, State
from knitcore.cloth.flat.strip import (
    LOCK_UP_SHARE,
    MAX_STRAIN,
    Clamps,
    clamp_edges,
    clamp_mask,
    lock_up_strain,
    stretched,
)

FORCE_TOLERANCE = 1e-6
MAX_CORRECTIONS = 25
FIRST_STRAIN = 1e-3
NEAR_LIMIT = 1e-2
"""Distance from the largest strain, as a share of it, at which that strain itself is tried."""


class _Pull(NamedTuple):
    """An equilibrium, the clamps' strain and their force in N."""

    strain: float
    force_n: float
    state: State


def strain_at_force(
    sheet: Sheet,
    direction: Direction,
    force_n: float,
    *,
    clamps: Clamps = Clamps.CLAMPED,
    cancelled: Cancelled | None = None,
) -> float:
    """The clamp-to-clamp strain at which the clamps hold a force (N).

    It is found by secant steps on the clamp force, each from the last equilibrium.

    Raises
    ------
    InputError
        If it lies beyond 98 % of the lock-up; names the force that is reached there.
    ConvergenceError, CancelledError
    """
    limit = min(LOCK_UP_SHARE * lock_up_strain(sheet, direction), MAX_STRAIN)
    fixed = clamp_mask(sheet.grid, direction, clamps)
    end = sheet.grid.edge(clamp_edges(direction)[1])
    pulls: list[_Pull] = []
    for _ in range(MAX_CORRECTIONS):
        strain = _next(pulls, force_n, limit)
        start = pulls[-1].state if pulls else None
        target = stretched(sheet.grid, direction, strain)
        path = run_path(sheet, fixed, [target], start=start, cancelled=cancelled)
        if path.problem:
            raise ConvergenceError(path.problem)
        reached_n = float(path.forces(end, direction.axis)[0])
        pulls = [*pulls[-1:], _Pull(strain, reached_n, path.states[0])]
        if abs(reached_n - force_n) <= FORCE_TOLERANCE * force_n:
            return strain
        if strain == limit and reached_n < force_n:
            most = float(np.floor(100 * reached_n) / 100)
            raise InputError(
                "force_n",
                f"{force_n:.3g} N {direction}-wise is too much: this swatch runs out of "
                f"stretch at {100 * limit:.1f} %, with {reached_n:.3g} N.",
                f"Use at most {most:.2f}.",
                most=most,
            )
    raise ConvergenceError(f"{MAX_CORRECTIONS} pulls did not come to {force_n:.3g} N.")


def _next(pulls: list[_Pull], force_n: float, limit: float) -> float:
    """Estimate the strain at which the clamps hold a force, from the last two pulls."""
    if not pulls:
        return min(FIRST_STRAIN, limit)
    now, before = pulls[-1], pulls[-2] if len(pulls) > 1 else None
    slope = (
        now.force_n / now.strain
        if before is None or before.strain == now.strain
        else (now.force_n - before.force_n) / (now.strain - before.strain)
    )
    strain = now.strain + (force_n - now.force_n) / slope
    half = (now.strain + limit) / 2  # stiffening makes the secant overshoot
    if strain <= half:
        return strain
    return limit if limit - half < NEAR_LIMIT * limit else half
