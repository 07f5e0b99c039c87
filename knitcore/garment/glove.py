"""The therapeutic glove (Note 10): one flat piece, knitted sideways around the hand and grafted.

Columns run from the forearm to the finger tips, rows around the hand: half of the thumb, the backs
of the fingers from index to little finger, their fronts in the reverse order, and the other half of
the thumb, which is grafted to the first row. The paper's has stockinette around the wrist along its
stiff direction, the wales; rib lets the fingers bend, garter lets the hand close, and seed lets the
thumb move both ways. Between fingers a few rows end at the crotch, and between thumb and hand a
gusset tapers from the thumb down to its crotch on either side. Thumb and gusset begin at the wrist
support, not at the cuff, so that they do not widen the wrist. Steps at the finger tips are on
right-side rows and steps at the wrist on wrong-side rows, which begin there: stitches are bound off
and cast on without cutting the yarn.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array, Indices, Mask
from knitcore.base.bounds import check_range
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.garment.gauge import Gauge, GaugeSet
from knitcore.garment.plan import GarmentPlan, OutlinePart, make_plan
from knitcore.garment.worn_piece import Fit, Worn, worn
from knitcore.materials import Material

CROTCH_ROWS = 2
PALM_TOLERANCE = 0.10
EASE = 0.05
"""Ease of fingers and thumb unless given. Rows of a finger come in fours, some 11 mm around: the
nearest count may be 9 % tighter, and a finger of wool 8 % too tight is pressed by over 30 mmHg."""
MIN_EASE, MAX_EASE = -0.4, 0.3
STUDY_GLOVE = "glove-wool:glove"
FINGERS = ("index finger", "middle finger", "ring finger", "little finger")
SUPPORT = "wrist support"
NEEDLES = (
    "Knit the wrist support on 2.0 mm needles (US 0) and the rest on 2.75 mm (US 2), as in the "
    "study: each row changes needles at the edges of the support."
)

GirthAlong = Callable[[Array], Array]


@dataclass(frozen=True)
class Finger:
    """A finger: length from its crotch, and circumference, in mm."""

    length_mm: float
    circumference_mm: float


@dataclass(frozen=True)
class Hand:
    """Measurements of a hand in mm; the defaults are an adult's.

    Attributes
    ----------
    cuff_mm : edge on the forearm.
    wrist_mm : length of the wrist support.
    wrist_circumference_mm : around the wrist, for the pressure there.
    palm_mm : from the support to the crotch of the fingers.
    thumb_crotch_mm : from the support to the crotch of the thumb.
    palm_circumference_mm : around the knuckles, without the thumb.
    gusset_mm : height of the thumb's gusset above its crotch; 0 for none.
    gusset_girth_mm : added to the thumb's girth by the gusset, at the crotch.
    thumb : from its crotch.
    fingers : index, middle, ring and little finger.
    """

    cuff_mm: float = 12.0
    wrist_mm: float = 55.0
    wrist_circumference_mm: float = 165.0
    palm_mm: float = 80.0
    thumb_crotch_mm: float = 45.0
    palm_circumference_mm: float = 205.0
    gusset_mm: float = 22.0
    gusset_girth_mm: float = 22.0
    thumb: Finger = Finger(55.0, 65.0)
    fingers: tuple[Finger, ...] = (
        Finger(70.0, 64.0),
        Finger(78.0, 64.0),
        Finger(72.0, 60.0),
        Finger(57.0, 53.0),
    )

    def __post_init__(self) -> None:
        lengths = "cuff_mm", "wrist_mm", "palm_mm", "thumb_crotch_mm"
        for name in (*lengths, "wrist_circumference_mm", "palm_circumference_mm"):
            check_range(name, getattr(self, name), 5, 600, "mm", "a size of a hand")
        thumb = min(self.thumb.length_mm, self.thumb.circumference_mm)
        check_range("thumb", thumb, 5, 600, "mm", "a size of a hand")
        if not (0 <= self.gusset_mm < self.thumb.length_mm and 0 <= self.gusset_girth_mm <= 100):
            raise InputError(
                "gusset_mm",
                "the gusset does not fit the thumb.",
                f"Give a height below the thumb's {self.thumb.length_mm:g} mm and 0 to 100 mm of "
                "girth.",
            )
        if len(self.fingers) != 4 or not all(
            5 <= value <= 300 for f in self.fingers for value in (f.length_mm, f.circumference_mm)
        ):
            raise InputError("fingers", "four fingers are needed.", "Give lengths and girths.")
        if self.thumb_crotch_mm >= self.palm_mm:
            problem = "the base of the thumb lies beyond that of the fingers."
            remedy = f"Give less than the length of the palm, {self.palm_mm:g} mm."
            raise InputError("thumb_crotch_mm", problem, remedy)


@dataclass(frozen=True)
class GloveFabrics:
    """Fabrics of a glove's parts; the defaults are those of the paper's.

    Attributes
    ----------
    support : around the wrist.
    hand : of the hand and the cuff.
    thumb : of the thumb and its gusset.
    fingers : of all four.
    """

    support: Fabric = Fabric.STOCKINETTE
    hand: Fabric = Fabric.GARTER
    thumb: Fabric = Fabric.SEED
    fingers: Fabric = Fabric.RIB


STUDY_FABRICS = GloveFabrics()


@dataclass(frozen=True)
class GloveLayout:
    """Stitches of a glove: columns from the forearm, rows of its parts.

    Attributes
    ----------
    cuff, support, thumb_crotch, crotch : columns at which these end.
    thumb_tip : column at which the thumb ends.
    thumb_rows : of either half of the thumb.
    gusset_ends : columns at which the gusset's rows on either side of the thumb end.
    finger_rows : rows of the back of each finger; its front has as many.
    finger_tips : columns at which the fingers end.
    """

    cuff: int
    support: int
    thumb_crotch: int
    crotch: int
    thumb_tip: int
    thumb_rows: int
    gusset_ends: tuple[int, ...]
    finger_rows: tuple[int, ...]
    finger_tips: tuple[int, ...]

    @classmethod
    def of(
        cls, hand: Hand, gauges: GaugeSet, ease: float, fabrics: GloveFabrics = STUDY_FABRICS
    ) -> GloveLayout:
        """Stitches for a hand: along it by the gauge of each part's own fabric, around it by that
        of fingers and thumb."""
        palm, thumb, finger = (gauges[f] for f in (fabrics.hand, fabrics.thumb, fabrics.fingers))
        cuff = palm.stitches_for(hand.cuff_mm)
        support = cuff + gauges[fabrics.support].stitches_for(hand.wrist_mm)
        thumb_crotch = support + palm.stitches_for(hand.thumb_crotch_mm)
        crotch = max(support + palm.stitches_for(hand.palm_mm), thumb_crotch + 1)
        return cls(
            cuff=cuff,
            support=support,
            thumb_crotch=thumb_crotch,
            crotch=crotch,
            thumb_tip=thumb_crotch + thumb.stitches_for(hand.thumb.length_mm),
            thumb_rows=thumb.rows_for(hand.thumb.circumference_mm / 2 * (1 + ease), multiple=2),
            gusset_ends=tuple(_gusset(hand, thumb, thumb_crotch)),
            finger_rows=tuple(
                finger.rows_for(f.circumference_mm / 2 * (1 + ease), multiple=2)
                for f in hand.fingers
            ),
            finger_tips=tuple(crotch + finger.stitches_for(f.length_mm) for f in hand.fingers),
        )

    @property
    def side(self) -> int:
        """Rows of half the thumb with its gusset and its crotch."""
        return self.thumb_rows + len(self.gusset_ends) + CROTCH_ROWS

    @property
    def ends(self) -> list[tuple[str, int]]:
        """Name of the part beyond the crotch and last column, for every row."""
        half = [("thumb", self.thumb_tip)] * self.thumb_rows
        half += [("gusset", end) for end in self.gusset_ends]
        half += [("hand", self.thumb_crotch)] * CROTCH_ROWS
        backs = list(zip(self.finger_rows, self.finger_tips, strict=True))
        ends = list(half)
        for side in (backs, backs[::-1]):
            for index, (rows, tip) in enumerate(side):
                ends += [("finger", tip)] * rows
                if index < len(side) - 1:
                    ends += [("hand", self.crotch)] * CROTCH_ROWS
        return ends + half[::-1]


@dataclass(frozen=True, eq=False)
class PartOnHand:
    """Stitches of a glove that lie around one part of the hand.

    Attributes
    ----------
    names : of the part, by the first column of each.
    rows : around it, from the thumb's side over the back.
    first : its first column.
    at_mm : (columns + 1,) distances of the edges of its columns from where the part begins.
    begins_mm : where that is, from the glove's edge.
    girth_mm : at distances from there.
    """

    names: dict[int, str]
    rows: Indices
    first: int
    at_mm: Array
    begins_mm: float
    girth_mm: GirthAlong

    def places(self) -> Iterator[tuple[int, str, float, float]]:
        """Columns, each with its part's name, its distance from the glove's edge and its girth."""
        name = ""
        for column, at in enumerate(0.5 * (self.at_mm[1:] + self.at_mm[:-1]), self.first):
            name = self.names.get(column, name)
            yield column, name, float(self.begins_mm + at), float(self.girth_mm(at))


def parts_on_hand(hand: Hand, layout: GloveLayout) -> Iterator[PartOnHand]:
    """Arm with the base of the thumb, then thumb, palm and the four fingers."""
    rows, side = len(layout.ends), layout.side
    support_mm = hand.cuff_mm + hand.wrist_mm
    thumb_mm, crotch_mm = support_mm + hand.thumb_crotch_mm, support_mm + hand.palm_mm
    at = np.interp(
        np.arange(layout.crotch + 1),
        [0, layout.cuff, layout.support, layout.thumb_crotch, layout.crotch],
        [0.0, hand.cuff_mm, support_mm, thumb_mm, crotch_mm],
    )
    root_mm = hand.palm_circumference_mm + 2.0 * hand.thumb.circumference_mm / np.pi

    def arm(at_mm: Array) -> Array:
        girths = hand.wrist_circumference_mm, root_mm
        return np.interp(at_mm, (support_mm, thumb_mm), girths)

    def thumb(at_mm: Array) -> Array:
        more = np.clip(1.0 - at_mm / max(hand.gusset_mm, 1e-9), 0.0, 1.0)
        return np.asarray(hand.thumb.circumference_mm + hand.gusset_girth_mm * more)

    def even(girth_mm: float) -> GirthAlong:
        return lambda at_mm: np.full(np.shape(at_mm), girth_mm)

    names = {0: "cuff", layout.cuff: SUPPORT, layout.support: "base of the thumb"}
    yield PartOnHand(names, np.arange(rows), 0, at[: layout.thumb_crotch + 1], 0.0, arm)
    half = layout.thumb_rows + len(layout.gusset_ends)
    around = np.concatenate([np.arange(rows - half, rows), np.arange(half)])
    first = layout.thumb_crotch
    along = np.linspace(0.0, hand.thumb.length_mm, layout.thumb_tip - first + 1)
    yield PartOnHand({first: "thumb"}, around, first, along, thumb_mm, thumb)
    palm = np.arange(side, rows - side)
    girth = even(hand.palm_circumference_mm)
    yield PartOnHand({first: "hand"}, palm, first, at[first:] - thumb_mm, thumb_mm, girth)
    begin, first = 0, layout.crotch
    for name, finger, count, tip in zip(
        FINGERS, hand.fingers, layout.finger_rows, layout.finger_tips, strict=True
    ):
        back, front = palm[begin : begin + count], palm[::-1][begin : begin + count][::-1]
        along = np.linspace(0.0, finger.length_mm, tip - first + 1)
        girth = even(finger.circumference_mm)
        around = np.concatenate([back, front])
        yield PartOnHand({first: name}, around, first, along, crotch_mm, girth)
        begin += count + CROTCH_ROWS


def glove(
    hand: Hand,
    material: Material,
    *,
    ease: float = EASE,
    mmhg: float | None = None,
    gauges: GaugeSet | None = None,
    fabrics: GloveFabrics = STUDY_FABRICS,
    linear_density_tex: float | None = None,
) -> GarmentPlan:
    """The plan of a glove.

    Parameters
    ----------
    hand : its measurements.
    material : gives gauges and laws; ``glove-wool:glove`` is the paper's.
    ease : of fingers and thumb.
    mmhg : target pressure of the wrist support; a note gives the rows for it.
    gauges : the knitter's; by default the material's own.
    fabrics : of its parts.
    linear_density_tex : for the mass of yarn.

    Notes
    -----
    Stitches along the hand come from the gauge of each part's own fabric, rows around it from the
    fingers' and the thumb's; misfits are reported, and the pressure on every part of the hand is
    that of the resulting rows, where the part is nearest to its lock-up.

    Raises
    ------
    InputError
        If measurements or ease cannot be used, or the material lacks a fabric.
    """
    check_range("ease", ease, MIN_EASE, MAX_EASE, what="an ease for a glove")
    gauges = gauges or GaugeSet.of_material(material)
    support_gauge = gauges[fabrics.support]
    layout = GloveLayout.of(hand, gauges, ease, fabrics)
    cuff, support = layout.cuff, layout.support
    thumb_crotch, crotch, ends = layout.thumb_crotch, layout.crotch, layout.ends

    tips = np.array([tip for _, tip in ends])
    kinds = np.array([kind for kind, _ in ends])[:, None]
    column = np.broadcast_to(np.arange(int(tips.max())), (len(ends), int(tips.max())))
    # One row of the crotch more on either side: wrong-side rows begin at the wrist.
    wrist_rows = slice(layout.side - 1, len(ends) - layout.side + 1)
    start = np.full((len(ends), 1), support)
    start[wrist_rows] = 0
    beyond = column >= support
    is_gusset = (kinds == "gusset") & (column >= thumb_crotch)
    is_thumb = beyond & (kinds == "thumb")
    is_finger = (column >= crotch) & (kinds == "finger")
    parts = (
        OutlinePart("cuff", column < cuff, fabrics.hand),
        OutlinePart(SUPPORT, (column >= cuff) & ~beyond, fabrics.support),
        OutlinePart("hand", beyond & ~is_thumb & ~is_gusset & ~is_finger, fabrics.hand),
        OutlinePart("thumb", is_thumb, fabrics.thumb),
        OutlinePart("thumb gusset", is_gusset, fabrics.thumb),
        OutlinePart("fingers", is_finger, fabrics.fingers),
    )
    around = wrist_rows.stop - wrist_rows.start
    stitch = (column >= start) & (column < tips[:, None])
    pressed = _worn(hand, layout, stitch, parts, material, gauges)
    return make_plan(
        "therapeutic glove",
        stitch,
        parts,
        material,
        gauges,
        around=Direction.WALE,
        worn=tuple(pressed.values()),
        closing="graft the last row to the first along the thumb, join the wrist's two edges, and "
        "seam finger tips and sides",
        notes=(NEEDLES,) if material.sample == STUDY_GLOVE else (),
        cautions=_cautions(hand, around, gauges[fabrics.hand], ease, material, fabrics.hand)
        + _wrist_cautions(pressed[SUPPORT], support_gauge, material, around, mmhg, fabrics.support),
        linear_density_tex=linear_density_tex,
    )


def _worn(
    hand: Hand,
    layout: GloveLayout,
    stitch: Mask,
    parts: tuple[OutlinePart, ...],
    material: Material,
    gauges: GaugeSet,
) -> dict[str, Worn]:
    """Every part of the hand where the glove is nearest to its lock-up, by name."""
    heights = np.sum([gauges[p.fabric].stitch_wale_mm * (p.cells & stitch) for p in parts], axis=0)
    lock_ups = {p.fabric: material.law(p.fabric).lock_up_strain(Direction.WALE) for p in parts}
    shares: dict[str, float] = {}
    pressed: dict[str, Worn] = {}
    for on_hand in parts_on_hand(hand, layout):
        for column, name, at, girth in on_hand.places():
            rest = float(heights[on_hand.rows, column].sum())
            here = on_hand.rows, column
            for fabric in {p.fabric for p in parts if (p.cells[here] & stitch[here]).any()}:
                share = (girth / rest - 1.0) / lock_ups[fabric]
                if share > shares.get(name, -np.inf):
                    shares[name] = share
                    place = worn(material, fabric, Direction.WALE, rest, girth, at_mm=at, part=name)
                    pressed[name] = place
    return pressed


def _gusset(hand: Hand, thumb: Gauge, thumb_crotch: int) -> list[int]:
    """Columns at which the gusset's rows end on one side of the thumb, two of each length."""
    height = round(hand.gusset_mm / thumb.stitch_course_mm)
    steps = round(hand.gusset_girth_mm / 2 / thumb.stitch_wale_mm / 2)
    if height < 1 or steps < 1:
        return []
    lengths = [round(height * (1 - step / steps)) for step in range(steps)]
    return [thumb_crotch + length for length in lengths for _ in range(2) if length > 0]


