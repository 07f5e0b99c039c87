"""Moduli of patches of a chart in a finite swatch, compared with large cloths of their repeats.

A patch is small, its repeat may be cut off, and its neighbours hold it. The swatch is pulled a
little along the course and along the wale; the mean stresses and strains of a patch in both pulls
give its own stiffness, and so its moduli. Divided by those of its repeat's flat composite, of which
the swatch is made, they give the factor between the patch and a large cloth of its repeat.
"""

from collections.abc import Sequence

import numpy as np

from knitcore.base.arrays import Array, Indices, Mask
from knitcore.base.errors import Cancelled
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.flat import Fields, strip_test
from knitcore.materials import Material
from knitcore.mechanics.homogenisation import homogenise
from knitcore.prediction.quarter_laws import flat_laws

SMALL_STRAIN = 0.005
LOADED = 0.2
"""Least stress along a pull, over the mean of all patches, of a patch that the pull measures."""


def finite_size(
    chart: StitchChart,
    material: Material,
    patches: Indices,
    repeats: Sequence[StitchChart],
    *,
    stitch: Mask,
    cancelled: Cancelled | None = None,
) -> Array:
    """(patches, 2) moduli of each patch in the swatch over those of its repeat, course and wale.

    They are 1 for patches that one of the pulls hardly loads, such as a finger of a glove that ends
    before the clamp.

    Parameters
    ----------
    chart : of the patches.
    patches : (rows, columns) number of each stitch's patch; numbers without a repeat are not
        patches.
    repeats : of each patch.
    stitch : (rows, columns), where there are stitches.

    Raises
    ------
    CancelledError
        If ``cancelled`` returned True.
    """
    count = len(repeats)
    stress, strain = np.empty((2, count, 2, 2))  # patch, component, pull
    for pull in Direction:
        test = strip_test(
            chart,
            material,
            pull,
            SMALL_STRAIN,
            steps=1,
            stitch=stitch,
            cancelled=cancelled,
            clamps="sliding",
            laws=flat_laws(chart, material),
        )
        fields = test.fields()
        area = _stitch_areas(fields).ravel()
        total = np.bincount(patches.ravel(), area)[:count]
        for component, name in enumerate(("xx", "yy")):
            for array, kind in ((stress, "stress"), (strain, "strain")):
                at_stitches = getattr(fields, f"{kind}_{name}")[1::2, 1::2].ravel()
                sums = np.bincount(patches.ravel(), area * at_stitches)[:count]
                array[:, component, pull.axis] = sums / total
    along = np.diagonal(stress, axis1=1, axis2=2)
    measured = (along > LOADED * along.mean(axis=0)).all(axis=1)
    compliance = strain[measured] @ np.linalg.inv(stress[measured])
    in_swatch = 1 / np.diagonal(compliance, axis1=1, axis2=2)
    large = {repeat: _flat_moduli(repeat, material) for repeat in dict.fromkeys(repeats)}
    factors = np.ones((count, 2))
    factors[measured] = in_swatch / np.array([large[repeat] for repeat in repeats])[measured]
    return factors


def _flat_moduli(repeat: StitchChart, material: Material) -> tuple[float, float]:
    sheet = homogenise(repeat, material)
    return sheet.modulus_n_per_mm(Direction.COURSE), sheet.modulus_n_per_mm(Direction.WALE)


def _stitch_areas(fields: Fields) -> Array:
    """Relaxed areas (rows, columns): every stitch is two quarter cells wide and high."""
    width = np.diff(fields.x_mm[0, ::2])
    height = np.diff(fields.y_mm[::2, 0])
    return np.outer(height, width)
