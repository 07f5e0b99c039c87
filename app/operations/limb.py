"""Fit and pressure of a knitted tube along a limb."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.models.base import Ends, RequestModel, ResultModel
from app.models.charts import ChartInput, MaterialName, to_chart
from app.models.laws import LawsRequest
from app.operations.context import Context
from app.operations.registry import Operation
from knitcore.answer.choose import choose
from knitcore.answer.limb import MAX_GIRTHS, LimbPlace, on_limb
from knitcore.fabric import Direction
from knitcore.mechanics.pressure import ELASTIC_MEAN, MMHG_PER_KPA


class Girth(RequestModel):
    """Circumferences at one place."""

    at_mm: float = Field(
        ge=0,
        le=3000,
        allow_inf_nan=False,
        description="Along the limb, from where the tube begins.",
    )
    girth_mm: float = Field(gt=0, le=3000, allow_inf_nan=False, description="Around the limb.")
    rest_mm: float = Field(
        gt=0, le=3000, allow_inf_nan=False, description="Around the unworn tube."
    )


class LimbRequest(LawsRequest):
    """A tube of a chart, and a limb by its girths."""

    chart: ChartInput
    material: MaterialName
    direction: Direction = Field(Direction.COURSE, description="Around the limb.")
    girths: list[Girth] = Field(
        min_length=2,
        max_length=MAX_GIRTHS,
        description="From one end to the other; between them sizes change evenly.",
    )


class LimbPlaceResult(ResultModel):
    """Fit at one place along the limb."""

    at_mm: float
    rest_mm: float = Field(description="Around the unworn tube.")
    girth_mm: float = Field(description="Around the limb.")
    ease: float = Field(description="Tube over limb, minus one; negative where it is stretched.")
    mmhg: Ends | None = Field(
        description="Mean pressure, from axially free to axially fixed; null where there is none."
    )
    mmhg_with_spread: Ends | None = Field(
        description="The same, widened by the 90 % interval of the chart's stress."
    )
    lock_up_share: float = Field(
        description="Strain around the limb over that at which the chart is locked."
    )
    problem: str = Field(description="Why there is no pressure, such as a loose fit.")


class LimbResult(ResultModel):
    """Fit along the limb; no medical class."""

    kind: Literal["limb"] = "limb"
    places: list[LimbPlaceResult]
    tightest_mm: float = Field(description="Where the tube is nearest to its lock-up.")
    loose_mm: float = Field(description="Length along the limb on which the tube is loose.")
    notes: list[str]


def limb(request: LimbRequest, context: Context) -> LimbResult:
    """Ease, pressure by Laplace's law and nearness to lock-up at 21 places along a limb.

    Raises
    ------
    InputError
        If the places do not increase, or the material lacks a fabric of the chart.
    """
    answer = choose(to_chart(request.chart), context.material(request.material))
    found = on_limb(
        answer.along(request.direction),
        [g.at_mm for g in request.girths],
        [g.girth_mm for g in request.girths],
        [g.rest_mm for g in request.girths],
    )
    step = found[1].at_mm - found[0].at_mm
    loose = sum(place.ease >= 0.0 for place in found) / len(found) * step * (len(found) - 1)
    return LimbResult(
        places=[_result(place) for place in found],
        tightest_mm=max(found, key=lambda place: place.lock_up_share).at_mm,
        loose_mm=loose,
        notes=[ELASTIC_MEAN],
    )


def _result(place: LimbPlace) -> LimbPlaceResult:
    pressed = place.pressure
    return LimbPlaceResult.of(
        place,
        mmhg=None if pressed is None else pressed.kpa.scaled(MMHG_PER_KPA),
        mmhg_with_spread=(
            None if pressed is None else pressed.kpa_with_spread.scaled(MMHG_PER_KPA)
        ),
    )


OPERATION = Operation(
    limb,
    tag="mechanics",
    summary="Fit and pressure of a knitted tube along a limb",
    example={
        "chart": "KP",
        "material": "acrylic",
        "girths": [
            {"at_mm": 0, "girth_mm": 170, "rest_mm": 140},
            {"at_mm": 200, "girth_mm": 260, "rest_mm": 200},
        ],
    },
)
