"""Pure fabrics: their own law and size."""

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.response import free_response, held_response, stiffened
from knitcore.law.uniaxial import free_transverse_strains
from knitcore.materials import FabricRecord, Interval, Material, Origin
from knitcore.materials.interval_parts import Part
from knitcore.materials.law_uncertainty import Z_SCORE
from knitcore.prediction.prediction import Along, Prediction, Source

CURLS = (
    "Stockinette curls: its sides roll to the purl side, its top and bottom edges to the knit side."
)
CURL = f"{CURLS} The moduli are those of a sheet held flat."

SIZE_LOG_SD = 0.08
"""Standard deviation of the logarithm of a pure fabric's size: one aspect ratio is used for all
yarns, and those of two yarns differ by up to 17 % (``materials/data/aspect.csv``)."""
SIZE_SD_SOURCE = "one aspect ratio of stitches for all yarns (8 %)"
_SMALLEST_N_PER_MM = 1e-5
"""Stress at which a fabric still has its modulus."""

_SOURCES = {Origin.SIMULATED: Source.SWEPT, Origin.ESTIMATED: Source.ESTIMATED}


def predict_pure(fabric: Fabric, material: Material) -> Prediction:
    """Predict a pure fabric from its record in the material.

    Raises
    ------
    InputError
        If the material has no such fabric.
    """
    record = material.record(fabric)
    notes = [CURL] if fabric is Fabric.STOCKINETTE else []
    course, wale = (_along(record, direction) for direction in Direction)
    return Prediction(
        course,
        wale,
        record.law.shear_modulus,
        _SOURCES.get(record.origin, Source.MEASURED),
        f"law of {fabric}, {record.origin}",
        "gauge of the pure fabric",
        (record.uncertainty.source,),
        (SIZE_SD_SOURCE,),
        (*notes, *([material.note] if material.note else [])),
    )


def _along(record: FabricRecord, direction: Direction) -> Along:
    law, spread = record.law, record.uncertainty
    response, modulus = free_response(law, direction), law.modulus(direction)
    # the stress at each strain is uncertain; the lock-up strain, which tests fix best, is kept
    stiff = stiffened(response, lambda stress: Z_SCORE * spread.log_stress(direction, stress))
    soft = stiffened(response, lambda stress: -Z_SCORE * spread.log_stress(direction, stress))
    part = record.unknown

    def parts(stress: ArrayLike) -> dict[Part, Array]:
        least, most = (end.strain(np.maximum(stress, _SMALLEST_N_PER_MM)) for end in (stiff, soft))
        return {part: np.square(np.log(most / least) / (2 * Z_SCORE))}

    return Along(
        response,
        stiff,
        soft,
        lambda stress: free_transverse_strains(law, direction, response.strain(stress)),
        held_response(law, direction),
        poisson=law.poisson(direction),
        poisson_parts={part: np.asarray(spread.poisson(direction) ** 2)},
        relaxed_mm=record.stitch_size_mm(direction),
        relaxed_parts={Part.SIZE: np.asarray(SIZE_LOG_SD**2)},
        strain_parts=parts,
        bounds_n_per_mm=Interval(modulus, modulus),
    )
