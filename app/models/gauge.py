"""A knitter's gauge in requests."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from pydantic import Field

from knitcore.prediction.size import KnownBy, RelaxedSize

from .base import RequestModel, ResultModel
from .laws import FabricRequest

Count = Annotated[
    float,
    Field(
        gt=0,
        le=1000,
        description="Counted on your own relaxed swatch; give stitches and rows, or neither.",
    ),
]


class GaugeInput(RequestModel):
    """The gauge of a chart: counted on your own relaxed cloth, or from a relaxation."""

    stitches_per_10_cm: Count
    rows_per_10_cm: Count
    log_sd: float = Field(
        RelaxedSize.log_sd,
        ge=0.001,
        le=1,
        description="Uncertainty of both numbers: standard deviation of their logarithms.",
    )
    known_by: KnownBy = Field(
        KnownBy.GAUGE, description="`relaxation` for the `gauge` in the result of `relax`."
    )

    def relaxed_size(self) -> RelaxedSize:
        """The relaxed size of one stitch."""
        size = RelaxedSize.from_gauge(self.stitches_per_10_cm, self.rows_per_10_cm)
        return replace(size, log_sd=self.log_sd, known_by=self.known_by)


class FoundGauge(ResultModel):
    """The gauge that a relaxation found; other requests take it as it is."""

    stitches_per_10_cm: float
    rows_per_10_cm: float
    log_sd: float
    known_by: KnownBy


class GaugedRequest(FabricRequest):
    """A chart of a material, and how somebody knits it."""

    gauge: GaugeInput | None = Field(
        None, description="Measured gauge of the chart; its relaxed size is estimated if left out."
    )

    @property
    def relaxed_size(self) -> RelaxedSize | None:
        """The relaxed size of one stitch, if the gauge was measured."""
        return self.gauge.relaxed_size() if self.gauge else None
