"""A strip of graded jersey on the bias against its measured force.

    python benchmarks/bias_strip.py FOLDER

FOLDER holds the force bands of Do, Tan, Ramos, Kiendl and Weeger, Composites Part B 2020 (CC BY
4.0): single jersey of loop length 4.5 and 6.5 mm pulled along the wales, cloth with one half of
each pulled along and across, and the same cloth cut at 45°. The first four give the laws; the shear
modulus is the one at which the bias strip has its measured force at 10 %. The files tell neither
width nor length: 50 mm, and 50 to 200 mm, are assumed. Nor do they tell Poisson's ratios.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, nnls

from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.stiffening import stiffening
from knitcore.piece import Cloth, CutPiece, Held, solve
from knitcore.swatch import QuarterGrid, Sheet, SheetModel

WIDTH_MM = 50.0
LENGTHS_MM = (50.0, 100.0, 200.0)
POISSON = (0.2, 0.3, 0.45)
STRAINS = np.array([0.05, 0.1, 0.2, 0.3])
MATCHED = 0.1
"""Strain at which the shear modulus is fitted."""
FAR_MM = 1000.0


@dataclass(frozen=True)
class Graded:
    """Laws of the two halves, and the measured force of the bias strip at ``STRAINS``, N."""

    laws: tuple[ConstitutiveLaw, ConstitutiveLaw]
    force_n: NDArray[np.float64]

    def sheared(self, ratio: float) -> tuple[ConstitutiveLaw, ...]:
        """Laws with a shear modulus of so many times the geometric mean of Young's moduli."""
        return tuple(
            replace(law, shear_modulus=ratio * math.sqrt(law.modulus_course * law.modulus_wale))
            for law in self.laws
        )

    def bias_force(
        self, ratio: float, length_mm: float, strains: NDArray[np.float64]
    ) -> list[float]:
        """Simulated force, N; the halves meet along a wale through the middle."""
        lines = np.array([-FAR_MM, 0.0, FAR_MM])
        grid = QuarterGrid.between(lines, lines[::2], np.array([[0, 1]], dtype=np.uint8))
        cloth = Cloth(Sheet(grid, self.sheared(ratio), SheetModel()), (-FAR_MM, -FAR_MM))
        piece = CutPiece.rectangle(WIDTH_MM, length_mm, grain_deg=45.0)
        forces = []
        for strain in strains:
            conditions = [Held("bottom"), Held("top", y_mm=strain * length_mm)]
            steps = max(1, round(strain / 0.1))
            test = solve(piece, cloth, conditions, steps=steps, mesh_mm=WIDTH_MM / 4)
            assert test.converged, test.problem
            forces.append(float(test.force_n[-1, 1, 1]))
        return forces

    def matching_ratio(self, length_mm: float) -> float:
        """Shear modulus over the geometric mean of Young's moduli that has the force at 10 %."""
        wanted = float(np.interp(MATCHED, STRAINS, self.force_n))

        def off(log_ratio: float) -> float:
            (force,) = self.bias_force(math.exp(log_ratio), length_mm, np.array([MATCHED]))
            return math.log(force / wanted)

        return math.exp(brentq(off, math.log(0.02), math.log(5.0), xtol=0.02))


def band(folder: Path, name: str, strain: NDArray[np.float64]) -> NDArray[np.float64]:
    """Geometric mean of the lower and upper measured force, N."""
    ends = [np.loadtxt(folder / f"test_{name}_{end}.txt") for end in ("low", "high")]
    found: NDArray[np.float64] = np.sqrt(
        np.prod([np.interp(strain, end[:, 0], end[:, 1]) for end in ends], axis=0)
    )
    return found


def graded(folder: Path, poisson: float) -> Graded:
    """Laws from the straight tests; ``poisson`` is the geometric mean of both ratios."""
    strain = np.linspace(0.02, 0.3, 15)
    wale = [
        _fitted(strain, band(folder, f"const{loop}_ww", strain) / WIDTH_MM) for loop in (4.5, 6.5)
    ]
    # across the halves are in series; their stiffness differs as it does along the wales
    pulled = band(folder, "discont4.5to6.5_cw", strain) / WIDTH_MM
    series = float(pulled @ strain / (strain @ strain))
    ratio = wale[0][0] / wale[1][0]
    course = series * (1 + ratio) / 2, series * (1 + ratio) / (2 * ratio)
    laws = []
    for modulus_x, (modulus_y, alpha, beta) in zip(course, wale, strict=True):
        held = 1 - poisson**2
        coupling = poisson * math.sqrt(modulus_x * modulus_y) / held
        stiffness = modulus_x / held, modulus_y / held, coupling, coupling
        laws.append(ConstitutiveLaw(*stiffness, 0.0, alpha, 0.0, beta))
    return Graded((laws[0], laws[1]), band(folder, "45deg", STRAINS))


def _fitted(strain: NDArray[np.float64], stress: NDArray[np.float64]) -> tuple[float, float, float]:
    """Young's modulus (N/mm), alpha and beta (N/mm) of least relative error."""
    best = math.inf, 0.0, 0.0, 0.0
    for alpha in np.linspace(0.05, 0.98, 60) / strain[-1]:
        design = np.column_stack([strain, stiffening(alpha * strain)[1]]) / stress[:, None]
        (modulus, beta), off = nnls(design, np.ones(len(strain)))
        best = min(best, (float(off), float(modulus), float(alpha), float(beta)))
    return best[1:]


def main() -> None:
    folder = Path(sys.argv[1])
    print("force at", ", ".join(f"{strain:.0%}" for strain in STRAINS), "over the measured one")
    for poisson in POISSON:
        test = graded(folder, poisson)
        for length in LENGTHS_MM:
            ratio = test.matching_ratio(length)
            forces = np.array(test.bias_force(ratio, length, STRAINS)) / test.force_n
            moduli = ", ".join(f"{law.shear_modulus:.3f}" for law in test.sheared(ratio))
            print(
                f"nu {poisson}, {length:3.0f} mm long: shear modulus {ratio:.2f} of sqrt(Yx Yy) "
                f"({moduli} N/mm); {', '.join(f'{f:.2f}' for f in forces)}"
            )


if __name__ == "__main__":
    main()
