"""Pressure of a knitted tube on a limb, by Laplace's law.

A tube of rest circumference C0 worn at C is strained by e = C / C0 - 1 around the limb. Its hoop
tension per worn length is T = sigma(e) / (1 + e_axial), because sigma is force per width at rest.
Over any convex section the mean pressure is

    P = 2 pi T / C

(Laplace's P = T / R for a circle). How much the tube may shorten along the limb is unknown, so the
result is an interval: from axially free (it shortens as in a strip test) to axially fixed (held by
friction or by its ends). No medical class is reported: such classes are defined by standardised
measurements.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import scipy

from knitcore.base.bounds import check_positive
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.law.constitutive import ConstitutiveLaw, Transverse
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials.law_uncertainty import Interval

MMHG_PER_KPA = 760.0 / 101.325
NEAR_LOCK_UP = 0.8
"""Share of the lock-up strain above which small errors of size change the pressure much."""
TESTED_SHARE = 0.7
"""Share of the lock-up strain that stretch tests typically reach (0.6 to 0.8 in the paper's)."""
MAX_CIRCUMFERENCE_MM = 5000.0
MIN_LENGTH = 0.05
"""Least share of its length that an axially free tube keeps; laws do not apply beyond."""
CAPILLARY_MMHG = 32.0
"""Mean pressure at which blood enters the capillaries of a finger's nail fold: E. M. Landis, Heart
15 (1930) 209-228. A garment that presses harder can stop it."""
ELASTIC_MEAN = (
    "A mean over the circumference from an elastic law: pressure is higher where the limb curves "
    "more, and no relaxation, friction or posture is included."
)


@dataclass(frozen=True)
class LimbPressure(Result):
    """Mean pressure of a tube on a limb; intervals go from axially free to fixed, or back.

    Attributes
    ----------
    strain : around the limb.
    kpa, mmhg : pressure.
    tension_n_per_mm : hoop tension per worn length.
    axial_strain_free : strain along the limb if the tube is free to shorten.
    utilisation : strain over lock-up strain.
    warnings : in sentences.
    """

    strain: float
    kpa: Interval
    mmhg: Interval
    tension_n_per_mm: Interval
    axial_strain_free: float
    utilisation: float
    warnings: tuple[str, ...]


def worn_strain(rest_mm: float, worn_mm: float) -> float:
    """Strain around a limb of a tube with two circumferences in mm.

    Raises
    ------
    InputError
        If a circumference is impossible, or the tube is loose.
    """
    for name, value in (("rest_mm", rest_mm), ("worn_mm", worn_mm)):
        check_positive(name, value, "mm", "a circumference", MAX_CIRCUMFERENCE_MM)
    if worn_mm < rest_mm:
        raise InputError(
            "worn_mm",
            f"the tube is loose, {rest_mm:.4g} mm around unworn on a limb of {worn_mm:.4g} mm.",
            "Make it smaller if it is to press.",
        )
    return worn_mm / rest_mm - 1


def limb_pressure(
    law: ConstitutiveLaw,
    direction: Direction,
    rest_mm: float,
    worn_mm: float,
    *,
    tested_strain: float | None = None,
) -> LimbPressure:
    """Pressure of a tube whose given direction runs around the limb.

    Parameters
    ----------
    law : of the fabric.
    direction : which material direction runs around the limb.
    rest_mm, worn_mm : circumferences of the tube, unworn and on the limb.
    tested_strain : largest strain of the stretch tests behind the law; 0.7 of the lock-up strain
        if it is not known.

    Raises
    ------
    InputError
        If a circumference is impossible, or the worn one is at or beyond the lock-up.
    """
    strain = worn_strain(rest_mm, worn_mm)
    if strain >= law.lock_up_strain(direction):
        raise InputError(
            "worn_mm",
            f"a strain of {strain:.2f} is at or beyond the lock-up of this fabric"
            f" ({law.lock_up_strain(direction):.2f}).",
            f"Use a rest circumference above {worn_mm / (1 + law.lock_up_strain(direction)):.0f}"
            " mm.",
        )
    tensions, axial = _tensions(law, direction, strain)
    kpa = tensions.scaled(2 * math.pi / worn_mm * 1000.0)
    utilisation = strain / law.lock_up_strain(direction)
    return LimbPressure(
        strain=strain,
        kpa=kpa,
        mmhg=kpa.scaled(MMHG_PER_KPA),
        tension_n_per_mm=tensions,
        axial_strain_free=axial,
        utilisation=utilisation,
        warnings=(
            *too_tight(MMHG_PER_KPA * kpa.high),
            *_warnings(law, direction, strain, tested_strain),
        ),
    )


def too_tight(mmhg: float, where: str = "It") -> tuple[str, ...]:
    """A warning of a pressure that can stop the blood; infinite where the fabric is locked."""
    if mmhg <= CAPILLARY_MMHG:
        return ()
    amount = f"up to {mmhg:.0f} mmHg"
    if math.isinf(mmhg):
        amount = "more than can be computed, as its fabric can stretch no further"
    return (
        f"{where} may press by {amount}. Above {CAPILLARY_MMHG:.0f} mmHg, at which "
        "blood enters the capillaries of a finger, it can stop the blood: make it looser, or ask "
        "a doctor.",
    )


def too_tight_parts(highest: Sequence[tuple[str, float]]) -> tuple[str, ...]:
    """A warning that names the parts that press too hard, from pairs of a part and mmHg."""
    names = dict.fromkeys(name for name, mmhg in highest if mmhg > CAPILLARY_MMHG)
    most = max((mmhg for _, mmhg in highest), default=0.0)
    return too_tight(most, f"Too tight: {', '.join(names)}. It")


def rest_circumference(
    law: ConstitutiveLaw, direction: Direction, worn_mm: float, mmhg: float
) -> Interval:
    """Rest circumference (mm) of a tube for a target pressure on a limb, as an interval.

    ``high`` gives the target if the tube is axially fixed, ``low`` if it is axially free.

    Parameters
    ----------
    law : of the fabric.
    direction : which material direction runs around the limb.
    worn_mm : circumference of the limb.
    mmhg : target pressure.

    Raises
    ------
    InputError
        If the target or the circumference cannot be used.
    """
    check_positive("mmhg", mmhg, "mmHg", "a target pressure", 300)
    check_positive("worn_mm", worn_mm, "mm", "a circumference", MAX_CIRCUMFERENCE_MM)
    tension = mmhg / MMHG_PER_KPA / 1000.0 * worn_mm / (2 * math.pi)
    circumferences = []
    for transverse in Transverse:
        lock_up = law.lock_up_strain(direction)
        upper = lock_up * (1 - 1e-9) if math.isfinite(lock_up) else 1.0
        while not math.isfinite(lock_up) and _tension(law, direction, upper, transverse) < tension:
            upper *= 2
        # Free to narrow, a fabric may carry less than that even at the lock-up of a held one.
        reached = _tension(law, direction, upper, transverse) >= tension
        strain = (
            scipy.optimize.brentq(
                lambda e, t=transverse: _tension(law, direction, e, t) - tension,
                0.0,
                upper,
                xtol=1e-10,
            )
            if reached
            else upper
        )
        circumferences.append(worn_mm / (1 + float(strain)))
    return Interval(min(circumferences), max(circumferences))


def _tension(
    law: ConstitutiveLaw, direction: Direction, strain: float, transverse: Transverse
) -> float:
    """Hoop tension per worn length (N/mm)."""
    curve = uniaxial_response(law, direction, strain, transverse=transverse)
    return float(curve.stress[0] / max(1 + curve.transverse_strain[0], MIN_LENGTH))


def _tensions(law: ConstitutiveLaw, direction: Direction, strain: float) -> tuple[Interval, float]:
    free = uniaxial_response(law, direction, strain)
    both = [_tension(law, direction, strain, t) for t in Transverse]
    return Interval(min(both), max(both)), float(free.transverse_strain[0])


def _warnings(
    law: ConstitutiveLaw, direction: Direction, strain: float, tested_strain: float | None
) -> list[str]:
    lock_up = law.lock_up_strain(direction)
    warnings = []
    if strain > NEAR_LOCK_UP * lock_up:
        warnings.append(
            f"The strain {strain:.2f} is {strain / lock_up:.0%} of the lock-up {lock_up:.2f}: the"
            " pressure rises steeply here, and a slightly larger limb is pressed much harder."
        )
    limit = TESTED_SHARE * lock_up if tested_strain is None else tested_strain
    if strain > limit:
        known = "stretch tests typically reach" if tested_strain is None else "the tests reached"
        warnings.append(
            f"The strain {strain:.2f} is beyond the {limit:.2f} that {known}: the pressure is"
            " extrapolated."
        )
    axial = float(uniaxial_response(law, direction, strain).transverse_strain[0])
    if axial <= -0.5:
        warnings.append(
            f"Axially free, the tube would shorten by {-axial:.0%}: the linear Poisson ratio does"
            " not hold that far."
        )
    return [*warnings, ELASTIC_MEAN]
