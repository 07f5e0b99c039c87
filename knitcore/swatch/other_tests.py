"""Other tests of a swatch: a strip under given forces, biaxial stretch and trellis shear."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np

from knitcore.arrays import Array
from knitcore.errors import ConvergenceError, InputError
from knitcore.fabric import Direction
from knitcore.swatch.results import BiaxialTest, StripTest, TrellisTest
from knitcore.swatch.run import Path, Progress, run_path
from knitcore.swatch.sheet import Sheet
from knitcore.swatch.solver import Equilibrium
from knitcore.swatch.strip import (
    LOCK_UP_SHARE,
    MAX_STRAIN,
    Clamps,
    check_lock_up,
    clamp_edges,
    clamp_mask,
    lock_up_strain,
    stretched,
    strip_result,
)

FORCE_TOLERANCE = 1e-6
MAX_CORRECTIONS = 25
MAX_SHEAR_ANGLE = 1.2
"""rad; beyond it courses and wales touch in any knit."""


def pull_with_force(
    sheet: Sheet,
    direction: Direction,
    forces_n: Sequence[float],
    *,
    clamps: Clamps = Clamps.CLAMPED,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
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


def biaxial_test(
    sheet: Sheet,
    strain_course: float,
    strain_wale: float,
    *,
    steps: int = 10,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> BiaxialTest:
    """Pull all four edges outwards; each edge stays straight and slides along itself.

    Raises
    ------
    InputError
        If a strain is negative, both are 0, or one is beyond the lock-up.
    """
    last = {Direction.COURSE: strain_course, Direction.WALE: strain_wale}
    for direction, strain in last.items():
        if not (np.isfinite(strain) and strain >= 0):
            raise InputError(
                f"strain_{direction}", f"{strain} is not a stretch.", "Give 0 or more."
            )
        check_lock_up(sheet, direction, strain)
    if max(last.values()) == 0:
        raise InputError("strain_course", "both strains are 0.", "Give one above 0.")
    grid = sheet.grid
    share = np.arange(1, steps + 1) / steps
    fixed = np.zeros((len(grid.corners), 2), dtype=bool)
    for direction in Direction:
        for name in clamp_edges(direction):
            fixed[grid.edge(name), direction.axis] = True
    targets = [grid.corners * (1 + s * np.array([strain_course, strain_wale])) for s in share]
    path = run_path(sheet, fixed, targets, progress=progress, cancelled=cancelled)
    done = share[: len(path.found)]
    course, wale = path.forces(grid.edge("right"), 0), path.forces(grid.edge("top"), 1)
    return BiaxialTest.of(
        sheet,
        path,
        strain_course=done * strain_course,
        strain_wale=done * strain_wale,
        force_course_n=course,
        force_wale_n=wale,
        stress_course_n_per_mm=course / grid.length_mm,
        stress_wale_n_per_mm=wale / grid.width_mm,
    )


def trellis_test(
    sheet: Sheet,
    shear_angle: float,
    *,
    steps: int = 10,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> TrellisTest:
    """Shear a swatch in a hinged frame by an angle (rad) between courses and wales.

    Raises
    ------
    InputError
        If the angle is not between 0 and 1.2 rad.
    """
    if not 0 < shear_angle <= MAX_SHEAR_ANGLE:
        raise InputError(
            "shear_angle", f"{shear_angle} rad is out of range.", f"Use 0 to {MAX_SHEAR_ANGLE}."
        )
    grid = sheet.grid
    angles = shear_angle * np.arange(1, steps + 1) / steps
    fixed = np.zeros((len(grid.corners), 2), dtype=bool)
    for name in ("left", "right", "bottom", "top"):
        fixed[grid.edge(name)] = True
    path = run_path(
        sheet,
        fixed,
        [grid.corners @ _frame(angle) for angle in angles],
        progress=progress,
        cancelled=cancelled,
    )
    angles = angles[: len(path.found)]
    # the work of the frame: reactions times the velocity of its bars per angle
    moment = np.array(
        [
            np.sum(e.reaction * (grid.corners @ _frame_rate(angle)))
            for e, angle in zip(path.found, angles, strict=True)
        ]
    )
    return TrellisTest.of(
        sheet,
        path,
        shear_angle=angles,
        moment_n_mm=moment,
        shear_stress_n_per_mm=moment / (grid.width_mm * grid.length_mm),
    )


def _frame(angle: float) -> Array:
    """Rows: images of the unit vectors along course and wale."""
    c, s = np.cos(angle / 2), np.sin(angle / 2)
    return np.array([[c, s], [s, c]])


def _frame_rate(angle: float) -> Array:
    c, s = np.cos(angle / 2) / 2, np.sin(angle / 2) / 2
    return np.array([[-s, c], [c, -s]])
