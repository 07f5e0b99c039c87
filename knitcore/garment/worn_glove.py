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

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array, Indices
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.garment.gauge import GaugeSet
from knitcore.garment.glove import (
    CROTCH_ROWS,
    STUDY_FABRICS,
    GloveFabrics,
    GloveLayout,
    Hand,
    glove,
)
from knitcore.garment.limb import LimbPlace, place_on
from knitcore.garment.plan import GarmentPlan
from knitcore.materials import Material
from knitcore.mechanics.pressure import MMHG_PER_KPA
from knitcore.prediction.predict import predict
from knitcore.prediction.prediction import Prediction

FINGERS = ("index finger", "middle finger", "ring finger", "little finger")
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
GirthAlong = Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class GloveOnHand:
    """A left glove on a hand, the back in front (z), the arm along y, mm.

    Attributes
    ----------
    plan : of the glove.
    corners_mm : (rows + 1, columns + 1, 3) corners of the stitches; corners without a stitch have
        no meaning. The face is outside.
    mmhg : (rows, columns) pressure, the middle between free and fixed along the hand; NaN where
        there is none.
    parts : the place of each part where it is nearest to its lock-up.
    body_mm : (rings, sides, 3) of every part of the hand, closed around.
    """

    plan: GarmentPlan
    corners_mm: Array
    mmhg: Array
    parts: dict[str, LimbPlace]
    body_mm: tuple[Array, ...]


