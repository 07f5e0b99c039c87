"""The model of a material file: its fields, and the checks on them."""

from __future__ import annotations

import math
from dataclasses import asdict, fields
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.constitutive import DEFAULT_SHEAR_MODULUS_N_PER_MM, ConstitutiveLaw
from knitcore.materials.consistency import check_stated_constants
from knitcore.materials.law_uncertainty import (
    DEFAULT_POISSON_SD,
    CurveUncertainty,
    LawUncertainty,
    log_deviation,
)
from knitcore.materials.material import FabricRecord, Material, Origin, Yarn
from knitcore.materials.measured_curves import MAX_POINTS, MeasuredCurve

_DEFAULT_RELATIVE_SD = 0.10
"""Standard deviation assumed where a file gives none: the paper's median."""

Length = Annotated[float, Field(gt=0, le=500, description="mm")]
Modulus = Annotated[float, Field(gt=0, le=1000, description="N/mm")]
Deviation = Annotated[float, Field(ge=0, le=1000)]


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class LawDocument(_Model):
    """A law as its stiffnesses, as its moduli and Poisson ratios, or as both if they agree."""

    stiffness_xxxx: Modulus | None = None
    stiffness_yyyy: Modulus | None = None
    stiffness_xxyy: Annotated[float, Field(ge=-1000, le=1000)] | None = None
    stiffness_yyxx: Annotated[float, Field(ge=-1000, le=1000)] | None = None
    modulus_course: Modulus | None = None
    modulus_wale: Modulus | None = None
    poisson_yx: Annotated[float, Field(ge=-2, le=5)] | None = None
    poisson_xy: Annotated[float, Field(ge=-2, le=5)] | None = None
    alpha_xx: Annotated[float, Field(ge=0, le=50)]
    alpha_yy: Annotated[float, Field(ge=0, le=50)]
    beta_xx: Annotated[float, Field(ge=0, le=1000)]
    beta_yy: Annotated[float, Field(ge=0, le=1000)]
    shear_modulus: Modulus = DEFAULT_SHEAR_MODULUS_N_PER_MM
    kappa_xx: Annotated[float, Field(ge=0, le=5)] = 0.0
    kappa_yy: Annotated[float, Field(ge=0, le=5)] = 0.0
    shear_stiffening: Annotated[float, Field(ge=0, le=100)] = 0.0

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if None not in self._stiffnesses() or None not in self._engineering().values():
            return self
        raise ValueError(
            "give stiffness_xxxx, stiffness_yyyy, stiffness_xxyy and stiffness_yyxx, or "
            "modulus_course, modulus_wale, poisson_yx and poisson_xy"
        )

    def _stiffnesses(self) -> tuple[float | None, ...]:
        return self.stiffness_xxxx, self.stiffness_yyyy, self.stiffness_xxyy, self.stiffness_yyxx

    def _engineering(self) -> dict[str, float | None]:
        names = "modulus_course", "modulus_wale", "poisson_yx", "poisson_xy"
        return {name: getattr(self, name) for name in names}

    def to_law(self) -> ConstitutiveLaw:
        """The law.

        Raises
        ------
        InputError
            If it is not positive definite, or if stated moduli contradict the stiffnesses.
        """
        others = {f.name: getattr(self, f.name) for f in fields(ConstitutiveLaw)[4:]}
        if None in self._stiffnesses():
            stated = (value or 0.0 for value in self._engineering().values())
            law = ConstitutiveLaw.of_moduli(*stated, **others)
        else:
            law = ConstitutiveLaw(*(value or 0.0 for value in self._stiffnesses()), **others)
        check_stated_constants(law, self._engineering())
        return law

    @classmethod
    def from_law(cls, law: ConstitutiveLaw) -> LawDocument:
        """The document of a law, as stiffnesses."""
        return cls(**asdict(law))


LogDeviation = Annotated[float, Field(ge=0, le=5, description="of the natural logarithm")]


