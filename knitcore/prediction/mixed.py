"""Charts that mix pure fabrics: the learned response with its intervals, bounds and notes."""

import math
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.law.response import Response
from knitcore.materials import Interval, Material
from knitcore.materials.interval_parts import Part, Variances, added, shared_out
from knitcore.materials.law_uncertainty import Z_SCORE
from knitcore.prediction.densities import Densities
from knitcore.prediction.learned import LearnedResponse, SweptChart
from knitcore.prediction.mixture import Mixture
from knitcore.prediction.prediction import Along, Prediction, Source
from knitcore.prediction.pure import CURL, SIZE_LOG_SD, SIZE_SD_SOURCE
from knitcore.prediction.size import KnownBy, RelaxedSize

LEARNED = (
    "Estimated from simulations without friction: the first stretch and the width are the least "
    "certain."
)
COUNT = "Your own gauge makes both more certain."
RELAXED = "The size at rest comes from a simulation of the yarn of this chart."
SWEPT = (
    "From a simulation of this chart without friction: the first stretch and the width are the "
    "least certain."
)
LEARNED_ERRORS = "errors on charts that the model had not seen"
KNITTED = "29 knitted swatches (KnitDB)"
_LOOP_SPREAD = 1.15


def predict_mixed(
    repeat: StitchChart,
    composition: Densities,
    material: Material,
    learned: LearnedResponse,
    size: RelaxedSize | None,
    swept: SweptChart | None = None,
) -> Prediction:
    """Add intervals, source and notes to the learned response of a chart.

    Parameters
    ----------
    repeat : a repeat of more than one pure fabric, or a patch of a chart.
    composition : its densities.
    learned : its size and response.
    size : its relaxed size, if known.
    swept : its sweep at the yarn level, if there is one.
    """
    mixture, parts = learned.mixture, learned.mixture.parts
    source = Source.LEARNED if size is None else Source.LEARNED_OF_SIZE
    taught, note = "estimated from simulations of mixed charts", LEARNED
    errors = LEARNED_ERRORS
    if swept is not None:
        source, taught, note = Source.SWEPT, "from a simulated stretch of this chart", SWEPT
        errors = KnownBy.RELAXATION.errors
    known_by = None if size is None else size.known_by
    pure = 1 - float(composition.mixed)  # near a pure fabric that fabric's own uncertainty counts
    if known_by is KnownBy.GAUGE:
        remarks: tuple[str, ...] = (note,)
        size_errors: tuple[str, ...] = (known_by.errors,)
        own_size_log_sd = 0.0
    else:
        remarks = (f"{note} {COUNT}", *((RELAXED,) if known_by else ()))
        knitted = () if mixture.simulated else (KNITTED,)
        size_errors = (known_by.errors if known_by else errors, *knitted, SIZE_SD_SOURCE)
        own_size_log_sd = SIZE_LOG_SD * pure
    shares = ", ".join(f"{share:.0%} {record.fabric}" for share, record in parts)
    notes = _notes(mixture, material)
    course, wale = (_along(learned, direction, own_size_log_sd, pure) for direction in Direction)
    return Prediction(
        course,
        wale,
        sum(share * record.law.shear_modulus for share, record in parts),
        source,
        f"{shares} mixed in {repeat.columns} x {repeat.rows} stitches, with a correction {taught}",
        known_by or ("learned" if swept is None else "yarn level"),
        tuple(dict.fromkeys([errors, *(record.uncertainty.source for _, record in parts)])),
        size_errors,
        (*remarks, *notes),
    )


def _along(
    learned: LearnedResponse, direction: Direction, own_size_log_sd: float, pure: float
) -> Along:
    response = _response(learned, direction)
    parts = learned.mixture.parts
    axis = direction.axis
    own_poisson_sd = pure * sum(share * r.uncertainty.poisson(direction) for share, r in parts)
    own_poisson = shared_out(
        np.asarray(own_poisson_sd**2), added({r.unknown: np.asarray(s)} for s, r in parts)
    )
    held = float(learned.mixture.shares_of_strain(direction, 0.0)[1])
    bounds = (*learned.mixture.bounds_n_per_mm(direction), response.modulus_n_per_mm)
    return Along(
        response,
        _response(learned, direction, -Z_SCORE),
        _response(learned, direction, Z_SCORE),
        partial(learned.across_strain, direction),
        Response(response.modulus_n_per_mm / held, partial(learned.held_strain, direction)),
        poisson=float(learned.poisson[axis]),
        poisson_parts=added([_of_axis(learned.poisson_parts, axis), own_poisson]),
        relaxed_mm=float(learned.size_mm[axis]),
        relaxed_parts=added(
            [_of_axis(learned.size_parts, axis), {Part.SIZE: np.asarray(own_size_log_sd**2)}]
        ),
        strain_parts=partial(learned.strain_parts, direction),
        bounds_n_per_mm=Interval(min(bounds), max(bounds)),
    )


def _of_axis(parts: Variances, axis: int) -> Variances:
    return {part: of[axis] for part, of in parts.items()}


def _response(learned: LearnedResponse, direction: Direction, deviations: float = 0.0) -> Response:
    """The stretch, moved by ``deviations`` standard deviations of the log strain."""

    def strain(stress: ArrayLike) -> Array:
        spread = deviations * learned.strain_log_sd(direction, stress) if deviations else 0.0
        return np.asarray(learned.strain(direction, stress) * np.exp(spread))

    softer = math.exp(deviations * learned.modulus_log_sd(direction))
    return Response(learned.modulus_n_per_mm(direction) / softer, strain)


def _notes(mixture: Mixture, material: Material) -> tuple[str, ...]:
    notes = []
    if any(share > 0.5 and r.fabric is Fabric.STOCKINETTE for share, r in mixture.parts):
        notes.append(CURL)
    lengths = {r.fabric: r.loop_length_mm for _, r in mixture.parts if r.loop_length_mm is not None}
    if lengths and max(lengths.values()) > _LOOP_SPREAD * min(lengths.values()):
        listed = ", ".join(f"{fabric} {length:g} mm" for fabric, length in lengths.items())
        notes.append(
            f"The fabrics of this material were knitted at different loop lengths ({listed}); a "
            "mixed chart lies between them."
        )
    return (*notes, material.note) if material.note else tuple(notes)
