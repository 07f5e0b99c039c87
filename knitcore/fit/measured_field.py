"""Measured displacement fields (digital image correlation) of a strip test.

File layout (``.npz``): ``displacement`` (frames, 2, rows, columns) in pixels, component x then y,
sampled every 8 pixels on the *deformed* picture, rows downwards, (0, 0) or NaN outside the fabric;
``frame`` (frames,) the picture numbers. The picture with the least displacement gives the region
at rest. ``pitch_px`` may give another distance. A point of the fabric now at x was at X = x - u.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.result import Result

PITCH_PX = 8.0
STILL_PX = 0.5
"""A picture whose displacements stay below this is a rest state."""
EDGE_POINTS = 6
"""Samples used to extrapolate a column of the field to the edge of the region."""


@dataclass(frozen=True, eq=False)
class Frame:
    """One picture of the test, in material coordinates with y upwards.

    Attributes
    ----------
    number : of the picture.
    points : (n, 2) px, rest positions of the measured points from the region's centre; the pull is
        along axis 1.
    displacement : (n, 2) px.
    bottom, top : (columns, 3) px, along each clamped edge: rest x, u across, u along the pull.
    """

    number: int
    points: Array
    displacement: Array
    bottom: Array
    top: Array


@dataclass(frozen=True, eq=False, repr=False)
class MeasuredField(Result):
    """A measured strip test.

    Attributes
    ----------
    width, length : px, region at rest, across and along the pull.
    frames : in the order of the stretch.
    """

    width: float
    length: float
    frames: tuple[Frame, ...]

    def stretch(self, frame: Frame) -> float:
        """Applied stretch: relative motion of the two edges over the rest length."""
        return float((frame.top[:, 2].mean() - frame.bottom[:, 2].mean()) / self.length)

    def only(self, numbers: set[int]) -> MeasuredField:
        """Keep some of the test's pictures.

        Raises
        ------
        InputError
            If a number does not occur.
        """
        known = {frame.number for frame in self.frames}
        if not numbers or not numbers <= known:
            problem = f"the file has no stretched picture {_listed(numbers - known)}."
            remedy = f"Use {_listed(known)}; a picture without motion is the reference for these."
            raise InputError("frames", problem, remedy)
        kept = tuple(frame for frame in self.frames if frame.number in numbers)
        return MeasuredField(self.width, self.length, kept)

    def thinned(self, points: int) -> MeasuredField:
        """Keep at most this many points per frame, evenly chosen."""
        frames = []
        for frame in self.frames:
            step = slice(None, None, max(1, -(-len(frame.points) // points)))
            frames.append(
                replace(frame, points=frame.points[step], displacement=frame.displacement[step])
            )
        return MeasuredField(self.width, self.length, tuple(frames))


def _listed(numbers: set[int]) -> str:
    return ", ".join(str(number) for number in sorted(numbers)) or "at all"


@in_reading_time
def load_field(path: Path | str) -> MeasuredField:
    """Read a displacement field.

    Raises
    ------
    InputError
        If the file is not such a field or has no stretched picture.
    """
    try:
        with np.load(path) as archive:
            displacement = np.asarray(archive["displacement"], dtype=float)
            numbers = np.asarray(archive["frame"], dtype=int)
            pitch = float(archive["pitch_px"]) if "pitch_px" in archive else PITCH_PX
    except (OSError, EOFError, KeyError, ValueError, TypeError, BadZipFile, zlib.error) as error:
        problem = f"{Path(path).name} cannot be read as a displacement field."
        remedy = "Give an .npz with displacement (frames, 2, rows, columns) and frame (frames,)."
        raise InputError("field", problem, remedy) from error
    return measured_field(displacement, numbers, pitch)


def measured_field(
    displacement: Array, numbers: NDArray[np.int_], pitch_px: float = PITCH_PX
) -> MeasuredField:
    """A field from its arrays; see the module for their layout.

    Raises
    ------
    InputError
        If the shapes do not fit, no picture is stretched, or the region cannot be found.
    """
    if (
        displacement.ndim != 4
        or displacement.shape[1] != 2
        or numbers.shape != (len(displacement),)
    ):
        problem = f"displacement has shape {displacement.shape}, frame {numbers.shape}."
        raise InputError("field", problem, "Use (frames, 2, rows, columns) and (frames,).")
    if len(np.unique(numbers)) < len(numbers):
        raise InputError("field", "frame numbers repeat.", "Number each picture once.")
    if not (np.isfinite(pitch_px) and pitch_px > 0):
        raise InputError("field", f"pitch_px is {pitch_px}.", "Give a distance above 0 px.")
    lost = ~np.isfinite(displacement).all(axis=1, keepdims=True)  # some programs write NaN
    displacement = np.where(lost, 0.0, displacement)
    largest = np.abs(displacement).max(axis=(1, 2, 3))
    samples = [_samples(u, pitch_px) for u in displacement]
    box = _rest_region(samples, largest)
    vertical = _pulled_vertically(samples[int(np.argmax(largest))])
    frames = []
    for number, sample, motion in zip(numbers, samples, largest, strict=True):
        if motion > STILL_PX:
            frames.append(_frame(int(number), sample, box, vertical))
    if not frames:
        raise InputError("field", "no picture is stretched.", "Give at least one with motion.")
    (x0, x1), (y0, y1) = box
    width, length = (x1 - x0, y1 - y0) if vertical else (y1 - y0, x1 - x0)
    field = MeasuredField(width, length, tuple(frames))
    return MeasuredField(width, length, tuple(sorted(frames, key=field.stretch)))


@dataclass(frozen=True, eq=False)
class _Samples:
    """Positions now (n, 2), displacements (n, 2), y upwards, and grid places of a picture."""

    now: Array
    moved: Array
    row: NDArray[np.int64]
    column: NDArray[np.int64]

    @property
    def rest(self) -> Array:
        return self.now - self.moved


def _samples(u: Array, pitch: float) -> _Samples:
    inside = (u[0] != 0) | (u[1] != 0)
    row, column = np.nonzero(inside)
    now = np.column_stack([column * pitch, -row * pitch])
    moved = np.column_stack([u[0][inside], -u[1][inside]])
    return _Samples(now, moved, row, column)


def _rest_region(
    samples: list[_Samples], largest: Array
) -> tuple[tuple[float, float], tuple[float, float]]:
    """((x0, x1), (y0, y1)) of the region at rest, from a still picture or the least moved one."""
    least = samples[int(np.argmin(largest))]
    if len(least.now) < 100:
        moved = [s for s in samples if len(s.now) >= 100]
        if not moved:
            remedy = "Give a picture with at least 100 points inside the fabric."
            raise InputError("field", "has too few points.", remedy)
        least = moved[0]
    rest = least.rest
    low, high = rest.min(axis=0), rest.max(axis=0)
    return (float(low[0]), float(high[0])), (float(low[1]), float(high[1]))


def _pulled_vertically(sample: _Samples) -> bool:
    """Say whether the picture is stretched more along y than along x."""
    rest, moved = sample.rest, sample.moved
    slopes = [np.polyfit(rest[:, axis], moved[:, axis], 1)[0] for axis in (0, 1)]
    return bool(slopes[1] >= slopes[0])


def _frame(
    number: int,
    sample: _Samples,
    box: tuple[tuple[float, float], tuple[float, float]],
    vertical: bool,
) -> Frame:
    order = [0, 1] if vertical else [1, 0]
    limits = np.array(box)[order]
    middle = limits.mean(axis=1)
    points = sample.rest[:, order] - middle
    moved = sample.moved[:, order]
    line = sample.column if vertical else sample.row
    half = (limits[1, 1] - limits[1, 0]) / 2
    bottom = _edge(points, moved, line, -half)
    top = _edge(points, moved, line, half)
    return Frame(number, points, moved, bottom, top)


def _edge(points: Array, moved: Array, line: NDArray[np.int64], y: float) -> Array:
    """Displacements where each sampling line meets the edge at rest height y, (lines, 3)."""
    crossings = []
    for number in np.unique(line):
        on = np.flatnonzero(line == number)
        nearest = on[np.argsort(np.abs(points[on, 1] - y))[:EDGE_POINTS]]
        if len(nearest) < EDGE_POINTS:
            continue
        heights = points[nearest, 1] - y
        if np.abs(heights).max() > 2 * EDGE_POINTS * PITCH_PX:
            continue  # this line of the picture leaves the fabric before it meets the edge
        values = np.column_stack([points[nearest, 0], moved[nearest]])
        crossings.append(np.polyfit(heights, values, 1)[1])
    if len(crossings) < 4:
        remedy = "Sample the picture more densely, as far as both clamped edges."
        raise InputError("field", "an edge cannot be found.", remedy)
    edge = np.array(crossings)
    return np.asarray(edge[np.argsort(edge[:, 0])])
