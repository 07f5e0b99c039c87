"""A yarn from what anyone has: ball band, ruler, kitchen scale, and photos of a hanging swatch.

Each step starts from what the library's eight yarns say and adds a measurement, so that a result
says what each of them brought:

- the wraps of yarn per inch, or its tex, give the bending modulus B = c d², because a yarn's fibres
  slide on each other: c and its scatter are those of the library;
- the gauge gives the yarn in a stitch in the library's proportions, gauge, weight and tex give it
  by weighing, and ten unravelled stitches give it best;
- points of the stretch curve give modulus, alpha and beta of all fabrics, by
  :mod:`knitcore.materials.estimate.mixed_model`. Bending modulus and yarn in a stitch do not enter
  there: of yarns left out they better the moduli from a factor of 2.21 to 2.14 only.

Intervals of the law are as wide as yarns of the library need that are left out one at a time and
measured in the same way.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_range
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import free_strains_at_stress, uniaxial_response
from knitcore.materials.estimate.estimate import Estimate, FabricEstimate
from knitcore.materials.estimate.mixed_model import LogStrain, MixedModel, covering
from knitcore.materials.estimate.yarn_statistics import (
    DIRECTIONS,
    FABRICS,
    LOAD_N_PER_MM,
    library_table,
)
from knitcore.materials.law_uncertainty import COVERAGE, Z_SCORE, CurveUncertainty, LawUncertainty
from knitcore.materials.library import load_library
from knitcore.materials.material import MM_PER_INCH, FabricRecord, Material, Origin, Yarn
from knitcore.measure.stretch_points import StretchPoint

INTERVAL_SOURCE = (
    "Yarns of the library left out one at a time, and measured in the same way; errors of the"
    " measurements."
)
COUNTED_TEX = {"cotton": 393.7, "lace-acrylic": 66.7, "lace-cashmere": 71.4}
"""Linear densities that the names of the library's yarns state: cotton count 3/2, metric 2/30 and
2/28. With the wraps per inch they give the density of wound yarn, 0.09 to 0.17 g/cm³."""
HANGING_SCATTER = 0.08
"""Standard deviation of the logarithm of a strain read once; assumed. Curves of repeated pulls
scatter by 0.05 (median of the refitted laws); a hanging weight adds creep and friction."""
POISSON_SCATTER = 0.05
"""Standard deviation of the ratio of strains, of a law without coupling; assumed."""
COUNT_ERROR = 0.02
"""Relative error of a counted gauge, a weighed or a measured swatch."""
TEX_ERROR = 0.05
"""Relative error of the linear density on a ball band; assumed."""
UNRAVELLED_ERROR = 0.02
"""Relative error of the length of ten unravelled stitches; assumed: 2 mm of crimp in 100."""
WRAPS_ERROR = 0.08
"""Relative error of wraps per inch; assumed: one in twelve."""
LAW_SCATTER = 0.05
"""Relative error of a strain of a fitted law; the median of the refitted laws."""
LAW_STRESSES_N_PER_MM = (0.03, 0.1, 0.3)
"""Stresses at which a fitted law is read."""
_T_90 = 1.895
"""Quantile of Student's distribution for 90 % with seven degrees of freedom."""
_REPEATS = 3
"""Draws of measuring errors for each yarn that is left out."""


