"""What a chart of a material will do: effective constants, with interval and source.

The rule, in this order:

1. A chart that is one pure fabric has that fabric's law, exactly ("measured"; "yarn level" if the
   record is simulated).
2. A repeat whose law was swept on the yarn level has that law ("yarn level").
3. A rib or welt with a known relaxed size is a series of its phases, corrected for its draw-in
   ("composite, corrected").
4. Anything else is the flat composite of its quarter cells, homogenised periodically ("composite,
   stretched state only"). Where like stitches stand in runs it folds at rest, which the composite
   does not know, so no relaxed size is given.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from knitcore.answer.composite import (
    FoldedRepeat,
    Layout,
    flat_rib_wale_wise,
    folded_repeat,
    layout_of,
)
from knitcore.answer.notes import composite_notes, fabric_notes
from knitcore.answer.relaxed import RelaxedSize, tabled_size
from knitcore.answer.uncertainty import (
    MODEL_LOG_SD,
    folded_log_sd,
    phase_log_sd,
)
from knitcore.chart import StitchChart
from knitcore.fabric import PHASES, Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import FabricRecord, Interval, Material, Origin
from knitcore.materials.uncertainty import (
    MODEL_POISSON_SD,
    YARN_LEVEL_LOG_SD,
    log_interval,
    normal_interval,
)
from knitcore.mechanics.homogenisation import EffectiveSheet, homogenise
from knitcore.phases import QUARTERS_OF_CODE, quarter_phases, surroundings


class Provenance(StrEnum):
    """Which law a prediction uses."""

    MEASURED = "measured"
    YARN_LEVEL = "yarn level"
    CORRECTED = "composite, corrected"
    STRETCHED = "composite, stretched state only"
    ESTIMATED = "estimated"


PATCHWORK_SHARE = 0.9
"""A chart is a patchwork of pure fabrics if so many of its stitches have pure surroundings."""


@dataclass(frozen=True)
class Prediction:
    """Effective constants of a chart at small strain; intervals cover 90 %.

    Attributes
    ----------
    modulus_course_n_per_mm, modulus_wale_n_per_mm : Young's moduli.
    poisson_yx, poisson_xy : contraction wale-wise under a course-wise pull, and the reverse.
    modulus_course_interval, modulus_wale_interval, poisson_yx_interval, poisson_xy_interval : of
        these. They carry the printed or stated standard deviations of the laws, and the model's
        own error where the chart is a composite.
    modulus_course_bounds, modulus_wale_bounds : Reuss and Voigt bounds of the flat composite
        (N/mm); both the modulus itself for a pure fabric.
    shear_modulus_n_per_mm : an assumption of the laws unless they were calibrated.
    relaxed_course_mm, relaxed_wale_mm : size of one mean stitch at rest, None where it is not
        certified.
    relaxed_source : where that size comes from.
    provenance : which law was used.
    method : how, in words.
    notes : what a user should know.
    """

    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    poisson_yx: float
    poisson_xy: float
    modulus_course_interval: Interval
    modulus_wale_interval: Interval
    poisson_yx_interval: Interval
    poisson_xy_interval: Interval
    modulus_course_bounds: Interval
    modulus_wale_bounds: Interval
    shear_modulus_n_per_mm: float
    provenance: Provenance
    method: str
    relaxed_course_mm: float | None = None
    relaxed_wale_mm: float | None = None
    relaxed_source: str = ""
    notes: tuple[str, ...] = field(default=())

    @property
    def extensibility_course_mm_per_n(self) -> float:
        """1 / Y_course, mm/N."""
        return 1.0 / self.modulus_course_n_per_mm

    @property
    def extensibility_wale_mm_per_n(self) -> float:
        """1 / Y_wale, mm/N."""
        return 1.0 / self.modulus_wale_n_per_mm

    @property
    def extensibility_course_interval(self) -> Interval:
        """90 % interval of 1 / Y_course, mm/N."""
        return _inverse(self.modulus_course_interval)

    @property
    def extensibility_wale_interval(self) -> Interval:
        """90 % interval of 1 / Y_wale, mm/N."""
        return _inverse(self.modulus_wale_interval)

    def modulus_n_per_mm(self, direction: Direction) -> float:
        """Young's modulus in a direction."""
        course = direction is Direction.COURSE
        return self.modulus_course_n_per_mm if course else self.modulus_wale_n_per_mm


