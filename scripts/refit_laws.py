"""Refit the library's laws to the authors' raw tests, and apply the correction to other yarns.

    python scripts/refit_laws.py --tests FOLDER [--check]

FOLDER holds ``outputData_Acrylic Yarn Garter X.h5`` and the like, from the paper's data
(https://github.com/sabetta/stitch-by-stitch, MIT). Writes ``knitcore/materials/data/refitted.csv``;
``--check`` compares with it instead. Prints the correction, and the errors of laws corrected
without their own raw tests.

A published law gives stress over the strain between the middle of the sample and the lower clamp,
which is ``r`` times the strain from clamp to clamp, and Poisson ratios from straight lines, which
overstate the waist. :class:`ClampCorrection` measures both effects on raw tests, and
:func:`converted` applies them to a law without raw tests.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from knitcore.chart.fabric import Direction, Fabric
from knitcore.fit.measured_strip import MeasuredStrip
from knitcore.fit.pull_fit import Reduction, fit_law
from knitcore.fit.strip_fit import StripFit, fit_strips
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import FabricRecord, Laws, Material, Origin, load_library, load_variants
from knitcore.materials.law_uncertainty import Z_SCORE, CurveUncertainty, LawUncertainty
from knitcore.materials.refitted import COLUMNS, CONSTANTS, CURVE, DEVIATIONS
from knitcore.measure.stretch_test import StretchTest
from knitcore.measure.uniaxial_files import Marks, read_stretch_test

FILE = Path(__file__).parent.parent / "knitcore" / "materials" / "data" / "refitted.csv"
AXES = {Direction.COURSE: "X", Direction.WALE: "Y"}
GARTER_WIDTH_MM = 59.5
"""Acrylic garter course-wise: its file repeats the clamp's size for the width. 31 rows of 1.86 to
2.0 mm make 57 to 62 mm, and at 59.5 mm it ends at the stress of the other tests."""
STRESSES = (0.05, 0.1, 0.2)
SAME_RIG = ("cotton",)
"""Yarns pulled on acrylic's rig; the others were pulled on a testing machine (paper, Methods)."""
Key = tuple[Fabric, Direction]
Array = NDArray[np.float64]
_MIN_HELD = 0.05
"""Least 1 - nu_xy nu_yx at which a converted law stays stable."""


@dataclass(frozen=True)
class ClampCorrection:
    """Ratios between a raw test and its published reduction.

    Attributes
    ----------
    strain_ratio : r, published over clamp-to-clamp strain at the peaks of the pulls.
    waist_ratio : measured waist over the published Poisson ratio times the published strain.
    """

    strain_ratio: float
    waist_ratio: float

    @classmethod
    def of(
        cls, centre: StretchTest, clamps: StretchTest, law: ConstitutiveLaw, direction: Direction
    ) -> ClampCorrection:
        """The ratios from one test, read both ways, and its published law."""
        published = _median(run.strain_along.max() for run in centre.runs)
        held = _median(run.strain_along.max() for run in clamps.runs)
        waist = _median(run.strain_across[np.argmax(run.strain_along)] for run in clamps.runs)
        ratio = law.poisson_yx if direction is Direction.COURSE else law.poisson_xy
        return cls(published / held, -waist / (ratio * published))

    @classmethod
    def mean(cls, corrections: Sequence[ClampCorrection]) -> ClampCorrection:
        """The geometric mean of several corrections."""
        logs = np.log([(c.strain_ratio, c.waist_ratio) for c in corrections])
        strain, waist = np.exp(logs.mean(axis=0)).tolist()
        return cls(strain, waist)


def _median(values: Iterable[float]) -> float:
    return float(np.median(list(values)))


