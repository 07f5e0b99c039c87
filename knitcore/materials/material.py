"""Materials: one yarn at one machine setting, with a law for each pure fabric."""

import copyreg
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from types import MappingProxyType
from typing import Any

from knitcore.base import showing
from knitcore.base.choice import Choice
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials.interval_parts import Part
from knitcore.materials.law_uncertainty import LawUncertainty
from knitcore.materials.measured_curves import MeasuredCurve
from knitcore.materials.printed_figures import Figure

MM_PER_INCH = 25.4


def _frozen(mapping: Mapping[object, object]) -> MappingProxyType[object, object]:
    return MappingProxyType(mapping)


# Python cannot pickle read-only mappings, and materials are sent to worker processes.
copyreg.pickle(MappingProxyType, lambda proxy: (_frozen, (dict(proxy),)))


class Origin(StrEnum):
    """Origin of the constants of a law."""

    MEASURED = "measured"
    SIMULATED = "simulated"
    FITTED = "fitted"
    ESTIMATED = "estimated"


class Laws(Choice):
    """The laws used for the paper's yarns: refitted clamp to clamp, or as published."""

    REFITTED = "refitted"
    PUBLISHED = "published"

    def of(self, identifier: str) -> str:
        """The identifier of a material with these laws."""
        sample = identifier.removesuffix(f":{Laws.PUBLISHED}")
        return f"{sample}:{Laws.PUBLISHED}" if self is Laws.PUBLISHED else sample


@dataclass(frozen=True)
class Yarn:
    """The yarn of a material, before it is knitted.

    Attributes
    ----------
    fibre, product : composition, and maker's name of the yarn.
    bending_modulus_n_mm2 : B, in N·mm², with its standard deviation (None if unknown).
    compression_stiffness_n_per_mm3, compression_exponent : k and p of the contact law (None if
        unmeasured).
    diameter_mm : nominal diameter, from the wraps per inch (25.4 mm / WPI). Inside a fabric the
        yarn is squeezed: see :attr:`FabricRecord.yarn_diameter_mm`.
    friction, friction_interval : coefficient of friction of yarn on yarn, with its 90 % interval
        (None if unmeasured; that of the fibre is used then).
    """

    fibre: str = ""
    product: str = ""
    bending_modulus_n_mm2: float | None = None
    bending_modulus_sd_n_mm2: float | None = None
    compression_stiffness_n_per_mm3: float | None = None
    compression_exponent: float | None = None
    diameter_mm: float | None = None
    friction: float | None = None
    friction_interval: tuple[float, float] | None = None


@dataclass(frozen=True)
class FabricRecord:
    """One pure fabric of a material.

    Attributes
    ----------
    fabric : which of the four.
    law : the constants to compute with.
    law_source : where they come from, in words; empty where ``origin`` says enough.
    inconsistent : directions in which the paper's own figures contradict each other.
    printed : the paper's figures behind it, by quantity; empty for other materials.
    loop_length_mm : yarn per stitch (None if unknown).
    hand_loop_length_mm : that of the hand-knit comparison sample, where the paper has one.
    yarn_diameter_mm, hand_yarn_diameter_mm : measured in the fabric (None if unmeasured).
    stitch_course_mm, stitch_wale_mm : relaxed width and height of one stitch.
    stitch_size_source : of these two sizes, in words.
    setting : machine and stitch setting, or needle.
    origin : measured, simulated, fitted or estimated.
    uncertainty : standard deviations of the linear constants.
    measured : curves of the tests behind the law, by direction; empty where none are known.
    """

    fabric: Fabric
    law: ConstitutiveLaw
    stitch_course_mm: float
    stitch_wale_mm: float
    uncertainty: LawUncertainty
    origin: Origin
    loop_length_mm: float | None = None
    hand_loop_length_mm: float | None = None
    yarn_diameter_mm: float | None = None
    hand_yarn_diameter_mm: float | None = None
    stitch_size_source: str = ""
    setting: str = ""
    law_source: str = ""
    inconsistent: frozenset[Direction] = frozenset()
    printed: Mapping[str, Figure] = field(default_factory=lambda: MappingProxyType({}))
    measured: Mapping[Direction, MeasuredCurve] = field(default_factory=dict)

    @property
    def stitch_mm(self) -> tuple[float, float]:
        """Relaxed width and height of one stitch."""
        return self.stitch_course_mm, self.stitch_wale_mm

    @property
    def unknown(self) -> Part:
        """The source of the uncertainty of the law."""
        return Part.YARN if self.origin is Origin.ESTIMATED else Part.LAW

    def stitch_size_mm(self, direction: Direction) -> float:
        """Relaxed extent of one stitch in a direction."""
        return self.stitch_mm[direction.axis]


