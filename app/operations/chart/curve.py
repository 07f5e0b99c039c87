"""The stress-strain curve of a chart."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import click
import numpy as np
from pydantic import Field

from knitcore.base.errors import check_cancelled
from knitcore.chart.fabric import Direction
from knitcore.materials.interval_parts import Part
from knitcore.prediction.curve import DEFAULT_STRESS_N_PER_MM, increasing
from knitcore.prediction.curve import curve as chart_curve

from ...context import Context
from ...requests.base import EndsOfList, Floats, IntervalResult
from ...requests.fabrics import StitchesRequest
from ...requests.faults import CheckedBy
from ..registry import Command, Operation

Stress = Annotated[float, Field(ge=0, le=100)]


class CurveRequest(StitchesRequest):
    """A chart, a direction and the stresses to ask for."""

    direction: Direction = Field(description="Direction of the pull: along rows, or along columns.")
    stress_n_per_mm: Annotated[list[Stress], CheckedBy(lambda s, _: increasing(s))] = Field(
        list(DEFAULT_STRESS_N_PER_MM),
        min_length=1,
        max_length=500,
        description="Stresses, increasing.",
    )


class CurveResult(IntervalResult):
    """Strain at each stress, transverse direction free."""

    kind: Literal["curve"] = "curve"
    stress_n_per_mm: Floats
    strain: Floats
    strain_interval: EndsOfList = Field(description="Strain interval at each stress.")
    stress_interval_n_per_mm: EndsOfList = Field(
        description="Stress interval at each strain; at most 10 N/mm."
    )
    shares: dict[Part, Floats] = Field(
        description="Shares of what is unknown in the variance of the strain's logarithm, at each "
        "stress."
    )
    provenance: str


def curve(request: CurveRequest, context: Context) -> CurveResult:
    """Strain at each stress, and the stress interval at each strain, for a chart of any size."""
    check_cancelled(context.cancelled)
    curve = request.pass_to(chart_curve, *request.stitches(context), size=request.relaxed_size)
    return CurveResult.of(
        curve,
        strain_interval=(curve.strain_low, curve.strain_high),
        stress_interval_n_per_mm=(curve.stress_low, curve.stress_high),
    )


@click.option(
    "--max-stress",
    type=click.FloatRange(0, 100, min_open=True),
    default=0.3,
    show_default=True,
    help="Largest stress in N/mm.",
)
@click.option("--points", type=click.IntRange(2, 500), default=31, show_default=True)
def _stresses(max_stress: float, points: int) -> dict[str, Any]:
    return {"stress_n_per_mm": np.linspace(0, max_stress, points).tolist()}


def _lines(r: CurveResult) -> list[str]:
    lines = [f"{'N/mm':>8} {'strain':>8}   90 % interval"]
    columns = (r.stress_n_per_mm, r.strain, *r.strain_interval)
    lines += [
        f"{s:8.4f} {e:8.4f}   {a:.4f} to {b:.4f}" for s, e, a, b in zip(*columns, strict=True)
    ]
    largest = max(r.shares, key=lambda part: r.shares[part][-1])
    share = f"{r.shares[largest][-1]:.0%} of the last interval's variance is from: {largest}"
    return [*lines, share, f"source: {r.provenance}"]


OPERATION = Operation(
    curve,
    tag="mechanics",
    summary="Stress-strain curve of a chart",
    example={
        "chart": "K\nP",
        "material": "acrylic",
        "direction": "wale",
        "stress_n_per_mm": [0.0, 0.05, 0.1],
    },
    job=True,
    command=Command(
        _lines,
        more="It is a repeat or a swatch of any size.",
        names={"stress_n_per_mm": None},
        fields=_stresses,
    ),
)
