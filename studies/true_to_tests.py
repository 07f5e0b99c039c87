"""Simulated against measured stretch tests: force, waist, and coverage of the intervals.

    python -m studies.true_to_tests FOLDER [--left-out]

FOLDER holds the authors' acrylic tests (``outputData_Acrylic Yarn Garter X.h5`` and the like).
Prints the eight tests with published and refitted laws. ``--left-out`` fits each pull by the others
(a minute or two), and prints the figures for the pulls left out.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from knitcore.chart.fabric import Direction, Fabric
from knitcore.fit.measured_strip import MeasuredStrip
from knitcore.fit.strip_errors import LOG_WIDTH_READING
from knitcore.fit.strip_fit import fit_strips
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import Laws, material
from knitcore.materials.law_uncertainty import Z_SCORE, LawUncertainty
from knitcore.measure.uniaxial_files import Marks
from scripts.refit_laws import STRESSES, read

Row = tuple[np.ndarray, np.ndarray, np.ndarray]


class LeftOut(NamedTuple):
    """A pull predicted from the others, with intervals for another sample and for this one."""

    fabric: Fabric
    direction: Direction
    other_sample: Row
    same_sample: Row


def strips(folder: Path, fabric: Fabric) -> list[MeasuredStrip]:
    """The two tests of a fabric."""
    tests = {direction: read(folder, fabric, direction, Marks.CLAMPS) for direction in Direction}
    return [MeasuredStrip.of(test, direction) for direction, test in tests.items()]


def compared(
    law: ConstitutiveLaw, spread: LawUncertainty, strip: MeasuredStrip, *, same_sample: bool = False
) -> Row:
    """Simulated over measured force, waist less the measured one, whether the force is inside.

    The waist is read between the points that the test tracks, and includes its flattening.
    The reading of its width is no error between pulls of the same sample.
    """
    stress, waist = strip.means
    known = np.isfinite(stress)
    target = np.minimum(STRESSES, stress[known].max())  # one test ends just below the last
    at = np.interp(target, stress[known], strip.strain[known])
    at = np.minimum(at, 0.95 * law.lock_up_strain(strip.direction))
    force, narrowing = strip.simulate(law, at)
    ratio = force / target
    sd = spread.log_stress(strip.direction, STRESSES)
    if same_sample:
        sd = np.sqrt(sd**2 - LOG_WIDTH_READING**2)
    return (
        ratio,
        narrowing - np.interp(at, strip.strain[known], waist[known]),
        np.abs(np.log(ratio)) <= Z_SCORE * sd,
    )


@dataclass(frozen=True)
class Summary:
    """Figures over many tests.

    Attributes
    ----------
    rms_factor, bias : of simulated over measured force at each stress.
    waist_rms : of the difference in strain.
    inside, forces : how many forces are in the 90 % interval, of how many.
    """

    rms_factor: tuple[float, ...]
    bias: tuple[float, ...]
    waist_rms: float
    inside: int
    forces: int

    @classmethod
    def of(cls, rows: list[Row]) -> Summary:
        """From the rows of single tests."""
        ratio, waist, inside = (np.array(part) for part in zip(*rows, strict=True))
        logs = np.log(ratio)
        return cls(
            tuple(np.exp(np.sqrt(np.nanmean(logs**2, axis=0))).tolist()),
            tuple(np.exp(np.nanmean(logs, axis=0)).tolist()),
            math.sqrt(np.nanmean(waist**2)),
            int(inside.sum()),
            int(np.isfinite(ratio).sum()),
        )

    def __str__(self) -> str:
        factors, bias = (
            " / ".join(f"{v:.3f}" for v in values) for values in (self.rms_factor, self.bias)
        )
        return (
            f"rms factor {factors}, bias {bias} at {' / '.join(map(str, STRESSES))} N/mm; waist "
            f"rms {self.waist_rms:.3f}; {self.inside} of {self.forces} forces inside the 90 % "
            f"interval ({self.inside / self.forces:.0%})"
        )


def of_library(folder: Path, laws: Laws) -> dict[tuple[Fabric, Direction], Row]:
    """The eight tests with the library's laws."""
    return {
        (fabric, strip.direction): compared(record.law, record.uncertainty, strip)
        for fabric in Fabric
        for record in [material("acrylic", laws).record(fabric)]
        for strip in strips(folder, fabric)
    }


def left_out(folder: Path) -> list[LeftOut]:
    """Every pull predicted by a law fitted to the other pulls."""
    rows = []
    for fabric in Fabric:
        both = strips(folder, fabric)
        for index in range(max(strip.pulls for strip in both)):
            fit = fit_strips([s.without(index) if index < s.pulls else s for s in both])
            for strip in both:
                if index < strip.pulls:
                    alone = replace(
                        strip,
                        stress_n_per_mm=strip.stress_n_per_mm[index : index + 1],
                        waist=strip.waist[index : index + 1],
                    )
                    other, same = (
                        compared(fit.law, fit.uncertainty, alone, same_sample=same)
                        for same in (False, True)
                    )
                    rows.append(LeftOut(fabric, strip.direction, other, same))
    return rows


def main() -> None:
    folder = Path(sys.argv[1])
    for laws in (Laws.PUBLISHED, Laws.REFITTED):
        print(f"{laws} laws: force over measured at {STRESSES} N/mm, waist less measured, inside")
        rows = of_library(folder, laws)
        for (fabric, direction), row in rows.items():
            columns = np.round(row[0], 2), np.round(row[1], 3), row[2].astype(int)
            print(f"  {fabric:12}{direction:8}", *columns)
        print(" ", Summary.of(list(rows.values())))
    if "--left-out" in sys.argv:
        pulls = left_out(folder)
        print("pulls left out:", Summary.of([pull.other_sample for pull in pulls]))
        print("  intervals of the same sample:", Summary.of([pull.same_sample for pull in pulls]))


if __name__ == "__main__":
    main()
