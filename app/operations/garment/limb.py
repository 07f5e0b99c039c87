"""Fit and pressure of a knitted tube along a limb."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, Self

import click
import numpy as np
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import check_stitches
from knitcore.cloth.space.limb_tube import TubeOnLimb, worn_tube
from knitcore.draw.body import Body
from knitcore.formats.write.yarn_mesh import write_curled_glb
from knitcore.garment.limb import (
    LEAST_GIRTH_MM,
    MAX_GIRTHS,
    PLACES,
    LimbPlace,
    MeasuredLimb,
    on_limb,
)
from knitcore.garment.shaped import ShapedChart, outline_marks
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import in_a_sentence
from knitcore.mechanics.pressure import CAPILLARY_MMHG, ELASTIC_MEAN, MMHG_PER_KPA, too_tight
from knitcore.prediction.patches import SIDE
from knitcore.prediction.predict import predict

from ...cli.options import out_option
from ...context import Context
from ...drawing.computed import PosedView
from ...requests.base import Ends, IntervalResult, RequestModel, ResultModel
from ...requests.charts import OutlineInput
from ...requests.fabrics import GaugedRequest
from ..perform import Viewed
from ..registry import Command, Operation

MAX_STITCHES = 40_000
"""Largest number of stitches of a chart that is itself the tube."""
LIMIT = "Pressure above which the garment can stop the blood in the capillaries."
FREE_ALONG = (
    "Nothing holds the tube along the limb here, so it shortens freely; friction may keep it "
    "longer."
)

BY_PATCHES = (
    f"A row is as stiff as the fabric around it, {SIDE} rows and more. Where textures meet, as "
    "at a hem, the pressure therefore changes over some rows on either side, and not at once."
)


class TubeGirth(RequestModel):
    """Circumferences at one place."""

    at_mm: float = Field(
        ge=0, le=3000, description="Distance along the limb, from where the tube begins."
    )
    girth_mm: float = Field(ge=LEAST_GIRTH_MM, le=3000, description="Circumference of the limb.")
    rest_mm: float | None = Field(
        None,
        ge=LEAST_GIRTH_MM,
        le=3000,
        description="Circumference of the unworn tube. If it is left out at all places, the whole "
        "chart is the tube.",
    )


class LimbRequest(GaugedRequest):
    """A tube of a chart, and a limb by its girths."""

    outline: OutlineInput = None
    direction: Direction = Field(
        Direction.COURSE, description="Direction of the chart that runs around the limb."
    )
    girths: list[TubeGirth] = Field(
        min_length=2,
        max_length=MAX_GIRTHS,
        description="Girths from one end to the other; between them sizes change evenly.",
    )


class LimbPlaceResult(ResultModel):
    """Fit at one place along the limb."""

    at_mm: float
    rest_mm: float = Field(description="Circumference of the unworn tube.")
    girth_mm: float = Field(description="Circumference of the limb.")
    ease: float = Field(description="Tube over limb, minus one; negative where it is stretched.")
    mmhg: Ends | None = Field(
        description="Mean pressure, from axially free to axially fixed; null where there is none."
    )
    mmhg_with_spread: Ends | None = Field(
        description="Mean pressure, widened by the 90 % interval of the chart's stress."
    )
    lock_up_share: float = Field(
        description="Strain around the limb over that at which the chart is locked."
    )
    problem: str = Field(description="Reason why there is no pressure, such as a loose fit.")

    @classmethod
    def of_place(cls, place: LimbPlace, **more: Any) -> Self:
        """Make the result of a place, with its pressure in mmHg."""
        kpa = place.pressure and place.pressure.kpa
        spread = place.pressure and place.pressure.kpa_with_spread
        return cls.of(
            place,
            mmhg=kpa and kpa.scaled(MMHG_PER_KPA),
            mmhg_with_spread=spread and spread.scaled(MMHG_PER_KPA),
            **more,
        )

    @property
    def line(self) -> str:
        """The place in words, for a table."""
        if self.mmhg is None or self.mmhg_with_spread is None:
            pressure = "loose" if self.ease > 0.0 else self.problem
        else:
            low, high = self.mmhg_with_spread
            pressure = f"{self.mmhg[0]:5.1f} to {self.mmhg[1]:5.1f} ({low:.1f} to {high:.1f})"
        return (
            f"{self.at_mm:4.0f} mm {self.girth_mm:4.0f} mm {self.rest_mm:4.0f} mm  "
            f"{self.ease:+4.0%}  {pressure:27} {self.lock_up_share:.0%}"
        )


HEADING = f"{'at':>7} {'limb':>7} {'tube':>7}  ease   pressure, mmHg (90 %)      to lock-up"


class LimbResult(IntervalResult):
    """Fit along the limb; no medical class."""

    kind: Literal["limb"] = "limb"
    places: list[LimbPlaceResult]
    tightest_mm: float = Field(description="Place where the tube is nearest to its lock-up.")
    loose_mm: float = Field(description="Length along the limb on which the tube is loose.")
    id: str | None = Field(
        None, description="Name of the shape, for 3D views, if the whole chart is the tube."
    )
    length_mm: float | None = Field(
        None, description="Length of the whole chart on the limb, held by nothing along it."
    )
    relaxed_length_mm: float | None = None
    limit_mmhg: float = Field(CAPILLARY_MMHG, description=LIMIT)
    notes: list[str]


def limb(request: LimbRequest, context: Context) -> Viewed[LimbResult]:
    """Ease, pressure by Laplace's law and nearness to lock-up at 21 places along a limb.

    With `rest_mm` at every place, the chart is a repeat of a tube of these sizes: of a chart with
    an outline, the largest rectangle inside. Without, the whole chart is the tube, every row with
    the stitches inside the outline: its first row is where the limb begins, or its first column
    where the columns run around it. The 3D view can show such a tube.

    Raises
    ------
    InputError
        If the places do not increase, some have a `rest_mm` and others none, the chart is not
        a tube, or the material lacks a fabric of the chart.
    """
    rests = [g.rest_mm for g in request.girths if g.rest_mm is not None]
    shaped, material = _shaped(request, context)
    worn = shaped.rectangle_inside() if rests else shaped.continued()
    answer = predict(worn, material, request.relaxed_size)
    source = in_a_sentence(answer.stretch_errors)
    if not rests:
        tube = _tube(request, context)
        return Viewed(_of_tube(tube, shaped, request, source), _view(tube, request.direction))
    if len(rests) < len(request.girths):
        raise InputError(
            "girths", "some places have a rest_mm and others none.", "Give it for all, or for none."
        )
    places = on_limb(
        answer.along(request.direction),
        [g.at_mm for g in request.girths],
        [g.girth_mm for g in request.girths],
        rests,
    )
    length = places[-1].at_mm - places[0].at_mm
    fit = _fit(places, places, length)
    return Viewed(
        LimbResult(**fit, interval_source=source, notes=[*_too_tight(places), ELASTIC_MEAN]), None
    )


def _shaped(request: LimbRequest, context: Context) -> tuple[ShapedChart, Material]:
    chart, material = request.fabric(context)
    if request.outline is None:
        return ShapedChart.rectangle(chart), material
    return ShapedChart(chart, outline_marks(request.outline)), material


def _tube(request: LimbRequest, context: Context) -> TubeOnLimb:
    shaped, material = _shaped(request, context)
    check_stitches(shaped.chart.stitches, MAX_STITCHES)
    girths = request.girths
    on = MeasuredLimb(tuple(g.at_mm for g in girths), tuple(g.girth_mm for g in girths))
    return worn_tube(
        shaped.chart,
        material,
        on,
        request.direction,
        stitches=shaped.stitch,
        size=request.relaxed_size,
    )


def _of_tube(
    tube: TubeOnLimb, shaped: ShapedChart, request: LimbRequest, source: str
) -> LimbResult:
    repeat = shaped.continued().repeat_cut()
    patched = max(repeat.rows, repeat.columns) > SIDE
    last = len(tube.places) - 1
    evenly = {round(k * last / (PLACES - 1)) for k in range(PLACES)}
    tightest = max(range(len(tube.places)), key=lambda k: tube.places[k].highest_mmhg)
    return LimbResult.of(
        tube,
        **_fit([tube.places[k] for k in sorted(evenly | {tightest})], tube.places, tube.length_mm),
        interval_source=source,
        id=OPERATION.key(request),
        notes=[
            *_too_tight(tube.places),
            ELASTIC_MEAN,
            FREE_ALONG,
            *([BY_PATCHES] if patched else []),
        ],
    )


def _too_tight(places: Sequence[LimbPlace]) -> tuple[str, ...]:
    """A warning if the tube presses too hard somewhere."""
    return too_tight(max(place.highest_mmhg for place in places))


def _view(tube: TubeOnLimb, around: Direction) -> PosedView:
    rows, columns = (n - 1 for n in tube.corners_mm.shape[:2])
    lines = np.array([place.highest_mmhg for place in tube.places], dtype=np.float32)
    return PosedView(
        tube.corners_mm.astype(np.float32),
        Body.around(tube.limb_mm),
        np.broadcast_to(
            lines[:, None] if around is Direction.COURSE else lines, (rows, columns)
        ).copy(),
    )


def _fit(
    listed: Sequence[LimbPlace], every: Sequence[LimbPlace], length_mm: float
) -> dict[str, Any]:
    loose = sum(place.ease >= 0.0 for place in every) / len(every)
    return {
        "places": [LimbPlaceResult.of_place(place) for place in listed],
        "tightest_mm": max(every, key=lambda place: place.lock_up_share).at_mm,
        "loose_mm": loose * length_mm,
    }


@click.option(
    "--girth",
    "girths",
    metavar="AT:GIRTH[:REST]",
    multiple=True,
    required=True,
    help="Places in mm, two or more: along the limb, around it, and around the unworn tube there. "
    "Without REST the whole chart is the tube.",
)
def _girths(girths: tuple[str, ...]) -> dict[str, Any]:
    names = ("at_mm", "girth_mm", "rest_mm")
    try:
        parts = [[float(part) for part in girth.split(":")] for girth in girths]
        return {"girths": [dict(zip(names, part, strict=len(part) != 2)) for part in parts]}
    except ValueError:
        raise InputError(
            "girth",
            f"{' '.join(girths)} cannot be read as girths.",
            "Write each as 0:170 or 0:170:140.",
        ) from None


@out_option("--out", help="Write the tube on the limb to FILE.glb.", suffixes=(".glb",))
def _and_write(request: LimbRequest, context: Context, out: Path | None) -> Viewed[LimbResult]:
    if out is not None:
        if any(girth.rest_mm is not None for girth in request.girths):
            raise InputError("out", "needs a tube that is the whole chart.", "Leave REST out.")
        shaped, material = _shaped(request, context)
        corners_mm = _tube(request, context).corners_mm
        out.write_bytes(write_curled_glb(shaped.chart, corners_mm, material, shaped.stitch))
    return limb(request, context)


def _lines(r: LimbResult) -> list[str]:
    head = (
        []
        if r.length_mm is None
        else [f"on the limb {r.length_mm:.0f} mm long, unworn {r.relaxed_length_mm:.0f} mm"]
    )
    return [
        *head,
        HEADING,
        *(place.line for place in r.places),
        f"nearest to its lock-up at {r.tightest_mm:.0f} mm; loose over {r.loose_mm:.0f} mm",
    ]


OPERATION = Operation(
    limb,
    tag="mechanics",
    summary="Fit and pressure of a knitted tube along a limb",
    most_stitches=MAX_STITCHES,
    example={
        "chart": "KP",
        "material": "acrylic",
        "girths": [
            {"at_mm": 0, "girth_mm": 170, "rest_mm": 140},
            {"at_mm": 200, "girth_mm": 260, "rest_mm": 200},
        ],
    },
    heavy=True,
    command=Command(
        _lines,
        more="The result has ease, pressure and nearness to lock-up along the limb.",
        names={"girths": None},
        fields=_girths,
        run=_and_write,
    ),
)