def converted(law: ConstitutiveLaw, correction: ClampCorrection) -> ConstitutiveLaw:
    """A published law, over the strain between the clamps.

    With the published strain r times the one between the clamps, sigma_p(r e) = sigma(e): Young's
    moduli and alpha are r times as large, and beta stays. The waist at that strain is the
    published one times the waist's ratio.
    """
    strain, waist = correction.strain_ratio, correction.strain_ratio * correction.waist_ratio
    yx, xy = waist * law.poisson_yx, waist * law.poisson_xy
    held = max(1.0 - yx * xy, _MIN_HELD)
    stiffness_xx, stiffness_yy = (strain * law.modulus(d) / held for d in Direction)
    return replace(
        law,
        stiffness_xxxx=stiffness_xx,
        stiffness_yyyy=stiffness_yy,
        stiffness_xxyy=xy * stiffness_xx,
        stiffness_yyxx=yx * stiffness_yy,
        alpha_xx=strain * law.alpha_xx,
        alpha_yy=strain * law.alpha_yy,
    )


@dataclass(frozen=True)
class LeftOutFabrics:
    """Errors of fabrics carried over without their own raw tests, course- and wale-wise in turn.

    Attributes
    ----------
    log_force : (tests, stresses), logarithm of simulated over measured force.
    waist : (tests,), strain, simulated less measured, at the last stress.
    """

    log_force: Array
    waist: Array

    @property
    def log_error(self) -> float:
        """Standard deviation of the logarithm of the force."""
        return math.sqrt(float(np.nanmean(self.log_force**2)))

    @property
    def inside(self) -> int:
        """Forces in a 90 % interval that the errors of the other fabrics set."""
        whole = self.log_force.reshape(len(Fabric), -1)
        others = [np.delete(whole, i, axis=0) for i in range(len(whole))]
        sd = [math.sqrt(float(np.nanmean(each**2))) for each in others]
        return int((np.abs(whole) <= Z_SCORE * np.array(sd)[:, None]).sum())

    def __str__(self) -> str:
        factors = np.exp(np.sqrt(np.nanmean(self.log_force**2, axis=0)))
        return (
            f"rms factor {' / '.join(f'{factor:.2f}' for factor in factors)} at "
            f"{' / '.join(map(str, STRESSES))} N/mm; waist rms "
            f"{math.sqrt(float(np.nanmean(self.waist**2))):.3f}; {self.inside} of "
            f"{np.isfinite(self.log_force).sum()} forces inside the 90 % interval that the other "
            "fabrics' errors set"
        )


def carried(folder: Path) -> LeftOutFabrics:
    """Each of acrylic's fabrics from its published law and the other fabrics' correction."""
    published, _, strips, corrections = raw(folder)
    return left_out(published.fabrics, strips, corrections, {})


def raw(
    folder: Path,
) -> tuple[Material, dict[Key, StretchTest], dict[Key, MeasuredStrip], dict[Key, ClampCorrection]]:
    """Acrylic as published, its raw tests and their strips, and the corrections that turn each
    published law into one of clamp-to-clamp strain."""
    published = load_library(Laws.PUBLISHED)["acrylic"]
    tests = {(f, d): read(folder, f, d, Marks.CLAMPS) for f in Fabric for d in Direction}
    corrections = {
        (f, d): ClampCorrection.of(read(folder, f, d, Marks.CENTRE), test, published.law(f), d)
        for (f, d), test in tests.items()
    }
    strips = {key: MeasuredStrip.of(test, key[1]) for key, test in tests.items()}
    return published, tests, strips, corrections


