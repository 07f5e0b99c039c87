"""Pressure of a knitted tube on a limb."""

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path

import click
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.formats.read.law_files import LawFile, law_from_mapping, load_law
from knitcore.garment.limb import tube_for, tube_pressure
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials.law_uncertainty import (
    Z_SCORE,
    Interval,
    LawUncertainty,
    in_a_sentence,
    log_deviation,
)
from knitcore.mechanics.pressure import (
    ELASTIC_MEAN,
    MMHG_PER_KPA,
    limb_pressure,
    rest_circumference,
)
from knitcore.prediction.predict import predict
from knitcore.prediction.prediction import Prediction

from ...context import Context
from ...requests.base import Ends, IntervalResult
from ...requests.charts import ChartInput, MaterialName, to_chart
from ...requests.fabrics import Gauged, LawsRequest
from ..registry import Command, Operation

NO_INTERVAL = "No interval: the law comes without standard errors."


class PressureRequest(Gauged, LawsRequest):
    """A tube on a limb: its law, or a fabric or chart of a material, and its sizes."""

    direction: Direction = Field(description="The material direction around the limb.")
    rest_mm: float | None = Field(None, description="Circumference of the unworn tube.")
    worn_mm: float = Field(description="Circumference of the limb.")
    target_mmhg: float | None = Field(
        None, description="Target pressure, in place of rest_mm: finds the size of the tube."
    )
    material: MaterialName | None = None
    fabric: Fabric | None = Field(None, description="A fabric of the material.")
    chart: ChartInput | None = Field(
        None, description="A chart of the material, in place of a fabric."
    )
    law: dict[str, float] | None = Field(None, description="Constants of a law, by name.")


class PressureResult(IntervalResult):
    """Mean pressure; no medical class."""

    mmhg: Ends = Field(description="Mean pressure, from axially free to axially fixed.")
    kpa: Ends
    mmhg_with_law_spread: Ends | None = Field(
        description="Mean pressure, widened by the 90 % interval of the fabric's stress, if known."
    )
    strain: float = Field(description="Strain around the limb.")
    rest_mm: float
    worn_mm: float
    tension_n_per_mm: Ends = Field(description="Hoop tension per worn length.")
    axial_strain_free: float
    lock_up_share: float | None = Field(
        description="Strain over lock-up strain; null for a chart, whose stitches differ."
    )
    rest_mm_for_target: Ends | None = Field(
        description="Sizes that give the target pressure, axially free to axially fixed."
    )
    warnings: list[str]
    law_source: str = Field(description="Source of the law; empty if unknown.")


def pressure(request: PressureRequest, context: Context) -> PressureResult:
    """An interval by Laplace's law with warnings, never a medical class.

    Raises
    ------
    InputError
        If neither or both of a law and a material are given, or not one of fabric and chart, or
        a gauge without a chart.
    """
    if request.gauge is not None and request.chart is None:
        raise InputError("gauge", "is that of a chart.", "Give the chart, or leave the gauge out.")
    if request.law is None and request.material is None:
        raise InputError("material", "is missing.", "Give a material, or a law.")
    if request.law is not None and request.material is not None:
        raise InputError("law", "material is given as well.", "Give one of the two.")
    if request.material is None:
        return _of_file(law_from_mapping(request.law or {}), request)
    material = context.material(request.material)
    if request.chart is not None and request.fabric is None:
        answer = predict(to_chart(request.chart), material, request.relaxed_size)
        return _of_answer(answer, request)
    if request.fabric is None:
        raise InputError("fabric", "is missing.", "Give a fabric, or a chart.")
    if request.chart is not None:
        raise InputError("chart", "fabric is given as well.", "Give one of the two.")
    record = material.record(request.fabric)
    return _of_law(record.law, request, uncertainty=record.uncertainty, source=record.law_source)


def _of_answer(answer: Prediction, request: PressureRequest) -> PressureResult:
    along = answer.along(request.direction)
    rest, sizes = _sizes(request, partial(tube_for, along))
    pressure = tube_pressure(along, rest, request.worn_mm)
    return PressureResult.of(
        pressure,
        mmhg=pressure.kpa.scaled(MMHG_PER_KPA),
        mmhg_with_law_spread=pressure.kpa_with_spread.scaled(MMHG_PER_KPA),
        lock_up_share=None,
        rest_mm_for_target=sizes,
        warnings=[ELASTIC_MEAN],
        law_source=str(answer.provenance),
        interval_source=in_a_sentence(answer.stretch_errors),
    )


