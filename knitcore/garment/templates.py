"""Templates for limbs: tubes from a circumference profile, and a brace knitted sideways."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from knitcore.base.bounds import check_range
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.garment.gauge import GaugeSet
from knitcore.garment.plan import GarmentPlan, OutlinePart, make_plan
from knitcore.garment.worn_piece import Fit, Worn, worn
from knitcore.materials import Material

MAX_CHANGE = 2
"""Largest number of stitches that a row gains or loses: one at each edge."""
SNUG = Fit()
KEEPS = 0.2
"""How far an edge may be off the target, as a share, and still keep to it."""
PLACES = 5
"""Number of positions along a limb at which the pressure is given, besides those measured."""


@dataclass(frozen=True)
class Girth:
    """Circumference of a limb at a distance along it, both in mm."""

    at_mm: float
    circumference_mm: float


def limb_tube(
    name: str,
    profile: Sequence[Girth],
    material: Material,
    *,
    fit: Fit = SNUG,
    gauges: GaugeSet | None = None,
    body: Fabric = Fabric.STOCKINETTE,
    hem: Fabric = Fabric.RIB,
    hem_mm: float = 40.0,
    notes: tuple[str, ...] = (),
    linear_density_tex: float | None = None,
) -> GarmentPlan:
    """A tube along a limb, worked in the round or flat and seamed; courses run around the limb.

    Parameters
    ----------
    name : of the garment.
    profile : circumferences along the limb, from where the knitting begins.
    material : gives the laws for the pressure.
    fit : ease, or a target pressure of the body, which may change along the limb.
    gauges : the knitter's; by default the material's own. Sizes follow the body's fabric.
    body, hem : fabrics of the middle, and of the first and last ``hem_mm``.
    notes : added to the plan's own.
    linear_density_tex : for the mass of yarn.

    Raises
    ------
    InputError
        If the profile or the fit cannot be used.
    """
    _check_profile(profile)
    gauges = gauges or GaugeSet.of_material(material)
    gauge = gauges[body]
    length = profile[-1].at_mm - profile[0].at_mm
    rows = gauge.rows_for(length)
    at = (np.arange(rows) + 0.5) * length / rows
    places = [g.at_mm - profile[0].at_mm for g in profile]
    girths = [g.circumference_mm for g in profile]
    bends = [at - profile[0].at_mm for at in fit.places_mm]
    sized = sorted({*places, *(at for at in bends if 0 < at < length)})
    rests = [
        fit.rest_mm(
            float(np.interp(along, places, girths)),
            material,
            body,
            Direction.COURSE,
            at_mm=along + profile[0].at_mm,
        )
        for along in sized
    ]
    # Even counts: shaping is symmetrical, and 1x1 rib closes around the limb.
    counts = [gauge.stitches_for(float(c), multiple=2) for c in np.interp(at, sized, rests)]
    shaped = _limit_changes(counts)
    columns = max(shaped)
    column = np.arange(columns)
    left = (columns - np.array(shaped)) // 2
    stitch = (column >= left[:, None]) & (column < columns - left[:, None])
    hem_rows = min(gauge.rows_for(hem_mm), rows // 3) if hem_mm > 0 else 0
    row = np.broadcast_to(np.arange(rows)[:, None], stitch.shape)
    parts = (
        OutlinePart("lower ribbing", row < hem_rows, hem),
        OutlinePart("body", (row >= hem_rows) & (row < rows - hem_rows), body),
        OutlinePart("upper ribbing", row >= rows - hem_rows, hem),
    )

    def place(along: float) -> Worn:
        index = min(int(along / length * rows), rows - 1)
        part = next(p for p in parts if p.cells[index, 0])
        rest = shaped[index] * gauges[part.fabric].stitch_course_mm
        return worn(
            material,
            part.fabric,
            Direction.COURSE,
            rest,
            float(np.interp(along, places, girths)),
            at_mm=along,
            part=part.name,
        )

    pressed = [place(along) for along in sorted({*sized, *np.linspace(0, length, PLACES).tolist()})]
    ribbed = [w for w in (pressed[0], pressed[-1]) if w.part != "body"]
    off = [n for w in ribbed if (n := _off_target(w, fit.mmhg_at(w.at_mm + profile[0].at_mm)))]
    return make_plan(
        name,
        stitch,
        parts,
        material,
        gauges,
        around=Direction.COURSE,
        worn=tuple(pressed),
        closing="work in the round, or work flat and seam the edges",
        notes=notes,
        cautions=(*_too_fast(counts, shaped), *off),
        linear_density_tex=linear_density_tex,
    )


def _off_target(place: Worn, mmhg: float | None, body: str = "body") -> str:
    """A caution if an edge, which has the stitches of the body, misses its target pressure."""
    if mmhg is None:
        return ""
    wish = f"The {place.part} does not keep to the {mmhg:.0f} mmHg of the {body}"
    remedy = f"Knit it in the fabric of the {body} to keep to it."
    if place.pressure is None:
        return f"{wish}: {place.problem} {remedy}"
    low, high = place.pressure.mmhg.low, place.pressure.mmhg.high
    if low / (1 + KEEPS) <= mmhg <= high * (1 + KEEPS):
        return ""
    ends = dict.fromkeys((f"{low:.0f}", f"{high:.0f}"))
    return f"{wish}: it presses by {' to '.join(ends)} mmHg. {remedy}"


def _too_fast(counts: list[int], shaped: list[int]) -> list[str]:
    """A caution if the limb changes faster than rows can gain or lose stitches."""
    if shaped == counts:
        return []
    row = max(range(len(counts)), key=lambda row: abs(shaped[row] - counts[row]))
    return [
        f"The limb widens faster than one stitch at each edge of a row: row {row + 1} has "
        f"{shaped[row]} stitches instead of {counts[row]}."
    ]


def sock_leg(
    ankle_mm: float,
    calf_mm: float,
    length_mm: float,
    material: Material,
    *,
    fit: Fit = SNUG,
    gauges: GaugeSet | None = None,
    body: Fabric = Fabric.STOCKINETTE,
    hem: Fabric = Fabric.RIB,
    linear_density_tex: float | None = None,
) -> GarmentPlan:
    """The leg of a sock from the ankle up to the calf, with ribbing at both ends."""
    profile = (Girth(0.0, ankle_mm), Girth(length_mm / 3, ankle_mm), Girth(length_mm, calf_mm))
    return limb_tube(
        "sock leg",
        profile,
        material,
        fit=fit,
        gauges=gauges,
        body=body,
        hem=hem,
        notes=(
            "The leg only: a heel is turned with short rows and a foot is a tube of its own, which "
            "a chart of whole rows cannot show. Knit them from the stitches at the ankle.",
        ),
        linear_density_tex=linear_density_tex,
    )


def wrist_brace(
    wrist_mm: float,
    length_mm: float,
    material: Material,
    *,
    fit: Fit = SNUG,
    gauges: GaugeSet | None = None,
    edge_mm: float = 15.0,
    support: Fabric = Fabric.STOCKINETTE,
    edge: Fabric = Fabric.GARTER,
    linear_density_tex: float | None = None,
) -> GarmentPlan:
    """A brace knitted sideways and grafted, so that wales, stockinette's stiff direction, go
    around.

    Parameters
    ----------
    wrist_mm : circumference of the wrist.
    length_mm : along the arm.
    material : gives the law for the pressure.
    fit : ease, or a target pressure.
    gauges : the knitter's; by default the material's own.
    edge_mm : width of the edges, which stretch around the arm.
    support, edge : fabrics of the middle and of the edges.
    linear_density_tex : for the mass of yarn.
    """
    _check_length("wrist_mm", wrist_mm)
    _check_length("length_mm", length_mm)
    gauges = gauges or GaugeSet.of_material(material)
    gauge = gauges[support]
    rest = fit.rest_mm(wrist_mm, material, support, Direction.WALE, at_mm=length_mm / 2)
    rows = gauge.rows_for(rest, multiple=2)
    columns = gauge.stitches_for(length_mm)
    wide = min(gauge.stitches_for(edge_mm), columns // 3) if edge_mm > 0 else 0
    column = np.broadcast_to(np.arange(columns), (rows, columns))
    parts = (
        OutlinePart("edge at the forearm", column < wide, edge),
        OutlinePart("support", (column >= wide) & (column < columns - wide), support),
        OutlinePart("edge at the hand", column >= columns - wide, edge),
    )
    edge_mm = wide * gauge.stitch_course_mm
    pressed = [
        worn(
            material,
            part.fabric,
            Direction.WALE,
            rows * gauges[part.fabric].stitch_wale_mm,
            wrist_mm,
            at_mm=at,
            part=part.name,
        )
        for part, at in zip(
            parts, (edge_mm / 2, length_mm / 2, length_mm - edge_mm / 2), strict=True
        )
        if part.cells.any()
    ]
    mmhg = fit.mmhg_at(length_mm / 2)
    edges = [w for w in pressed if w.part != "support"]
    return make_plan(
        "wrist brace",
        np.ones((rows, columns), dtype=bool),
        parts,
        material,
        gauges,
        around=Direction.WALE,
        worn=tuple(pressed),
        closing="graft the last row to the first",
        cautions=tuple(n for w in edges if (n := _off_target(w, mmhg, "support"))),
        linear_density_tex=linear_density_tex,
    )


def _limit_changes(counts: Sequence[int]) -> list[int]:
    """The largest counts that never exceed these and change slowly enough."""
    limited = list(counts)
    for order in (range(1, len(limited)), range(len(limited) - 2, -1, -1)):
        for row in order:
            before = limited[row - order.step]
            limited[row] = min(limited[row], before + MAX_CHANGE)
    return limited


def _check_profile(profile: Sequence[Girth]) -> None:
    if len(profile) < 2:
        raise InputError("profile", "it has no length.", "Give at least two circumferences.")
    for before, after in pairwise(profile):
        if not after.at_mm > before.at_mm:
            problem = f"{after.at_mm:g} mm does not come after {before.at_mm:g} mm."
            raise InputError("profile", problem, "Give positions in rising order.")
    for girth in profile:
        _check_length("profile", girth.circumference_mm)
    _check_length("profile", profile[-1].at_mm - profile[0].at_mm)


def _check_length(name: str, value: float) -> None:
    check_range(name, value, 5, 2000, "mm", "a length that can be knitted")
