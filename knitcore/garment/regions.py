"""Regions of a garment, their fills, and the borders between them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Mask
from knitcore.base.bounds import check_positive
from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.garment.gauge import Gauge
from knitcore.garment.shaped import ShapedChart
from knitcore.materials import Interval, Material
from knitcore.materials.law_uncertainty import log_interval
from knitcore.materials.yarn_per_stitch import MeasuredYarn, yarn_per_stitch
from knitcore.prediction.hand import HandPull, hand_pulls
from knitcore.prediction.neighbourhood import counted_over_computed
from knitcore.prediction.predict import predict
from knitcore.prediction.size import RelaxedSize

MISFIT = 0.10
"""Relative difference of stitch sizes above which a seam between regions puckers visibly."""


@dataclass(frozen=True, eq=False)
class Region:
    """A part of a garment with one fabric.

    Attributes
    ----------
    name : for people.
    cells : bool (rows, columns), row 0 at the bottom.
    fill : the repeat, continued over the whole chart from its bottom left, so that regions of
        one fabric fit together.
    colour : ``#rrggbb`` for intarsia and for the chart, or empty.
    """

    name: str
    cells: Mask
    fill: StitchChart
    colour: str = ""


@dataclass(frozen=True)
class RegionMisfit:
    """Two regions of different gauge that share an edge.

    Attributes
    ----------
    first, second : the regions.
    stitches : number of pairs of stitches that meet there.
    difference : of the size that should be equal on both sides, over the smaller.
    text : a description in words.
    """

    first: str
    second: str
    stitches: int
    difference: float
    text: str


@dataclass(frozen=True)
class RegionNumbers:
    """Extensibility and moduli of the fabric of a region, and its stretch at a hand's pull."""

    name: str
    stitches: int
    extensibility_course_mm_per_n: float
    extensibility_wale_mm_per_n: float
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    hand: HandPull


def fill_regions(stitch: Mask, regions: Sequence[Region]) -> ShapedChart:
    """The chart that regions make inside an outline.

    Raises
    ------
    InputError
        If regions overlap, or leave a stitch without a fabric.
    """
    times = np.zeros(stitch.shape, dtype=int)
    purl = np.zeros(stitch.shape, dtype=bool)
    for region in regions:
        if region.cells.shape != stitch.shape:
            raise InputError(
                "regions",
                f"the size of {region.name} is not that of the chart.",
                "Give True or False for every cell of the chart.",
            )
        times += region.cells
        purl[region.cells] = region.fill.resized(*stitch.shape).purl[region.cells]
    for problem, cells in (("two regions", times > 1), ("no region", times == 0)):
        wrong = np.argwhere(cells & stitch)
        if len(wrong):
            row, column = wrong[0] + 1
            raise InputError(
                "regions",
                f"{len(wrong)} stitches belong to {problem}, the first in row {row}, column "
                f"{column}.",
                "Give every stitch of the outline exactly one region.",
            )
    return ShapedChart(StitchChart(purl), stitch)


def misfits(
    regions: Sequence[Region], gauges: Sequence[Gauge], stitch: Mask
) -> tuple[RegionMisfit, ...]:
    """Borders between regions of different gauge.

    Regions side by side share row heights; regions above each other share stitch widths.
    """
    owner = np.full(stitch.shape, -1)
    for index, region in enumerate(regions):
        owner[region.cells & stitch] = index
    borders = []
    for pairs, name, words in (
        ((owner[:, :-1], owner[:, 1:]), "stitch_wale_mm", ("beside", "rows", "higher")),
        ((owner[:-1], owner[1:]), "stitch_course_mm", ("below or above", "stitches", "wider")),
    ):
        first, second = (side.ravel() for side in pairs)
        meet = (first >= 0) & (second >= 0) & (first != second)
        edges = np.sort(np.stack([first[meet], second[meet]]), axis=0)
        for a, b in np.unique(edges, axis=1).T.tolist():
            sizes = getattr(gauges[a], name), getattr(gauges[b], name)
            difference = max(sizes) / min(sizes) - 1
            if difference <= MISFIT:
                continue
            larger, smaller = (a, b) if sizes[0] > sizes[1] else (b, a)
            text = (
                f"“{regions[larger].name}” lies {words[0]} “{regions[smaller].name}” and its "
                f"{words[1]} are {100 * difference:.0f} % {words[2]}: the edge will pucker or draw "
                "in unless one of them is knitted on other needles or with short rows."
            )
            count = int(np.count_nonzero((edges == [[a], [b]]).all(axis=0)))
            borders.append(RegionMisfit(regions[a].name, regions[b].name, count, difference, text))
    return tuple(borders)


