"""The glove on the hand that it is made for."""

from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import Field

from knitcore.draw.body import Body
from knitcore.garment.worn_glove import GloveOnHand, glove_on_hand, prediction_of
from knitcore.materials.law_uncertainty import in_a_sentence
from knitcore.mechanics.pressure import CAPILLARY_MMHG, ELASTIC_MEAN, too_tight_parts

from ...cli.options import out_option
from ...context import Context
from ...drawing.computed import PosedView
from ...requests.base import IntervalResult
from ...requests.garments import Glove, KnitterRequest
from ..perform import Viewed
from ..registry import Command, Operation
from .garment import measured_options, read_measured
from .limb import HEADING, LIMIT, LimbPlaceResult

SIMPLE = (
    "Fingers and thumb are cylinders, palm and forearm straight in front and behind. Every part is "
    "as long as the hand's; rows of the thumb are gathered at the wrist."
)


class GloveRequest(KnitterRequest):
    """The measurements of a hand, and the yarn."""

    garment: Glove


class GlovePart(LimbPlaceResult):
    """Fit of a part of the glove where it is nearest to its lock-up."""

    name: str


class GloveResult(IntervalResult):
    """Fit of the glove; no medical class."""

    kind: Literal["glove"] = "glove"
    id: str = Field(description="Name of the shape, for 3D views of the glove's chart.")
    rows: int
    columns: int
    parts: list[GlovePart]
    limit_mmhg: float = Field(CAPILLARY_MMHG, description=LIMIT)
    notes: list[str]


def glove(request: GloveRequest, context: Context) -> Viewed[GloveResult]:
    """Fit and pressure of the parts of the therapeutic glove on the hand that it is made for.

    The hand is made of simple bodies with the given measurements; pressure is that of a tube of
    each part's fabric by Laplace's law. The 3D view can show the glove on the hand.

    Raises
    ------
    InputError
        If a measurement or the material cannot be used.
    """
    worn = _worn(request, context)
    return Viewed(_result(worn, request, context), _view(worn))


def _result(worn: GloveOnHand, request: GloveRequest, context: Context) -> GloveResult:
    rows, columns = worn.mmhg.shape
    support = prediction_of(request.garment.support_fabric, context.material(request.material))
    return GloveResult(
        interval_source=in_a_sentence(support.stretch_errors),
        id=OPERATION.key(request),
        rows=rows,
        columns=columns,
        parts=[GlovePart.of_place(place, name=name) for name, place in worn.parts.items()],
        notes=[*_too_tight(worn), ELASTIC_MEAN, SIMPLE],
    )


def _too_tight(worn: GloveOnHand) -> tuple[str, ...]:
    """A warning that names the parts that press too hard."""
    return too_tight_parts([(name, place.highest_mmhg) for name, place in worn.parts.items()])


def _worn(request: GloveRequest, context: Context) -> GloveOnHand:
    material = context.material(request.material)
    return glove_on_hand(
        request.garment.hand,
        material,
        ease=request.garment.ease,
        gauges=request.gauges(material),
        fabrics=request.garment.fabrics,
    )


def _view(worn: GloveOnHand) -> PosedView:
    return PosedView(
        worn.corners_mm.astype(np.float32),
        Body.joined([Body.around(part) for part in worn.body_mm]),
        worn.mmhg.astype(np.float32),
    )


@measured_options
def _hand(settings: tuple[str, ...], gauge: str | None, per: str) -> dict[str, object]:
    return read_measured("glove", settings, gauge, per)


@out_option("--out", help="Write the glove on the hand to FILE.glb.", suffixes=(".glb",))
def _and_write(request: GloveRequest, context: Context, out: Path | None) -> GloveResult:
    worn = _worn(request, context)
    result = _result(worn, request, context)
    if out is not None:
        # the 3D view's libraries take a second to load
        from ...drawing.design_view import Curled, ViewRequest, build_scene
        from ...drawing.fabric import solid_glb
        from ...drawing.stitch_colours import Colour

        shaped = worn.plan.shaped
        shown = ViewRequest(
            chart=shaped.chart.text,
            outline=shaped.outline,
            material=request.material,
            colour=Colour.PRESSURE,
            curl=Curled(id=result.id),
        )
        out.write_bytes(solid_glb(build_scene(shown, _view(worn), context)))
    return result


def _lines(r: GloveResult) -> list[str]:
    return [f"{'':18} {HEADING}", *(f"{part.name:18} {part.line}" for part in r.parts)]


OPERATION = Operation(
    glove,
    tag="garments",
    summary="The glove on a hand",
    example={"garment": {"template": "glove"}, "material": "glove-wool:glove"},
    heavy=True,
    command=Command(_lines, names={"garment": None, "gauge": None}, fields=_hand, run=_and_write),
)
