"""Fitting a law to stretch tests."""

from pathlib import Path
from typing import Annotated, Any, Literal

import click
import numpy as np
from pydantic import Field, ValidationError

from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.fabric import Direction
from knitcore.fit.pull_fit import LawFit, Reduction, Residuals
from knitcore.fit.strip_fit import fit_tests
from knitcore.formats.read.law_files import LawFile, save_law
from knitcore.materials.material_document import CurveDocument
from knitcore.measure.table_reading import TableReading
from knitcore.measure.uniaxial_files import read_stretch_test

from ...cli.options import out_option, write_table
from ...context import Context
from ...requests.base import Floats, RequestModel, ResultModel, first_fault
from ...requests.fabrics import ElasticConstants, LawConstants, LawResult, law_fields
from ...requests.faults import CheckedBy
from ...requests.tables import TableTemplate, Title, reading_of
from ...requests.uploads import UploadedFile, example_file, stored
from ..registry import Command, Operation

PLOTTED_POINTS = 2000
"""Largest number of points of a residual plot: more than a screen resolves."""


_ANY_SIZE = TableReading(width_mm=100.0, length_mm=100.0)


def _read(file: UploadedFile, _: Context) -> None:
    with stored([file]) as (path,):
        read_stretch_test(path, reading=_ANY_SIZE)


class FitRequest(RequestModel):
    """Two stretch tests of one fabric."""

    test_course: Annotated[UploadedFile, CheckedBy(_read)] = Field(
        description="Test pulled along the rows; HDF5, CSV or XLSX."
    )
    test_wale: Annotated[UploadedFile, CheckedBy(_read)] = Field(
        description="Test pulled along the columns."
    )
    format: Literal["csv", "h5"] | None = Field(
        None, description="Format of the tests; recognised from the content if not given."
    )
    reduction: Reduction = Field(
        Reduction.RECOMMENDED,
        description="recommended: force and waist of the simulated test, clamp to clamp; uniform: "
        "clamp to clamp, as if the cloth strained evenly; published: as in the paper.",
    )
    width_course_mm: float | None = Field(
        None, ge=5, le=10_000, description="Clamped width, in place of the course-wise test's."
    )
    width_wale_mm: float | None = Field(
        None, ge=5, le=10_000, description="Clamped width, in place of the wale-wise test's."
    )
    length_course_mm: float | None = Field(
        None, ge=5, le=10_000, description="Distance of the clamps at rest, course-wise test."
    )
    length_wale_mm: float | None = Field(
        None, ge=5, le=10_000, description="Distance of the clamps at rest, wale-wise test."
    )
    columns: dict[str, Title] | None = Field(
        None,
        max_length=10,
        description="What a tester's table calls our columns: strain_along or extension_mm, "
        'strain_across, force_n, width_mm; such as {"force_n": "Channel 2 (N)"}.',
    )
    template_course: TableTemplate | None = Field(
        None, description="How the course-wise table is read; the fields above come first."
    )
    template_wale: TableTemplate | None = Field(None, description="The same of the other table.")
    residuals: bool = Field(False, description="Return residuals at each point too.")


class LawErrors(ElasticConstants, LawConstants):
    """Standard errors of a law's constants."""

    shear_modulus_n_per_mm: float | None = Field(
        None,
        description="Error with the recommended reduction only; mostly that of its prior, a factor "
        "of 1.5.",
    )
    kappa_xx: float | None = None
    kappa_yy: float | None = None


class ResidualPoints(ResultModel):
    """Measured points and the fitted stress there."""

    strain_along: Floats
    strain_across: Floats = Field(description="Empty where it was not measured.")
    stress_n_per_mm: Floats
    fitted_n_per_mm: Floats


class FitResult(ElasticConstants, LawResult):
    """The constants of a law with their uncertainty."""

    kind: Literal["fit"] = "fit"
    standard_errors: LawErrors
    rms_n_per_mm: float = Field(description="Rms of all residuals.")
    rms_course_n_per_mm: float
    rms_wale_n_per_mm: float
    largest_strain: dict[Direction, float] = Field(description="Largest strain of the fit.")
    runs: dict[Direction, int] = Field(description="Number of pulls used.")
    reduction: Reduction
    error_method: str
    notes: list[str]
    waist_rms: dict[Direction, float] | None = Field(
        None,
        description="Rms of the simulated minus the measured strain of the waist (recommended "
        "reduction).",
    )
    residuals: dict[Direction, ResidualPoints] | None = None
    curves: dict[Direction, CurveDocument] = Field(
        description="Median curve of the pulls in each direction; kept with the law in a file."
    )


def fit(request: FitRequest, context: Context) -> FitResult:
    """A law with standard errors from a course-wise and a wale-wise test."""
    return _result(_fit(request, context), residuals=request.residuals)


