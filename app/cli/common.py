"""What commands share: the chart argument, the material option and the two ways of printing."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import Any

import click
from pydantic import BaseModel

from app.models.charts import fabric_repeat
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.formats.chart_files import read_chart, read_piece
from knitcore.garment.piece import Piece

Decorated = Callable[..., Any]

json_option = click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
material_option = click.option(
    "--material", required=True, help="Library id (see `knitcore materials`) or a material file."
)


def choice(names: type[StrEnum]) -> click.Choice[str]:
    """The values of an enumeration as a choice (click would offer its Python names)."""
    return click.Choice([member.value for member in names])


direction_option = click.option(
    "--direction", required=True, type=choice(Direction), help="Along rows, or along columns."
)


flat_option = click.option(
    "--flat", is_flag=True, help="Hold the stitches in one plane, as a fabric laid flat."
)


def _loop_lengths(_: click.Context, option: click.Parameter, text: str | None) -> Any:
    """Rows from the bottom, separated by /; in each one length, or one a stitch."""
    if text is None:
        return None
    try:
        return [[float(length) for length in row.split(",")] for row in text.split("/")]
    except ValueError:
        raise click.BadParameter(
            f"{text!r} is no list of lengths. Write one for every row from the bottom, such as "
            "14/12, or one for every stitch, such as 14,13/12,12.",
            param=option,
        ) from None


loop_lengths_option = click.option(
    "--loop-lengths-mm",
    callback=_loop_lengths,
    metavar="ROW/ROW…",
    help="Instead of one length: rows from the bottom, each one length or one for every stitch.",
)


def chart_argument(function: Decorated) -> Decorated:
    """CHART and --size."""
    size = click.option(
        "--size", metavar="COLUMNSxROWS", help="Size of a fabric given by name, such as 31x20."
    )
    return click.argument("chart", metavar="CHART")(size(function))


def resolve_chart(chart: str, size: str | None) -> StitchChart:
    """The chart that CHART and --size mean: a file, or a pure fabric of a size.

    Raises
    ------
    InputError
        If it is neither, or the size is missing or malformed.
    """
    if chart.lower() in set(Fabric):
        if size is None:
            raise InputError("size", f"{chart} needs a size.", "Add --size COLUMNSxROWS.")
        match = re.fullmatch(r"(\d{1,6})[x×](\d{1,6})", size.strip().lower())
        if match is None:
            raise InputError("size", f"{size!r} is no size.", "Write COLUMNSxROWS, such as 31x20.")
        columns, rows = int(match[1]), int(match[2])
        return StitchChart.of_fabric(chart, rows=rows, columns=columns)
    if size is not None:
        raise InputError(
            "size", "goes with the name of a fabric, not with a file.", "Leave --size out."
        )
    if not Path(chart).suffix:
        names = ", ".join(Fabric)
        raise InputError(
            "chart",
            f"{chart!r} is neither a file nor a fabric.",
            f"Name a .txt, .png or .json file, or one of {names} with --size.",
        )
    return read_chart(chart)


def resolve_piece(chart: str, size: str | None) -> Piece:
    """As :func:`resolve_chart`, with the outline of a file that has one."""
    stitches = resolve_chart(chart, size)
    return read_piece(chart) if Path(chart).suffix else Piece.plain(stitches)


def resolve_repeat(chart: str, size: str | None) -> StitchChart:
    """The repeat that CHART means; the name of a fabric needs no size here.

    Raises
    ------
    InputError
        As :func:`resolve_chart`.
    """
    if chart.lower() in set(Fabric):
        if size is not None:
            resolve_chart(chart, size)  # a malformed size is told all the same
        return fabric_repeat(Fabric.parse(chart))
    return resolve_chart(chart, size)


def given_chart(
    chart: str, size: str | None, loop_lengths_mm: list[list[float]] | None
) -> StitchChart:
    """The repeat that CHART means, or all of it where its rows have loop lengths of their own.

    Raises
    ------
    InputError
        As :func:`resolve_chart`.
    """
    if loop_lengths_mm is None or size is None:
        return resolve_repeat(chart, size)
    return resolve_chart(chart, size)


def user_data_dir() -> Path:
    """The data folder of the settings."""
    from app.settings import Settings

    return Settings().data_dir.expanduser()


def emit(result: BaseModel, text: str, *, as_json: bool) -> None:
    """Print a result as one JSON object, or as text for people."""
    click.echo(result.model_dump_json() if as_json else text)


def check_writable(path: Path | None, field: str) -> None:
    """Refuse a file that cannot be written, before anything is computed.

    Raises
    ------
    InputError
        If there is no such folder, it cannot be written to, or the name is that of a folder.
    """
    if path is None:
        return
    if not path.parent.is_dir():
        raise InputError(
            field, f"{path.parent} is no folder.", "Name a file in a folder that exists."
        )
    if path.is_dir():
        raise InputError(field, f"{path} is a folder.", "Name a file in it.")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise InputError(field, f"{path} cannot be written.", "Name a file that you may write.")
