"""The glove on a hand of simple bodies: how its parts fit and press.

The hand has the measurements for which the glove is made: forearm, palm and base of the thumb are
straight in front and behind and round at the sides, fingers and thumb are cylinders with round
tips. Every loop of stitches around a part is as long as the part's girth, or as at rest where that
is more; along the hand the glove is held by crotches and tips. Pressure is that of a tube of the
part's fabric (:mod:`knitcore.garment.limb`).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array, Mask
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.in_space import ClothInSpace
from knitcore.chart.stitch_chart import StitchChart
from knitcore.garment.gauge import GaugeSet
from knitcore.garment.glove import (
    CROTCH_ROWS,
    EASE,
    STUDY_FABRICS,
    GirthAlong,
    GloveFabrics,
    GloveLayout,
    Hand,
    PartOnHand,
    glove,
    parts_on_hand,
)
from knitcore.garment.limb import LimbPlace, place_on
from knitcore.garment.plan import GarmentPlan
from knitcore.materials import Material
from knitcore.prediction.predict import predict
from knitcore.prediction.prediction import Prediction

SIDES = 48
"""Number of sides with which the surface of a part is drawn."""
WRIST_DEPTH, HAND_DEPTH = 0.22, 0.13
"""Depth of wrist and palm over their girth; that of a cylinder is 1/π."""
THUMB_ANGLE, SPREAD = 0.45, 0.3
"""Angle between thumb and arm, and between the first and the last finger, rad."""
BLEND_MM = 14.0
"""Distance beyond a crotch over which a part takes its own shape."""
TIP = 0.1
"""Length of a finger beyond the glove's, in radii of the finger."""
BARE_MM = 25.0
"""Length of forearm that is drawn beyond the cuff."""
GATHERED = 0.05
"""Height of the thumb's rows where they begin, at the wrist, over their full height."""

Curve = Callable[[Array, Array], Array]
"""Points (…, 3), mm, of a part of the hand: at shares of the way around it, from the thumb's side
over the back, and at distances from where it begins, mm."""


