"""The stress-strain curve of a chart."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from app.operations.charts import ChartInput, to_chart
from app.operations.predict import GaugeInput
from app.results.own_materials import find_material
from knitcore.answer.chart_curve import DEFAULT_STRESS_N_PER_MM, ChartCurve, chart_curve
from knitcore.answer.prediction import Provenance, predict
from knitcore.answer.stored import known_repeat
from knitcore.chart import StitchChart
from knitcore.fabric import Direction
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import Material

Stress = Annotated[float, Field(ge=0, le=100, allow_inf_nan=False)]


class CurveRequest(BaseModel):
    """A chart, a direction and the stresses to ask for."""

    model_config = ConfigDict(extra="forbid")

    chart: ChartInput
    material: str = Field(max_length=80, examples=["acrylic"])
    direction: Direction
    stress_n_per_mm: list[Stress] = Field(
        list(DEFAULT_STRESS_N_PER_MM), min_length=1, max_length=500, description="Increasing."
    )
    gauge: GaugeInput | None = None


class CurveResult(BaseModel):
    """Strain at each stress, transverse direction free."""

    stress_n_per_mm: list[float]
    strain: list[float]
    strain_low: list[float] = Field(description="Lower end of the 90 % interval.")
    strain_high: list[float] = Field(description="Upper end of the 90 % interval.")
    provenance: str


def run_curve(request: CurveRequest, *, cancelled: Callable[[], bool] | None = None) -> CurveResult:
    """The curve that a request asks for."""
    return curve_of_chart(
        to_chart(request.chart),
        find_material(request.material),
        request.direction,
        request.stress_n_per_mm,
        request.gauge,
        cancelled=cancelled,
    )


def curve_of_chart(
    chart: StitchChart,
    material: Material,
    direction: Direction,
    stress_n_per_mm: list[float],
    gauge: GaugeInput | None = None,
    *,
    cancelled: Callable[[], bool] | None = None,
) -> CurveResult:
    """The curve of any chart and material.

    The interval takes the modulus' uncertainty as one of the whole scale of stress: the lock-up
    strain, which the tests fix best, stays where it is.
    """
    known = known_repeat(chart, material)
    relaxed = gauge.relaxed_size() if gauge else known.relaxed if known else None
    law = known.law if known else None
    modulus = predict(chart, material, relaxed=relaxed, repeat_law=law)
    stress = np.array(stress_n_per_mm)

    def at(stresses: NDArray[np.float64]) -> ChartCurve:
        if law is not None:
            strain = free_strains_at_stress(law, direction, stresses)
            return ChartCurve(stresses, strain, Provenance.YARN_LEVEL)
        return chart_curve(
            chart, material, direction, stresses, relaxed=relaxed, cancelled=cancelled
        )

    value = modulus.modulus_n_per_mm(direction)
    interval = (
        modulus.modulus_course_interval
        if direction is Direction.COURSE
        else modulus.modulus_wale_interval
    )
    curve = at(stress)
    return CurveResult(
        stress_n_per_mm=stress.tolist(),
        strain=curve.strain.tolist(),
        strain_low=at(stress * value / interval.high).strain.tolist(),
        strain_high=at(stress * value / interval.low).strain.tolist(),
        provenance=curve.provenance,
    )
