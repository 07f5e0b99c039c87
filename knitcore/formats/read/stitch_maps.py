"""Maps of target moduli from a spreadsheet (see :mod:`knitcore.formats.write.stitch_values`)."""

import csv
from pathlib import Path

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, check_chart_size

MAX_BYTES = 80_000_000
WANTED = ("modulus_course_n_per_mm", "modulus_wale_n_per_mm")


@in_reading_time
def read_target_moduli(file: Path) -> tuple[Array, Array]:
    """Two maps (rows, columns), row 0 at the bottom; NaN where a cell is empty or missing.

    The file needs the columns ``row`` and ``column`` (from 1 at the bottom left) and one or both
    of ``modulus_course_n_per_mm`` and ``modulus_wale_n_per_mm``.

    Raises
    ------
    InputError
        Naming the line that cannot be read.
    """
    if not file.is_file() or file.stat().st_size > MAX_BYTES:
        remedy = f"Give the path of a CSV file of at most {MAX_BYTES // 10**6} MB."
        raise InputError("target", f"{file} is not a usable CSV file.", remedy)
    try:
        with file.open(newline="", encoding="utf-8-sig") as stream:
            table = csv.DictReader(stream)
            names = set(table.fieldnames or ())
            if not {"row", "column"} <= names or not names & set(WANTED):
                problem = f"{file.name} lacks columns."
                raise InputError("target", problem, f"Give row, column, {' and '.join(WANTED)}.")
            entries = [_entry(line, table.line_num) for line in table]
    except (UnicodeDecodeError, csv.Error):
        raise InputError("target", f"{file.name} is not CSV text.", "Save it as CSV.") from None
    if not entries:
        raise InputError(
            "target", f"{file.name} holds no stitch.", "Give one line for each stitch."
        )
    rows, columns = max(entry[0] for entry in entries), max(entry[1] for entry in entries)
    check_chart_size(rows, columns)
    maps = np.full((2, rows, columns), np.nan)
    for row, column, course, wale in entries:
        maps[:, row - 1, column - 1] = course, wale
    return maps[0], maps[1]


def _entry(line: dict[str, str], number: int) -> tuple[int, int, float, float]:
    try:
        row, column = int(line["row"]), int(line["column"])
        targets = [float(line[name]) if line.get(name) else np.nan for name in WANTED]
    except (TypeError, ValueError):
        raise InputError(
            "target", f"line {number} holds no numbers.", "Give row, column and moduli."
        ) from None
    if not (1 <= row <= MAX_STITCHES_PER_SIDE and 1 <= column <= MAX_STITCHES_PER_SIDE):
        problem = f"line {number} is for row {row}, column {column}."
        raise InputError("target", problem, f"Count from 1 to {MAX_STITCHES_PER_SIDE}.")
    return row, column, targets[0], targets[1]