@dataclass(frozen=True, eq=False, repr=False)
class GloveOnHand(ClothInSpace):
    """A left glove on a hand, the back in front (z), the arm along y, mm.

    Attributes
    ----------
    plan : of the glove.
    corners_mm : (rows + 1, columns + 1, 3) corners of the stitches; corners without a stitch have
        no meaning. The face is outside.
    mmhg : (rows, columns) pressure, the upper end of its range; infinite where a fabric is locked,
        NaN where there is no stitch.
    parts : the place of each part where it is nearest to its lock-up.
    body_mm : (rings, sides, 3) of every part of the hand, closed around.
    """

    plan: GarmentPlan
    corners_mm: Array
    mmhg: Array
    parts: dict[str, LimbPlace]
    body_mm: tuple[Array, ...]

    @property
    def stitches(self) -> Mask:
        """Mask (rows, columns) of the stitches."""
        return self.plan.shaped.stitch

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Collect the shape and the pressure as arrays."""
        return super().arrays() | {"mmhg": self.mmhg}


def glove_on_hand(
    hand: Hand,
    material: Material,
    *,
    ease: float = EASE,
    gauges: GaugeSet | None = None,
    fabrics: GloveFabrics = STUDY_FABRICS,
) -> GloveOnHand:
    """A glove on the hand that it is made for.

    Parameters are those of :func:`knitcore.garment.glove.glove`.

    Raises
    ------
    InputError
        If measurements or ease cannot be used, or the material lacks a fabric.
    """
    gauges = gauges or GaugeSet.of_material(material)
    plan = glove(hand, material, ease=ease, gauges=gauges, fabrics=fabrics)
    rows, columns = plan.shaped.stitch.shape
    heights = np.zeros((rows, columns))
    fabric_at: NDArray[np.object_] = np.full((rows, columns), None, dtype=object)
    for region, fabric in zip(plan.regions, plan.fabrics, strict=True):
        cells = region.cells & plan.shaped.stitch
        heights[cells], fabric_at[cells] = gauges[fabric].stitch_wale_mm, fabric
    corners = _hidden(rows, columns, hand)
    mmhg = np.full((rows, columns), np.nan)
    parts: dict[str, LimbPlace] = {}
    loops = list(_loops(hand, GloveLayout.of(hand, gauges, ease, fabrics), heights))
    fitted = _fits(material)
    for loop in loops:
        loop.lay(heights, corners)
        around = loop.part.rows
        for column, name, at_mm, girth_mm in loop.part.places():
            rest_mm = float(heights[around, column].sum())
            for fabric in {cell for cell in fabric_at[around, column] if cell is not None}:
                place = fitted(fabric, at_mm, girth_mm, rest_mm)
                mmhg[around[fabric_at[around, column] == fabric], column] = place.highest_mmhg
                if name not in parts or _tightness(place) > _tightness(parts[name]):
                    parts[name] = place
    return GloveOnHand(plan, corners, mmhg, parts, tuple(loop.skin() for loop in loops))


def prediction_of(fabric: Fabric, material: Material) -> Prediction:
    """Predict a part of one fabric."""
    return predict(StitchChart.of_fabric(fabric, 2, 2), material)


def _hidden(rows: int, columns: int, hand: Hand) -> Array:
    """Corners inside the palm, where cells without a stitch are hidden."""
    column, row = np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0))
    inside = np.array([0.0, hand.cuff_mm + hand.wrist_mm + 0.5 * hand.palm_mm, 0.0])
    return np.asarray(inside + 0.01 * np.stack([-row, column, 0.0 * row], axis=-1))


def _fits(material: Material) -> Callable[[Fabric, float, float, float], LimbPlace]:
    """Fit of a fabric at a place, around a girth, with a size at rest."""

    @cache
    def along(fabric: Fabric) -> Callable[[float, float], LimbPlace]:
        prediction = prediction_of(fabric, material).along(Direction.WALE)
        return cache(lambda girth, rest: place_on(prediction, 0.0, girth, rest))

    def fitted(fabric: Fabric, at_mm: float, girth_mm: float, rest_mm: float) -> LimbPlace:
        return replace(along(fabric)(girth_mm, rest_mm), at_mm=at_mm)

    return fitted


def _tightness(place: LimbPlace) -> tuple[float, float]:
    """Nearness to the lock-up, and for loose places to the limb."""
    return place.lock_up_share, -place.ease


@dataclass(frozen=True, eq=False)
class _Loop:
    """Stitches that lie around one part of the hand, in space.

    Parameters
    ----------
    part : which stitches.
    curve : of the part.
    grown : (columns + 1, rows) share of its height that a row has there; None if all do, but those
        that have ended.
    """

    part: PartOnHand
    curve: Curve
    grown: Array | None = None

    def lay(self, heights_mm: Array, corners_mm: Array) -> None:
        """Set the corners of its stitches, but not the first of a part that leaves another."""
        part = self.part
        count = len(part.at_mm) - 1
        for k in range(0 if self.grown is not None else 1, count + 1):
            # rows that end are still there at the edge where they do, those that grow already
            column = k - 1 if self.grown is None else min(k, count - 1)
            own = heights_mm[part.rows, part.first + column]
            own = own if self.grown is None else own * self.grown[k]
            at = part.at_mm[k]
            wide = max(1.0, float(own.sum() / part.girth_mm(at)))
            around = np.append(0.0, np.cumsum(own)) / own.sum()
            lower, upper = around[:-1] + _INSIDE, around[1:] - _INSIDE
            middle = self.curve(np.arange(0.0, 1.0, 0.125), np.full(8, at)).mean(axis=0)
            there = own > 0.0
            for rows, share in ((part.rows, lower), (part.rows + 1, upper)):
                points = self.curve(share[there], np.full(np.count_nonzero(there), at))
                corners_mm[rows[there], part.first + k] = middle + wide * (points - middle)

    def skin(self) -> Array:
        """Rings of the part's surface, (rings, sides, 3), closed at both ends."""
        ends_mm = self.part.at_mm[-1]
        reach = float(self.part.girth_mm(ends_mm)) * TIP / (2.0 * np.pi)
        before = [-BARE_MM] if self.grown is not None else []
        beyond = [] if self.grown is not None else ends_mm + reach * np.array([0.5, 0.9])
        at = np.concatenate([before, self.part.at_mm, beyond])
        share = (np.arange(SIDES) + 0.5) / SIDES
        rings = self.curve(*np.broadcast_arrays(share[None], at[:, None]))
        ends = np.broadcast_to(rings[[0, -1]].mean(axis=1, keepdims=True), (2, SIDES, 3))
        return np.concatenate([ends[:1], rings, ends[1:]])


