"""A yarn that is not in the library."""

from pathlib import Path
from typing import Any

import click
from pydantic import Field, ValidationError

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.formats.read.law_files import law_from_mapping, load_law
from knitcore.materials.estimate.estimate import (
    INTERVAL_SOURCE,
    FabricEstimate,
    MeasuredSwatch,
    YarnEstimate,
    estimate_yarn,
)
from knitcore.materials.estimate.estimated_material import estimated_material
from knitcore.materials.estimate.yarn_statistics import LeftOut, left_out
from knitcore.materials.material_document import MaterialDocument
from knitcore.materials.material_files import save_material_file

from ...cli.options import out_option
from ...context import Context
from ...requests.base import UNIT, Ends, IntervalResult, RequestModel, ResultModel
from ...requests.fabrics import LawResult, law_fields
from ..registry import Command, Operation


class SwatchInput(RequestModel):
    """A measured swatch of the yarn."""

    fabric: Fabric
    law: dict[str, float] = Field(description="Constants of its law, by name.")
    loop_length_mm: float
    setting: str = Field("", max_length=200, description="Needle or stitch setting.")


class YarnFacts(RequestModel):
    """Facts of the yarn and the product that a command takes as plain options."""

    bending_modulus_n_mm2: float = Field(
        description="Bending modulus B of the yarn (`measure bending`)."
    )
    product_setting: str = Field(
        "", max_length=200, description="Needle or stitch setting of the product."
    )


class EstimateRequest(YarnFacts):
    """The yarn, the product, and swatches of the yarn that were measured."""

    loop_length_mm: float | dict[Fabric, float] = Field(description="Yarn per stitch.")
    swatches: list[SwatchInput] = Field(default_factory=list, max_length=4)


class LeftOutResult(ResultModel, LeftOut):
    """Errors for the library's yarns when each is left out; rms errors are factors."""

    modulus_within_two: float = Field(description="Share predicted within a factor of two.")
    modulus_coverage: float = Field(description="Coverage of the 90 % intervals.")


class FabricEstimateResult(ResultModel):
    """One fabric; extension under load comes first because it is predicted best."""

    strain_at_0_1_n_per_mm: dict[Direction, float]
    strain_at_0_1_n_per_mm_interval: dict[Direction, Ends] = Field(
        description="Interval of the strain. Intervals have no width where the fabric is measured."
    )
    modulus_n_per_mm: dict[Direction, float]
    modulus_interval_n_per_mm: dict[Direction, Ends]
    alpha: dict[Direction, float]
    alpha_interval: dict[Direction, Ends]
    beta_n_per_mm: dict[Direction, float]
    beta_interval_n_per_mm: dict[Direction, Ends]
    law: LawResult
    loop_length_mm: float
    measured: bool


class EstimateResult(IntervalResult):
    """All four fabrics of the yarn."""

    fabrics: dict[Fabric, FabricEstimateResult]
    left_out: LeftOutResult | None = Field(
        description="Errors for yarns left out; null if all fabrics are measured."
    )
    material: MaterialDocument = Field(description="A material file of the four fabrics.")
    warnings: list[str]


def estimate(request: EstimateRequest, context: Context) -> EstimateResult:
    """Extension under load, moduli and laws of a yarn's four fabrics, with 90 % intervals.

    Raises
    ------
    InputError
        If no fabric can have the estimated law.
    """
    del context
    swatches = [
        MeasuredSwatch(s.fabric, law_from_mapping(s.law).law, s.loop_length_mm, s.setting)
        for s in request.swatches
    ]
    return _result(request.pass_to(estimate_yarn, swatches=swatches))


def _result(estimate: YarnEstimate) -> EstimateResult:
    measured = tuple(f for f, e in estimate.fabrics.items() if e.measured)
    return EstimateResult.of(
        estimate,
        fabrics={
            fabric: FabricEstimateResult.of(f, law=law_fields(f.law, LawResult), **_values(f))
            for fabric, f in estimate.fabrics.items()
        },
        interval_source=INTERVAL_SOURCE,
        left_out=left_out(measured) if len(measured) < len(Fabric) else None,
        material=_document(estimate),
    )


def _document(estimate: YarnEstimate) -> MaterialDocument:
    try:
        return MaterialDocument.from_material(estimated_material(estimate, "estimated"))
    except ValidationError as error:
        fault = error.errors()[0]
        raise InputError(
            "loop_length_mm",
            f"with this bending modulus gives a fabric that cannot exist: {fault['loc'][-1]},"
            f" {fault['msg'].lower()}.",
            "Compare both numbers with their units, mm and N·mm².",
        ) from error


def _values(fabric: FabricEstimate) -> dict[str, Any]:
    """Central values and intervals, by direction."""
    by_name = {
        ("strain_at_0_1_n_per_mm", ""): fabric.strain_at_load,
        ("modulus", UNIT): fabric.modulus,
        ("alpha", ""): fabric.alpha,
        ("beta", UNIT): fabric.beta,
    }
    values = {
        f"{name}{unit}": {d: estimate.value for d, estimate in known.items()}
        for (name, unit), known in by_name.items()
    }
    return values | {f"{name}_interval{unit}": known for (name, unit), known in by_name.items()}


