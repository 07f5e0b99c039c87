"""The yarn in the yarn-level model: a rod with a soft shell around a hard core."""

import math
from dataclasses import dataclass, fields

from knitcore.base.errors import InputError

_LIMITS = {
    # Wide enough for sewing thread and for rope; values outside have the wrong unit.
    "bending_modulus_n_mm2": (1e-6, 1e3),
    "contact_stiffness_n_per_mm3": (1e-8, 1e3),
    "contact_exponent": (1.0, 20.0),
    "radius_mm": (1e-3, 1e2),
}


@dataclass(frozen=True)
class YarnModel:
    """Mechanical parameters of one yarn.

    Parameters
    ----------
    bending_modulus_n_mm2 : bending modulus B, N·mm².
    contact_stiffness_n_per_mm3 : compression stiffness k, N/mm³ (the paper's table prints
        mN mm⁻², which its own force law does not allow).
    contact_exponent : exponent p > 1 of the compression law.
    radius_mm : outer radius r, mm: two centre lines more than 2r apart do not touch.
    core_radius_mm : core radius, mm, ``0 <= core < r``: two centre lines come no closer than twice
        this.

    Raises
    ------
    InputError
        If a value is not finite, has the wrong sign, or is so far out of range that its unit must
        be wrong.
    """

    bending_modulus_n_mm2: float
    contact_stiffness_n_per_mm3: float
    contact_exponent: float
    radius_mm: float
    core_radius_mm: float

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not math.isfinite(value):
                raise InputError(field.name, f"{value} is not a number.", "Give a finite value.")
        for name, (low, high) in _LIMITS.items():
            value = getattr(self, name)
            if not low < value < high:
                raise InputError(
                    name, f"{value:g} is out of range.", f"Give a value from {low:g} to {high:g}."
                )
        if self.core_radius_mm < 0:
            raise InputError(
                "core_radius_mm",
                f"{self.core_radius_mm:g} mm is negative.",
                "Give zero or a positive radius.",
            )
        if self.core_radius_mm >= self.radius_mm:
            raise InputError(
                "core_radius_mm",
                f"the core, {self.core_radius_mm:g} mm, is not inside the yarn, "
                f"{self.radius_mm:g} mm.",
                "Give a core radius below the yarn's radius.",
            )