def read(folder: Path, fabric: Fabric, direction: Direction, marks: Marks) -> StretchTest:
    """A raw test of acrylic, with its width corrected."""
    name = f"outputData_Acrylic Yarn {fabric.title()} {AXES[direction]}.h5"
    test = read_stretch_test(folder / name, marks=marks)
    wrong = fabric is Fabric.GARTER and direction is Direction.COURSE
    return test.with_width(GARTER_WIDTH_MM) if wrong else test


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--tests", type=Path, required=True)
    options.add_argument("--check", action="store_true")
    given = options.parse_args()
    published, tests, strips, corrections = raw(given.tests)
    print("published over clamp-to-clamp strain, waist over published")
    for (f, d), c in corrections.items():
        print(f"  {f:12} {d:7} {c.strain_ratio:.3f} {c.waist_ratio:.2f}")
    mean = ClampCorrection.mean(list(corrections.values()))
    log_strain = float(np.std([math.log(c.strain_ratio) for c in corrections.values()], ddof=1))
    print(
        f"  mean {mean.strain_ratio:.3f} (times or over {math.exp(log_strain):.3f}), "
        f"{mean.waist_ratio:.2f}"
    )

    own = {f: fit_strips([strips[f, d] for d in Direction]) for f in Fabric}
    source = (
        "refitted from the authors' raw tests, clamp to clamp: force and waist of the simulated "
        "tests, course and wale together"
    )
    rows = [row("acrylic", "", f, fit.law, fit.uncertainty, source) for f, fit in own.items()]
    even = pulled_evenly(tests, strips)
    left = left_out(published.fabrics, strips, corrections, own).log_error
    for record in measured():
        figure = record.printed["C_xxxx"]
        if figure.material == "acrylic":
            continue
        like = own[record.fabric]
        if figure.material in SAME_RIG:
            law, error = converted(record.law, mean), left
            source = (
                "the paper's law converted from its strain (middle of the sample to the lower "
                "clamp) to clamp-to-clamp strain, as found in acrylic's tests: strain over "
                f"{mean.strain_ratio:.2f}, within a factor of {math.exp(1.645 * log_strain):.2f}"
            )
        else:
            law, error = record.law, even
            source = "the paper's law, whose strain the testing machine measured clamp to clamp"
        share = like.law.shear_modulus / mean_modulus(like.law)
        law = replace(
            law, shear_modulus=share * mean_modulus(law), shear_stiffening=like.law.shear_stiffening
        )
        spread = carried_uncertainty(record, like.uncertainty, error)
        rows.append(row(figure.material, figure.variant, record.fabric, law, spread, source))
    if given.check:
        sys.exit(compare(rows))
    with FILE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def mean_modulus(law: ConstitutiveLaw) -> float:
    """Geometric mean of Young's moduli, N/mm."""
    return math.sqrt(law.modulus_course * law.modulus_wale)


def measured() -> list[FabricRecord]:
    """Every measured fabric of the paper once."""
    materials = [*load_library(Laws.PUBLISHED).values(), *load_variants(Laws.PUBLISHED).values()]
    records = [r for m in materials for r in m.fabrics.values() if r.origin is Origin.MEASURED]
    return list(
        {
            (r.printed["C_xxxx"].material, r.printed["C_xxxx"].variant, r.fabric): r
            for r in records
        }.values()
    )


def pulled_evenly(tests: dict[Key, StretchTest], strips: dict[Key, MeasuredStrip]) -> float:
    """Error of the force of a test simulated with a law fitted as if the sample strained evenly.

    Such are the laws of the paper. Returns the standard deviation of the logarithm of the force.
    """
    print("laws fitted as if the sample strained evenly: force over measured")
    errors = []
    for fabric in Fabric:
        course, wale = (tests[fabric, direction] for direction in Direction)
        law = fit_law(course, wale, reduction=Reduction.UNIFORM).law
        for direction in Direction:
            force, _ = simulated(strips[fabric, direction], law)
            errors.append(np.log(force / STRESSES))
            print(f"  {fabric:12} {direction:7}", np.round(force / STRESSES, 2))
    log_factor = math.sqrt(float(np.nanmean(np.square(errors))))
    print(f"  rms factor {math.exp(log_factor):.2f}")
    return log_factor


