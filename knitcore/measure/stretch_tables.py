"""Read stretch tests from tables: a simple one of our own, and those that testers write.

Own table (CSV, or the first sheet of an XLSX or XLS workbook): a header line with ``strain_along,
strain_across, force_n, width_mm`` and, for repeated pulls, ``run``, the distance of the clamps at
rest, ``length_mm``, and that of the points between which the strain across is read, ``across_mm``;
one row per point in the order of the pull.

Tester's table: whatever :mod:`knitcore.measure.tester_tables` reads. Of a specimen that is pulled
again and again the first pull conditions it and is not used; the others are, without their
unloading. A tester sees no narrowing: the strain across is then not a number.
"""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import scipy

from knitcore.base.arrays import Array, Indices
from knitcore.base.errors import InputError
from knitcore.measure.plausibility import plausible
from knitcore.measure.stretch_test import (
    StretchRun,
    StretchTest,
    check_run,
    misread_forces,
    until_unloaded,
)
from knitcore.measure.table_reading import (
    Doubt,
    DoubtError,
    OtherReading,
    TableReading,
    doubt_of_width,
)
from knitcore.measure.tables import numbers, read_table, rows_by_label
from knitcore.measure.tester_tables import Specimen, has_units, in_unit, read_specimens
from knitcore.measure.workbooks import Worksheet, is_workbook, read_workbook

CSV_COLUMNS = ("strain_along", "strain_across", "force_n", "width_mm")
TABLE_LENGTHS = {"length_mm": "the clamps", "across_mm": "the points tracked across"}
"""Optional columns, each with the marks between which it is measured."""
MAX_TABLE_BYTES = 64 * 2**20
WIDER_THAN_CLAMPED = 1.2
"""Tracked points farther apart than this share of the clamped width mean a misread width."""
FAR = 3.0
"""Strain beyond which a length at rest may be in another unit."""
MIN_WIDTH_MM = 5.0
TURNS = 0.2
"""Part of the largest strain by which a strain must fall to begin another pull."""


def read_stretch_table(path: Path, reading: TableReading | None = None) -> StretchTest:
    """A test from a table.

    Raises
    ------
    InputError
        If the file has no usable pull, or does not say which column is which.
    """
    if path.stat().st_size > MAX_TABLE_BYTES:
        raise InputError(path.name, "is larger than 64 MB.", "Thin the points out.")
    reading = reading or TableReading()
    return _read_table(path, reading) if is_own_table(path) else _of_specimens(path, reading)


def is_own_table(path: Path) -> bool:
    """Tell whether the first line has names of our own columns, between commas, in our units."""
    if is_workbook(path):
        head = read_workbook(path, only_head=True)
        rows: Worksheet = [*next(iter(head.values()), []), [], []]
        names, below = ([str(cell) for cell in row] for row in rows[:2])
    else:
        with path.open("rb") as file:
            lines = [file.readline(10_000).decode("utf-8-sig", "replace") for _ in range(2)]
        names, below = (line.strip().split(",") for line in lines)
    own = {_column_name(name) for name in names} & {*CSV_COLUMNS}
    is_ours = len(own) >= 2 and "strain_along" in own
    return is_ours and not has_units(names, below, {"n", "mm", "-", "1"})


# -- testers' tables -------------------------------------------------------------------------------


def _of_specimens(path: Path, reading: TableReading) -> StretchTest:
    specimens, notes = read_specimens(path, reading)
    doubts: list[Doubt] = []
    runs: list[StretchRun] = []
    widths: dict[str, float] = {}
    for specimen in specimens:
        width = _constant(specimen, "width_mm", reading.width_mm)
        if width is None:
            remedy = "Give the clamped width at rest in mm."
            raise InputError(specimen.name, "does not say how wide the specimen is.", remedy)
        if "width_mm" not in reading.sure:
            _check_width(specimen.name, width)
        pulls = [*_pulls(specimen, width, reading, notes)]
        if len(pulls) > 1 and not specimen.labels:
            notes.append(f"{specimen.name}: {_conditioned(len(pulls))}")
            pulls = pulls[1:]
        widths |= dict.fromkeys((pull.name for pull in pulls), width)
        runs += pulls
    if not all(np.isfinite(run.strain_across).all() for run in runs):
        notes.append(
            f"{path.name} has no strain across the pull, so Poisson's ratio is that of knitted"
            " fabric in general, and less certain."
        )
    sound = sound_runs([plausible(run, reading, notes, doubts) for run in runs], notes)
    lengths = {_constant(s, "length_mm", reading.length_mm) for s in specimens}
    length = lengths.pop() if len(lengths) == 1 else None
    across = _constant(specimens[0], "across_mm", None)
    sizes = tuple(widths[run.name] for run in sound)
    return StretchTest(
        path.name, "", tuple(sound), sizes, tuple(notes), length, across,
        tuple(doubts[:1]), reading.sure,
    )  # fmt: skip


