"""Compile numba's kernels before somebody waits for them (``make`` does so beside its other work).

Each calculation is small; the machine code that it needs stays beside the sources.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from typing import Literal

from knitcore import StitchChart, curve, material, relax, strip_test
from knitcore.shell.curl import curl
from knitcore.yarnlevel.hysteresis import hysteresis
from knitcore.yarnlevel.relax import RelaxedRepeat
from knitcore.yarnlibrary.yarns import yarn_for

CHART = StitchChart.parse("K/P")
ACRYLIC = material("acrylic")


def _yarn(branch: Literal["free", "mirrored"]) -> RelaxedRepeat:
    used = yarn_for(ACRYLIC, CHART)
    return relax(CHART, used.yarn, used.loop_length_mm, branch=branch)


def free() -> None:
    """The yarn-level solver, without and with friction."""
    _yarn("free")
    hysteresis(_yarn("mirrored"), "course", 0.1, 0.2, points=2, cycles=1)


def published() -> None:
    """The yarn-level solver of the paper."""
    used = yarn_for(ACRYLIC, CHART)
    relax(CHART, used.yarn, used.loop_length_mm, branch="published")


def cloth() -> None:
    """The swatch solver."""
    curve(CHART, ACRYLIC, "course")
    strip_test(CHART.tile(4, 8), ACRYLIC, "course", 0.05, steps=1)


def shape() -> None:
    """The solver of sheets in space."""
    curl(CHART.tile(3, 6), ACRYLIC)


TASKS: tuple[Callable[[], None], ...] = (free, published, shape, cloth)


if __name__ == "__main__":
    with ProcessPoolExecutor() as pool:
        for task in [pool.submit(task) for task in TASKS]:
            task.result()
