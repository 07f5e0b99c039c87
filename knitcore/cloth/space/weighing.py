"""Tests of a fabric by its own weight: strips over an edge, round pieces on a disc, borders.

**Overhang.** Peirce, "The handle of cloth as a measurable quantity", J. Text. Inst. 21 (1930)
T377: where the line from the edge of a table to the tip of a strip falls by θ, the bending length
is L (cos(θ/2) / (8 tan θ))^(1/3), half the overhang at θ = 41.5°.

**Drape.** Cusick, "The dependence of fabric drape on bending and shear stiffness", J. Text. Inst.
56 (1965) T596: the share of the ring outside a disc that the shadow of a round piece covers, 1 for
a stiff board.

**Borders** keep a curling piece flat on a table. Held flat, a piece turns the line beside its
border with its moment m₀ per width. To tip a border of width b and weight w per area about that
line takes w b²/2, so one narrower than √(2 m₀/w) is tipped over. A wider one does not always hold:
cloth that bends easily rises beside the line in a ridge instead. Turning it by θ costs a heavy beam
of rigidity D only (w D²)^(1/3) θ^(5/3) and gains m₀ θ, so where D is small the ridge becomes a
scroll. A strip of piece and borders on a smooth table shows which of the two happens.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_range
from knitcore.base.errors import Cancelled, InputError
from knitcore.chart.in_space import ClothInSpace
from knitcore.chart.result import Result
from knitcore.cloth.space.even_cloth import EvenCloth
from knitcore.cloth.space.sheet_shape import Shape, settle, shake_mm
from knitcore.cloth.space.stitch_sheet import StitchSheet

WIDTH_MM = 25.0
"""Width of a strip over an edge."""
MIN_BENDING_LENGTHS, MAX_BENDING_LENGTHS = 0.1, 5.0
"""Shortest and longest overhang, in bending lengths: a shorter strip hardly falls, a longer one
hangs straight down."""
_ALONG, _CLAMPED, _ACROSS = 40, 2, 2
"""Rectangles along the overhang, along the part in the clamp, and across the strip."""

PIECE_MM, DISC_MM = 300.0, 180.0
"""Diameters of the standard drape test."""
ACROSS = 60
"""Rectangles across the round piece."""
MAX_ACROSS = 80
STARTS = (5, 6, 7)
"""Waves of the rim with which the descents begin: draped cloth has several states of rest."""
_WAVE = 0.2
"""Height of these waves over the distance from the disc."""
_SHAKEN_MM = 0.01

RULE_STITCHES, RULE_ROWS = (3, 5), 4
"""Knitters' rule for the width of a border at the sides, and at top and bottom."""
SAFETY = 1.2
"""Width of the border tested on the table, over the width that just does not tip."""
INNER_MM = 100.0
"""Width of the piece between the tested borders."""
MAX_WIDTH_MM = 500.0
_RECTANGLE_MM = 2.5


@dataclass(frozen=True, eq=False, repr=False)
class Overhang(ClothInSpace):
    """A strip at rest; x along it from the edge of the table, z up.

    Parameters
    ----------
    overhang_mm : length beyond the edge.
    angle_rad : of the line from the edge to the tip, below the horizontal.
    reach_mm, fall_mm : how far out and how far down the tip is.
    bending_length_mm : by Peirce's formula from overhang and angle.
    rigidity_n_mm : weight per area times the cube of the bending length.
    corners_mm : (lines along, lines across, 3) of the rectangles.
    rectangle_mm : their size, along and across.
    converged : whether the strip is in equilibrium.
    """

    overhang_mm: float
    angle_rad: float
    reach_mm: float
    fall_mm: float
    bending_length_mm: float
    rigidity_n_mm: float
    corners_mm: Array
    rectangle_mm: tuple[float, float]
    converged: bool


