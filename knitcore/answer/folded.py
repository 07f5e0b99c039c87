"""Ribs and welts: the composite of phases corrected by one relaxed size.

A 1-D repeat (all rows alike: a rib; all columns alike: a welt) is a row of phases in series. At a
force F per row (for a welt per wale) each phase has its own length; their mean is the flat
composite's absolute size of a stitch,

    s_c(F) = sum_k f_k l_k (1 + e_k(F / t_k)),

with share f, relaxed length l along the pull and t across, and e_k the phase's strain at a stress.
Where the cloth lies flat, this is right; at rest it is too wide, because the real cloth folds. With
the relaxed size s_0 and t_0 across (from the yarn level, a gauge or the packaged table),

    s(sigma) = s_c(sigma t_0) - (s_c(0) - s_0) exp(-sigma / sigma_c).

sigma_c is the stress that unfolds it: 0.015 N/mm for ribs, 0.020 N/mm for welts in the study's
yarn, carried to others as B / d³. A repeat that is wider at rest than its flat composite is
scaled instead. Against our own yarn level (benchmarks/draw_in.py) the strain is then within 5 %
from 0.03 to 0.2 N/mm for ribs and welts; a study of folded shapes found 6 % and 13 %. Below
0.01 N/mm the first stretch is an extrapolation.

Across the folds nothing is in series. A rib pulled wale-wise strains as the course-parity-weighted
mean of its phases at equal force per wale, a balanced rib (k x k) as the pure rib does; plain
parallel mixing is 25-50 % too stiff there. A welt pulled course-wise has its rows in parallel, per
flat height: per shortened height it would be a quarter too stiff (benchmarks/stored_repeats.py).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from knitcore.answer.answer import Along, Answer, Source
from knitcore.answer.composite import mixture_notes, mixture_poisson_sd
from knitcore.answer.relaxed import RelaxedSize
from knitcore.answer.repeat import Layout, Repeat
from knitcore.fabric import PHASES, Direction, Fabric
from knitcore.law.response import Parallel, Part, Series, flat_mm
from knitcore.materials import Material
from knitcore.materials.uncertainty import Z_SCORE
from knitcore.mechanics.homogenisation import homogenise

UNFOLDING_STRESS_N_PER_MM = {Direction.COURSE: 0.015, Direction.WALE: 0.020}
"""sigma_c of the study's yarn, for ribs (course) and welts (wale)."""

STUDY_BENDING_STRESS_N_PER_MM = 0.045 / 1.48**3
"""B / d³ of the study's yarn."""

WIDE_RIB_RATIOS = (1.35, 1.50)
"""A k x k rib (k > 1) is 35-50 % more extensible than 1x1 rib in the study. sigma_c is moved just
as far as its first stretch needs to lie in that range: the ratio carries over to other yarns
better than a stress does."""

_WIDEST_BALANCED = 8


MODEL_LOG_SD = {
    (Layout.RIB, Direction.COURSE): math.log(1.09) / Z_SCORE,
    (Layout.RIB, Direction.WALE): math.log(1.64) / Z_SCORE,
    (Layout.WELT, Direction.COURSE): math.log(1.36) / Z_SCORE,
    (Layout.WELT, Direction.WALE): math.log(1.20) / Z_SCORE,
}
"""The model's own error: 90 % of the stored ribs and welts are within that factor at 0.05 N/mm
(benchmarks/stored_repeats.py)."""

UNFOLDING_LOG_SD = 0.4
"""sigma_c is known for one yarn only."""

DRAW_IN = (
    "Draw-in is taken over from the yarn level by its ratio to a pure fabric; it has no friction "
    "or set, so it is probably exaggerated. Your own gauge is better."
)


@dataclass(frozen=True)
class FoldedRepeat:
    """Corrected response of a 1-D repeat in both directions.

    Attributes
    ----------
    layout : rib or welt.
    relaxed : the size that corrects it.
    along : across the folds' axes, where the cloth unfolds (course-wise for a rib).
    across : the other direction.
    """

    layout: Layout
    relaxed: RelaxedSize
    along: Series
    across: Series | Parallel

    def response(self, direction: Direction) -> Series | Parallel:
        """The response in a direction."""
        return self.along if direction is self.along.direction else self.across


def folded(repeat: Repeat, material: Material, size: RelaxedSize) -> Answer:
    """What a rib or welt of a known relaxed size does.

    Raises
    ------
    InputError
        If the material lacks one of its phases.
    """
    found = folded_repeat(repeat, material, size)
    sheet = homogenise(repeat.chart, material)
    along = found.along.direction
    poisson = {Direction.COURSE: sheet.poisson_yx, Direction.WALE: sheet.poisson_xy}
    # While a fold opens the other direction does not move, so the ratio falls with the modulus.
    opened = found.along.modulus_n_per_mm / sheet.modulus_n_per_mm(along)
    poisson[along] *= min(opened, 1.0)
    course, wale = (
        Along.of_response(
            found.response(d),
            _log_sd(found, d, material),
            (poisson[d], mixture_poisson_sd(material, d)),
            (size.extent_mm(d), size.log_sd),
            sheet.bounds_n_per_mm(d),
        )
        for d in Direction
    )
    return Answer(
        course,
        wale,
        sheet.shear_modulus_n_per_mm,
        Source.COMPOSITE_OF_SIZE,
        f"{found.layout}: phases in series along the {along}, corrected for draw-in with the "
        f"relaxed size ({size.source})",
        str(size.source),
        (DRAW_IN, *mixture_notes(repeat, material)),
    )