@click.option(
    "--loop-length-mm",
    "lengths",
    multiple=True,
    metavar="MM | FABRIC=MM",
    help="Yarn per stitch of the product: one for all, or once per fabric.",
)
@click.option(
    "--swatch",
    "swatches",
    multiple=True,
    metavar="FABRIC=LAW",
    help="A measured swatch: LAW.json, a material file or a library id.",
)
@click.option(
    "--swatch-loop-length-mm",
    "swatch_lengths",
    multiple=True,
    metavar="MM | FABRIC=MM",
    help="Yarn per stitch of the swatches; by default that of the material, or the product's.",
)
@click.option("--swatch-setting", default="", help="Needle or stitch setting of the swatches.")
@out_option("--out", help="Write a material file.")
def _command(
    request: YarnFacts,
    context: Context,
    lengths: tuple[str, ...],
    swatches: tuple[str, ...],
    swatch_lengths: tuple[str, ...],
    swatch_setting: str,
    out: Path | None,
) -> EstimateResult:
    if not lengths:
        raise InputError("loop_length_mm", "is missing.", "Unravel ten stitches and measure.")
    product = _lengths(lengths, "loop_length_mm")
    own = _lengths(swatch_lengths, "swatch_loop_length_mm") if swatch_lengths else {}
    measured = [_swatch(text, own, product, swatch_setting, context) for text in swatches]
    made = request.pass_to(estimate_yarn, loop_length_mm=product, swatches=measured)
    if out is not None:
        identifier = out.stem.lower().replace(" ", "-")
        save_material_file(estimated_material(made, identifier), out)
    return _result(made)


def _lengths(texts: tuple[str, ...], field: str) -> dict[Fabric, float]:
    lengths: dict[Fabric, float] = {}
    for text in texts:
        name, _, number = text.rpartition("=")
        try:
            value = float(number)
        except ValueError:
            raise InputError(
                field, f"{text!r} is not a length.", "Write MM or FABRIC=MM."
            ) from None
        if name:
            lengths[Fabric.parse(name)] = value
        else:
            lengths = {fabric: lengths.get(fabric, value) for fabric in Fabric}
    return lengths


def _swatch(
    text: str,
    own: dict[Fabric, float],
    product: dict[Fabric, float],
    setting: str,
    context: Context,
) -> MeasuredSwatch:
    name, separator, source = text.partition("=")
    if not separator:
        raise InputError("swatch", f"{text!r} names no fabric.", "Write FABRIC=LAW.json.")
    fabric = Fabric.parse(name)
    path = Path(source)
    if path.suffix.lower() == ".json" and path.is_file() and '"fabrics"' not in path.read_text():
        file = load_law(path)
        law, length, known, curves = file.law, None, "", file.curves
    else:
        record = context.material(source).record(fabric)
        law, length, known = record.law, record.loop_length_mm, record.setting
        curves = record.measured
    length = own.get(fabric) or length or product.get(fabric)
    if length is None:
        raise InputError(
            "swatch_loop_length_mm", f"is missing for {fabric}.", "Unravel ten stitches."
        )
    return MeasuredSwatch(fabric, law, length, setting or known, curves)


def _lines(r: EstimateResult) -> list[str]:
    lines = ["extension at 0.1 N/mm (90 % interval), then Young's modulus in N/mm"]
    for fabric, f in r.fabrics.items():
        kind = " (measured)" if f.measured else ""
        for d in Direction:
            low, high = f.strain_at_0_1_n_per_mm_interval[d]
            strain = f"{f.strain_at_0_1_n_per_mm[d]:.0%} ({low:.0%} to {high:.0%})"
            low, high = f.modulus_interval_n_per_mm[d]
            lines.append(
                f"{fabric + kind:22} {d:6} {strain:24} {f.modulus_n_per_mm[d]:.4f}"
                f" ({low:.4f} to {high:.4f})"
            )
    if r.left_out is not None:
        lines += ["", _left_out_line(r.left_out)]
    return lines


def _left_out_line(r: LeftOutResult) -> str:
    """Figures of left-out yarns, in a line."""
    measured = " and ".join(r.measured) or "nothing"
    return (
        f"yarns left out, {measured} measured: extension within a factor {r.strain_rms_factor:.2f}"
        f" (rms), moduli {r.modulus_rms_factor:.2f} ({r.modulus_within_two:.0%} within two);"
        f" 90 % intervals cover {r.strain_coverage:.0%} and {r.modulus_coverage:.0%}"
        f" of {r.values} values"
    )


OPERATION = Operation(
    estimate,
    tag="materials",
    summary="The four fabrics of a yarn that is not in the library",
    example={"bending_modulus_n_mm2": 0.04, "loop_length_mm": 14.0},
    command=Command(_lines, run=_command, request=YarnFacts),
)