def _cautions(
    hand: Hand, rows: int, palm: Gauge, ease: float, material: Material, fabric: Fabric
) -> tuple[str, ...]:
    cautions = []
    if material.sample != STUDY_GLOVE:
        cautions.append(
            "The study's glove has its wrist support on 2.0 mm needles and the rest on 2.75 mm. "
            f"The material {STUDY_GLOVE} was measured on both, {material.identifier} on one."
        )
    around = palm.rows_for(hand.palm_circumference_mm * (1 + ease))
    if abs(rows / around - 1) > PALM_TOLERANCE:
        cautions.append(
            f"The fingers need {rows} rows around the hand, the hand itself {around} rows of "
            f"{fabric}: it will be {100 * abs(rows / around - 1):.0f} % "
            f"{'narrower' if rows < around else 'wider'} than planned. "
            "Another ease of the fingers or fabric of the hand changes that."
        )
    return tuple(cautions)


def _wrist_cautions(
    pressed: Worn, gauge: Gauge, material: Material, rows: int, mmhg: float | None, support: Fabric
) -> tuple[str, ...]:
    """A caution on the rows that the wrist support needs for a pressure."""
    if pressed.pressure is None:
        loose = (
            f"The wrist support is {pressed.rest_mm:.0f} mm around, the wrist "
            f"{pressed.worn_mm:.0f} mm: it exerts no pressure."
        )
        if mmhg is None:
            return (f"{loose} Give a target pressure to see how many rows that takes.",)
    if mmhg is None:
        return ()
    rest = Fit(mmhg=mmhg).rest_mm(pressed.worn_mm, material, support, Direction.WALE)
    needed = gauge.rows_for(rest, multiple=2)
    if needed >= rows:
        more = ", so it presses more" if needed > rows else ""
        return (f"For {mmhg:g} mmHg the wrist support takes {needed} rows; it has {rows}{more}.",)
    return (
        f"For {mmhg:g} mmHg the wrist support takes {needed} of the {rows} rows ({rest:.0f} mm): "
        f"turn {rows - needed} rows, in pairs, at its edge to the hand (short rows).",
    )
