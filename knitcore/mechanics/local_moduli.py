"""Local moduli: the contribution of each stitch of a chart to the stiffness of its surroundings.

The moduli of a stitch depend only on its surroundings code (16 kinds,
:mod:`knitcore.chart.phases`), so they are looked up in a table of 16 rows per material. The rule,
after the reduced-symmetry model: along the pull the two quarters of a half stitch are in series,
weighted by their relaxed extent along it; across the pull the two halves are in parallel, weighted
by their relaxed extent across. A stitch whose quarters are all of one phase has that pure fabric's
modulus exactly, and any other one lies between the moduli of its phases.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.chart.fabric import PHASES, Direction
from knitcore.chart.phases import QUARTERS_OF_CODE, surroundings
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart, as_chart
from knitcore.materials import Material, as_material
from knitcore.materials.law_uncertainty import Z_SCORE


@dataclass(frozen=True, eq=False, repr=False)
class StitchTable(Result):
    """Elastic constants of the 16 kinds of stitch of one material.

    Attributes
    ----------
    modulus_course_n_per_mm, modulus_wale_n_per_mm : (16,) local Young's moduli, N/mm, by
        surroundings code.
    log_sd_course, log_sd_wale : (16,) standard deviations of the moduli's logarithms, from those
        of the phases (delta method, phases independent).
    fractions : (16, 4) shares of the phases (stockinette, garter, rib, seed).
    """

    modulus_course_n_per_mm: Array
    modulus_wale_n_per_mm: Array
    log_sd_course: Array
    log_sd_wale: Array
    fractions: Array

    def modulus_n_per_mm(self, direction: Direction) -> Array:
        """Local modulus by code in a direction, N/mm."""
        return direction.of(self.modulus_course_n_per_mm, self.modulus_wale_n_per_mm)

    @cached_property
    def log_moduli(self) -> Array:
        """(2, 16) logarithms of the moduli, course-wise and wale-wise."""
        return np.log([self.modulus_course_n_per_mm, self.modulus_wale_n_per_mm])

    def extensibility_mm_per_n(self, direction: Direction) -> Array:
        """Inverse of the modulus: the sides of the extensibility rectangles (Fig. 4d), mm/N."""
        return 1.0 / self.modulus_n_per_mm(direction)

    @property
    def anisotropy(self) -> Array:
        """Y_course / Y_wale by code."""
        return self.modulus_course_n_per_mm / self.modulus_wale_n_per_mm

    def modulus_interval_n_per_mm(self, direction: Direction) -> tuple[Array, Array]:
        """Low and high ends of the moduli's 90 % intervals, N/mm."""
        modulus = self.modulus_n_per_mm(direction)
        factor = np.exp(Z_SCORE * direction.of(self.log_sd_course, self.log_sd_wale))
        return modulus / factor, modulus * factor


def stitch_table(material: Material | str) -> StitchTable:
    """The table of a material's 16 kinds of stitch.

    A material that lacks a pure fabric gets NaN for the kinds that contain it.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> table = stitch_table(material("acrylic"))
    >>> round(float(table.modulus_course_n_per_mm[0b1100]), 3)  # garter: odd below and above
    0.134
    """
    material = as_material(material)
    missing = np.full(4, np.nan)
    moduli, deviations, sizes = np.array([missing] * 2), np.array([missing] * 2), np.ones((2, 4))
    for phase, fabric in enumerate(PHASES):
        record = material.fabrics.get(fabric)
        if record is None:
            continue
        for direction in Direction:
            moduli[direction.axis, phase] = record.law.modulus(direction)
            deviations[direction.axis, phase] = record.uncertainty.log_modulus(direction)
            sizes[direction.axis, phase] = record.stitch_size_mm(direction)
    quarters = QUARTERS_OF_CODE  # (16, below/above, left/right)
    course, sd_course = _mix(quarters, moduli[0], deviations[0], sizes[0], sizes[1])
    wale, sd_wale = _mix(quarters.swapaxes(1, 2), moduli[1], deviations[1], sizes[1], sizes[0])
    fractions = (quarters.reshape(16, 4, 1) == np.arange(4)).mean(axis=1)
    return StitchTable(course, wale, sd_course, sd_wale, fractions)


