"""The draw-in correction of ribs and welts against sweeps of the yarn level.

The flat composite is made of the sweeps of the pure fabrics, of the same yarn, so that only the
rule of mixing and the correction are tested. About 10 s of CPU time.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from knitcore.answer.folded import UNFOLDING_STRESS_N_PER_MM
from knitcore.chart import StitchChart
from knitcore.fabric import Direction
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.relax import Branch, relax
from knitcore.yarnlevel.sweep import sweep
from knitcore.yarnlevel.yarn import YarnModel

YARN = YarnModel(45e-3, 6e-4, 2.4, 0.74, 0.30)
LOOP_LENGTH_MM = 11.28
STRESS = np.array([0.03, 0.05, 0.1, 0.2])
CASES = {
    Direction.COURSE: {
        "KKP": {"K": 1 / 3, "KP": 2 / 3},
        "KKPP": {"K": 1 / 2, "KP": 1 / 2},
        "KKKP": {"K": 1 / 2, "KP": 1 / 2},
        "KKKPPP": {"K": 2 / 3, "KP": 1 / 3},
    },
    Direction.WALE: {
        "K/K/P": {"K": 1 / 3, "K/P": 2 / 3},
        "K/K/K/P": {"K": 1 / 2, "K/P": 1 / 2},
        "K/K/P/P": {"K": 1 / 2, "K/P": 1 / 2},
    },
}


class Stretched:
    """Sizes of a repeat's stitch against force per row or wale."""

    def __init__(self, text: str, direction: Direction) -> None:
        cell = relax(
            StitchChart.parse(text),
            YARN,
            LOOP_LENGTH_MM,
            branch=Branch.MIRRORED,
            convention=Convention.AUTHORS_CODE,
        )
        self.across_mm = cell.cell_mm(direction.other)
        curve = sweep(cell, direction, 4.0, points=80, max_stress_n_per_mm=0.35, back=False)
        self._size = np.array([c.cell_mm(direction) for c in curve.cells])
        self._force = np.array([c.force_n[direction.axis] for c in curve.cells])

    @property
    def relaxed_mm(self) -> float:
        return float(self._size[0])

    def size_mm(self, force_n: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.interp(force_n, self._force, self._size)


def main() -> None:
    print("error of the strain, %, at", STRESS, "N/mm: corrected, and flat")
    for direction, cases in CASES.items():
        pure = {text: Stretched(text, direction) for text in {t for c in cases.values() for t in c}}
        for text, shares in cases.items():
            real = Stretched(text, direction)
            force = STRESS * real.across_mm
            flat = sum(share * pure[t].size_mm(force) for t, share in shares.items())
            at_rest = sum(share * pure[t].relaxed_mm for t, share in shares.items())
            fold = np.exp(-STRESS / UNFOLDING_STRESS_N_PER_MM[direction])
            corrected = flat - (at_rest - real.relaxed_mm) * fold
            strain = real.size_mm(force) / real.relaxed_mm - 1
            errors = [
                np.round(100 * (found / strain - 1)).astype(int)
                for found in (corrected / real.relaxed_mm - 1, flat / at_rest - 1)
            ]
            print(f"{text:8} {direction:7} {real.relaxed_mm / at_rest:.2f}", *errors)


if __name__ == "__main__":
    main()
