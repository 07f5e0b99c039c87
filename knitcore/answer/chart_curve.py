"""Stretch of any chart under a given stress, by the same rule as its prediction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from knitcore.answer.composite import Layout, flat_rib_wale_wise, folded_repeat, layout_of
from knitcore.answer.prediction import Provenance, pure_provenance
from knitcore.answer.relaxed import RelaxedSize, tabled_size
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import PHASES, Direction
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import Material
from knitcore.mechanics.repeat_curve import repeat_curve_at_stress
from knitcore.phases import quarter_phases

Array = NDArray[np.float64]

DEFAULT_STRESS_N_PER_MM = tuple(float(s) for s in np.linspace(0.0, 0.3, 31))


@dataclass(frozen=True, eq=False)
class ChartCurve:
    """A stress-strain curve of a chart, transverse direction free.

    Attributes
    ----------
    stress_n_per_mm, strain : arrays of one length; strain from the relaxed size, or from the flat
        size where the provenance says that only the stretched state is right.
    provenance : which law was used.
    """

    stress_n_per_mm: Array
    strain: Array
    provenance: Provenance


def chart_curve(
    chart: StitchChart,
    material: Material,
    direction: Direction,
    stress_n_per_mm: ArrayLike = DEFAULT_STRESS_N_PER_MM,
    *,
    relaxed: RelaxedSize | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> ChartCurve:
    """Strain of a chart at increasing stresses (N/mm).

    Parameters
    ----------
    cancelled : asked before each stress that Newton's method solves for.

    Raises
    ------
    InputError
        If the stresses are not finite, increasing and at least 0, or if the chart is neither a
        pure fabric, nor a rib or welt, nor a repeat of at most 256 stitches: a swatch of that
        size is stretched by knitcore.swatch.
    CancelledError
        If ``cancelled`` returned True.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> wide = chart_curve(StitchChart.parse("KKPP"), material("acrylic"), Direction.COURSE, [0.1])
    >>> pure = chart_curve(StitchChart.parse("KP"), material("acrylic"), Direction.COURSE, [0.1])
    >>> bool(wide.strain[0] > pure.strain[0])
    True
    """
    stress = np.atleast_1d(np.asarray(stress_n_per_mm, dtype=float))
    if not np.all(np.isfinite(stress)) or np.any(np.diff(stress) <= 0) or np.any(stress < 0):
        raise InputError(
            "stress", "must be finite, increasing and at least 0.", "Give, say, 0, 0.1, 0.2 N/mm."
        )
    present = np.unique(quarter_phases(chart))
    if len(present) == 1:
        record = material.record(PHASES[present[0]])
        strain = free_strains_at_stress(record.law, direction, stress)
        return ChartCurve(stress, strain, pure_provenance(record))
    repeat = chart.repeat_cut()
    size = relaxed or tabled_size(repeat, material)
    if layout_of(repeat) is not None and size is not None:
        folded = folded_repeat(repeat, material, size)
        return ChartCurve(stress, folded.response(direction).strain(stress), Provenance.CORRECTED)
    if layout_of(repeat) is Layout.RIB and direction is Direction.WALE:
        strain = flat_rib_wale_wise(repeat, material).strain(stress)
        return ChartCurve(stress, strain, Provenance.STRETCHED)
    curve = repeat_curve_at_stress(repeat, material, direction, stress, cancelled=cancelled)
    return ChartCurve(stress, curve.strain, Provenance.STRETCHED)
