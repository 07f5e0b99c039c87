"""``knitcore fit``."""

from __future__ import annotations

import csv
from pathlib import Path

import click

from app.cli.common import check_writable, choice, emit, json_option
from app.operations.fit import FileFormat, FitResult, fit_paths, fit_result
from knitcore.formats.law_files import LawFile, save_law
from knitcore.measure.uniaxial import LawFit, Reduction


@click.command("fit")
@click.argument("test_course", type=click.Path(path_type=Path))
@click.argument("test_wale", type=click.Path(path_type=Path))
@click.option(
    "--format", "file_format", type=click.Choice(["csv", "h5"]), help="Otherwise found out."
)
@click.option(
    "--reduction",
    type=choice(Reduction),
    default=Reduction.RECOMMENDED.value,
    show_default=True,
    help="published: as in the paper; recommended: clamp to clamp, every pull counts the same.",
)
@click.option("--out", type=click.Path(path_type=Path), help="Write the law to LAW.json.")
@click.option(
    "--residuals", type=click.Path(path_type=Path), help="Write points and fit to FILE.csv."
)
@json_option
def command(
    test_course: Path,
    test_wale: Path,
    file_format: FileFormat | None,
    reduction: str,
    out: Path | None,
    residuals: Path | None,
    as_json: bool,
) -> None:
    """Fit a law to a course-wise and a wale-wise stretch test (HDF5 or CSV)."""
    check_writable(out, "out")
    check_writable(residuals, "residuals")
    fit = fit_paths(test_course, test_wale, Reduction(reduction), file_format)
    if out is not None:
        source = f"fitted to {test_course.name} and {test_wale.name}, {fit.reduction} reduction"
        file = LawFile(fit.law, source, fit.standard_errors, fit.largest_strain, fit.curves)
        save_law(file, out)
    if residuals is not None:
        _write_residuals(fit, residuals)
    result = fit_result(fit)
    emit(result, _text(result), as_json=as_json)


def _write_residuals(fit: LawFit, path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(
            ["direction", "strain_along", "strain_across", "stress_n_per_mm", "fitted_n_per_mm"]
        )
        for direction, r in fit.residuals.items():
            columns = zip(r.strain_along, r.strain_across, r.stress, r.fitted, strict=True)
            writer.writerows([str(direction), *map(float, row)] for row in columns)


def _text(r: FitResult) -> str:
    lines = []
    for name, error in r.standard_errors.model_dump().items():
        unit = " N/mm" if name.endswith("_n_per_mm") else ""
        value = getattr(r, name)
        lines.append(f"{name.removesuffix('_n_per_mm'):16} {value:9.4f} ± {error:.4f}{unit}")
    lines += [
        f"residuals        {r.rms_n_per_mm:.4f} N/mm rms "
        f"(course {r.rms_course_n_per_mm:.4f}, wale {r.rms_wale_n_per_mm:.4f})",
        f"reduction        {r.reduction}; errors: {r.error_method}",
        *(f"note: {note}" for note in r.notes),
    ]
    return "\n".join(lines)
