"""Read compression tests of yarns: the testing machine's workbook, or a simple CSV.

Workbook (XLS or XLSX): one sheet per test, named ``yarn-number``, with a title row, a row of column
names (``Standard force``, ``Strain``: the probe's depth) and a row of units (mN or N; mm); a sheet
``Yarn Diameters`` with one column per yarn and one row per sample.

CSV: a header line with ``depth_mm, force_n`` and, where there are several tests, ``sample``
(``yarn-number``); the diameter may be a column ``diameter_mm``. Other text is read as
:mod:`knitcore.measure.tester_tables` does, in any of its units.
"""

import re
from dataclasses import dataclass
from pathlib import Path

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.measure.table_reading import TableReading
from knitcore.measure.tables import numbers, read_table, rows_by_label
from knitcore.measure.tester_tables import read_specimens, table_heads
from knitcore.measure.workbooks import MAX_BYTES, Cell, Worksheet, is_workbook, read_workbook


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


@in_reading_time
def read_compression(path: Path) -> list[CompressionTest]:
    """All tests of a file.

    Raises
    ------
    InputError
        If the file is missing, is not of the type of its suffix, or holds other data.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(str(path), "is not a file.", "Give the path of an XLS, XLSX or CSV file.")
    if path.stat().st_size > MAX_BYTES:
        raise InputError(path.name, "is larger than 50 MB.", "Give the tests only.")
    if is_workbook(path):
        return _of_workbook(path.name, read_workbook(path))
    if path.suffix.lower() in (".xls", ".xlsx"):
        raise InputError(path.name, "is not a workbook.", "Give an XLS, XLSX or CSV file.")
    return _read_csv(path)


def _yarn(name: str) -> str:
    return re.sub(r"[\s_-]*\d+$", "", name).strip().lower() or name


# -- workbooks -----------------------------------------------------------------------------------


def _of_workbook(file_name: str, sheets: dict[str, Worksheet]) -> list[CompressionTest]:
    diameters = _diameters(sheets)
    tests = [
        _of_sheet(file_name, name, sheet, diameters)
        for name, sheet in sheets.items()
        if "diameter" not in name.lower()
    ]
    if not tests:
        raise InputError(file_name, "has no sheet with a test.", "Give one sheet per test.")
    return tests


def _of_sheet(
    file_name: str, name: str, sheet: Worksheet, diameters: dict[tuple[str, int], float]
) -> CompressionTest:
    where = f"{file_name}, sheet {name!r}"
    header = next(
        (
            row
            for row, cells in enumerate(sheet[:10])
            if any("force" in str(v).lower() for v in cells)
        ),
        None,
    )
    if header is None or header + 2 >= len(sheet):
        problem = "has no column whose name contains 'force', or no readings below it."
        remedy = "Give a row of names (force, strain), a row of units, then the readings."
        raise InputError(where, problem, remedy)
    names = [str(v).strip().lower() for v in sheet[header]]
    units = [str(v).strip().lower() for v in sheet[header + 1]] + [""] * len(names)
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
    forces, depths = (
        numbers(f"{where}, column {names[column]!r}", cells, first + 1)
        for column, cells in _readings(sheet[first:], force, depth).items()
    )
    number = re.search(r"(\d+)\s*$", name)
    yarn = _yarn(name)
    return CompressionTest(
        name=name,
        yarn=yarn,
        depth_mm=depths,
        force_n=forces * (1e-3 if units[force] == "mn" else 1.0),
        diameter_mm=_diameter_of(diameters, yarn, int(number.group(1)) if number else 1),
    )


def _readings(rows: Worksheet, *columns: int) -> dict[int, list[Cell]]:
    """The columns, without the rows at the end in which all of them are empty."""
    readings = [[row[c] if c < len(row) else "" for c in columns] for row in rows]
    while readings and not any(map(str, readings[-1])):
        readings.pop()
    return {c: [row[i] for row in readings] for i, c in enumerate(columns)}


def _diameters(sheets: dict[str, Worksheet]) -> dict[tuple[str, int], float]:
    """Diameters by (column name, sample number)."""
    diameters: dict[tuple[str, int], float] = {}
    for name, sheet in sheets.items():
        if "diameter" not in name.lower():
            continue
        header: list[str] = []
        for values in filter(None, sheet):
            if "sample" in str(values[0]).lower():
                header = [str(v).strip().lower() for v in values]
            elif header and isinstance(values[0], int | float):
                for column, value in zip(header[1:], values[1:], strict=False):
                    if isinstance(value, int | float) and value > 0:
                        diameters[(column, int(values[0]))] = value
    return diameters


def _diameter_of(diameters: dict[tuple[str, int], float], yarn: str, number: int) -> float | None:
    matching = [v for (column, n), v in diameters.items() if yarn in column and n == number]
    return matching[0] if len(matching) == 1 else None


# -- CSV -----------------------------------------------------------------------------------------


def _read_csv(path: Path) -> list[CompressionTest]:
    with path.open("rb") as file:
        head = file.readline(10_000).decode("utf-8-sig", "replace").lower()
    if not {"depth_mm", "force_n"} <= {name.strip() for name in head.split(",")}:
        return _of_tester(path)
    table = read_table(path, "depth_mm, force_n")
    table.columns = [str(c).strip().lower() for c in table.columns]
    if table.empty:
        remedy = "Give a header line depth_mm,force_n and one row per reading."
        raise InputError(path.name, "has no rows.", remedy)
    columns = {
        name: numbers(f"{path.name}, column {name}", table[name])
        for name in ("depth_mm", "force_n", "diameter_mm")
        if name in table
    }
    tests = []
    for label, rows in rows_by_label(table, "sample", path.stem).items():
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


def _of_tester(path: Path) -> list[CompressionTest]:
    """Tests of a tester's table: its path is the depth."""
    heads = table_heads(path, TableReading())
    if heads is None or not {"extension_mm", "force_n"} <= {*heads.quantities}:
        has = f" (it has {', '.join(filter(None, heads.titles[:8]))})" if heads else ""
        problem = f"has no column of a depth beside one of a force{has}."
        remedy = "Give a header line depth_mm,force_n and one row per reading."
        raise InputError(path.name, problem, remedy)
    specimens, _ = read_specimens(path, TableReading())
    tests = []
    for specimen in specimens:
        name = specimen.name.removeprefix(f"{path.name}, ") if len(specimens) > 1 else path.stem
        depth, force = specimen.columns["extension_mm"], specimen.columns["force_n"]
        tests.append(CompressionTest(name, _yarn(name), depth, force, None))
    return tests