@dataclass(frozen=True)
class KnownSwatch:
    """A swatch by ruler, scale and ball band; all but fabric and gauge may be missing (None).

    Attributes
    ----------
    fabric : of the swatch.
    stitches_per_10_cm, rows_per_10_cm : at rest.
    weight_g, width_mm, height_mm : of the swatch.
    ten_stitches_mm : yarn in ten stitches, unravelled.
    tex : linear density on the ball band, g/km.
    wraps_per_inch : of the yarn around a ruler.
    """

    fabric: Fabric
    stitches_per_10_cm: float
    rows_per_10_cm: float
    weight_g: float | None = None
    width_mm: float | None = None
    height_mm: float | None = None
    ten_stitches_mm: float | None = None
    tex: float | None = None
    wraps_per_inch: float | None = None

    def __post_init__(self) -> None:
        limits = {
            "stitches_per_10_cm": (3, 300, ""),
            "rows_per_10_cm": (3, 300, ""),
            "weight_g": (0.1, 1000, "g"),
            "width_mm": (10, 2000, "mm"),
            "height_mm": (10, 2000, "mm"),
            "ten_stitches_mm": (10, 1000, "mm"),
            "tex": (5, 20_000, "tex (g/km)"),
            "wraps_per_inch": (1, 100, ""),
        }
        for name, (low, high, unit) in limits.items():
            value = getattr(self, name)
            if value is not None:
                check_range(name, value, low, high, unit)

    @property
    def stitch_mm(self) -> Array:
        """Width and height of a stitch."""
        return np.array([100 / self.stitches_per_10_cm, 100 / self.rows_per_10_cm])


@dataclass(frozen=True)
class Step:
    """State of knowledge after a measurement.

    Attributes
    ----------
    name : of the measurement.
    loop_length_mm : yarn in a stitch of the swatch.
    bending_modulus_n_mm2 : B.
    strain_at_load, modulus : of the swatch's fabric: extension at 0.1 N/mm, and N/mm.
    other_strains : of the other fabrics: the mean factor of the intervals of their extension.
    """

    name: str
    loop_length_mm: Estimate
    bending_modulus_n_mm2: Estimate
    strain_at_load: Mapping[Direction, Estimate]
    modulus: Mapping[Direction, Estimate]
    other_strains: float


@dataclass(frozen=True)
class UntestedYarn:
    """A yarn whose laws were found without a tensile tester.

    Attributes
    ----------
    fabric : of the swatch.
    steps : the library alone, then each measurement.
    fabrics : all four, after the last step.
    uncertainty : of their laws.
    notes : in sentences.
    """

    fabric: Fabric
    steps: tuple[Step, ...]
    fabrics: Mapping[Fabric, FabricEstimate]
    uncertainty: Mapping[Fabric, LawUncertainty]
    notes: tuple[str, ...]

    def material(self, identifier: str, name: str = "", fibre: str = "") -> Material:
        """The yarn as a material, to keep and to design with."""
        bending = self.steps[-1].bending_modulus_n_mm2
        deviation = math.log(bending.high / bending.low) / 2 / Z_SCORE
        yarn = Yarn(
            fibre=fibre,
            bending_modulus_n_mm2=bending.value,
            bending_modulus_sd_n_mm2=bending.value * math.sqrt(math.expm1(deviation**2)),
        )
        records = {
            fabric: FabricRecord(
                fabric=fabric,
                law=estimate.law,
                stitch_course_mm=estimate.stitch_course_mm,
                stitch_wale_mm=estimate.stitch_wale_mm,
                stitch_size_source="counted gauge"
                if fabric is self.fabric
                else "the gauge of the swatch, in the library's mean proportions",
                uncertainty=self.uncertainty[fabric],
                origin=Origin.ESTIMATED,
                loop_length_mm=estimate.loop_length_mm,
                law_source="the library's yarns and " + ", ".join(s.name for s in self.steps[1:]),
            )
            for fabric, estimate in self.fabrics.items()
        }
        note = "Measured without a tester: " + ", ".join(s.name for s in self.steps[1:]) + "."
        return Material(identifier, name or identifier, yarn, records, note=note)


def points_of_law(fabric: Fabric, law: ConstitutiveLaw) -> tuple[StretchPoint, ...]:
    """Points of the curves of a law that was fitted to tests, from which other fabrics follow."""
    points = []
    for direction in Direction:
        strains = free_strains_at_stress(law, direction, LAW_STRESSES_N_PER_MM).tolist()
        curve = uniaxial_response(law, direction, strains)
        rows = zip(LAW_STRESSES_N_PER_MM, strains, curve.transverse_strain.tolist(), strict=True)
        points += [
            StretchPoint(
                fabric, direction, stress, along, LAW_SCATTER * along, across, LAW_SCATTER * along
            )
            for stress, along, across in rows
        ]
    return tuple(points)


