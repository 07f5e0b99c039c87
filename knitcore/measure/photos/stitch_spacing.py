"""Width and height of a stitch in a straightened photo, by the periodicity of the texture.

The autocorrelation of the fabric, with the light evened out and the window divided out, has a peak
at each shift that lays stitches on stitches. The first peaks along rows and columns are sought near
where the gauge expects them; then the lattice is fitted to the peaks farther and farther out, each
located by a parabola, so that many stitches share the error of a pixel.
"""

import math
from dataclasses import dataclass

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Fabric

MIN_PERIODS = 5.0
"""Fewest repeats of the texture across the fabric in each direction."""
MIN_PERIOD_PX = 7.0
"""Smallest repeat that a photo resolves."""
MIN_PERIODICITY = 0.2
"""Least correlation of the fabric with itself, shifted by a stitch."""
MAX_ROTATION_DEG = 6.0
"""Largest angle of rows and columns against the photo's sides."""
MAX_ERROR = 0.01
"""Largest standard deviation of a spacing over the spacing."""
_HIGHER = 1.4
"""Height of the peak at two repeats over that at one, from which on one is half of a repeat."""
_AS_HIGH = 0.85
"""Height of a peak over the highest from which on it is the first of a series."""
_REACH = 0.42
"""Farthest shift that is used, over the size of the fabric."""
_SCATTER = 0.0015
"""Relative error that remains: of pixels, and of what the window cuts off."""
_UNEVEN = 0.3
"""Relative error times the stitches in a row, over 1 / correlation - 1: a few uneven stitches are
not as wide as the swatch's mean (from rendered swatches of scattered stitches)."""


@dataclass(frozen=True)
class StitchSpacing:
    """Size of a stitch in the plane of a photo, with standard deviations.

    Attributes
    ----------
    course_mm, wale_mm : width of a stitch along its row, and height along its column.
    course_sd_mm, wale_sd_mm : of these.
    periodicity : correlation of the fabric with itself, shifted by a repeat; the smaller of two.
    """

    course_mm: float
    wale_mm: float
    course_sd_mm: float
    wale_sd_mm: float
    periodicity: float


def repeat_of(fabric: Fabric) -> tuple[int, int]:
    """Stitches after which the texture of a fabric comes again, along a row and along a column."""
    return 1 + fabric.course_odd, 1 + fabric.wale_odd


def stitch_spacing(
    straightened: Array,
    px_per_mm: float,
    expected_mm: tuple[tuple[float, float], tuple[float, float]],
    fabric: Fabric,
    *,
    name: str = "photo",
) -> StitchSpacing:
    """The mean size of a stitch in a straightened photo of nothing but fabric.

    Parameters
    ----------
    straightened : (rows, columns) grey levels; the rows of the knitting lie along the rows.
    px_per_mm : its scale.
    expected_mm : the least and the largest width of a stitch, and the same of its height.
    fabric : which decides after how many stitches the texture comes again.
    name : for messages.

    Raises
    ------
    InputError
        If there are too few stitches, too few pixels for a stitch, or no even texture.
    """
    even = _evened(straightened, max(high for _, high in expected_mm) * px_per_mm)
    correlation = _autocorrelation(even)
    middle = np.array(correlation.shape) // 2
    repeats = repeat_of(fabric)
    vectors, heights = [], []
    for axis, (repeat, ends) in enumerate(zip(repeats, expected_mm, strict=True)):
        low, high = (repeat * px_per_mm * end for end in ends)
        most = _REACH * straightened.shape[1 - axis]
        vector, height = _first_peak(correlation, middle, axis, max(low, 4.0), min(high, most))
        vectors.append(vector)
        heights.append(height)
    _check_periodicity(correlation, middle, np.array(vectors), heights, name)
    lattice, covariance = _fitted_lattice(correlation, middle, np.array(vectors), heights)
    lengths = np.hypot(*lattice.T)
    _check_size(np.array(straightened.shape[::-1]), lengths, px_per_mm, name)
    counts = np.array(straightened.shape[::-1]) / lengths * repeats
    uneven = _UNEVEN * (1 / np.minimum(heights, 1) - 1) / counts
    errors = np.hypot(np.sqrt(np.diag(covariance)), np.hypot(_SCATTER, uneven) * lengths)
    if (errors > MAX_ERROR * lengths).any():
        problem = f"the stitches are too uneven: ± {(errors / lengths).max():.1%} of a stitch."
        remedy = "Go closer, light the fabric evenly, and let it hang flat without creases."
        raise InputError(name, problem, remedy)
    per_stitch = np.array(repeats) * px_per_mm
    course, wale = (lengths / per_stitch).tolist()
    course_sd, wale_sd = (errors / per_stitch).tolist()
    return StitchSpacing(course, wale, course_sd, wale_sd, min(heights))


