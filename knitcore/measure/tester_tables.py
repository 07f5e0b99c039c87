"""Tables of tensile testers: names and units of columns, specimens one below or beside the other.

Testers write what they measured as text (commas, semicolons or tabs; decimal points or commas; a
line ``sep=;``; UTF-8, UTF-16 or Windows' letters) or as a workbook with a sheet for each specimen.
Lines about the test come first, such as ``Width;25 mm``; then a line of names, often a line of
units, and the readings. Either line starts a new specimen when it comes again; so does a quantity
that comes again in the line of names. Numbers without a line of names have columns called
``column 1``, ``column 2`` and so on, until a user says what they are.
"""

import csv
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.measure.table_reading import TableReading
from knitcore.measure.workbooks import MAX_COLUMNS, MAX_ROWS, is_workbook, read_workbook

QUANTITIES = {
    "strain_across": r"strain_across|(transverse|lateral|width(wise)?) strain|dehnung quer"
    r"|querdehnung|strain (2|trans\w*|lat\w*)",
    "strain_along": r"strain_along|strain (1|axial|longitudinal)"
    r"|((tensile|axial|longitudinal|nominal|engineering|stroke) )?strain"
    r"|(längs|standard)?dehnung( längs)?",
    "extension_mm": r"((tensile|compressive|machine|axial|corrected) )?"
    r"(extension|displacement|elongation|position|travel)( mm| from preload)?"
    r"|standard travel|deformation|stroke|depth(_mm)?"
    r"|cross ?head( (travel|position|displacement|separation|extension))?"
    r"|(standard|traversen)?weg|verlängerung|allongement|déplacement|desplazamiento"
    r"|alargamiento|spostamento|allungamento|corsa",
    "force_n": r"force_n|((standard|axial|tensile) ?)?(force|kraft|load)( cell)?|(standard)?last"
    r"|fuerza|carga|forza|carico",
    "width_mm": r"((specimen|sample|clamped|initial) )?(width|breite)( [bw]0)?|width_mm"
    r"|proben?breite( b0)?|b0|largeur|ancho|larghezza",
    "length_mm": r"((initial|original) )?gau?ge length( l0)?|length_mm|((initial|original) )?grip"
    r"( to grip)? separation( at .*)?|clamp distance|((specimen|sample|initial) )?length( l0)?"
    r"|(einspann|mess|proben)?länge( l0| bei .*)?|(grip|clamp)(ing)? length|l0|longueur|longitud"
    r"|lunghezza",
    "across_mm": r"across_mm",
    "run": r"run|specimen( (no\.?|number|id))?|sample( (no\.?|number))?|probe(n?nummer)?",
    "time": r"((test|running|elapsed) )?time|(prüf)?zeit|temps|tiempo|tempo",
}
"""Titles of testers' columns, in English and German, and the usual ones in French, Spanish and
Italian, by the names that we use."""
UNITS = {
    "force": {
        "n": 1.0, "kn": 1e3, "mn": 1e-3, "cn": 1e-2, "g": 9.80665e-3, "gf": 9.80665e-3,
        "kg": 9.80665, "kgf": 9.80665, "lbf": 4.4482216, "lb": 4.4482216, "dan": 10.0,
    },
    "length": {
        "mm": 1.0, "cm": 10.0, "m": 1000.0, "µm": 1e-3, "μm": 1e-3, "um": 1e-3, "in": 25.4,
        "inch": 25.4, '"': 25.4,
    },
    "strain": {"%": 0.01, "percent": 0.01, "-": 1.0, "1": 1.0, "mm/mm": 1.0, "m/m": 1.0},
}  # fmt: skip
"""Size of each unit in N, in mm and as a fraction."""
RATIO = "ratio"
"""Unit of a strain that is given as length over length at rest."""
MAX_UNIT = 7
"""Letters of the longest unit, ``percent``."""
MIN_READINGS = 5
"""Rows of numbers from which on they count as the readings of a specimen."""
_UNIT = re.compile(
    r"\s*[(\[]\s*([^)\]]*?)\s*[)\]]\s*$|[\s_](%|percent|cn|mn|kn|kgf|gf|lbf|cm|in)$", re.IGNORECASE
)
_STATED = re.compile(r"(?P<name>[^\d:=]*[^\d:=\s])\s*[:=]?\s+(?P<value>\d.*)")
"""A quantity and its value in one cell: ``Width : 50 mm``."""
_SPACED = re.compile(
    r" *[+-]?\d+(?:[.,]\d+)?(?:e[+-]?\d+)?(?: +[+-]?\d+(?:[.,]\d+)?(?:e[+-]?\d+)?)+ *", re.I
)
_GROUPED = re.compile(
    r"[+-]?\d{1,3}(?:,\d{3})+\.\d+|[+-]?\d{1,3}(?:[ \u00a0\u2009\u202f]\d{3})+[.,]?\d*"
)
"""Thousands in groups, where nothing else can be meant."""
_DECIMAL_COMMA = re.compile(r"[+-]?(\d{1,3}(\.\d{3})+|\d+),\d*(e[+-]?\d+)?", re.IGNORECASE)