def region_numbers(
    shaped: ShapedChart, regions: Sequence[Region], material: Material
) -> tuple[RegionNumbers, ...]:
    """Numbers of the fabrics that fill the regions.

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.
    """
    numbers = []
    for region in regions:
        cells = region.cells & shaped.stitch
        if not cells.any():
            continue
        predicted = predict(region.fill, material)
        course, wale = predicted.modulus_course_n_per_mm, predicted.modulus_wale_n_per_mm
        (hand,) = hand_pulls(material, predicted, ["hand"])
        count = int(cells.sum())
        numbers.append(RegionNumbers(region.name, count, 1 / course, 1 / wale, course, wale, hand))
    return tuple(numbers)


@dataclass(frozen=True)
class YarnUse:
    """Yarn needed for a chart.

    Attributes
    ----------
    length_m : without cast-on, tails and swatch.
    mass_g : None without a linear density.
    log_sd : standard deviation of the logarithm of both.
    source : of the yarn in a stitch, in words.
    """

    length_m: float
    mass_g: float | None
    log_sd: float
    source: str

    def __str__(self) -> str:
        low, high = self.length_interval_m
        mass = "" if self.mass_g is None else f", {self.mass_g:.3g} g"
        return f"{self.length_m:.3g} m ({low:.3g} to {high:.3g}) of yarn{mass}"

    @property
    def length_interval_m(self) -> Interval:
        """90 % interval."""
        return log_interval(self.length_m, self.log_sd)

    @property
    def mass_interval_g(self) -> Interval | None:
        """90 % interval of the mass."""
        return None if self.mass_g is None else log_interval(self.mass_g, self.log_sd)


def yarn_use(
    shaped: ShapedChart,
    material: Material,
    *,
    linear_density_tex: float | None = None,
    cells: Mask | None = None,
    size: RelaxedSize | None = None,
    measured: MeasuredYarn | None = None,
    length_factor: float = 1.0,
) -> YarnUse:
    """Yarn of all stitches, by :func:`~knitcore.materials.yarn_per_stitch.yarn_per_stitch`.

    Parameters
    ----------
    shaped : the chart.
    material : with a loop length, unless yarn was measured.
    linear_density_tex : g per km of the yarn.
    cells : which stitches, such as those of one yarn; all inside the outline if left out.
    size : relaxed size of the mean stitch, if known: loops grow with the root of its area.
    measured : yarn in a stitch, if known; the size and the factor then say nothing more.
    length_factor : loop lengths over the material's, by the knitter's gauge.

    Raises
    ------
    InputError
        If no loop length is known, or the density is not positive.
    """
    chart = shaped.continued()
    used = yarn_per_stitch(chart, material, measured=measured, cells=cells, stitch=shaped.stitch)
    if measured is None:
        areas = counted_over_computed(chart, material, size, shaped.stitch).prod()
        length_factor *= math.sqrt(areas)
    else:
        length_factor = 1.0
    counted = shaped.stitch if cells is None else shaped.stitch & cells
    metres = length_factor * used.mean_mm * int(counted.sum()) / 1000
    if linear_density_tex is None:
        return YarnUse(metres, None, used.log_sd, used.source)
    check_positive("linear_density_tex", linear_density_tex, "tex", "a linear density", 1e5)
    return YarnUse(metres, metres * linear_density_tex / 1000, used.log_sd, used.source)
