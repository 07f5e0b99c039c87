"""The library: the paper's eight yarns, and their variants."""

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from statistics import median
from types import MappingProxyType

from knitcore.base.errors import InputError
from knitcore.base.extensions import Group, offered
from knitcore.base.kinds import check_kind
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials.consistency import LAW_QUANTITIES, consistent_law
from knitcore.materials.law_uncertainty import DEFAULT_POISSON_SD, LawUncertainty, log_deviation
from knitcore.materials.material import MM_PER_INCH, FabricRecord, Laws, Material, Origin, Yarn
from knitcore.materials.printed_figures import Figure, paper_figures, read_packaged
from knitcore.materials.refitted import refitted

SIMULATION = "simulation"
NEEDLE_2_MM = "needle-2.0mm"
GLOVE = "glove"

IDENTIFIER = "the identifier of a material such as 'acrylic'."
INCONSISTENT = {("acrylic", Fabric.GARTER): frozenset({Direction.COURSE})}
"""Rows of the paper's tables that its own data contradict. Acrylic garter course-wise: the raw file
has the clamp measured twice in place of the width, so stress, C_xxxx, beta_xx and Y_x are 1.6 to
1.8 times too high, and its loop length (10.55 mm) contradicts its stitch area (7.98 mm²)."""


@cache
def load_library(laws: Laws = Laws.REFITTED) -> Mapping[str, Material]:
    """The eight yarns of the paper by identifier, as measured on their default setting.

    Loading checks that each row's figures are consistent and that its stiffness is positive
    definite. Variants are in :func:`load_variants`. With published laws an identifier ends in
    ``:published``; the keys are the same.

    Raises
    ------
    InputError
        If the packaged data contradict themselves.

    Examples
    --------
    >>> list(load_library())[:3]
    ['acrylic', 'cotton', 'lace-acrylic']
    """
    measured = {row["identifier"]: _measured(row) for row in read_packaged("yarns.csv")}
    return MappingProxyType(_with_laws(measured, laws))


@cache
def load_variants(laws: Laws = Laws.REFITTED) -> Mapping[str, Material]:
    """Other records of the same yarns by identifier, ``yarn:variant``.

    ``acrylic:simulation`` and ``cotton:simulation`` are the paper's stitch simulations.
    ``glove-wool:needle-2.0mm`` is the stockinette knitted on 2.0 mm needles (starred in tables 6,
    19 and 20), alone; ``glove-wool:glove`` combines it with the other fabrics on 2.75 mm needles,
    as the paper's glove was knitted (its Methods). Plain ``glove-wool`` is on 2.75 mm needles
    throughout, so that its four fabrics can be compared.
    """
    library = {row["identifier"]: _measured(row) for row in read_packaged("yarns.csv")}
    variants = {}

    def add(
        base: str, variant: str, name: str, fabrics: Mapping[Fabric, FabricRecord], note: str
    ) -> None:
        key, yarn = f"{base}:{variant}", library[base]
        variants[key] = Material(key, f"{yarn.name}, {name}", yarn.yarn, fabrics, note=note)

    for yarn in ("acrylic", "cotton"):
        simulated = {fabric: _record(yarn, fabric, SIMULATION) for fabric in Fabric}
        note = "The paper's simulation of the relaxed stitch; no friction, no fuzz."
        add(yarn, SIMULATION, "simulated", simulated, note)
    tight = {Fabric.STOCKINETTE: _record("glove-wool", Fabric.STOCKINETTE, NEEDLE_2_MM)}
    note = "Stockinette only: the paper has no other fabric on this needle."
    add("glove-wool", NEEDLE_2_MM, "on 2.0 mm needles", tight, note)
    note = "Stockinette on 2.0 mm needles, the other fabrics on 2.75 mm."
    add("glove-wool", GLOVE, "as in the glove", {**library["glove-wool"].fabrics, **tight}, note)
    return MappingProxyType(_with_laws(variants, laws))


def material(identifier: str, laws: Laws | str | None = None) -> Material:
    """A material of the library, one of its variants, or one of an extension's yarn library.

    The laws are the refitted ones by default; ``laws="published"``, or an identifier that ends in
    ``:published``, selects the paper's.

    Raises
    ------
    InputError
        If there is no material of that name.

    Examples
    --------
    >>> from knitcore.chart.fabric import Direction, Fabric
    >>> round(material("acrylic").law(Fabric.GARTER).modulus_course, 2)
    0.13
    >>> round(material("acrylic", laws="published").law(Fabric.GARTER).modulus_course, 2)
    0.22
    >>> material("glove-wool:glove").record(Fabric.STOCKINETTE).loop_length_mm
    9.83
    """
    check_kind("material", identifier, str, f"Give {IDENTIFIER}")
    key = identifier.strip().lower()
    sample = Laws.REFITTED.of(key)
    named = Laws.PUBLISHED if sample != key else Laws.REFITTED
    chosen = named if laws is None else Laws.parse(laws)
    known_material = load_library(chosen).get(sample) or load_variants(chosen).get(sample)
    if known_material is not None:
        return known_material
    others = offered_materials()
    if key not in others:
        known = ", ".join([*load_library(), *load_variants(), *others])
        raise InputError(
            "material", f"{identifier!r} is not in the library.", f"Use a file or one of {known}."
        )
    return others[key]


def as_material(of: Material | str) -> Material:
    """Take a material as it is, or look up its identifier.

    Raises
    ------
    InputError
        If it is neither, or there is no material of that name.
    """
    if isinstance(of, Material):
        return of
    check_kind("material", of, str, f"Give a Material, or {IDENTIFIER}")
    return material(of)


