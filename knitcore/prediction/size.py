"""A known relaxed size."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array, Mask
from knitcore.base.bounds import check_positive, check_range
from knitcore.base.choice import Choice
from knitcore.base.kinds import check_kind
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result


class KnownBy(Choice):
    """How a relaxed size became known."""

    GAUGE = "gauge"
    RELAXATION = "relaxation"

    @property
    def errors(self) -> str:
        """Name the source of the interval of such a size, in words."""
        return _ERRORS[self]


_ERRORS = {
    KnownBy.GAUGE: "the gauge as given",
    KnownBy.RELAXATION: "how far yarn-level charts of the same densities differ",
}


@dataclass(frozen=True)
class RelaxedSize(Result):
    """Relaxed size of one mean stitch of a chart.

    Attributes
    ----------
    course_mm, wale_mm : width and height.
    log_sd : standard deviation of their logarithms.
    known_by : a gauge counted on cloth, or a relaxation at the yarn level
        (:mod:`knitcore.prediction.swept`).

    Raises
    ------
    InputError
        If a size is not a positive number, or the standard deviation not from 0 to 1.
    """

    course_mm: float
    wale_mm: float
    log_sd: float = 0.03
    known_by: KnownBy = KnownBy.GAUGE

    def __post_init__(self) -> None:
        for name in ("course_mm", "wale_mm"):
            check_positive(name, getattr(self, name), "mm", "a stitch size", 500)
        check_range("log_sd", self.log_sd, 0, 1, what="a standard deviation of logarithms")
        object.__setattr__(self, "known_by", KnownBy.parse(self.known_by))

    @classmethod
    def from_gauge(cls, stitches_per_10_cm: float, rows_per_10_cm: float) -> RelaxedSize:
        """Take the size from the gauge of a swatch.

        Examples
        --------
        >>> RelaxedSize.from_gauge(25, 40).course_mm
        4.0
        """
        for name, value in (
            ("stitches_per_10_cm", stitches_per_10_cm),
            ("rows_per_10_cm", rows_per_10_cm),
        ):
            check_positive(name, value, what="a gauge")
        return cls(100 / stitches_per_10_cm, 100 / rows_per_10_cm)

    @property
    def stitches_per_10_cm(self) -> float:
        """Gauge along the rows."""
        return 100 / self.course_mm

    @property
    def rows_per_10_cm(self) -> float:
        """Gauge along the columns."""
        return 100 / self.wale_mm

    def extent_mm(self, direction: Direction) -> float:
        """Relaxed size along a direction, mm."""
        return direction.of(self.course_mm, self.wale_mm)

    def over(self, sizes_mm: Array, stitches: Mask | None = None) -> Array:
        """How much wider and higher it is than the mean stitch of a piece, (2,).

        All stitches of a piece whose mean stitch has this size are so much wider and higher than
        they were computed: this is the rule by which a counted gauge enters a piece.

        Parameters
        ----------
        sizes_mm : (rows, columns, 2) computed width and height.
        stitches : (rows, columns) False where the piece has none.
        """
        mean = sizes_mm.mean(axis=(0, 1), where=True if stitches is None else stitches[..., None])
        return np.asarray([self.course_mm, self.wale_mm] / mean)


def check_size(size: RelaxedSize) -> None:
    """Refuse what is no relaxed size.

    Raises
    ------
    InputError
    """
    remedy = "Give a RelaxedSize, such as RelaxedSize.from_gauge(22, 30)."
    check_kind("size", size, RelaxedSize, remedy)
