"""Refit the library's laws to the authors' raw tests, and apply the correction to other yarns.

    python scripts/refit_laws.py --tests FOLDER [--check]

FOLDER holds ``outputData_Acrylic Yarn Garter X.h5`` and the like, from the paper's data
(https://github.com/sabetta/stitch-by-stitch, MIT). Writes ``knitcore/materials/data/refitted.csv``;
``--check`` compares with it instead. Prints the correction, and the errors of laws corrected
without their own raw tests.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from knitcore.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import FabricRecord, Laws, Origin, load_library, load_variants
from knitcore.materials.refitted import COLUMNS, CONSTANTS, CURVE, DEVIATIONS
from knitcore.materials.uncertainty import CurveUncertainty, LawUncertainty
from knitcore.measure.stretch_test import StretchTest
from knitcore.measure.uniaxial_files import Gauge, read_stretch_test
from knitcore.swatch.clamp_correction import ClampCorrection, carried_strip
from knitcore.swatch.strip_fit import MeasuredStrip, StripFit, fit_strips

FILE = Path(__file__).parent.parent / "knitcore" / "materials" / "data" / "refitted.csv"
AXES = {Direction.COURSE: "X", Direction.WALE: "Y"}
GARTER_WIDTH_MM = 59.5
"""Acrylic garter course-wise: its file repeats the clamp's size for the width. 31 rows of 1.86 to
2.0 mm make 57 to 62 mm, and at 59.5 mm it ends at the stress of the other tests."""
STRESSES = (0.05, 0.1, 0.2)
Key = tuple[Fabric, Direction]


def read(folder: Path, fabric: Fabric, direction: Direction, gauge: Gauge) -> StretchTest:
    """A raw test of acrylic, with its width corrected."""
    name = f"outputData_Acrylic Yarn {fabric.title()} {AXES[direction]}.h5"
    test = read_stretch_test(folder / name, gauge=gauge)
    wrong = fabric is Fabric.GARTER and direction is Direction.COURSE
    return test.with_width(GARTER_WIDTH_MM) if wrong else test


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--tests", type=Path, required=True)
    options.add_argument("--check", action="store_true")
    given = options.parse_args()
    published = load_library(Laws.PUBLISHED)["acrylic"]
    tests = {(f, d): read(given.tests, f, d, Gauge.CLAMPS) for f in Fabric for d in Direction}
    strips = {key: MeasuredStrip.of(test, key[1]) for key, test in tests.items()}
    corrections = {
        (f, d): ClampCorrection.of(
            read(given.tests, f, d, Gauge.CENTRE), tests[f, d], published.law(f), d
        )
        for f, d in tests
    }
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
    rows = [
        row(
            "acrylic",
            "",
            f,
            fit.law,
            fit.uncertainty,
            "refitted from the authors' raw tests, "
            "clamp to clamp: force and waist of the simulated tests, course and wale together",
        )
        for f, fit in own.items()
    ]
    extra = left_out(published.fabrics, strips, corrections, own, log_strain)
    for record in measured():
        figure = record.printed["C_xxxx"]
        if figure.material == "acrylic":
            continue
        fit = carried(record, strips, mean, own[record.fabric].law)
        rows.append(
            row(
                figure.material,
                figure.variant,
                record.fabric,
                fit.law,
                carried_uncertainty(record, fit, log_strain, extra),
                "the paper's law converted from its strain (middle of the sample to the lower "
                f"clamp) to clamp-to-clamp strain, as found in acrylic's tests: strain over "
                f"{mean.strain_ratio:.2f}, within a factor of {math.exp(1.645 * log_strain):.2f}",
            )
        )
        print(f"  {figure.material}:{figure.variant} {record.fabric} carried", flush=True)
    if given.check:
        sys.exit(compare(rows))
    with FILE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


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


def carried(
    record: FabricRecord,
    strips: dict[Key, MeasuredStrip],
    correction: ClampCorrection,
    like: ConstitutiveLaw | None,
) -> StripFit:
    """A published law fitted again; strips are as large as acrylic's of the same fabric."""
    found = []
    for direction in Direction:
        strip = strips[record.fabric, direction]
        assert strip.length_mm is not None
        size = (strip.width_mm, strip.length_mm)
        found.append(carried_strip(record.law, direction, size, correction))
    return fit_strips(found, like=like)


