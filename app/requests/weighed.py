"""Requests that need the yarn's weight, and corners in answers."""

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from knitcore.base.arrays import Array
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space.even_cloth import EvenCloth, cloth_of

from ..context import Context
from .charts import MaterialName
from .fabrics import Gauged, LawsRequest

LinearDensity = Annotated[
    float,
    Field(
        gt=0,
        le=20,
        description="Linear density of the yarn, g/m (tex divided by 1000): weigh some metres.",
    ),
]
Corner = tuple[float, float, float] | None
Corners = Annotated[
    list[list[Corner]] | None,
    Field(description="Corners of the sheet line by line, mm; null outside the piece."),
]
WantsCorners = Annotated[bool, Field(description="Also return the corners of the sheet.")]
TimeLimit = Annotated[
    float,
    Field(
        gt=0,
        le=600,
        description="CPU time after which the current shape is returned, not converged.",
    ),
]
FRICTIONLESS = (
    "Friction is left out, and so is what washing or pressing sets. Friction makes real "
    "fabric seem stiffer, and can hold it in more than one shape."
)


class WeighedRequest(Gauged, LawsRequest):
    """A material, the weight of its yarn, and how somebody knits it."""

    material: MaterialName
    linear_density_g_per_m: LinearDensity

    def cloth(self, repeat: StitchChart, context: Context) -> EvenCloth:
        """Cloth of the repeat whose gauge the request may have."""
        return self.pass_to(
            cloth_of, repeat, context.material(self.material), size=self.relaxed_size
        )


def corner_lists(corners_mm: Array, there: NDArray[np.bool_]) -> list[list[Corner]]:
    """Corners (lines, points, 3) as an answer has them, null where there are none."""
    lines = zip(corners_mm.round(3).tolist(), there.tolist(), strict=True)
    return [
        [tuple(at) if known else None for at, known in zip(*line, strict=True)] for line in lines
    ]
