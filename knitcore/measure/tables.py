"""Read columns of numbers in users' tables."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from knitcore.base.arrays import Array, Indices
from knitcore.base.errors import InputError
from knitcore.measure.workbooks import MAX_COLUMNS, is_workbook, read_workbook

if TYPE_CHECKING:
    import pandas as pd


def read_table(path: Path, header: str) -> pd.DataFrame:
    """A CSV file, or the first sheet of a workbook, as texts.

    Parameters
    ----------
    header : the columns that it should have, for the message.

    Raises
    ------
    InputError
        If it is not such a file.
    """
    import pandas as pd  # half a second, which only those who read a table wait

    if is_workbook(path):
        names, *rows = next(iter(read_workbook(path).values()), [[]])
        width = len(names)
        texts = [[str(cell) for cell in (*row, *[""] * width)][:width] for row in rows]
        return pd.DataFrame(texts, columns=[str(name) for name in names], dtype=str)
    with path.open("rb") as file:
        head = next((line for line in file if line.strip()), b"")
    if head.count(b",") >= MAX_COLUMNS:  # pandas looks at each name among those before it
        remedy = f"Keep the columns of the test: at most {MAX_COLUMNS}."
        raise InputError(path.name, "has too many columns.", remedy)
    try:
        table = pd.read_csv(path, skipinitialspace=True, dtype=str, engine="c")
    except UnicodeDecodeError:
        raise InputError(
            path.name, "is not text in UTF-8.", "Save it as CSV in UTF-8, or as XLSX."
        ) from None
    except (pd.errors.ParserError, pd.errors.EmptyDataError) as error:
        problem = f"cannot be read as CSV ({str(error).strip()})."
        remedy = f"Give a header line {header} and comma-separated numbers."
        raise InputError(path.name, problem, remedy) from None
    for separator, name in ((";", "semicolons"), ("\t", "tabs")):
        if separator in str(table.columns[0]):
            remedy = "Save it with commas between columns and decimal points, or as XLSX."
            raise InputError(path.name, f"has {name} between its columns.", remedy)
    return table


def rows_by_label(table: pd.DataFrame, column: str, default: str) -> dict[str, Indices]:
    """Rows of a table by their label in a column, in the order in which the labels come.

    Parameters
    ----------
    default : label of all rows of a table without that column.
    """
    if column not in table:
        return {default: np.arange(len(table))}
    groups = table.groupby(table[column].fillna("").str.strip(), sort=False)
    return {str(label): np.asarray(rows) for label, rows in groups.indices.items()}


def numbers(where: str, values: Sequence[object] | pd.Series, first_row: int = 2) -> Array:
    """A column of finite numbers.

    Parameters
    ----------
    where : file and column, for the message.
    first_row : of the values in the file, from 1.

    Raises
    ------
    InputError
        Naming the first row that holds something else.
    """
    import pandas as pd

    texts = pd.Series(values, dtype=object)
    parsed = pd.to_numeric(texts, errors="coerce").to_numpy(dtype=float)
    bad = np.flatnonzero(~np.isfinite(parsed))
    if bad.size:
        row = int(bad[0])
        raise InputError(
            where,
            f"row {row + first_row} holds {texts.iloc[row]!r}, which is not a number"
            f" ({bad.size} such rows).",
            "Remove the row or give a number with a decimal point.",
        )
    return parsed
