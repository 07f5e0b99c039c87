"""Points of stretch curves in requests and results, and the gauge of the swatch behind them."""

import json
from pathlib import Path
from typing import Annotated

from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.fabric import Direction, Fabric
from knitcore.measure.stretch_points import StretchPoint

from .base import RequestModel

Gauge = Annotated[float, Field(ge=3, le=300, description="Counted on the swatch at rest.")]


class PointModel(RequestModel):
    """A point of a stretch curve, the width free; strains with standard deviations."""

    fabric: Fabric
    direction: Direction
    force_n_per_mm: float = Field(gt=0, le=100)
    strain_along: float = Field(ge=0.02, le=5)
    strain_along_sd: float = Field(ge=0, le=5)
    strain_across: float = Field(ge=-1, le=5)
    strain_across_sd: float = Field(ge=0, le=5)

    def point(self) -> StretchPoint:
        """The point as the library takes it."""
        return StretchPoint(**dict(self))


@in_reading_time
def points_in(path: Path) -> list[PointModel]:
    """The points in a file of `knitcore measure photos`.

    Raises
    ------
    InputError
        If it is none.
    """
    try:
        return [PointModel.model_validate(row) for row in json.loads(path.read_text("utf-8"))]
    except (OSError, ValueError, TypeError) as error:
        remedy = "Give a file that `knitcore measure photos --out` wrote."
        raise InputError("points", f"{path.name} holds no points ({error}).", remedy) from None