def overhang(
    cloth: EvenCloth,
    axis: int,
    overhang_mm: float | None = None,
    *,
    cancelled: Cancelled | None = None,
) -> Overhang:
    """A strip 25 mm wide, clamped flat on a table up to its edge.

    Parameters
    ----------
    cloth : taken as flat at rest: the test is not meant for strips that roll up.
    axis : 0 for a strip along the rows, 1 for one along the columns.
    overhang_mm : by default the length at which the strip falls by 41.5°.

    Raises
    ------
    InputError
        If the overhang is shorter than a tenth of the bending length or longer than five.
    CancelledError
        If ``cancelled`` returned True.
    """
    expected = cloth.bending_length_mm(axis)
    length = 2.0 * expected if overhang_mm is None else overhang_mm
    shortest, longest = MIN_BENDING_LENGTHS * expected, MAX_BENDING_LENGTHS * expected
    if not shortest <= length <= longest:
        falls = "do not bend" if length < shortest else "hang straight down"
        raise InputError(
            "overhang_mm",
            f"{length:g} mm {falls}: the bending length is {expected:.0f} mm.",
            f"Give {shortest:.1f} to {longest:.0f} mm.",
        )
    strip = cloth.turned() if axis else cloth
    size = length / _ALONG, WIDTH_MM / _ACROSS
    columns = _ALONG + _CLAMPED
    sheet = strip.flat().sheet(_ACROSS, columns, size)
    held = np.tile(np.arange(columns + 1) <= _CLAMPED, _ACROSS + 1)
    load = sheet.load_n(cloth.weight_n_per_mm2 * size[0] * size[1])
    shape = settle(sheet.clamped(held), sheet.flat_mm, held=held, load_n=load, cancelled=cancelled)
    corners = shape.x.reshape(_ACROSS + 1, columns + 1, 3)
    corners = corners - corners[_ACROSS // 2, _CLAMPED]
    reach, _, height = corners[:, -1].mean(axis=0)
    angle = math.atan2(-height, reach)
    peirce = length * math.cbrt(math.cos(0.5 * angle) / (8.0 * math.tan(angle)))
    return Overhang(
        overhang_mm=length,
        angle_rad=angle,
        reach_mm=float(reach),
        fall_mm=float(-height),
        bending_length_mm=peirce,
        rigidity_n_mm=cloth.weight_n_per_mm2 * peirce**3,
        corners_mm=corners.transpose(1, 0, 2),
        rectangle_mm=size,
        converged=shape.converged,
    )


@dataclass(frozen=True, eq=False, repr=False)
class Drape(ClothInSpace):
    """A draped piece: the state of least energy of those found; z up.

    Parameters
    ----------
    coefficient : shadow of the ring over its area.
    coefficients : of all states of rest, one for each start.
    folds : number of folds around the rim.
    fall_mm : from the disc to the lowest point.
    corners_mm : (lines up, lines across, 3) of the rectangles; NaN outside the piece.
    converged : whether all descents came to rest.
    """

    coefficient: float
    coefficients: tuple[float, ...]
    folds: int
    fall_mm: float
    corners_mm: Array
    converged: bool


def drape(
    cloth: EvenCloth,
    *,
    piece_mm: float = PIECE_MM,
    disc_mm: float = DISC_MM,
    across: int = ACROSS,
    starts: tuple[int, ...] = STARTS,
    time_limit_s: float = 120.0,
    cancelled: Cancelled | None = None,
) -> Drape:
    """A round piece held between two discs, its rim free.

    Parameters
    ----------
    cloth : taken as flat at rest.
    piece_mm, disc_mm : diameters.
    across : rectangles across the piece.
    starts : numbers of waves of the rim with which the descents begin.
    time_limit_s : CPU time of all descents.

    Raises
    ------
    InputError
        If the piece is not larger than the disc, or the rectangles are too many or too few.
    CancelledError
        If ``cancelled`` returned True.
    """
    if not 0.0 < disc_mm < 0.95 * piece_mm:
        raise InputError(
            "disc_mm",
            f"{disc_mm:g} mm is no disc inside the piece.",
            "Give above 0 and below 0.95 piece_mm.",
        )
    check_range("across", across, 10, MAX_ACROSS)
    sheet, held = _round(cloth, piece_mm, disc_mm, across)
    load = sheet.load_n(cloth.weight_n_per_mm2 * _area(sheet))
    shapes = [
        settle(
            sheet.clamped(held), _waved(sheet, held, waves), held=held, load_n=load,
            time_limit_s=time_limit_s / len(starts), cancelled=cancelled,
        )
        for waves in starts
    ]  # fmt: skip
    covered = [_coefficient(sheet, shape.x, disc_mm) for shape in shapes]
    best = int(np.argmin([shape.energy_n_mm for shape in shapes]))
    corners = np.where(sheet.used[:, None], shapes[best].x, np.nan)
    return Drape(
        coefficient=covered[best],
        coefficients=tuple(covered),
        folds=_folds(sheet, shapes[best], 0.5 * (piece_mm - disc_mm)),
        fall_mm=float(-shapes[best].x[:, 2].min()),
        corners_mm=corners.reshape(across + 1, across + 1, 3),
        converged=all(shape.converged for shape in shapes),
    )


def _round(
    cloth: EvenCloth, piece_mm: float, disc_mm: float, across: int
) -> tuple[StitchSheet, NDArray[np.bool_]]:
    """The round piece, and a mask of its corners in the clamp."""
    size = piece_mm / across
    whole = cloth.flat().sheet(across, across, (size, size))
    middle = whole.flat_mm[whole.quads].mean(axis=1)
    inside = np.linalg.norm(middle, axis=1) <= 0.5 * piece_mm
    sheet = whole.cut(inside.reshape(across, across))
    radius = np.linalg.norm(sheet.flat_mm, axis=1)
    reach = np.sort(radius[sheet.quads].max(axis=1))
    clamped = round(0.25 * math.pi * disc_mm**2 / size**2)  # rectangles as large as the disc
    return sheet, radius <= reach[clamped - 1]


def _waved(sheet: StitchSheet, held: NDArray[np.bool_], waves: int) -> Array:
    x = sheet.flat_mm.copy()
    out = np.linalg.norm(x, axis=1) - np.linalg.norm(x[held], axis=1).max()
    wave = _WAVE * out * np.cos(waves * np.arctan2(x[:, 1], x[:, 0]))
    noise = shake_mm((len(x),), _SHAKEN_MM)
    x[~held, 2] += (wave + noise)[~held]
    return x


def _area(sheet: StitchSheet) -> float:
    return float(sheet.membrane[0, :2].prod())


def _coefficient(sheet: StitchSheet, x: Array, disc_mm: float) -> float:
    disc = 0.25 * math.pi * disc_mm**2
    ring = len(sheet.quads) * _area(sheet) - disc
    triangles = np.concatenate(
        [x[sheet.quads[:, half], :2] for half in ([0, 1, 3, 0], [0, 3, 2, 0])]
    )
    shapes = shapely.polygons(triangles)
    solid = shapes[shapely.area(shapes) > 1e-9]
    shadow = float(shapely.union_all(solid, grid_size=1e-4).area)
    return (shadow - disc) / ring


def _folds(sheet: StitchSheet, shape: Shape, ring_mm: float) -> int:
    """Crests around the rim, at least a tenth as high as the ring is wide."""
    from scipy.signal import find_peaks  # slow to import

    rim = np.linalg.norm(sheet.flat_mm, axis=1) >= 0.92 * sheet.flat_mm[:, 0].max()
    rim &= sheet.used
    angle = np.arctan2(sheet.flat_mm[rim, 1], sheet.flat_mm[rim, 0])
    grid = np.linspace(-np.pi, np.pi, 144, endpoint=False)
    order = np.argsort(angle)
    height = np.interp(grid, angle[order], shape.x[rim, 2][order], period=2.0 * np.pi)
    smooth = np.convolve(np.tile(height, 3), np.full(5, 0.2), mode="same")
    crests, _ = find_peaks(smooth, prominence=0.1 * ring_mm)
    return int(np.count_nonzero((crests >= 144) & (crests < 288)))


@dataclass(frozen=True, eq=False, repr=False)
class BorderAdvice(Result):
    """A border along one pair of edges.

    Parameters
    ----------
    moment_n : per width, with which the piece curls there; 0 if it does not.
    width_mm : of the border that its weight just keeps from being tipped over; 0 for none.
    stitches : the same in stitches, or rows, of the border.
    rule_share : share of the moment that the weight of a border of the usual width holds: five
        stitches at the sides, four rows at top and bottom.
    holds : whether a border of 1.2 times this width keeps a smooth strip from rolling up.
    ridge_mm : how high this strip rises beside its borders.
    line_mm : (n, 2) the strip in cross-section, along the table and up.
    """

    moment_n: float
    width_mm: float
    stitches: int
    rule_share: float
    holds: bool
    ridge_mm: float
    line_mm: Array


def advice(
    inner: EvenCloth,
    border: EvenCloth,
    axis: int,
    *,
    time_limit_s: float = 20.0,
    cancelled: Cancelled | None = None,
) -> BorderAdvice:
    """Advise how wide a border must be to keep a curling piece flat by its weight.

    Parameters
    ----------
    inner, border : the piece and its border.
    axis : 0 for the sides, 1 for top and bottom.
    time_limit_s : CPU time on the table; a strip not at rest by then does not hold.

    Raises
    ------
    CancelledError
        If ``cancelled`` returned True.
    """
    moment, weight = inner.moment_n[axis], border.weight_n_per_mm2
    size = border.stitch_mm[axis]
    width = math.sqrt(2.0 * moment / weight)
    ruled = size * (RULE_ROWS if axis else max(RULE_STITCHES))
    if moment == 0.0:
        return BorderAdvice(0.0, 0.0, 0, 1.0, True, 0.0, np.zeros((0, 2)))
    sheet, shape = on_table(
        inner, border, axis, min(SAFETY * width, MAX_WIDTH_MM), time_limit_s=time_limit_s,
        cancelled=cancelled,
    )  # fmt: skip
    line = shape.x.reshape(2, sheet.columns + 1, 3).mean(axis=0)[:, ::2]
    return BorderAdvice(
        moment_n=moment,
        width_mm=width,
        stitches=math.ceil(width / size),
        rule_share=min(0.5 * weight * ruled**2 / moment, 1.0),
        holds=bool(shape.converged and (np.diff(line[:, 0]) > 0.0).all()),
        ridge_mm=float(np.ptp(line[:, 1])),
        line_mm=line,
    )


def on_table(
    inner: EvenCloth,
    border: EvenCloth,
    axis: int,
    border_mm: float,
    *,
    time_limit_s: float = 20.0,
    cancelled: Cancelled | None = None,
) -> tuple[StitchSheet, Shape]:
    """A strip across the piece with a border at both ends, from the flat state to rest.

    It lies on a smooth table with the side up to which it curls.
    """
    piece, edge = (cloth.turned() if axis else cloth for cloth in (inner, border))
    piece = replace(piece, curvature_per_mm=(-abs(piece.curvature_per_mm[0]), 0.0))
    edge = replace(edge.flat(), thickness_mm=piece.thickness_mm)
    wide = round(border_mm / _RECTANGLE_MM)
    of_border = np.repeat([1.0, 0.0, 1.0], [wide, round(INNER_MM / _RECTANGLE_MM), wide])
    size = _RECTANGLE_MM, _RECTANGLE_MM
    own, other = (cloth.sheet(1, len(of_border), size) for cloth in (piece, edge))
    share = 0.5 * (of_border[1:] + of_border[:-1])[:, None]
    sheet = replace(
        own,
        turning=(1.0 - share) * own.turning + share * other.turning,
        membrane=np.where(of_border.repeat(4)[:, None] > 0.0, other.membrane, own.membrane),
    )
    weight = np.where(of_border > 0.0, edge.weight_n_per_mm2, piece.weight_n_per_mm2)
    load = sheet.load_n(weight * _RECTANGLE_MM**2)
    held = np.zeros((2, len(of_border) + 1, 3), dtype=bool)
    held[..., 1] = True  # a strip would roll up into a helix
    held[:, len(of_border) // 2, 0] = True
    return sheet, settle(
        sheet, sheet.flat_mm, held=held.reshape(-1, 3), load_n=load, floor_mm=0.0,
        time_limit_s=time_limit_s, cancelled=cancelled,
    )  # fmt: skip