def left_out(
    records: dict[Fabric, FabricRecord],
    strips: dict[Key, MeasuredStrip],
    corrections: dict[Key, ClampCorrection],
    own: dict[Fabric, StripFit],
    log_strain: float,
) -> float:
    """Error against its own raw tests of a fabric corrected by the other fabrics' correction.

    Returns the standard deviation of the logarithm of stress not explained by the strain's scale.
    """
    print("left out one fabric at a time: force over measured, waist minus measured")
    errors, explained = [], []
    for fabric, record in records.items():
        others = ClampCorrection.mean([c for (f, _), c in corrections.items() if f is not fabric])
        law = mended(record.law) if Direction.COURSE in record.inconsistent else record.law
        fit = carried(replace(record, law=law), strips, others, None)
        for direction in Direction:
            strip = strips[fabric, direction]
            stress, waist = strip.means
            at = np.interp(STRESSES, stress, strip.strain)
            levels = np.sort(at)
            force, narrowing = strip.simulate(fit.law, levels)
            more, _ = strip.simulate(fit.law, levels * 1.02)
            slope = np.log(more / force) / math.log(1.02)
            errors.append(np.log(force / STRESSES))
            explained.append(slope * log_strain)
            print(
                f"  {fabric:12} {direction:7}",
                np.round(force / STRESSES, 2),
                np.round(narrowing - np.interp(levels, strip.strain, waist), 3),
                "strain's scale alone:",
                np.round(np.exp(slope * log_strain), 2),
            )
        for name in ("modulus_course", "modulus_wale"):
            print(f"    {name} {getattr(fit.law, name) / getattr(own[fabric].law, name):.2f}")
    squares = np.nanmean(np.square(errors))
    rest = max(float(squares - np.nanmean(np.square(explained))), 0.0)
    print(
        f"  rms factor {math.exp(math.sqrt(squares)):.2f}, besides the strain's scale "
        f"{math.exp(math.sqrt(rest)):.2f}"
    )
    return math.sqrt(rest)


def mended(law: ConstitutiveLaw) -> ConstitutiveLaw:
    """Acrylic garter as published, over the right width."""
    ratio = 35.2 / GARTER_WIDTH_MM
    return replace(
        law,
        stiffness_xxxx=law.stiffness_xxxx * ratio,
        stiffness_xxyy=law.stiffness_xxyy * ratio,
        beta_xx=law.beta_xx * ratio,
    )


def carried_uncertainty(
    record: FabricRecord, fit: StripFit, log_strain: float, extra: float
) -> LawUncertainty:
    """The printed one, and what carrying over adds."""
    printed = record.uncertainty

    def curve(found: CurveUncertainty, direction: Direction) -> CurveUncertainty:
        stress = math.hypot(printed.log_modulus(direction), extra)
        return CurveUncertainty(stress, log_strain, math.hypot(found.log_lock_up, log_strain))

    def modulus(direction: Direction) -> float:
        return math.hypot(printed.log_modulus(direction), extra, log_strain)

    return replace(
        fit.uncertainty,
        log_modulus_course=modulus(Direction.COURSE),
        log_modulus_wale=modulus(Direction.WALE),
        poisson_yx=math.hypot(fit.uncertainty.poisson_yx, printed.poisson_yx),
        poisson_xy=math.hypot(fit.uncertainty.poisson_xy, printed.poisson_xy),
        curve_course=curve(fit.uncertainty.curve(Direction.COURSE), Direction.COURSE),
        curve_wale=curve(fit.uncertainty.curve(Direction.WALE), Direction.WALE),
    )


def row(
    material: str,
    variant: str,
    fabric: Fabric,
    law: ConstitutiveLaw,
    uncertainty: LawUncertainty,
    source: str,
) -> dict[str, str]:
    """One line of the file."""
    curves = {d: uncertainty.curve(d) for d in Direction}
    return {
        "material": material,
        "variant": variant,
        "fabric": fabric,
        **{name: f"{getattr(law, name):.5g}" for name in CONSTANTS},
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