def yarn_without_tester(
    swatch: KnownSwatch, points: Sequence[StretchPoint] = (), *, source: str = "photos"
) -> UntestedYarn:
    """All four fabrics of a yarn, step by step, with 90 % intervals.

    Parameters
    ----------
    swatch : what was counted, weighed and measured.
    points : of stretch curves, from photos.
    source : of the points, in words.

    Raises
    ------
    InputError
        If a number is impossible, or what was measured contradicts itself.
    """
    notes: list[str] = []
    sizes = _Sizes.of(swatch)
    own = FABRICS.index(swatch.fabric)
    steps: list[Step] = []
    known: list[tuple[Estimate, Estimate]] = []
    used: list[LogStrain] = []
    model = _law_model(())
    lengths = sizes.lengths(notes)
    bendings = sizes.bendings()

    def add(name: str) -> None:
        loop, bending = lengths.get(name), bendings.get(name)
        known.append((loop or known[-1][0], bending or known[-1][1]))
        steps.append(_step(name, known[-1], model, tuple(used), own))

    add("library")
    for name in ("ball band", "gauge and weight", "ten stitches"):
        if name in lengths or name in bendings:
            add(name)
    for direction in DIRECTIONS:
        pulled = [point for point in points if point.direction is direction]
        if pulled:
            used += [log_strain(point) for point in pulled]
            model = _law_model(()).knowing(used)
            add(f"{source}, pulled {direction}-wise")
    notes += _hints(swatch, points)
    fabrics, uncertainty = _fabrics(swatch, points, model, tuple(used), known[-1][0].value)
    return UntestedYarn(swatch.fabric, tuple(steps), fabrics, uncertainty, tuple(notes))


def _hints(swatch: KnownSwatch, points: Sequence[StretchPoint]) -> list[str]:
    notes = []
    if any(point.fabric is not swatch.fabric for point in points):
        notes.append("Some photos show another fabric than the swatch that was counted.")
    if not points:
        notes.append(
            "No photo of the hanging swatch was read: the stretch is that of an average yarn."
        )
    elif len({point.direction for point in points}) == 1:
        notes.append(
            f"The swatch was pulled {points[0].direction}-wise only: turn it and take photos of the"
            " other direction, too."
        )
    reach = max((point.force_n_per_mm for point in points), default=LOAD_N_PER_MM)
    if reach < 0.5 * LOAD_N_PER_MM:
        notes.append(
            f"The largest weight is {reach:.3f} N/mm; a garment pulled on by hand carries"
            f" {LOAD_N_PER_MM:g}: hang more on the swatch, or take a narrower one."
        )
    return notes


