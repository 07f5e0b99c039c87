"""Templates of garments with their measurements, and the knitter."""

from abc import ABC, abstractmethod
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field

from knitcore.chart.fabric import Fabric
from knitcore.garment.gauge import Gauge, GaugeLength, GaugeSet
from knitcore.garment.glove import EASE, STUDY_FABRICS, Finger, GloveFabrics, Hand, glove
from knitcore.garment.plan import GarmentPlan
from knitcore.garment.templates import Girth, limb_tube, sock_leg, wrist_brace
from knitcore.garment.worn_piece import Fit
from knitcore.materials import Material

from .base import RequestModel
from .charts import MaterialName
from .fabrics import LawsRequest

Length = Annotated[float, Field(gt=0, le=2000)]
OfHand = Annotated[float, Field(gt=0, le=500)]
Ease = Annotated[float, Field(ge=-0.6, le=1)]
TargetProfile = Annotated[
    list[tuple[float, Annotated[float, Field(gt=0, le=300)]]] | None,
    Field(
        min_length=1,
        max_length=100,
        description="Graded target pressure: pairs [position_mm, mmHg] along the limb; takes "
        "precedence over one target.",
    ),
]
TargetPressure = Annotated[
    float | None,
    Field(gt=0, le=300, description="Target pressure; takes precedence over the ease."),
]


class GaugeCount(RequestModel):
    """A gauge counted on a swatch."""

    stitches: float = Field(gt=0, le=1000)
    rows: float = Field(gt=0, le=1000)
    per: Literal["10 cm", "4 in", "5 cm"] = "10 cm"
    fabric: Fabric = Field(Fabric.STOCKINETTE, description="Repeat of the swatch.")

    def gauge(self) -> Gauge:
        """The gauge as an object of the library."""
        return Gauge.of_count(self.stitches, self.rows, LENGTHS[self.per])


LENGTHS = {
    "10 cm": GaugeLength.TEN_CM,
    "4 in": GaugeLength.FOUR_INCHES,
    "5 cm": GaugeLength.FIVE_CM,
}


class Template(RequestModel, ABC):
    """A garment with its measurements and its tightness."""

    AROUND: ClassVar[tuple[str, ...]] = ()
    """Names of the measures around the body."""
    ALONG: ClassVar[tuple[str, ...]] = ()
    """Names of the measures along it."""

    ease: Ease = -0.15
    target_mmhg: TargetPressure = None

    @property
    def fit(self) -> Fit:
        """The fit as an object of the library."""
        return Fit(self.ease, self.target_mmhg)

    @abstractmethod
    def plan(self, **yarn: Any) -> GarmentPlan:
        """The garment's plan, for a material, gauges and a linear density."""

    def scaled(self, around: float, along: float) -> Self:
        """The same garment for a body that is larger by two factors."""
        measures = {name: around * getattr(self, name) for name in self.AROUND}
        return self.model_copy(
            update=measures | {name: along * getattr(self, name) for name in self.ALONG}
        )


class WristBrace(Template):
    """A brace, knitted sideways and grafted."""

    AROUND = ("wrist_mm",)
    ALONG = ("length_mm",)

    template: Literal["wrist-brace"]
    wrist_mm: Length
    length_mm: Length
    edge_mm: Annotated[float, Field(ge=0, le=500)] = 15.0
    support: Fabric = Fabric.STOCKINETTE
    edge: Fabric = Fabric.GARTER

    def plan(self, **yarn: Any) -> GarmentPlan:
        """The garment's plan for a yarn."""
        return self.pass_to(wrist_brace, fit=self.fit, **yarn)


class Graded(Template):
    """A tube along a limb, whose pressure may change along it."""

    mmhg_profile: TargetProfile = None
    body: Fabric = Fabric.STOCKINETTE
    hem: Fabric = Fabric.RIB

    @property
    def fit(self) -> Fit:
        """The fit as an object of the library."""
        return Fit(self.ease, self.mmhg_profile or self.target_mmhg)

    def scaled(self, around: float, along: float) -> Self:
        """The same garment for a body that is larger by two factors."""
        profile = self.mmhg_profile and [(along * at, mmhg) for at, mmhg in self.mmhg_profile]
        return super().scaled(around, along).model_copy(update={"mmhg_profile": profile})


class SockLeg(Graded):
    """The leg of a sock."""

    AROUND = ("ankle_mm", "calf_mm")
    ALONG = ("length_mm",)

    template: Literal["sock-leg"]
    ankle_mm: Length
    calf_mm: Length
    length_mm: Length

    def plan(self, **yarn: Any) -> GarmentPlan:
        """The garment's plan for a yarn."""
        return self.pass_to(sock_leg, fit=self.fit, **yarn)


