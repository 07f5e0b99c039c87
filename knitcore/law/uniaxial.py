"""A uniaxial test of a homogeneous sheet: stress and transverse strain at given axial strains."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.base.kinds import as_numbers
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.law.constitutive import ConstitutiveLaw, Transverse
from knitcore.law.stiffening import stiffening

_HALVINGS = 52
"""Halvings that reduce an interval to the rounding error of a double."""
_NEWTON_STEPS = 200


@dataclass(frozen=True, eq=False, repr=False)
class UniaxialCurve(Result):
    """Response of a sheet pulled in one direction; arrays of one length.

    Attributes
    ----------
    strain : axial engineering strain.
    transverse_strain : strain across the pull.
    stress : N/mm, axial force per initial width.
    """

    strain: Array
    transverse_strain: Array
    stress: Array


def uniaxial_response(
    law: ConstitutiveLaw,
    direction: Direction,
    strain: ArrayLike,
    *,
    transverse: Transverse = Transverse.FREE,
) -> UniaxialCurve:
    """Pull a sheet to the given strains (an array of any length).

    Raises
    ------
    InputError
        If a strain reaches the lock-up.
    """
    axial = np.atleast_1d(as_numbers("strain", strain, "Give finite strains."))
    if not np.all(np.isfinite(axial)):
        raise InputError("strain", "has values that are not numbers.", "Give finite strains.")
    check_below_lock_up(law, direction, float(axial.max(initial=0.0)))
    across = (
        np.zeros_like(axial)
        if transverse is Transverse.FIXED
        else free_transverse_strains(law, direction, axial)
    )
    stress = law.stress(*_pair(direction, axial, across))[direction.axis]
    return UniaxialCurve(strain=axial, transverse_strain=across, stress=stress)


def free_strains_at_stress(law: ConstitutiveLaw, direction: Direction, stress: ArrayLike) -> Array:
    """Axial strains of the full law at stresses (N/mm, at least 0) of any shape, transversely free.

    Raises
    ------
    InputError
        If a stress is negative or not a number.
    """
    stresses = _checked(stress)
    # The linear part alone bounds the strain; free contraction only softens it.
    low, high = np.zeros_like(stresses), stresses / law.modulus(direction)
    if min(law.poisson_yx, law.poisson_xy) < 0 or law.kappa_xx > 0 or law.kappa_yy > 0:
        return _by_newton(law, direction, stresses, low, high)
    modulus, alpha, beta = law.modulus(direction), law.alpha(direction), law.beta(direction)
    high = np.minimum(high, law.lock_up_strain(direction))
    return _by_halving(lambda e: modulus * e + beta * stiffening(alpha * e)[1], stresses, low, high)


def held_strains_at_stress(law: ConstitutiveLaw, direction: Direction, stress: ArrayLike) -> Array:
    """Axial strains of the full law at stresses (N/mm, at least 0) of any shape, the width held.

    Raises
    ------
    InputError
        If a stress is negative or not a number.
    """
    stresses = _checked(stress)
    axis = direction.axis
    low, high = np.zeros_like(stresses), stresses / law.stiffness[axis, axis]
    high = np.minimum(high, law.lock_up_strain(direction))
    return _by_halving(
        lambda e: law.stress(*_pair(direction, e, np.zeros_like(e)))[axis], stresses, low, high
    )


def _checked(stress: ArrayLike) -> Array:
    remedy = "Give 0 N/mm or more."
    stresses = as_numbers("stress", stress, remedy)
    if not np.all(np.isfinite(stresses)) or np.any(stresses < 0):
        raise InputError("stress", "has values that are negative or no numbers.", remedy)
    return stresses


def _pair(direction: Direction, along: Array, across: Array) -> tuple[Array, Array]:
    """Strains course-wise and wale-wise."""
    return direction.of((along, across), (across, along))


def _by_halving(
    carried: Callable[[Array], Array], stresses: Array, low: Array, high: Array
) -> Array:
    """Strain at which an increasing stress has a given value."""
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        less = carried(middle) < stresses
        low, high = np.where(less, middle, low), np.where(less, high, middle)
    return np.asarray((low + high) / 2)


def _by_newton(
    law: ConstitutiveLaw, direction: Direction, stress: Array, low: Array, high: Array
) -> Array:
    """Newton's method for the strain at a stress, kept between bounds by halving."""
    along, across = direction.axis, direction.other.axis
    strain = np.minimum(high, 0.5 * law.lock_up_strain(direction))
    other = np.zeros_like(strain)
    for _ in range(_NEWTON_STEPS):
        other = free_transverse_strains(law, direction, strain, start=other)
        pair = _pair(direction, strain, other)
        stresses, tangent = law.linearised(*pair)
        excess = stresses[along] - stress
        slope = tangent[..., along, along] - (
            tangent[..., along, across] * tangent[..., across, along] / tangent[..., across, across]
        )
        low, high = np.where(excess < 0, strain, low), np.where(excess < 0, high, strain)
        step = strain - excess / slope
        step = np.where((step >= low) & (step <= high), step, (low + high) / 2)
        if np.all(np.abs(step - strain) <= 1e-13 * (1 + strain)):
            return np.asarray(step)
        # where the transverse stress stays at zero, as far as the tangent tells
        ratio = tangent[..., across, along] / tangent[..., across, across]
        strain, other = step, other - ratio * (step - strain)
    return strain


def check_below_lock_up(law: ConstitutiveLaw, direction: Direction, strain: float) -> None:
    """Refuse a strain at or beyond the lock-up.

    Raises
    ------
    InputError
        Naming the largest strain that is accepted.
    """
    lock_up = law.lock_up_strain(direction)
    if strain >= lock_up:
        raise InputError(
            "strain",
            f"{strain:.3g} is at or beyond the lock-up of this fabric {direction}-wise.",
            f"Use a strain below {lock_up:.3f}.",
        )


def free_transverse_strains(
    law: ConstitutiveLaw, direction: Direction, axial: Array, *, start: Array | None = None
) -> Array:
    """Transverse strains at which the transverse stress vanishes, at axial strains that exist.

    ``start`` is about where they are.
    """
    linear = -law.poisson(direction) * axial
    if law.kappa_xx == 0 and law.kappa_yy == 0 and np.all(linear <= 0):
        return linear  # slack yarn does not stiffen: the linear answer is exact
    # The transverse stress grows and is convex in the transverse strain: after its first step
    # Newton's method comes down to the root from one side.
    axis, across = direction.other.axis, np.zeros_like(axial) if start is None else start
    for _ in range(_NEWTON_STEPS):
        stresses, tangent = law.linearised(*_pair(direction, axial, across))
        step = stresses[axis] / tangent[..., axis, axis]
        across = across - step
        if np.all(np.abs(step) <= 1e-14 * (1 + np.abs(across))):
            break
    return across
