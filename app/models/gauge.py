"""A knitter's gauge in requests."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from app.models.base import RequestModel
from app.models.laws import FabricRequest
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


class GaugedRequest(FabricRequest):
    """A chart of a material, and how somebody knits it."""

    gauge: GaugeInput | None = Field(
        None, description="Measured gauge of the chart; its relaxed size is estimated if left out."
    )

    @property
    def relaxed_size(self) -> RelaxedSize | None:
        """The relaxed size of one stitch, if the gauge was measured."""
        return self.gauge.relaxed_size() if self.gauge else None
