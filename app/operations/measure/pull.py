"""A yarn after one stretch test of one of its fabrics."""

from pathlib import Path

from pydantic import Field

from knitcore.chart.fabric import Direction, Fabric
from knitcore.design.certainty import unexpected
from knitcore.materials import Material
from knitcore.materials.estimate.pull_points import points_of_test
from knitcore.materials.estimate.pulled import pulled
from knitcore.materials.estimate.yarn_statistics import LOAD_N_PER_MM
from knitcore.materials.material_document import MaterialDocument
from knitcore.materials.material_files import save_material_file
from knitcore.measure.table_reading import TableReading
from knitcore.measure.uniaxial_files import read_stretch_test
from knitcore.prediction.pure import predict_pure

from ...cli.options import out_option
from ...context import Context
from ...requests.base import Ends, IntervalResult, RequestModel, ResultModel
from ...requests.charts import MaterialName
from ...requests.uploads import UploadedFile, example_file, stored
from ..registry import Command, Operation


class PullRequest(RequestModel):
    """One stretch test of a pure fabric of a yarn."""

    test: UploadedFile = Field(description="HDF5, CSV or XLSX; one pull is enough.")
    material: MaterialName
    fabric: Fabric
    direction: Direction = Field(description="Pulled along the rows, or along the columns.")
    width_mm: float | None = Field(None, ge=5, le=10_000, description="Clamped width.")
    length_mm: float | None = Field(
        None, ge=5, le=10_000, description="Distance of the clamps at rest."
    )


class PulledFabric(ResultModel):
    """Extension of a fabric at 0.1 N/mm in one direction, before and after the pull."""

    fabric: Fabric
    direction: Direction
    before: float
    before_interval: Ends
    after: float
    after_interval: Ends


class UpdatedYarnResult(IntervalResult):
    """The yarn after the pull, and what it changed."""

    fabrics: list[PulledFabric]
    warning: str = Field(description="What to check of a pull that was not expected; else empty.")
    material: MaterialDocument = Field(description="A material file of the yarn.")


def pull(request: PullRequest, context: Context) -> UpdatedYarnResult:
    """Laws and intervals of a yarn's fabrics as one pull leaves them.

    If its laws were estimated, all fabrics follow; laws with tests of their own err each by itself,
    so that only the fabric that was pulled follows.

    Raises
    ------
    InputError
        If the yarn lacks the fabric, or the test cannot be read or ends too early.
    """
    before = context.material(request.material)
    reading = TableReading(width_mm=request.width_mm, length_mm=request.length_mm)
    with stored([request.test]) as (path,):
        test = read_stretch_test(path, reading=reading)
    points = points_of_test(test, request.fabric, request.direction)
    updated = pulled(before, points)
    note = f"{before.note} Updated by {request.test.name}.".strip()
    after = Material("own-yarn", f"{before.name}, pulled", before.yarn, updated.fabrics, note)
    return UpdatedYarnResult(
        fabrics=[_changed(fabric, d, before, after) for fabric in after.fabrics for d in Direction],
        warning=unexpected(points, before),
        material=MaterialDocument.from_material(after),
        interval_source=after.record(request.fabric).uncertainty.source,
    )


def _changed(
    fabric: Fabric, direction: Direction, before: Material, after: Material
) -> PulledFabric:
    old, new = (predict_pure(fabric, yarn).along(direction) for yarn in (before, after))
    return PulledFabric(
        fabric=fabric,
        direction=direction,
        before=float(old.strain(LOAD_N_PER_MM)),
        before_interval=old.strain_interval(LOAD_N_PER_MM),
        after=float(new.strain(LOAD_N_PER_MM)),
        after_interval=new.strain_interval(LOAD_N_PER_MM),
    )


@out_option("--out", help="Write a material file.")
def _command(request: PullRequest, context: Context, out: Path | None) -> UpdatedYarnResult:
    result = pull(request, context)
    if out is not None:
        save_material_file(result.material.to_material(), out)
    return result


def _lines(r: UpdatedYarnResult) -> list[str]:
    lines = [f"{'at 0.1 N/mm':22} {'before':28} after"]
    for of in r.fabrics:
        before, after = (
            f"{strain:.0%} ({low:.0%} to {high:.0%})"
            for strain, (low, high) in (
                (of.before, of.before_interval),
                (of.after, of.after_interval),
            )
        )
        lines.append(f"{of.fabric + ', ' + of.direction:22} {before:28} {after}")
    return [*lines, *([r.warning] if r.warning else [])]


OPERATION = Operation(
    pull,
    path="/measure/pull",
    tag="measure",
    summary="A yarn after one stretch test of one of its fabrics",
    example={
        "test": example_file("course.csv"),
        "material": "cotton",
        "fabric": "rib",
        "direction": "course",
    },
    command=Command(_lines, run=_command),
)
