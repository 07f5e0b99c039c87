"""The stress-strain curve of a chart."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from app.operations.charts import ChartInput, to_chart
from app.operations.predict import GaugeInput
from knitcore.chart import StitchChart
from knitcore.fabric import Direction
from knitcore.materials import Material
from knitcore.materials import material as find_material
from knitcore.mechanics.chart_curve import DEFAULT_STRESS_N_PER_MM, chart_curve
from knitcore.mechanics.prediction import Provenance
from knitcore.mechanics.uniaxial import free_strains_at_stress
from knitcore.yarnlevel.known import known_repeat

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
    provenance: str


def curve_request(request: CurveRequest) -> CurveResult:
    """The curve that a request asks for."""
    return curve_of_chart(
        to_chart(request.chart),
        find_material(request.material),
        request.direction,
        request.stress_n_per_mm,
        request.gauge,
    )


def curve_of_chart(
    chart: StitchChart,
    material: Material,
    direction: Direction,
    stress_n_per_mm: list[float],
    gauge: GaugeInput | None = None,
) -> CurveResult:
    """The curve of any chart and material."""
    known = known_repeat(chart, material)
    if known is not None:
        stress = np.array(stress_n_per_mm)
        strain = free_strains_at_stress(known.law, direction, stress)
        return CurveResult(
            stress_n_per_mm=stress.tolist(),
            strain=strain.tolist(),
            provenance=Provenance.YARN_LEVEL,
        )
    relaxed = gauge.relaxed_size() if gauge else None
    curve = chart_curve(chart, material, direction, stress_n_per_mm, relaxed=relaxed)
    return CurveResult(
        stress_n_per_mm=curve.stress_n_per_mm.tolist(),
        strain=curve.strain.tolist(),
        provenance=curve.provenance,
    )
