"""Read compression tests of yarns: the testing machine's workbook, or a simple CSV.

Workbook (XLS or XLSX): one sheet per test, named ``yarn-number``, with a title row, a row of column
names (``Standard force``, ``Strain``: the probe's depth) and a row of units (mN or N; mm); a sheet
``Yarn Diameters`` with one column per yarn and one row per sample.

CSV: a header line with ``depth_mm, force_n`` and, where there are several tests, ``sample``
(``yarn-number``); the diameter may be a column ``diameter_mm``. Other text is read as
:mod:`knitcore.measure.tester_tables` does, in any of its units.
"""

import re
from dataclasses import dataclass, replace
from pathlib import Path

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.result import Result
from knitcore.measure.table_reading import TableReading
from knitcore.measure.tables import numbers, read_table, rows_by_label
from knitcore.measure.tester_tables import read_specimens
from knitcore.measure.workbooks import MAX_BYTES, Worksheet, is_workbook, read_workbook


@dataclass(frozen=True, eq=False, repr=False)
class CompressionTest(Result):
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
        raise InputError(
            path.name, "is larger than 50 MB.", "Keep only the sheets with tests in it."
        )
    if is_workbook(path):
        return _of_workbook(path)
    if path.suffix.lower() in (".xls", ".xlsx"):
        raise InputError(path.name, "is not a workbook.", "Give an XLS, XLSX or CSV file.")
    return _read_csv(path)


def _yarn(name: str) -> str:
    return re.sub(r"[\s_-]*\d+$", "", name).strip().lower() or name


# -- workbooks -----------------------------------------------------------------------------------


def _of_workbook(path: Path) -> list[CompressionTest]:
    diameters = _diameters(read_workbook(path))
    tests = _of_tester(path, TableReading(columns={"extension_mm": "Strain"}))
    return [replace(test, diameter_mm=_diameter_of(diameters, test)) for test in tests]


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


def _diameter_of(diameters: dict[tuple[str, int], float], test: CompressionTest) -> float | None:
    at_end = re.search(r"(\d+)\s*$", test.name)
    number = int(at_end.group(1)) if at_end else 1
    matching = [v for (column, n), v in diameters.items() if test.yarn in column and n == number]
    return matching[0] if len(matching) == 1 else None


# -- CSV -----------------------------------------------------------------------------------------


def _read_csv(path: Path) -> list[CompressionTest]:
    with path.open("rb") as file:
        head = file.readline(10_000).decode("utf-8-sig", "replace").lower()
    if not {"depth_mm", "force_n"} <= {name.strip() for name in head.split(",")}:
        return _of_tester(path, TableReading())
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


def _of_tester(path: Path, reading: TableReading) -> list[CompressionTest]:
    """Tests of a tester's table: its path is the depth."""
    specimens, _ = read_specimens(path, reading)
    is_alone = len(specimens) == 1 and not is_workbook(path)
    tests = []
    for specimen in specimens:
        name = path.stem if is_alone else specimen.name.removeprefix(f"{path.name}, ")
        depth, force = specimen.columns.get("extension_mm"), specimen.columns["force_n"]
        if depth is None:
            remedy = "Give it in mm, not in percent."
            raise InputError(specimen.name, "has no column of the probe's depth.", remedy)
        tests.append(CompressionTest(name, _yarn(name), depth, force, None))
    return tests