_INSIDE = 1e-9
"""Share by which stitches lie inside of where a part's outline may jump, between its two sides."""


def _loops(hand: Hand, layout: GloveLayout, heights_mm: Array) -> Iterator[_Loop]:
    """The parts, each after the part that it leaves."""
    trunk, thumb, palm, *fingers = parts_on_hand(hand, layout)
    rows, side = len(heights_mm), layout.side
    risen = (trunk.at_mm - hand.cuff_mm - hand.wrist_mm) / hand.thumb_crotch_mm
    grown = np.ones((len(trunk.at_mm), rows))
    grown[:, : side - 1] = np.clip(risen, GATHERED, 1.0)[:, None]
    grown[:, rows - side + 1 :] = grown[:, :1]
    trunk_curve, thumb_root = _trunk(hand, trunk.girth_mm)
    yield _Loop(trunk, trunk_curve, grown)
    shares = _shares(heights_mm[:, layout.thumb_crotch - 1])
    half = len(thumb.rows) // 2
    leaves_mm = thumb.begins_mm
    tube = _tube(thumb_root, leaves_mm, THUMB_ANGLE, thumb.girth_mm, hand.thumb.length_mm)

    def of_trunk(share: Array) -> Array:
        return np.asarray(shares[half] * (2.0 * share - 1.0))

    def own_thumb(share: Array, at_mm: Array) -> Array:
        return tube(share + 0.5, at_mm)  # from the crotch

    yield _Loop(thumb, _leaving(trunk_curve, leaves_mm, of_trunk, own_thumb, THUMB_ANGLE))

    def own_palm(share: Array, at_mm: Array) -> Array:
        girth = palm.girth_mm(share)
        flat = _section(share, girth, HAND_DEPTH * girth)
        return np.stack([flat[..., 0], leaves_mm + at_mm, flat[..., 1]], axis=-1)

    def beside_thumb(share: Array) -> Array:
        return np.asarray(shares[side] + (1.0 - 2.0 * shares[side]) * share)

    palm_curve = _leaving(trunk_curve, leaves_mm, beside_thumb, own_palm, 0.0)
    yield _Loop(palm, palm_curve)
    around = heights_mm[palm.rows, layout.crotch - 1]
    yield from _fingers(hand, fingers, _shares(around), palm_curve, palm.at_mm[-1])


def _shares(heights_mm: Array) -> Array:
    """Where rows of these heights end around a part, from 0 to 1, (rows + 1,)."""
    return np.asarray(np.append(0.0, np.cumsum(heights_mm)) / heights_mm.sum())


def _fingers(
    hand: Hand, fingers: list[PartOnHand], shares: Array, palm: Curve, palm_mm: float
) -> Iterator[_Loop]:
    """The fingers, which leave the palm at its end, where its rows have these shares."""
    begin = 0
    for part, finger, (root, angle) in zip(fingers, hand.fingers, _roots(hand), strict=True):
        count = len(part.rows) // 2
        ends = float(shares[begin]), float(shares[begin + count])

        def of_palm(share: Array, ends: tuple[float, float] = ends) -> Array:
            across = (ends[1] - ends[0]) * np.where(share < 0.5, 2.0 * share, 2.0 * share - 1.0)
            return np.where(share < 0.5, ends[0] + across, 1.0 - ends[1] + across)

        tube = _tube(root, part.begins_mm, angle, part.girth_mm, finger.length_mm)
        yield _Loop(part, _leaving(palm, palm_mm, of_palm, tube, angle))
        begin += count + CROTCH_ROWS


