"""A yarn that is not in the library: laws from measured swatches of it, or from none.

The model is :mod:`knitcore.materials.estimate.yarn_statistics`; its intervals cover 90 % of the
values of yarns left out. They do not cover another tightness: swatch and product share the needle
or stitch setting. There are only eight yarns, five of them from one machine. Extension under load
is predicted best, so it comes first.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from knitcore.base.arrays import Array, Mask
from knitcore.base.bounds import check_range
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.result import Result
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials.estimate.yarn_statistics import (
    DIRECTIONS,
    FABRICS,
    LOAD_N_PER_MM,
    QUANTITIES,
    LibraryTable,
    interval_widths,
    library_table,
    mask_of,
    predict_cells,
)
from knitcore.materials.measured_curves import MeasuredCurve

LOOP_LENGTH_TOLERANCE = 0.1
"""Largest difference of two loop lengths (in logarithms) that counts as the same tightness."""
INTERVAL_SOURCE = "Yarns of the library left out one at a time, the same fabrics of them measured."


@dataclass(frozen=True)
class Estimate:
    """A value with the interval that covers 90 % of left-out values (equal if measured)."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class MeasuredSwatch:
    """A swatch of the new yarn.

    Attributes
    ----------
    fabric : which pure fabric.
    law : fitted to its stretch tests.
    loop_length_mm : yarn per stitch.
    setting : needle or stitch setting, in words ("" if unknown).
    curves : of its stretch tests, by direction, where known.
    """

    fabric: Fabric
    law: ConstitutiveLaw
    loop_length_mm: float
    setting: str = ""
    curves: Mapping[Direction, MeasuredCurve] = field(default_factory=dict)


@dataclass(frozen=True)
class FabricEstimate:
    """One fabric of the new yarn.

    Attributes
    ----------
    strain_at_load : extension at 0.1 N/mm by direction, free to contract.
    modulus : Young's moduli, N/mm.
    alpha : dimensionless. beta : N/mm.
    law : of the central values.
    loop_length_mm : given.
    stitch_course_mm, stitch_wale_mm : from the library's mean proportions of stitch to loop length.
    measured : whether the law is the swatch's own.
    curves : of the swatch's stretch tests, by direction, where known.
    """

    fabric: Fabric
    strain_at_load: Mapping[Direction, Estimate]
    modulus: Mapping[Direction, Estimate]
    alpha: Mapping[Direction, Estimate]
    beta: Mapping[Direction, Estimate]
    law: ConstitutiveLaw
    loop_length_mm: float
    stitch_course_mm: float
    stitch_wale_mm: float
    measured: bool
    curves: Mapping[Direction, MeasuredCurve]


@dataclass(frozen=True, repr=False)
class YarnEstimate(Result):
    """All four fabrics of a new yarn, with warnings.

    Attributes
    ----------
    fabrics : the four.
    warnings : in sentences.
    bending_modulus_n_mm2, product_setting : as given.
    """

    fabrics: Mapping[Fabric, FabricEstimate]
    warnings: tuple[str, ...]
    bending_modulus_n_mm2: float
    product_setting: str


def estimate_yarn(
    bending_modulus_n_mm2: float,
    loop_length_mm: Mapping[Fabric, float] | float,
    swatches: Sequence[MeasuredSwatch] = (),
    *,
    product_setting: str = "",
) -> YarnEstimate:
    """Laws of all four fabrics of a new yarn, with 90 % intervals.

    Parameters
    ----------
    bending_modulus_n_mm2 : B, N·mm² (see :mod:`knitcore.measure.bending_modulus`).
    loop_length_mm : yarn per stitch of the product, per fabric, or one for all.
    swatches : measured swatches of the same yarn, at most one per fabric.
    product_setting : needle or stitch setting of the product, compared with the swatches'.

    Raises
    ------
    InputError
        If a number is impossible, a loop length is missing or a fabric is measured twice.
    """
    check_range("bending_modulus_n_mm2", bending_modulus_n_mm2, 1e-5, 10, "N·mm²")
    loops = _loop_lengths(loop_length_mm)
    table = library_table()
    measured = _measured_mask(swatches)
    length = np.array([[loops[f]] * 2 for f in FABRICS])
    scale = np.log(bending_modulus_n_mm2 / length**3)
    own = _own_values(swatches, bending_modulus_n_mm2)
    estimate = predict_cells(table, own, measured, scale)
    widths = interval_widths(tuple(s.fabric for s in swatches))
    log_width = {name: widths[name] * estimate.deviation[name] for name in QUANTITIES}
    log_width["strain"] = np.full((4, 2), widths["strain"])
    stitch = np.exp(table.stitch.mean(axis=0)) * length
    given = {s.fabric: s for s in swatches}
    fabrics = {}
    for i, fabric in enumerate(FABRICS):
        swatch = given.get(fabric)
        law = swatch.law if swatch else estimate.laws[i]
        width = {name: np.zeros(2) if swatch else log_width[name][i] for name in log_width}
        fabrics[fabric] = FabricEstimate(
            fabric=fabric,
            strain_at_load=_intervals(law, "strain", width),
            modulus=_intervals(law, "modulus", width),
            alpha=_intervals(law, "alpha", width),
            beta=_intervals(law, "beta", width),
            law=law,
            loop_length_mm=loops[fabric],
            stitch_course_mm=float(stitch[i, 0]),
            stitch_wale_mm=float(stitch[i, 1]),
            measured=swatch is not None,
            curves=swatch.curves if swatch else {},
        )
    warnings = tuple(_warnings(swatches, loops, scale, table, product_setting))
    return YarnEstimate(fabrics, warnings, bending_modulus_n_mm2, product_setting)


