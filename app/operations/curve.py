"""The stress-strain curve of a chart."""

from __future__ import annotations

from typing import Annotated, Any

import click
import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from app.models.base import Floats, RequestModel, ResultModel
from app.models.charts import ChartInput, MaterialName, to_chart
from app.models.gauge import GaugeInput
from app.operations.context import Context
from app.operations.registry import Command, Operation
from knitcore.answer.chart_curve import DEFAULT_STRESS_N_PER_MM, ChartCurve, chart_curve
from knitcore.answer.prediction import Provenance, predict
from knitcore.answer.stored import known_repeat
from knitcore.fabric import Direction
from knitcore.law.uniaxial import free_strains_at_stress

Stress = Annotated[float, Field(ge=0, le=100, allow_inf_nan=False)]


class CurveRequest(RequestModel):
    """A chart, a direction and the stresses to ask for."""

    chart: ChartInput
    material: MaterialName
    direction: Direction = Field(description="Along rows, or along columns.")
    stress_n_per_mm: list[Stress] = Field(
        list(DEFAULT_STRESS_N_PER_MM), min_length=1, max_length=500, description="Increasing."
    )
    gauge: GaugeInput | None = None


class CurveResult(ResultModel):
    """Strain at each stress, transverse direction free."""

    stress_n_per_mm: Floats
    strain: Floats
    strain_low: Floats = Field(description="Lower end of the 90 % interval.")
    strain_high: Floats = Field(description="Upper end of the 90 % interval.")
    provenance: str


def curve(request: CurveRequest, context: Context) -> CurveResult:
    """Strain at each stress, for pure fabrics, ribs, welts and repeats of up to 256 stitches.

    The interval takes the modulus' uncertainty as one of the whole scale of stress: the lock-up
    strain, which the tests fix best, stays where it is. Large repeats take minutes; stops when the
    caller goes away.
    """
    chart, material = to_chart(request.chart), context.material(request.material)
    known = known_repeat(chart, material)
    relaxed = known.relaxed if known else None
    if request.gauge is not None:
        relaxed = request.gauge.relaxed_size()
    law = known.law if known else None
    modulus = predict(chart, material, relaxed=relaxed, repeat_law=law)
    stress, direction = np.array(request.stress_n_per_mm), request.direction

    def at(stresses: NDArray[np.float64]) -> ChartCurve:
        if law is not None:
            strain = free_strains_at_stress(law, direction, stresses)
            return ChartCurve(stresses, strain, Provenance.YARN_LEVEL)
        return chart_curve(
            chart, material, direction, stresses, relaxed=relaxed, cancelled=context.cancelled
        )

    value = modulus.modulus_n_per_mm(direction)
    interval = (
        modulus.modulus_course_interval
        if direction is Direction.COURSE
        else modulus.modulus_wale_interval
    )
    return CurveResult.of(
        at(stress),
        stress_n_per_mm=stress,
        strain_low=at(stress * value / interval.high).strain,
        strain_high=at(stress * value / interval.low).strain,
    )


@click.option(
    "--max-stress",
    type=click.FloatRange(0, 100, min_open=True),
    default=0.3,
    show_default=True,
    help="Last stress in N/mm.",
)
@click.option("--points", type=click.IntRange(2, 500), default=31, show_default=True)
def _stresses(max_stress: float, points: int) -> dict[str, Any]:
    return {"stress_n_per_mm": np.linspace(0, max_stress, points).tolist()}


def _text(r: CurveResult) -> str:
    lines = [f"{'N/mm':>8} {'strain':>8}   90 % interval"]
    columns = (r.stress_n_per_mm, r.strain, r.strain_low, r.strain_high)
    lines += [
        f"{s:8.4f} {e:8.4f}   {a:.4f} to {b:.4f}" for s, e, a, b in zip(*columns, strict=True)
    ]
    return "\n".join([*lines, f"source: {r.provenance}"])


OPERATION = Operation(
    name="curve",
    tag="mechanics",
    summary="Stress-strain curve of a chart",
    request=CurveRequest,
    result=CurveResult,
    run=curve,
    heavy=True,
    job=True,
    command=Command(
        _text,
        help="Stress-strain curve of CHART: a pure fabric, rib, welt or repeat of up to 256 "
        "stitches.",
        names={"stress_n_per_mm": None},
        fields=_stresses,
    ),
)
