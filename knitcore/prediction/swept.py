"""Charts that were themselves relaxed and stretched at the yarn level, applied to a material.

The yarn level has no friction and an idealised yarn: its pure fabrics differ from measured ones by
up to a factor of two. So a sweep is compared with the mixture of pure fabrics of the same yarn *on
the yarn level*, and the ratios correct the mixture of the material's own pure fabrics, as those of
the learned model do (:mod:`knitcore.prediction.learned`); and as there, knitted fabric folds less.
A relaxation alone gives the size in the same way. It takes seconds, so the page starts one when
painting pauses.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import FabricRecord, Material, Origin
from knitcore.materials.law_uncertainty import LawUncertainty
from knitcore.prediction.densities import densities
from knitcore.prediction.learned import STRESS_GRID, SweptChart, follows, packaged_model
from knitcore.prediction.mixture import Mixture
from knitcore.prediction.prediction import Prediction, Source
from knitcore.prediction.size import KnownBy, RelaxedSize

STRESS = np.geomspace(0.005, 0.33, 24)
"""Stresses (N/mm) at which curves are compared."""
MIN_REACHED_N_PER_MM = 0.1
"""Curves that end below this stress, as those of wide ribs do at a strain of 3, are not used."""
MAX_STITCHES = 36
"""Largest repeat that is worth the wait: its relaxation takes some seconds."""


def swept_chart(
    chart: StitchChart,
    size_mm: tuple[float, float],
    law: ConstitutiveLaw,
    pure: Mapping[Fabric, FabricRecord],
    material: Material,
) -> SweptChart:
    """The correction of a chart's mixture by a sweep.

    Parameters
    ----------
    chart : the repeat that was swept.
    size_mm : width and height of its relaxed mean stitch.
    law : fitted to the sweep.
    pure : all pure fabrics of the chart, from the same simulation of the same yarn.
    material : whose yarn it is.
    """
    mixture = Mixture.of(densities(chart).shares, material)
    same = replace(mixture, parts=tuple((share, pure[r.fabric]) for share, r in mixture.parts))
    fold, ratio = over_mixture(same, size_mm, *of_law(law))
    slopes = packaged_model().slopes * follows(same)
    return SweptChart(fold, ratio - slopes @ fold)


def over_mixture(
    mixture: Mixture,
    size_mm: tuple[float, float],
    strains: Sequence[Array],
    poisson: tuple[float, float],
) -> tuple[Array, Array]:
    """A simulation compared with the mixture of the pure fabrics of the same yarn.

    Parameters
    ----------
    strains : at :data:`STRESS`, course-wise and wale-wise; nan where it was not stretched so far.

    Returns
    -------
    (2,) logarithms of width and height; (14,) logarithms of strain at the stresses of the learned
    model, nan where a stretch ended below :data:`MIN_REACHED_N_PER_MM`, and differences of
    Poisson's ratios.
    """
    at = np.log(STRESS / mixture.bending_stress_n_per_mm)
    ratio = np.full((2, len(STRESS_GRID)), np.nan)
    for direction, strain in zip(Direction, strains, strict=True):
        logs = np.log(strain / mixture.strain(direction, STRESS))
        known = np.isfinite(logs)
        if known.any() and STRESS[known][-1] >= MIN_REACHED_N_PER_MM:
            ratio[direction.axis] = np.interp(np.log(STRESS_GRID), at[known], logs[known])
    fold = np.log(np.array(size_mm) / mixture.size_mm)
    return fold, np.append(ratio.ravel(), np.array(poisson) - mixture.poisson)


def of_law(law: ConstitutiveLaw) -> tuple[list[Array], tuple[float, float]]:
    """Strains at :data:`STRESS` and Poisson's ratios of a law that was fitted to a sweep."""
    strains = [free_strains_at_stress(law, direction, STRESS) for direction in Direction]
    return strains, (law.poisson_yx, law.poisson_xy)


def simulated_record(
    fabric: Fabric,
    size_mm: tuple[float, float],
    law: ConstitutiveLaw,
    loop_length_mm: float | None = None,
) -> FabricRecord:
    """A pure fabric as simulated at the yarn level."""
    exact = LawUncertainty(0.0, 0.0, 0.0, 0.0, "yarn level")
    return FabricRecord(fabric, law, *size_mm, exact, Origin.SIMULATED, loop_length_mm)


def worth_relaxing(
    chart: StitchChart, material: Material, prediction: Prediction
) -> StitchChart | None:
    """The repeat whose relaxation would make a learned prediction more certain; None if none would.

    Measured cloth shows the folds of the yarn level only in part, so for measured materials a
    relaxation narrows no interval.
    """
    if prediction.provenance is not Source.LEARNED or not material.is_simulated:
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
    composition = densities(chart)
    mixture = Mixture.of(composition.shares, material)
    flat_mm = sum(share * np.array(pure_mm[record.fabric]) for share, record in mixture.parts)
    model = packaged_model()
    # as for sweeps: which of several shapes a simulation settles in
    noise = model.folding.settings.noise
    fold, deviation = model.folded(
        np.log(np.array(cell_mm) / flat_mm), noise, composition, simulated=mixture.simulated
    )
    course, wale = (mixture.size_mm * np.exp(fold)).tolist()
    return RelaxedSize(course, wale, float(deviation.max()), KnownBy.RELAXATION)
