"""Requests of the yarn level about a repeat of any stitches."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar, Self, TypeVar

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
from .base import ResultModel
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
        check_stitches(stitches.rows * stitches.columns, MAX_STITCHES, "its repeat")
        self.yarn(stitches.plain, context)


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
