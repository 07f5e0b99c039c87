"""CPU seconds of relaxations and sweeps at the yarn level, with their targets.

    python -m studies.speed.yarn [--sides 1 2 4 8 16] [--charts 3] [--cells-only] [--whole 12]

Run with OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1: idle threads of the linear algebra would count
as CPU time. The authors' public code, unmodified, needs about 250 CPU seconds for one point of one
fabric.
"""

import argparse
import resource
import time

import numpy as np

from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.loops.relaxed_stitches import relax_stitches
from knitcore.yarn.model.paper_samples import load_samples, sample
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.growth import Start
from knitcore.yarn.solve.splines import ROUGH_FROM
from knitcore.yarn.study.relax import relax
from knitcore.yarn.study.sweep import sweep
from knitcore.yarn.study.whole_stitches import relax_whole_stitches

AUTHORS_POINT_S = 250.0
FAR = {
    Fabric.STOCKINETTE: (0.9, 0.5),
    Fabric.GARTER: (1.0, 1.6),
    Fabric.RIB: (3.0, 0.8),
    Fabric.SEED: (1.2, 1.4),
}
YARN = YarnModel(0.045, 6e-4, 2.4, 0.74, 0.30)
LOOP_MM = 11.28
LIMITS_S = {1: 0.04, 2: 0.2, 4: 1.0, 8: 8.0, 16: 60.0}
ROPE = "PKKKKP;P[2/2R]P;PKKKKP;PKKKKP"
REPEATS = {
    "lace of 12": ("KKKKKK;KO/\\OK", 2.5),
    "cable rope of 16": ("[2/2L];KKKK;KKKK;KKKK", 4.0),
    "cable rope of 24": (ROPE, 9.0),
    "feather and fan of 18": ("//OOOO\\\\K;KKKKKKKKK", 9.0),
    "slip mosaic of 16": ("KKKK;VKVK;KKKK;KVKV", 3.0),
    "fisherman's rib of 8": ("TP;KP;PT;PK", 2.0),
}
"""Repeats of other stitches, and their limits in CPU seconds."""
STITCH_LIMIT_S, SWEEP_LIMIT_S, SWEEPS_LIMIT_S = 0.15, 4.0, 90.0


def against(value: float, limit: float, unit: str = "s") -> str:
    """A value, its limit and whether it is within it."""
    return f"{value:.4g} {unit} (limit {limit:g}: {'kept' if value <= limit else 'MISSED'})"


def stitches() -> None:
    """One stitch and its stretches for each of the eight samples."""
    print("one stitch, two starts, polished on the fine grid; 25-point sweeps there and back")
    print(f"{'sample':24}{'relax s':>9}{'x authors':>11}{'course s':>10}{'wale s':>8}{'N·mm':>9}")
    total = slowest = longest = 0.0
    for entry in load_samples():
        zero = relax(
            StitchChart.of_fabric(entry.fabric, 2, 2),
            entry.yarn,
            entry.loop_length_mm,
            branch="mirrored",
        )
        times = []
        for direction, far in zip(Direction, FAR[entry.fabric], strict=True):
            began = time.process_time()
            sweep(zero, direction, far, points=25)
            times.append(time.process_time() - began)
        total, slowest = total + sum(times), max(slowest, zero.seconds)
        longest = max(longest, *times)
        name, ratio = f"{entry.fabric} {entry.yarn_id}", AUTHORS_POINT_S / zero.seconds
        print(
            f"{name:24}{zero.seconds:9.3f}{ratio:11.0f}{times[0]:10.2f}{times[1]:8.2f}"
            f"{zero.energy_n_mm:9.4f}"
        )
    print("slowest stitch:", against(slowest, STITCH_LIMIT_S))
    print("longest sweep:", against(longest, SWEEP_LIMIT_S))
    print("all 16 sweeps:", against(total, SWEEPS_LIMIT_S))


def cells(sides: list[int], charts: int) -> None:
    """Cells of random knits and purls in both yarns: CPU and wall seconds.

    Small cells have one start, of the two that are usual.
    """
    print("cells of random K and P, from the first shape to the tolerance")
    print(f"{'cell':9}{'yarn':9}{'chart':>6}{'CPU s':>9}{'s/stitch':>10}{'wall s':>9}{'N·mm':>10}")
    for side in sides:
        times = []
        for seed in range(1, charts + 1):
            chart = StitchChart(np.random.default_rng(seed).random((side, side)) < 0.5)
            for name in ("acrylic", "cotton"):
                entry = sample(name, "stockinette")
                began = time.perf_counter()
                usual = [Start("usual")] if chart.stitches < ROUGH_FROM else None
                shape = relax(
                    chart, entry.yarn, entry.loop_length_mm, starts=usual, branch="mirrored"
                )
                wall = time.perf_counter() - began
                times.append(shape.seconds)
                state = "" if shape.converged else "  not converged"
                print(
                    f"{f'{side} x {side}':9}{name:9}{seed:6}{shape.seconds:9.3f}"
                    f"{shape.seconds / side**2:10.3f}{wall:9.3f}{shape.energy_n_mm:10.6f}{state}",
                    flush=True,
                )
        limit = LIMITS_S.get(side, np.inf)
        print(f"{side} x {side}: median", against(float(np.median(times)), limit))


def repeats() -> None:
    """Repeats of lace, cables, slips and tucks after blocking."""
    print("repeats of other stitches, blocked and let go")
    relax_stitches(SymbolChart.parse("KKKK;KO/K;KKKK"), YARN, LOOP_MM)  # compiles
    for name, (chart, limit) in REPEATS.items():
        cell = relax_stitches(SymbolChart.parse(chart), YARN, LOOP_MM)
        print(f"{name:24}{against(cell.seconds, limit)} {cell.energy_n_mm:.6f} N·mm", flush=True)


def whole_charts(side: int) -> None:
    """Whole charts of ``side`` stitches, a multiple of 12, each way, with and without repeats."""
    rng = np.random.default_rng(2)
    scattered = [
        "K" * side if row % 2 else "".join(rng.choice(["KKKK", "KO/K", "K\\OK"], side // 4))
        for row in range(side)
    ]
    charts = {
        "lace of repeats": SymbolChart.parse("KKKKKK;KO/\\OK").tile(side // 2, side // 6),
        "ropes of repeats": SymbolChart.parse(ROPE).tile(side // 4, side // 6),
        "scattered lace": SymbolChart.parse(";".join(scattered)),
    }
    for name, chart in charts.items():
        whole = relax_whole_stitches(chart, YARN, LOOP_MM)
        most_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(
            f"{name}, {side} x {side}: {whole.seconds:.0f} s, at most {most_mb:.0f} MB", flush=True
        )


def main() -> None:
    """Print everything."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sides", type=int, nargs="*", default=[1, 2, 4, 8])
    parser.add_argument("--charts", type=int, default=3, help="random charts of each size")
    parser.add_argument("--cells-only", action="store_true")
    parser.add_argument("--whole", type=int, help="only whole charts of this many stitches a side")
    options = parser.parse_args()
    if options.whole is not None:
        whole_charts(options.whole)
        return
    relax(StitchChart.parse("K"), YARN, LOOP_MM, branch="mirrored")  # compiles
    relax(StitchChart.parse("KP/KK"), YARN, LOOP_MM, branch="mirrored")
    cells(options.sides, options.charts)
    if options.cells_only:
        return
    stitches()
    repeats()


if __name__ == "__main__":
    main()
