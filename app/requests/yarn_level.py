"""Requests and results of the yarn level, with friction between yarns where it is wanted."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import asdict, replace
from typing import Annotated, Any, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import (
    MAX_STITCHES_PER_SIDE,
    StitchChart,
    check_stitches,
    size_in_words,
)
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.materials import Material
from knitcore.materials.yarn_per_stitch import yarn_per_stitch
from knitcore.yarn.library.yarns import ChartYarn, yarn_for, yarn_friction
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.relaxed_cell import RelaxedCell
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.friction import MAX_COEFFICIENT, MAX_STITCHES
from knitcore.yarn.study.hysteresis import TAKE_DOWN_N_PER_MM, WORN_N_PER_MM, History
from knitcore.yarn.study.relax import Branch, RelaxedRepeat, relax

from ..context import Context
from .base import Ends, Positive, RequestModel, ResultModel
from .charts import MaterialName, RepeatInput, to_chart, to_repeat
from .faults import with_others

LoopLengths = list[Annotated[list[Positive], Field(min_length=1, max_length=MAX_STITCHES_PER_SIDE)]]


class StitchRequest(RequestModel):
    """A repeat and its yarn."""

    chart: RepeatInput
    material: MaterialName
    loop_length_mm: float | None = Field(
        None, gt=0, le=1000, description="Yarn per stitch; the material's by default."
    )

    def repeat(self, most: int | None = None) -> StitchChart:
        """The chart's repeat.

        Raises
        ------
        InputError
            If it has more than ``most`` stitches.
        """
        repeat = to_repeat(self.chart).repeat()
        if most is not None:
            check_stitches(repeat.stitches, most, "its repeat")
        return repeat

    def check_parts(self, context: Context) -> None:
        """Refuse loop lengths and charts that do not go together."""
        self.yarn(self.repeat(), context)

    def yarn(self, repeat: StitchChart, context: Context) -> ChartYarn:
        """The material's yarn in a repeat, with the loop length if it is given."""
        return _yarn(context.material(self.material), repeat, self.loop_length_mm)


class RowLengthsRequest(StitchRequest):
    """A repeat and its yarn, of which rows may have different lengths."""

    loop_lengths_mm: LoopLengths | None = Field(
        None,
        min_length=1,
        max_length=MAX_STITCHES_PER_SIDE,
        description="Yarn per stitch, in place of one length: a list for every row of the chart, "
        "the bottom row first, of one length for all its stitches or one for each.",
        examples=[[[14.0], [12.0]]],
    )
    yarn_per_stitch: bool = Field(
        False,
        description="Give each row the yarn that it takes at one setting of the machine, which is "
        "more where it changes between knit and purl; the mean stitch keeps its loop length. "
        "Without this option all rows have the same.",
    )

    def repeat(self, most: int | None = None) -> StitchChart:
        """The chart's repeat, or the whole chart if its rows have loop lengths of their own."""
        return super().repeat(most) if self.loop_lengths_mm is None else to_chart(self.chart)

    def yarn(self, repeat: StitchChart, context: Context) -> ChartYarn:
        """The material's yarn for a repeat, with the mean of the loop lengths if they are given.

        Raises
        ------
        InputError
            If lengths are given twice.
        """
        lengths, given = self.loop_lengths_mm, self.loop_length_mm
        if lengths is not None and (given is not None or self.yarn_per_stitch):
            other = "yarn_per_stitch" if given is None else "loop_length_mm"
            raise InputError(
                "loop_lengths_mm", f"{other} is given as well.", "Give one of the two."
            )
        if lengths is not None:
            given = float(np.mean([np.mean(row) for row in lengths]))
        return _yarn(context.material(self.material), repeat, given)

    def with_row_lengths(self, context: Context) -> Self:
        """The request with the loop length of each row, where it asks for them and they differ."""
        if not self.yarn_per_stitch:
            return self
        repeat = to_chart(self.chart).repeat()
        mean = self.yarn(repeat, context).loop_length_mm
        own = yarn_per_stitch(repeat, context.material(self.material), periodic=True)
        if own.rows_are_equal:
            return self.model_copy(update={"yarn_per_stitch": False})
        lengths = [[mean * share] for share in own.row_shares.tolist()]
        update = {"yarn_per_stitch": False, "chart": repeat.text, "loop_length_mm": None}
        return self.model_copy(update=update | {"loop_lengths_mm": lengths})


class YarnLevelRequest(RowLengthsRequest):
    """A repeat, its yarn, and the model to use."""

    flat: bool = Field(
        False,
        description="Hold the stitches in one plane, as a fabric laid flat; not in the published "
        "branch.",
    )
    branch: Branch | None = None
    convention: Convention = Convention.PUBLISHED
    fresh: bool = Field(False, description="Compute again, even if the result is stored.")

    def inputs(self, repeat: StitchChart | SymbolChart, used: ChartYarn) -> dict[str, Any]:
        """Everything that decides a result, from which its stored name is made."""
        left_out = {"fresh", "chart", "material", "yarn_per_stitch"}  # lengths say it
        options = self.model_dump(mode="json", exclude=left_out)
        return {"repeat": repeat.text, "used": asdict(used), "asked": options}


def _yarn(material: Material, repeat: StitchChart, loop_length_mm: float | None) -> ChartYarn:
    used = yarn_for(material, repeat, loop_length_mm)
    return used if loop_length_mm is None else replace(used, loop_length_mm=loop_length_mm)