def _trunk(hand: Hand, girth: GirthAlong) -> tuple[Curve, float]:
    """Forearm, wrist and palm with the thumb's base, and where the thumb's axis leaves it."""
    support_mm = hand.cuff_mm + hand.wrist_mm
    stations = support_mm, support_mm + hand.thumb_crotch_mm
    wrist, palm = hand.wrist_circumference_mm, hand.palm_circumference_mm
    thumb = hand.thumb.circumference_mm / np.pi
    depths = WRIST_DEPTH * wrist, HAND_DEPTH * palm
    # the little finger's side is straight, the thumb's goes out
    outer = _half_width(palm + 2.0 * thumb, depths[1]) - _half_width(palm, depths[1])

    def curve(share: Array, at_mm: Array) -> Array:
        flat = _section(share, girth(at_mm), np.interp(at_mm, stations, depths))
        aside = np.interp(at_mm, stations, (0.0, outer))
        return np.stack([flat[..., 0] + aside, at_mm, flat[..., 1]], axis=-1)

    return curve, _half_width(palm, depths[1]) + 2.0 * outer - 0.5 * thumb


def _roots(hand: Hand) -> Iterator[tuple[float, float]]:
    """Where the axes of the fingers leave the palm, side by side, and how they spread."""
    wide = np.array([finger.circumference_mm for finger in hand.fingers])
    half = _half_width(hand.palm_circumference_mm, HAND_DEPTH * hand.palm_circumference_mm)
    middles = (np.cumsum(wide) - 0.5 * wide) / wide.sum()
    yield from zip(
        (half * (1.0 - 2.0 * middles)).tolist(), (SPREAD * (0.5 - middles)).tolist(), strict=True
    )


def _half_width(girth_mm: float, depth_mm: float) -> float:
    return float(_section(np.array(0.0), np.array(girth_mm), np.array(depth_mm))[0])


def _section(share: Array, girth_mm: Array, depth_mm: Array) -> Array:
    """Points (…, 2), x and z, of a section that is straight in front and behind."""
    bend = np.minimum(0.5 * depth_mm, girth_mm / (2.0 * np.pi))
    quarter, straight = 0.5 * np.pi * bend, 0.5 * girth_mm - np.pi * bend
    way = np.mod(share, 1.0) * girth_mm
    back = np.minimum(way, girth_mm - way)  # the front is its mirror image
    on_straight = np.clip(back - quarter, 0.0, straight)
    angle = (back - on_straight) / bend
    x = 0.5 * straight - on_straight + bend * np.cos(angle)
    z = bend * np.sin(angle)
    return np.stack([x, np.where(way <= 0.5 * girth_mm, z, -z)], axis=-1)


def _tube(
    root_mm: float, begins_mm: float, angle: float, girth: GirthAlong, length_mm: float
) -> Curve:
    """A cylinder with a round tip, whose axis leans to the thumb's side."""
    root, ahead = np.array([root_mm, begins_mm, 0.0]), _ahead(angle)
    aside, up = np.array([ahead[1], -ahead[0], 0.0]), np.array([0.0, 0.0, 1.0])

    def curve(share: Array, at_mm: Array) -> Array:
        radius = girth(at_mm) / (2.0 * np.pi)
        beyond = np.clip((at_mm - length_mm) / radius + 1.0 - TIP, 0.0, 1.0)
        radius = (radius * np.sqrt(1.0 - beyond**2))[..., None]
        turn = 2.0 * np.pi * share[..., None]
        out = radius * (np.cos(turn) * aside + np.sin(turn) * up)
        return np.asarray(root + at_mm[..., None] * ahead + out)

    return curve


def _ahead(angle: float) -> Array:
    return np.array([np.sin(angle), np.cos(angle), 0.0])


def _leaving(
    trunk: Curve, leaves_mm: float, shares: Callable[[Array], Array], own: Curve, angle: float
) -> Curve:
    """Curve of a part that leaves another: it begins with its share of the other's outline."""
    ahead = _ahead(angle)

    def curve(share: Array, at_mm: Array) -> Array:
        before = trunk(shares(share), np.full(np.shape(at_mm), leaves_mm))
        part = np.clip(at_mm / BLEND_MM, 0.0, 1.0)[..., None]
        part = part * part * (3.0 - 2.0 * part)
        moved = before + at_mm[..., None] * ahead
        return np.asarray((1.0 - part) * moved + part * own(share, at_mm))

    return curve
