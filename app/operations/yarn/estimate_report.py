"""Accuracy of the estimates of yarns that are not in the library."""

from __future__ import annotations

import math

from pydantic import Field

from knitcore.chart.fabric import Direction, Fabric
from knitcore.materials.estimate.yarn_statistics import left_out, library_table

from ...context import Context
from ...requests.base import NoRequest, ResultModel
from ..registry import Operation


class LeftOutResult(ResultModel):
    """Errors for the library's yarns when each is left out; rms errors are factors."""

    measured: list[Fabric]
    values: int
    strain_rms_factor: float
    modulus_rms_factor: float
    modulus_median_factor: float
    modulus_within_two: float = Field(description="Share predicted within a factor of two.")
    alpha_rms_factor: float
    beta_rms_factor: float
    modulus_coverage: float = Field(description="Coverage of the 90 % intervals.")
    strain_coverage: float


class ModelReport(ResultModel):
    """The model refitted from the packaged tables, and its leave-one-yarn-out figures."""

    yarns: int
    modulus_constant: dict[Fabric, dict[Direction, float]] = Field(
        description="K in Y = K B / L³, geometric mean."
    )
    alpha: dict[Fabric, dict[Direction, float]]
    beta_n_per_mm: dict[Fabric, dict[Direction, float]]
    left_out: list[LeftOutResult]


def estimate_report(request: NoRequest, context: Context) -> ModelReport:
    """The model refitted from the packaged tables."""
    del request, context
    return report()


def report() -> ModelReport:
    """Refit the model and leave out one yarn at a time, with no, one and two swatches measured."""
    table = library_table()

    def means(name: str) -> dict[Fabric, dict[Direction, float]]:
        mean = getattr(table, name).mean(axis=0)
        return {
            fabric: {d: math.exp(mean[i, d.axis]) for d in Direction}
            for i, fabric in enumerate(Fabric)
        }

    return ModelReport(
        yarns=len(table.modulus),
        modulus_constant=means("modulus"),
        alpha=means("alpha"),
        beta_n_per_mm=means("beta"),
        left_out=[
            left_out(measured)
            for measured in (
                (),
                *((fabric,) for fabric in Fabric),
                (Fabric.STOCKINETTE, Fabric.RIB),
            )
        ],
    )


def text_of_left_out(r: LeftOutResult) -> str:
    """Figures of left-out yarns, in a line."""
    measured = " and ".join(r.measured) or "nothing"
    return (
        f"yarns left out, {measured} measured: extension within a factor {r.strain_rms_factor:.2f}"
        f" (rms), moduli {r.modulus_rms_factor:.2f} ({r.modulus_within_two:.0%} within two);"
        f" 90 % intervals cover {r.strain_coverage:.0%} and {r.modulus_coverage:.0%}"
        f" of {r.values} values"
    )


def report_lines(r: ModelReport) -> list[str]:
    """The report for people."""
    lines = [f"{r.yarns} yarns; K in Y = K B / L³, alpha, beta (N/mm)"]
    lines += [
        f"{fabric:12} {d:6} {r.modulus_constant[fabric][d]:8.0f}"
        f" {r.alpha[fabric][d]:7.3f} {r.beta_n_per_mm[fabric][d]:8.4f}"
        for fabric in Fabric
        for d in Direction
    ]
    return [*lines, "", *map(text_of_left_out, r.left_out)]


OPERATION = Operation(
    estimate_report,
    method="GET",
    path="/estimate/report",
    tag="materials",
    summary="Accuracy of predictions for left-out yarns",
)
