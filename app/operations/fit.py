"""Fitting a law to stretch tests."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from app.models.uploads import UploadedFile, stored
from app.operations.materials import LawResult
from knitcore.fabric import Direction
from knitcore.materials.document import CurveDocument
from knitcore.measure.uniaxial import LawFit, Reduction, Residuals, fit_files

FileFormat = Literal["csv", "h5"]
PLOTTED_POINTS = 2000
"""Points of a residual plot; more than a screen shows."""


class FitRequest(BaseModel):
    """Two stretch tests of one fabric."""

    model_config = ConfigDict(extra="forbid")

    test_course: UploadedFile = Field(description="Pulled along the rows; HDF5 or CSV.")
    test_wale: UploadedFile = Field(description="Pulled along the columns.")
    format: FileFormat | None = Field(None, description="Found out from the content if not given.")
    reduction: Reduction = Reduction.RECOMMENDED
    residuals: bool = Field(False, description="Whether to return points beside the fit.")


class LawErrors(BaseModel):
    """Standard errors of a law's constants."""

    stiffness_xxxx_n_per_mm: float
    stiffness_yyyy_n_per_mm: float
    stiffness_xxyy_n_per_mm: float
    stiffness_yyxx_n_per_mm: float
    alpha_xx: float
    alpha_yy: float
    beta_xx_n_per_mm: float
    beta_yy_n_per_mm: float
    poisson_yx: float
    poisson_xy: float
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float


class ResidualPoints(BaseModel):
    """Measured points and the fitted stress there."""

    strain_along: list[float]
    strain_across: list[float]
    stress_n_per_mm: list[float]
    fitted_n_per_mm: list[float]


class FitResult(LawResult):
    """The constants of a law (its shear modulus is an assumption), with their uncertainty."""

    standard_errors: LawErrors
    poisson_yx: float = Field(description="Contraction wale-wise when pulled course-wise.")
    poisson_xy: float = Field(description="Contraction course-wise when pulled wale-wise.")
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    rms_n_per_mm: float = Field(description="Of all residuals.")
    rms_course_n_per_mm: float
    rms_wale_n_per_mm: float
    largest_strain: dict[Direction, float] = Field(description="Up to where the law was fitted.")
    runs: dict[Direction, int] = Field(description="Pulls used.")
    reduction: Reduction
    error_method: str
    notes: list[str]
    residuals: dict[Direction, ResidualPoints] | None = None
    curves: dict[Direction, CurveDocument] = Field(
        description="Median curve of the pulls in each direction; kept with the law in a file."
    )


def run_fit(request: FitRequest, *, cancelled: Callable[[], bool] | None = None) -> FitResult:
    """The fit that a request asks for (a tenth of a second: it does not look at ``cancelled``)."""
    del cancelled
    with stored([request.test_course, request.test_wale]) as (course, wale):
        fit = fit_paths(course, wale, request.reduction, request.format)
    return fit_result(fit, residuals=request.residuals)


def fit_paths(
    course: Path, wale: Path, reduction: Reduction, file_format: FileFormat | None = None
) -> LawFit:
    """The fit to two files."""
    return fit_files(course, wale, reduction=reduction, file_format=file_format)


def fit_result(fit: LawFit, *, residuals: bool = False) -> FitResult:
    """The numbers of a fit."""
    errors = fit.standard_errors
    return FitResult(
        **LawResult.of(fit.law).model_dump(),
        standard_errors=LawErrors(
            **{name: errors[name.removesuffix("_n_per_mm")] for name in LawErrors.model_fields}
        ),
        poisson_yx=fit.law.poisson_yx,
        poisson_xy=fit.law.poisson_xy,
        modulus_course_n_per_mm=fit.law.modulus_course,
        modulus_wale_n_per_mm=fit.law.modulus_wale,
        rms_n_per_mm=fit.rms_n_per_mm,
        rms_course_n_per_mm=fit.rms_course_n_per_mm,
        rms_wale_n_per_mm=fit.rms_wale_n_per_mm,
        largest_strain=fit.largest_strain,
        runs=fit.runs,
        reduction=fit.reduction,
        error_method=fit.error_method,
        notes=list(fit.notes),
        residuals={d: _points(r) for d, r in fit.residuals.items()} if residuals else None,
        curves={d: CurveDocument.from_curve(c) for d, c in fit.curves.items()},
    )


def _points(residuals: Residuals) -> ResidualPoints:
    step = max(1, -(-len(residuals.stress) // PLOTTED_POINTS))
    part = slice(None, None, step)
    return ResidualPoints(
        strain_along=residuals.strain_along[part].tolist(),
        strain_across=residuals.strain_across[part].tolist(),
        stress_n_per_mm=residuals.stress[part].tolist(),
        fitted_n_per_mm=residuals.fitted[part].tolist(),
    )
