"""A strip test in which the clamps are pulled with given forces."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np

from knitcore.errors import Cancelled, ConvergenceError, InputError
from knitcore.fabric import Direction
from knitcore.swatch.results import StripTest
from knitcore.swatch.run import Path, Progress, run_path
from knitcore.swatch.sheet import Sheet
from knitcore.swatch.solver import Equilibrium
from knitcore.swatch.strip import (
    LOCK_UP_SHARE,
    MAX_STRAIN,
    Clamps,
    clamp_edges,
    clamp_mask,
    lock_up_strain,
    stretched,
    strip_result,
)

FORCE_TOLERANCE = 1e-6
MAX_CORRECTIONS = 25


def pull_with_force(
    sheet: Sheet,
    direction: Direction,
    forces_n: Sequence[float],
    *,
    clamps: Clamps = Clamps.CLAMPED,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> StripTest:
    """A strip test in which the clamps are pulled with given forces (N, increasing).

    The strain for a force is found by secant steps on the clamp force of strain-driven
    equilibria. A force beyond 98 % of the lock-up strain ends the test as not converged.

    Raises
    ------
    InputError
        If the forces are not positive and increasing.
    """
    levels = np.asarray(forces_n, dtype=float)
    if levels.ndim != 1 or levels.size == 0 or not np.all(np.isfinite(levels)) or levels[0] <= 0:
        raise InputError(
            "force_n", f"{forces_n} are not all pulling forces.", "Give numbers above 0."
        )
    if np.any(np.diff(levels) <= 0):
        raise InputError("force_n", "the forces do not increase.", "Give increasing forces.")
    begin = time.perf_counter()
    limit = min(LOCK_UP_SHARE * lock_up_strain(sheet, direction), MAX_STRAIN)
    nodes = sheet.grid.edge(clamp_edges(direction)[1])
    fixed = clamp_mask(sheet.grid, direction, clamps)

    def solve(strain: float, start: Equilibrium | None) -> Equilibrium:
        path = run_path(
            sheet,
            fixed,
            [stretched(sheet.grid, direction, strain)],
            start=start.state if start else None,
            cancelled=cancelled,
        )
        if path.problem:
            raise ConvergenceError(path.problem)
        return path.found[0]

    def force(found: Equilibrium) -> float:
        return float(found.reaction[nodes, direction.axis].sum())

    found: list[Equilibrium] = []
    strains: list[float] = []
    problem = None
    last = (0.0, 0.0)
    strain = 1e-3
    equilibrium: Equilibrium | None = None
    try:
        for number, goal in enumerate(levels):
            iterations = 0
            for _ in range(MAX_CORRECTIONS):
                equilibrium = solve(strain, equilibrium)
                iterations += equilibrium.iterations
                now = force(equilibrium)
                if abs(now - goal) <= FORCE_TOLERANCE * goal:
                    break
                slope = (now - last[1]) / (strain - last[0])
                last = (strain, now)
                # stiffening makes the secant overshoot; half the strain that is left bounds it
                strain = min(strain + (goal - now) / slope, (strain + limit) / 2)
            else:
                raise ConvergenceError(
                    f"{goal:.3g} N needs more than {limit:.3f} strain, 98 % of the lock-up."
                )
            found.append(
                Equilibrium(equilibrium.state, equilibrium.energy, equilibrium.reaction, iterations)
            )
            strains.append(strain)
            if progress is not None:
                progress(number + 1, len(levels))
            if number + 1 < len(levels):
                slope = (now - last[1]) / (strain - last[0]) if strain != last[0] else now / strain
                last = (strain, now)
                strain = min(strain + (levels[number + 1] - now) / slope, (strain + limit) / 2)
    except ConvergenceError as error:
        problem = f"Force {len(found) + 1} of {len(levels)} was not reached. {error}"
    path = Path(tuple(found), problem, time.perf_counter() - begin)
    return strip_result(sheet, direction, np.array(strains), path)
