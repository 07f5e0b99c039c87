"""A design in the 3D view."""

import math
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, Field

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.draw.instances import MAX_STITCHES
from knitcore.draw.lattice import flat_lattice
from knitcore.draw.looped import shapes_of
from knitcore.draw.placing import PlacedStitches, carried, lying, unstretched
from knitcore.draw.rectangles import extensibility_rectangles, stitch_labels
from knitcore.formats.designs.layout import DesignRegion
from knitcore.garment.shaped import outline_marks
from knitcore.materials import Material

from ..context import Context
from ..requests.base import RequestModel
from ..requests.charts import (
    AnyChartInput,
    Column,
    MaterialName,
    OutlineInput,
    Row,
    size_of_chart,
    to_stitches,
)
from ..requests.fabrics import Gauged
from .computed import PosedView, StretchView
from .fabric import FabricScene
from .stitch_colours import Colour, FieldColours, Palette, region_labels, stitch_colours

MAX_REGIONS = 200
MAX_LETTERS = 41_000
"""Letters, with line ends, of the largest chart whose stitches the service lays itself. Such a
chart is drawn whole, which takes 0.1 s of CPU and 25 MB."""


class RectangleGroups(StrEnum):
    """Part of the fabric that one extensibility rectangle stands for."""

    STITCH = "stitch"
    BLOCK = "block"
    REGION = "region"


class StretchStep(RequestModel):
    """A state of a stretch test that was run before."""

    id: str = Field(max_length=128, description="The id that the stretch test returned.")
    step: int = Field(ge=0)


class Curled(RequestModel):
    """The shape of a piece that was computed before."""

    id: str = Field(
        max_length=128, description="The id that `curl`, `hang`, `limb` or `glove` returned."
    )


class Focus(RequestModel):
    """A stitch."""

    row: Row
    column: Column


class ViewRequest(Gauged):
    """A design and how to show it."""

    chart: AnyChartInput
    material: MaterialName
    outline: OutlineInput = None
    colour: Colour = Colour.FABRIC
    field: FieldColours | None = Field(None, description="Values for the colour `field`.")
    regions: list[DesignRegion] = Field(
        [],
        max_length=MAX_REGIONS,
        description="Regions of the design, for the colours `yarn` and `region`.",
    )
    palette: Palette = Palette()
    rectangles: bool = False
    rectangle_groups: RectangleGroups = RectangleGroups.STITCH
    rectangle_block: int = Field(4, ge=1, le=400, description="Stitches on a side of a block.")
    stretch: StretchStep | None = None
    curl: Curled | None = Field(
        None,
        description="Show the fabric as it lies, hangs or is worn; not together with `stretch`.",
    )
    focus: Focus | None = Field(
        None,
        description="Stitch around which a chart too large to be drawn whole is drawn as yarn.",
    )


class ViewResult(BaseModel):
    """The view of a design and its address."""

    stitches: int = Field(description="Stitches drawn as yarn.")
    source: str = Field(description="Source of the stitches' shapes.")
    scale_mm: float = Field(description="Length of the line below the fabric.")
    url: str = Field(
        description="Address of the view for a browser; the pass to watch it follows the #."
    )


def is_large(request: ViewRequest) -> bool:
    """Return whether a worker should lay the stitches of the chart.

    Such a chart is not drawn whole, and no stretch test is as large.
    """
    return size_of_chart(request.chart) > MAX_LETTERS


