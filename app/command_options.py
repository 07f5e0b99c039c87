"""Options and arguments of commands that are not fields of their requests."""

from __future__ import annotations

import csv
import os
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import click

from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Fabric
from knitcore.patterns import PATTERNS

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


class OutFile(click.Path):
    """A file to write; if it cannot be written, it is refused before anything is computed."""

    def __init__(self, *suffixes: str) -> None:
        super().__init__(path_type=Path)
        self.suffixes = suffixes

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The path."""
        path = Path(str(super().convert(value, param, ctx)))
        field = str(param.name) if param else "out"
        if self.suffixes and path.suffix.lower() not in self.suffixes:
            known = " or ".join(self.suffixes)
            raise InputError(field, f"{path.name} has no known file type.", f"Use {known}.")
        check_writable(path, field)
        return path


def out_option(*names: str, suffixes: tuple[str, ...] = (), **more: Any) -> Decorator:
    """An option that names a file to write; otherwise as ``click.option``."""
    return click.option(*names, type=OutFile(*suffixes), **more)


atlas_option = click.option(
    "--atlas",
    type=click.Path(path_type=Path),
    help="FILE.npz of `knitcore atlas`; otherwise small.",
)
design_option = out_option("-o", "--out", help="Write a design (.json).")


@click.option(
    "--loop-lengths-mm",
    metavar="ROW/ROW…",
    help="Instead of one length: rows from the bottom, each one length or one for every stitch.",
)
def loop_lengths(loop_lengths_mm: str | None) -> dict[str, Any]:
    """A field of a request at the yarn level.

    Raises
    ------
    InputError
        If it is not a list of lengths.
    """
    if loop_lengths_mm is None:
        return {}
    try:
        rows = [[float(one) for one in row.split(",")] for row in loop_lengths_mm.split("/")]
    except ValueError:
        raise InputError(
            "loop-lengths-mm",
            f"{loop_lengths_mm!r} is not a list of lengths.",
            "Write one for every row from the bottom, such as 14/12, or one for every stitch, "
            "such as 14,13/12,12.",
        ) from None
    return {"loop_lengths_mm": rows}


def write_design_of(chart: str, material: str, name: str, out: Path | None) -> None:
    """Write a chart as a design, if there is a file for it."""
    if out is not None:
        from knitcore.formats.design import DesignFile, write_design

        design = DesignFile(name=name, material=material, chart=chart)
        out.write_text(write_design(design), encoding="utf-8")


def write_table(file: Path, head: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table with the names of its columns."""
    with file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(head)
        writer.writerows(rows)


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
            field, f"{path.parent} is not a folder.", "Name a file in a folder that exists."
        )
    if path.is_dir():
        raise InputError(field, f"{path} is a folder.", "Name a file in it.")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise InputError(field, f"{path} cannot be written.", "Name a file that you may write.")


def resolve_chart(chart: str, size: str | None) -> StitchChart:
    """The chart that CHART and --size name: a file, or a fabric or a pattern of a size.

    Raises
    ------
    InputError
        If it is none, or the size is missing or malformed.
    """
    if Path(chart).suffix:
        from knitcore.formats.chart_files import read_chart  # a fabric needs no readers

        if size is not None:
            raise InputError(
                "size", "goes with the name of a fabric, not with a file.", "Leave --size out."
            )
        return read_chart(chart)
    named = {str(fabric): StitchChart.of_fabric(fabric) for fabric in Fabric}
    if chart.lower() not in named:
        named |= {pattern.identifier: pattern.chart for pattern in PATTERNS}
    if chart.lower() not in named:
        names = ", ".join(named)
        raise InputError(
            "chart",
            f"{chart!r} is neither a file nor a fabric.",
            f"Name a .txt, .png or .json file, or one of {names} with --size.",
        )
    if size is None:
        raise InputError("size", f"{chart} needs a size.", "Add --size COLUMNSxROWS.")
    match = re.fullmatch(r"(\d{1,6})[x×](\d{1,6})", size.strip().lower())
    if match is None:
        raise InputError("size", f"{size!r} is not a size.", "Write COLUMNSxROWS, such as 31x20.")
    return named[chart.lower()].resized(rows=int(match[2]), columns=int(match[1]))
