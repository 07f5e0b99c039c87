"""The prediction for a chart: response in both directions, intervals, source and notes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base import showing
from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.base.kinds import as_numbers
from knitcore.chart.fabric import Direction
from knitcore.law.response import Response
from knitcore.materials.interval_parts import Part, Variances, deviation
from knitcore.materials.law_uncertainty import Interval, log_interval, normal_interval
from knitcore.prediction.size import KnownBy, RelaxedSize

SHOWN_STRESS_N_PER_MM = 0.2
"""Stress up to which a prediction's curves are drawn."""


class Source(StrEnum):
    """Kind of evidence that a prediction comes from."""

    MEASURED = "measured"
    ESTIMATED = "estimated"
    SWEPT = "swept"
    LEARNED = "learned"
    LEARNED_OF_SIZE = "learned with known size"
    OTHER_STITCHES = "learned with other stitches"


@dataclass(frozen=True, eq=False)
class Along:
    """Response to a pull along one direction, with the other direction free unless stated.

    Attributes
    ----------
    response : stretch under stress.
    stiff, soft : the ends of its 90 % interval, as responses.
    across : strains across the pull at stresses.
    held : stretch under stress while the width is held.
    poisson, poisson_parts : contraction across the pull over the strain along it, at small strain,
        and its variance by part.
    relaxed_mm, relaxed_parts : extent of the mean stitch at rest, and the variance of its logarithm
        by part.
    strain_parts : variances of the logarithm of the strain at stresses, by part.
    bounds_n_per_mm : of the modulus: Reuss and Voigt bounds of the pure fabrics in the chart,
        widened to the modulus where folds put it outside.
    """

    response: Response
    stiff: Response
    soft: Response
    across: Callable[[ArrayLike], Array]
    held: Response
    poisson: float
    poisson_parts: Variances
    relaxed_mm: float
    relaxed_parts: Variances
    strain_parts: Callable[[ArrayLike], Variances]
    bounds_n_per_mm: Interval

    def __repr__(self) -> str:
        return f"Y = {self.modulus_n_per_mm:.3g} N/mm, stitch {self.relaxed_mm:.3g} mm"

    @property
    def modulus_n_per_mm(self) -> float:
        """Young's modulus at small strain."""
        return self.response.modulus_n_per_mm

    @property
    def modulus_interval_n_per_mm(self) -> Interval:
        """90 % interval of the modulus."""
        return Interval(self.soft.modulus_n_per_mm, self.stiff.modulus_n_per_mm)

    @property
    def extensibility_interval_mm_per_n(self) -> Interval:
        """90 % interval of 1 / Y."""
        return Interval(1 / self.stiff.modulus_n_per_mm, 1 / self.soft.modulus_n_per_mm)

    @property
    def poisson_sd(self) -> float:
        """Standard deviation of the contraction."""
        return float(deviation(self.poisson_parts))

    @property
    def relaxed_log_sd(self) -> float:
        """Standard deviation of the logarithm of the relaxed extent."""
        return float(deviation(self.relaxed_parts))

    @property
    def poisson_interval(self) -> Interval:
        """90 % interval of the contraction."""
        return normal_interval(self.poisson, self.poisson_sd)

    @property
    def relaxed_interval_mm(self) -> Interval:
        """90 % interval of the relaxed extent."""
        return log_interval(self.relaxed_mm, self.relaxed_log_sd)

    def strain(self, stress_n_per_mm: ArrayLike) -> Array:
        """Strains from the relaxed size at stresses (N/mm, at least 0)."""
        return self.response.strain(_not_negative("stress", stress_n_per_mm))

    def strain_interval(self, stress_n_per_mm: ArrayLike) -> tuple[Array, Array]:
        """Lower and upper ends of the strains' 90 % intervals."""
        stress = _not_negative("stress", stress_n_per_mm)
        return self.stiff.strain(stress), self.soft.strain(stress)

    def stress(self, strain: ArrayLike) -> Array:
        """Stresses (N/mm) at strains of at least 0; at most 10 N/mm, which lock any fabric."""
        return self.response.stress(_not_negative("strain", strain))

    def stress_interval(self, strain: ArrayLike) -> tuple[Array, Array]:
        """Lower and upper ends of the stresses' 90 % intervals."""
        strains = _not_negative("strain", strain)
        return self.soft.stress(strains), self.stiff.stress(strains)

    def held_strain(self, stress_n_per_mm: ArrayLike) -> Array:
        """Strains at stresses (N/mm, at least 0) while the width is held."""
        return self.held.strain(_not_negative("stress", stress_n_per_mm))

    def held_stress(self, strain: ArrayLike) -> Array:
        """Stresses (N/mm) at strains of at least 0 while the width is held; at most 10 N/mm."""
        return self.held.stress(_not_negative("strain", strain))

    def across_strain(self, stress_n_per_mm: ArrayLike) -> Array:
        """Strains across the pull, below 0 where it narrows, at stresses (N/mm, at least 0)."""
        return self.across(_not_negative("stress", stress_n_per_mm))