_STRETCHES = {"strain_along", "extension_mm"}

Rows = list[list[str]]


@dataclass(frozen=True, eq=False)
class Specimen:
    """Readings of one specimen.

    Attributes
    ----------
    name : as the file has it, or its place in the file.
    columns : by our names (:data:`QUANTITIES`), (readings,) in mm, N and as fractions.
    constants : such as ``width_mm``, from lines above the readings.
    labels : of the rows, where a column says to which run they belong.
    lengths_mm : all lengths at rest that the lines just above the readings name.
    """

    name: str
    columns: dict[str, Array]
    constants: dict[str, float] = field(default_factory=dict)
    labels: tuple[str, ...] = ()
    lengths_mm: tuple[float, ...] = ()


def read_specimens(path: Path, reading: TableReading) -> tuple[list[Specimen], list[str]]:
    """The specimens of a tester's file, and notes about how it was read.

    Parameters
    ----------
    path : text or workbook.
    reading : columns and units where the file says too little; a title that the file has not is
        not used.

    Raises
    ------
    InputError
        If no line names a force and a strain or an extension, or a reading is not a number.
    """
    notes: list[str] = []
    specimens: list[Specimen] = []
    unknown = sorted({*reading.columns, *reading.units} - set(QUANTITIES))
    if unknown:
        remedy = f"Use {', '.join(QUANTITIES)}."
        raise InputError("columns", f"{unknown[0]!r} is none of our columns.", remedy)
    heads: list[str] = []
    for sheet, rows in _sheets(path, notes):
        specimens += _specimens(path.name, sheet, rows, reading, notes)
        heads = heads or [cell for cell in _first_numbers(rows).titles if cell]
    if not specimens:
        has = f" (it has {', '.join(heads[:8])})" if heads else ""
        raise InputError(
            path.name, f"has no column strain_along or extension_mm beside one force_n{has}.",
            "Name the columns in a line above their numbers, or say which column is which.",
        )  # fmt: skip
    return specimens, list(dict.fromkeys(notes))


# -- rows of texts ---------------------------------------------------------------------------------


