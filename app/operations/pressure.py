"""Pressure of a knitted tube on a limb."""

from __future__ import annotations

import math
from dataclasses import asdict

from pydantic import BaseModel, ConfigDict, Field

from app.results.own_materials import find_material
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.formats.law_files import LawFile, law_from_mapping
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import Material
from knitcore.materials.uncertainty import Z_SCORE, log_deviation
from knitcore.mechanics import pressure


class PressureOptions(BaseModel):
    """Which tube on which limb."""

    model_config = ConfigDict(extra="forbid")

    direction: Direction = Field(description="The material direction around the limb.")
    rest_mm: float | None = Field(None, description="Circumference of the unworn tube.")
    worn_mm: float = Field(description="Circumference of the limb.")
    target_mmhg: float | None = Field(
        None, description="Instead of rest_mm: the pressure wanted, for which to size the tube."
    )


class PressureRequest(PressureOptions):
    """A fabric of a library material, or a law, around a limb."""

    material: str | None = Field(None, max_length=80)
    fabric: Fabric | None = None
    law: dict[str, float] | None = Field(None, description="Constants of a law, by name.")


class IntervalResult(BaseModel):
    """From axially free to axially fixed."""

    low: float
    high: float


class PressureResult(BaseModel):
    """Mean pressure; no medical class."""

    mmhg: IntervalResult = Field(description="From axially free to axially fixed.")
    kpa: IntervalResult
    mmhg_with_law_spread: IntervalResult | None = Field(
        description="The same, widened by the 90 % interval of the fabric's modulus, where known."
    )
    strain: float = Field(description="Around the limb.")
    rest_mm: float
    worn_mm: float
    tension_n_per_mm: IntervalResult = Field(description="Hoop tension per worn length.")
    axial_strain_free: float
    lock_up_share: float = Field(description="Strain over lock-up strain.")
    rest_mm_for_target: IntervalResult | None = Field(
        description="Sizes that press by the target: axially free to axially fixed."
    )
    warnings: list[str]


def run_pressure(request: PressureRequest) -> PressureResult:
    """The pressure that a request asks for.

    Raises
    ------
    InputError
        If neither or both of a law and a material are given.
    """
    if (request.law is None) == (request.material is None):
        raise InputError("law", "one of law and material is needed.", "Give exactly one.")
    if request.law is not None:
        return pressure_of_law(law_from_mapping(request.law), request)
    return pressure_of_material(find_material(request.material or ""), request.fabric, request)


def pressure_of_material(
    material: Material, fabric: Fabric | None, options: PressureOptions
) -> PressureResult:
    """Pressure of a fabric of a material.

    Raises
    ------
    InputError
        If the fabric is not named.
    """
    if fabric is None:
        raise InputError("fabric", "is missing.", "Name the fabric of the material.")
    record = material.record(fabric)
    return _pressure(record.law, options, spread=record.uncertainty.log_modulus(options.direction))


def pressure_of_law(file: LawFile, options: PressureOptions) -> PressureResult:
    """Pressure of a fabric known by its law."""
    name = f"modulus_{options.direction}"
    error = file.standard_errors.get(name)
    spread = None if error is None else log_deviation(file.law.modulus(options.direction), error)
    return _pressure(
        file.law, options, spread=spread, tested=file.largest_strain.get(options.direction)
    )


def _pressure(
    law: ConstitutiveLaw,
    options: PressureOptions,
    *,
    spread: float | None,
    tested: float | None = None,
) -> PressureResult:
    sizes = None
    rest = options.rest_mm
    if (rest is None) == (options.target_mmhg is None):
        raise InputError("rest_mm", "one of rest_mm and target_mmhg is needed.", "Give one.")
    if options.target_mmhg is not None:
        sizes = pressure.rest_circumference(
            law, options.direction, options.worn_mm, options.target_mmhg
        )
        rest = math.sqrt(sizes.low * sizes.high)
    found = pressure.limb_pressure(
        law, options.direction, rest or 0.0, options.worn_mm, tested_strain=tested
    )
    widened = None
    if spread is not None:
        factor = math.exp(Z_SCORE * spread)
        widened = IntervalResult(low=found.mmhg.low / factor, high=found.mmhg.high * factor)
    return PressureResult(
        mmhg=IntervalResult(**asdict(found.mmhg)),
        kpa=IntervalResult(**asdict(found.kpa)),
        mmhg_with_law_spread=widened,
        strain=found.strain,
        rest_mm=rest or 0.0,
        worn_mm=options.worn_mm,
        tension_n_per_mm=IntervalResult(**asdict(found.tension_n_per_mm)),
        axial_strain_free=found.axial_strain_free,
        lock_up_share=found.utilisation,
        rest_mm_for_target=IntervalResult(**asdict(sizes)) if sizes else None,
        warnings=list(found.warnings),
    )