def _own_values(swatches: Sequence[MeasuredSwatch], bending: float) -> dict[str, Array]:
    own = {name: np.zeros((4, 2)) for name in QUANTITIES}
    for swatch in swatches:
        i = FABRICS.index(swatch.fabric)
        for d in DIRECTIONS:
            # The floors only matter for a swatch without any stiffening.
            scale = bending / swatch.loop_length_mm**3
            own["modulus"][i, d.axis] = math.log(swatch.law.modulus(d) / scale)
            own["alpha"][i, d.axis] = math.log(max(swatch.law.alpha(d), 0.05))
            own["beta"][i, d.axis] = math.log(max(swatch.law.beta(d), 1e-4))
    return own


def _value(law: ConstitutiveLaw, direction: Direction, name: str) -> float:
    if name == "strain":
        return float(free_strains_at_stress(law, direction, LOAD_N_PER_MM))
    constants = {"modulus": law.modulus, "alpha": law.alpha, "beta": law.beta}
    return constants[name](direction)


def _intervals(
    law: ConstitutiveLaw, name: str, log_width: Mapping[str, Array]
) -> dict[Direction, Estimate]:
    """A law's value in both directions, with its interval."""
    estimates = {}
    for d in DIRECTIONS:
        value, factor = _value(law, d, name), math.exp(log_width[name][d.axis])
        estimates[d] = Estimate(value, value / factor, value * factor)
    return estimates


# -- inputs -------------------------------------------------------------------------------------


def _measured_mask(swatches: Sequence[MeasuredSwatch]) -> Mask:
    fabrics = [s.fabric for s in swatches]
    if len(set(fabrics)) < len(fabrics):
        raise InputError(
            "swatches", "a fabric is given twice.", "Give one law per fabric, fitted to all tests."
        )
    for swatch in swatches:
        check_range("swatches.loop_length_mm", swatch.loop_length_mm, 1, 100, "mm")
    return mask_of(fabrics)


def _loop_lengths(given: Mapping[Fabric, float] | float) -> dict[Fabric, float]:
    loops = dict(given) if isinstance(given, Mapping) else dict.fromkeys(FABRICS, given)
    missing = [f.value for f in FABRICS if f not in loops]
    if missing:
        remedy = "Unravel ten stitches of each fabric and divide, or give one length for all."
        raise InputError("loop_length_mm", f"is missing for {', '.join(missing)}.", remedy)
    for fabric, length in loops.items():
        check_range(f"loop_length_mm.{fabric}", length, 1, 100, "mm")
    return loops


def _warnings(
    swatches: Sequence[MeasuredSwatch],
    loops: Mapping[Fabric, float],
    scale: Array,
    table: LibraryTable,
    product_setting: str,
) -> list[str]:
    warnings = []
    for swatch in swatches:
        setting, product = swatch.setting.strip().lower(), product_setting.strip().lower()
        if setting and product and setting != product:
            warnings.append(
                f"The {swatch.fabric} swatch was knitted with {swatch.setting}, the product with"
                f" {product_setting}: the intervals do not cover another tightness (2.0 instead"
                " of 2.75 mm needles changed a modulus three times more than the loop length"
                " explains)."
            )
        ratio = swatch.loop_length_mm / loops[swatch.fabric]
        if abs(math.log(ratio)) > LOOP_LENGTH_TOLERANCE:
            warnings.append(
                f"The {swatch.fabric} swatch has {swatch.loop_length_mm:.2f} mm of yarn per stitch,"
                f" the product {loops[swatch.fabric]:.2f} mm: that is another needle or stitch"
                " setting, which the intervals do not cover."
            )
    if scale.min() < table.scale.min() - 0.3 or scale.max() > table.scale.max() + 0.3:
        warnings.append(
            "B / L³ is outside the range of the eight yarns behind the estimate; the intervals"
            " may be too narrow."
        )
    if not swatches:
        warnings.append(
            "No swatch was measured: testing one stockinette swatch in both directions would narrow"
            " the intervals most."
        )
    return warnings
