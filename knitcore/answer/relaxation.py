"""A chart's size from a relaxation of its repeat at the yarn level, in place of a learned one.

The yarn level's own sizes are not the material's: both are compared with the pure fabrics of the
same yarn, as for sweeps (:mod:`knitcore.answer.swept`). A relaxation takes seconds, so the page
starts one when painting pauses.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from knitcore.answer.answer import Answer, Source
from knitcore.answer.densities import densities
from knitcore.answer.learned import packaged_model
from knitcore.answer.mixture import Mixture
from knitcore.answer.relaxed import KnownBy, RelaxedSize
from knitcore.chart import StitchChart
from knitcore.fabric import Fabric
from knitcore.materials import Material

MAX_STITCHES = 36
"""Largest repeat that is worth the wait: its relaxation takes some seconds."""


def worth_relaxing(chart: StitchChart, material: Material, answer: Answer) -> StitchChart | None:
    """The repeat whose relaxation would make a learned answer more certain; None if none would.

    Measured cloth shows the folds of the yarn level only in part, so for measured materials a
    relaxation narrows no interval.
    """
    if answer.provenance is not Source.LEARNED or not material.is_simulated:
        return None
    repeat = chart.repeat_cut()
    return repeat if repeat.stitches <= MAX_STITCHES else None


def size_from_relaxation(
    chart: StitchChart,
    material: Material,
    cell_mm: tuple[float, float],
    pure_mm: Mapping[Fabric, tuple[float, float]],
) -> RelaxedSize:
    """The size of a chart's mean stitch in a material, from a relaxation of its repeat.

    Parameters
    ----------
    chart : the repeat.
    material : whose yarn was relaxed.
    cell_mm : width and height of its relaxed mean stitch in the mirrored branch.
    pure_mm : the same of each pure fabric in the chart, of the same yarn.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """
    found = densities(chart)
    mixture = Mixture.of(found.shares, material)
    flat_mm = sum(share * np.array(pure_mm[record.fabric]) for share, record in mixture.parts)
    model = packaged_model()
    # as for sweeps: which of several shapes a simulation settles in
    noise = model.folding.settings.noise
    fold, deviation = model.folded(
        np.log(np.array(cell_mm) / flat_mm), noise, found, simulated=mixture.simulated
    )
    course, wale = (mixture.size_mm * np.exp(fold)).tolist()
    return RelaxedSize(course, wale, float(deviation.max()), KnownBy.RELAXATION)
