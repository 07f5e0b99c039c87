"""Size at rest of charts with lace, cables, slipped and tucked stitches.

Cloth with yarn overs or cables hardly folds, as ribs and welts do, so that its size is that of the
mixture of its knits and purls (:mod:`knitcore.prediction.mixture`), times a factor for each kind of
stitch::

    ln size = ln mixture + exp(-share / 0.05) · ln folds + Σ effect · density

``share`` counts yarn overs, crossings, slips and tucks, so that size and interval are those of the
knits and purls where there are none. The effects are packaged data with their sources
(``data/stitch_effects.csv``), made by ``studies/other_stitches.py``. How such cloth stretches
nobody has measured: its law is that of its knits and purls, and both ends of the intervals lie a
factor of 2 farther.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_kinds import STITCHES, YarnAct
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.law.response import Response
from knitcore.materials import Interval, Material
from knitcore.materials.interval_parts import Part, Variances, deviation
from knitcore.materials.law_uncertainty import Z_SCORE
from knitcore.prediction.densities import densities
from knitcore.prediction.mixture import Mixture
from knitcore.prediction.prediction import Along, Prediction, Source

FADE = 0.05
"""Share of other stitches at which cloth folds 1/e as much as its knits and purls alone."""
STRETCH_FACTOR = 2.0
"""Factor by which either end of an interval of strains or moduli lies farther than for knits and
purls."""
KINDS = "yarn_overs", "leans", "crossings", "slips", "tucks"


@dataclass(frozen=True)
class StitchDensities:
    """Stitches of a chart that are neither knit nor purl, per stitch.

    Attributes
    ----------
    yarn_overs, slips, tucks : shares of the chart's stitches.
    leans : wales by which the loops beside yarn overs and decreases lean.
    crossings : pairs of stitches that cross; a 2/2 cable has 4.
    crossed : share of the stitches that take part in a cable.
    """

    yarn_overs: float
    slips: float
    tucks: float
    leans: float
    crossings: float
    crossed: float

    @classmethod
    def of(cls, chart: SymbolChart) -> StitchDensities:
        """Count a chart's."""
        graph = chart.graph
        takes = np.diff(graph.first, axis=1)
        over, miss = graph.act == YarnAct.OVER, graph.act == YarnAct.MISS
        pairs = 0
        for place, count in zip(*np.unique(chart.cells, return_counts=True), strict=True):
            layers = [site.layer for site in STITCHES[place].sites] if place >= 0 else []
            pairs += int(count) * layers.count(1) * layers.count(-1)
        size = graph.act.size
        site = np.repeat(np.tile(np.arange(chart.columns), chart.rows), takes.ravel())
        lean = np.abs(graph.source - site)[graph.layer == 0]
        return cls(
            yarn_overs=float((over & (takes == 0)).sum()) / size,
            slips=float(miss.sum()) / size,
            tucks=float((over & (takes > 0)).sum()) / size,
            leans=float(lean.sum()) / size,
            crossings=pairs / size,
            crossed=float((graph.layer != 0).sum()) / size,
        )

    @property
    def share(self) -> float:
        """Share of the stitches that keep cloth from folding."""
        return self.yarn_overs + self.crossed + self.slips + self.tucks


@dataclass(frozen=True)
class Effect:
    """Effect of a kind of stitch on the size, per unit of its density.

    Attributes
    ----------
    log_size : (2,) change of the logarithm of width and height.
    log_sd : (2,) standard deviation of that change where it is not measured, else 0.
    measured : on knitted swatches; otherwise a stated guess.
    source : where it comes from.
    """

    log_size: Array
    log_sd: Array
    measured: bool
    source: str


@cache
def effects() -> Mapping[str, Effect]:
    """The packaged effects by kind, and under ``left`` what they leave unexplained."""
    text = files("knitcore.prediction").joinpath("data", "stitch_effects.csv").read_text("utf-8")
    return {
        row["kind"]: Effect(
            np.array([float(row["course"]), float(row["wale"])]),
            np.array([float(row["course_sd"]), float(row["wale_sd"])]),
            row["basis"] == "measured",
            row["source"],
        )
        for row in csv.DictReader(text.splitlines())
    }