# -- yarn in a stitch, and bending modulus ----------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Sizes:
    """Logarithms of sizes, each with its standard deviation."""

    swatch: KnownSwatch
    proportion: tuple[float, float]
    slenderness: tuple[float, float]
    bending: tuple[float, float]
    density: tuple[float, float]

    @classmethod
    def of(cls, swatch: KnownSwatch) -> "_Sizes":
        table, library = library_table(), load_library()
        own = FABRICS.index(swatch.fabric)
        yarns = [material.yarn for material in library.values()]
        diameters = np.log([yarn.diameter_mm or math.nan for yarn in yarns])
        bending = np.log([yarn.bending_modulus_n_mm2 or math.nan for yarn in yarns])
        loops = np.log(
            [m.record(swatch.fabric).loop_length_mm or math.nan for m in library.values()]
        )
        areas = math.pi / 4 * np.exp(2 * diameters)
        densities = [
            math.log(COUNTED_TEX[name] / 1000 / area)
            for name, area in zip(library, areas, strict=True)
            if name in COUNTED_TEX
        ]
        return cls(
            swatch,
            proportion=_mean(table.stitch[:, own].mean(axis=1)),
            slenderness=_mean(diameters - loops),
            bending=_mean(bending - 2 * diameters),
            density=_mean(np.array(densities)),
        )

    def lengths(self, notes: list[str]) -> dict[str, Estimate]:
        """Yarn in a stitch of the swatch after each measurement, mm."""
        swatch = self.swatch
        loops = np.log(
            [m.record(swatch.fabric).loop_length_mm or math.nan for m in load_library().values()]
        )
        known = {"library": _interval(*_mean(loops))}
        area = float(np.log(swatch.stitch_mm).mean())
        belief = (area - self.proportion[0], math.hypot(self.proportion[1], COUNT_ERROR))
        weighed = self._weighed()
        if weighed is not None:
            _note_apart(belief, weighed, "gauge", "weight and ball band", notes)
            belief = _joined(belief, weighed)
        known["gauge and weight"] = _interval(*belief)
        if swatch.ten_stitches_mm is not None:
            counted = (math.log(swatch.ten_stitches_mm / 10), UNRAVELLED_ERROR)
            _note_apart(belief, counted, "gauge and weight", "ten unravelled stitches", notes)
            belief = _joined(belief, counted)
            known["ten stitches"] = _interval(*belief)
            if math.exp(belief[0]) <= swatch.stitch_mm.max():
                raise InputError(
                    "ten_stitches_mm",
                    f"{swatch.ten_stitches_mm:g} mm of yarn cannot make ten stitches of"
                    f" {swatch.stitch_mm[0]:.1f} mm.",
                    "Give the length of yarn in ten stitches, in mm.",
                )
        return known

    def _weighed(self) -> tuple[float, float] | None:
        s = self.swatch
        if s.weight_g is None or s.width_mm is None or s.height_mm is None or s.tex is None:
            return None
        stitches = s.width_mm * s.height_mm / float(s.stitch_mm.prod())
        error = math.sqrt(TEX_ERROR**2 + 5 * COUNT_ERROR**2)
        return math.log(s.weight_g / stitches / s.tex * 1e6), error

    def bendings(self) -> dict[str, Estimate]:
        """Bending modulus after each measurement, N·mm²."""
        values = [m.yarn.bending_modulus_n_mm2 or math.nan for m in load_library().values()]
        known = {"library": _interval(*_mean(np.log(values)))}
        s = self.swatch
        diameter: tuple[float, float] | None = None
        if s.tex is not None:
            value, deviation = self.density
            area = math.log(s.tex / 1000) - value
            diameter = ((area - math.log(math.pi / 4)) / 2, deviation / 2)
        if s.wraps_per_inch is not None:
            wrapped = (math.log(MM_PER_INCH / s.wraps_per_inch), WRAPS_ERROR)
            diameter = wrapped if diameter is None else _joined(diameter, wrapped)
        if diameter is not None:
            known["ball band"] = self._bending_of(diameter)
        else:
            loop = float(np.log(s.stitch_mm).mean()) - self.proportion[0]
            spread = math.hypot(self.proportion[1], self.slenderness[1])
            known["gauge and weight"] = self._bending_of((loop + self.slenderness[0], spread))
        return known

    def _bending_of(self, diameter: tuple[float, float]) -> Estimate:
        value, deviation = diameter
        return _interval(self.bending[0] + 2 * value, math.hypot(self.bending[1], 2 * deviation))


def _mean(logarithms: Array) -> tuple[float, float]:
    """Mean, and the standard deviation of a new one, such that 1.645 of it cover 90 %."""
    count = len(logarithms)
    spread = float(logarithms.std(ddof=1)) * math.sqrt(1 + 1 / count)
    return float(logarithms.mean()), spread * _T_90 / Z_SCORE


def _joined(first: tuple[float, float], second: tuple[float, float]) -> tuple[float, float]:
    """Mean of two independent values, weighted by their precision."""
    a, b = first[1] ** -2, second[1] ** -2
    return (a * first[0] + b * second[0]) / (a + b), (a + b) ** -0.5


def _interval(value: float, deviation: float) -> Estimate:
    reach = Z_SCORE * deviation
    return Estimate(math.exp(value), math.exp(value - reach), math.exp(value + reach))