class CurveDeviationDocument(_Model):
    """Standard deviations of a stress-strain curve, as logarithms."""

    log_stress: LogDeviation
    log_lock_up: LogDeviation = 0.0

    def to_uncertainty(self) -> CurveUncertainty:
        """The uncertainty of the curve."""
        return CurveUncertainty(self.log_stress, self.log_lock_up)


class DeviationDocument(_Model):
    """Standard deviations of the linear constants, in their units, and of what goes beyond them."""

    modulus_course: Deviation | None = None
    modulus_wale: Deviation | None = None
    poisson_yx: Deviation | None = None
    poisson_xy: Deviation | None = None
    curve_course: CurveDeviationDocument | None = None
    curve_wale: CurveDeviationDocument | None = None
    log_shear: LogDeviation | None = None
    source: str = ""


class CurveDocument(_Model):
    """A measured stress–strain curve."""

    strain: Annotated[list[float], Field(min_length=2, max_length=MAX_POINTS)]
    stress_n_per_mm: Annotated[list[float], Field(min_length=2, max_length=MAX_POINTS)]
    pulls: Annotated[int, Field(ge=1)] = 1

    def to_curve(self) -> MeasuredCurve:
        """The curve."""
        return MeasuredCurve(tuple(self.strain), tuple(self.stress_n_per_mm), self.pulls)

    @classmethod
    def from_curve(cls, curve: MeasuredCurve) -> CurveDocument:
        """The document of a curve."""
        return cls.model_validate(asdict(curve))


class FabricDocument(_Model):
    """One pure fabric of a user's material."""

    law: LawDocument
    stitch_course_mm: Length
    stitch_wale_mm: Length
    stitch_size_source: str = "given by the user"
    loop_length_mm: Length | None = None
    hand_loop_length_mm: Length | None = None
    yarn_diameter_mm: Length | None = None
    hand_yarn_diameter_mm: Length | None = None
    setting: str = ""
    origin: Origin = Origin.FITTED
    law_source: str = ""
    inconsistent: tuple[Direction, ...] = ()
    standard_deviation: DeviationDocument = DeviationDocument()
    measured: dict[Direction, CurveDocument] = Field(default_factory=dict)

    def to_record(self, fabric: Fabric) -> FabricRecord:
        """The record of this fabric."""
        law = self.law.to_law()
        if self.loop_length_mm is not None and self.loop_length_mm <= self.stitch_course_mm:
            raise InputError(
                "loop_length_mm",
                f"{self.loop_length_mm:g} mm of yarn cannot make a stitch "
                f"{self.stitch_course_mm:g} mm wide.",
                "Give the length of yarn in one stitch, in mm.",
            )
        return FabricRecord(
            fabric=fabric,
            law=law,
            uncertainty=self._uncertainty(law),
            **{name: getattr(self, name) for name in _SHARED},
            inconsistent=frozenset(self.inconsistent),
            measured={d: curve.to_curve() for d, curve in self.measured.items()},
        )

    def _uncertainty(self, law: ConstitutiveLaw) -> LawUncertainty:
        given = self.standard_deviation
        stated = given.modulus_course is not None and given.modulus_wale is not None

        def logarithmic(value: float, deviation: float | None) -> float:
            return log_deviation(
                value, _DEFAULT_RELATIVE_SD * value if deviation is None else deviation
            )

        def absolute(deviation: float | None) -> float:
            return DEFAULT_POISSON_SD if deviation is None else deviation

        curves = {
            name: None if curve is None else curve.to_uncertainty()
            for name in _CURVES
            for curve in [getattr(given, name)]
        }
        assumed = "stated in the file" if stated else "not stated: 10 % assumed, the paper's median"
        return LawUncertainty(
            log_modulus_course=logarithmic(law.modulus_course, given.modulus_course),
            log_modulus_wale=logarithmic(law.modulus_wale, given.modulus_wale),
            poisson_yx=absolute(given.poisson_yx),
            poisson_xy=absolute(given.poisson_xy),
            source=given.source or assumed,
            log_shear=given.log_shear,
            **curves,
        )

    @classmethod
    def from_record(cls, record: FabricRecord) -> FabricDocument:
        """The document of a record."""
        law, spread = record.law, record.uncertainty
        return cls(
            law=LawDocument.from_law(law),
            **{name: getattr(record, name) for name in _SHARED},
            standard_deviation=DeviationDocument(
                modulus_course=_written(
                    law.modulus_course * _coefficient(spread.log_modulus_course)
                ),
                modulus_wale=_written(law.modulus_wale * _coefficient(spread.log_modulus_wale)),
                poisson_yx=spread.poisson_yx,
                poisson_xy=spread.poisson_xy,
                log_shear=spread.log_shear,
                source=spread.source,
                **{
                    name: CurveDeviationDocument(**asdict(curve))
                    for name in _CURVES
                    if (curve := getattr(spread, name))
                },
            ),
            inconsistent=tuple(sorted(record.inconsistent)),
            measured={d: CurveDocument.from_curve(c) for d, c in record.measured.items()},
        )