def left_out(
    records: Mapping[Fabric, FabricRecord],
    strips: dict[Key, MeasuredStrip],
    corrections: dict[Key, ClampCorrection],
    own: dict[Fabric, StripFit],
) -> LeftOutFabrics:
    """Error against its own raw tests of a fabric converted by the other fabrics' correction."""
    print("left out one fabric at a time: force over measured, waist minus measured")
    errors: list[Array] = []
    waists: list[float] = []
    for fabric, record in records.items():
        others = ClampCorrection.mean([c for (f, _), c in corrections.items() if f is not fabric])
        law = mended(record.law) if Direction.COURSE in record.inconsistent else record.law
        law = converted(law, others)
        for direction in Direction:
            strip = strips[fabric, direction]
            force, off = simulated(strip, law)
            errors.append(np.log(force / STRESSES))
            waists.append(float(off[-1]))
            print(f"  {fabric:12} {direction:7}", np.round(force / STRESSES, 2), np.round(off, 3))
        for name in ("modulus_course", "modulus_wale") if fabric in own else ():
            print(f"    {name} {getattr(law, name) / getattr(own[fabric].law, name):.2f}")
    errors_left_out = LeftOutFabrics(np.array(errors), np.array(waists))
    print(f"  {errors_left_out}")
    return errors_left_out


def simulated(strip: MeasuredStrip, law: ConstitutiveLaw) -> tuple[Array, Array]:
    """Force per width (N/mm) at the strains where the test carried :data:`STRESSES`, and the waist
    minus the measured one.
    """
    stress, waist = strip.means
    levels = np.sort(np.interp(STRESSES, stress, strip.strain))
    force, narrowing = strip.simulate(law, levels)
    return force, narrowing - np.interp(levels, strip.strain, waist)


def mended(law: ConstitutiveLaw) -> ConstitutiveLaw:
    """Acrylic garter as published, over the right width."""
    ratio = 35.2 / GARTER_WIDTH_MM
    return replace(
        law,
        stiffness_xxxx=law.stiffness_xxxx * ratio,
        stiffness_xxyy=law.stiffness_xxyy * ratio,
        beta_xx=law.beta_xx * ratio,
    )


def carried_uncertainty(record: FabricRecord, like: LawUncertainty, error: float) -> LawUncertainty:
    """The printed one and that of the law's force; shear and lock-up as in acrylic's fabric."""
    printed = record.uncertainty

    def curve(direction: Direction) -> CurveUncertainty:
        stress = math.hypot(printed.log_modulus(direction), error)
        return CurveUncertainty(stress, like.curve(direction).log_lock_up)

    return replace(
        like,
        log_modulus_course=math.hypot(printed.log_modulus(Direction.COURSE), error),
        log_modulus_wale=math.hypot(printed.log_modulus(Direction.WALE), error),
        poisson_yx=math.hypot(like.poisson_yx, printed.poisson_yx),
        poisson_xy=math.hypot(like.poisson_xy, printed.poisson_xy),
        curve_course=curve(Direction.COURSE),
        curve_wale=curve(Direction.WALE),
    )


def row(
    material: str, variant: str, fabric: Fabric, law: ConstitutiveLaw,
    uncertainty: LawUncertainty, source: str,
) -> dict[str, str]:  # fmt: skip
    """One line of the file."""
    curves = {d: uncertainty.curve(d) for d in Direction}
    return {
        "material": material,
        "variant": variant,
        "fabric": fabric,
        **{name: f"{round(getattr(law, name), 6):.5g}" for name in CONSTANTS},
        **{name: f"{getattr(uncertainty, name):.3g}" for name in DEVIATIONS},
        **{f"{n}_{d}": f"{getattr(c, n):.3g}" for d, c in curves.items() for n in CURVE},
        "source": source,
    }


def compare(rows: list[dict[str, str]]) -> int:
    """1 if a constant differs from the packaged one by more than a percent."""
    with FILE.open(encoding="utf-8") as file:
        kept = list(csv.DictReader(file))
    worst = max(
        abs(float(new[name]) / float(old[name]) - 1)
        for new, old in zip(rows, kept, strict=True)
        for name in ("stiffness_xxxx", "stiffness_yyyy", "alpha_xx", "alpha_yy")
    )
    print(f"largest difference of a constant: {worst:.1e}")
    return int(worst > 0.01)


if __name__ == "__main__":
    main()
