"""Points of a stretch test that tell of a yarn (:mod:`knitcore.materials.estimate.pulled`)."""

from __future__ import annotations

import numpy as np

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.materials.estimate.without_tester import LAW_SCATTER, LAW_STRESSES_N_PER_MM
from knitcore.measure.stretch_points import StretchPoint
from knitcore.measure.stretch_test import StretchTest


def points_of_test(
    test: StretchTest, fabric: Fabric, direction: Direction
) -> tuple[StretchPoint, ...]:
    """Points of a stretch test as far as it goes: means of its pulls, clamp to clamp.

    Raises
    ------
    InputError
        If no pull reaches the smallest stress that is read.
    """
    points = []
    for stress in LAW_STRESSES_N_PER_MM:
        runs = [run for run in test.runs if run.stress.max() >= stress]
        if not runs:
            break
        strains = [
            float(np.interp(stress, np.maximum.accumulate(run.stress), run.strain_along))
            for run in runs
        ]
        along = float(np.mean(strains))
        spread = LAW_SCATTER * along
        points.append(StretchPoint(fabric, direction, stress, along, spread, 0.0, spread))
    if not points:
        least = LAW_STRESSES_N_PER_MM[0]
        problem = f"no pull reaches {least:g} N/mm."
        raise InputError(test.source, problem, "Pull farther, or take a narrower strip.")
    return tuple(points)