def _sheets(path: Path, notes: list[str]) -> Iterator[tuple[str, Rows]]:
    if is_workbook(path):
        for sheet, cells in read_workbook(path).items():
            yield sheet, [[str(cell).strip() for cell in row] for row in cells]
        return
    text = _decoded(path, notes)
    lines = text.splitlines()
    if len(lines) > MAX_ROWS:
        raise InputError(path.name, f"has more than {MAX_ROWS:,} rows.", "Thin the points out.")
    separator = ""
    if lines and (named := re.fullmatch(r'"?sep=(.)"?', lines[0].strip(), re.IGNORECASE)):
        separator, lines[0] = named.group(1), ""
    separator = separator or _separator(lines)
    if separator:
        try:
            rows = list(csv.reader(lines, delimiter=separator, skipinitialspace=True))
        except csv.Error as error:
            raise InputError(path.name, f"is not CSV ({error}).", "Save it as CSV again.") from None
    else:
        rows = [re.split(r"\s{2,}", line.strip()) for line in lines]
        if max(map(len, rows), default=0) < 2:
            rows = [line.split() for line in lines]
    if max(map(len, rows), default=0) > MAX_COLUMNS:
        raise InputError(
            path.name, f"has more than {MAX_COLUMNS} columns.", "Keep only the columns of the test."
        )
    stripped = [[_ungrouped(cell.strip()) for cell in row] for row in rows]
    if _has_decimal_commas(stripped, separator):
        notes.append(f"{path.name}: commas are read as decimal commas.")
        stripped = [[_with_point(cell) for cell in row] for row in stripped]
    yield "", stripped


def _has_decimal_commas(rows: Rows, separator: str) -> bool:
    """Say whether commas are decimal ones; in quotes between commas 1,234 may be a thousand."""
    with_comma = [cell for row in rows for cell in row if _DECIMAL_COMMA.fullmatch(cell)]
    if separator != ",":
        return bool(with_comma)
    return any(re.search(r"^[+-]?0,|,(?!\d{3}$)", cell) for cell in with_comma)


def _ungrouped(cell: str) -> str:
    if _GROUPED.fullmatch(cell) is None:
        return cell
    return re.sub(r"[ \u00a0\u2009\u202f]|,(?=.*\.)", "", cell)


def _decoded(path: Path, notes: list[str]) -> str:
    data = path.read_bytes()
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("cp1252", "replace")
        notes.append(f"{path.name} is not in UTF-8; its letters are read as Windows' (cp1252).")
    if "\0" in text:
        raise InputError(path.name, "is not text.", "Give a CSV, TXT or XLSX file.")
    return text


def _separator(lines: list[str]) -> str:
    """The character that most lines have most often; "" where spaces stand between numbers."""
    some = [line for line in lines[:400] if line.strip()]
    if sum(_SPACED.fullmatch(line) is not None for line in some) > len(some) / 2:
        return ""

    def columns(separator: str) -> tuple[int, int]:
        counts = [line.count(separator) for line in some]
        usual = int(np.median(counts)) if counts else 0
        return sum(count >= max(usual, 1) for count in counts), usual

    return max(("\t", ";", ","), key=columns)


def _with_point(cell: str) -> str:
    return cell.replace(".", "").replace(",", ".") if _DECIMAL_COMMA.fullmatch(cell) else cell


# -- specimens -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Column:
    """A column of readings: our name, its place, and what one of its unit is."""

    name: str
    place: int
    unit: str | None


def _specimens(
    file: str, sheet: str, rows: Rows, reading: TableReading, notes: list[str]
) -> Iterator[Specimen]:
    """Specimens of a sheet, in the order of their readings."""
    constants: dict[str, float] = {}
    lengths: list[float] = []
    title = sheet
    nameless = _first_numbers(rows)
    row = 0
    while row < len(rows):
        is_nameless = not nameless.has_names and row == nameless.first
        heads = nameless.titles if is_nameless else rows[row]
        groups = _heads(heads, reading.columns)
        if not groups:
            before = constants
            title, constants = _about(rows[row], title, constants)
            if constants is not before and "length_mm" in constants:
                lengths.append(constants["length_mm"])
            row += 1
            continue
        first = row if is_nameless else row + 1
        units = nameless.units
        if not is_nameless:
            units = rows[first] if first < len(rows) and _is_units(rows[first]) else []
            first += bool(units)
        groups = [[_with_unit(c, units) for c in group] for group in groups]
        end = first
        while end < len(rows) and _is_reading(rows[end], groups):
            end += 1
        while end > first and not _is_numeric(rows[end - 1], groups):  # results below the readings
            end -= 1
        readings = [(at, rows[at]) for at in range(first, end) if any(rows[at])]
        if len(readings) >= MIN_READINGS:
            _check_width(file, [head for head in heads if head], *readings[0])
            _tell_unread(file, heads, groups, reading.columns, notes)
            for place, group in enumerate(groups):
                name = title or "readings"
                name = f"{name} {place + 1}" if len(groups) > 1 else name
                made = _specimen(f"{file}, {name}", group, readings, constants, reading.units)
                yield replace(made, lengths_mm=tuple(dict.fromkeys(lengths)))
            title, lengths = sheet, []
        row = max(end, first)


