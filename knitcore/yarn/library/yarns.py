"""The yarn-level parameters of a material's yarn in a chart.

The paper measured contact data for acrylic and cotton only, and tuned the core radius for each of
the eight samples. A chart of several symmetries gets the mean of the samples' parameters, weighted
by its quarter cells, so that a pure fabric has exactly its own. Any other yarn gets an estimate.

The friction between yarns of the library was not measured. Listed are static and kinetic
coefficients of fibre on fibre (Röder 1953, in Morton and Hearle, Physical Properties of Textile
Fibres, 4th ed., chapter 25). The default is the kinetic one, which a slow pull meets most of the
time; the interval goes up to the static one and down to half the kinetic one, as knitting yarns are
waxed.
"""

import math
from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import sum_in_order
from knitcore.base.errors import InputError
from knitcore.chart.fabric import PHASES, Fabric
from knitcore.chart.phases import quarter_phases
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials import Material, material
from knitcore.materials.yarn_per_stitch import loop_length
from knitcore.yarn.model.paper_samples import Sample, load_samples
from knitcore.yarn.model.yarn_model import YarnModel


@dataclass(frozen=True)
class ChartYarn(Result):
    """Yarn and loop length for a chart.

    Parameters
    ----------
    yarn : the parameters.
    loop_length_mm : mm of yarn per stitch.
    provenance : where they come from, in one sentence.
    estimated : whether contact data were estimated rather than measured and tuned.
    """

    yarn: YarnModel
    loop_length_mm: float
    provenance: str
    estimated: bool


def yarn_for(of: Material, chart: StitchChart, loop_length_mm: float | None = None) -> ChartYarn:
    """Parameters of a material's yarn in a chart.

    Parameters
    ----------
    of, chart : the material and the repeat.
    loop_length_mm : yarn per stitch of fabrics that have none in the material; by default it
        follows from the others' (:func:`~knitcore.materials.yarn_per_stitch.loop_length`).

    Raises
    ------
    InputError
        If the material has no loop length, or neither a diameter nor a bending modulus.
    """
    shares = phase_shares(chart)
    yarn_id = of.identifier.partition(":")[0]  # variants are of the same yarn
    tuned = {s.fabric: s for s in load_samples() if s.yarn_id == yarn_id}
    if tuned:
        parts = [(share, tuned[f].yarn, tuned[f].loop_length_mm) for f, share in shares.items()]
        words = "simulation parameters of the paper (Supplementary Table 7)"
        if len(parts) > 1:
            words += ", mean over the quarter cells"
        return ChartYarn(*_mean(parts), provenance=words, estimated=False)
    parts = [(share, *_estimate(of, fabric, loop_length_mm)) for fabric, share in shares.items()]
    words = (
        "estimated: radius and core from loop length and stitch area, contact stiffness from "
        "bending modulus and radius, in the proportions of acrylic and cotton"
    )
    return ChartYarn(*_mean(parts), provenance=words, estimated=True)


def phase_shares(chart: StitchChart) -> dict[Fabric, float]:
    """Share of each pure fabric in the quarter cells of a repeat (absent ones are left out)."""
    codes = quarter_phases(chart.repeat(), periodic=True)
    counts = np.bincount(codes.ravel(), minlength=len(PHASES)) / codes.size
    return {fabric: float(counts[fabric.phase]) for fabric in PHASES if counts[fabric.phase] > 0}


def _mean(parts: list[tuple[float, YarnModel, float]]) -> tuple[YarnModel, float]:
    def mean(name: str) -> float:
        return sum_in_order(share * float(getattr(yarn, name)) for share, yarn, _ in parts)

    logarithm = sum_in_order(
        share * math.log(yarn.contact_stiffness_n_per_mm3) for share, yarn, _ in parts
    )
    model = YarnModel(
        bending_modulus_n_mm2=mean("bending_modulus_n_mm2"),
        contact_stiffness_n_per_mm3=math.exp(logarithm),
        contact_exponent=mean("contact_exponent"),
        radius_mm=mean("radius_mm"),
        core_radius_mm=mean("core_radius_mm"),
    )
    return model, sum_in_order(share * length for share, _, length in parts)