def offered_materials() -> dict[str, Material]:
    """Materials of extensions by identifier; each has only its own laws.

    Warns
    -----
    knitcore.base.extensions.ExtensionWarning
        Of every extension that cannot be used.
    """
    return offered(Group.MATERIALS, Material, {*load_library(), *load_variants()})


def _with_laws(materials: Mapping[str, Material], laws: Laws) -> dict[str, Material]:
    """Materials with published laws, marked as such, or with refitted ones."""
    if laws is Laws.PUBLISHED:
        return {
            key: replace(m, identifier=laws.of(m.identifier))
            if m.record(next(iter(m.fabrics))).origin is Origin.MEASURED
            else m
            for key, m in materials.items()
        }
    return {
        key: replace(m, fabrics={f: refitted(r) for f, r in m.fabrics.items()})
        for key, m in materials.items()
    }


def _measured(row: Mapping[str, str]) -> Material:
    identifier = row["identifier"]
    return Material(
        identifier,
        row["name"],
        _yarn(row),
        {fabric: _record(identifier, fabric) for fabric in Fabric},
        note=_NOTES.get(identifier, ""),
    )


_NOTES = {
    "glove-wool": "Knitted on 2.75 mm needles throughout. The paper's glove has its stockinette on "
    "2.0 mm needles: glove-wool:glove."
}


def _yarn(row: Mapping[str, str]) -> Yarn:
    figures = paper_figures()
    identifier = row["identifier"]
    bending = figures.get(identifier, "B")
    stiffness, exponent = figures.find(identifier, "k"), figures.find(identifier, "p")
    wraps_per_inch = (float(row["wraps_per_inch_low"]) + float(row["wraps_per_inch_high"])) / 2
    deviation = bending.standard_deviation
    return Yarn(
        fibre=row["fibre"],
        product=row["product"],
        bending_modulus_n_mm2=bending.corrected / 1000,
        bending_modulus_sd_n_mm2=None if deviation is None else deviation / 1000,
        compression_stiffness_n_per_mm3=None if stiffness is None else stiffness.corrected / 1000,
        compression_exponent=None if exponent is None else exponent.corrected,
        diameter_mm=round(MM_PER_INCH / wraps_per_inch, 2),
    )


def _record(identifier: str, fabric: Fabric, variant: str = "") -> FabricRecord:
    figures = paper_figures()

    def value(quantity: str, of: str) -> float | None:
        figure = figures.find(identifier, quantity, variant=of, fabric=fabric)
        return None if figure is None else figure.corrected

    # Simulations represent the measured sample, so they share its dimensions.
    sample = "" if variant == SIMULATION else variant
    printed = {
        name: figures.get(identifier, name, variant=variant, fabric=fabric)
        for name in LAW_QUANTITIES
    }
    law = consistent_law(printed)
    area = figures.get(identifier, "stitch_area", variant=sample, fabric=fabric)
    aspect, aspect_source = _aspects()[fabric]
    return FabricRecord(
        fabric=fabric,
        law=law,
        stitch_course_mm=math.sqrt(area.corrected * aspect),
        stitch_wale_mm=math.sqrt(area.corrected / aspect),
        stitch_size_source=f"stitch area of table {area.table}; width to height {aspect}, assumed "
        f"alike for all yarns: {aspect_source}",
        uncertainty=_uncertainty(printed, law),
        origin=Origin.SIMULATED if variant == SIMULATION else Origin.MEASURED,
        loop_length_mm=value("loop_length", sample),
        hand_loop_length_mm=value("loop_length", "hand-knit"),
        yarn_diameter_mm=value("yarn_diameter", sample),
        hand_yarn_diameter_mm=value("yarn_diameter", "hand-knit"),
        setting=_setting(identifier, variant),
        law_source="the paper's tables, as corrected",
        inconsistent=INCONSISTENT.get((identifier, fabric), frozenset()),
        printed=MappingProxyType(printed),
    )


def _setting(identifier: str, variant: str) -> str:
    if variant == NEEDLE_2_MM:
        return "hand-knit on 2.0 mm needles (US 0), 25 columns x 34 rows"
    rows = {row["identifier"]: row["setting"] for row in read_packaged("yarns.csv")}
    return rows[identifier]


@cache
def _aspects() -> Mapping[Fabric, tuple[float, str]]:
    return {
        Fabric(row["fabric"]): (float(row["aspect"]), row["source"])
        for row in read_packaged("aspect.csv")
    }


def _uncertainty(printed: Mapping[str, Figure], law: ConstitutiveLaw) -> LawUncertainty:
    """Uncertainty from the printed ±, or from the median of those that are printed."""
    moduli = (printed["Y_x"], printed["Y_y"])
    stated = all(figure.standard_deviation is not None for figure in moduli)
    course, wale = (
        math.hypot(_log_deviation(figure), figure.half_unit / math.sqrt(3) / figure.corrected)
        for figure in moduli
    )
    return LawUncertainty(
        log_modulus_course=course,
        log_modulus_wale=wale,
        poisson_yx=printed["nu_yx"].standard_deviation or DEFAULT_POISSON_SD,
        poisson_xy=printed["nu_xy"].standard_deviation or DEFAULT_POISSON_SD,
        source=f"± of table {moduli[0].table}, and rounding"
        if stated
        else "none printed: the median relative ± of acrylic and cotton, and rounding",
    )


def _log_deviation(figure: Figure) -> float:
    if figure.standard_deviation is None:
        return _typical_log_deviation()
    return log_deviation(figure.corrected, figure.standard_deviation)


@cache
def _typical_log_deviation() -> float:
    """Median of the relative standard deviations that the paper prints for Young's moduli."""
    return median(
        log_deviation(figure.corrected, figure.standard_deviation)
        for figure in paper_figures()
        if figure.quantity in ("Y_x", "Y_y") and figure.standard_deviation is not None
    )
