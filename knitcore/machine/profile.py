"""Profiles of knitting machines: what a machine has, takes and refuses.

A profile is a JSON file. Those of this package are in ``knitcore/machine/data``; a user's own has
the same fields and is read with :meth:`MachineProfile.read`. ``sources`` of a profile names where
each figure comes from; a figure of nobody's is called a stated guess there.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import Annotated, Literal

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError

from knitcore.base.errors import InputError

FORMAT = "knitcore-machine"
MAX_BYTES = 100_000
GUESS = "stated guess"
"""The source of a figure that neither a maker nor a user of the machine states."""

_Name = Annotated[str, Field(min_length=1, max_length=80)]
_Identifier = Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9-]{0,39}$")]
_Count = Annotated[int, Field(ge=0, le=100)]
_Number = Annotated[float, Field(ge=0, le=10_000, allow_inf_nan=False)]
_Above = Annotated[float, Field(gt=0, le=10_000, allow_inf_nan=False)]
_STRICT = ConfigDict(extra="forbid")


class Dialect(StrEnum):
    """The language in which a machine is programmed.

    ``knitout`` brings yarn in with a hook; ``kniterate`` is knitout for carriers without a hook,
    after waste yarn; ``hand`` is a plan that a knitter follows row by row.
    """

    KNITOUT = "knitout"
    KNITERATE = "kniterate"
    HAND = "hand"


@dataclass(frozen=True)
class CarrierPark:
    """The yarn carriers, named 1 to ``count``.

    Attributes
    ----------
    waste : the carrier of waste yarn; None lets the program take the first free one.
    draw : the carrier of the draw thread between waste yarn and piece; None for a machine whose
        comb or hook starts a piece without one.
    parking : the side where carriers that are out wait.
    hooks : whether a hook brings yarn in and out (``inhook``); ``in`` and ``out`` otherwise.
    """

    __pydantic_config__ = _STRICT

    count: Annotated[int, Field(ge=1, le=32)]
    waste: Annotated[int, Field(ge=1, le=32)] | None = None
    draw: Annotated[int, Field(ge=1, le=32)] | None = None
    parking: Literal["left", "right"] = "left"
    hooks: bool = False


@dataclass(frozen=True)
class Racking:
    """How far the beds move against each other, in needles; 0 if they do not."""

    __pydantic_config__ = _STRICT

    most_needles: _Number
    step_needles: _Above = 1.0


@dataclass(frozen=True)
class StitchNumbers:
    """The numbers of the stitch cam or dial; a larger one makes a longer loop.

    Attributes
    ----------
    whole : whether only whole numbers can be set.
    waste : the number for waste yarn.
    transfer : the number for transfers, where a program can set it.
    """

    __pydantic_config__ = _STRICT

    least: _Number
    most: _Number
    default: _Number
    whole: bool = True
    waste: _Number | None = None
    transfer: _Number | None = None


@dataclass(frozen=True)
class ProgramNumbers:
    """A setting of programs: speed or roller advance, for the piece, its waste and its transfers.

    The unit is the machine's own.
    """

    __pydantic_config__ = _STRICT

    default: _Number
    waste: _Number | None = None
    transfer: _Number | None = None


@dataclass(frozen=True)
class PassTimes:
    """The time that a pass takes.

    Attributes
    ----------
    carriage_speed_m_per_s : while knitting with the default speed.
    turn_s : from the end of a pass to the start of the next.
    transfer_pass_s : further time of a pass that transfers.
    racking_s : time to rack the bed once.
    hand_transfer_s : time to move one stitch by hand.
    """

    __pydantic_config__ = _STRICT

    carriage_speed_m_per_s: _Above
    turn_s: _Number
    transfer_pass_s: _Number = 0.0
    racking_s: _Number = 0.0
    hand_transfer_s: _Number = 0.0


@dataclass(frozen=True)
class DialSwatch:
    """A swatch of the user's, knitted on the machine.

    Attributes
    ----------
    number : the stitch number that it was knitted with.
    loop_length_mm : yarn of a stitch.
    yarn : the identifier of its material.
    """

    __pydantic_config__ = _STRICT

    number: _Number
    loop_length_mm: _Above
    yarn: Annotated[str, Field(max_length=80)] = ""


@dataclass(frozen=True)
class MachineProfile:
    """A knitting machine.

    Attributes
    ----------
    identifier : by which it is chosen.
    header : its name in the header of a program.
    beds : 1 or 2; a single bed purls by hand.
    needles : of one bed.
    needles_per_column : 2 at half gauge, where every other needle rests.
    tuck_with_knit : whether one pass of the carriage can tuck on some needles of a bed and knit on
        others.
    position : header ``Position`` of programs; None writes none.
    speed, roller_advance : None if a program does not set them.
    waste_passes : of waste yarn before a piece, for machines without hooks.
    longest_float_needles : beyond which a float catches on hooks and fingers.
    bed_gap_mm : from a hook to the one that it faces, in a transfer; None takes a stated guess in
        proportion to the distance of the needles.
    take_down_n : force on each loop; None takes a stated guess.
    swatches : of the user's, from which :mod:`knitcore.machine.dial` has stitch numbers.
    sources : where figures come from, by field; the empty name stands for all others.
    """

    __pydantic_config__ = _STRICT

    identifier: _Identifier
    name: _Name
    dialect: Dialect
    beds: Literal[1, 2]
    needles: Annotated[int, Field(ge=1, le=2000)]
    gauge_needles_per_inch: Annotated[float, Field(gt=0, le=40, allow_inf_nan=False)]
    carriers: CarrierPark
    racking: Racking
    tuck_with_knit: bool
    stitch_number: StitchNumbers
    times: PassTimes
    longest_float_needles: Annotated[int, Field(ge=1, le=2000)]
    sources: Annotated[dict[str, str], Field(min_length=1, max_length=40)]
    header: _Name = "generic"
    needles_per_column: Literal[1, 2] = 1
    position: Literal["Keep", "Left", "Center", "Right"] | None = None
    speed: ProgramNumbers | None = None
    roller_advance: ProgramNumbers | None = None
    fabric_presser: bool = False
    bed_gap_mm: _Above | None = None
    take_down_n: _Above | None = None
    waste_passes: Annotated[int, Field(ge=2, le=200)] = 70
    swatches: Annotated[tuple[DialSwatch, ...], Field(max_length=200)] = ()
    format: Literal["knitcore-machine"] = field(default="knitcore-machine", repr=False)
    version: Literal[1] = field(default=1, repr=False)

    def __post_init__(self) -> None:
        numbers, park = self.stitch_number, self.carriers
        for name in ("default", "waste", "transfer"):
            number = getattr(numbers, name)
            if number is not None and not numbers.least <= number <= numbers.most:
                raise InputError(
                    f"stitch_number.{name}",
                    f"{number:g} is outside {numbers.least:g} to {numbers.most:g}.",
                    "Give least ≤ number ≤ most.",
                )
            if numbers.whole and number is not None and number % 1:
                raise InputError(
                    f"stitch_number.{name}",
                    f"{number:g} is no whole number, and the machine has no others.",
                    'Give a whole number, or "whole": false.',
                )
        if 0 < self.racking.most_needles < self.racking.step_needles:
            raise InputError(
                "racking.step_needles",
                f"a step of {self.racking.step_needles:g} needles is beyond the limit of "
                f"{self.racking.most_needles:g}.",
                "Give a step of at most most_needles.",
            )
        if park.hooks and self.dialect is Dialect.KNITERATE:
            raise InputError(
                "carriers.hooks",
                "the dialect kniterate brings yarn in without a hook.",
                'Give "hooks": false, or the dialect knitout.',
            )
        if self.reads_programs and not park.hooks and self.beds == 1:
            raise InputError(
                "beds",
                "without a hook, programs begin with waste yarn on two beds.",
                'Give 2 beds, "hooks": true, or the dialect hand.',
            )
        for name in ("waste", "draw"):
            carrier = getattr(park, name)
            if carrier is not None and carrier > park.count:
                raise InputError(
                    f"carriers.{name}",
                    f"there is no carrier {carrier}: the machine has {park.count}.",
                    f"Give one of 1 to {park.count}.",
                )

    @property
    def columns(self) -> int:
        """The widest chart in columns."""
        return -(-self.needles // self.needles_per_column)

    @property
    def reads_programs(self) -> bool:
        """True if it knits from a program, and not by hand."""
        return self.dialect is not Dialect.HAND

    @property
    def pitch_mm(self) -> float:
        """The distance of two needles of a bed."""
        return 25.4 / self.gauge_needles_per_inch

    @classmethod
    def read(cls, content: bytes | str) -> "MachineProfile":
        """Read a profile from a JSON file's content.

        Raises
        ------
        InputError
            Naming the first field that cannot be used.

        Examples
        --------
        >>> MachineProfile.read(b'{"identifier": "mine"}')
        Traceback (most recent call last):
        knitcore.base.errors.InputError: name: Field required (11 more). Compare the profile with \
