"""The shape in which a piece of knitting lies: curled, folded, pleated."""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base import showing
from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, InputError
from knitcore.chart.fabric import Direction
from knitcore.chart.in_space import ClothInSpace
from knitcore.chart.phases import continued
from knitcore.chart.stitch_chart import StitchChart, as_chart, check_stitches
from knitcore.cloth.space.folds import balances
from knitcore.cloth.space.rolled import start
from knitcore.cloth.space.sheet_shape import settle, shake_mm
from knitcore.cloth.space.stitch_sheet import StitchSheet, sheet_of
from knitcore.materials import Material, as_material
from knitcore.prediction.size import RelaxedSize

MAX_STITCHES = 10_000
"""Largest number of stitches of a piece."""
TIME_LIMIT_S = 120.0
_BETWEEN = 3
"""Number of stitches that a pull needs: two in the clamps, one between."""
_STRIPS = 0.3
"""Share of the time limit for each of the two starting strips."""
STRIP = 4.0
"""Width of the edge strip whose curl is reported, in thicknesses."""
PULLED_NOTE = (
    "Pulled between clamps: this is how far the free edges curl against the pull. The cloth is as "
    "stiff here as at small strains, so take forces from the stretch test, not from this shape."
)
UNBALANCED_NOTE = (
    "Its knits and purls do not balance, so the whole piece rolls up; `bend` shows the same for "
    "the repeat. Laid flat it has the size that `predict` gives."
)
NOTE = (
    "Without friction, weight and what washing or pressing sets, edges roll and folds close "
    "as far as they can; real fabric does so only in part. Rely on the direction of curls and "
    "folds, and on which fabrics lie flat, rather than on the millimetres."
)


