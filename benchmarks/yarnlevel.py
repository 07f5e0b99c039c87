"""CPU times of the yarn level: relaxations, sweeps and cells of several sizes.

Run with OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1: idle threads of the linear algebra would count
as CPU time. The authors' public code, unmodified, needs about 250 CPU seconds for one point of one
fabric.
"""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from knitcore.chart import StitchChart
from knitcore.fabric import Direction, Fabric
from knitcore.yarnlevel.cell import plain_cell
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.growth import Start, grow
from knitcore.yarnlevel.relax import COARSE, relax
from knitcore.yarnlevel.samples import load_samples
from knitcore.yarnlevel.solver import Options
from knitcore.yarnlevel.sweep import sweep
from knitcore.yarnlevel.yarn import YarnModel

AUTHORS_POINT_S = 250.0
FAR = {
    Fabric.STOCKINETTE: (0.9, 0.5),
    Fabric.GARTER: (1.0, 1.6),
    Fabric.RIB: (3.0, 0.8),
    Fabric.SEED: (1.2, 1.4),
}
YARN = YarnModel(0.045, 6e-4, 2.4, 0.74, 0.30)


def main() -> None:
    """Print the table."""
    relax(StitchChart.parse("K"), YARN, 11.28)
    print("one stitch, two starts, polished on the fine grid; 25-point sweeps there and back")
    print(f"{'sample':24}{'relax s':>9}{'x authors':>11}{'course s':>10}{'wale s':>8}")
    total = 0.0
    for sample in load_samples():
        chart = StitchChart.of_fabric(sample.fabric, 2, 2)
        zero = relax(chart, sample.yarn, sample.loop_length_mm)
        times = []
        for direction, far in zip(Direction, FAR[sample.fabric], strict=True):
            began = time.process_time()
            sweep(zero, direction, far, points=25)
            times.append(time.process_time() - began)
        total += sum(times)
        name = f"{sample.fabric} {sample.yarn_id}"
        ratio = AUTHORS_POINT_S / zero.seconds
        print(f"{name:24}{zero.seconds:9.3f}{ratio:11.0f}{times[0]:10.2f}{times[1]:8.2f}")
    print(f"all 16 sweeps: {total:.1f} s")
    print(f"{'random cell, one start':24}{'s':>9}{'steps':>8}{'N·mm a stitch':>16}")
    rng = np.random.default_rng(1)
    for side in (2, 4, 8):
        cell = plain_cell(StitchChart.from_rows(rng.random((side, side)) < 0.5), COARSE)
        began = time.process_time()
        found = grow(
            cell, YARN, np.full(side, 11.28), Convention.AUTHORS_CODE, Start("usual"),
            options=replace(Options(), tolerance=1e-6),
        )  # fmt: skip
        seconds = time.process_time() - began
        energy = found.terms.energy / cell.stitches
        state = "" if found.converged else "  not converged"
        print(f"{f'{side} x {side}':24}{seconds:9.2f}{found.steps:8d}{energy:16.4f}{state}")


if __name__ == "__main__":
    main()
