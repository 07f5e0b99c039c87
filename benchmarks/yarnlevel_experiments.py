"""The spline yarn model against the 16 moduli of acrylic and cotton that the paper measured.

One convention for all, chosen before the comparison: energy ``published``; bending modulus,
contact law and loop length as measured; the radius half the diameter measured in that fabric; the
core radius of Supplementary Table 7 (not measured); branch ``mirrored``, no slide quenching;
the law fitted over the range of stress of the experiment in that fabric and direction (medians of
the pulls in the published acrylic records; cotton's are not public and take the same).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from knitcore.chart import StitchChart
from knitcore.fabric import Direction, Fabric
from knitcore.materials import material
from knitcore.yarnlevel.relax import relax
from knitcore.yarnlevel.results import Sweep
from knitcore.yarnlevel.samples import Sample, load_samples
from knitcore.yarnlevel.sweep import sweep
from knitcore.yarnlibrary.lawfit import fit_sweeps

RANGE_N_PER_MM = {
    Fabric.STOCKINETTE: (0.445, 0.313),
    Fabric.GARTER: (0.764, 0.243),
    Fabric.RIB: (0.290, 0.351),
    Fabric.SEED: (0.449, 0.204),
}
"""Largest stress course-wise and wale-wise, medians of the pulls of the acrylic samples."""
_FAR = {Direction.COURSE: 3.5, Direction.WALE: 2.5}
_POINTS = {Direction.COURSE: 90, Direction.WALE: 70}


def as_measured(sample: Sample) -> Sample:
    """The sample with its radius half the diameter measured in the fabric."""
    diameter = material(sample.yarn_id).yarn_diameter_mm(sample.fabric)
    if diameter is None:
        return sample
    return replace(sample, yarn=replace(sample.yarn, radius_mm=0.5 * diameter))


def moduli(sample: Sample) -> tuple[float, float]:
    """Simulated moduli of a sample, course and wale, N/mm."""
    zero = relax(
        StitchChart.of_fabric(sample.fabric, 2, 2),
        sample.yarn,
        sample.loop_length_mm,
        branch="mirrored",
    )
    curves: dict[Direction, Sweep] = {}
    for direction, most in zip(Direction, RANGE_N_PER_MM[sample.fabric], strict=True):
        curve = sweep(
            zero, direction, _FAR[direction], points=_POINTS[direction],
            max_stress_n_per_mm=most,
        )  # fmt: skip
        inside = np.flatnonzero(curve.stress_n_per_mm > most)
        end = int(inside[0]) if len(inside) else len(curve.cells)
        curves[direction] = replace(
            curve, cells=curve.cells[:end], stress_n_per_mm=curve.stress_n_per_mm[:end]
        )
    law = fit_sweeps(curves[Direction.COURSE], curves[Direction.WALE], np.inf).law
    return law.modulus_course, law.modulus_wale


def main() -> None:
    """Print the comparison."""
    print("| sample | Y_x | measured | ratio | Y_y | measured | ratio |")
    print("|---|---|---|---|---|---|---|")
    ratios = []
    for sample in map(as_measured, load_samples()):
        law = material(f"{sample.yarn_id}:published").law(sample.fabric)
        cells = []
        for found, known in zip(
            moduli(sample), (law.modulus_course, law.modulus_wale), strict=True
        ):
            ratios.append(found / known)
            cells += [f"{found:.3f}", f"{known:.3f}", f"{ratios[-1]:.2f}"]
        print(f"| {sample.yarn_id} {sample.fabric} | " + " | ".join(cells) + " |", flush=True)
    logs = np.log(ratios)
    print(
        f"rms factor {np.exp(np.sqrt(np.mean(logs**2))):.2f}, "
        f"worst {np.exp(np.abs(logs).max()):.2f} "
        "(the paper's simulation: 2.16, worst 4.4)"
    )


if __name__ == "__main__":
    main()