@dataclass(frozen=True, eq=False)
class Prediction:
    """Response of a chart of a material in both directions; intervals are 90 % intervals.

    Attributes
    ----------
    course, wale : pulled along the rows, and along the columns.
    shear_modulus_n_per_mm : an assumption of the laws unless they were calibrated.
    provenance : the source; for a chart in patches the least certain of theirs.
    method : how the prediction was made, in words.
    relaxed_source : where the relaxed size comes from.
    stretch_errors, size_errors : what the intervals of moduli, Poisson's ratios and curves rest
        on, and those of the relaxed size.
    notes : remarks for the user, in sentences.
    """

    course: Along
    wale: Along
    shear_modulus_n_per_mm: float
    provenance: Source
    method: str
    relaxed_source: str
    stretch_errors: tuple[str, ...]
    size_errors: tuple[str, ...]
    notes: tuple[str, ...] = ()

    @property
    def size_is_known(self) -> bool:
        """Say whether the relaxed size was given, not estimated."""
        return self.relaxed_source in tuple(KnownBy)

    @property
    def interval_source(self) -> str:
        """Name the sources of the intervals, in words."""
        return f"Stretch: {'; '.join(self.stretch_errors)}. Size: {'; '.join(self.size_errors)}."

    def along(self, direction: Direction | str) -> Along:
        """The prediction for a pull in a direction.

        Raises
        ------
        InputError
            If there is no direction of this name.
        """
        return Direction.parse(direction).of(self.course, self.wale)

    def with_size(self, relaxed: RelaxedSize) -> Prediction:
        """The prediction with a known relaxed size, and the same stretch from it."""
        course, wale = (
            replace(
                self.along(d),
                relaxed_mm=relaxed.extent_mm(d),
                relaxed_parts={Part.SIZE: np.asarray(relaxed.log_sd**2)},
            )
            for d in Direction
        )
        known_by = relaxed.known_by
        return replace(
            self, course=course, wale=wale, relaxed_source=known_by, size_errors=(known_by.errors,)
        )

    def modulus_n_per_mm(self, direction: Direction | str) -> float:
        """Young's modulus in a direction."""
        return self.along(direction).modulus_n_per_mm

    def to_dict(self) -> dict[str, Any]:
        """Collect the numbers of both directions under the names that REST and files use.

        Units are in the names, intervals are lists of two ends; curves and functions are left out.
        """
        numbers: dict[str, Any] = {}
        both = self.course, self.wale
        for direction, along, ratio in zip(Direction, both, ("yx", "xy"), strict=True):
            intervals = {
                f"modulus_{direction}_interval_n_per_mm": along.modulus_interval_n_per_mm,
                f"modulus_{direction}_bounds_n_per_mm": along.bounds_n_per_mm,
                f"poisson_{ratio}_interval": along.poisson_interval,
                f"relaxed_{direction}_interval_mm": along.relaxed_interval_mm,
            }
            numbers |= {
                f"modulus_{direction}_n_per_mm": along.modulus_n_per_mm,
                f"extensibility_{direction}_mm_per_n": 1.0 / along.modulus_n_per_mm,
                f"poisson_{ratio}": along.poisson,
                f"relaxed_{direction}_mm": along.relaxed_mm,
            }
            numbers |= {name: [ends.low, ends.high] for name, ends in intervals.items()}
        return numbers | {
            "shear_modulus_n_per_mm": self.shear_modulus_n_per_mm,
            "relaxed_source": str(self.relaxed_source),
            "provenance": self.provenance.value,
            "method": self.method,
            "interval_source": self.interval_source,
            "notes": [*self.notes],
        }

    def __repr__(self) -> str:
        return f"Prediction(course: {self.course}; wale: {self.wale}; {self.provenance})"

    def _repr_html_(self) -> str:
        def ends(value: float, interval: Interval, digits: str) -> str:
            return f"{value:{digits}} ({interval.low:{digits}} to {interval.high:{digits}})"

        along = {d: self.along(d) for d in Direction}
        rows = [
            (
                d,
                ends(a.modulus_n_per_mm, a.modulus_interval_n_per_mm, ".4f"),
                ends(a.poisson, a.poisson_interval, ".2f"),
                ends(a.relaxed_mm, a.relaxed_interval_mm, ".2f"),
            )
            for d, a in along.items()
        ]
        head = ("", "Young's modulus (N/mm)", "Poisson's ratio", "stitch at rest (mm)")
        stress = np.linspace(0.0, SHOWN_STRESS_N_PER_MM, 31)
        drawn = [
            (str(d), a.strain(stress), stress, a.strain_interval(stress)) for d, a in along.items()
        ]
        give = self.extensibility_course_mm_per_n, self.extensibility_wale_mm_per_n
        pictures = showing.beside(
            showing.curves(drawn, "strain", "stress, N/mm"),
            showing.rectangles([("extensibility", *give)], "mm/N"),
        )
        extensible = f"The rectangle is the extensibility: {give[0]:.3g} × {give[1]:.3g} mm/N."
        source = f"{self.provenance}: {self.method}. 90 % intervals: {self.interval_source}"
        table = showing.html_table(head, rows)
        return showing.captioned(table + pictures, extensible, source, *self.notes)

    @property
    def modulus_course_n_per_mm(self) -> float:
        """Young's modulus along the courses."""
        return self.course.modulus_n_per_mm

    @property
    def modulus_wale_n_per_mm(self) -> float:
        """Young's modulus along the wales."""
        return self.wale.modulus_n_per_mm

    @property
    def extensibility_course_mm_per_n(self) -> float:
        """1 / Y along the courses."""
        return 1.0 / self.modulus_course_n_per_mm

    @property
    def extensibility_wale_mm_per_n(self) -> float:
        """1 / Y along the wales."""
        return 1.0 / self.modulus_wale_n_per_mm

    @property
    def poisson_yx(self) -> float:
        """Contraction wale-wise under a course-wise pull."""
        return self.course.poisson

    @property
    def poisson_xy(self) -> float:
        """Contraction course-wise under a wale-wise pull."""
        return self.wale.poisson

    @property
    def relaxed_course_mm(self) -> float:
        """Width of the mean stitch at rest."""
        return self.course.relaxed_mm

    @property
    def relaxed_wale_mm(self) -> float:
        """Height of the mean stitch at rest."""
        return self.wale.relaxed_mm


def _not_negative(field: str, values: ArrayLike) -> Array:
    remedy = "Give, for example, 0, 0.1, 0.2."
    array = as_numbers(field, values, remedy)
    if not np.all(np.isfinite(array)) or np.any(array < 0):
        raise InputError(field, "must be finite and at least 0.", remedy)
    return array
