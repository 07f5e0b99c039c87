"""The median curve of repeated pulls."""

from __future__ import annotations

import numpy as np

from knitcore.materials.measured_curves import MeasuredCurve
from knitcore.measure.stretch_test import StretchTest

POINTS = 60


def median_curve(test: StretchTest) -> MeasuredCurve:
    """Median stress of the pulls at equal steps of strain.

    Each pull is first averaged over steps of strain, which removes the camera's noise.
    The curve goes as far as at least half of the pulls do.

    Raises
    ------
    InputError
        If the pulls have no range of strain in common.

    Examples
    --------
    >>> from knitcore.measure.stretch_test import StretchRun
    >>> strain = np.linspace(0, 0.5, 200)
    >>> runs = tuple(StretchRun("", strain, -strain, k * strain) for k in (0.9, 1.0, 2.0))
    >>> curve = median_curve(StretchTest("", "", runs, (70.0,) * 3))
    >>> round(curve.strain[-1], 3), round(curve.stress_n_per_mm[-1], 2), curve.pulls
    (0.496, 0.5, 3)
    """
    centres = (np.arange(POINTS) + 0.5) / POINTS * test.usual_strain
    stresses = np.full((len(test.runs), POINTS), np.nan)
    for stress, run in zip(stresses, test.runs, strict=True):
        mean = run.averaged(POINTS, test.usual_strain)
        outside = (centres < run.strain_along.min()) | (centres > run.strain_along.max())
        stress[:] = np.where(outside, np.nan, np.interp(centres, mean.strain_along, mean.stress))
    known = np.isfinite(stresses).sum(axis=0) * 2 >= len(test.runs)
    median = np.nanmedian(stresses[:, known], axis=0)
    return MeasuredCurve(
        tuple(centres[known].round(5).tolist()), tuple(median.round(6).tolist()), len(test.runs)
    )