def _mix(
    quarters: NDArray[np.uint8], modulus: Array, log_sd: Array, along: Array, across: Array
) -> tuple[Array, Array]:
    """Moduli of the 16 kinds, and the standard deviations of their logarithms.

    ``quarters`` has the shape (16, halves in parallel, quarters in series).
    """
    length, compliance = along[quarters], along[quarters] / modulus[quarters]
    half = length.sum(axis=-1) / compliance.sum(axis=-1)
    weight = across[quarters].mean(axis=-1)
    weight = weight / weight.sum(axis=-1, keepdims=True)
    total = (weight * half).sum(axis=-1)
    # d ln total / d ln modulus of each quarter, then added up for quarters of one phase.
    share = (weight * half / total[:, None])[..., None] * (
        compliance / compliance.sum(axis=-1, keepdims=True)
    )
    by_phase = (share[..., None] * (quarters[..., None] == np.arange(4))).sum(axis=(1, 2))
    terms = np.where(by_phase > 0, by_phase * log_sd, 0.0)
    return total, np.sqrt((terms**2).sum(axis=-1))


@dataclass(frozen=True, eq=False, repr=False)
class LocalModuli(Result):
    """Local moduli of every stitch of a chart.

    Attributes
    ----------
    codes : uint8 (rows, columns), surroundings codes; row 0 is the bottom row.
    table : values by code.
    """

    codes: NDArray[np.uint8]
    table: StitchTable

    @cached_property
    def modulus_course_n_per_mm(self) -> Array:
        """(rows, columns) local course-wise modulus, N/mm."""
        return self.table.modulus_course_n_per_mm[self.codes]

    @cached_property
    def modulus_wale_n_per_mm(self) -> Array:
        """(rows, columns) local wale-wise modulus, N/mm."""
        return self.table.modulus_wale_n_per_mm[self.codes]

    @cached_property
    def extensibility_course_mm_per_n(self) -> Array:
        """(rows, columns) side of the extensibility rectangle along the course, mm/N."""
        return self.table.extensibility_mm_per_n(Direction.COURSE)[self.codes]

    @cached_property
    def extensibility_wale_mm_per_n(self) -> Array:
        """(rows, columns) side of the extensibility rectangle along the wale, mm/N."""
        return self.table.extensibility_mm_per_n(Direction.WALE)[self.codes]

    @cached_property
    def anisotropy(self) -> Array:
        """(rows, columns) Y_course / Y_wale."""
        return self.table.anisotropy[self.codes]


def local_moduli(chart: StitchChart | str, material: Material | str) -> LocalModuli:
    """Local moduli of every stitch.

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> chart = StitchChart.parse("KKKPKPKP")
    >>> local_moduli(chart, material("acrylic")).modulus_course_n_per_mm.round(3)
    array([[0.303, 0.303, 0.028, 0.013, 0.013, 0.013, 0.013, 0.013]])
    """
    chart, material = as_chart(chart), as_material(material)
    codes = surroundings(chart)
    if not material.is_complete:
        for phase in np.unique(QUARTERS_OF_CODE[np.unique(codes)]):
            material.record(PHASES[phase])
    return LocalModuli(codes, stitch_table(material))


def windows_of(touched: slice, size: int) -> tuple[slice, slice]:
    """The stitches whose codes a change can alter, and those that determine them."""
    start, stop, _ = touched.indices(size)
    changed = slice(max(start - 1, 0), min(stop + 1, size))
    # Two more on each side: an edge stitch borrows the segment of its other side, so a window
    # must reach one stitch beyond any stitch whose code is kept.
    return changed, slice(max(changed.start - 2, 0), min(changed.stop + 2, size))