def log_sizes(chart: SymbolChart, material: Material, plain: Prediction) -> tuple[Array, Array]:
    """Logarithm of width and height of the mean stitch, and its standard deviation, (2,) each.

    Parameters
    ----------
    plain : prediction of the chart's knits and purls.
    """
    made_of = StitchDensities.of(chart)
    flat = np.log(Mixture.of(densities(chart.plain.repeat_cut()).shares, material).size_mm)
    folds = np.log([plain.relaxed_course_mm, plain.relaxed_wale_mm]) - flat
    fade = math.exp(-made_of.share / FADE)
    logs = flat + fade * folds
    own = np.array([plain.course.relaxed_log_sd, plain.wale.relaxed_log_sd])
    variance = fade * own**2 + (1 - fade) * effects()["left"].log_sd ** 2
    for kind in KINDS:
        density, effect = getattr(made_of, kind), effects()[kind]
        logs = logs + density * effect.log_size
        variance = variance + (density * effect.log_sd) ** 2
    return logs, np.sqrt(variance)


def with_other_stitches(
    plain: Prediction, chart: SymbolChart, material: Material, *, size_is_known: bool
) -> Prediction:
    """Turn the prediction of a chart's knits and purls into that of the chart.

    Parameters
    ----------
    plain : of :attr:`SymbolChart.plain`.
    size_is_known : keep its size, which was given.
    """
    course, wale = (_wider(plain.along(direction)) for direction in Direction)
    changed = replace(
        plain,
        course=course,
        wale=wale,
        provenance=Source.OTHER_STITCHES,
        method=f"knits and purls: {plain.method}; other stitches by their effect on knitted "
        "swatches",
        stretch_errors=(*plain.stretch_errors, "other stitches: a factor of 2, a stated guess"),
        notes=(*_notes(chart), *plain.notes),
    )
    if size_is_known:
        return changed
    logs, log_sd = log_sizes(chart, material, plain)
    fade = math.exp(-StitchDensities.of(chart).share / FADE)
    kept = ({part: fade * of for part, of in a.relaxed_parts.items()} for a in (course, wale))
    course, wale = (
        replace(
            along,
            relaxed_mm=math.exp(log),
            relaxed_parts=own | {Part.OTHER_STITCHES: sd**2 - deviation(own) ** 2},
        )
        for along, own, log, sd in zip((course, wale), kept, logs, log_sd, strict=True)
    )
    used = [effects()[kind] for kind in _present(chart)]
    sources = tuple(dict.fromkeys(effect.source for effect in used)) or plain.size_errors
    return replace(
        changed, course=course, wale=wale, relaxed_source="other stitches", size_errors=sources
    )


def _present(chart: SymbolChart) -> list[str]:
    made_of = StitchDensities.of(chart)
    return [kind for kind in KINDS if getattr(made_of, kind) > 0]


def _notes(chart: SymbolChart) -> list[str]:
    notes = [
        "How cloth with lace, cables, slips or tucks stretches has not been measured: the numbers "
        "are those of its knits and purls, and both ends of their intervals a factor of 2 farther."
    ]
    guesses = [kind.replace("_", " ") for kind in _present(chart) if not effects()[kind].measured]
    if guesses:
        notes.append(f"The effect of {' and '.join(guesses)} on the size is a stated guess.")
    return notes


def _wider(along: Along) -> Along:
    """Widen the intervals of a response."""
    low, high = along.bounds_n_per_mm

    def parts(stress: ArrayLike) -> Variances:
        return _with_more(along.strain_parts(stress), math.log(STRETCH_FACTOR) / Z_SCORE)

    return replace(
        along,
        stiff=_scaled(along.stiff, 1 / STRETCH_FACTOR),
        soft=_scaled(along.soft, STRETCH_FACTOR),
        poisson_parts=_with_more(along.poisson_parts, (STRETCH_FACTOR - 1) * along.poisson_sd),
        strain_parts=parts,
        bounds_n_per_mm=Interval(low / STRETCH_FACTOR, high * STRETCH_FACTOR),
    )


def _with_more(parts: Variances, more: float) -> Variances:
    """Parts with a deviation that is added to theirs, as that of the other stitches."""
    own = deviation(parts)
    return {**parts, Part.OTHER_STITCHES: np.asarray((own + more) ** 2 - own**2)}


def _scaled(response: Response, factor: float) -> Response:
    """A response with ``factor`` times the strain under every stress."""

    def strain(stress: ArrayLike) -> Array:
        return factor * response.strain(stress)

    return Response(response.modulus_n_per_mm / factor, strain)