def _check_width(file: str, heads: list[str], at: int, row: list[str]) -> None:
    """Refuse numbers that a decimal comma cuts in two."""
    if len(row) >= 2 * len(heads):
        problem = f"row {at + 1} has {len(row)} numbers under {len(heads)} names: its decimals are"
        remedy = "Save it with semicolons between columns, or with decimal points."
        raise InputError(file, f"{problem} commas between commas.", remedy)


@dataclass(frozen=True)
class _FirstNumbers:
    """Where the first numbers of a sheet begin, and what stands above them.

    ``titles`` are ``column 1``, ``column 2`` and so on if no line of names does.
    """

    titles: list[str]
    units: list[str]
    first: int
    has_names: bool


def _first_numbers(rows: Rows) -> _FirstNumbers:
    numeric = [sum(_number(cell) is not None for cell in row) >= 2 for row in rows]
    starts = range(len(rows) - MIN_READINGS + 1)
    first = next((at for at in starts if all(numeric[at : at + MIN_READINGS])), None)
    if first is None:
        return _FirstNumbers([], [], len(rows), has_names=True)
    above = [row for row in rows[:first] if any(row)]
    units = above.pop() if above and _is_units(above[-1]) else []
    if above and _is_names(above[-1]):
        return _FirstNumbers(above[-1], units, first, has_names=True)
    width = max(map(len, rows[first : first + MIN_READINGS]))
    return _FirstNumbers(
        [f"column {number + 1}" for number in range(width)], units, first, has_names=False
    )


def _is_names(row: list[str]) -> bool:
    """Tell whether a line may name columns: it has two texts, and no number or constant."""
    cells = [cell for cell in row if cell]
    has_numbers = any(_number(cell) is not None for cell in cells) or _about(row, "", {})[1]
    return len(cells) > 1 and not has_numbers


@dataclass(frozen=True)
class TableHeads:
    """The line above the numbers of a table, and its first rows.

    Attributes
    ----------
    titles, units, quantities : of each column; "" where there is none. Quantities are by our names.
    rows : the first readings as they stand.
    constants : such as ``width_mm``, from the lines above.
    """

    titles: tuple[str, ...]
    units: tuple[str, ...]
    quantities: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    constants: Mapping[str, float]


def table_heads(path: Path, reading: TableReading, *, most: int = 4) -> TableHeads | None:
    """Heads and first rows of a table; None if it has no numbers.

    Raises
    ------
    InputError
        If the file is not text, or too large.
    """
    for _, rows in _sheets(path, []):
        numbers = _first_numbers(rows)
        titles, units, first = numbers.titles, numbers.units, numbers.first
        if not titles:
            continue
        constants: dict[str, float] = {}
        for row in rows[:first]:
            _, constants = _about(row, "", constants)
        width = max(map(len, (titles, *rows[first : first + most])))
        named = {c.place: _with_unit(c, units) for c in _named(titles, reading.columns)}
        columns = [named.get(place) for place in range(width)]
        return TableHeads(
            tuple(_padded(titles, width)),
            tuple("" if c is None else reading.units.get(c.name, c.unit or "") for c in columns),
            tuple("" if c is None else c.name for c in columns),
            tuple(tuple(_padded(row, width)) for row in rows[first : first + most]),
            constants,
        )
    return None


def _padded(row: list[str], width: int) -> list[str]:
    return [*row, *[""] * (width - len(row))]