def _check_periodicity(
    correlation: Array, middle: Array, vectors: Array, heights: list[float], name: str
) -> None:
    twice = scipy.ndimage.map_coordinates(
        correlation, (2 * vectors[:, ::-1] + middle).T, order=1, cval=0.0
    )
    if (twice > np.maximum(_HIGHER * np.array(heights), MIN_PERIODICITY)).any():
        remedy = "Count stitches and rows per 10 cm again, and say which fabric it is."
        raise InputError(name, "the stitches are twice as large as the gauge says.", remedy)
    axis = int(np.argmin(heights))
    if heights[axis] < MIN_PERIODICITY:
        raise InputError(
            name,
            f"no {('columns', 'rows')[axis]} of stitches can be made out (correlation"
            f" {max(heights[axis], 0):.2f}; {MIN_PERIODICITY:g} is needed).",
            "Photograph the face side sharply, in light from one side, so that each stitch has a"
            " shadow; let the rows lie level; and check the gauge.",
        )


def _check_size(size: Array, lengths: Array, px_per_mm: float, name: str) -> None:
    if lengths.min() < MIN_PERIOD_PX:
        raise InputError(
            name,
            f"has {px_per_mm:.1f} pixels per mm, too few for these stitches.",
            f"Go closer, or send a larger photo: {MIN_PERIOD_PX:.0f} pixels a stitch are needed.",
        )
    if (size < MIN_PERIODS * lengths).any():
        width, height = (size / px_per_mm).tolist()
        raise InputError(
            name,
            f"only {width:.0f} × {height:.0f} mm of flat fabric can be used.",
            f"Knit a swatch of 20 stitches and 30 rows or more; {MIN_PERIODS:.0f} repeats of the"
            " texture are needed in its middle.",
        )


def _evened(grey: Array, period_px: float) -> Array:
    """Grey levels without shading over more than a stitch, of one contrast everywhere."""
    flat = grey - scipy.ndimage.gaussian_filter(grey, 0.7 * period_px)
    contrast = np.sqrt(scipy.ndimage.gaussian_filter(flat**2, 1.5 * period_px))
    return np.asarray(flat / np.maximum(contrast, 1e-6 + 0.2 * np.median(contrast)))