def _of_file(file: LawFile, request: PressureRequest) -> PressureResult:
    direction = request.direction
    error = file.standard_errors.get(f"modulus_{direction}")
    uncertainty = None
    if error is not None:
        spread = log_deviation(file.law.modulus(direction), error)
        source = "standard error of the modulus in the law's file"
        uncertainty = LawUncertainty(spread, spread, 0.0, 0.0, source)
    tested = file.largest_strain.get(direction)
    return _of_law(file.law, request, uncertainty=uncertainty, source=file.source, tested=tested)


def _of_law(
    law: ConstitutiveLaw,
    request: PressureRequest,
    *,
    uncertainty: LawUncertainty | None,
    source: str,
    tested: float | None = None,
) -> PressureResult:
    direction, worn = request.direction, request.worn_mm
    rest, sizes = _sizes(request, partial(rest_circumference, law, direction))
    pressure = limb_pressure(law, direction, rest, worn, tested_strain=tested)
    widened = None
    if uncertainty is not None:
        spread = uncertainty.log_stress(direction, pressure.tension_n_per_mm.low)
        factor = math.exp(Z_SCORE * float(spread))
        widened = pressure.mmhg.low / factor, pressure.mmhg.high * factor
    return PressureResult.of(
        pressure,
        mmhg_with_law_spread=widened,
        rest_mm=rest,
        worn_mm=worn,
        lock_up_share=pressure.utilisation,
        rest_mm_for_target=sizes,
        law_source=source,
        interval_source=in_a_sentence([uncertainty.source]) if uncertainty else NO_INTERVAL,
    )


def _sizes(
    request: PressureRequest, sizes_for: Callable[[float, float], Interval]
) -> tuple[float, Interval | None]:
    """The tube's circumference (mm), and the sizes for a wanted pressure if one is given."""
    if request.target_mmhg is None and request.rest_mm is not None:
        return request.rest_mm, None
    if request.target_mmhg is None:
        raise InputError("rest_mm", "is missing.", "Give rest_mm, or a target_mmhg.")
    if request.rest_mm is not None:
        raise InputError("target_mmhg", "rest_mm is given as well.", "Give one of the two.")
    sizes = sizes_for(request.worn_mm, request.target_mmhg)
    return math.sqrt(sizes.low * sizes.high), sizes


@click.option(
    "--law",
    type=click.Path(path_type=Path),
    help="LAW.json (see `knitcore fit`), in place of a material.",
)
def _command(request: PressureRequest, context: Context, law: Path | None) -> PressureResult:
    if law is None:
        return pressure(request, context)
    if request.material is not None:
        raise InputError("law", "--material is given as well.", "Give one of the two.")
    return _of_file(load_law(law), request)


def _lines(r: PressureResult) -> list[str]:
    (low, high), (low_kpa, high_kpa) = r.mmhg, r.kpa
    locked = "" if r.lock_up_share is None else f" ({r.lock_up_share:.0%} of the lock-up)"
    lines = [
        f"pressure  {low:.1f} to {high:.1f} mmHg "
        f"({low_kpa:.2f} to {high_kpa:.2f} kPa), axially free to fixed",
        f"strain    {r.strain:.3f} around the limb{locked}",
    ]
    if r.mmhg_with_law_spread is not None:
        low, high = r.mmhg_with_law_spread
        lines.append(f"          {low:.1f} to {high:.1f} mmHg with the law's uncertainty")
    if r.rest_mm_for_target is not None:
        low, high = r.rest_mm_for_target
        lines.append(f"size      {low:.1f} to {high:.1f} mm unworn; middle shown above")
    return lines


OPERATION = Operation(
    pressure,
    tag="mechanics",
    summary="Pressure of a knitted tube on a limb",
    example={
        "material": "acrylic",
        "fabric": "rib",
        "direction": "course",
        "rest_mm": 150.0,
        "worn_mm": 180.0,
    },
    command=Command(
        _lines,
        more="It is an interval, never a medical class.",
        names={"law": None, "chart": None, "gauge": None},
        run=_command,
    ),
)
