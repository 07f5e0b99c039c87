"""Readings of a table beyond what the file says, and doubts about a test."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from knitcore.base.errors import InputError


@dataclass(frozen=True)
class TableReading:
    """How a table of a stretch test is read, where the file does not say it or says it wrongly.

    Attributes
    ----------
    width_mm, length_mm : clamped width, and distance of the clamps, at rest.
    columns : what the file calls our columns, such as ``{"force_n": "Channel 2 (N)"}``; an empty
        title leaves a column out.
    units : of our columns, in place of those in the file, such as ``{"force_n": "cN"}``; ``ratio``
        for a strain that is length over length at rest.
    narrowing_is_positive : whether the strain across is positive where the fabric narrows.
    keeps_slack : whether strains count from the first reading although the force rises later.
    """

    width_mm: float | None = None
    length_mm: float | None = None
    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    narrowing_is_positive: bool = False
    keeps_slack: bool = False

    @property
    def sure(self) -> frozenset[str]:
        """Names of the quantities whose size the user has stated."""
        lengths = {name for name in ("width_mm", "length_mm") if getattr(self, name) is not None}
        return frozenset(lengths | {*self.units})

    def over(self, other: "TableReading") -> "TableReading":
        """This reading, and another's where this one says nothing."""
        return replace(
            self,
            width_mm=other.width_mm if self.width_mm is None else self.width_mm,
            length_mm=other.length_mm if self.length_mm is None else self.length_mm,
            columns={**other.columns, **self.columns},
            units={**other.units, **self.units},
            narrowing_is_positive=self.narrowing_is_positive or other.narrowing_is_positive,
            keeps_slack=self.keeps_slack or other.keeps_slack,
        )


@dataclass(frozen=True)
class OtherReading:
    """One answer to a doubt.

    Attributes
    ----------
    words : short, such as ``cm: 70 mm``.
    changes : fields of :class:`TableReading` that say so.
    exchanges : whether the two files change places.
    """

    words: str
    changes: Mapping[str, Any] = field(default_factory=dict)
    exchanges: bool = False


@dataclass(frozen=True)
class Doubt:
    """Something in a test that can be read in more than one way.

    Attributes
    ----------
    field : file and column.
    problem, remedy : sentences, as of an :class:`~knitcore.base.errors.InputError`.
    readings : the answers.
    is_open : whether there is no law before it is answered.
    """

    field: str
    problem: str
    remedy: str
    readings: tuple[OtherReading, ...] = ()
    is_open: bool = True

    @property
    def note(self) -> str:
        """The doubt in a sentence, for a result that was made all the same."""
        return f"{self.field} {self.problem} {self.remedy}"


class DoubtError(InputError):
    """A test that cannot be used before a doubt is answered."""

    doubt: Doubt

    @classmethod
    def about(cls, doubt: Doubt) -> "DoubtError":
        """The refusal."""
        error = cls(doubt.field, doubt.problem, doubt.remedy)
        error.doubt = doubt
        return error

    def __reduce__(self) -> tuple[type[InputError], tuple[str, str, str], dict[str, object]]:
        made, arguments, kept = super().__reduce__()
        return made, arguments, {**kept, "doubt": self.doubt}

    @classmethod
    def of(cls, field: str, problem: str, remedy: str, *readings: OtherReading) -> "DoubtError":
        """The refusal of a test with these other readings."""
        return cls.about(Doubt(field, problem, remedy, readings))


def doubt_of_width(
    field: str, width_mm: float, *, beside_mm: Sequence[float] = (), name: str = "width_mm"
) -> Doubt | None:
    """The doubt whether a width or a length is in mm, if it is small and would fit another unit.

    Parameters
    ----------
    beside_mm : widths or lengths of the other test: one that agrees in another unit says it.
    """
    fitting = [
        (unit, width_mm * factor)
        for unit, factor in _LENGTHS
        if _USUAL_MM[0] <= width_mm * factor <= _USUAL_MM[1]
        and all(abs(width_mm * factor / beside - 1) < _AGREES for beside in beside_mm)
    ]
    if not fitting or width_mm >= NARROW_MM:
        return None
    units = " or ".join(unit for unit, _ in fitting)
    beside = f" beside {beside_mm[0]:g}" if beside_mm else ""
    what = "width" if name == "width_mm" else "distance of the clamps"
    return Doubt(
        f"{field}, {name}",
        f"A {what} of {width_mm:g}{beside} looks like {units}, not mm.",
        f"Give the {what} at rest in mm; {width_mm:g} mm is taken if you say so.",
        (
            *(OtherReading(f"{unit}: {mm:.4g} mm", {name: round(mm, 3)}) for unit, mm in fitting),
            OtherReading(f"{width_mm:g} mm", {name: width_mm}),
        ),
    )


NARROW_MM = 20.0
"""A strip narrower than this is rare; a width of 7 may be 7 cm."""
_LENGTHS = (("cm", 10.0), ("inches", 25.4), ("m", 1000.0))
_USUAL_MM = (15.0, 500.0)
"""Widths and lengths of strips that are tested."""
_AGREES = 0.02
