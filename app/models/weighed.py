"""Requests that need the yarn's weight, and corners in answers."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from app.models.base import RequestModel
from app.models.charts import MaterialName

LinearDensity = Annotated[
    float,
    Field(gt=0, le=20, description="Of the yarn, g/m: weigh some metres; tex divided by 1000."),
]
Corner = tuple[float, float, float] | None
Corners = Annotated[
    list[list[Corner]] | None,
    Field(description="Corners of the sheet line by line, mm; null outside the piece."),
]
WantsCorners = Annotated[bool, Field(description="Also return the corners of the sheet.")]
FRICTIONLESS = (
    "Without friction and set. Friction makes real fabric seem stiffer, and keeps it in more than "
    "one shape."
)
CURLS = (
    "This fabric curls. It was taken as flat at rest, as if its edges were pressed: the test is "
    "not meant for fabric that rolls up."
)


class WeighedRequest(RequestModel):
    """A material and the weight of its yarn."""

    material: MaterialName
    linear_density_g_per_m: LinearDensity