def predict(
    chart: StitchChart,
    material: Material,
    *,
    relaxed: RelaxedSize | None = None,
    repeat_law: ConstitutiveLaw | None = None,
) -> Prediction:
    """Effective constants of a chart, by the rule above.

    Parameters
    ----------
    chart : a repeat, or a swatch that may cut its last repeat off.
    material : one yarn on one setting.
    relaxed : relaxed size of the chart's mean stitch, from a gauge or the yarn level; otherwise
        common repeats are looked up in the packaged table.
    repeat_law : a law fitted to a yarn-level sweep of this very repeat.

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> garter = predict(StitchChart.of_fabric("garter", 31, 31), material("acrylic"))
    >>> round(garter.modulus_course_n_per_mm, 3), round(garter.modulus_wale_n_per_mm, 3)
    (0.223, 0.056)
    >>> predict(StitchChart.parse("KKPP"), material("acrylic")).provenance
    <Provenance.CORRECTED: 'composite, corrected'>
    """
    present = np.unique(quarter_phases(chart))
    if len(present) == 1:
        return _pure(PHASES[present[0]], material, relaxed)
    repeat = chart.repeat_cut()
    if repeat_law is not None:
        return _yarn_level(repeat_law, relaxed)
    sheet = homogenise(repeat, material)
    size = relaxed or tabled_size(repeat, material)
    if layout_of(repeat) is not None and size is not None:
        return _corrected(folded_repeat(repeat, material, size), sheet, repeat, material)
    return _flat(sheet, repeat, material, size)


def pure_provenance(record: FabricRecord) -> Provenance:
    """Label of a pure fabric's law."""
    if record.origin is Origin.SIMULATED:
        return Provenance.YARN_LEVEL
    return Provenance.ESTIMATED if record.origin is Origin.ESTIMATED else Provenance.MEASURED


def _pure(fabric: Fabric, material: Material, relaxed: RelaxedSize | None) -> Prediction:
    record = material.record(fabric)
    law, spread = record.law, record.uncertainty
    size = (record.stitch_course_mm, record.stitch_wale_mm, record.stitch_size_source)
    if relaxed is not None:
        size = (relaxed.course_mm, relaxed.wale_mm, relaxed.source)
    return _of_law(
        law,
        log_sd=(spread.log_modulus_course, spread.log_modulus_wale),
        poisson_sd=(spread.poisson_yx, spread.poisson_xy),
        provenance=pure_provenance(record),
        method=f"law of {fabric}, {record.origin}; uncertainty: {spread.source}",
        size=size,
        notes=fabric_notes(fabric, material),
    )


def _yarn_level(law: ConstitutiveLaw, relaxed: RelaxedSize | None) -> Prediction:
    size = None if relaxed is None else (relaxed.course_mm, relaxed.wale_mm, relaxed.source)
    return _of_law(
        law,
        log_sd=(YARN_LEVEL_LOG_SD, YARN_LEVEL_LOG_SD),
        poisson_sd=(MODEL_POISSON_SD, MODEL_POISSON_SD),
        provenance=Provenance.YARN_LEVEL,
        method="law fitted to a yarn-level stretch of this repeat",
        size=size,
        notes=("The yarn level has no friction or set: draw-in is probably exaggerated.",),
    )


def _of_law(
    law: ConstitutiveLaw,
    *,
    log_sd: tuple[float, float],
    poisson_sd: tuple[float, float],
    provenance: Provenance,
    method: str,
    size: tuple[float, float, str] | None,
    notes: tuple[str, ...],
) -> Prediction:
    course, wale = law.modulus_course, law.modulus_wale
    return Prediction(
        modulus_course_n_per_mm=course,
        modulus_wale_n_per_mm=wale,
        poisson_yx=law.poisson_yx,
        poisson_xy=law.poisson_xy,
        modulus_course_interval=log_interval(course, log_sd[0]),
        modulus_wale_interval=log_interval(wale, log_sd[1]),
        poisson_yx_interval=normal_interval(law.poisson_yx, poisson_sd[0]),
        poisson_xy_interval=normal_interval(law.poisson_xy, poisson_sd[1]),
        modulus_course_bounds=Interval(course, course),
        modulus_wale_bounds=Interval(wale, wale),
        shear_modulus_n_per_mm=law.shear_modulus,
        provenance=provenance,
        method=method,
        relaxed_course_mm=None if size is None else size[0],
        relaxed_wale_mm=None if size is None else size[1],
        relaxed_source="" if size is None else size[2],
        notes=notes,
    )


