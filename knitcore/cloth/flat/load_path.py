"""Running a path of load steps: progress, cancellation, and partial results if it stops early."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, Progress
from knitcore.base.threads import one_blas_thread
from knitcore.cloth.flat.equilibrium_path import Equilibrium, PathSolver, StepError, Tolerance
from knitcore.cloth.flat.grid_sheet import Sheet, State


@dataclass(frozen=True, eq=False)
class Path:
    """Equilibria found, the reason if the path stopped early, and the time taken."""

    equilibria: tuple[Equilibrium, ...]
    problem: str | None
    seconds: float

    @property
    def states(self) -> tuple[State, ...]:
        """Positions per step."""
        return tuple(e.state for e in self.equilibria)

    @property
    def energies(self) -> Array:
        """N·mm per step."""
        return np.array([e.energy for e in self.equilibria])

    @property
    def iterations(self) -> tuple[int, ...]:
        """Linear systems solved per step."""
        return tuple(e.iterations for e in self.equilibria)

    def forces(self, nodes: NDArray[np.int64], axis: int) -> Array:
        """Force (N) on prescribed nodes along an axis, per step."""
        return np.array([e.reaction[nodes, axis].sum() for e in self.equilibria])


def run_path(
    sheet: Sheet,
    fixed: NDArray[np.bool_],
    targets: list[Array],
    *,
    start: State | None = None,
    tolerance: Tolerance | None = None,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> Path:
    """Follow the targets as far as they converge.

    Raises
    ------
    CancelledError
        If ``cancelled`` returned True.
    """
    begin = time.perf_counter()
    solver = PathSolver(sheet, fixed, tolerance=tolerance, cancelled=cancelled)
    equilibria: list[Equilibrium] = []
    problem = None
    try:
        with one_blas_thread():
            for equilibrium in solver.follow(start or sheet.reference, targets):
                equilibria.append(equilibrium)
                if progress is not None:
                    progress(len(equilibria), len(targets))
    except StepError as error:
        problem = f"Step {len(equilibria) + 1} of {len(targets)} did not converge. {error}"
    return Path(tuple(equilibria), problem, time.perf_counter() - begin)