@dataclass(frozen=True)
class Material:
    """One yarn at one machine setting (or on one needle).

    Attributes
    ----------
    identifier : the name by which commands and files refer to it.
    name : for people.
    yarn : the yarn.
    fabrics : the pure fabrics that are known, up to four.
    note : a caution for the user.
    """

    identifier: str
    name: str
    yarn: Yarn
    fabrics: Mapping[Fabric, FabricRecord]
    note: str = ""

    def __post_init__(self) -> None:
        if not self.fabrics:
            raise InputError("fabrics", "the material has no fabric.", "Give at least one law.")
        object.__setattr__(self, "fabrics", MappingProxyType(dict(self.fabrics)))

    def record(self, fabric: Fabric) -> FabricRecord:
        """The record of one pure fabric.

        Raises
        ------
        InputError
            If this material has no such fabric.
        """
        try:
            return self.fabrics[fabric]
        except KeyError:
            known = ", ".join(self.fabrics)
            problem = f"{self.identifier} has no {fabric}; it has {known}."
            remedy = f"Add a measured or estimated law for {fabric}, or use a chart without it."
            raise InputError("material", problem, remedy) from None

    def law(self, fabric: Fabric) -> ConstitutiveLaw:
        """The constitutive law of one pure fabric."""
        return self.record(fabric).law

    @property
    def sample(self) -> str:
        """The identifier without the choice of laws."""
        return self.identifier.removesuffix(f":{Laws.PUBLISHED}")

    @property
    def is_simulated(self) -> bool:
        """Say whether all fabrics of the material come from yarn-level simulations."""
        return all(record.origin is Origin.SIMULATED for record in self.fabrics.values())

    @property
    def is_complete(self) -> bool:
        """Say whether all four pure fabrics are known, so that any chart can be predicted."""
        return len(self.fabrics) == len(Fabric)

    def yarn_diameter_mm(self, fabric: Fabric) -> float | None:
        """The yarn's diameter in that fabric, or its nominal one if that was not measured."""
        measured = self.record(fabric).yarn_diameter_mm
        return self.yarn.diameter_mm if measured is None else measured

    def to_dict(self) -> dict[str, Any]:
        """Collect the material as :func:`~knitcore.materials.load_material_file` reads it."""
        from knitcore.materials.material_document import MaterialDocument

        return MaterialDocument.from_material(self).model_dump(mode="json", exclude_none=True)

    def __repr__(self) -> str:
        return f"Material({self.identifier}: {self.name}, {', '.join(self.fabrics)})"

    def _repr_html_(self) -> str:
        head = ("", "Y course, wale (N/mm)", "Poisson yx, xy", "lock-up", "stitch (mm)", "laws")
        rows = []
        for fabric, record in self.fabrics.items():
            law = record.law
            lock_up = (f"{law.lock_up_strain(d):.2f}" for d in Direction)
            rows.append(
                (
                    fabric,
                    f"{law.modulus_course:.4f}, {law.modulus_wale:.4f}",
                    f"{law.poisson_yx:.2f}, {law.poisson_xy:.2f}",
                    ", ".join(lock_up),
                    f"{record.stitch_course_mm:.2f} × {record.stitch_wale_mm:.2f}",
                    record.origin,
                )
            )
        title = f"{self.name} ({self.identifier})"
        return showing.captioned(showing.html_table(head, rows), title, self.note)
