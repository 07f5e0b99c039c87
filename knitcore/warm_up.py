"""Compile the kernels of all kinds of calculations before somebody waits for them.

Each calculation is small; numba keeps the machine code that it needs.
"""

from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed

from knitcore import StitchChart, curve, material, relax, strip_test
from knitcore.cloth.space.curl import curl
from knitcore.yarn.library.yarns import yarn_for
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


def warm_up() -> Iterator[str]:
    """Run the tasks, as many at a time as there are processors; their names as they end."""
    with ProcessPoolExecutor() as pool:
        running = {pool.submit(task): task.__name__ for task in TASKS}
        for ended in as_completed(running):
            ended.result()
            yield running[ended]