_OWN = {"law", "standard_deviation", "inconsistent", "measured"}
_SHARED = tuple(name for name in FabricDocument.model_fields if name not in _OWN)
"""Fields shared with a record; only the figures that the paper prints stay in the library."""
_CURVES = ("curve_course", "curve_wale")


Friction = Annotated[float, Field(ge=0, le=2, description="of yarn on yarn")]


class YarnDocument(_Model):
    """The yarn of a material; every field is optional."""

    fibre: str = ""
    product: str = ""
    bending_modulus_n_mm2: Annotated[float, Field(gt=0, le=100)] | None = None
    bending_modulus_sd_n_mm2: Deviation | None = None
    compression_stiffness_n_per_mm3: Annotated[float, Field(gt=0, le=100)] | None = None
    compression_exponent: Annotated[float, Field(gt=1, le=20)] | None = None
    diameter_mm: Annotated[float, Field(gt=0, le=50)] | None = None
    friction: Friction | None = None
    friction_interval: tuple[Friction, Friction] | None = None

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if self.friction_interval is None:
            return self
        low, high = self.friction_interval
        if self.friction is None or not low <= self.friction <= high:
            raise ValueError("give friction_interval as [low, high], with friction between them")
        return self


class MaterialDocument(_Model):
    """A material file."""

    format: Literal["knitcore-material"] = "knitcore-material"
    version: Literal[1] = 1
    identifier: Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9._:-]{0,63}$")]
    name: Annotated[str, Field(min_length=1, max_length=200)]
    yarn: YarnDocument = YarnDocument()
    fabrics: Annotated[dict[Fabric, FabricDocument], Field(min_length=1)]
    note: str = ""

    def to_material(self) -> Material:
        """The material.

        Raises
        ------
        InputError
            Naming the fabric and the constant that cannot be used.
        """
        fabrics = {}
        for fabric, document in self.fabrics.items():
            try:
                fabrics[fabric] = document.to_record(fabric)
            except InputError as error:
                where = f"fabrics.{fabric}.{error.field}"
                raise InputError(where, error.problem, error.remedy) from error
        return Material(
            self.identifier, self.name, Yarn(**self.yarn.model_dump()), fabrics, note=self.note
        )

    @classmethod
    def from_material(cls, material: Material) -> MaterialDocument:
        """The document of a material; :meth:`to_material` gives it back."""
        yarn = {name: getattr(material.yarn, name) for name in YarnDocument.model_fields}
        return cls(
            identifier=material.identifier,
            name=material.name,
            yarn=YarnDocument(**yarn),
            fabrics={
                fabric: FabricDocument.from_record(record)
                for fabric, record in material.fabrics.items()
            },
            note=material.note,
        )


def _written(value: float) -> float:
    """Round to twelve digits, which stay the same when the file is read and written again."""
    return float(f"{value:.12g}")


def _coefficient(log_standard_deviation: float) -> float:
    """Coefficient of variation; inverse of :func:`log_deviation`."""
    return math.sqrt(math.expm1(log_standard_deviation**2))
