"""Requests of the yarn level about a repeat of any stitches."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar, Self, TypeVar

from pydantic import Field

from knitcore.base.choice import Choice
from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import check_stitches
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.library.yarns import ChartYarn, yarn_friction
from knitcore.yarn.loops.relaxed_stitches import (
    MAX_STITCHES,
    RelaxedStitches,
    StitchHistory,
    relax_stitches,
)

from ..context import Context
from .base import Ends, IntervalResult, ResultModel
from .charts import AnyRepeatInput, PureFabricChart, to_stitches
from .yarn_level import RubbedRequest, StitchRequest

NO_INTERVAL = "No interval: such cells miss sizes of measured cloth by a factor of 1.2 to 1.35."


class AnyHistory(Choice):
    """The treatment of the fabric before it came to rest."""

    AGITATED = "agitated"
    KNITTED = "as-knitted"
    STRETCHED_COURSE = "stretched-course"
    STRETCHED_WALE = "stretched-wale"
    BLOCKED = "blocked"


class AnyStitchesRequest(StitchRequest):
    """A repeat of any stitches and its yarn.

    Attributes
    ----------
    chart : the repeat.
    of_knits_and_purls : fields for charts of knits and purls only.
    """

    chart: AnyRepeatInput

    of_knits_and_purls: ClassVar[tuple[str, ...]] = ()

    def others(self) -> SymbolChart | None:
        """The repeat, if it has other stitches than knits and purls."""
        chart = None if isinstance(self.chart, PureFabricChart) else to_stitches(self.chart)
        return chart.repeat() if isinstance(chart, SymbolChart) else None

    def check_parts(self, context: Context) -> None:
        """Refuse besides what is for charts of knits and purls only."""
        if (stitches := self.others()) is None:
            super().check_parts(context)
            return
        for name in self.of_knits_and_purls:
            if getattr(self, name) != type(self).model_fields[name].default:
                raise InputError(name, "is for charts of knits and purls only.", "Leave it out.")
        self.check_size(stitches)
        self.yarn(stitches.plain, context)

    def check_size(self, stitches: SymbolChart) -> None:
        """Refuse a chart of other stitches that is too large."""
        check_stitches(stitches.rows * stitches.columns, MAX_STITCHES, "its repeat")


Kept = TypeVar("Kept", bound=ResultModel)


class RestedRequest(AnyStitchesRequest, RubbedRequest):
    """A repeat of any stitches, its yarn, the model to use, and its history."""

    history: AnyHistory | None = None

    def check_parts(self, context: Context) -> None:
        """Refuse besides histories that such a chart does not have."""
        super().check_parts(context)
        self.with_friction(context)

    def with_friction(self, context: Context) -> Self:
        """The request with its history and its coefficient of friction, where it has them.

        Raises
        ------
        InputError
            If the history is none of the chart's stitches.
        """
        if self.others() is None:
            return super().with_friction(context)
        history = self.history or AnyHistory.BLOCKED
        if str(history) not in map(str, StitchHistory):
            raise InputError(
                "history",
                f"{history} is for charts of knits and purls only.",
                f"Use {', '.join(StitchHistory)}.",
            )
        friction = self.friction
        if history is AnyHistory.AGITATED:
            friction = None
        elif friction is None:
            friction = yarn_friction(context.material(self.material)).coefficient
        return self.model_copy(update={"history": history, "friction": friction})

    def at_rest(self, stitches: SymbolChart, used: ChartYarn, context: Context) -> RelaxedStitches:
        """The repeat after its history."""
        return self.pass_to(
            relax_stitches, stitches, used.yarn, used.loop_length_mm,
            friction=self.friction or 0.0, cancelled=context.cancelled,
        )  # fmt: skip

    def kept_or_made_of_others(
        self,
        kind: type[Kept],
        context: Context,
        stitches: SymbolChart,
        make: Callable[[Self, SymbolChart, ChartYarn, Context], Kept],
    ) -> Kept:
        """The stored or new result of a repeat of other stitches; it says which."""
        self.check_parts(context)
        request = self.with_friction(context)
        used = request.yarn(stitches.plain, context)
        result, known = context.kept.get_or_make(
            kind,
            request.inputs(stitches, used),
            lambda: make(request, stitches, used, context),
            fresh=request.fresh,
        )
        return result.model_copy(update={"known": known})


class RestedResult(IntervalResult):
    """Yarn at rest: the size of its mean stitch, and the holes of other stitches."""

    cell_course_mm: float | None = Field(
        description="Width of a stitch; null where a cloth of other stitches folds."
    )
    cell_wale_mm: float | None
    cell_course_interval_mm: Ends | None = Field(
        description="90 % interval for knitted cloth; null for a width that was held, and for "
        "other stitches than knits and purls."
    )
    cell_wale_interval_mm: Ends | None
    thickness_mm: float = Field(description="From the lowest to the highest yarn.")
    folded: bool | None = Field(
        None,
        description="True where rows or columns of the cloth stand up; null, as are the next "
        "three, for knits and purls.",
    )
    hole_share: float | None = Field(
        None, description="Part of the cloth that no yarn covers, 0 to 1; null where it folds."
    )
    eyelet_mm2: float | None = Field(
        None,
        description="Mean area of the holes of yarn overs, neighbouring ones together; null "
        "without any, and where the cloth folds.",
    )
    crossings: int | None = Field(
        None, description="Crossings of the yarn that the chart asks for, all kept."
    )


def unless_folded(folded: bool, rested: object) -> dict[str, Any]:
    """Sizes and holes of a cloth of other stitches, which it has unless it folds."""
    names = ("cell_course_mm", "cell_wale_mm", "hole_share", "eyelet_mm2")
    return {name: None if folded else getattr(rested, name) for name in names}


def size_line(r: RestedResult) -> str:
    """The size of a stitch as commands print it."""
    if r.cell_course_mm is None or r.cell_wale_mm is None:
        size = "has no size, as the cloth folds"
    else:
        size = (
            f"{r.cell_course_mm:.3f} mm wide{_between(r.cell_course_interval_mm)}, "
            f"{r.cell_wale_mm:.3f} mm high{_between(r.cell_wale_interval_mm)}"
        )
    return f"{size}, {r.thickness_mm:.2f} mm thick"


def hole_lines(r: RestedResult) -> list[str]:
    """Holes and crossings of other stitches as commands print them."""
    if r.crossings is None:
        return []
    holes = "not known, as the cloth folds"
    if r.hole_share is not None:
        eyelets = "" if r.eyelet_mm2 is None else f", {r.eyelet_mm2:.1f} mm² an eyelet"
        holes = f"{r.hole_share:.0%} of the cloth{eyelets}"
    return [f"holes           {holes}", f"crossings       {r.crossings}, all as the chart asks"]


def _between(ends: tuple[float, float] | None) -> str:
    return "" if ends is None else f" ({ends[0]:.2f} to {ends[1]:.2f})"
