"""The atlas of a material: the mechanics of every small repeat."""

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Literal, get_args

import click
from pydantic import BeforeValidator, Field

from knitcore.chart.fabric import Direction
from knitcore.design.atlas import INTERVAL_SOURCE, VALUES, Atlas
from knitcore.design.atlas_build import build_atlas
from knitcore.design.targets import USUAL_LOAD_N_PER_MM

from ...cli.options import out_option
from ...context import Context
from ...requests.base import IntervalResult
from ...requests.charts import MaterialName, RepeatText
from ...requests.fabrics import LawsRequest
from ...service.results.atlases import EXTENTS, Extent, repeats_of
from ..registry import Command, Operation

DIGITS = 5


def _rounded(values: Iterable[float]) -> list[float]:
    return [float(f"{value:.{DIGITS}g}") for value in values]


Values = Annotated[list[float], BeforeValidator(_rounded)]


class AtlasRequest(LawsRequest):
    """The atlas to compute."""

    material: MaterialName
    repeats: Extent = Field("small", description=EXTENTS)


class AtlasResult(IntervalResult):
    """An atlas as columns, for the rigidity-rigidity scatter."""

    kind: Literal["atlas"] = "atlas"
    material: str
    repeats: list[RepeatText]
    modulus_course_n_per_mm: Values
    modulus_course_interval_n_per_mm: tuple[Values, Values]
    modulus_wale_n_per_mm: Values
    modulus_wale_interval_n_per_mm: tuple[Values, Values]
    poisson_yx: Values
    poisson_xy: Values
    stretch_course: Values = Field(description="Strain at 0.1 N/mm.")
    stretch_wale: Values
    relaxed_course_mm: Values = Field(description="Width of the mean stitch at rest.")
    relaxed_wale_mm: Values = Field(description="Height of the mean stitch at rest.")
    transfers_per_stitch: Values
    crossings_per_stitch: Values
    curl: Values
    provenance: list[str]


COLUMNS = [name for name in AtlasResult.model_fields if name in VALUES]
COSTS = ("transfers_per_stitch", "crossings_per_stitch", "curl")


def atlas(request: AtlasRequest, context: Context) -> AtlasResult:
    """Columns for a scatter of stiffness course-wise against wale-wise."""
    return _result(context.atlas(request.material, request.repeats))


def _result(atlas: Atlas) -> AtlasResult:
    return AtlasResult.of(
        atlas,
        repeats=atlas.keys,
        interval_source=INTERVAL_SOURCE,
        **{name: atlas.column(name) for name in COLUMNS},
        **{
            f"modulus_{d}_interval_n_per_mm": [
                atlas.column(f"modulus_{d}_{end}") for end in ("low", "high")
            ]
            for d in Direction
        },
        **{name: [getattr(cost, name) for cost in atlas.costs] for name in COSTS},
        **{f"stretch_{d}": atlas.strain_at(d, USUAL_LOAD_N_PER_MM) for d in Direction},
    )


@out_option("-o", "--out", required=True, help="FILE.npz", suffixes=(".npz",))
@click.option(
    "--repeats", type=click.Choice(get_args(Extent)), default="all", show_default=True, help=EXTENTS
)
@click.option("--workers", type=click.IntRange(1), help="Processes; all cores if left out.")
@click.option("--scheduler", metavar="tcp://…", help="Address of a Dask cluster to work on.")
def _command(
    request: AtlasRequest,
    context: Context,
    out: Path,
    repeats: Extent,
    workers: int | None,
    scheduler: str | None,
    as_json: bool,
) -> AtlasResult:
    atlas = build_atlas(
        context.material(request.material),
        repeats_of(repeats),
        file=out,
        workers=workers,
        scheduler=scheduler,
        progress=None if as_json else _show_progress,
    )
    return _result(atlas)


def _show_progress(done: int, total: int) -> None:
    click.echo(f"\r{done} of {total} repeats", nl=done == total, err=True)


def _lines(r: AtlasResult) -> list[str]:
    course, wale = r.modulus_course_n_per_mm, r.modulus_wale_n_per_mm
    sources = ", ".join(f"{n} {source}" for source, n in Counter(r.provenance).most_common())
    return [
        f"{len(r.repeats)} repeats of {r.material}; "
        f"course {min(course):.4f} to {max(course):.4f} N/mm, "
        f"wale {min(wale):.4f} to {max(wale):.4f} N/mm; laws: {sources}"
    ]


OPERATION = Operation(
    atlas,
    tag="design",
    summary="Predicted constants of all small repeats of a material",
    example={"material": "acrylic"},
    job=True,
    command=Command(
        _lines,
        more="A stopped run continues where it left off.",
        names={"repeats": None},
        run=_command,
    ),
)
