"""Strips of the yarn level's fabrics in the acrylic stretch tests: strain at equal stress.

    python -m benchmarks.yarnlevel_strips FOLDER [--friction 0.26 [--as-tested]] [--draws 40]
        [--specimens 10]

FOLDER holds the authors' acrylic tests. Each fabric is relaxed and pulled at the yarn level with
the yarn as measured in it (the convention of ``yarnlevel_experiments.py``), at several widths.
These pulls are the cloth of a strip of the measured size between its clamps
(``pulled_cloth.py``), and the strains at which strip and test carry the same stress are compared;
nothing measured on the fabric is fed in, and no law is fitted. Waists are compared at the strains
at which the test carries these stresses.

``--friction`` pulls the yarn with friction, from its relaxed shape; 0.26 is the library's default.
``--as-tested`` first does what the authors did: a whole test before those that count, then a pull
across it that brings the fabric back to its length.
``--draws`` repeats the comparison with loop length and diameter of each fabric, bending modulus and
contact stiffness drawn from their printed scatter, as that of a mean over ``--specimens`` (1: of a
single stitch or length of yarn).
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.pulled_cloth import (
    CELLS,
    SHARES,
    TOP_N_PER_MM,
    PulledCloth,
    Reading,
    Strip,
)
from benchmarks.true_to_tests import strips
from benchmarks.yarnlevel_experiments import _FAR, _POINTS, as_measured
from knitcore.arrays import Array
from knitcore.chart import StitchChart
from knitcore.errors import ConvergenceError, KnitcoreError, UnravelledError
from knitcore.fabric import Direction, Fabric
from knitcore.law.constitutive import DEFAULT_SHEAR_MODULUS_N_PER_MM
from knitcore.swatch.measured_strip import MeasuredStrip
from knitcore.yarnlevel.bending import bending_response
from knitcore.yarnlevel.friction import RubbedCell, agitated
from knitcore.yarnlevel.hysteresis import MAX_STRIDES, RubbedStretch
from knitcore.yarnlevel.relax import relax
from knitcore.yarnlevel.samples import Sample, sample
from knitcore.yarnlevel.splines import RelaxedRepeat

STRESSES = np.array([0.05, 0.1, 0.2, 0.3])
OUTLIER = f"{Fabric.SEED} along the {Direction.COURSE}"
_STRIDE = 0.02
"""Steps of the pulls before a test, in strain."""
LEVELS = 60
"""Strains of a strip up to the largest of the free pull."""
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


@dataclass(frozen=True, eq=False)
class Comparison:
    """A simulated strip beside its test, at each stress; NaN where one of them does not reach it.

    Attributes
    ----------
    ratio : simulated over measured strain.
    waist, measured_waist : strain across, at the strain at which the test carries the stress.
    """

    ratio: Array
    waist: Array
    measured_waist: Array


def shear_modulus(relaxed: RelaxedRepeat) -> float:
    """Of the yarn level, N/mm; the library's default where the state has no positive one."""
    try:
        found = bending_response(relaxed).shear_modulus_n_per_mm
    except (ConvergenceError, UnravelledError):
        found = None
    return found if found is not None and found > 0.0 else DEFAULT_SHEAR_MODULUS_N_PER_MM


def compared(
    begin: RelaxedRepeat | RubbedCell, shear: float, strip: MeasuredStrip, friction: float,
    *, shares: tuple[float, ...] = SHARES, refined: int = 1, cells: int = CELLS,
) -> Comparison:  # fmt: skip
    """The strip of a simulated fabric beside its test; ``refined`` divides the steps of pulls."""
    assert strip.length_mm is not None
    along = strip.direction
    far, points = _FAR[along], refined * (_POINTS[along] - 1) + 1
    cloth = PulledCloth.of_yarn(
        begin, along, friction, shear, max_strain=far, points=points, shares=shares
    )
    stress, waist = strip.means
    known = np.isfinite(stress)
    wanted = np.where(stress[known].max() >= STRESSES, STRESSES, np.nan)
    at = np.interp(wanted, stress[known], strip.strain[known])
    simulated = Strip(
        cloth, strip.length_mm, strip.width_mm, across_mm=strip.across_mm, cells=cells
    )
    readings = [Reading(0.0, 0.0, 0.0)]
    for reading in simulated.pull(np.linspace(0.0, cloth.longest, LEVELS + 1)[1:]):
        readings.append(reading)
        if reading.stress_n_per_mm > STRESSES[-1] and reading.strain > np.nanmax(at):
            break
    strain, carried, narrowing = np.array(readings).T
    return Comparison(
        np.interp(wanted, carried, strain, right=np.nan) / at,
        np.interp(at, strain, narrowing, right=np.nan),
        np.interp(at, strip.strain[known], waist[known]),
    )


