"""A yarn that is not in the library."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pydantic import BaseModel, ConfigDict, Field

from app.operations.materials import LawResult
from knitcore.estimate.estimate import (
    Estimate,
    FabricEstimate,
    MeasuredSwatch,
    YarnEstimate,
    estimate_yarn,
)
from knitcore.estimate.model import left_out, library_table
from knitcore.fabric import Direction, Fabric
from knitcore.formats.law_files import law_from_mapping
from knitcore.materials import FabricRecord, Material, Origin, Yarn
from knitcore.materials.uncertainty import Z_SCORE, LawUncertainty

MEASURED_LOG_SD = 0.1
"""Of the moduli of a measured swatch in a saved material: the paper's median."""


class SwatchInput(BaseModel):
    """A measured swatch of the yarn."""

    model_config = ConfigDict(extra="forbid")

    fabric: Fabric
    law: dict[str, float] = Field(description="Constants of its law, by name.")
    loop_length_mm: float
    setting: str = Field("", max_length=200, description="Needle or stitch setting.")


class EstimateRequest(BaseModel):
    """What is known of the yarn and of the product."""

    model_config = ConfigDict(extra="forbid")

    bending_modulus_n_mm2: float
    loop_length_mm: float | dict[Fabric, float] = Field(description="Yarn per stitch.")
    swatches: list[SwatchInput] = Field(default_factory=list, max_length=4)
    product_setting: str = Field("", max_length=200)


class EstimateInterval(BaseModel):
    """A value and its 90 % interval (of no width where it is measured)."""

    value: float
    low: float
    high: float


class FabricEstimateResult(BaseModel):
    """One fabric: extension under load first, because it is predicted best."""

    strain_at_0_1_n_per_mm: dict[Direction, EstimateInterval]
    modulus_n_per_mm: dict[Direction, EstimateInterval]
    alpha: dict[Direction, EstimateInterval]
    beta_n_per_mm: dict[Direction, EstimateInterval]
    law: LawResult
    loop_length_mm: float
    measured: bool


class LeftOutResult(BaseModel):
    """How well the library's yarns are predicted when they are left out; factors of the rms."""

    measured: list[Fabric]
    values: int
    strain_rms_factor: float
    modulus_rms_factor: float
    modulus_median_factor: float
    modulus_within_two: float = Field(description="Share predicted within a factor of two.")
    alpha_rms_factor: float
    beta_rms_factor: float
    modulus_coverage: float = Field(description="Of the 90 % intervals.")
    strain_coverage: float


class EstimateResult(BaseModel):
    """All four fabrics of the yarn."""

    fabrics: dict[Fabric, FabricEstimateResult]
    left_out: LeftOutResult | None = Field(description="None if all fabrics are measured.")
    warnings: list[str]


class ModelReport(BaseModel):
    """The model refitted from the packaged tables, and its leave-one-yarn-out figures."""

    yarns: int
    modulus_constant: dict[Fabric, dict[Direction, float]] = Field(
        description="K in Y = K B / L³, geometric mean."
    )
    alpha: dict[Fabric, dict[Direction, float]]
    beta_n_per_mm: dict[Fabric, dict[Direction, float]]
    left_out: list[LeftOutResult]


def run_estimate(request: EstimateRequest) -> EstimateResult:
    """The estimate that a request asks for."""
    return estimate_result(
        make_estimate(
            request.bending_modulus_n_mm2,
            request.loop_length_mm,
            [
                MeasuredSwatch(s.fabric, law_from_mapping(s.law).law, s.loop_length_mm, s.setting)
                for s in request.swatches
            ],
            request.product_setting,
        )
    )


def make_estimate(
    bending_modulus_n_mm2: float,
    loop_length_mm: float | Mapping[Fabric, float],
    swatches: list[MeasuredSwatch],
    product_setting: str,
) -> YarnEstimate:
    """Laws of all four fabrics."""
    return estimate_yarn(
        bending_modulus_n_mm2, loop_length_mm, swatches, product_setting=product_setting
    )


def estimate_result(estimate: YarnEstimate) -> EstimateResult:
    """The numbers of an estimate."""
    measured = tuple(f for f, e in estimate.fabrics.items() if e.measured)
    return EstimateResult(
        fabrics={fabric: _fabric(found) for fabric, found in estimate.fabrics.items()},
        left_out=_left_out(measured) if len(measured) < len(Fabric) else None,
        warnings=list(estimate.warnings),
    )


def model_report() -> ModelReport:
    """Refit the model and leave one yarn out, with nothing, one and two swatches measured."""
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
            _left_out(measured)
            for measured in (
                (),
                *((fabric,) for fabric in Fabric),
                (Fabric.STOCKINETTE, Fabric.RIB),
            )
        ],
    )


def estimated_material(
    estimate: YarnEstimate, identifier: str, bending_modulus_n_mm2: float, setting: str = ""
) -> Material:
    """A material of an estimate, to save and to design with."""
    return Material(
        identifier,
        identifier,
        Yarn(bending_modulus_n_mm2=bending_modulus_n_mm2),
        {fabric: _record(found, setting) for fabric, found in estimate.fabrics.items()},
        note="Estimated from the library's yarns: see the intervals of `knitcore estimate`.",
    )


def _record(found: FabricEstimate, setting: str) -> FabricRecord:
    deviations = {
        d: MEASURED_LOG_SD
        if found.measured
        else math.log(found.modulus[d].high / found.modulus[d].value) / Z_SCORE
        for d in Direction
    }
    return FabricRecord(
        fabric=found.fabric,
        law=found.law,
        stitch_course_mm=found.stitch_course_mm,
        stitch_wale_mm=found.stitch_wale_mm,
        stitch_size_source="the library's mean proportion of stitch to loop length",
        uncertainty=LawUncertainty(
            log_modulus_course=deviations[Direction.COURSE],
            log_modulus_wale=deviations[Direction.WALE],
            poisson_yx=0.02 if found.measured else 0.1,
            poisson_xy=0.02 if found.measured else 0.2,
            source="assumed: the paper's median"
            if found.measured
            else "yarns of the library left out",
        ),
        origin=Origin.FITTED if found.measured else Origin.ESTIMATED,
        loop_length_mm=found.loop_length_mm,
        setting=setting,
        measured=found.curves,
    )


def _fabric(found: FabricEstimate) -> FabricEstimateResult:
    return FabricEstimateResult(
        strain_at_0_1_n_per_mm=_intervals(found.strain_at_load),
        modulus_n_per_mm=_intervals(found.modulus),
        alpha=_intervals(found.alpha),
        beta_n_per_mm=_intervals(found.beta),
        law=LawResult.of(found.law),
        loop_length_mm=found.loop_length_mm,
        measured=found.measured,
    )


def _intervals(estimates: Mapping[Direction, Estimate]) -> dict[Direction, EstimateInterval]:
    return {
        d: EstimateInterval(value=e.value, low=e.low, high=e.high) for d, e in estimates.items()
    }


def _left_out(measured: tuple[Fabric, ...]) -> LeftOutResult:
    found = left_out(measured)
    return LeftOutResult(**{name: getattr(found, name) for name in LeftOutResult.model_fields})
