"""Read compression tests of yarns: the testing machine's XLS workbook, or a simple CSV.

XLS: one sheet per test, named ``yarn-number``, with a title row, a row of column names (``Standard
force``, ``Strain``: the probe's depth) and a row of units (mN or N; mm); a sheet ``Yarn Diameters``
with one column per yarn and one row per sample.

CSV: a header line with ``depth_mm, force_n`` and, where there are several tests, ``sample``
(``yarn-number``); the diameter may be a column ``diameter_mm``.
"""

from __future__ import annotations

import io
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xlrd
from numpy.typing import NDArray

from knitcore.errors import InputError
from knitcore.measure.tables import numbers, read_csv

Array = NDArray[np.float64]

MAX_BYTES = 50 * 2**20
_XLS_MAGIC = bytes.fromhex("d0cf11e0a1b11ae1")


@dataclass(frozen=True, eq=False)
class CompressionTest:
    """One squeeze of one yarn.

    Attributes
    ----------
    name : of the sample, ``yarn-number``.
    yarn : the part of the name before the number.
    depth_mm, force_n : (n,) readings in the order of time.
    diameter_mm : of the uncompressed yarn (None if the file does not say).
    """

    name: str
    yarn: str
    depth_mm: Array
    force_n: Array
    diameter_mm: float | None


def read_compression(path: Path) -> list[CompressionTest]:
    """All tests of a file.

    Raises
    ------
    InputError
        If the file is missing, is not of the type of its suffix, or holds other data.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(str(path), "is not a file.", "Give the path of an XLS or CSV file.")
    if path.stat().st_size > MAX_BYTES:
        raise InputError(path.name, "is larger than 50 MB.", "Give the tests only.")
    with path.open("rb") as file:
        start = file.read(8)
    if start == _XLS_MAGIC:
        return _read_xls(path)
    if start.startswith(b"PK\x03\x04"):
        raise InputError(path.name, "is an XLSX workbook.", "Save it as XLS or as CSV.")
    if path.suffix.lower() == ".xls":
        raise InputError(path.name, "is not an XLS workbook.", "Give an XLS or CSV file.")
    return _read_csv(path)


def _yarn(name: str) -> str:
    return re.sub(r"[\s_-]*\d+$", "", name).strip().lower() or name


# -- XLS -----------------------------------------------------------------------------------------


def _read_xls(path: Path) -> list[CompressionTest]:
    try:
        book = xlrd.open_workbook(str(path), logfile=io.StringIO())
        sheets = {sheet.name: sheet for sheet in book.sheets()}
    except Exception as error:  # on a damaged file xlrd may raise anything
        raise InputError(
            path.name, f"cannot be read as XLS ({error}).", "The file may be cut off."
        ) from None
    diameters = _diameters(sheets)
    tests = [
        _xls_test(path.name, sheet, diameters)
        for name, sheet in sheets.items()
        if "diameter" not in name.lower() and sheet.nrows > 0
    ]
    if not tests:
        raise InputError(path.name, "has no sheet with a test.", "Give one sheet per test.")
    return tests


def _xls_test(
    file_name: str, sheet: Any, diameters: dict[tuple[str, int], float]
) -> CompressionTest:
    where = f"{file_name}, sheet {sheet.name!r}"
    header = next(
        (
            row
            for row in range(min(sheet.nrows, 10))
            if any("force" in str(v).lower() for v in sheet.row_values(row))
        ),
        None,
    )
    if header is None or header + 2 >= sheet.nrows:
        raise InputError(
            where,
            "has no column whose name contains 'force', or no readings below it.",
            "Give a row of names (force, strain), a row of units, then the readings.",
        )
    names = [str(v).strip().lower() for v in sheet.row_values(header)]
    units = [str(v).strip().lower() for v in sheet.row_values(header + 1)]
    force = next(i for i, name in enumerate(names) if "force" in name)
    depth = next((i for i, n in enumerate(names) if "strain" in n or "depth" in n), None)
    if depth is None:
        raise InputError(where, "has no column for the depth.", "Name it 'Strain' or 'Depth'.")
    if units[force] not in ("n", "mn"):
        raise InputError(where, f"the force is in {units[force]!r}.", "Give it in mN or N.")
    if units[depth] != "mm":
        raise InputError(
            where, f"the probe's depth is in {units[depth]!r}.", "Give it in mm, not in percent."
        )
    first = header + 2
    rows = range(first, sheet.nrows)
    forces = _cells(where, names[force], [sheet.cell_value(r, force) for r in rows], first)
    depths = _cells(where, names[depth], [sheet.cell_value(r, depth) for r in rows], first)
    keep = np.isfinite(forces) & np.isfinite(depths)
    number = re.search(r"(\d+)\s*$", sheet.name)
    yarn = _yarn(sheet.name)
    return CompressionTest(
        name=sheet.name,
        yarn=yarn,
        depth_mm=depths[keep],
        force_n=forces[keep] * (1e-3 if units[force] == "mn" else 1.0),
        diameter_mm=_diameter_of(diameters, yarn, int(number.group(1)) if number else 1),
    )


def _cells(where: str, column: str, values: list[Any], first: int) -> Array:
    """Numbers, without empty cells at the end of the sheet."""
    while values and str(values[-1]).strip() == "":
        values = values[:-1]
    return numbers(f"{where}, column {column!r}", values, first + 1)


def _diameters(sheets: dict[str, Any]) -> dict[tuple[str, int], float]:
    """Diameters by (column name, sample number)."""
    found: dict[tuple[str, int], float] = {}
    for name, sheet in sheets.items():
        if "diameter" not in name.lower():
            continue
        header: list[str] = []
        for row in range(sheet.nrows):
            values = sheet.row_values(row)
            if "sample" in str(values[0]).lower():
                header = [str(v).strip().lower() for v in values]
            elif header and isinstance(values[0], float):
                for column, value in zip(header[1:], values[1:], strict=False):
                    if isinstance(value, float) and value > 0:
                        found[(column, int(values[0]))] = value
    return found


def _diameter_of(diameters: dict[tuple[str, int], float], yarn: str, number: int) -> float | None:
    matching = [v for (column, n), v in diameters.items() if yarn in column and n == number]
    return matching[0] if len(matching) == 1 else None


# -- CSV -----------------------------------------------------------------------------------------


def _read_csv(path: Path) -> list[CompressionTest]:
    table = read_csv(path, "depth_mm, force_n")
    table.columns = [str(c).strip().lower() for c in table.columns]
    missing = [c for c in ("depth_mm", "force_n") if c not in table.columns]
    if missing or table.empty:
        raise InputError(
            path.name,
            f"has no column {', '.join(missing)}." if missing else "has no rows.",
            "Give a header line depth_mm,force_n and one row per reading.",
        )
    columns = {
        name: numbers(f"{path.name}, column {name}", table[name])
        for name in ("depth_mm", "force_n", "diameter_mm")
        if name in table
    }
    labels = (
        table["sample"].fillna("").str.strip().to_numpy(dtype=str)
        if "sample" in table
        else np.full(len(table), path.stem)
    )
    tests = []
    for label in dict.fromkeys(labels.tolist()):
        rows = labels == label
        diameter = columns["diameter_mm"][rows][0] if "diameter_mm" in columns else None
        tests.append(
            CompressionTest(
                name=label,
                yarn=_yarn(label),
                depth_mm=columns["depth_mm"][rows],
                force_n=columns["force_n"][rows],
                diameter_mm=None if diameter is None else float(diameter),
            )
        )
    return tests
