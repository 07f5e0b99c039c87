"""Difference between a law and a measured displacement field."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.cloth.flat.equilibrium_path import Path, run_path
from knitcore.cloth.flat.grid import QuarterGrid
from knitcore.cloth.flat.grid_sheet import Sheet
from knitcore.cloth.flat.sheet_models import SheetModel
from knitcore.cloth.flat.strip import Clamps, clamp_edges, clamp_mask
from knitcore.fit.measured_field import Frame, MeasuredField
from knitcore.law.constitutive import ConstitutiveLaw

CELLS_ACROSS = 96
MAX_STEP = 0.05
"""Largest increase of the stretch in one load step."""


class Edges(StrEnum):
    """Motion imposed at the clamped edges: the measured one, or its mean (rigid clamps)."""

    MEASURED = "measured"
    RIGID = "rigid"


@dataclass(frozen=True)
class FrameError:
    """Differences of one picture, in percent of the region's rest width.

    u_x is along the courses, u_y along the wales.
    """

    frame: int
    applied_stretch: float
    ux_rms_percent_width: float
    ux_max_percent_width: float
    uy_rms_percent_width: float
    uy_max_percent_width: float


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Result):
    """Differences of all frames that could be computed, and the reason if some could not."""

    frames: tuple[FrameError, ...]
    problem: str | None


def compare(
    field: MeasuredField,
    law: ConstitutiveLaw,
    direction: Direction,
    *,
    edges: Edges = Edges.RIGID,
    model: SheetModel | None = None,
) -> Comparison:
    """Compute every picture of a field with a law and compare the displacements.

    Parameters
    ----------
    field : the measurement.
    law : law of the homogeneous fabric.
    direction : in which it was pulled.
    edges : motion of the clamped edges.
    model : energy model (``full`` by default).
    """
    sheet = field_sheet(field, law, direction, model or SheetModel())
    differences, problem = field_differences(field, sheet, direction, edges)
    axis = direction.axis
    errors = []
    for frame, difference in zip(field.frames, differences, strict=False):
        pulled, across = difference[:, 1], difference[:, 0]
        ux, uy = (pulled, across) if axis == 0 else (across, pulled)
        percent = 100 / field.width
        errors.append(
            FrameError(
                frame.number,
                field.stretch(frame),
                float(np.sqrt(np.mean(ux**2)) * percent),
                float(np.abs(ux).max() * percent),
                float(np.sqrt(np.mean(uy**2)) * percent),
                float(np.abs(uy).max() * percent),
            )
        )
    return Comparison(tuple(errors), problem)


def field_sheet(
    field: MeasuredField,
    law: ConstitutiveLaw,
    direction: Direction,
    model: SheetModel,
    cells_across: int = CELLS_ACROSS,
) -> Sheet:
    """The measured region as a sheet of one law; lengths in px (the law has no length scale)."""
    cells = cells_across, max(2, round(cells_across * field.length / field.width))
    return even_sheet(law, direction, cells, (field.width, field.length), model)


def even_sheet(
    law: ConstitutiveLaw,
    direction: Direction,
    cells: tuple[int, int],
    size: tuple[float, float],
    model: SheetModel,
) -> Sheet:
    """A rectangle of one law; ``cells`` and ``size`` are across the pull and along it."""
    columns, rows = direction.of(cells[::-1], cells)
    width, height = direction.of(size[::-1], size)
    return Sheet(QuarterGrid.uniform(columns, rows, width, height), [law], model)


def field_differences(
    field: MeasuredField, sheet: Sheet, direction: Direction, edges: Edges
) -> tuple[list[Array], str | None]:
    """Simulated minus measured displacement at the measured points, per picture (across, along)."""
    path, last_steps = follow_field(field, sheet, direction, edges)
    grid, axis = sheet.grid, direction.axis
    shape = (grid.rows + 1, grid.columns + 1, 2)
    differences = []
    for frame, step in zip(field.frames, last_steps, strict=True):
        if step >= len(path.equilibria):
            break
        moved = (path.equilibria[step].state.corners - grid.corners).reshape(shape)
        at = _in_grid(grid, frame.points if axis == 1 else frame.points[:, ::-1])
        value = scipy.interpolate.RegularGridInterpolator(
            (grid.row_lines, grid.column_lines), moved
        )(at[:, ::-1])
        simulated = value if axis == 1 else value[:, ::-1]
        differences.append(simulated - frame.displacement)
    return differences, path.problem


def follow_field(
    field: MeasuredField, sheet: Sheet, direction: Direction, edges: Edges
) -> tuple[Path, list[int]]:
    """Solve along the pictures; the index of each picture's load step."""
    grid = sheet.grid
    targets: list[Array] = []
    last_steps: list[int] = []
    previous, stretch = grid.corners, 0.0
    for frame in field.frames:
        goal = _prescribed(frame, grid, direction, edges)
        count = max(1, int(np.ceil((field.stretch(frame) - stretch) / MAX_STEP - 1e-9)))
        targets += [previous + (goal - previous) * k / count for k in range(1, count + 1)]
        last_steps.append(len(targets) - 1)
        previous, stretch = goal, field.stretch(frame)
    return run_path(sheet, clamp_mask(grid, direction, Clamps.CLAMPED), targets), last_steps


def _prescribed(frame: Frame, grid: QuarterGrid, direction: Direction, edges: Edges) -> Array:
    """Corner positions with both clamped edges moved."""
    corners = grid.corners.copy()
    axis, across = direction.axis, direction.other.axis
    for name, edge in zip(clamp_edges(direction), (frame.bottom, frame.top), strict=True):
        nodes = grid.edge(name)
        if edges is Edges.RIGID:
            corners[nodes, across] += edge[:, 1].mean()
            corners[nodes, axis] += edge[:, 2].mean()
        else:
            where = grid.corners[nodes, across]
            corners[nodes, across] += _along(edge[:, 0], edge[:, 1], where)
            corners[nodes, axis] += _along(edge[:, 0], edge[:, 2], where)
    return corners


def _along(x: Array, values: Array, where: Array) -> Array:
    """Values along an edge, extrapolated beyond its ends with the slope of the outer tenth."""
    out = np.interp(where, x, values)
    tenth = max(len(x) // 10, 2)
    for end, outside in ((slice(None, tenth), where < x[0]), (slice(-tenth, None), where > x[-1])):
        if np.any(outside):
            slope, _ = np.polyfit(x[end], values[end], 1)
            anchor = 0 if end.start is None else -1
            out[outside] = values[anchor] + slope * (where[outside] - x[anchor])
    return np.asarray(out)


def _in_grid(grid: QuarterGrid, points: Array) -> Array:
    """Points moved onto the region where noise put them outside."""
    low = np.array([grid.column_lines[0], grid.row_lines[0]])
    return np.clip(points, low, -low)
