"""Positions of the stitches of a chart in the plane: on a straight lattice, or drawn in."""

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.fabric import PHASES, Direction
from knitcore.chart.phases import QUARTERS_OF_CODE, pure_fabric, quarter_phases, surroundings
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials.material import Material
from knitcore.prediction.neighbourhood import neighbourhood_sizes


@dataclass(frozen=True, eq=False)
class Lattice:
    """Stitches of a chart laid flat.

    Attributes
    ----------
    centres_mm : (rows, columns, 2) centres of the stitches, x along the course, y up the wale.
    sizes_mm : (rows, columns, 2) width and height of each stitch.
    """

    centres_mm: Array
    sizes_mm: Array

    @property
    def corners_mm(self) -> Array:
        """Corners of the cells, (rows + 1, columns + 1, 2): the mean of the edges that meet there.

        Those along x end at a corner from below and above, those along y from left and right.
        """
        return np.stack([self._edges_along(0), self._edges_along(1).T], axis=-1)

    def _edges_along(self, axis: int) -> Array:
        """One coordinate of the corners; the first axis is of the lines that run along it."""
        centres, sizes = (v[..., axis] for v in (self.centres_mm, self.sizes_mm))
        if axis == 1:
            centres, sizes = centres.T, sizes.T
        ends = centres[:, -1:] + sizes[:, -1:] / 2
        edges = np.pad(np.hstack([centres - sizes / 2, ends]), ((1, 1), (0, 0)), mode="edge")
        return np.asarray((edges[1:] + edges[:-1]) / 2)


def flat_lattice(chart: StitchChart, material: Material) -> Lattice:
    """The chart as a flat sheet, with the mean width of each wale and mean height of each course.

    The lattice is for pictures; it is no equilibrium, for which the swatch solves.

    Raises
    ------
    InputError
        If the material lacks one of the four fabrics.
    """
    of_phase = np.array([material.record(fabric).stitch_mm for fabric in PHASES])
    sizes = of_phase[QUARTERS_OF_CODE].mean(axis=(1, 2))[surroundings(chart)]
    widths, heights = sizes[:, :, 0].mean(axis=0), sizes[:, :, 1].mean(axis=1)
    x, y = np.cumsum(widths) - widths / 2, np.cumsum(heights) - heights / 2
    return Lattice(
        centres_mm=np.stack(np.meshgrid(x, y), axis=-1),
        sizes_mm=np.stack(np.meshgrid(widths, heights), axis=-1),
    )


def resting_lattice(chart: StitchChart, material: Material) -> Lattice:
    """The chart as it lies at rest with free edges: textures of different gauge draw each other in.

    Every stitch tends to the size that its surroundings give it
    (:mod:`knitcore.prediction.neighbourhood`), and shear holds rows and columns together: the
    places x of the edges between stitches minimise the sum of (step along the course - width)² +
    weight (step along the wale)², and y likewise; the weights are shear over Young's modulus. Both
    are Poisson's equation on a rectangle, which a cosine transform solves.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """
    if pure_fabric(chart) is not None:
        return flat_lattice(chart, material)
    sizes = neighbourhood_sizes(chart, material)
    shares = np.bincount(quarter_phases(chart).ravel(), minlength=len(PHASES))
    laws = [(share, material.law(PHASES[k])) for k, share in enumerate(shares) if share]
    shear, course, wale = np.sum(
        [(n * law.shear_modulus, *(n * law.modulus(d) for d in Direction)) for n, law in laws],
        axis=0,
    )
    aspect = float(sizes[..., 0].mean() / sizes[..., 1].mean())
    x = _edges(sizes[..., 0], float(shear / course) * aspect**2)
    y = _edges(sizes[..., 1].T, float(shear / wale) / aspect**2).T
    return Lattice(
        centres_mm=np.stack([(x[:, 1:] + x[:, :-1]) / 2, (y[1:] + y[:-1]) / 2], axis=-1),
        sizes_mm=np.stack([np.diff(x, axis=1), np.diff(y, axis=0)], axis=-1),
    )


def _edges(steps: Array, weight: float) -> Array:
    """Places (lines, steps + 1) of the edges between stitches whose steps along each line are
    nearest to ``steps`` (lines, steps), and whose steps from line to line, times the weight, are
    nearest to 0.
    """
    from scipy.fft import dctn, idctn  # loads for 0.3 s, which a prediction does not wait for

    pull = -np.diff(steps, axis=1, prepend=0.0, append=0.0)
    wave = dctn(pull, norm="ortho")
    across, along = (2 - 2 * np.cos(np.pi * np.arange(n) / n) for n in pull.shape)
    stiffness = along[None, :] + weight * across[:, None]
    stiffness[0, 0] = 1.0  # the mean place is free, and 0
    places: Array = idctn(wave / stiffness, norm="ortho")
    return places - float(places.min())


def course_angles(centres_mm: Array) -> Array:
    """Slope of each course at each stitch, radians, (rows, columns)."""
    if centres_mm.shape[1] < 2:
        return np.zeros(centres_mm.shape[:2])
    along = np.gradient(centres_mm, axis=1)
    return np.arctan2(along[..., 1], along[..., 0])


def stretched_sizes_mm(centres_mm: Array, relaxed: Lattice) -> Array:
    """Sizes of stitches whose centres have moved, so that neighbours still meet.

    Parameters
    ----------
    centres_mm : (rows, columns, 2) where the centres are now.
    relaxed : the lattice before.
    """
    sizes = relaxed.sizes_mm.copy()
    for axis, component in ((1, 0), (0, 1)):
        if centres_mm.shape[axis] < 2:
            continue
        now = np.gradient(centres_mm[..., component], axis=axis)
        before = np.gradient(relaxed.centres_mm[..., component], axis=axis)
        sizes[..., component] *= now / before
    return sizes