class YarnResult(ResultModel, YarnModel):
    """The yarn that was used, and the source of its numbers."""

    provenance: str
    estimated: bool

    @classmethod
    def of_chart(cls, used: ChartYarn) -> YarnResult:
        """Describe the yarn of a chart."""
        return cls.of(used.yarn, provenance=used.provenance, estimated=used.estimated)


def lengths_of(request: RowLengthsRequest, used: ChartYarn, rows: int, columns: int) -> ArrayLike:
    """One loop length, one for every course, or one for every stitch."""
    table = request.loop_lengths_mm
    if table is None:
        return used.loop_length_mm
    if len(table) != rows or any(len(row) not in (1, columns) for row in table):
        raise InputError(
            "loop_lengths_mm",
            f"they do not fit a chart of {size_in_words(columns, rows)}.",
            "Give every row one length, or one for each of its stitches, the bottom row first.",
        )
    if all(len(row) == 1 for row in table):
        return [row[0] for row in table]
    return [row * (columns // len(row)) for row in table]


def relax_requested(
    repeat: StitchChart, used: ChartYarn, request: YarnLevelRequest, context: Context
) -> RelaxedCell:
    """Relax in the requested branch, at held sizes of a stitch if they are given."""
    lengths = lengths_of(request, used, repeat.rows, repeat.columns)
    return request.pass_to(relax, repeat, used.yarn, lengths, cancelled=context.cancelled)


Request = TypeVar("Request", bound=YarnLevelRequest)
Kept = TypeVar("Kept", bound=ResultModel)


def kept_or_made(
    kind: type[Kept],
    request: Request,
    context: Context,
    make: Callable[[Request, StitchChart, ChartYarn, Context], Kept],
) -> Kept:
    """The stored or new result of a request; it says which."""
    request = request.with_row_lengths(context)
    repeat = request.repeat()
    used = request.yarn(repeat, context)
    result, known = context.kept.get_or_make(
        kind,
        request.inputs(repeat, used),
        lambda: make(request, repeat, used, context),
        fresh=request.fresh,
    )
    return result.model_copy(update={"known": known})


HISTORIES = (
    f"As-knitted: pulled along the columns by {TAKE_DOWN_N_PER_MM:g} N/mm, then released; "
    f"stretched: by {WORN_N_PER_MM:g} N/mm. Agitated: shaken until friction holds nothing."
)
"""Note that explains the histories."""


class RubbedRequest(YarnLevelRequest):
    """A repeat, its yarn, the model to use, and friction between yarns where it is asked for."""

    friction: float | None = Field(
        None,
        ge=0,
        le=MAX_COEFFICIENT,
        description="Coefficient of friction between yarns. Without it, and without the other "
        "options that need one, there is no friction.",
    )

    @property
    @abstractmethod
    def has_friction(self) -> bool:
        """True if an option that needs friction is given."""

    def check_parts(self, context: Context) -> None:
        """Refuse, besides, options that do not go together with friction."""
        super().check_parts(context)
        self.with_friction(context)

    def with_friction(self, context: Context) -> Self:
        """The request with its coefficient of friction, that of the yarn unless it is given.

        Raises
        ------
        InputError
            Naming every option that does not go together with friction.
        """
        if not self.has_friction:
            return self
        faults = self._against_friction()
        if (error := next(faults, None)) is not None:
            raise with_others(error, faults)
        if self.friction is not None:
            return self
        known = yarn_friction(context.material(self.material))
        return self.model_copy(update={"friction": known.coefficient})

    def friction_note(self, context: Context) -> str:
        """The coefficient of friction and where it comes from."""
        known = yarn_friction(context.material(self.material))
        source = known.source if self.friction == known.coefficient else "as given"
        return f"Coefficient of friction {self.friction:g}: {source}."

    def _against_friction(self) -> Iterator[InputError]:
        """Yield an error for each option that does not go together with friction."""
        if self.branch is Branch.PUBLISHED:
            yield InputError(
                "branch", "the published branch has no friction.", "Use mirrored or free."
            )
        if self.flat:
            yield InputError(
                "flat", "a repeat that is held flat cannot have friction.", "Leave it out."
            )
        if any(len(row) > 1 for row in self.loop_lengths_mm or ()):
            yield InputError(
                "loop_lengths_mm",
                "lengths of single stitches hold the yarn, which friction must let slide.",
                "Give one length for each row.",
            )
        try:
            check_stitches(self.repeat().stitches, MAX_STITCHES, "its repeat", " with friction")
        except InputError as error:
            yield error


def on_splines(zero: RelaxedCell) -> RelaxedRepeat:
    """Return the relaxed cell of a request with friction as one on splines."""
    assert isinstance(zero, RelaxedRepeat)  # noqa: S101 - the published branch was refused
    return zero


class RestSizeResult(ResultModel):
    """Size of a stitch free of force after a history."""

    history: History
    course_mm: float
    wale_mm: float
    course_interval_mm: Ends | None = Field(
        None, description="Interval of the size over the interval of friction."
    )
    wale_interval_mm: Ends | None = None


def rest_line(rest: RestSizeResult) -> str:
    """A rest size as commands print it."""
    return f"rest, {rest.history:18}{rest.course_mm:6.3f} × {rest.wale_mm:.3f} mm a stitch"
