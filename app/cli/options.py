"""Options that operations declare for their commands, the files they write, and CHART."""

import contextlib
import csv
import os
import re
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import click

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Fabric
from knitcore.chart.patterns import PATTERNS
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.stitch_kinds import BY_CODE
from knitcore.chart.symbol_chart import CODE, SymbolChart, knits_and_purls

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

CHART_HELP = (
    "CHART is a file (.txt, .ks, .png, .json, .k), - for standard input, a repeat in one line such "
    "as KKP/PPK (the top row first), or a fabric's name with --size."
)
STITCHES = frozenset("KkPp|•–-")
"""Signs of stitches in a repeat in one line, as in a chart file."""
SEPARATORS = frozenset("/, ")
STANDARD_INPUT = "-"
_KINDS = {
    b"\x89PNG": ".png",
    b"\xff\xd8\xff": ".jpg",
    b"GIF8": ".gif",
    b"{": ".json",
    b"\xef\xbb\xbf{": ".json",
    b";!knitout": ".k",
    b"\xef\xbb\xbf;!": ".k",
}
"""First bytes of files, and the names that their readers expect; all others are texts."""


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
        _check_writable(path, field)
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
        rows = [[float(length) for length in row.split(",")] for row in loop_lengths_mm.split("/")]
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
        from knitcore.formats.designs.design_file import DesignFile, write_design

        design = DesignFile(name=name, material=material, chart=chart)
        out.write_text(write_design(design), encoding="utf-8")


def write_table(file: Path, head: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table with the names of its columns."""
    with file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(head)
        writer.writerows(rows)


def _check_writable(path: Path, field: str) -> None:
    """Refuse a folder, and a file in a folder that does not exist or that cannot be written."""
    if not path.parent.is_dir():
        raise InputError(
            field, f"{path.parent} is not a folder.", "Name a file in a folder that exists."
        )
    if path.is_dir():
        raise InputError(field, f"{path} is a folder.", "Name a file in it.")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise InputError(field, f"{path} cannot be written.", "Name a file that you may write.")


def resolve_chart(chart: str, size: str | None, *, is_repeat: bool = False) -> StitchChart:
    """Read CHART: a file, standard input, a fabric or pattern by name, or a repeat in one line.

    A file comes before a fabric of the same name.

    Parameters
    ----------
    chart : what stands on the command line.
    size : COLUMNSxROWS of cloth of a named fabric or of a repeat, if it is given.
    is_repeat : whether a named fabric without a size stands for its repeat.

    Raises
    ------
    InputError
        If CHART is none of these, or the size is missing, malformed or out of place.
    """
    with chart_file(chart) as file:
        if file is not None:
            from knitcore.formats.read.chart_files import read_noted_chart  # slow to import

            if size is not None:
                raise InputError("size", "does not go with a file.", "Leave --size out.")
            chart_in_file, notes = read_noted_chart(file)
            show_notes(notes)
            return chart_in_file
    named = _chart_of_name(chart)
    signs = set(chart)
    if named is None and not (signs & STITCHES and signs <= STITCHES | SEPARATORS):
        if (stitches := stitches_of(chart)) is not None:
            knits_and_purls(stitches)
        raise _no_chart(chart)
    cloth = StitchChart.parse(chart.replace("/", "\n")) if named is None else named
    if size is not None:
        match = re.fullmatch(r"(\d{1,6})[x×](\d{1,6})", size.strip().lower())
        if match is None:
            raise InputError(
                "size", f"{size!r} is not a size.", "Write COLUMNSxROWS, such as 31x20."
            )
        return cloth.resized(rows=int(match[2]), columns=int(match[1]))
    if named is not None and not is_repeat:
        raise InputError("size", f"{chart} needs a size.", "Add --size COLUMNSxROWS.")
    return cloth if named is None else cloth.repeat()


def stitches_of(chart: str) -> SymbolChart | None:
    """A repeat in one line with other stitches than knit and purl; rows end with ``;``.

    Raises
    ------
    InputError
        If it does not balance.
    """
    codes = CODE.findall(chart.replace(";", ""))
    known = all(code in BY_CODE or code in STITCHES for code in codes)
    is_name = _names_file(chart) or _chart_of_name(chart) is not None
    if is_name or not known or set(chart) <= STITCHES | SEPARATORS:
        return None
    return SymbolChart.parse(chart)


def show_notes(notes: Iterable[str]) -> None:
    """Print the notes of a file's reader, beside the result, which may be piped on."""
    for note in notes:
        click.echo(f"note: {note}", err=True)


@contextlib.contextmanager
def chart_file(chart: str) -> Iterator[Path | None]:
    """Give the file that CHART names, or one with standard input; None if it names neither.

    A file whose name has no ending is read by what it begins with, as standard input is.
    """
    path = Path(chart)
    if chart != STANDARD_INPUT and (path.suffix or not _names_file(chart)):
        yield path if _names_file(chart) else None
        return
    if chart == STANDARD_INPUT:
        name, content = "standard-input", sys.stdin.buffer.read()
    else:
        name, content = path.name, path.read_bytes()
    kind = next((kind for start, kind in _KINDS.items() if content.startswith(start)), ".txt")
    with tempfile.TemporaryDirectory(prefix="knitcore-") as folder:
        copy = Path(folder) / f"{name}{kind}"
        copy.write_bytes(content)
        yield copy


def is_fabric(chart: str) -> bool:
    """Tell whether CHART is the name of a pure fabric, and no file has that name."""
    return chart.lower() in set(Fabric) and not _names_file(chart)


def _names_file(chart: str) -> bool:
    # unlike those of pathlib, these functions take names of any length
    return os.path.exists(chart) and not os.path.isdir(chart)


def _chart_of_name(name: str) -> StitchChart | None:
    if name.lower() in set(Fabric):
        return StitchChart.of_fabric(Fabric(name.lower()))
    return next((p.chart for p in PATTERNS if p.identifier == name.lower()), None)


def _no_chart(chart: str) -> InputError:
    names = ", ".join(pattern.identifier for pattern in PATTERNS)
    problem = "is neither a file, a repeat in one line nor the name of a fabric"
    if os.path.isdir(chart):
        problem = "is a folder, not a file"
    elif Path(chart).suffix:
        problem = "does not exist"
    return InputError(
        "chart",
        f"{chart!r} {problem}.",
        "Give a file such as chart.txt (or .ks, .png, .json, .k), a repeat in one line such as "
        "KKP/PPK (the top row first), - for standard input, or a fabric such as rib with "
        f"--size 31x20; fabrics are {names}.",
    )
