"""Read stretch tests: the HDF5 layout of the paper's authors, and tables.

HDF5: one group ``videoN`` per pull with ``forces`` (n,) in N, ``traj`` (7, 2, n) in pixels (right,
left, bottom, top, centre, clamp bottom, clamp top; the pull is vertical in the image) and
``frames`` (n,). With four points, the two that are farthest apart across are right and left, and
the strain along is read between the other two. The datasets ``clampSize`` (px, the length of a
clamp of 35.5 mm) and ``fabricSize`` (px, the clamped width). ``video1`` conditions the sample and
is not used.

Tables are in :mod:`knitcore.measure.stretch_tables`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.measure.stretch_tables import WIDER_THAN_CLAMPED, read_stretch_table, sound_runs
from knitcore.measure.stretch_test import MIN_POINTS, StretchRun, StretchTest, misread_forces
from knitcore.measure.table_reading import TableReading

if TYPE_CHECKING:
    import h5py

CLAMP_MM = 35.5
MAX_PIXEL = 1e6
MAX_FORCE_N = 1e6
MAX_FRAMES = 2_000_000
MAX_VIDEOS = 100
_RIGHT, _LEFT, _BOTTOM, _TOP, _CENTRE, _CLAMP_BOTTOM, _CLAMP_TOP = range(7)


class Marks(StrEnum):
    """The pair of tracked points between which the strain along the pull is read.

    ``centre`` (centre of the fabric to the lower clamp) reproduces the published numbers;
    ``clamps`` is the whole sample.
    """

    CENTRE = "centre"
    CLAMPS = "clamps"

    @property
    def points(self) -> tuple[int, int]:
        """Indices of the two tracked points."""
        return (_CENTRE, _CLAMP_BOTTOM) if self is Marks.CENTRE else (_CLAMP_BOTTOM, _CLAMP_TOP)


@in_reading_time
def read_stretch_test(
    path: Path,
    *,
    marks: Marks = Marks.CLAMPS,
    file_format: str | None = None,
    reading: TableReading | None = None,
) -> StretchTest:
    """A test from a file; the format is taken from the content unless it is given.

    Parameters
    ----------
    path : HDF5, CSV or workbook.
    marks : for HDF5, which points give the strain along the pull.
    file_format : ``"h5"``, ``"csv"`` (any table) or None.
    reading : what the user says in place of the file; for HDF5, the width and the length.

    Raises
    ------
    InputError
        If the file is missing, is not of the given format, or has no usable run.
    """
    import h5py  # 10 MB, for those who read a file

    path = Path(path)
    if not path.is_file():
        raise InputError(str(path), "is not a file.", "Give the path of an HDF5, CSV or XLSX file.")
    actual = "h5" if h5py.is_hdf5(path) else "csv"
    if file_format not in (None, "h5", "csv"):
        raise InputError("format", f"{file_format!r} is unknown.", "Use csv or h5.")
    claims_hdf5 = file_format == "h5" or (
        file_format is None and path.suffix.lower() in (".h5", ".hdf5")
    )
    if claims_hdf5 and actual != "h5":
        raise InputError(
            path.name, "is not an HDF5 file, or is cut off.", "Give the file again, complete."
        )
    if file_format == "csv" and actual == "h5":
        raise InputError(path.name, "is an HDF5 file, not a CSV.", "Use the format h5.")
    if actual != "h5":
        return read_stretch_table(path, reading)
    test = _read_hdf5(path, marks)
    if reading is None:
        return test
    test = test if reading.width_mm is None else test.with_width(reading.width_mm)
    return test if reading.length_mm is None else replace(test, length_mm=reading.length_mm)


# -- HDF5 ----------------------------------------------------------------------------------------


def _read_hdf5(path: Path, marks: Marks) -> StretchTest:
    import h5py

    try:
        with h5py.File(path, "r") as file:
            return _test_from_hdf5(path.name, file, marks)
    except UnicodeDecodeError:
        raise _not_utf_8(path.name) from None
    except (OSError, RuntimeError, KeyError) as error:
        reason = (str(error).splitlines() or ["no reason given"])[0]
        remedy = "The file may be cut off or damaged: copy it again."
        raise InputError(path.name, f"cannot be read as HDF5 ({reason}).", remedy) from None


def _not_utf_8(name: str) -> InputError:
    remedy = "Name groups and datasets in plain letters, as docs/fit-a-law.md lists them."
    return InputError(name, "has a name or a text that is not UTF-8.", remedy)


def _test_from_hdf5(name: str, file: h5py.File, marks: Marks) -> StretchTest:
    notes: list[str] = []
    keys = _pulls(name, file, notes)
    clamp_px, fabric_px = (_numbers(name, file, key) for key in ("clampSize", "fabricSize"))
    if not all(size.size and size.min() > 0 for size in (clamp_px, fabric_px)):
        problem = "must both hold a positive number of pixels."
        remedy = f"clampSize is the length in pixels of a clamp of {CLAMP_MM} mm."
        raise InputError(f"{name}, clampSize and fabricSize", problem, remedy)
    mm_per_px = CLAMP_MM / float(clamp_px.mean())
    width_mm = float(fabric_px.mean()) * mm_per_px
    tracked = {key: _tracked(name, file, key, marks, notes) for key in keys}
    pulls = {key: pull for key, pull in tracked.items() if pull is not None}
    if not pulls:
        raise _no_pull(name, notes)
    first = next(iter(pulls.values()))
    across_mm = float(first.across[0]) * mm_per_px
    if across_mm > WIDER_THAN_CLAMPED * width_mm:
        notes.append(
            f"{name}: the tracked points are {across_mm:.0f} mm apart across, but the"
            f" clamped width is {width_mm:.1f} mm, so fabricSize may be misread: give the true"
            " width."
        )
    runs = [
        StretchRun(
            name=f"{name}, {key}",
            strain_along=pull.along / first.along[0] - 1,
            strain_across=pull.across / first.across[0] - 1,
            stress=pull.force / width_mm,
        )
        for key, pull in pulls.items()
    ]
    runs = sound_runs(runs, notes)
    if not runs:
        raise _no_pull(name, notes)
    length_mm = float(np.nanmedian(first.clamps[:9])) * mm_per_px
    description = np.asarray(file.attrs.get("description", "")).ravel()
    text = _text(description[0]) if description.size else ""
    widths = (width_mm,) * len(runs)
    return StretchTest(name, text, tuple(runs), widths, tuple(notes), length_mm, across_mm)


def _no_pull(name: str, notes: list[str]) -> InputError:
    remedy = "Give at least one pull that is tracked from rest to the largest force."
    return InputError(name, "has no usable pull. " + " ".join(notes), remedy)


def _pulls(name: str, file: h5py.File, notes: list[str]) -> list[str]:
    """Groups of the pulls in their order, without the first of several."""
    if any(isinstance(key, bytes) for key in file):  # h5py's form of a name it cannot decode
        raise _not_utf_8(name)
    videos = sorted(
        (int(match.group(1)), key)
        for key in file
        if (match := re.fullmatch(r"video[ _]?(\d+)", key, re.IGNORECASE))
    )
    if not videos or len(videos) > MAX_VIDEOS:
        remedy = f"Give 1 to {MAX_VIDEOS} pulls in the layout of docs/fit-a-law.md."
        raise InputError(name, f"has {len(videos)} groups named video1, video2, ….", remedy)
    if len(videos) > 1 and videos[0][0] == 1:
        videos = videos[1:]
        notes.append("video1 conditions the sample and is left out.")
    return [key for _, key in videos]


@dataclass(frozen=True, eq=False)
class _Tracked:
    """Lengths in pixels between the marks, between the clamps and across, and the force in N."""

    along: Array
    clamps: Array
    across: Array
    force: Array


def _tracked(
    name: str, file: h5py.File, key: str, marks: Marks, notes: list[str]
) -> _Tracked | None:
    """The frames that are tracked, or None."""
    force = _numbers(name, file, f"{key}/forces").ravel()
    points = _numbers(name, file, f"{key}/traj")
    if points.ndim != 3 or points.shape[0] < 4 or points.shape[1] != 2:
        remedy = "It must be (7 points, 2 coordinates, frames), or (4, 2, frames)."
        raise InputError(f"{name}, {key}/traj", f"has the shape {points.shape}.", remedy)
    if points.shape[0] < 7:
        points = _seven(points, notes)
    frames = min(len(force), points.shape[2])
    if abs(len(force) - points.shape[2]) > max(5, 0.01 * frames):
        raise InputError(
            f"{name}, {key}",
            f"has {len(force)} forces but {points.shape[2]} tracked frames.",
            "The file is cut off or mixes two pulls; give forces and points of the same frames.",
        )
    force, points = force[:frames], points[:, :, :frames]
    used = points[[_RIGHT, _LEFT, *marks.points]]
    # A point that leaves the image sticks to its border.
    lost = ~np.all((used > 0) & (used < MAX_PIXEL), axis=(0, 1))
    unread = ~(np.abs(force) < MAX_FORCE_N)
    good = ~(lost | unread)
    good[good] = ~misread_forces(force[good])
    if good.sum() < max(MIN_POINTS, 0.5 * frames):
        notes.append(
            f"{key} is left out: {int(lost.sum())} of {frames} frames have an untracked point,"
            f" {int(unread.sum())} no force."
        )
        return None
    if (~good).any():
        notes.append(f"{key}: {int((~good).sum())} of {frames} frames are left out.")
    along, clamps, across = (
        np.hypot(*(points[first] - points[second]))[good]
        for first, second in (marks.points, Marks.CLAMPS.points, (_RIGHT, _LEFT))
    )
    if min(along[0], across[0]) <= 0:
        problem = "two points coincide in the first tracked frame."
        remedy = "Track the points from the unstretched sample on."
        raise InputError(f"{name}, {key}/traj", problem, remedy)
    return _Tracked(along, clamps, across, force[good])


def _seven(points: Array, notes: list[str]) -> Array:
    """Four points in the order of the seven: the outer ones along stand for the clamps."""
    note = (
        "Four points are tracked: the strain along is read between the lower and the upper one,"
        " as if they were at the clamps."
    )
    if note not in notes:
        notes.append(note)
    usual = np.nanmedian(points[:4], axis=2)
    left, right = int(np.argmin(usual[:, 0])), int(np.argmax(usual[:, 0]))
    first, second = (i for i in range(4) if i not in (left, right))
    middle = (points[first] + points[second]) / 2
    ends = [points[first], points[second]]
    return np.stack([points[right], points[left], *ends, middle, *ends])


def _numbers(name: str, file: h5py.File, key: str) -> Array:
    """A dataset of numbers stored in this very file, of bounded size."""
    import h5py

    if key not in file:
        raise InputError(f"{name}, {key}", "is missing.", "See docs/fit-a-law.md for the layout.")
    if not isinstance(file.get(key, getlink=True), h5py.HardLink):
        raise InputError(f"{name}, {key}", "is a link.", "Store the numbers in the file itself.")
    data = file[key]
    if not isinstance(data, h5py.Dataset) or data.dtype.kind not in "iuf" or data.external:
        raise InputError(f"{name}, {key}", "is not a dataset of numbers.", "Store plain numbers.")
    if data.size > 14 * MAX_FRAMES:
        raise InputError(
            f"{name}, {key}", f"holds {data.size} numbers.", f"Give at most {MAX_FRAMES} frames."
        )
    return np.asarray(data[()], dtype=float)


def _text(value: object) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)