def _named(row: list[str], called: Mapping[str, str]) -> list[_Column]:
    """Columns of a line of names; where a user says what one is called, no other is taken for it.

    Strain and extension say the same: one that is called so replaces the other, too.
    """
    titles = {_plain(title): ours for ours, title in called.items() if title}
    here = {titles[plain] for cell in row if (plain := _plain(cell)) in titles}
    taken = here | {ours for ours, title in called.items() if not title}
    taken |= _STRETCHES if here & _STRETCHES else set()
    columns = []
    for place, cell in enumerate(row):
        name = titles.get(_plain(cell))
        if name is None and (name := _quantity(cell)) in taken:
            continue
        if name is not None:
            columns.append(_Column(name, place, _unit(cell)))
    return columns


def _heads(row: list[str], called: Mapping[str, str]) -> list[list[_Column]]:
    """Columns of a line of names, by specimens side by side; none if it is another line."""
    groups: list[list[_Column]] = [[]]
    for column in _named(row, called):
        if any(other.name == column.name for other in groups[-1]):
            groups.append([])
        groups[-1].append(column)
    shared = [column for column in groups[0] if column.name in _STRETCHES]
    alone = [group for group in groups if not _STRETCHES & {column.name for column in group}]
    for group in alone:  # one column of strain for the forces of several specimens
        group.extend(shared)
    return [group for group in groups if _usable(group)]


def _usable(group: list[_Column]) -> bool:
    names = {column.name for column in group}
    return "force_n" in names and bool(names & _STRETCHES)


def _quantity(cell: str) -> str | None:
    plain = _plain(_UNIT.sub("", cell))
    name = next((q for q, pattern in QUANTITIES.items() if re.fullmatch(pattern, plain)), None)
    is_share = (_unit(cell) or "").lower() in UNITS["strain"]
    return "strain_along" if name == "extension_mm" and is_share else name


def _plain(cell: str) -> str:
    return re.sub(r"[\s.:]+", " ", cell).strip().lower()


def _unit(cell: str) -> str | None:
    """The unit in brackets or behind a name; what else stands in brackets is a remark."""
    match = _UNIT.search(cell)
    unit = "" if match is None else (match.group(1) or match.group(2) or "").strip()
    return unit if unit and len(unit) <= MAX_UNIT else None


def _is_units(row: list[str]) -> bool:
    known = {unit for units in UNITS.values() for unit in units} | {"s", "sec", "min"}
    cells = [cell.strip("()[] ").lower() for cell in row if cell]
    named = sum(cell in known for cell in cells)
    return 2 * named > len(cells) and not any(_number(cell) is not None for cell in cells)


def has_units(names: list[str], below: list[str], ours: set[str]) -> bool:
    """Tell whether a line of names, or the one below, gives other units than ours, or all units."""
    return _is_units(below) or any((_unit(name) or "1").lower() not in ours for name in names)


def _with_unit(column: _Column, units: list[str]) -> _Column:
    unit = units[column.place].strip("()[] ") if column.place < len(units) else ""
    share = column.name == "extension_mm" and unit.lower() in ("%", "percent", "mm/mm", "m/m")
    return _Column("strain_along" if share else column.name, column.place, unit or column.unit)


def _is_reading(row: list[str], groups: list[list[_Column]]) -> bool:
    """Tell whether a row goes on with the readings: it is empty, or holds a number for a column."""
    if not any(row):
        return True
    cells = [row[c.place] for group in groups for c in group if c.place < len(row)]
    return any(_number(cell) is not None for cell in cells)


def _is_numeric(row: list[str], groups: list[list[_Column]]) -> bool:
    """Tell whether a row has numbers in our columns and nothing else, or the columns are empty."""
    cells = [
        row[c.place]
        for group in groups
        for c in group
        if c.name not in ("time", "run") and c.place < len(row)
    ]
    return any(cells) and all(_number(cell) is not None for cell in cells if cell)


def _number(cell: str) -> float | None:
    try:
        value = float(cell)
    except ValueError:
        return None
    return value if np.isfinite(value) else None


