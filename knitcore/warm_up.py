"""Compile the kernels of all kinds of calculations before somebody waits for them.

Each calculation is small; numba keeps the machine code that it needs.
"""

import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed

import numpy as np
import scipy

from knitcore import StitchChart, curve, material, relax, strip_test
from knitcore.cloth.space.curl import curl
from knitcore.linear.dense import eliminate, product, solved, substitute, times
from knitcore.linear.sheet_factor import SheetFactor
from knitcore.yarn.kernels.rod import rod_hessian
from knitcore.yarn.kernels.scatter import scatter_local
from knitcore.yarn.kernels.tiles import one_tile
from knitcore.yarn.library.yarns import yarn_for
from knitcore.yarn.model.cell import plain_cell
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.start_shape import start_state
from knitcore.yarn.solve.clasps import knitted_code
from knitcore.yarn.solve.splines import COARSE
from knitcore.yarn.study.bending import repeat_bending
from knitcore.yarn.study.hysteresis import hysteresis
from knitcore.yarn.study.whole_chart import relax_whole

CHART = StitchChart.parse("K/P")
ACRYLIC = material("acrylic")


def yarn() -> None:
    """Yarn that is free, bent, rubbed or in a whole piece: all of them share most kernels."""
    used = yarn_for(ACRYLIC, CHART)
    repeat_bending(relax(CHART, used.yarn, used.loop_length_mm))
    mirrored = relax(CHART, used.yarn, used.loop_length_mm, branch="mirrored")
    hysteresis(mirrored, "course", 0.1, 0.2, points=2, cycles=1)
    relax_whole(CHART.tile(6, 3), used.yarn, used.loop_length_mm, tolerance=0.1, rounds=2)


def published() -> None:
    """Yarn in the paper's own description."""
    used = yarn_for(ACRYLIC, CHART)
    relax(CHART, used.yarn, used.loop_length_mm, branch="published")


def cloth() -> None:
    """Swatches."""
    curve(CHART, ACRYLIC, "course")
    strip_test(CHART.tile(4, 8), ACRYLIC, "course", 0.05, steps=1)


def shape() -> None:
    """Sheets in space."""
    curl(CHART.tile(3, 6), ACRYLIC)


TASKS: tuple[Callable[[], None], ...] = (yarn, published, shape, cloth)


def latter_half(module: str) -> None:
    """Compile what a study needs last, while another process compiles what it needs first.

    numba compiles on one core only. ``module`` is where the other process has begun.
    """
    for room, functions in (
        ("knitcore.yarn", _last_of_yarn),
        ("knitcore.cloth.space", _last_of_shape),
    ):
        if module.startswith(room):
            functions()


def _last_of_shape() -> None:
    SheetFactor(scipy.sparse.bsr_matrix(np.eye(12), blocksize=(3, 3)), columns=2).solve(np.ones(12))


def _last_of_yarn() -> None:
    used = yarn_for(ACRYLIC, CHART)
    cell = plain_cell(CHART, COARSE)
    lengths = np.full(cell.rows, used.loop_length_mm)
    energy = CellEnergy(cell, used.yarn, lengths, Convention.PUBLISHED)
    state = start_state(cell, used.loop_length_mm, used.yarn.radius_mm)
    curve = energy.curve(state)
    still, tension = np.zeros(len(curve)), np.zeros(len(lengths))
    along = curve, energy.rod_law, energy.speeds, tension[energy.stretch_of], still
    slopes, local = rod_hessian(*along)
    energy.gathered(np.zeros((len(curve), 3)), slopes)
    matrix, sizes = one_tile(cell.unknowns), np.zeros((2, cell.unknowns))
    nothing = np.zeros((len(curve), 3, 3))
    scatter_local(local, nothing, nothing, cell.layout, matrix.tiles, matrix.where, sizes)
    factor = np.eye(2)
    eliminate(factor)
    substitute(factor, np.eye(2))
    solved(np.eye(2), np.ones(2))
    product(factor, factor)
    times(factor, np.ones(2))
    knitted_code(CHART)
    energy.along_yarn(curve, tension, still)


def warm_up() -> Iterator[str]:
    """Run the tasks, as many at a time as there are processors; their names as they end."""
    with ProcessPoolExecutor() as pool:
        running = {pool.submit(task): task.__name__ for task in TASKS}
        for ended in as_completed(running):
            ended.result()
            yield running[ended]


if __name__ == "__main__":
    latter_half(sys.argv[1])