def _estimate(
    of: Material, fabric: Fabric, loop_length_mm: float | None
) -> tuple[YarnModel, float]:
    """Scale the paper's two yarns in the same fabric to this one."""
    record = of.fabrics.get(fabric)
    if record is None:
        raise InputError(
            "material",
            f"{of.identifier} has no data of {fabric}.",
            "Add the fabric to the material, or use a material that has it.",
        )
    loop = record.loop_length_mm if record.loop_length_mm is not None else loop_length_mm
    if loop is None:
        loop = loop_length(of, fabric).mm
    bending = of.yarn.bending_modulus_n_mm2
    if bending is None:
        raise InputError(
            "material",
            f"the bending modulus of {of.identifier} is not known.",
            "Measure it (`knitcore measure bending`) and put it into the material.",
        )
    side = math.sqrt(record.stitch_course_mm * record.stitch_wale_mm)
    models = [s for s in load_samples() if s.fabric is fabric]
    # a loose fabric has a longer loop and a larger area: both are needed to find the radius
    by_loop = _geometric_mean([s.yarn.radius_mm / s.loop_length_mm for s in models]) * loop
    by_area = _geometric_mean([s.yarn.radius_mm / _side(s) for s in models]) * side
    radius = math.sqrt(by_loop * by_area)
    core = (
        radius
        * sum_in_order(s.yarn.core_radius_mm / s.yarn.radius_mm for s in models)
        / len(models)
    )
    stiffness = of.yarn.compression_stiffness_n_per_mm3
    if stiffness is None:
        stiffness = (
            _geometric_mean([_contact_number(s) for s in models]) * bending / (loop * radius**4)
        )
    exponent = of.yarn.compression_exponent
    if exponent is None:
        exponent = sum_in_order(s.yarn.contact_exponent for s in models) / len(models)
    return YarnModel(bending, stiffness, exponent, radius, core), loop


def _contact_number(sample: Sample) -> float:
    """k r⁴ L / B: contact energy over bending energy, up to a factor."""
    yarn = sample.yarn
    return (
        yarn.contact_stiffness_n_per_mm3
        * yarn.radius_mm**4
        * sample.loop_length_mm
        / yarn.bending_modulus_n_mm2
    )


def _side(sample: Sample) -> float:
    """Side of a square of the sample's stitch area, mm (measured)."""
    record = material(sample.yarn_id).fabrics[sample.fabric]
    return math.sqrt(record.stitch_course_mm * record.stitch_wale_mm)


def _geometric_mean(values: list[float]) -> float:
    return math.exp(sum_in_order(math.log(v) for v in values) / len(values))


SOURCE = (
    "fibre on fibre, kinetic, up to static and down to half for waxed yarn (Röder 1953, in Morton "
    "and Hearle, Physical Properties of Textile Fibres, chapter 25); not measured on this yarn"
)

_STATIC_AND_KINETIC = {
    "cotton": (0.51, 0.26),
    "nylon": (0.47, 0.40),
    "polyamide": (0.47, 0.40),
    "polyester": (0.15, 0.12),
    "viscose": (0.35, 0.26),
    "rayon": (0.35, 0.26),
    "bamboo": (0.35, 0.26),
    # with and against the scales, which point both ways in a yarn
    "wool": (0.37, 0.25),
    "mohair": (0.37, 0.25),
    "cashmere": (0.37, 0.25),
    "alpaca": (0.37, 0.25),
}
_UNLISTED = (0.51, 0.26)
"""Coefficients of unlisted fibres, such as acrylic: those of cotton, the widest common range."""


@dataclass(frozen=True)
class YarnFriction:
    """Friction between yarns of a material.

    Attributes
    ----------
    coefficient, low, high : default and interval.
    source : where they come from, in one sentence.
    """

    coefficient: float
    low: float
    high: float
    source: str


def yarn_friction(of: Material) -> YarnFriction:
    """The coefficient of friction of a material's yarn: its own, or by the first fibre it names.

    A coefficient that is given without an interval is taken as exact.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> yarn_friction(material("cotton")).coefficient
    0.26
    """
    own = of.yarn
    if own.friction is not None:
        ends = own.friction_interval or (own.friction, own.friction)
        return YarnFriction(own.friction, *ends, "given with the material")
    fibre = own.fibre.lower()
    named = [(fibre.find(name), name) for name in _STATIC_AND_KINETIC if name in fibre]
    static, kinetic = _STATIC_AND_KINETIC[min(named)[1]] if named else _UNLISTED
    unlisted = "" if named else "as cotton, since the fibre is not listed: "
    return YarnFriction(kinetic, 0.5 * kinetic, static, unlisted + SOURCE)