def _about(row: list[str], title: str, constants: dict[str, float]) -> tuple[str, dict[str, float]]:
    """Title and constants of the specimens below a line: its name, width or length."""
    cells = [cell for cell in row if cell]
    if not cells:
        return title, constants
    if len(cells) == 1 and (stated := _STATED.fullmatch(cells[0])):
        cells = [stated["name"], stated["value"]]
    name = _quantity(cells[0])
    if name in ("width_mm", "length_mm") and len(cells) > 1:
        value, _, behind = cells[1].partition(" ")
        number = _number(_with_point(value))
        unit = behind or (cells[2] if len(cells) > 2 else "") or _unit(cells[0]) or "mm"
        if number is not None:
            scale = _scale(name, unit, cells[0])
            return title, {**constants, name: number * scale}
    if len(cells) <= 2 and re.match(r"(specimen|sample|probe|prüfling|test|run)\b", cells[0], re.I):
        return " ".join(cells), constants
    return title, constants


def in_unit(values: Array, name: str, unit: str | None, where: str) -> Array:
    """Readings of one of our columns in mm, N or as fractions.

    Raises
    ------
    InputError
        If the unit is not known.
    """
    if unit == RATIO and name.startswith("strain"):
        return values - 1.0
    return values if unit is None else _scale(name, unit, where) * values


def _scale(name: str, unit: str, where: str) -> float:
    kind = {"force_n": "force", "strain_along": "strain", "strain_across": "strain"}.get(name)
    units = UNITS[kind or "length"]
    scale = units.get(unit.strip("()[] ").lower())
    if scale is None:
        remedy = f"Give it in {', '.join(units)}."
        raise InputError(where, f"is in {unit!r}, which is not known.", remedy)
    return scale


def _specimen(
    name: str,
    group: list[_Column],
    readings: list[tuple[int, list[str]]],
    constants: dict[str, float],
    units: Mapping[str, str],
) -> Specimen:
    columns = {}
    labels: tuple[str, ...] = ()
    inside = [
        (at, row) for at, row in readings if any(c.place < len(row) and row[c.place] for c in group)
    ]
    for column in group:
        texts = [row[column.place] if column.place < len(row) else "" for _, row in inside]
        if column.name == "run":
            labels = tuple(texts)
        elif column.name != "time":
            values = _readings(f"{name}, column {column.name}", texts, inside)
            unit = units.get(column.name, column.unit)
            columns[column.name] = in_unit(values, column.name, unit, name)
    return Specimen(name, columns, constants, labels)


def _readings(where: str, texts: list[str], rows: list[tuple[int, list[str]]]) -> Array:
    try:
        values = np.array(texts, dtype=float)
    except ValueError:
        values = np.array([np.nan if (v := _number(text)) is None else v for text in texts])
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        at = int(bad[0])
        raise InputError(
            where, f"row {rows[at][0] + 1} holds {texts[at]!r}, which is not a number"
            f" ({bad.size} such rows).", "Remove the row or give a number.",
        )  # fmt: skip
    return values


def _tell_unread(
    file: str,
    heads: list[str],
    groups: Iterable[list[_Column]],
    called: Mapping[str, str],
    notes: list[str],
) -> None:
    used = {column.place for group in groups for column in group}
    left = [(place, cell) for place, cell in enumerate(heads) if cell and place not in used]
    unread = [cell for _, cell in left if _quantity(cell) is None or _quantity(cell) in called]
    if unread:
        notes.append(f"{file}: not used: {', '.join(unread[:8])}.")
    beside = [cell for _, cell in left if _quantity(cell) in {*_STRETCHES, "force_n"} - {*called}]
    if beside:
        taken = [
            heads[c.place] for group in groups for c in group if c.name in (*_STRETCHES, "force_n")
        ]
        notes.append(
            f"{file}: {', '.join(taken[:4])} are read, and {', '.join(beside[:4])} is not."
        )
