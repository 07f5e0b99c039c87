"""Requests and results of the yarn level."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, replace
from typing import Annotated, Any, TypeVar

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
from knitcore.materials import Material
from knitcore.yarn.library.yarns import ChartYarn, yarn_for
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.relaxed_cell import RelaxedCell
from knitcore.yarn.study.relax import Branch, relax

from ..context import Context
from .base import RequestModel, ResultModel
from .charts import MaterialName, RepeatInput, to_chart, to_repeat

LoopLength = Annotated[float, Field(gt=0, le=1000)]
LoopLengths = list[
    Annotated[list[LoopLength], Field(min_length=1, max_length=MAX_STITCHES_PER_SIDE)]
]


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

    def yarn(self, repeat: StitchChart, context: Context) -> ChartYarn:
        """The material's yarn in a repeat, with the loop length if it is given."""
        return _yarn(context.material(self.material), repeat, self.loop_length_mm)


class YarnLevelRequest(StitchRequest):
    """A repeat, its yarn, and the model to use."""

    loop_lengths_mm: LoopLengths | None = Field(
        None,
        min_length=1,
        max_length=MAX_STITCHES_PER_SIDE,
        description="Yarn per stitch, in place of one length: a list for every row of the chart, "
        "the bottom row first, of one length for all its stitches or one for each.",
        examples=[[[14.0], [12.0]]],
    )
    flat: bool = Field(
        False,
        description="Hold the stitches in one plane, as a fabric laid flat; not in the published "
        "branch.",
    )
    branch: Branch | None = None
    convention: Convention = Convention.PUBLISHED
    fresh: bool = Field(False, description="Compute again, even if the result is stored.")

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
        if lengths is not None and given is not None:
            raise InputError(
                "loop_lengths_mm", "loop_length_mm is given as well.", "Give one of the two."
            )
        if lengths is not None:
            given = float(np.mean([np.mean(row) for row in lengths]))
        return _yarn(context.material(self.material), repeat, given)

    def inputs(self, repeat: StitchChart, used: ChartYarn) -> dict[str, Any]:
        """Everything that decides a result, from which its stored name is made."""
        options = self.model_dump(mode="json", exclude={"fresh", "chart", "material"})
        return {"repeat": repeat.text, "used": asdict(used), "asked": options}


def _yarn(material: Material, repeat: StitchChart, loop_length_mm: float | None) -> ChartYarn:
    used = yarn_for(material, repeat, loop_length_mm)
    return used if loop_length_mm is None else replace(used, loop_length_mm=loop_length_mm)


class YarnResult(ResultModel):
    """The yarn that was used, and the source of its numbers."""

    bending_modulus_n_mm2: float
    contact_stiffness_n_per_mm3: float
    contact_exponent: float
    radius_mm: float
    core_radius_mm: float
    provenance: str
    estimated: bool

    @classmethod
    def of_chart(cls, used: ChartYarn) -> YarnResult:
        """Describe the yarn of a chart."""
        return cls.of(used.yarn, provenance=used.provenance, estimated=used.estimated)


def _lengths(request: YarnLevelRequest, used: ChartYarn, rows: int, columns: int) -> ArrayLike:
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
    repeat: StitchChart,
    used: ChartYarn,
    request: YarnLevelRequest,
    context: Context,
    sizes_mm: tuple[float | None, float | None] = (None, None),
) -> RelaxedCell:
    """Relax in the requested branch, at held sizes of a stitch if they are given."""
    return relax(
        repeat,
        used.yarn,
        _lengths(request, used, repeat.rows, repeat.columns),
        branch=request.branch,
        convention=request.convention,
        cell_course_mm=sizes_mm[0],
        cell_wale_mm=sizes_mm[1],
        flat=request.flat,
        cancelled=context.cancelled,
    )


Request = TypeVar("Request", bound=YarnLevelRequest)
Kept = TypeVar("Kept", bound=ResultModel)


def kept_or_made(
    kind: type[Kept],
    request: Request,
    context: Context,
    make: Callable[[Request, StitchChart, ChartYarn, Context], Kept],
) -> Kept:
    """The stored or new result of a request; it says which."""
    repeat = request.repeat()
    used = request.yarn(repeat, context)
    result, known = context.kept.get_or_make(
        kind,
        request.inputs(repeat, used),
        lambda: make(request, repeat, used, context),
        fresh=request.fresh,
    )
    return result.model_copy(update={"known": known})