def _flat(
    sheet: EffectiveSheet, repeat: StitchChart, material: Material, size: RelaxedSize | None
) -> Prediction:
    codes = surroundings(repeat, periodic=True)
    pure = np.ptp(QUARTERS_OF_CODE.reshape(16, 4), axis=1) == 0
    patchwork = float(pure[codes].mean()) >= PATCHWORK_SHARE
    model = MODEL_LOG_SD["patchwork" if patchwork else "flat"]
    log_sd = tuple(
        math.hypot(model, phase_log_sd(sheet.energy_shares[d.axis], material, d)) for d in Direction
    )
    kind = "patchwork" if patchwork else "repeat"
    course, wale = (sheet.modulus_n_per_mm(d) for d in Direction)
    if layout_of(repeat) is Layout.RIB and not patchwork:
        wale = flat_rib_wale_wise(repeat, material).modulus_n_per_mm
    return _composite(
        sheet,
        moduli=(course, wale),
        poisson=(sheet.poisson_yx, sheet.poisson_xy),
        log_sd=log_sd,
        material=material,
        provenance=Provenance.STRETCHED,
        method=f"periodic homogenisation of the quarter cells of a {kind} of "
        f"{repeat.columns} x {repeat.rows} stitches",
        size=size,
        notes=composite_notes(repeat, material, patchwork=patchwork, corrected=False),
    )


def _corrected(
    folded: FoldedRepeat, sheet: EffectiveSheet, repeat: StitchChart, material: Material
) -> Prediction:
    moduli = tuple(folded.response(d).modulus_n_per_mm for d in Direction)
    along = folded.along.direction
    # While a fold opens the other direction does not move, so the ratio falls with the modulus.
    opened = min(moduli[along.axis] / sheet.modulus_n_per_mm(along), 1.0)
    poisson = [sheet.poisson_yx, sheet.poisson_xy]
    poisson[along.axis] *= opened
    log_sd = tuple(folded_log_sd(folded, d, material) for d in Direction)
    return _composite(
        sheet,
        moduli=moduli,
        poisson=(poisson[0], poisson[1]),
        log_sd=log_sd,
        material=material,
        provenance=Provenance.CORRECTED,
        method=f"{folded.layout}: phases in series along the {along}, corrected for draw-in with "
        f"the relaxed size ({folded.relaxed.source})",
        size=folded.relaxed,
        notes=composite_notes(repeat, material, patchwork=False, corrected=True),
    )


def _composite(
    sheet: EffectiveSheet,
    *,
    moduli: tuple[float, ...],
    poisson: tuple[float, float],
    log_sd: tuple[float, ...],
    material: Material,
    provenance: Provenance,
    method: str,
    size: RelaxedSize | None,
    notes: tuple[str, ...],
) -> Prediction:
    spread = [record.uncertainty for record in material.fabrics.values()]
    yx_sd = math.hypot(MODEL_POISSON_SD, max(s.poisson_yx for s in spread))
    xy_sd = math.hypot(MODEL_POISSON_SD, max(s.poisson_xy for s in spread))
    return Prediction(
        modulus_course_n_per_mm=moduli[0],
        modulus_wale_n_per_mm=moduli[1],
        poisson_yx=poisson[0],
        poisson_xy=poisson[1],
        modulus_course_interval=log_interval(moduli[0], log_sd[0]),
        modulus_wale_interval=log_interval(moduli[1], log_sd[1]),
        poisson_yx_interval=normal_interval(poisson[0], yx_sd),
        poisson_xy_interval=normal_interval(poisson[1], xy_sd),
        modulus_course_bounds=Interval(*sheet.bounds_n_per_mm(Direction.COURSE)),
        modulus_wale_bounds=Interval(*sheet.bounds_n_per_mm(Direction.WALE)),
        shear_modulus_n_per_mm=sheet.shear_modulus_n_per_mm,
        provenance=provenance,
        method=method,
        relaxed_course_mm=None if size is None else size.course_mm,
        relaxed_wale_mm=None if size is None else size.wale_mm,
        relaxed_source="" if size is None else size.source,
        notes=notes,
    )


def _inverse(interval: Interval) -> Interval:
    return Interval(1 / interval.high, 1 / interval.low)
