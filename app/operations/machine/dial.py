"""The stitch number for a loop length, from the swatches in a machine's profile."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import click
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.machine.dial import Dial, DialSetting, with_swatches
from knitcore.machine.profile import MAX_BYTES, DialSwatch, machine_of
from knitcore.machine.setting import yarn_identifier
from knitcore.materials import Material

from ...cli.options import out_option
from ...context import Context
from ...requests.base import Ends, IntervalResult, RequestModel
from ...requests.charts import MaterialName
from ..files.machines import machine_text
from ..registry import Command, Operation


class DialSwatchInput(RequestModel):
    """A swatch at a stitch number, and its yarn per stitch."""

    number: float = Field(ge=0, le=1000, description="Stitch number that it was knitted with.")
    loop_length_mm: float = Field(
        gt=0, le=100, description="Yarn per stitch: unravel ten stitches and divide by ten."
    )


class DialRequest(RequestModel):
    """A machine, a yarn, and swatches of it."""

    machine: str = Field(
        max_length=MAX_BYTES,
        description="A machine's name, or a profile of one's own as JSON, which keeps swatches.",
    )
    material: MaterialName = Field("acrylic", description="Material of the yarn.")
    loop_length_mm: float | None = Field(
        None, gt=0, le=100, description="Yarn of a stitch; the material's if left out."
    )
    swatches: list[DialSwatchInput] = Field(
        default_factory=list,
        max_length=50,
        description="Two at different numbers make it sure; they replace those of this yarn in "
        "the profile.",
    )


class DialResult(IntervalResult):
    """A stitch number."""

    machine: str
    material: str
    number: float
    exact: float = Field(description="Before rounding to what the machine can be set to.")
    exact_interval: Ends
    loop_length_mm: float = Field(description="What that number gives.")
    loop_length_interval_mm: Ends
    guessed: bool = Field(description="Whether no swatch stands behind it.")
    swatches: list[DialSwatchInput] = Field(description="Of this yarn, in the profile.")
    profile: str = Field(description="The machine's profile with the swatches, JSON, to keep.")


def dial(request: DialRequest, context: Context) -> DialResult:
    """The stitch number that gives a loop length, by swatches or else by a guess from the gauge.

    Raises
    ------
    InputError
        If no number gives it, or the swatches cannot be right.
    """
    material = context.material(request.material)
    yarn = yarn_identifier(material)
    machine = machine_of(request.machine)
    if request.swatches:
        others = tuple(swatch for swatch in machine.swatches if swatch.yarn != yarn)
        swatches = [DialSwatch(s.number, s.loop_length_mm, yarn) for s in request.swatches]
        machine = with_swatches(replace(machine, swatches=others), swatches)
    fit = Dial(machine, yarn)
    return DialResult.of(
        _setting(fit, material, request.loop_length_mm),
        machine=machine.name,
        material=yarn,
        swatches=[
            DialSwatchInput(number=s.number, loop_length_mm=s.loop_length_mm) for s in fit.swatches
        ],
        profile=machine.to_json(),
        interval_source=f"S{str(fit)[1:]}.",
    )


def _setting(fit: Dial, material: Material, loop_length_mm: float | None) -> DialSetting:
    """The number for a loop length, or the nearest one for that of the material."""
    if loop_length_mm is not None:
        return fit.setting(loop_length_mm)
    known = [r.loop_length_mm for r in material.fabrics.values() if r.loop_length_mm]
    if not known:
        known = [fit.loop_length_mm(fit.machine.stitch_number.default)[0]]
    return fit.nearest(sum(known) / len(known))


@click.option(
    "--swatch",
    "swatches",
    multiple=True,
    metavar="NUMBER=MM",
    help="Yarn per stitch of a swatch at a stitch number, such as 6=10.4; repeatable.",
)
def _swatches(swatches: tuple[str, ...]) -> dict[str, Any]:
    """The swatches of options."""
    given = []
    for text in swatches:
        number, _, length = text.partition("=")
        try:
            given.append({"number": float(number), "loop_length_mm": float(length)})
        except ValueError:
            raise InputError(
                "swatch", f"{text[:40]!r} is no number and length.", "Write it as 6=10.4."
            ) from None
    return {"swatches": given}


@out_option("-o", "--out", help="Write the machine's profile with the swatches to FILE.")
def _command(request: DialRequest, context: Context, out: Path | None) -> DialResult:
    request = request.model_copy(update={"machine": machine_text(request.machine)})
    result = dial(request, context)
    if out is not None:
        out.write_text(result.profile, encoding="utf-8")
    return result


def _lines(result: DialResult) -> list[str]:
    low, high = result.loop_length_interval_mm
    return [
        f"machine        {result.machine}",
        f"stitch number  {result.number:g} for {result.material}",
        f"loop length    {result.loop_length_mm:.1f} mm ({low:.1f} to {high:.1f})",
        result.interval_source,
    ]


OPERATION = Operation(
    dial,
    tag="files",
    summary="Stitch number of a machine for a loop length",
    example={
        "machine": "kniterate",
        "loop_length_mm": 10.4,
        "swatches": [{"number": 5, "loop_length_mm": 9.2}, {"number": 7, "loop_length_mm": 11.6}],
    },
    command=Command(
        _lines,
        more="--machine takes a name of `knitcore machines`, or the file of a profile, with the "
        "swatches in it. Other commands use the profile that -o writes.",
        names={"swatches": None},
        fields=_swatches,
        run=_command,
    ),
)
