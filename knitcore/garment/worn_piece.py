"""The pressure of a garment where it is worn, and the width that gives a target pressure."""

from dataclasses import dataclass
from numbers import Real

from knitcore.base.bounds import check_range
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.materials import Material
from knitcore.mechanics.pressure import LimbPressure, limb_pressure, rest_circumference


@dataclass(frozen=True)
class Worn:
    """One place along a limb.

    Attributes
    ----------
    at_mm : along the limb, from where the garment begins.
    part : of the garment there.
    rest_mm, worn_mm : circumferences of the garment unworn, and of the limb.
    pressure : on the limb; None where there is none.
    problem : why there is none, such as a loose fit or a strain beyond the lock-up; else empty.
    """

    at_mm: float
    part: str
    rest_mm: float
    worn_mm: float
    pressure: LimbPressure | None
    problem: str = ""

    @property
    def ease(self) -> float:
        """Rest over worn circumference, minus one: negative where the garment is stretched."""
        return self.rest_mm / self.worn_mm - 1


def worn(
    material: Material,
    fabric: Fabric,
    around: Direction,
    rest_mm: float,
    worn_mm: float,
    *,
    at_mm: float = 0.0,
    part: str = "",
) -> Worn:
    """A place of a garment of one fabric, whose direction ``around`` runs around the limb."""
    try:
        pressure = limb_pressure(material.law(fabric), around, rest_mm, worn_mm)
    except InputError as error:
        return Worn(at_mm, part, rest_mm, worn_mm, None, f"{error.problem} {error.remedy}")
    return Worn(at_mm, part, rest_mm, worn_mm, pressure)


@dataclass(frozen=True)
class Fit:
    """How tight a garment is: by its ease, or by a target pressure.

    Parameters
    ----------
    ease : rest circumference over the limb's, minus one; negative is tighter.
    mmhg : target pressure; takes precedence over the ease.
    """

    ease: float = -0.15
    mmhg: float | None = None

    def __post_init__(self) -> None:
        for name, value in (("ease", self.ease), ("mmhg", self.mmhg or 0.0)):
            if not isinstance(value, Real):
                remedy = "Give one number for the whole garment."
                raise InputError(name, f"is of type {type(value).__name__}.", remedy)
        check_range("ease", self.ease, -0.6, 1, what="an ease")

    def rest_mm(
        self, worn_mm: float, material: Material, fabric: Fabric, around: Direction
    ) -> float:
        """The rest circumference for a limb; for a pressure, the middle of the interval of sizes.

        Raises
        ------
        InputError
            If the pressure or the circumference cannot be used.
        """
        if self.mmhg is None:
            return worn_mm * (1 + self.ease)
        sizes = rest_circumference(material.law(fabric), around, worn_mm, self.mmhg)
        return (sizes.low + sizes.high) / 2