@dataclass(frozen=True, eq=False, repr=False)
class CurledPiece(ClothInSpace):
    """A piece at rest, on average aligned with the flat one: x along the rows, z towards the face.

    Parameters
    ----------
    chart : the piece, continued where it has no stitch.
    corners_mm : (rows + 1, columns + 1, 3), corners of the stitches, the lowest row first.
    flat_mm : (rows + 1, columns + 1, 3), the same in the flat sheet.
    thickness_mm : of the fabric.
    width_mm, height_mm, depth_mm : extent of the corners.
    curl_course_mm : how far the sides stand out, positive towards the face (the front): greatest
        height of the outer strip, four thicknesses wide, over the plane of the fabric at its inner
        end, mean over the middle rows.
    curl_wale_mm : the same of top and bottom.
    energy_n_mm : of the piece.
    converged : whether every corner is in equilibrium; where it is not, the shape is a preview.
    residual : largest force on a corner, over the force that turns two stitches by a radian.
    seconds : CPU time.
    stitches : (rows, columns), False where the piece has none; None if it has all. Corners without
        a stitch mean nothing, and `curl_course_mm` and `curl_wale_mm` are NaN for such a piece.
    """

    chart: StitchChart
    corners_mm: Array
    flat_mm: Array
    thickness_mm: float
    width_mm: float
    height_mm: float
    depth_mm: float
    curl_course_mm: float
    curl_wale_mm: float
    energy_n_mm: float
    converged: bool
    residual: float
    seconds: float
    stitches: NDArray[np.bool_] | None = None
    notes: tuple[str, ...] = (NOTE,)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Collect the shape as arrays.

        ``corners_mm`` and ``flat_mm``, (rows + 1, columns + 1, 3), are NaN where there is no
        stitch; ``purl`` and ``stitch`` are (rows, columns).
        """
        flat = np.where(self.used[..., None], self.flat_mm, np.nan)
        return super().arrays() | {"flat_mm": flat, "purl": self.chart.purl}

    def _repr_html_(self) -> str:
        step = max(1, max(self.corners_mm.shape[:2]) // 30)
        rows, columns = self.corners_mm[::step], self.corners_mm.transpose(1, 0, 2)[::step]
        net = [*rows, *columns, self.corners_mm[-1], self.corners_mm[:, -1]]
        picture = showing.in_space(net, "The piece as it lies", thickness=0.6, tilt=1.0)
        size = f"{self.width_mm:.0f} × {self.height_mm:.0f} × {self.depth_mm:.0f} mm at rest"
        ends = f"sides {self.curl_course_mm:+.1f} mm, top and bottom {self.curl_wale_mm:+.1f} mm"
        return showing.captioned(picture, f"{size}; towards the face: {ends}", *self.notes)


@dataclass(frozen=True)
class Pull:
    """Two clamps that hold the outermost rows (wale) or columns (course) and move apart.

    Attributes
    ----------
    direction : of the pull.
    strain : from clamp to clamp.
    """

    direction: Direction
    strain: float


def curl(
    chart: StitchChart | str,
    material: Material | str,
    *,
    stitches: NDArray[np.bool_] | None = None,
    size: RelaxedSize | None = None,
    pull: Pull | None = None,
    begin: Array | None = None,
    time_limit_s: float = TIME_LIMIT_S,
    cancelled: Cancelled | None = None,
) -> CurledPiece:
    """The shape at rest of a piece whose edges are free, or free beside two clamps.

    Parameters
    ----------
    chart : the whole piece, from the face side.
    stitches : (rows, columns) False where the piece has none: around it, or in a hole. The chart
        says nothing there.
    size : relaxed size of the mean stitch, if known.
    pull : by clamps, if any.
    begin : (rows + 1, columns + 1, 3) corners, mm, to descend from, such as those of the piece
        before a stitch was changed: the first steps come soon. By default the flat or a bent
        piece, so that the result depends on nothing else.
    time_limit_s : CPU time after which the current shape is returned, not converged.
    cancelled : called before every step; True stops with CancelledError.

    Raises
    ------
    InputError
        If the piece is too large, has no stitch or is in several parts, ``begin`` has another size,
        or the material lacks data for the yarn level.
    ConvergenceError
        If a fabric of the material does not relax at the yarn level.
    CancelledError
        If ``cancelled`` returned True.
    """
    chart, material = as_chart(chart), as_material(material)
    check_piece(chart, stitches)
    if pull is not None and min(chart.rows, chart.columns) < _BETWEEN:
        remedy = f"Give at least {_BETWEEN} rows and {_BETWEEN} columns."
        raise InputError("chart", "is too small for clamps.", remedy)
    shape = (chart.rows + 1, chart.columns + 1, 3)
    if begin is not None and begin.shape != shape:
        remedy = f"Give the corners of a piece of {chart.columns} x {chart.rows} stitches."
        raise InputError("begin", "has another size than the chart.", remedy)
    if stitches is not None:
        chart = continued(chart, stitches)
    sheet = sheet_of(chart, material, stitches, size)
    clock = time.process_time()
    before = None if begin is None else begin.reshape(-1, 3).astype(float)
    held = None
    if pull is not None:
        x, held = _pulled(sheet, pull)
        sheet = sheet.clamped(held)
        if before is not None:
            x = np.where(held[:, None], x, before)
    elif before is not None:
        x = before
    else:
        x = start(sheet, time_limit_s=_STRIPS * time_limit_s, cancelled=cancelled)
    if stitches is not None:
        sheet = sheet.cut(stitches)
    left = time_limit_s - (time.process_time() - clock)
    near = begin is not None
    rest = settle(sheet, x, held=held, near=near, time_limit_s=left, cancelled=cancelled)
    placed = rest.x if pull else aligned(rest.x, sheet)
    corners = placed.reshape(shape)
    strip = STRIP * sheet.thickness_mm
    width, height, depth = np.ptp(placed[sheet.used], axis=0)
    whole = stitches is None or bool(stitches.all())
    return CurledPiece(
        chart=chart,
        corners_mm=corners,
        flat_mm=sheet.flat_mm.reshape(shape),
        thickness_mm=sheet.thickness_mm,
        width_mm=float(width),
        height_mm=float(height),
        depth_mm=float(depth),
        curl_course_mm=standing_out_mm(corners, strip) if whole else np.nan,
        # columns for rows turns the face to the other side
        curl_wale_mm=-standing_out_mm(corners.transpose(1, 0, 2), strip) if whole else np.nan,
        energy_n_mm=rest.energy_n_mm,
        converged=rest.converged,
        residual=rest.residual,
        seconds=time.process_time() - clock,
        stitches=stitches,
        notes=(
            *(() if pull is None else (PULLED_NOTE,)),
            *(() if balances(chart, stitches) else (UNBALANCED_NOTE,)),
            NOTE,
        ),
    )


def _pulled(sheet: StitchSheet, pull: Pull) -> tuple[Array, NDArray[np.bool_]]:
    """The flat sheet stretched evenly between clamps, and a mask (corners,) of what they hold."""
    axis = pull.direction.axis
    grid = np.arange(len(sheet.flat_mm)).reshape(sheet.rows + 1, sheet.columns + 1)
    lines = grid if axis == 1 else grid.T
    at = sheet.flat_mm[lines, axis].mean(axis=1)
    middle = 0.5 * (at[1:] + at[:-1])
    longer = pull.strain * (middle[-1] - middle[0])
    x = sheet.flat_mm.copy()
    x[:, axis] += longer * np.clip((sheet.flat_mm[:, axis] - at[1]) / (at[-2] - at[1]), 0.0, 1.0)
    held = np.zeros(len(x), dtype=bool)
    held[lines[[0, 1, -2, -1]]] = True
    x[~held] += shake_mm(x[~held].shape)
    return x, held


def check_piece(chart: StitchChart, stitches: NDArray[np.bool_] | None = None) -> None:
    """Refuse a piece that is too large, has no stitch or is in several parts.

    Raises
    ------
    InputError
    """
    check_stitches(chart.stitches, MAX_STITCHES)
    if stitches is None:
        return
    if stitches.shape != chart.purl.shape or not stitches.any():
        remedy = "Give True or False for every stitch of the chart, True for at least one."
        raise InputError("outline", "does not fit the chart.", remedy)
    parts, count = scipy.ndimage.label(stitches, structure=np.ones((3, 3)))
    if count > 1:
        sizes = np.bincount(parts.ravel())[1:]
        row, column = np.argwhere(parts == sizes.argmin() + 1)[0]
        raise InputError(
            "outline",
            f"is in {count} parts that nothing holds together; the smallest begins at stitch "
            f"{column + 1} of row {row + 1}.",
            "Join them by a stitch, or make them charts of their own.",
        )


def aligned(x: Array, sheet: StitchSheet) -> Array:
    """Turn and move a shape to where it is nearest to the flat sheet (Kabsch 1976)."""
    middle = x - x[sheet.used].mean(axis=0)
    left, _, right = np.linalg.svd(middle[sheet.used].T @ sheet.flat_mm[sheet.used])
    proper = np.diag([1.0, 1.0, np.linalg.det(left @ right)])
    return np.asarray(middle @ left @ proper @ right)


def standing_out_mm(corners: Array, strip_mm: float) -> float:
    """Mean over the rows of the greatest height of an edge strip over the plane at its inner end.

    Parameters
    ----------
    corners : (rows, columns, 3), mm; positive heights are along columns × rows.
    strip_mm : width of the strip at either side.
    """
    rows, columns = corners.shape[:2]
    if min(rows, columns - 1) < 2:
        return 0.0
    stitch = float(np.linalg.norm(np.diff(corners, axis=1), axis=2).mean())
    wide = int(np.clip(round(strip_mm / stitch), 1, (columns - 1) // 2))
    inner = slice(rows // 4, rows - rows // 4)
    heights = []
    for side, sign in ((corners, 1.0), (corners[:, ::-1], -1.0)):
        at = side[:, wide]
        normal = sign * np.cross(side[:, wide + 1] - at, np.gradient(at, axis=0))
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        height = np.einsum("ijm,im->ij", side[:, :wide] - at[:, None], normal)[inner]
        heights.append(height[np.arange(len(height)), np.abs(height).argmax(axis=1)].mean())
    return float(np.mean(heights))
