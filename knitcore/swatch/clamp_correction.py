"""Published laws converted back to the tests that they came from, clamp to clamp.

A published law gives stress over the strain between the middle of the sample and the lower clamp,
which is ``r`` times the strain from clamp to clamp, and Poisson ratios from straight lines, which
overstate the waist. :class:`ClampCorrection` measures both effects on raw tests.
:func:`carried_strip` converts a published law to the test as measured between the clamps, which
:func:`knitcore.swatch.strip_fit.fit_strips` can fit again.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from knitcore.fabric import Direction
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import strain_at_stress, uniaxial_response
from knitcore.measure.stretch_test import StretchTest
from knitcore.swatch.strip_fit import LEVELS, MeasuredStrip

LARGEST_STRESS_N_PER_MM = 0.25
"""About where the authors' tests end (30 N)."""
LOCK_UP_SHARE = 0.95
WAIST_NOISE = 0.06
"""Error of a waist computed from published Poisson ratios: these are slopes of straight lines, for
samples of unknown size."""


@dataclass(frozen=True)
class ClampCorrection:
    """Ratios between a raw test and its published reduction.

    Attributes
    ----------
    strain_ratio : r, published over clamp-to-clamp strain at the peaks of the pulls.
    waist_ratio : measured waist over the published Poisson ratio times the published strain.
    """

    strain_ratio: float
    waist_ratio: float

    @classmethod
    def of(
        cls, centre: StretchTest, clamps: StretchTest, law: ConstitutiveLaw, direction: Direction
    ) -> ClampCorrection:
        """From one test read both ways, and its published law."""
        published = _median(run.strain_along.max() for run in centre.runs)
        held = _median(run.strain_along.max() for run in clamps.runs)
        waist = _median(run.strain_across[np.argmax(run.strain_along)] for run in clamps.runs)
        ratio = law.poisson_yx if direction is Direction.COURSE else law.poisson_xy
        return cls(published / held, -waist / (ratio * published))

    @classmethod
    def mean(cls, found: Sequence[ClampCorrection]) -> ClampCorrection:
        """The geometric mean."""
        logs = np.log([(c.strain_ratio, c.waist_ratio) for c in found])
        strain, waist = np.exp(logs.mean(axis=0)).tolist()
        return cls(strain, waist)


def _median(values: Iterable[float]) -> float:
    return float(np.median(list(values)))


def carried_strip(
    law: ConstitutiveLaw,
    direction: Direction,
    size_mm: tuple[float, float],
    correction: ClampCorrection,
) -> MeasuredStrip:
    """The test behind a published law, as measured between the clamps.

    Parameters
    ----------
    law : as published.
    direction : of the pull.
    size_mm : clamped width and distance of the clamps.
    correction : to apply.
    """
    top = min(
        strain_at_stress(law, direction, LARGEST_STRESS_N_PER_MM),
        LOCK_UP_SHARE * law.lock_up_strain(direction),
    )
    published = np.linspace(0.08, 1.0, LEVELS) * top
    curve = uniaxial_response(law, direction, published)
    return MeasuredStrip(
        direction,
        *size_mm,
        strain=published / correction.strain_ratio,
        stress_n_per_mm=curve.stress[None],
        waist=correction.waist_ratio * curve.transverse_strain[None],
        waist_noise=WAIST_NOISE,
    )