one that `knitcore machines swg091n2 --json` prints.
        """
        if isinstance(content, bytes):
            content = content.decode(errors="replace")
        if len(content) > MAX_BYTES:
            raise InputError("machine", "the profile is over 100 kB.", "Give a machine profile.")
        try:
            return _ADAPTER.validate_json(content.removeprefix("\ufeff"))
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            if isinstance(cause := first.get("ctx", {}).get("error"), InputError):
                raise cause from None
            name = ".".join(map(str, first["loc"])) or "machine"
            more = f" ({error.error_count() - 1} more)" if error.error_count() > 1 else ""
            remedy = "Compare the profile with one that `knitcore machines swg091n2 --json` prints."
            raise InputError(name, f"{first['msg']}{more}.", remedy) from None

    def to_json(self) -> str:
        """The profile as the content of a file."""
        return _ADAPTER.dump_json(self, indent=2, exclude_none=True).decode() + "\n"

    def to_dict(self) -> dict[str, object]:
        """The fields by name."""
        return asdict(self)

    def source(self, name: str) -> str:
        """Say where a field's figures come from.

        Examples
        --------
        >>> profile("kniterate").source("needles")
        'public Kniterate back end'
        """
        return self.sources.get(name) or self.sources.get("") or GUESS


_ADAPTER = TypeAdapter(MachineProfile)


@cache
def profiles() -> Mapping[str, MachineProfile]:
    """The profiles of this package by identifier.

    Examples
    --------
    >>> list(profiles())
    ['ayab', 'brother', 'brother-ribber', 'kniterate', 'silver-reed', 'silver-reed-ribber', \
'swg091n2', 'v-bed-half-gauge']
    """
    folder = files("knitcore.machine").joinpath("data")
    shipped = sorted(
        (
            MachineProfile.read(file.read_bytes())
            for file in folder.iterdir()
            if file.name.endswith(".json")
        ),
        key=lambda shape: shape.identifier,
    )
    return MappingProxyType({shape.identifier: shape for shape in shipped})


DEFAULT = "swg091n2"
"""The machine of programs for which none is named."""


def machine_of(text: str | None) -> MachineProfile:
    """A machine by its name, or by the text of a profile of one's own; the default one for None.

    Raises
    ------
    InputError
        If there is none of that name, or the profile cannot be used.

    Examples
    --------
    >>> machine_of("kniterate").carriers.count
    6
    """
    if text is not None and text.lstrip("\ufeff \t\r\n").startswith("{"):
        return MachineProfile.read(text)
    return profile(text or DEFAULT)


def profile(name: str) -> MachineProfile:
    """A profile of this package.

    Raises
    ------
    InputError
        If there is none of that name.
    """
    known = profiles()
    if name not in known:
        raise InputError(
            "machine",
            f"{name[:40]!r} is not a machine.",
            f"Use one of {', '.join(known)}, or a machine profile of your own.",
        )
    return known[name]