def _conditioned(pulls: int) -> str:
    return f"of {pulls} pulls the first conditions the specimen and is left out."


def _check_width(name: str, width_mm: float) -> None:
    """Refuse a width that no clamp holds.

    Raises
    ------
    DoubtError
        With the units that it may be in.
    """
    if width_mm < MIN_WIDTH_MM:
        doubt = doubt_of_width(name, width_mm)
        problem = f"{width_mm:g} is below {MIN_WIDTH_MM:g} mm, so it may be in cm or m."
        remedy = "Give the clamped width at rest in mm."
        answers = doubt.readings[:-1] if doubt else ()
        raise DoubtError.of(f"{name}, width_mm", problem, remedy, *answers)


def _constant(specimen: Specimen, name: str, given: float | None) -> float | None:
    if given is not None:
        return given
    if name in specimen.columns:
        return float(specimen.columns[name][0])
    return specimen.constants.get(name)


def _pulls(
    specimen: Specimen, width_mm: float, reading: TableReading, notes: list[str]
) -> Iterator[StretchRun]:
    """Pulls of a specimen: its runs, or the parts in which the strain grows."""
    columns = specimen.columns
    along = columns.get("strain_along")
    if along is None:
        length = _constant(specimen, "length_mm", reading.length_mm)
        if length is None:
            remedy = (
                "Give length_mm, the distance of the clamps at rest: strain is extension/length."
            )
            raise InputError(specimen.name, "has an extension, but no length at rest.", remedy)
        if len(specimen.lengths_mm) > 1 and "length_mm" not in reading.sure | {*columns}:
            raise DoubtError.of(
                specimen.name,
                f"names several lengths at rest: {', '.join(f'{v:g}' for v in specimen.lengths_mm)}"
                " mm.",
                "Give the one over which the extension is measured, as length_mm.",
                *(OtherReading(f"{v:g} mm", {"length_mm": v}) for v in specimen.lengths_mm),
            )
        along = columns["extension_mm"] / length
        if -along.min() > along.max() and -columns["force_n"].min() > columns["force_n"].max():
            along = -along
            notes.append(f"{specimen.name}: extensions are negative, and are read as stretching.")
        doubt = doubt_of_width(specimen.name, length, name="length_mm")
        if along.max() > FAR and "length_mm" not in reading.sure and doubt is not None:
            raise DoubtError.about(doubt)
    force = columns["force_n"]
    if force.max(initial=0.0) < -force.min(initial=0.0):
        force = -force
        notes.append(f"{specimen.name}: forces are negative, and are read as tension.")
    across = columns.get("strain_across", np.full(len(along), np.nan))
    across = -across if reading.narrowing_is_positive else across
    labels = np.array(specimen.labels)
    named = [(f"run {label}", np.flatnonzero(labels == label)) for label in dict.fromkeys(labels)]
    parts = named or [(f"pull {n + 1}", rows) for n, rows in enumerate(_growing(along))]
    for name, rows in parts:
        title = f"{specimen.name}, {name}" if len(parts) > 1 else specimen.name
        stress = force[rows] / width_mm
        good = ~misread_forces(stress)
        yield StretchRun(title, along[rows][good], across[rows][good], stress[good])


def _growing(strain: Array) -> list[Indices]:
    """Readings of each pull: from the lowest strain after the one before to the highest."""
    least = TURNS * float(np.ptp(strain))
    padded = np.concatenate([[-np.inf], strain, [-np.inf]])
    tops = scipy.signal.find_peaks(padded, prominence=least)[0] - 1
    parts, begin = [], 0
    for top in tops.tolist() or [len(strain) - 1]:
        begin += int(np.argmin(strain[begin : top + 1]))
        parts.append(np.arange(begin, top + 1))
        begin = top
    return parts


def sound_runs(runs: list[StretchRun], notes: list[str]) -> list[StretchRun]:
    """The pulls that a fit can use, without their unloading; refuses if there is none."""
    sound: list[StretchRun] = []
    refused: InputError | None = None
    for whole in runs:
        run = until_unloaded(whole)
        try:
            check_run(run)
        except InputError as error:
            refused = error
            notes.append(f"{run.name} is left out: {error.problem}")
            continue
        _note_unloading(run, whole, notes)
        sound.append(run)
    if refused is not None and not sound:
        raise refused
    return sound


def _note_unloading(run: StretchRun, whole: StretchRun, notes: list[str]) -> None:
    if run.length < whole.length:
        after = whole.length - run.length
        notes.append(f"{run.name}: {after} readings after the largest force are left out.")


# -- our own table ---------------------------------------------------------------------------------