def _note_apart(
    first: tuple[float, float], second: tuple[float, float], name: str, other: str, notes: list[str]
) -> None:
    apart = second[0] - first[0]
    if abs(apart) > 2.5 * math.hypot(first[1], second[1]):
        notes.append(
            f"The yarn in a stitch from {other} is {math.expm1(apart):+.0%} against that from"
            f" {name}: weigh, count and read the ball band again."
        )


# -- the laws ----------------------------------------------------------------------------------


def log_strain(point: StretchPoint) -> LogStrain:
    """A point as the mixed model takes it, with the scatter of strains that are read once."""
    error = point.strain_along_sd / point.strain_along
    return LogStrain(
        FABRICS.index(point.fabric),
        point.direction.axis,
        point.force_n_per_mm,
        math.log(point.strain_along),
        math.hypot(error, HANGING_SCATTER),
    )


@cache
def library_values() -> Array:
    """Logarithms of modulus, alpha and beta of the library, (yarns, 3, 4, 2)."""
    table = library_table()
    return np.stack([table.modulus + table.scale, table.alpha, table.beta], axis=1)


@cache
def _law_model(without: tuple[int, ...]) -> MixedModel:
    return MixedModel.fit(np.delete(library_values(), without, axis=0))


@cache
def _factors(points: tuple[LogStrain, ...]) -> dict[str, float]:
    """Standard deviations that 90 % of left-out values need, measured as these points were."""
    random = np.random.default_rng(0)
    errors: dict[str, list[Array]] = {"modulus": [], "alpha": [], "beta": [], "strain": []}
    for index, truth in enumerate(library_values()):
        others = _law_model((index,))
        true = MixedModel(truth, np.zeros((24, 24)))
        for _ in range(_REPEATS if points else 1):
            measured = [
                replace(
                    p,
                    value=true.log_strain(p.fabric, p.direction, p.stress_n_per_mm)[0]
                    + p.deviation * random.normal(),
                )
                for p in points
            ]
            model = others.knowing(measured)
            off = np.abs(model.mean - truth) / model.deviation
            for name, values in zip(errors, off, strict=False):
                errors[name].append(values)
            expected, deviation = _strains(model)
            errors["strain"].append(np.abs(expected - _strains(true)[0]) / deviation)
    return {name: covering(np.array(values), COVERAGE) for name, values in errors.items()}


def _strains(model: MixedModel) -> tuple[Array, Array]:
    """Logarithms of the extension at 0.1 N/mm, (4, 2), and their standard deviations."""
    pairs = [[model.log_strain(f, d, LOAD_N_PER_MM) for d in range(2)] for f in range(4)]
    values = np.array(pairs)
    return values[..., 0], values[..., 1]


def _estimates(
    model: MixedModel, points: tuple[LogStrain, ...]
) -> dict[str, list[dict[Direction, Estimate]]]:
    """Estimates by quantity, fabric and direction."""
    factors = _factors(points)
    strain, strain_sd = _strains(model)
    values = {
        name: (model.mean[i], model.deviation[i])
        for i, name in enumerate(("modulus", "alpha", "beta"))
    } | {"strain": (strain, strain_sd)}
    return {
        name: [
            {
                d: _interval(mean[f, d.axis], factors[name] * deviation[f, d.axis] / Z_SCORE)
                for d in DIRECTIONS
            }
            for f in range(4)
        ]
        for name, (mean, deviation) in values.items()
    }


def _step(
    name: str,
    known: tuple[Estimate, Estimate],
    model: MixedModel,
    points: tuple[LogStrain, ...],
    own: int,
) -> Step:
    estimates = _estimates(model, points)
    others = [
        math.log(e.high / e.value)
        for f, by_direction in enumerate(estimates["strain"])
        if f != own
        for e in by_direction.values()
    ]
    return Step(
        name,
        *known,
        strain_at_load=estimates["strain"][own],
        modulus=estimates["modulus"][own],
        other_strains=math.exp(float(np.mean(others))),
    )


