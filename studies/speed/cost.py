"""How CPU time grows with the number of stitches: seconds over two decades, exponent and limit.

python -m studies.speed.cost
"""

import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from knitcore import StitchChart, predict
from knitcore.cloth.flat import strip_test
from knitcore.cloth.space.curl import curl
from knitcore.materials import material
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.study.relax import relax

ACRYLIC = material("acrylic")
YARN = sample("acrylic", "stockinette")


def relaxed(chart: StitchChart) -> object:
    return relax(chart, YARN.yarn, YARN.loop_length_mm, branch="mirrored")


WORK: dict[str, tuple[Callable[[StitchChart], Any], tuple[int, ...], str]] = {
    "predict": (
        partial(predict, material=ACRYLIC),
        (40, 80, 160, 400),
        "patches, up to 64; then memory",
    ),
    "stretch, 5 steps": (
        lambda chart: strip_test(chart, ACRYLIC, "wale", 0.3, steps=5),
        (20, 40, 80, 200),
        "flops of the factor, n^1.5",
    ),
    "curl": (lambda chart: curl(chart, ACRYLIC), (8, 16, 32, 80), "steps and flops of the factor"),
    "relax": (relaxed, (1, 2, 4, 10), "pairs of yarn in contact, and steps"),
}


def main() -> None:
    for name, (work, sides, limit) in WORK.items():
        work(StitchChart.parse("KKP/PPK/KPK"))  # compiles
        spent = []
        for side in sides:
            chart = StitchChart(np.random.default_rng(1).random((side, side)) < 0.5)
            begin = time.process_time()
            work(chart)
            spent.append(time.process_time() - begin)
        exponent, _ = np.polyfit(2 * np.log(sides), np.log(spent), 1)
        times = ", ".join(f"{s} x {s} {t:.3g} s" for s, t in zip(sides, spent, strict=True))
        print(f"{name:18} n^{exponent:.2f}: {times}; limit: {limit}", flush=True)


if __name__ == "__main__":
    main()
