"""A knitter's gauge in requests."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from app.models.base import RequestModel
from knitcore.answer.relaxed import RelaxedSize

Count = Annotated[
    float,
    Field(
        gt=0,
        le=1000,
        description="Counted on your own relaxed swatch; give stitches and rows, or neither.",
    ),
]


class GaugeInput(RequestModel):
    """The gauge of a swatch, counted on your own relaxed cloth."""

    stitches_per_10_cm: Count
    rows_per_10_cm: Count

    def relaxed_size(self) -> RelaxedSize:
        """The relaxed size of one stitch."""
        return RelaxedSize.from_gauge(self.stitches_per_10_cm, self.rows_per_10_cm)