def _fit(request: FitRequest, context: Context) -> LawFit:
    with stored([request.test_course, request.test_wale]) as (course, wale):
        return request.pass_to(
            fit_tests,
            course,
            wale,
            file_format=request.format,
            template_course=reading_of(request.template_course),
            template_wale=reading_of(request.template_wale),
            cancelled=context.cancelled,
        )


def _result(fit: LawFit, *, residuals: bool) -> FitResult:
    errors = fit.standard_errors
    names = {name: name.removesuffix("_n_per_mm") for name in LawErrors.model_fields}
    return FitResult.of(
        fit,
        **law_fields(fit.law, ElasticConstants, LawResult),
        standard_errors={name: errors.get(constant) for name, constant in names.items()},
        residuals={d: _points(r) for d, r in fit.residuals.items()} if residuals else None,
        curves={d: CurveDocument.from_curve(c) for d, c in fit.curves.items()},
    )


def _points(residuals: Residuals) -> ResidualPoints:
    step = max(1, -(-len(residuals.stress) // PLOTTED_POINTS))
    across = residuals.strain_across
    return ResidualPoints(
        strain_along=residuals.strain_along[::step],
        strain_across=across[::step] if np.isfinite(across).all() else [],
        stress_n_per_mm=residuals.stress[::step],
        fitted_n_per_mm=residuals.fitted[::step],
    )


@click.option(
    "--column",
    multiple=True,
    metavar="NAME=TITLE",
    help="What a tester's table calls one of our columns, such as 'force_n=Channel 2 (N)'.",
)
@click.option(
    "--template",
    multiple=True,
    type=click.Path(path_type=Path),
    help="How the tables are read: FILE.json of the page; a second one is for the second test.",
)
def _columns(column: tuple[str, ...], template: tuple[Path, ...]) -> dict[str, Any]:
    pairs = [text.partition("=") for text in column]
    for (_, sign, _), text in zip(pairs, column, strict=True):
        if not sign:
            remedy = "Write our name and the table's: force_n=Load."
            raise InputError("column", f"{text!r} does not say which column is which.", remedy)
    if len(template) > len(Direction):
        raise InputError("template", "There are more than two.", "Give one, or one for each test.")
    documents = [_template(path) for path in template]
    both = documents * 2 if len(documents) == 1 else documents
    return {
        "columns": {name.strip(): title.strip() for name, _, title in pairs} or None,
        **dict(zip(("template_course", "template_wale"), both, strict=False)),
    }


@in_reading_time
def _template(path: Path) -> TableTemplate:
    try:
        return TableTemplate.model_validate_json(path.read_bytes())
    except OSError:
        raise InputError("template", f"{path} cannot be read.", "Check its name.") from None
    except ValidationError as error:
        remedy = "Save it on the page, or write columns, units, width_mm and length_mm as JSON."
        raise InputError("template", f"{path.name}: {first_fault(error)}.", remedy) from None


@out_option("--residuals", help="Write points and fit to FILE.csv.")
@out_option("--out", help="Write the law to LAW.json.")
def _command(
    request: FitRequest, context: Context, out: Path | None, residuals: Path | None
) -> FitResult:
    fit = _fit(request, context)
    if out is not None:
        tests = f"{request.test_course.name} and {request.test_wale.name}"
        source = f"fitted to {tests}, {fit.reduction} reduction"
        file = LawFile(fit.law, source, fit.standard_errors, fit.largest_strain, fit.curves)
        save_law(file, out)
    if residuals is not None:
        points = (
            (direction, *map(float, row))
            for direction, r in fit.residuals.items()
            for row in zip(r.strain_along, r.strain_across, r.stress, r.fitted, strict=True)
        )
        write_table(residuals, ["direction", *ResidualPoints.model_fields], points)
    return _result(fit, residuals=False)


def _lines(r: FitResult) -> list[str]:
    lines = []
    for name, error in r.standard_errors.model_dump(exclude_none=True).items():
        unit = " N/mm" if name.endswith("_n_per_mm") else ""
        value = getattr(r, name)
        lines.append(f"{name.removesuffix('_n_per_mm'):16} {value:9.4f} ± {error:.4f}{unit}")
    lines += [
        f"residuals        {r.rms_n_per_mm:.4f} N/mm rms "
        f"(course {r.rms_course_n_per_mm:.4f}, wale {r.rms_wale_n_per_mm:.4f})",
        f"reduction        {r.reduction}; errors: {r.error_method}",
    ]
    return lines


OPERATION = Operation(
    fit,
    tag="measure",
    summary="A law from two stretch tests",
    example={"test_course": example_file("course.csv"), "test_wale": example_file("wale.csv")},
    job=True,
    command=Command(
        _lines,
        more="Each is an HDF5, CSV or XLSX file.",
        names=dict.fromkeys(("residuals", "columns", "template_course", "template_wale")),
        run=_command,
        fields=_columns,
    ),
)