class Limb(Graded):
    """A sleeve for any limb."""

    template: Literal["limb"]
    profile: list[tuple[float, Length]] = Field(
        min_length=2,
        max_length=200,
        description="Pairs [position_mm, circumference_mm] along the limb.",
    )
    hem_mm: Annotated[float, Field(ge=0, le=500)] = 40.0

    def plan(self, **yarn: Any) -> GarmentPlan:
        """The garment's plan for a yarn."""
        girths = [Girth(at, around) for at, around in self.profile]
        return self.pass_to(limb_tube, "sleeve", girths, fit=self.fit, **yarn)

    def scaled(self, around: float, along: float) -> Self:
        """The same garment for a body that is larger by two factors."""
        profile = [(along * at, around * girth) for at, girth in self.profile]
        return super().scaled(around, along).model_copy(update={"profile": profile})


class FingerSize(RequestModel):
    """Measurements of one finger."""

    length_mm: OfHand
    circumference_mm: OfHand

    def scaled(self, around: float, along: float) -> "FingerSize":
        """A finger that is larger by two factors."""
        return FingerSize.model_construct(
            length_mm=along * self.length_mm, circumference_mm=around * self.circumference_mm
        )


_HAND = Hand()
_THUMB, *_FINGERS = (
    FingerSize(length_mm=digit.length_mm, circumference_mm=digit.circumference_mm)
    for digit in (_HAND.thumb, *_HAND.fingers)
)


class Glove(Template):
    """The therapeutic glove; measurements default to an adult's hand."""

    AROUND = ("wrist_circumference_mm", "palm_circumference_mm", "gusset_girth_mm")
    ALONG = ("cuff_mm", "wrist_mm", "palm_mm", "thumb_crotch_mm", "gusset_mm")

    template: Literal["glove"]
    cuff_mm: OfHand = _HAND.cuff_mm
    wrist_mm: OfHand = _HAND.wrist_mm
    wrist_circumference_mm: OfHand = _HAND.wrist_circumference_mm
    palm_mm: OfHand = _HAND.palm_mm
    thumb_crotch_mm: OfHand = _HAND.thumb_crotch_mm
    palm_circumference_mm: OfHand = _HAND.palm_circumference_mm
    gusset_mm: Annotated[float, Field(ge=0, le=200)] = _HAND.gusset_mm
    gusset_girth_mm: Annotated[float, Field(ge=0, le=100)] = _HAND.gusset_girth_mm
    thumb: FingerSize | None = None
    fingers: list[FingerSize] | None = Field(None, min_length=4, max_length=4)
    support_fabric: Fabric = STUDY_FABRICS.support
    hand_fabric: Fabric = Field(STUDY_FABRICS.hand, description="Fabric of the hand and the cuff.")
    thumb_fabric: Fabric = STUDY_FABRICS.thumb
    finger_fabric: Fabric = STUDY_FABRICS.fingers
    ease: Ease = EASE

    @property
    def fabrics(self) -> GloveFabrics:
        """The fabrics as an object of the library."""
        return GloveFabrics(
            self.support_fabric, self.hand_fabric, self.thumb_fabric, self.finger_fabric
        )

    @property
    def hand(self) -> Hand:
        """The hand as an object of the library."""
        fingers = self.fingers and tuple(finger.pass_to(Finger) for finger in self.fingers)
        thumb = self.thumb and self.thumb.pass_to(Finger)
        return self.pass_to(Hand, thumb=thumb or _HAND.thumb, fingers=fingers or _HAND.fingers)

    def plan(self, **yarn: Any) -> GarmentPlan:
        """The garment's plan for a yarn."""
        return glove(self.hand, ease=self.ease, mmhg=self.target_mmhg, fabrics=self.fabrics, **yarn)

    def scaled(self, around: float, along: float) -> Self:
        """The same glove for a hand that is larger by two factors."""
        thumb, *fingers = (
            digit.scaled(around, along)
            for digit in (self.thumb or _THUMB, *(self.fingers or _FINGERS))
        )
        digits = {"thumb": thumb, "fingers": fingers}
        return super().scaled(around, along).model_copy(update=digits)


AnyTemplate = Annotated[WristBrace | SockLeg | Limb | Glove, Field(discriminator="template")]


class KnitterRequest(LawsRequest):
    """The yarn, and how somebody knits it."""

    material: MaterialName
    gauge: GaugeCount | None = Field(
        None, description="The knitter's gauge; the material's by default."
    )

    def gauges(self, material: Material) -> GaugeSet:
        """The gauges of the four fabrics."""
        if self.gauge is None:
            return GaugeSet.of_material(material)
        return GaugeSet.of_material(material, self.gauge.gauge(), self.gauge.fabric)
