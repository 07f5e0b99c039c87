"""Published laws converted back to the tests that they came from, clamp to clamp.

A published law gives stress over the strain between the middle of the sample and the lower clamp,
which is ``r`` times the strain from clamp to clamp, and Poisson ratios from straight lines, which
overstate the waist. :class:`ClampCorrection` measures both effects on raw tests, and
:func:`converted` applies them to a law without raw tests.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from knitcore.fabric import Direction
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.measure.stretch_test import StretchTest

_MIN_HELD = 0.05
"""Of 1 - nu_xy nu_yx, so that a converted law stays stable."""


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
        """The ratios from one test, read both ways, and its published law."""
        published = _median(run.strain_along.max() for run in centre.runs)
        held = _median(run.strain_along.max() for run in clamps.runs)
        waist = _median(run.strain_across[np.argmax(run.strain_along)] for run in clamps.runs)
        ratio = law.poisson_yx if direction is Direction.COURSE else law.poisson_xy
        return cls(published / held, -waist / (ratio * published))

    @classmethod
    def mean(cls, found: Sequence[ClampCorrection]) -> ClampCorrection:
        """The geometric mean of several corrections."""
        logs = np.log([(c.strain_ratio, c.waist_ratio) for c in found])
        strain, waist = np.exp(logs.mean(axis=0)).tolist()
        return cls(strain, waist)


def _median(values: Iterable[float]) -> float:
    return float(np.median(list(values)))


def converted(law: ConstitutiveLaw, correction: ClampCorrection) -> ConstitutiveLaw:
    """A published law, over the strain between the clamps.

    With the published strain r times the one between the clamps, sigma_p(r e) = sigma(e): Young's
    moduli and alpha are r times as large, and beta stays. The waist at that strain is the
    published one times the waist's ratio.
    """
    strain, waist = correction.strain_ratio, correction.strain_ratio * correction.waist_ratio
    yx, xy = waist * law.poisson_yx, waist * law.poisson_xy
    held = max(1.0 - yx * xy, _MIN_HELD)
    stiffness_xx, stiffness_yy = (strain * law.modulus(d) / held for d in Direction)
    return replace(
        law,
        stiffness_xxxx=stiffness_xx,
        stiffness_yyyy=stiffness_yy,
        stiffness_xxyy=xy * stiffness_xx,
        stiffness_yyxx=yx * stiffness_yy,
        alpha_xx=strain * law.alpha_xx,
        alpha_yy=strain * law.alpha_yy,
    )
