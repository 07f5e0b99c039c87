"""What a chart of a material will do: effective constants with interval and source."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from knitcore.chart import StitchChart
from knitcore.fabric import PHASES, Direction
from knitcore.materials import Interval, Material
from knitcore.mechanics.local import local_moduli
from knitcore.phases import QUARTERS_OF_CODE


@dataclass(frozen=True)
class Prediction:
    """Effective constants of a chart at small strain."""

    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    poisson_yx: float
    poisson_xy: float
    modulus_course_interval: Interval
    modulus_wale_interval: Interval
    provenance: str
    method: str
    notes: tuple[str, ...]

    @property
    def extensibility_course_mm_per_n(self) -> float:
        """1 / Y_course."""
        return 1.0 / self.modulus_course_n_per_mm

    @property
    def extensibility_wale_mm_per_n(self) -> float:
        """1 / Y_wale."""
        return 1.0 / self.modulus_wale_n_per_mm


def predict(chart: StitchChart, material: Material) -> Prediction:
    """Effective constants of a chart: pure fabrics exactly, others between their bounds."""
    local = local_moduli(chart, material)
    x, y = local.modulus_course_n_per_mm, local.modulus_wale_n_per_mm
    course = _between(1 / (1 / x).mean(axis=1).mean(), (1 / (1 / x.mean(axis=0)).mean()))
    wale = _between(1 / (1 / y).mean(axis=0).mean(), (1 / (1 / y.mean(axis=1)).mean()))
    quarters = QUARTERS_OF_CODE[local.codes]
    laws = [material.law(PHASES[code]) for code in np.unique(quarters)]
    shares = np.array([(quarters == code).mean() for code in np.unique(quarters)])
    pure = len(laws) == 1
    codes = local.codes
    low_x, high_x = (v[codes].mean() for v in local.table.modulus_interval_n_per_mm(_COURSE))
    low_y, high_y = (v[codes].mean() for v in local.table.modulus_interval_n_per_mm(_WALE))
    return Prediction(
        modulus_course_n_per_mm=course,
        modulus_wale_n_per_mm=wale,
        poisson_yx=float(shares @ [law.poisson_yx for law in laws]),
        poisson_xy=float(shares @ [law.poisson_xy for law in laws]),
        modulus_course_interval=Interval(course * low_x / x.mean(), course * high_x / x.mean()),
        modulus_wale_interval=Interval(wale * low_y / y.mean(), wale * high_y / y.mean()),
        provenance="measured" if pure else "composite, stretched state only",
        method="table" if pure else "bounds",
        notes=(),
    )


_COURSE, _WALE = Direction


def _between(low: float, high: float) -> float:
    return float(np.sqrt(low * high))