def _read_table(path: Path, reading: TableReading) -> StretchTest:
    table = read_table(path, ", ".join(CSV_COLUMNS))
    table.columns = [_column_name(str(c)) for c in table.columns]
    table = table[~(table.isna() | (table == "")).all(axis=1)]
    _check_header(path.name, list(table.columns))
    given = [*CSV_COLUMNS, *(name for name in TABLE_LENGTHS if name in table)]
    values = {
        name: in_unit(numbers(where, table[name]), name, reading.units.get(name), where)
        for name in given
        for where in [f"{path.name}, column {name}"]
    }
    if len(table) == 0:
        raise InputError(path.name, "has no rows.", "Give one row per point.")
    for name in ("width_mm", "length_mm"):
        if (size := getattr(reading, name)) is not None:
            values[name] = np.full(len(table), size)
    if reading.columns.get("strain_across") == "":
        values["strain_across"] = np.full(len(table), np.nan)
    elif reading.narrowing_is_positive:
        values["strain_across"] = -values["strain_across"]
    notes: list[str] = []
    doubts: list[Doubt] = []
    labelled = rows_by_label(table, "run", "")
    if "run" not in table and len(pulls := _growing(values["strain_along"])) > 1:
        notes.append(f"{path.name}: {_conditioned(len(pulls))}")
        labelled = {f"pull {n + 1}": rows for n, rows in enumerate(pulls)}
        del labelled["pull 1"]
    runs_and_widths = [
        _run(path.name, label, rows, values, notes) for label, rows in labelled.items()
    ]
    runs = tuple(plausible(run, reading, notes, doubts) for run, _ in runs_and_widths)
    widths = tuple(width for _, width in runs_and_widths)
    lengths = {
        column: _length(path.name, column, values[column])
        for column in TABLE_LENGTHS
        if column in values
    }
    clamps, across = (lengths.get(column) for column in TABLE_LENGTHS)
    if across is not None and across > WIDER_THAN_CLAMPED * min(widths):
        problem = f"{across:g} mm is more than the clamped width."
        remedy = "Give the distance, in mm at rest, of the points that you track across."
        raise InputError(f"{path.name}, column across_mm", problem, remedy)
    return StretchTest(
        path.name, "", runs, widths, tuple(notes), clamps, across, tuple(doubts[:1]), reading.sure
    )


def _length(name: str, column: str, length: Array) -> float:
    """A length at rest, the same in all rows."""
    if length.min() < 5 or np.ptp(length) > 0.01 * length[0]:
        raise InputError(
            f"{name}, column {column}",
            f"goes from {length.min():g} to {length.max():g} mm.",
            f"Give the distance of {TABLE_LENGTHS[column]} at rest in mm, the same in every row.",
        )
    return float(length[0])


def _column_name(text: str) -> str:
    """The documented name of a column: ``Force (N)`` and ``force`` are ``force_n``."""
    name = re.sub(r"[^\w%]+", "_", text.strip().lower()).strip("_")
    return {"force": "force_n", "width": "width_mm", "length": "length_mm"}.get(name, name)


def _check_header(name: str, columns: list[str]) -> None:
    percent = [c for c in columns if "strain" in c and ("%" in c or "percent" in c)]
    if percent:
        remedy = "Divide the strains by 100 and name the columns strain_along and strain_across."
        raise InputError(f"{name}, {percent[0]}", "is a strain in percent (%).", remedy)
    missing = [c for c in CSV_COLUMNS if c not in columns]
    if missing:
        problem = f"has no column {', '.join(missing)} (it has {', '.join(columns[:8])})."
        raise InputError(name, problem, f"The header line must name {', '.join(CSV_COLUMNS)}.")


def _run(
    name: str, label: str, rows: Indices, values: dict[str, Array], notes: list[str]
) -> tuple[StretchRun, float]:
    title = f"{name}, run {label}" if label else name
    width = values["width_mm"][rows]
    _check_width(f"{title}, row {int(rows[np.argmin(width)]) + 2}", float(width.min()))
    if np.ptp(width) > 0.01 * width[0]:
        row = int(rows[np.argmax(np.abs(width - width[0]) > 0.01 * width[0])])
        problem = f"changes from {width[0]:g} to {values['width_mm'][row]:g} mm in row {row + 2}."
        remedy = "Stress is force per width at rest: give that width in every row of a run."
        raise InputError(f"{title}, column width_mm", problem, remedy)
    force = values["force_n"][rows]
    good = ~misread_forces(force)
    whole = StretchRun(
        name=title,
        strain_along=values["strain_along"][rows][good],
        strain_across=values["strain_across"][rows][good],
        stress=force[good] / width[0],
    )
    run = until_unloaded(whole)
    check_run(run, first_row=int(rows[0]) + 2)
    _note_unloading(run, whole, notes)
    return run, float(width[0])