def _autocorrelation(even: Array) -> Array:
    """Correlation with itself at every shift; no shift is in the middle."""
    window = np.outer(*(scipy.signal.windows.tukey(size, 0.5) for size in even.shape))
    shape = [scipy.fft.next_fast_len(2 * size, real=True) for size in even.shape]

    def squared(values: Array) -> Array:
        return np.asarray(scipy.fft.irfft2(np.abs(scipy.fft.rfft2(values, shape)) ** 2, shape))

    mean = float((even * window).sum() / window.sum())
    own = squared((even - mean) * window)
    overlap = np.maximum(squared(window), 1e-3 * float(np.sum(window**2)))
    ratio = own / overlap
    centred = np.fft.fftshift(ratio / ratio[0, 0])
    half = [size // 2 for size in even.shape]
    middle = [size // 2 for size in shape]
    rows, columns = (slice(m - h, m + h + 1) for m, h in zip(middle, half, strict=True))
    return np.asarray(centred[rows, columns])


def _first_peak(
    correlation: Array, middle: Array, axis: int, low: float, high: float
) -> tuple[Array, float]:
    """The shift (x, y) to the first peak about along an axis (0: x), and its height."""
    along = np.arange(low, high + 1, 0.5)
    angles = np.radians(np.linspace(-MAX_ROTATION_DEG, MAX_ROTATION_DEG, 25))
    shifts = np.stack([np.outer(along, np.cos(angles)), np.outer(along, np.sin(angles))], axis=-1)
    shifts = shifts if axis == 0 else shifts[..., ::-1]
    heights = scipy.ndimage.map_coordinates(
        correlation, np.moveaxis(shifts[..., ::-1] + middle, -1, 0), order=1, cval=-1.0
    )
    best = heights.max(axis=1)
    inner = (best[1:-1] >= best[:-2]) & (best[1:-1] >= best[2:])
    peaks = 1 + np.flatnonzero(inner)
    if not len(peaks):
        return shifts[int(best.argmax()), int(heights[best.argmax()].argmax())], -1.0
    first = peaks[best[peaks] >= _AS_HIGH * best[peaks].max()][0]
    shift = shifts[first, int(heights[first].argmax())]
    return shift, float(best[first])


def _fitted_lattice(
    correlation: Array, middle: Array, vectors: Array, heights: list[float]
) -> tuple[Array, Array]:
    """Two shifts (2, 2), as rows (x, y), and the covariance of their lengths."""
    reach = _REACH * np.array(correlation.shape[::-1])
    lengths = np.hypot(*vectors.T)
    least = 0.3 * min(heights)
    weights, residuals, counts = np.zeros(0), np.zeros((0, 2)), np.zeros((0, 2))
    for ring in range(1, 60):
        pairs = np.array([(n, m) for n in range(ring + 1) for m in range(-ring, ring + 1)])
        pairs = pairs[(pairs[:, 0] > 0) | (pairs[:, 1] > 0)]
        shifts = pairs @ vectors
        pairs = pairs[(np.abs(shifts) < reach).all(axis=1)]
        located = [_located(correlation, middle, pair @ vectors, lengths) for pair in pairs]
        high = np.array([height for _, height in located]) > least
        if ring > 1 and (len(pairs) == len(counts) or high.sum() < 3):
            break
        counts, places = pairs[high], np.array([place for place, _ in located])[high]
        weights = np.array([height for _, height in located])[high]
        if len(counts) < 2 or np.linalg.matrix_rank(counts) < 2:
            break
        root = np.sqrt(weights)[:, None]
        vectors = np.linalg.lstsq(counts * root, places * root, rcond=None)[0]
        residuals = places - counts @ vectors
    freedom = max(len(counts) - 2, 1)
    scatter = float(np.sum(weights * (residuals**2).mean(axis=1)) / weights.sum())
    information = (counts * weights[:, None] / weights.mean()).T @ counts
    # Peaks are not independent: neighbours share most of the fabric. Count a quarter of them.
    covariance = 4 * scatter * len(counts) / freedom * np.linalg.pinv(information)
    return vectors, covariance


def _located(
    correlation: Array, middle: Array, shift: Array, lengths: Array
) -> tuple[Array, float]:
    """The place (x, y) of the peak near a shift, by parabolas, and its height."""
    column, row = np.rint(shift + middle[::-1]).astype(int)
    wide, high = np.maximum(2, np.rint(0.2 * lengths)).astype(int)
    top, left = max(row - high, 0), max(column - wide, 0)
    part = correlation[top : row + high + 1, left : column + wide + 1]
    if min(part.shape) < 3:
        return shift, -1.0
    y, x = np.unravel_index(int(part.argmax()), part.shape)
    if not (0 < y < part.shape[0] - 1 and 0 < x < part.shape[1] - 1):
        return shift, -1.0  # the highest place is at the rim: no peak of this stitch
    reach_y, reach_x = (max(1, round(0.08 * length)) for length in lengths[::-1])
    rows = slice(max(y - reach_y, 0), min(y + reach_y + 1, part.shape[0]))
    columns = slice(max(x - reach_x, 0), min(x + reach_x + 1, part.shape[1]))
    down, right = np.mgrid[rows, columns]
    down, right = down - y, right - x
    terms = [np.ones_like(down), right, down, right**2, down**2, right * down]
    a = np.stack([term.ravel() for term in terms], axis=1).astype(float)
    _, bx, by, cxx, cyy, cxy = np.linalg.lstsq(a, part[rows, columns].ravel(), rcond=None)[0]
    curvature = 4 * cxx * cyy - cxy**2
    if cxx >= 0 or cyy >= 0 or curvature <= 0:
        return shift, -1.0
    off = np.array([cxy * by - 2 * cyy * bx, cxy * bx - 2 * cxx * by]) / curvature
    if math.hypot(*off) > 1.5 * max(reach_x, reach_y):
        return shift, -1.0
    place = np.array([left + x, top + y]) + off - middle[::-1]
    return place, float(part.max())