def build_scene(
    request: ViewRequest, computed: StretchView | PosedView | None, context: Context
) -> FabricScene:
    """The scene of a design: flat, in a shape of its own, or at one step of its stretch test.

    Stitches other than knit and purl have the colours of the purl map.

    Raises
    ------
    InputError
        If the test or the shape is not known any more, or belongs to another chart.
    """
    stitches, material = to_stitches(request.chart), context.material(request.material)
    chart = stitches if isinstance(stitches, StitchChart) else stitches.plain
    drawn = _drawn(request, chart)
    stretch = computed if isinstance(computed, StretchView) else None
    posed = _posed(request, computed, chart)
    step = _checked_step(request, stretch, chart)
    shapes = shapes_of(stitches, material, folded=posed is None)
    if (size := request.relaxed_size) is not None:
        shapes = shapes.resized(size, drawn)
    placement, room = unstretched(shapes), None
    if posed is not None:
        placement = lying(posed.corners_mm.astype(float))
    if stretch is not None:
        centres = stretch.positions_mm[step].astype(float)
        placement = carried(shapes, centres, flat_lattice(chart, material))
        room = np.ptp(stretch.positions_mm, axis=(1, 2)).max(axis=0).astype(float)
    colours = request.pass_to(
        stitch_colours,
        request.colour,
        chart,
        material,
        stretch=stretch,
        step=step,
        mmhg=None if posed is None else posed.mmhg,
    )
    return FabricScene(
        shapes=shapes,
        placement=placement,
        colours=colours,
        drawn=drawn,
        rectangles_mm=_rectangles(request, chart, material, placement, drawn),
        focus=(request.focus.row, request.focus.column) if request.focus else None,
        room_mm=room,
        body=None if posed is None else posed.body,
    )


def _posed(
    request: ViewRequest, computed: StretchView | PosedView | None, chart: StitchChart
) -> PosedView | None:
    if request.curl is None:
        return None
    if request.stretch is not None:
        raise InputError("curl", "stretch is given as well.", "Give one of the two.")
    if not isinstance(computed, PosedView):
        raise InputError("curl.id", "is not known any more.", "Compute the shape again.")
    if computed.corners_mm.shape[:2] != (chart.rows + 1, chart.columns + 1):
        raise InputError("curl.id", "belongs to another chart.", "Compute it for this one.")
    return computed


def _checked_step(request: ViewRequest, stretch: StretchView | None, chart: StitchChart) -> int:
    if request.stretch is None:
        return 0
    if stretch is None:
        raise InputError("stretch.id", "is not known any more.", "Run the stretch test again.")
    steps, rows, columns = stretch.positions_mm.shape[:3]
    if (rows, columns) != (chart.rows, chart.columns):
        raise InputError("stretch.id", "belongs to another chart.", "Run the test for this one.")
    if request.stretch.step >= steps:
        raise InputError("stretch.step", "is beyond the test.", f"Use 0 to {steps - 1}.")
    return request.stretch.step


def _drawn(request: ViewRequest, chart: StitchChart) -> NDArray[np.bool_] | None:
    """Mask of the stitches; an outline in several parts is shown as it is."""
    if request.outline is None:
        return None
    drawn = outline_marks(request.outline)
    if drawn.shape != chart.purl.shape or not drawn.any():
        raise InputError(
            "outline",
            "it does not fit the chart.",
            f"Give {chart.rows} lines of {chart.columns} x or dots, one x at least.",
        )
    return drawn


def _rectangles(
    request: ViewRequest,
    chart: StitchChart,
    material: Material,
    placement: PlacedStitches,
    drawn: NDArray[np.bool_] | None,
) -> NDArray[np.float64] | None:
    if not request.rectangles or placement.frames is not None:
        return None
    if request.rectangle_groups is RectangleGroups.REGION:
        labels = region_labels(chart, request.regions)
    else:
        single = request.rectangle_groups is RectangleGroups.STITCH
        block = 1 if single else request.rectangle_block
        if chart.stitches > block**2 * MAX_STITCHES:
            raise InputError(
                "rectangle_block",
                f"the chart is too large for a rectangle at each {block} × {block} stitches.",
                f"Use blocks of {math.ceil((chart.purl.size / MAX_STITCHES) ** 0.5)} or more.",
            )
        labels = stitch_labels(chart.rows, chart.columns, block)
    if drawn is not None:
        labels = np.where(drawn, labels, -1)
    return extensibility_rectangles(chart, material, placement, labels)
