"""Draw the figure of docs/yarn-level.md: python docs/figures/draw_hysteresis.py."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from docs.figures.measure_figures import COLOURS, Plot
from knitcore.chart import StitchChart
from knitcore.fabric import Fabric
from knitcore.yarnlevel.hysteresis import hysteresis
from knitcore.yarnlevel.relax import relax
from knitcore.yarnlevel.samples import sample

FABRICS = (Fabric.STOCKINETTE, Fabric.GARTER, Fabric.RIB, Fabric.SEED)
COEFFICIENT, STRAIN, TOP_N_PER_MM = 0.26, 0.5, 0.2


def main() -> None:
    plot = Plot((0.0, STRAIN), (0.0, TOP_N_PER_MM), ("strain along the rows", "stress, N/mm"))
    for fabric in FABRICS:
        entry = sample("acrylic", fabric)
        chart = StitchChart.of_fabric(fabric, 2, 2)
        rest = relax(chart, entry.yarn, entry.loop_length_mm, branch="mirrored")
        for friction, dash in ((COEFFICIENT, ""), (0.0, "2 4")):
            loop = hysteresis(rest, "course", STRAIN, friction, cycles=2 if friction else 1)
            for leg in loop.legs if friction else loop.legs[:1]:
                plot.line(leg.strain, leg.stress_n_per_mm, COLOURS[fabric], dash, width=1.5)
            if friction:
                print(
                    f"{fabric}: {loop.lost_share:.0%} lost, strain {loop.left_strain:.3f} left, "
                    f"closes within {loop.closes_within:.1%}"
                )
    for place, fabric in enumerate(FABRICS):
        plot.text(0.02, TOP_N_PER_MM * (0.95 - 0.07 * place), str(fabric), COLOURS[fabric])
    plot.save("hysteresis.svg")


if __name__ == "__main__":
    main()
