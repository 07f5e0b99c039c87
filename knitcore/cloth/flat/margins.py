"""The intervals of a strip test at every step, for the whole swatch and for each stitch."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, check_cancelled
from knitcore.chart.result import Result
from knitcore.cloth.flat import Clamps, StripTest
from knitcore.cloth.flat.strip_uncertainty import StripSpread, interval_source
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import Z_SCORE

SAMPLES = 5
"""Number of steps at which intervals are computed. Between them they are interpolated over the
strain: in 20 steps to 0.28 this is off by less than 5 % of a step's widest interval of a strain,
and by less than 12 % of its widest interval of a utilisation."""


@dataclass(frozen=True, eq=False, repr=False)
class StretchMargins(Result):
    """Half widths of 90 % intervals.

    Attributes
    ----------
    force_factor : (steps,), factor between force or stress and either end of its interval.
    waist : (steps,).
    strain, utilisation : (steps, rows, columns) at the stitches; the strain along the pull.
    source : what the intervals rest on, in words.
    """

    force_factor: Array
    waist: Array
    strain: Array
    utilisation: Array
    source: str


def sampled_steps(steps: int) -> list[int]:
    """Steps at which the intervals of a test are computed, the first and the last among them."""
    count = min(steps, SAMPLES)
    return sorted(set(np.linspace(0, steps - 1, count).round().astype(int).tolist()))


def stretch_margins(
    test: StripTest,
    material: Material,
    clamps: Clamps,
    *,
    progress: Callable[[int], None] | None = None,
    cancelled: Cancelled | None = None,
) -> StretchMargins:
    """Intervals of a test of a chart; ``progress`` is called with the number of samples done.

    Raises
    ------
    CancelledError
        If ``cancelled`` returned True.
    """
    from scipy.interpolate import PchipInterpolator  # slow to import

    spread = StripSpread(test, material, clamps)
    picked = sampled_steps(test.steps)
    samples: list[tuple[Array, Array, Array, Array]] = []
    for step in picked:
        check_cancelled(cancelled)
        at = spread.at(step)
        along = at.strain_xx_sd if test.direction.axis == 0 else at.strain_yy_sd
        samples.append(
            (
                np.array(at.force_log_sd),
                np.array(at.waist_sd),
                along[1::2, 1::2],  # nodes lie on the quarter grid
                at.utilisation_sd[1::2, 1::2],
            )
        )
        if progress is not None:
            progress(len(samples))

    def at_all_steps(kind: int) -> Array:
        known = Z_SCORE * np.array([sample[kind] for sample in samples])
        known = np.nan_to_num(known)  # where a shaped piece has no stitch
        if len(samples) < 2:
            return known
        return np.asarray(PchipInterpolator(test.strain[picked], known, axis=0)(test.strain))

    force, waist, strain, utilisation = map(at_all_steps, range(4))
    source = interval_source(test.sheet, material)
    return StretchMargins(np.exp(force), waist, strain, utilisation, source)
