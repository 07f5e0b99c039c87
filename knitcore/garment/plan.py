"""A garment plan: outline, regions, and the numbers that follow from them."""

from dataclasses import dataclass

from knitcore.base.arrays import Mask
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart
from knitcore.garment.gauge import GaugeSet
from knitcore.garment.regions import (
    Region,
    RegionMisfit,
    RegionNumbers,
    YarnUse,
    fill_regions,
    misfits,
    region_numbers,
    yarn_use,
)
from knitcore.garment.shaped import ShapedChart
from knitcore.garment.worn_piece import Worn
from knitcore.materials import Material
from knitcore.mechanics.pressure import too_tight_parts

FABRIC_COLOURS = {
    Fabric.STOCKINETTE: "#3b6fb6",
    Fabric.GARTER: "#d9822b",
    Fabric.RIB: "#3f9b5b",
    Fabric.SEED: "#8a5ea8",
}


@dataclass(frozen=True, eq=False, repr=False)
class GarmentPlan(Result):
    """A garment, ready to be edited as a chart.

    Attributes
    ----------
    name : of the template.
    shaped : chart and outline.
    regions : its parts.
    fabrics : of the regions.
    gauges : of its fabrics.
    around : the direction of the material that runs around the limb.
    worn : its pressure, place by place; empty where the limb is not known.
    closing : how the piece is closed, in words.
    notes : for the knitter.
    cautions : for the designer: what the plan cannot do, and what to change.
    misfits : borders between regions of different gauge.
    numbers : extensibility by region.
    yarn : length and mass needed.
    """

    name: str
    shaped: ShapedChart
    regions: tuple[Region, ...]
    fabrics: tuple[Fabric, ...]
    gauges: GaugeSet
    around: Direction
    worn: tuple[Worn, ...]
    closing: str
    notes: tuple[str, ...]
    cautions: tuple[str, ...]
    misfits: tuple[RegionMisfit, ...]
    numbers: tuple[RegionNumbers, ...]
    yarn: YarnUse

    def yarn_of(
        self, region: Region, material: Material, linear_density_tex: float | None = None
    ) -> YarnUse:
        """The size and yarn of one region."""
        return yarn_use(
            self.shaped, material, linear_density_tex=linear_density_tex, cells=region.cells,
            measured=self.gauges.measured_yarn, length_factor=self.gauges.length_factor,
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class OutlinePart:
    """A named part of an outline in one pure fabric, before it is filled."""

    name: str
    cells: Mask
    fabric: Fabric


def make_plan(
    name: str,
    stitch: Mask,
    parts: tuple[OutlinePart, ...],
    material: Material,
    gauges: GaugeSet,
    *,
    around: Direction,
    closing: str,
    worn: tuple[Worn, ...] = (),
    notes: tuple[str, ...] = (),
    cautions: tuple[str, ...] = (),
    linear_density_tex: float | None = None,
) -> GarmentPlan:
    """Fill an outline and compute its numbers.

    Raises
    ------
    InputError
        If the outline, the regions or the material cannot be used.
    """
    used = tuple(part for part in parts if (part.cells & stitch).any())
    regions = tuple(
        Region(p.name, p.cells, StitchChart.of_fabric(p.fabric).repeat(), FABRIC_COLOURS[p.fabric])
        for p in used
    )
    sizes = [gauges[part.fabric] for part in used]
    shaped = fill_regions(stitch, regions)
    return GarmentPlan(
        name=name,
        shaped=shaped,
        regions=regions,
        fabrics=tuple(part.fabric for part in used),
        gauges=gauges,
        around=around,
        worn=worn,
        closing=closing,
        notes=notes,
        cautions=(*_too_tight(worn), *cautions),
        misfits=misfits(regions, sizes, stitch),
        numbers=region_numbers(shaped, regions, material),
        yarn=yarn_use(
            shaped,
            material,
            linear_density_tex=linear_density_tex,
            measured=gauges.measured_yarn,
            length_factor=gauges.length_factor,
        ),
    )


def _too_tight(worn: tuple[Worn, ...]) -> tuple[str, ...]:
    """A warning that names the parts that press too hard."""
    return too_tight_parts([(place.part, place.highest_mmhg) for place in worn])
