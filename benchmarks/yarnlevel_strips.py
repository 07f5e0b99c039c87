"""Strips of the yarn level's fabrics in the acrylic stretch tests: strain at equal stress.

    python -m benchmarks.yarnlevel_strips FOLDER [--friction 0.26] [--draws 40] [--specimens 10]

FOLDER holds the authors' acrylic tests. Each fabric is relaxed and stretched at the yarn level with
the yarn as measured in it (the convention of ``yarnlevel_experiments.py``). Its law goes into a
strip of the measured size between its clamps, and the strains at which strip and test carry the
same stress are compared; nothing measured on the fabric is fed in.

``--friction`` pulls the yarn with friction, from its relaxed shape; 0.26 is the library's default.
``--draws`` repeats the comparison with loop length and diameter of each fabric, bending modulus and
contact stiffness drawn from their printed scatter, as that of a mean over ``--specimens`` (1: of a
single stitch or length of yarn).
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.true_to_tests import strips
from benchmarks.yarnlevel_experiments import _FAR, _POINTS, as_measured
from knitcore.arrays import Array
from knitcore.chart import StitchChart
from knitcore.errors import KnitcoreError
from knitcore.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.swatch.measured_strip import MeasuredStrip
from knitcore.yarnlevel.hysteresis import pull
from knitcore.yarnlevel.relax import relax
from knitcore.yarnlevel.samples import Sample, sample
from knitcore.yarnlevel.sweep import sweep
from knitcore.yarnlibrary.lawfit import fit_sweeps

STRESSES = np.array([0.05, 0.1, 0.2, 0.3])
FITTED_TO_N_PER_MM = 0.33
BENDING_LOG_SD, CONTACT_LOG_SD = 5.96 / 45.15, 0.10 / 0.62
"""Of the acrylic yarn (Supplementary Table 4)."""
LOOP_LOG_SD = {
    Fabric.STOCKINETTE: 0.62 / 11.28, Fabric.GARTER: 0.27 / 10.55,
    Fabric.RIB: 1.58 / 16.10, Fabric.SEED: 0.76 / 15.67,
}  # fmt: skip
DIAMETER_LOG_SD = {
    Fabric.STOCKINETTE: 0.11 / 1.47, Fabric.GARTER: 0.10 / 2.07,
    Fabric.RIB: 0.15 / 2.35, Fabric.SEED: 0.12 / 2.39,
}  # fmt: skip
"""Of the machine-knit samples (Supplementary Table 2)."""


def yarn_law(entry: Sample, friction: float) -> ConstitutiveLaw:
    """The law of a simulated fabric."""
    zero = relax(StitchChart.of_fabric(entry.fabric, 2, 2), entry.yarn, entry.loop_length_mm)
    pulled = partial(pull, coefficient=friction) if friction else sweep
    course, wale = (
        pulled(
            zero, direction, _FAR[direction], points=_POINTS[direction],
            max_stress_n_per_mm=FITTED_TO_N_PER_MM,
        )
        for direction in Direction
    )  # fmt: skip
    return fit_sweeps(course, wale, FITTED_TO_N_PER_MM).law


def strain_ratio(law: ConstitutiveLaw, strip: MeasuredStrip) -> Array:
    """Simulated over measured strain at each stress; NaN where one of the two does not reach it."""
    measured, _ = strip.means
    known = np.isfinite(measured)
    wanted = np.where(measured[known].max() >= STRESSES, STRESSES, np.nan)
    at = np.interp(wanted, measured[known], strip.strain[known])
    levels = np.linspace(0.02, 0.97, 24) * law.lock_up_strain(strip.direction)
    stress, _ = strip.simulate(law, levels)
    reached = np.isfinite(stress)
    found = np.interp(
        wanted, np.r_[0.0, stress[reached]], np.r_[0.0, levels[reached]], right=np.nan
    )
    return np.asarray(found / at)


def drawn(entry: Sample, rng: np.random.Generator, shared: Array, specimens: int) -> Sample:
    """A sample whose inputs lie where their scatter allows them to."""
    own = rng.standard_normal(2) / np.sqrt(specimens)
    yarn, common = entry.yarn, shared / np.sqrt(specimens)
    radius = yarn.radius_mm * np.exp(DIAMETER_LOG_SD[entry.fabric] * own[1])
    return replace(
        entry,
        loop_length_mm=entry.loop_length_mm * float(np.exp(LOOP_LOG_SD[entry.fabric] * own[0])),
        yarn=replace(
            yarn,
            radius_mm=float(radius),
            bending_modulus_n_mm2=yarn.bending_modulus_n_mm2
            * float(np.exp(BENDING_LOG_SD * common[0])),
            contact_stiffness_n_per_mm3=yarn.contact_stiffness_n_per_mm3
            * float(np.exp(CONTACT_LOG_SD * common[1])),
        ),
    )


def rms_factor(ratios: Array) -> Array:
    """Over the tests, at each stress."""
    return np.asarray(np.exp(np.sqrt(np.nanmean(np.log(ratios) ** 2, axis=0))))


def main() -> None:
    """Print the comparison."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--friction", type=float, default=0.0)
    parser.add_argument("--draws", type=int, default=0)
    parser.add_argument("--specimens", type=int, default=10)
    asked = parser.parse_args()
    tests = {fabric: strips(asked.folder, fabric) for fabric in Fabric}
    printed = {fabric: as_measured(sample("acrylic", fabric)) for fabric in Fabric}
    print("simulated over measured strain at", ", ".join(map(str, STRESSES)), "N/mm")
    ratios = strain_ratios(printed, tests, asked.friction)
    names = [f"{fabric} along the {strip.direction}" for fabric in tests for strip in tests[fabric]]
    for name, row in zip(names, ratios, strict=True):
        print(f"  {name}: {_shown(row)}")
    print("rms factor:", _shown(rms_factor(ratios)), flush=True)
    rng = np.random.default_rng(20)
    draws, failed = [], 0
    for _ in range(asked.draws):
        shared = rng.standard_normal(2)
        entries = {
            fabric: drawn(entry, rng, shared, asked.specimens) for fabric, entry in printed.items()
        }
        try:
            draws.append(strain_ratios(entries, tests, asked.friction))
        except KnitcoreError:
            failed += 1
    if draws:
        print(f"90 % of {len(draws)} draws of the inputs ({failed} more gave no law):")
        for name, own in zip(names, np.swapaxes(draws, 0, 1), strict=True):
            ends = intervals(own)
            inside = int(np.sum((ends[0] <= 1.0) & (ends[1] >= 1.0)))
            known = int(np.isfinite(ends[0]).sum())
            print(f"  {name}: {_spans(ends)}; 1 lies inside {inside} of {known}")
        print("rms factor:", _spans(intervals(np.array([rms_factor(draw) for draw in draws]))))


def strain_ratios(
    entries: dict[Fabric, Sample], tests: dict[Fabric, list[MeasuredStrip]], friction: float
) -> Array:
    """(tests, stresses): simulated over measured strain."""
    return np.array(
        [
            strain_ratio(law, strip)
            for fabric, entry in entries.items()
            for law in [yarn_law(entry, friction)]
            for strip in tests[fabric]
        ]
    )


def intervals(draws: Array) -> Array:
    """(2, stresses): ends of the 90 % interval; NaN where not all draws reach the stress."""
    return np.asarray(np.quantile(draws, [0.05, 0.95], axis=0))


def _shown(values: Array) -> str:
    return ", ".join(f"{value:.2f}" for value in values)


def _spans(ends: Array) -> str:
    return ", ".join(f"{low:.2f} to {high:.2f}" for low, high in ends.T)


if __name__ == "__main__":
    main()