def _fabrics(
    swatch: KnownSwatch,
    points: Sequence[StretchPoint],
    model: MixedModel,
    used: tuple[LogStrain, ...],
    loop_mm: float,
) -> tuple[dict[Fabric, FabricEstimate], dict[Fabric, LawUncertainty]]:
    """Laws of all fabrics and their uncertainty; sizes in the library's proportions to the own."""
    table, own = library_table(), FABRICS.index(swatch.fabric)
    loops = np.array(
        [
            [math.log(m.record(f).loop_length_mm or math.nan) for f in FABRICS]
            for m in load_library().values()
        ]
    )
    longer = np.exp((loops - loops[:, [own]]).mean(axis=0))
    stitch = table.stitch + loops[..., None]
    larger = np.exp((stitch - stitch[:, [own]]).mean(axis=0))
    estimates = _estimates(model, used)
    values = np.exp(model.mean)
    fabrics, uncertainty = {}, {}
    for i, fabric in enumerate(FABRICS):
        poisson, poisson_sd = _poisson(fabric, i, points)
        modulus, alpha, beta = values[:, i].tolist()
        law = ConstitutiveLaw.of_moduli(
            modulus[0],
            modulus[1],
            poisson[0],
            poisson[1],
            alpha_xx=alpha[0],
            alpha_yy=alpha[1],
            beta_xx=beta[0],
            beta_yy=beta[1],
        )
        course, wale = (swatch.stitch_mm * larger[i]).tolist()
        fabrics[fabric] = FabricEstimate(
            fabric=fabric,
            strain_at_load=estimates["strain"][i],
            modulus=estimates["modulus"][i],
            alpha=estimates["alpha"][i],
            beta=estimates["beta"][i],
            law=law,
            loop_length_mm=loop_mm * float(longer[i]),
            stitch_course_mm=course,
            stitch_wale_mm=wale,
            measured=False,
            curves={},
        )
        course_sd, wale_sd = (_log_deviation(estimates["modulus"][i][d]) for d in DIRECTIONS)
        uncertainty[fabric] = LawUncertainty(
            course_sd,
            wale_sd,
            *poisson_sd,
            source=INTERVAL_SOURCE.rstrip("."),
            curve_course=_curve(law, Direction.COURSE, estimates["strain"][i]),
            curve_wale=_curve(law, Direction.WALE, estimates["strain"][i]),
        )
    return fabrics, uncertainty


def _log_deviation(estimate: Estimate) -> float:
    return math.log(estimate.high / estimate.value) / Z_SCORE


def _curve(
    law: ConstitutiveLaw, direction: Direction, strains: Mapping[Direction, Estimate]
) -> CurveUncertainty:
    """Error of the stress at a strain, from that of the strain at 0.1 N/mm."""
    step = 0.05
    low, high = (
        math.log(free_strains_at_stress(law, direction, LOAD_N_PER_MM * math.exp(sign * step)))
        for sign in (-1, 1)
    )
    return CurveUncertainty(_log_deviation(strains[direction]) * 2 * step / (high - low))


def _poisson(
    fabric: Fabric, index: int, points: Sequence[StretchPoint]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Poisson ratios course-wise and wale-wise, and their standard deviations."""
    library = library_table().poisson[:, index]
    values, deviations = [], []
    for direction in DIRECTIONS:
        cells = library[:, direction.axis]
        belief = float(cells.mean()), float(cells.std(ddof=1))
        for point in points:
            if point.fabric is fabric and point.direction is direction:
                ratio = -point.strain_across / point.strain_along
                error = math.hypot(point.strain_across_sd, ratio * point.strain_along_sd)
                spread = math.hypot(error / point.strain_along, POISSON_SCATTER)
                belief = _joined(belief, (ratio, spread))
        values.append(max(belief[0], 0.0))
        deviations.append(belief[1])
    largest = math.sqrt(max(values[0] * values[1] / 0.9, 1.0))  # a law needs a product below 1
    return (values[0] / largest, values[1] / largest), (deviations[0], deviations[1])