def folded_repeat(repeat: Repeat, material: Material, relaxed: RelaxedSize) -> FoldedRepeat:
    """The corrected composite of a rib or welt of a relaxed size.

    Examples
    --------
    >>> from knitcore.answer.relaxed import known_size
    >>> from knitcore.chart import StitchChart
    >>> from knitcore.materials import material
    >>> rib, acrylic = Repeat.of(StitchChart.parse("KKPP")), material("acrylic")
    >>> size = known_size(rib, acrylic)
    >>> round(folded_repeat(rib, acrylic, size).along.modulus_n_per_mm, 4)  # 1x1 rib: 0.0100
    0.0074
    """
    if repeat.layout is Layout.RIB:
        along = _series(repeat, material, Direction.COURSE, relaxed.course_mm, relaxed.wale_mm)
        along = _anchored_to_the_pure_rib(along, repeat, material)
        across = _rib_wale_wise(repeat, along.parts, relaxed.course_mm)
        return FoldedRepeat(Layout.RIB, relaxed, along, across)
    along = _series(repeat, material, Direction.WALE, relaxed.wale_mm, relaxed.course_mm)
    parts = tuple(replace(p, along_mm=p.across_mm, across_mm=p.along_mm) for p in along.parts)
    # per flat height: pulled along its rows a shortened welt is softer than its rows laid flat
    return FoldedRepeat(
        Layout.WELT, relaxed, along, Parallel(Direction.COURSE, parts, along.flat_mm)
    )


def _parts(repeat: Repeat, material: Material, direction: Direction) -> tuple[Part, ...]:
    parts = []
    for phase in np.flatnonzero(repeat.shares):
        record = material.record(PHASES[phase])
        parts.append(
            Part(
                fabric=record.fabric,
                law=record.law,
                share=float(repeat.shares[phase]),
                along_mm=record.stitch_size_mm(direction),
                across_mm=record.stitch_size_mm(direction.other),
            )
        )
    return tuple(parts)


def _series(
    repeat: Repeat, material: Material, direction: Direction, along_mm: float, across_mm: float
) -> Series:
    parts = _parts(repeat, material, direction)
    flat = flat_mm(parts)
    return Series(
        direction=direction,
        parts=parts,
        relaxed_mm=along_mm,
        across_mm=across_mm,
        gap_mm=max(flat - along_mm, 0.0),
        unfolding_stress_n_per_mm=_unfolding_stress(material, direction),
    )


def _unfolding_stress(material: Material, direction: Direction) -> float:
    bending = material.yarn.bending_modulus_n_mm2
    plain = material.fabrics.get(Fabric.STOCKINETTE)
    diameter = material.yarn.diameter_mm
    if plain is not None and plain.yarn_diameter_mm is not None:
        diameter = plain.yarn_diameter_mm
    stress = UNFOLDING_STRESS_N_PER_MM[direction]
    if bending is None or diameter is None:
        return stress
    return stress * bending / diameter**3 / STUDY_BENDING_STRESS_N_PER_MM


def _is_balanced(repeat: Repeat) -> bool:
    """k knits and k purls, 1 < k <= 4 (wider ones tend to stockinette in their middle)."""
    purl = repeat.chart.purl[0]
    changes = int(np.count_nonzero(purl != np.roll(purl, 1)))
    return changes == 2 and 2 * int(purl.sum()) == purl.size and 2 < purl.size <= _WIDEST_BALANCED


def _anchored_to_the_pure_rib(along: Series, repeat: Repeat, material: Material) -> Series:
    if not (_is_balanced(repeat) and along.gap_mm):
        return along
    parts, fold = along.compliances()
    flat = float(parts.sum())
    pure = 1.0 / material.law(Fabric.RIB).modulus(Direction.COURSE)
    least, most = (ratio * pure for ratio in WIDE_RIB_RATIOS)
    wanted = min(max(flat + fold, least), most)
    if wanted <= flat:
        return along
    stress = along.unfolding_stress_n_per_mm * fold / (wanted - flat)
    return replace(along, unfolding_stress_n_per_mm=stress)


def _rib_wale_wise(repeat: Repeat, phases: tuple[Part, ...], width_mm: float) -> Series:
    """Mean of the phases' strains at equal force per wale; of the pure rib alone if balanced."""
    parts = tuple(
        replace(part, along_mm=1.0, across_mm=part.along_mm)
        for part in phases
        if not _is_balanced(repeat) or part.fabric is Fabric.RIB
    )
    total = sum(part.share for part in parts)
    return Series(
        direction=Direction.WALE,
        parts=tuple(replace(part, share=part.share / total) for part in parts),
        relaxed_mm=1.0,
        across_mm=width_mm,
        gap_mm=0.0,
        unfolding_stress_n_per_mm=math.inf,
    )


def _log_sd(folded: FoldedRepeat, direction: Direction, material: Material) -> float:
    """Standard deviation of the log modulus: laws, relaxed size and model.

    The laws' own are carried by the delta method: d ln Y / d ln C of a phase is its share of the
    compliance (series) or of the stiffness (parallel).
    """
    response, size_sd = folded.response(direction), folded.relaxed.log_sd
    if isinstance(response, Series):
        parts, fold = response.compliances()
        total = float(parts.sum()) + fold
        weights, fold_share = parts / total, fold / total
        opening = response.unfolding_stress_n_per_mm * total if fold else math.inf
        # d ln Y / d ln s_0 = 1 + (s_0 / sigma_c) / (s_0 / Y): the narrower at rest, the more fold.
        terms = [size_sd * (1 + 1 / opening), UNFOLDING_LOG_SD * fold_share]
    else:
        weights, terms = response.stiffnesses() / response.modulus_n_per_mm, [size_sd]
    terms.append(MODEL_LOG_SD[folded.layout, direction])
    for part, weight in zip(response.parts, weights, strict=True):
        spread = material.record(part.fabric).uncertainty
        terms.append(float(weight) * spread.log_modulus(direction))
    return math.hypot(*terms)
