"""Reading a chart from a file of any kind that holds one."""

from __future__ import annotations

from pathlib import Path

from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.formats.design import FORMAT as DESIGN_FORMAT
from knitcore.formats.design import VERSION as DESIGN_VERSION
from knitcore.formats.design import read_design
from knitcore.formats.png import read_png
from knitcore.formats.written_reader import looks_written, read_rows

__all__ = ["DESIGN_FORMAT", "DESIGN_VERSION", "MAX_FILE_BYTES", "read_chart"]

MAX_FILE_BYTES = 16_000_000


def read_chart(path: str | Path) -> StitchChart:
    """The chart in a file.

    Parameters
    ----------
    path : ``.txt`` (K/P lines or written rows), ``.png`` (one pixel a stitch), ``.json`` (a
        design) or ``.k`` / ``.knitout`` (a knitout program).

    Raises
    ------
    InputError
        If the file is missing, too large, of another kind, or does not hold what its name says.
    """
    file = Path(path)
    readers = {
        ".txt": _read_text,
        ".png": read_png,
        ".json": lambda file: read_design(file).to_chart(),
        ".k": _read_knitout,
        ".knitout": _read_knitout,
    }
    reader = readers.get(file.suffix.lower())
    if reader is None:
        raise InputError(
            "chart",
            f"{file.name} is of no kind that holds a chart.",
            "Use a .txt file of K/P lines or written rows, a .png with one pixel a stitch, a .json"
            " design or a .k knitout program.",
        )
    if not file.is_file():
        raise InputError("chart", f"there is no file {file}.", "Check the path.")
    if file.stat().st_size > MAX_FILE_BYTES:
        raise InputError(
            "chart", f"{file.name} is too large.", f"Use at most {MAX_FILE_BYTES // 10**6} MB."
        )
    return reader(file)


def _read_text(file: Path) -> StitchChart:
    text = _text(file)
    return read_rows(text) if looks_written(text) else StitchChart.parse(text)


def _read_knitout(file: Path) -> StitchChart:
    from knitcore.formats.knitout_reader import knitted_chart

    return knitted_chart(_text(file)).chart


def _text(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise InputError(
            "chart", f"{file.name} is not UTF-8 text.", "Save it as plain text."
        ) from None
