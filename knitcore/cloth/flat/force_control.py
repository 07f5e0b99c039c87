"""A strip test in which the clamps are pulled with given forces."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from knitcore.base.errors import Cancelled, ConvergenceError, InputError, Progress
from knitcore.chart.fabric import Direction
from knitcore.cloth.flat.equilibrium_path import Equilibrium, Path, run_path
from knitcore.cloth.flat.grid_sheet import Sheet
from knitcore.cloth.flat.strip import (
    LOCK_UP_SHARE,
    MAX_STRAIN,
    Clamps,
    clamp_edges,
    clamp_mask,
    lock_up_strain,
    stretched,
    strip_result,
)
from knitcore.cloth.flat.strip_results import StripTest

FORCE_TOLERANCE = 1e-6
MAX_CORRECTIONS = 25
FIRST_STRAIN = 1e-3
NEAR_LIMIT = 1e-2
"""Distance from the largest strain, as a share of it, at which that strain itself is tried."""


def strain_at_force(
    sheet: Sheet,
    direction: Direction,
    force_n: float,
    *,
    clamps: Clamps = Clamps.CLAMPED,
    cancelled: Cancelled | None = None,
) -> float:
    """The clamp-to-clamp strain at which the clamps hold a force (N).

    Raises
    ------
    InputError
        If it lies beyond 98 % of the lock-up; names the force that is reached there.
    ConvergenceError, CancelledError
    """
    return _Bench(sheet, direction, clamps, cancelled).pull(force_n).strain


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

    A force beyond 98 % of the lock-up strain ends the test as not converged.

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
    bench = _Bench(sheet, direction, clamps, cancelled)
    pulls: list[_Pull] = []
    problem = None
    try:
        for goal in levels:
            pulls.append(bench.pull(goal))
            if progress is not None:
                progress(len(pulls), len(levels))
    except (ConvergenceError, InputError) as error:
        problem = f"Force {len(pulls) + 1} of {len(levels)} was not reached. {error}"
    path = Path(tuple(pull.equilibrium for pull in pulls), problem, time.perf_counter() - begin)
    return strip_result(sheet, direction, np.array([pull.strain for pull in pulls]), path)


@dataclass(frozen=True, eq=False)
class _Pull:
    """An equilibrium, the clamps' strain and their force in N."""

    strain: float
    force_n: float
    equilibrium: Equilibrium


class _Bench:
    """A sheet between clamps, pulled on by ever larger forces.

    The strain for a force is found by secant steps on the clamp force, each from the last
    equilibrium.
    """

    def __init__(
        self, sheet: Sheet, direction: Direction, clamps: Clamps, cancelled: Cancelled | None
    ) -> None:
        self._sheet, self._direction, self._cancelled = sheet, direction, cancelled
        self._limit = min(LOCK_UP_SHARE * lock_up_strain(sheet, direction), MAX_STRAIN)
        self._fixed = clamp_mask(sheet.grid, direction, clamps)
        self._end = sheet.grid.edge(clamp_edges(direction)[1])
        self._last: list[_Pull] = []

    def pull(self, goal_n: float) -> _Pull:
        """Find the equilibrium under a force.

        Raises
        ------
        InputError
            If the sheet locks up before that.
        ConvergenceError, CancelledError
        """
        iterations = 0
        for _ in range(MAX_CORRECTIONS):
            now = self._at(self._next(goal_n))
            self._last = [*self._last[-1:], now]
            iterations += now.equilibrium.iterations
            if abs(now.force_n - goal_n) <= FORCE_TOLERANCE * goal_n:
                return replace(now, equilibrium=replace(now.equilibrium, iterations=iterations))
            if now.strain == self._limit and now.force_n < goal_n:
                most = float(np.floor(100 * now.force_n) / 100)
                raise InputError(
                    "force_n",
                    f"{goal_n:.3g} N {self._direction}-wise is too much: this swatch can be "
                    f"pulled to a strain of {self._limit:.3f}, near its lock-up, with "
                    f"{now.force_n:.3g} N.",
                    f"Use at most {most:.2f}.",
                    most=most,
                )
        raise ConvergenceError(f"{MAX_CORRECTIONS} pulls did not come to {goal_n:.3g} N.")

    def _next(self, goal_n: float) -> float:
        """Estimate the strain at which the clamps hold a force, from the known ones."""
        if not self._last:
            return min(FIRST_STRAIN, self._limit)
        now = self._last[-1]
        before = self._last[-2] if len(self._last) > 1 else None
        slope = (
            now.force_n / now.strain
            if before is None or before.strain == now.strain
            else (now.force_n - before.force_n) / (now.strain - before.strain)
        )
        strain = now.strain + (goal_n - now.force_n) / slope
        half = (now.strain + self._limit) / 2  # stiffening makes the secant overshoot
        if strain <= half:
            return strain
        return self._limit if self._limit - half < NEAR_LIMIT * self._limit else half

    def _at(self, strain: float) -> _Pull:
        path = run_path(
            self._sheet,
            self._fixed,
            [stretched(self._sheet.grid, self._direction, strain)],
            start=self._last[-1].equilibrium.state if self._last else None,
            cancelled=self._cancelled,
        )
        if path.problem:
            raise ConvergenceError(path.problem)
        return _Pull(
            strain, float(path.forces(self._end, self._direction.axis)[0]), path.equilibria[0]
        )