def as_tested(relaxed: RelaxedRepeat, along: Direction, friction: float) -> RubbedCell:
    """The fabric free of force after a whole test along a direction, and after a pull across that
    brings it back to its length.
    """
    length, width = relaxed.cell_mm(along), relaxed.cell_mm(along.other)
    test = RubbedStretch(agitated(relaxed), along, friction)
    for step in range(1, MAX_STRIDES):
        try:
            pulled = test.reach((), length * (1.0 + _STRIDE * step))
        except (ConvergenceError, UnravelledError):
            break  # the yarn locks: the test cannot have gone further
        if pulled.force_n[along.axis] > TOP_N_PER_MM * width:
            break
    left = _released(test, _STRIDE * length)
    reset = RubbedStretch(left, along.other, friction)
    here = left.cell.cell_mm(along.other)
    for step in range(1, MAX_STRIDES):
        reset.reach((), here + _STRIDE * width * step)
        left = _released(replace(reset), _STRIDE * width)
        if left.cell.cell_mm(along) <= length:
            break
    return left


def _released(stretch: RubbedStretch, stride_mm: float) -> RubbedCell:
    for _ in stretch.release(stride_mm):
        pass
    return stretch.state


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
    parser.add_argument("--as-tested", action="store_true")
    asked = parser.parse_args()
    if asked.as_tested and not asked.friction:
        parser.error("--as-tested: without friction the past leaves no trace. Give --friction.")
    tests = {fabric: strips(asked.folder, fabric) for fabric in Fabric}
    printed = {fabric: as_measured(sample("acrylic", fabric)) for fabric in Fabric}
    print("simulated over measured strain at", ", ".join(map(str, STRESSES)), "N/mm")
    names = [f"{fabric} along the {strip.direction}" for fabric in tests for strip in tests[fabric]]
    rows = compared_all(printed, tests, asked.friction, tested=asked.as_tested)
    for name, row in zip(names, rows, strict=True):
        waists = f"waist {_shown(row.waist)}, measured {_shown(row.measured_waist)}"
        print(f"  {name}: {_shown(row.ratio)}; {waists}")
    ratios = np.array([row.ratio for row in rows])
    print("rms factor:", _shown(rms_factor(ratios)))
    others = np.array(names) != OUTLIER
    print(f"without {OUTLIER}:", _shown(rms_factor(ratios[others])), flush=True)
    rng = np.random.default_rng(20)
    draws, failed = [], 0
    for _ in range(asked.draws):
        shared = rng.standard_normal(2)
        entries = {
            fabric: drawn(entry, rng, shared, asked.specimens) for fabric, entry in printed.items()
        }
        try:
            rows = compared_all(entries, tests, asked.friction, tested=asked.as_tested)
        except KnitcoreError:
            failed += 1
        else:
            draws.append([row.ratio for row in rows])
    if draws:
        print(f"90 % of {len(draws)} draws of the inputs ({failed} more did not relax):")
        for name, own in zip(names, np.swapaxes(draws, 0, 1), strict=True):
            ends = intervals(np.asarray(own))
            inside = int(np.sum((ends[0] <= 1.0) & (ends[1] >= 1.0)))
            known = int(np.isfinite(ends[0]).sum())
            print(f"  {name}: {_spans(ends)}; 1 lies inside {inside} of {known}")
        for name, which in (("rms factor", others | True), (f"without {OUTLIER}", others)):
            factors = [rms_factor(np.array(draw)[which]) for draw in draws]
            print(f"{name}: {_spans(intervals(np.array(factors)))}")


def compared_all(
    entries: dict[Fabric, Sample], tests: dict[Fabric, list[MeasuredStrip]], friction: float,
    *, tested: bool,
) -> list[Comparison]:  # fmt: skip
    """Every test."""
    found = []
    for fabric, entry in entries.items():
        chart = StitchChart.of_fabric(fabric, 2, 2)
        relaxed = relax(chart, entry.yarn, entry.loop_length_mm, branch="mirrored")
        shear = shear_modulus(relaxed)
        for strip in tests[fabric]:
            begin = as_tested(relaxed, strip.direction, friction) if tested else relaxed
            found.append(compared(begin, shear, strip, friction))
    return found


def intervals(draws: Array) -> Array:
    """(2, stresses): ends of the 90 % interval; NaN where fewer than 90 % reach the stress."""
    often = np.isfinite(draws).mean(axis=0) >= 0.9
    ends = np.nanquantile(np.where(often, draws, 0.0), [0.05, 0.95], axis=0)
    return np.asarray(np.where(often, ends, np.nan))


def _shown(values: Array) -> str:
    return ", ".join(f"{value:.2f}" for value in values)


def _spans(ends: Array) -> str:
    return ", ".join(f"{low:.2f} to {high:.2f}" for low, high in ends.T)


if __name__ == "__main__":
    main()
