"""Swatch solver: CPU time of the paper's demonstration, and of charts of four mixed fabrics.

    python -m studies.speed.swatch [--large]

``--large`` adds the 200x200 crossed mesh and charts of 200x200 and 400x400 stitches (minutes).
"""

import resource
import sys
import time

import numpy as np

from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.flat import EnergyModel, QuarterGrid, Sheet, SheetModel, pull, strip_test
from knitcore.cloth.flat.strip import load_levels
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import material

SCRIPT = ConstitutiveLaw(
    0.240872, 0.0599528, 0.0362245, 0.0362245, 1.16995, 0.802057, 0.0223765, 0.0219965, 0.01
)
"""Constants of the authors' finite-element script."""
TARGET_SECONDS = {100: 1.0, 200: 4.0, 400: 20.0}


def published(cells: int) -> tuple[float, float]:
    """CPU seconds and energy of 20 load steps to 0.75 on a crossed mesh.

    The seconds are those of the thread that has more to do: the time on two free cores.
    """
    begin = time.thread_time()
    sheet = Sheet(
        QuarterGrid.uniform(cells, cells, 3.15, 1.0), [SCRIPT], SheetModel(EnergyModel.PUBLISHED)
    )
    test = pull(sheet, Direction.WALE, load_levels(0.75, 20))
    return time.thread_time() - begin, float(test.energy_n_mm[-1])


def four_fabrics(side: int) -> StitchChart:
    """Quadrants of stockinette, garter, rib and seed."""
    half = side // 2
    row, column = np.mgrid[0:half, 0:half]
    plain, garter = np.zeros((half, half), bool), row % 2 == 1
    rib, seed = column % 2 == 1, (row + column) % 2 == 1
    return StitchChart(np.block([[plain, garter], [rib, seed]]))


def main() -> None:
    large = "--large" in sys.argv
    meshes = [50, 100, 200] if large else [50, 100]
    published(8)  # compiles
    strip_test(four_fabrics(6), material("acrylic"), "wale", 0.3, steps=2)
    print("published model, 20 load steps to 0.75, CPU seconds of the busier thread")
    for cells in meshes:
        seconds, energy = published(cells)
        print(f"  {cells:4d}^2 crossed  {seconds:7.2f} s  energy {energy:.13f}", flush=True)
    print("full model, four mixed fabrics, stretch 0.30 in 5 steps")
    for side in [100, 200, 400] if large else [100]:
        for direction in Direction:
            own, cpu = time.thread_time(), time.process_time()
            test = strip_test(four_fabrics(side), material("acrylic"), direction, 0.3, steps=5)
            own, cpu = time.thread_time() - own, time.process_time() - cpu
            memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
            print(
                f"  {side}x{side} {direction:6}  CPU {cpu:6.2f} s  busier thread {own:6.2f} s "
                f"(target {TARGET_SECONDS[side]:g})  {test.dofs} dofs  {memory:.1f} GB so far  "
                f"{'converged' if test.converged else test.problem}",
                flush=True,
            )


if __name__ == "__main__":
    main()
