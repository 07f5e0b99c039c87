"""What the 3D view shows of a design."""

from __future__ import annotations

from enum import StrEnum

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from app.operations.charts import ChartInput, to_chart
from app.operations.stretch import StretchRun
from app.viewer.colours import diverging, fabric_mix, sequential
from app.viewer.fabric import FabricScene
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import PHASES, Direction
from knitcore.geometry.lattice import flat_lattice
from knitcore.geometry.placing import at_rest, carried
from knitcore.geometry.stitches import stitch_shapes
from knitcore.materials import Material
from knitcore.materials import material as find_material
from knitcore.mechanics.local import stitch_table
from knitcore.phases import surroundings


class Colour(StrEnum):
    """What the colours of the loops mean."""

    FABRIC = "fabric"
    COURSE = "course"
    WALE = "wale"
    ANISOTROPY = "anisotropy"
    STRAIN = "strain"
    UTILISATION = "utilisation"


class StretchStep(BaseModel):
    """A state of a stretch test that was run before."""

    model_config = ConfigDict(extra="forbid")

    id: str = Field(max_length=128, description="The id that the stretch test returned.")
    step: int = Field(ge=0)


class ViewRequest(BaseModel):
    """A design and how to show it."""

    model_config = ConfigDict(extra="forbid")

    chart: ChartInput
    material: str
    colour: Colour = Colour.FABRIC
    rectangles: bool = False
    stretch: StretchStep | None = None


class ViewResult(BaseModel):
    """What is shown, and where."""

    stitches: int = Field(description="Stitches drawn as loops.")
    url: str


def build_scene(request: ViewRequest, stretch: StretchRun | None) -> FabricScene:
    """The scene of a design, relaxed or at one step of its stretch test.

    Raises
    ------
    InputError
        If the test is not known any more, or belongs to another chart.
    """
    chart, material = to_chart(request.chart), find_material(request.material)
    shapes = stitch_shapes(chart, material)
    placement = at_rest(shapes)
    step = _checked_step(request, stretch, chart)
    if stretch is not None:
        centres = stretch.positions_mm[step].astype(float)
        placement = carried(shapes, centres, flat_lattice(chart, material))
    return FabricScene(
        shapes=shapes,
        placement=placement,
        colours=_colours(request.colour, chart, material, stretch, step),
        rectangles_mm=_rectangles_mm(chart, material) if request.rectangles else None,
    )


def _checked_step(request: ViewRequest, stretch: StretchRun | None, chart: StitchChart) -> int:
    if request.stretch is None:
        if request.colour in (Colour.STRAIN, Colour.UTILISATION):
            raise InputError("colour", "needs a stretch test.", "Run one and name its step.")
        return 0
    if stretch is None:
        raise InputError("stretch.id", "is not known any more.", "Run the stretch test again.")
    steps, rows, columns = stretch.positions_mm.shape[:3]
    if (rows, columns) != (chart.rows, chart.columns):
        raise InputError("stretch.id", "belongs to another chart.", "Run the test for this one.")
    if request.stretch.step >= steps:
        raise InputError("stretch.step", "is beyond the test.", f"Use 0 to {steps - 1}.")
    return request.stretch.step


def _colours(
    colour: Colour,
    chart: StitchChart,
    material: Material,
    stretch: StretchRun | None,
    step: int,
) -> NDArray[np.uint8]:
    table, codes = stitch_table(material), surroundings(chart)
    if colour is Colour.FABRIC:
        return fabric_mix(table.fractions)[codes]
    if colour is Colour.COURSE:
        values = table.modulus_course_n_per_mm
        return sequential(values, values.min(), values.max(), log=True)[codes]
    if colour is Colour.WALE:
        values = table.modulus_wale_n_per_mm
        return sequential(values, values.min(), values.max(), log=True)[codes]
    if colour is Colour.ANISOTROPY:
        ratio = np.log(table.modulus_course_n_per_mm / table.modulus_wale_n_per_mm)
        return diverging(ratio, float(np.abs(ratio).max()))[codes]
    assert stretch is not None  # noqa: S101 - checked with the step
    if colour is Colour.UTILISATION:
        return sequential(stretch.utilisation[step], 0.0, 1.0)
    strain = stretch.strain[step][..., stretch.direction.axis]
    most = float(np.abs(stretch.strain[..., stretch.direction.axis]).max())
    return diverging(strain, most)


def _rectangles_mm(chart: StitchChart, material: Material) -> NDArray[np.float64]:
    """Extensibility rectangles (Fig. 4d) scaled so that the largest side fills 90 % of a stitch."""
    table = stitch_table(material)
    sides = np.stack(
        [
            table.extensibility_mm_per_n(Direction.COURSE),
            table.extensibility_mm_per_n(Direction.WALE),
        ],
        axis=-1,
    )[surroundings(chart)]
    smallest = min(
        min(material.record(f).stitch_course_mm, material.record(f).stitch_wale_mm) for f in PHASES
    )
    rectangles: NDArray[np.float64] = sides / sides.max() * 0.9 * smallest
    return rectangles
