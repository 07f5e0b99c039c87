"""The stitch number for a loop length, from swatches of the user's."""

from pathlib import Path
from typing import Any

import click
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.machine.dial import Dial, DialSwatch
from knitcore.machine.profile import profile

from ...cli.options import out_option
from ...context import Context
from ...requests.base import Ends, IntervalResult, RequestModel
from ..registry import Command, Operation


class DialSwatchInput(RequestModel):
    """A swatch at a stitch number: its yarn per stitch, measured or from its weight."""

    number: float = Field(ge=0, le=1000, description="Stitch number that it was knitted with.")
    loop_length_mm: float = Field(gt=0, le=100, description="Yarn per stitch.")


class DialRequest(RequestModel):
    """A machine, a loop length, and swatches of the yarn."""

    machine: str = Field(max_length=80, description="Identifier of the machine.")
    loop_length_mm: float = Field(gt=0, le=100, description="Yarn that a stitch is to have.")
    swatches: list[DialSwatchInput] = Field(
        default_factory=list, max_length=50, description="Two or more make the number sure."
    )
    yarn: str = Field("", max_length=80, description="Name of the yarn, kept with the swatches.")


class DialResult(IntervalResult):
    """A stitch number."""

    number: float
    exact: float = Field(description="Before rounding to what the machine can be set to.")
    exact_interval: Ends
    loop_length_mm: float = Field(description="What that number gives.")
    loop_length_interval_mm: Ends
    guessed: bool = Field(description="Whether no swatch stands behind it.")
    file: str = Field(description="The swatches as a file to keep, JSON.")


def dial(request: DialRequest, context: Context) -> DialResult:
    """The stitch number that gives a loop length, by swatches or else by a guess from the gauge.

    Raises
    ------
    InputError
        If no number gives it, or the swatches cannot be right.
    """
    del context
    swatches = tuple(DialSwatch(s.number, s.loop_length_mm) for s in request.swatches)
    fit = Dial(profile(request.machine), request.yarn, swatches)
    count = len(swatches)
    basis = f"{count} swatch{'es' * (count > 1)} of yours" if count else "a guess from the gauge"
    setting = fit.setting(request.loop_length_mm)
    return DialResult.of(setting, file=fit.to_json(), interval_source=f"The number: {basis}.")


@click.option(
    "--swatch",
    "swatches",
    multiple=True,
    metavar="NUMBER=MM",
    help="Yarn per stitch of a swatch at a stitch number, such as 6=10.4; repeatable.",
)
@click.option(
    "--from", "kept", type=click.Path(path_type=Path), help="FILE of swatches that -o wrote."
)
def _swatches(swatches: tuple[str, ...], kept: Path | None) -> dict[str, Any]:
    """The swatches of a file and of options."""
    both = [] if kept is None else list(Dial.read(kept.read_bytes()).swatches)
    for text in swatches:
        number, _, length = text.partition("=")
        try:
            both.append(DialSwatch(float(number), float(length)))
        except ValueError:
            raise InputError(
                "swatch", f"{text[:40]!r} is no number and length.", "Write it as 6=10.4."
            ) from None
    return {"swatches": [vars(swatch) for swatch in both]}


@out_option("-o", "--out", help="Write the swatches to FILE, for --from.")
def _command(request: DialRequest, context: Context, out: Path | None) -> DialResult:
    result = dial(request, context)
    if out is not None:
        out.write_text(result.file, encoding="utf-8")
    return result


def _lines(result: DialResult) -> list[str]:
    low, high = result.loop_length_interval_mm
    return [
        f"stitch number  {result.number:g}",
        f"loop length    {result.loop_length_mm:.1f} mm ({low:.1f} to {high:.1f})",
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
    command=Command(_lines, names={"swatches": None}, fields=_swatches, run=_command),
)