def glove_on_hand(
    hand: Hand,
    material: Material,
    *,
    ease: float = -0.10,
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
        for column, name, place_at in loop.places():
            for fabric in {cell for cell in fabric_at[loop.rows, column] if cell is not None}:
                place = fitted(fabric, *place_at, float(heights[loop.rows, column].sum()))
                mmhg[loop.rows[fabric_at[loop.rows, column] == fabric], column] = _middle(place)
                if name not in parts or place.lock_up_share > parts[name].lock_up_share:
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


def _middle(place: LimbPlace) -> float:
    """Pressure, the middle between free and fixed along the hand, mmHg."""
    if place.pressure is None:
        return np.nan
    return 0.5 * MMHG_PER_KPA * (place.pressure.kpa.low + place.pressure.kpa.high)


@dataclass(frozen=True, eq=False)
class _Loop:
    """Stitches that lie around one part of the hand.

    Parameters
    ----------
    names : of the part, by the first column of each.
    rows : around it, from the thumb's side over the back.
    first : its first column.
    at_mm : (columns + 1,) distances of the edges of its columns from where the part begins.
    begins_mm : where that is, from the glove's edge.
    girth_mm, curve : of the part.
    grown : (columns + 1, rows) share of its height that a row has there; None if all do, but those
        that have ended.
    """

    names: dict[int, str]
    rows: Indices
    first: int
    at_mm: Array
    begins_mm: float
    girth_mm: GirthAlong
    curve: Curve
    grown: Array | None = None

    def places(self) -> Iterator[tuple[int, str, tuple[float, float]]]:
        """Columns, each with its part's name, its distance from the glove's edge and its girth."""
        name = ""
        for column, at in enumerate(0.5 * (self.at_mm[1:] + self.at_mm[:-1]), self.first):
            name = self.names.get(column, name)
            yield column, name, (float(self.begins_mm + at), float(self.girth_mm(at)))

    def lay(self, heights_mm: Array, corners_mm: Array) -> None:
        """Set the corners of its stitches, but not the first of a part that leaves another."""
        count = len(self.at_mm) - 1
        for k in range(0 if self.grown is not None else 1, count + 1):
            # rows that end are still there at the edge where they do, those that grow already
            column = k - 1 if self.grown is None else min(k, count - 1)
            own = heights_mm[self.rows, self.first + column]
            own = own if self.grown is None else own * self.grown[k]
            at = self.at_mm[k]
            wide = max(1.0, float(own.sum() / self.girth_mm(at)))
            around = np.append(0.0, np.cumsum(own)) / own.sum()
            lower, upper = around[:-1] + _INSIDE, around[1:] - _INSIDE
            middle = self.curve(np.arange(0.0, 1.0, 0.125), np.full(8, at)).mean(axis=0)
            there = own > 0.0
            for rows, share in ((self.rows, lower), (self.rows + 1, upper)):
                points = self.curve(share[there], np.full(np.count_nonzero(there), at))
                corners_mm[rows[there], self.first + k] = middle + wide * (points - middle)

    def skin(self) -> Array:
        """Rings of the part's surface, (rings, sides, 3), closed at both ends."""
        reach = float(self.girth_mm(self.at_mm[-1])) * TIP / (2.0 * np.pi)
        before = [-BARE_MM] if self.grown is not None else []
        beyond = [] if self.grown is not None else self.at_mm[-1] + reach * np.array([0.5, 0.9])
        at = np.concatenate([before, self.at_mm, beyond])
        share = (np.arange(SIDES) + 0.5) / SIDES
        rings = self.curve(*np.broadcast_arrays(share[None], at[:, None]))
        ends = np.broadcast_to(rings[[0, -1]].mean(axis=1, keepdims=True), (2, SIDES, 3))
        return np.concatenate([ends[:1], rings, ends[1:]])


_INSIDE = 1e-9
"""Share by which stitches lie inside of where a part's outline may jump, between its two sides."""


def _loops(hand: Hand, layout: GloveLayout, heights_mm: Array) -> Iterator[_Loop]:
    """The parts, each after the part that it leaves."""
    rows = len(heights_mm)
    support_mm = hand.cuff_mm + hand.wrist_mm
    thumb_mm, crotch_mm = support_mm + hand.thumb_crotch_mm, support_mm + hand.palm_mm
    columns = np.arange(layout.crotch + 1)
    at = np.interp(
        columns,
        [0, layout.cuff, layout.support, layout.thumb_crotch, layout.crotch],
        [0.0, hand.cuff_mm, support_mm, thumb_mm, crotch_mm],
    )
    trunk_at, palm_at = at[: layout.thumb_crotch + 1], at[layout.thumb_crotch :] - thumb_mm
    side = layout.side
    grown = np.ones((len(trunk_at), rows))
    risen = np.clip((trunk_at - support_mm) / hand.thumb_crotch_mm, GATHERED, 1.0)
    grown[:, : side - 1] = grown[:, rows - side + 1 :] = risen[:, None]
    trunk_girth, trunk, thumb_root = _trunk(hand)
    yield _Loop(
        {0: "cuff", layout.cuff: "wrist support", layout.support: "base of the thumb"},
        np.arange(rows), 0, trunk_at, 0.0, trunk_girth, trunk, grown,
    )  # fmt: skip
    around = heights_mm[:, layout.thumb_crotch - 1]
    shares = _shares(around)
    yield _thumb(hand, layout, around, trunk, thumb_root)

    def palm_girth(at_mm: Array) -> Array:
        return np.full(np.shape(at_mm), hand.palm_circumference_mm)

    def own_palm(share: Array, at_mm: Array) -> Array:
        flat = _section(share, palm_girth(share), HAND_DEPTH * palm_girth(share))
        return np.stack([flat[..., 0], thumb_mm + at_mm, flat[..., 1]], axis=-1)

    palm = _leaving(
        trunk, thumb_mm, lambda s: shares[side] + (1.0 - 2.0 * shares[side]) * s, own_palm, 0.0
    )
    palm_rows = np.arange(side, rows - side)
    yield _Loop(
        {layout.thumb_crotch: "hand"}, palm_rows, layout.thumb_crotch, palm_at, thumb_mm,
        palm_girth, palm,
    )  # fmt: skip
    around = heights_mm[palm_rows, layout.crotch - 1]
    yield from _fingers(hand, layout, palm_rows, around, palm, palm_at[-1])


def _shares(heights_mm: Array) -> Array:
    """Where rows of these heights end around a part, from 0 to 1, (rows + 1,)."""
    return np.asarray(np.append(0.0, np.cumsum(heights_mm)) / heights_mm.sum())


def _thumb(hand: Hand, layout: GloveLayout, heights_mm: Array, trunk: Curve, root: float) -> _Loop:
    """The thumb with its gusset, which leaves the trunk where its rows are ``heights_mm`` high."""
    rows, shares = len(heights_mm), _shares(heights_mm)
    leaves_mm = hand.cuff_mm + hand.wrist_mm + hand.thumb_crotch_mm
    half = layout.thumb_rows + len(layout.gusset_ends)

    def girth(at_mm: Array) -> Array:
        more = np.clip(1.0 - at_mm / max(hand.gusset_mm, 1e-9), 0.0, 1.0)
        return np.asarray(hand.thumb.circumference_mm + hand.gusset_girth_mm * more)

    tube = _tube(root, leaves_mm, THUMB_ANGLE, girth, hand.thumb.length_mm)

    def own(share: Array, at_mm: Array) -> Array:
        return tube(share + 0.5, at_mm)  # from the crotch

    return _Loop(
        {layout.thumb_crotch: "thumb"},
        np.concatenate([np.arange(rows - half, rows), np.arange(half)]),
        layout.thumb_crotch,
        np.linspace(0.0, hand.thumb.length_mm, layout.thumb_tip - layout.thumb_crotch + 1),
        leaves_mm,
        girth,
        _leaving(trunk, leaves_mm, lambda s: shares[half] * (2.0 * s - 1.0), own, THUMB_ANGLE),
    )


def _fingers(
    hand: Hand,
    layout: GloveLayout,
    palm_rows: Indices,
    heights_mm: Array,
    palm: Curve,
    palm_mm: float,
) -> Iterator[_Loop]:
    """The fingers, which leave the palm at its end, where its rows are ``heights_mm`` high."""
    shares = _shares(heights_mm)
    crotch_mm = hand.cuff_mm + hand.wrist_mm + hand.palm_mm
    begin = 0
    places = zip(
        FINGERS, hand.fingers, layout.finger_rows, layout.finger_tips, _roots(hand), strict=True
    )
    for name, finger, count, tip, (root, angle) in places:
        back = palm_rows[begin : begin + count]
        front = palm_rows[::-1][begin : begin + count][::-1]
        ends = float(shares[begin]), float(shares[begin + count])

        def girth(at_mm: Array, around_mm: float = finger.circumference_mm) -> Array:
            return np.full(np.shape(at_mm), around_mm)

        def of_palm(share: Array, ends: tuple[float, float] = ends) -> Array:
            across = (ends[1] - ends[0]) * np.where(share < 0.5, 2.0 * share, 2.0 * share - 1.0)
            return np.where(share < 0.5, ends[0] + across, 1.0 - ends[1] + across)

        tube = _tube(root, crotch_mm, angle, girth, finger.length_mm)
        yield _Loop(
            {layout.crotch: name}, np.concatenate([back, front]), layout.crotch,
            np.linspace(0.0, finger.length_mm, tip - layout.crotch + 1), crotch_mm, girth,
            _leaving(palm, palm_mm, of_palm, tube, angle),
        )  # fmt: skip
        begin += count + CROTCH_ROWS


def _trunk(hand: Hand) -> tuple[GirthAlong, Curve, float]:
    """Forearm, wrist and palm with the thumb's base, and where the thumb's axis leaves it."""
    support_mm = hand.cuff_mm + hand.wrist_mm
    stations = support_mm, support_mm + hand.thumb_crotch_mm
    wrist, palm = hand.wrist_circumference_mm, hand.palm_circumference_mm
    thumb = hand.thumb.circumference_mm / np.pi
    depths = WRIST_DEPTH * wrist, HAND_DEPTH * palm
    # the little finger's side is straight, the thumb's goes out
    outer = _half_width(palm + 2.0 * thumb, depths[1]) - _half_width(palm, depths[1])

    def girth(at_mm: Array) -> Array:
        return np.interp(at_mm, stations, (wrist, palm + 2.0 * thumb))

    def curve(share: Array, at_mm: Array) -> Array:
        flat = _section(share, girth(at_mm), np.interp(at_mm, stations, depths))
        aside = np.interp(at_mm, stations, (0.0, outer))
        return np.stack([flat[..., 0] + aside, at_mm, flat[..., 1]], axis=-1)

    return girth, curve, _half_width(palm, depths[1]) + 2.0 * outer - 0.5 * thumb


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
