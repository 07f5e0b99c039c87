"""Workbooks of testing machines and of people, XLS and XLSX, as rows of cells."""

import io
import zipfile
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from knitcore.base.errors import InputError

Cell = str | float
Worksheet = list[list[Cell]]

MAX_BYTES = 50 * 2**20
MAX_UNPACKED_BYTES = 256 * 2**20
MAX_SHEETS = 200
MAX_ROWS = 500_000
MAX_COLUMNS = 200
MAX_CELLS = 400_000
"""Cells of all sheets; reading so many takes some 10 s."""
MAX_TAGS = 4 * MAX_CELLS
"""Tags in the parts of a workbook: four for each cell. They are counted before any part is read."""
MAX_XLS_BYTES = 20 * 2**20
"""Bytes of an XLS, which has no tags: reading so many takes some 5 s."""
MAX_EMPTY_ROWS = 1000
"""Longest gap of empty rows inside a sheet; a stray cell far below is ignored."""
_XLS = bytes.fromhex("d0cf11e0a1b11ae1")
_XLSX = b"PK\x03\x04"


def is_workbook(path: Path) -> bool:
    """Say whether a file begins as workbooks do, whatever its name."""
    with path.open("rb") as file:
        return file.read(8).startswith((_XLS, _XLSX))


def read_workbook(path: Path, *, only_head: bool = False) -> dict[str, Worksheet]:
    """The cells of each sheet that has any, in the order of the sheets.

    A formula counts as the value that was saved with it, an empty cell as ``""``; empty cells at
    the end of a row and empty rows at the end of a sheet are left out.

    Parameters
    ----------
    only_head : whether two rows, or all down to the first with a cell, of one sheet are enough.

    Raises
    ------
    InputError
        If the file is damaged, protected by a password, or larger than what is read.
    """
    if path.stat().st_size > MAX_BYTES:
        raise _too_large(path)
    with path.open("rb") as file:
        of_kind = _xlsx_sheets if file.read(4) == _XLSX else _xls_sheets
    sheets: dict[str, Worksheet] = {}
    room = MAX_CELLS
    try:
        for name, rows in of_kind(path):
            sheet: Worksheet = []
            filled = 0
            for row in rows:
                sheet.append(_cells(row))
                filled = len(sheet) if sheet[-1] else filled
                if len(sheet) - filled > MAX_EMPTY_ROWS or (
                    only_head and filled and len(sheet) > 1
                ):
                    break
                room -= 1 + len(sheet[-1])
                if room < 0:
                    raise _too_large(path)
            if filled:
                sheets[name] = sheet[:filled]
                if only_head:
                    break
    except InputError:
        raise
    except Exception as error:  # on a damaged file both readers may raise anything
        raise InputError(
            path.name,
            f"cannot be read as a workbook ({error}).",
            "It may be cut off or protected by a password: save it again, without one, or as CSV.",
        ) from None
    return sheets


def _xls_sheets(path: Path) -> Iterator[tuple[str, Iterable[Sequence[Any]]]]:
    import xlrd

    if path.stat().st_size > MAX_XLS_BYTES:
        raise _too_large(path, MAX_XLS_BYTES)
    # one cell far out would otherwise fill its sheet, and all sheets would be read before any
    book = xlrd.open_workbook(str(path), logfile=io.StringIO(), on_demand=True, ragged_rows=True)
    rows = 0
    for number in range(min(book.nsheets, MAX_SHEETS)):
        sheet = book.sheet_by_index(number)
        rows += sheet.nrows
        if rows > MAX_ROWS:
            raise _too_large(path)
        yield sheet.name, map(sheet.row_values, range(sheet.nrows))
        book.unload_sheet(number)


def _xlsx_sheets(path: Path) -> Iterator[tuple[str, Iterable[Sequence[Any]]]]:
    from openpyxl import load_workbook  # .2 s, which only those who read a workbook wait

    with zipfile.ZipFile(path) as packed:
        if sum(part.file_size for part in packed.infolist()) > MAX_UNPACKED_BYTES:
            raise _too_large(path)
        tags = 0
        for part in packed.infolist():
            with packed.open(part) as stream:
                while chunk := stream.read(2**20):
                    tags += chunk.count(b"<")
                    if tags > MAX_TAGS:
                        raise _too_large(path)
    with path.open("rb") as file:  # which has another name than a workbook's, at times
        book = load_workbook(file, read_only=True, data_only=True, keep_links=False)
        try:
            for sheet in book.worksheets[:MAX_SHEETS]:
                yield (
                    sheet.title,
                    sheet.iter_rows(max_row=MAX_ROWS, max_col=MAX_COLUMNS, values_only=True),
                )
        finally:
            book.close()


def _cells(row: Sequence[Any]) -> list[Cell]:
    cells: list[Cell] = [
        "" if value is None else value if isinstance(value, int | float) else str(value)
        for value in row
    ]
    while cells and cells[-1] == "":
        cells.pop()
    return cells


def _too_large(path: Path, most_bytes: int = MAX_BYTES) -> InputError:
    remedy = f"Give the tests only: at most {most_bytes // 2**20} MB and {MAX_CELLS:,} cells."
    return InputError(path.name, "is larger than what is read of a workbook.", remedy)
