"""Uncertainty of composites, as standard deviations of the logarithm of a modulus.

The laws' own are carried by the delta method: d ln Y / d ln C of a phase is its share of the energy
(homogenised charts), of the compliance (series) or of the stiffness (parallel). To these the
relaxed size, the unfolding stress and the model's own error are added.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from knitcore.answer.composite import FoldedRepeat, Layout
from knitcore.answer.relaxed import SizeSource
from knitcore.fabric import PHASES, Direction
from knitcore.law.response import Series
from knitcore.materials import Material
from knitcore.materials.uncertainty import Z_SCORE

MODEL_LOG_SD = {"flat": math.log(3.5) / Z_SCORE, "patchwork": 0.05}
"""The model's own error where it is not corrected. Flat repeats: the strain of 90 % of the stored
2-D repeats is within that factor at 0.05 N/mm (benchmarks/stored_repeats.py)."""

FOLDED_LOG_SD = {
    (Layout.RIB, Direction.COURSE): math.log(1.09) / Z_SCORE,
    (Layout.RIB, Direction.WALE): math.log(1.64) / Z_SCORE,
    (Layout.WELT, Direction.COURSE): math.log(1.36) / Z_SCORE,
    (Layout.WELT, Direction.WALE): math.log(1.20) / Z_SCORE,
}
"""The same of ribs and welts corrected with their relaxed size: 90 % of the stored ones are within
that factor at 0.05 N/mm."""

SIZE_LOG_SD = {
    SizeSource.TABLE: 0.10,
    SizeSource.STORE: 0.12,
    SizeSource.YARN_LEVEL: 0.10,
    SizeSource.GAUGE: 0.03,
}
"""Ratios of two yarns in the store differ by 0.07 (ribs and welts); the branches differ by 0.10."""

UNFOLDING_LOG_SD = 0.4
"""sigma_c is known for one yarn only."""


def phase_log_sd(
    shares: NDArray[np.float64],
    material: Material,
    direction: Direction,
) -> float:
    """Delta method: d ln Y / d ln C of a phase is its share of the energy."""
    return math.hypot(
        *(
            float(shares[phase]) * material.record(PHASES[phase]).uncertainty.log_modulus(direction)
            for phase in np.flatnonzero(shares > 0)
        )
    )


def folded_log_sd(folded: FoldedRepeat, direction: Direction, material: Material) -> float:
    """Standard deviation of the log modulus of a rib or welt: laws, relaxed size and model."""
    response = folded.response(direction)
    size_sd = SIZE_LOG_SD[folded.relaxed.source]
    if isinstance(response, Series):
        parts, fold = response.compliances()
        total = float(parts.sum()) + fold
        weights, fold_share = parts / total, fold / total
        opening = response.unfolding_stress_n_per_mm * total if fold else math.inf
        # d ln Y / d ln s_0 = 1 + (s_0 / sigma_c) / (s_0 / Y): a narrower rest leaves more fold.
        terms = [size_sd * (1 + 1 / opening), UNFOLDING_LOG_SD * fold_share]
    else:
        weights, terms = response.stiffnesses() / response.modulus_n_per_mm, [size_sd]
    terms.append(FOLDED_LOG_SD[folded.layout, direction])
    for part, weight in zip(response.parts, weights, strict=True):
        spread = material.record(part.fabric).uncertainty
        terms.append(float(weight) * spread.log_modulus(direction))
    return math.hypot(*terms)
