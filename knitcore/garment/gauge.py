"""Gauge: how many stitches and rows a length of cloth takes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Fabric
from knitcore.materials import Material
from knitcore.materials.yarn_per_stitch import MeasuredYarn
from knitcore.prediction.pure import SIZE_LOG_SD
from knitcore.prediction.size import RelaxedSize

SWATCH_LOG_SD = RelaxedSize.log_sd
"""Standard deviation of the logarithm of a knitter's own gauge."""


class GaugeLength(Enum):
    """Lengths over which gauge is counted, in mm."""

    TEN_CM = 100.0
    FOUR_INCHES = 101.6
    FIVE_CM = 50.0


@dataclass(frozen=True)
class Gauge:
    """Size of one stitch at rest.

    Attributes
    ----------
    stitch_course_mm, stitch_wale_mm : width of a stitch and height of a row.
    source : of the sizes, in words.
    log_sd : standard deviation of the logarithm of both.
    """

    stitch_course_mm: float
    stitch_wale_mm: float
    source: str = ""
    log_sd: float = SWATCH_LOG_SD

    def __post_init__(self) -> None:
        for name in ("stitch_course_mm", "stitch_wale_mm"):
            value = getattr(self, name)
            if not (math.isfinite(value) and 0.1 <= value <= 100):
                raise InputError(
                    "gauge",
                    f"{value:g} mm is not a stitch size.",
                    "Count stitches and rows over a ruler, and give both counts and the length.",
                )

    @classmethod
    def of_swatch(cls, stitches: int, rows: int, width_mm: float, height_mm: float) -> Gauge:
        """The gauge of a measured swatch.

        Examples
        --------
        >>> gauge = Gauge.of_swatch(stitches=22, rows=30, width_mm=100, height_mm=100)
        >>> gauge.stitches_for(250), gauge.rows_for(60)
        (55, 18)
        """
        for name, value in (("stitches", stitches), ("rows", rows)):
            if value < 1:
                raise InputError(name, f"{value} cannot be counted.", "Count at least one.")
        return cls(width_mm / stitches, height_mm / rows, "swatch")

    @classmethod
    def of_count(cls, stitches: float, rows: float, per: GaugeLength = GaugeLength.TEN_CM) -> Gauge:
        """The gauge as a ball band prints it."""
        if not (stitches > 0 and rows > 0):
            raise InputError(
                "gauge",
                "the counts must be positive.",
                "Give numbers of stitches and rows above 0.",
            )
        return cls(per.value / stitches, per.value / rows, "counted")

    @classmethod
    def of_material(cls, material: Material, fabric: Fabric) -> Gauge:
        """The gauge of a pure fabric of the library.

        Raises
        ------
        InputError
            If the material lacks that fabric.
        """
        record = material.record(fabric)
        return cls(
            record.stitch_course_mm,
            record.stitch_wale_mm,
            f"{material.identifier}, {fabric}: {record.stitch_size_source}",
            SIZE_LOG_SD,
        )

    def counts(self, per: GaugeLength = GaugeLength.TEN_CM) -> tuple[float, float]:
        """Stitches and rows over a length."""
        return per.value / self.stitch_course_mm, per.value / self.stitch_wale_mm

    def stitches_for(self, width_mm: float, *, multiple: int = 1, extra: int = 0) -> int:
        """Stitches of a width, rounded to ``multiple * n + extra`` with at least one repeat."""
        return _rounded(width_mm / self.stitch_course_mm, multiple, extra)

    def rows_for(self, height_mm: float, *, multiple: int = 1, extra: int = 0) -> int:
        """Rows of a height, rounded to ``multiple * n + extra`` with at least one repeat."""
        return _rounded(height_mm / self.stitch_wale_mm, multiple, extra)


@dataclass(frozen=True)
class GaugeSet:
    """The gauge of each pure fabric.

    Attributes
    ----------
    gauges : by fabric; the material may lack some.
    material : its identifier.
    length_factor : loop lengths over the material's own: the square root of the ratio of stitch
        areas.
    measured_yarn : yarn in a stitch of the swatch, if known, instead of the factor.
    """

    gauges: Mapping[Fabric, Gauge]
    material: str
    length_factor: float = 1.0
    measured_yarn: MeasuredYarn | None = None

    @classmethod
    def of_material(
        cls, material: Material, swatch: Gauge | None = None, fabric: Fabric = Fabric.STOCKINETTE
    ) -> GaugeSet:
        """The gauges of a material, or of a knitter who knits ``fabric`` at a swatch's gauge.

        The other fabrics are scaled alike: a loose knitter is loose in all of them.

        Raises
        ------
        InputError
            If there is a swatch of a fabric that the material lacks.
        """
        gauges = {f: Gauge.of_material(material, f) for f in Fabric if f in material.fabrics}
        if swatch is None:
            return cls(gauges, material.identifier)
        if fabric not in gauges:
            Gauge.of_material(material, fabric)  # raises if the material lacks the fabric
        own = gauges[fabric]
        across = swatch.stitch_course_mm / own.stitch_course_mm
        along = swatch.stitch_wale_mm / own.stitch_wale_mm
        scaled = {
            f: Gauge(
                g.stitch_course_mm * across,
                g.stitch_wale_mm * along,
                f"{swatch.source} {fabric}, other fabrics scaled alike",
                swatch.log_sd if f is fabric else math.hypot(swatch.log_sd, SIZE_LOG_SD),
            )
            for f, g in gauges.items()
        }
        return cls(scaled, material.identifier, math.sqrt(across * along))

    def __getitem__(self, fabric: Fabric) -> Gauge:
        """The gauge of a fabric.

        Raises
        ------
        InputError
            If the material lacks it.
        """
        if fabric not in self.gauges:
            remedy = "Choose another fabric, or a material that has it."
            raise InputError("material", f"{self.material} has no {fabric}.", remedy)
        return self.gauges[fabric]


def _rounded(count: float, multiple: int, extra: int) -> int:
    if not (math.isfinite(count) and count > 0):
        raise InputError("size", "a length must be positive.", "Give a length above 0 mm.")
    if multiple < 1 or extra < 0:
        raise InputError(
            "multiple",
            "no repeat has this many stitches.",
            "Give multiple of at least 1, and extra of at least 0.",
        )
    return max(round((count - extra) / multiple), 1) * multiple + extra
