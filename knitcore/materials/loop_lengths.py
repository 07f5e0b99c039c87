"""Length of yarn in stitches."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.fabric import PHASES
from knitcore.materials.material import Material


def loop_lengths_mm(quarters: NDArray[np.uint8], material: Material) -> Array:
    """Yarn of stitches, (...): the mean loop length of their quarters' fabrics.

    Parameters
    ----------
    quarters : (..., 4) phases of the stitches' quarters.

    Raises
    ------
    InputError
        If one of these fabrics has no loop length.
    """
    lengths = np.zeros(len(PHASES))
    for phase in np.unique(quarters):
        length = material.record(PHASES[phase]).loop_length_mm
        if length is None:
            raise InputError(
                "material",
                f"{material.identifier} has no loop length for {PHASES[phase]}.",
                "Unravel ten stitches of a swatch, measure the yarn, and add loop_length_mm.",
            )
        lengths[phase] = length
    return np.asarray(lengths[quarters].mean(axis=-1))
