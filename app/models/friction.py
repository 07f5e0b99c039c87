"""Friction between yarns in requests and results of the yarn level."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from typing import Self

from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import check_stitches
from knitcore.yarn.library.yarns import yarn_friction
from knitcore.yarn.model.relaxed_cell import RelaxedCell
from knitcore.yarn.solve.friction import MAX_COEFFICIENT, MAX_STITCHES
from knitcore.yarn.study.hysteresis import TAKE_DOWN_N_PER_MM, WORN_N_PER_MM, History
from knitcore.yarn.study.relax import Branch, RelaxedRepeat

from ..context import Context
from .base import Ends, ResultModel
from .checks import with_others
from .yarn_level import YarnLevelRequest

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

    def with_friction(self, context: Context) -> Self:
        """The request with its coefficient of friction, that of the yarn unless it is given.

        Raises
        ------
        InputError
            With all that cannot be had with friction.
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
        """Yield an error for each option that cannot be had with friction."""
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
