"""The colours of the stitches in the 3D view, by quantity."""

from collections.abc import Sequence
from enum import StrEnum
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.fabric import PHASES, Direction, Fabric
from knitcore.chart.phases import surroundings
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.flat.strip_results import TAUT
from knitcore.formats.designs.layout import Colour as HexColour
from knitcore.formats.designs.layout import DesignRegion
from knitcore.materials import Material
from knitcore.mechanics.local_moduli import StitchTable, stitch_table

from ..requests.base import RequestModel
from ..requests.charts import MAX_FIELD
from .colours import FABRIC_COLOURS, diverging, fabric_mix, named_colour, rgb, sequential
from .computed import StretchView

Colours = NDArray[np.uint8]

TAUT_SCALE = 0.7
"""Share of the colour map up to which a stitch that has stretch left is coloured: to orange."""
TAUT_COLOUR = (214, 30, 36)
"""Colour of stitches without stretch left, a warning; the page uses the same."""


class Colour(StrEnum):
    """The quantity that colours the stitches."""

    YARN = "yarn"
    REGION = "region"
    FABRIC = "fabric"
    PHASE = "phase"
    COURSE = "course"
    WALE = "wale"
    ANISOTROPY = "anisotropy"
    STRAIN = "strain"
    UTILISATION = "utilisation"
    PRESSURE = "pressure"
    FIELD = "field"


class Palette(RequestModel):
    """Colours that carry a meaning; the page sends those of its theme."""

    yarn: HexColour | None = Field(
        None, description="Colour of the yarn; by default that of its name."
    )
    stockinette: HexColour = f"#{FABRIC_COLOURS[Fabric.STOCKINETTE]}"
    garter: HexColour = f"#{FABRIC_COLOURS[Fabric.GARTER]}"
    rib: HexColour = f"#{FABRIC_COLOURS[Fabric.RIB]}"
    seed: HexColour = f"#{FABRIC_COLOURS[Fabric.SEED]}"

    def fabrics(self) -> Colours:
        """(4, 3) in the order of the phase codes."""
        return np.array([rgb(getattr(self, fabric.value)) for fabric in PHASES], dtype=np.uint8)


class FieldColours(RequestModel):
    """Any value of each stitch on a colour map."""

    values: list[float] = Field(
        max_length=MAX_FIELD,
        description="Values row by row from the bottom, each row from the left.",
    )
    low: float
    high: float
    log: bool = False
    map: Literal["batlow", "vik"] = "batlow"


def stitch_colours(
    colour: Colour,
    chart: StitchChart,
    material: Material,
    *,
    palette: Palette,
    regions: Sequence[DesignRegion],
    field: FieldColours | None,
    stretch: StretchView | None,
    step: int,
    mmhg: NDArray[np.float32] | None,
) -> Colours:
    """Colour of every stitch, (rows, columns, 3).

    Raises
    ------
    InputError
        If the field has another number of values than the chart stitches.
    """
    if colour in (Colour.YARN, Colour.REGION):
        every = colour is Colour.REGION
        own = (
            rgb(palette.yarn)
            if palette.yarn
            else named_colour(f"{material.name} {material.yarn.product}")
        )
        return _regions(chart, [r for r in regions if every or r.yarn is not None], own)
    if colour is Colour.FIELD:
        return _field(chart, field)
    if colour in (Colour.STRAIN, Colour.UTILISATION):
        return _stretched(colour, stretch, step)
    if colour is Colour.PRESSURE:
        if mmhg is None:
            raise InputError("colour", "needs a tube on a limb.", "Compute one and name its id.")
        most = float(mmhg[np.isfinite(mmhg)].max(initial=0.0)) or 1.0
        return sequential(np.nan_to_num(mmhg, posinf=most), 0.0, most)
    return _kinds(colour, stitch_table(material), palette)[surroundings(chart)]


def _kinds(colour: Colour, table: StitchTable, palette: Palette) -> Colours:
    """(16, 3) colours of the kinds of stitch."""
    if colour is Colour.FABRIC:
        return fabric_mix(table.fractions, palette.fabrics())
    if colour is Colour.PHASE:
        strongest: Colours = palette.fabrics()[table.fractions.argmax(axis=1)]
        return strongest
    if colour is Colour.ANISOTROPY:
        ratio = np.log(table.anisotropy)
        return diverging(ratio, float(np.abs(ratio).max()))
    values = table.modulus_n_per_mm(Direction(colour.value))
    return sequential(values, values.min(), values.max(), log=True)


def _stretched(colour: Colour, stretch: StretchView | None, step: int) -> Colours:
    if stretch is None:
        raise InputError("colour", "needs a stretch test.", "Run one and name its step.")
    if colour is Colour.UTILISATION:
        used = stretch.utilisation[step]
        colours = sequential(used, 0.0, 1.0 / TAUT_SCALE)
        colours[used >= TAUT] = TAUT_COLOUR
        return colours
    along = stretch.strain[..., stretch.direction.axis]
    return diverging(along[step], float(np.abs(along).max()))


def region_labels(chart: StitchChart, regions: Sequence[DesignRegion]) -> NDArray[np.intp]:
    """(rows, columns) number of the topmost visible region at each stitch; -1 where none is.

    Raises
    ------
    InputError
        If a run reaches beyond the chart.
    """
    labels = np.full((chart.rows, chart.columns), -1, dtype=np.intp)
    for number, region in enumerate(regions):
        if region.hidden:
            continue
        for row, column, length in region.runs:
            if row >= chart.rows or column + length > chart.columns:
                raise InputError(
                    "regions",
                    f"{region.name!r} reaches beyond the chart in row {row + 1}.",
                    "Keep its runs inside the chart.",
                )
            labels[row, column : column + length] = number
    return labels


def _regions(
    chart: StitchChart, regions: Sequence[DesignRegion], own: tuple[int, int, int]
) -> Colours:
    colours = np.array([own, *(rgb(r.colour) for r in regions)], dtype=np.uint8)
    return colours[region_labels(chart, regions) + 1]


def _field(chart: StitchChart, field: FieldColours | None) -> Colours:
    if field is None or len(field.values) != chart.stitches:
        raise InputError(
            "field",
            "does not have one value for each stitch.",
            f"Send {chart.stitches} values, row by row from the bottom.",
        )
    values = np.array(field.values).reshape(chart.rows, chart.columns)
    if field.log and (min(field.low, field.high) <= 0 or values.min() <= 0):
        raise InputError(
            "field",
            "has values that are not positive, on a logarithmic scale.",
            "Send positive ones.",
        )
    if field.map == "vik":
        return diverging(values, max(abs(field.low), abs(field.high)))
    return sequential(values, field.low, field.high, log=field.log)
