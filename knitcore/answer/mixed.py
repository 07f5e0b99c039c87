"""Charts that mix pure fabrics: the learned answer with its intervals, bounds and notes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from knitcore.answer.answer import Along, Answer, Source
from knitcore.answer.densities import Densities
from knitcore.answer.learned import LearnedAnswer, SweptChart, packaged_model
from knitcore.answer.measured import CURL, GAUGE_LOG_SD, GAUGE_SD_SOURCE
from knitcore.answer.mixture import Mixture
from knitcore.answer.relaxed import KnownBy, RelaxedSize
from knitcore.arrays import Array
from knitcore.chart import StitchChart
from knitcore.fabric import Direction, Fabric
from knitcore.law.response import Response
from knitcore.materials import Interval, Material
from knitcore.materials.uncertainty import Z_SCORE

LEARNED = (
    "Learned from yarn-level simulations, which have no friction or set: the initial stretch and "
    "the draw-in are the least certain."
)
COUNT = "Your own gauge makes both more certain."
RELAXED = "The size at rest comes from a relaxation of this chart at the yarn level."
SWEPT = (
    "From a yarn-level simulation of this chart, which has no friction or set: the initial stretch "
    "and the draw-in are the least certain."
)
LEARNED_ERRORS = "errors on charts that the model had not seen"
KNITTED = "29 knitted swatches (KnitDB)"
_LOOP_SPREAD = 1.15


def mixed(
    repeat: StitchChart,
    found: Densities,
    material: Material,
    gauge: RelaxedSize | None,
    swept: SweptChart | None = None,
) -> Answer:
    """Answer for a repeat of more than one pure fabric.

    Parameters
    ----------
    repeat : the repeat.
    found : its densities.
    gauge : its relaxed size, if known.
    swept : its sweep at the yarn level, if there is one.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the repeat needs.
    """
    learned = packaged_model().answer(found, material, gauge, swept)
    return _answer(repeat, found, material, learned, gauge, swept)


def mixed_patches(
    parts: Sequence[StitchChart],
    found: Densities,
    material: Material,
    sizes: Sequence[RelaxedSize | None],
) -> list[Answer]:
    """Answers for the patches of a chart, by their densities and relaxed sizes, if known.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the patches need.
    """
    learned = packaged_model().answers(found, material, sizes)
    each = zip(parts, found, learned, sizes, strict=True)
    return [_answer(part, own, material, one, size) for part, own, one, size in each]


def _answer(
    repeat: StitchChart,
    found: Densities,
    material: Material,
    learned: LearnedAnswer,
    gauge: RelaxedSize | None,
    swept: SweptChart | None = None,
) -> Answer:
    pure = 1 - float(found.mixed)  # near a pure fabric that fabric's own uncertainty counts
    known_by = None if gauge is None else gauge.known_by
    own = 0.0 if known_by is KnownBy.GAUGE else GAUGE_LOG_SD * pure
    course, wale = (_along(learned, direction, own, pure) for direction in Direction)
    parts = learned.mixture.parts
    shares = ", ".join(f"{share:.0%} {record.fabric}" for share, record in parts)
    source = Source.LEARNED if gauge is None else Source.LEARNED_OF_SIZE
    taught, note = "learned from yarn-level simulations of mixed charts", LEARNED
    errors = LEARNED_ERRORS
    if swept is not None:
        source, taught, note = Source.SWEPT, "from a yarn-level stretch of this chart", SWEPT
        errors = KnownBy.RELAXATION.errors
    return Answer(
        course,
        wale,
        sum(share * record.law.shear_modulus for share, record in parts),
        source,
        f"{shares} mixed in {repeat.columns} x {repeat.rows} stitches, with a correction {taught}",
        known_by or ("learned" if swept is None else "yarn level"),
        tuple(dict.fromkeys([errors, *(record.uncertainty.source for _, record in parts)])),
        _size_errors(errors, known_by, learned.mixture),
        (*_of_size(note, known_by), *_notes(learned.mixture, material)),
    )


def _size_errors(errors: str, known_by: KnownBy | None, mixture: Mixture) -> tuple[str, ...]:
    if known_by is KnownBy.GAUGE:
        return (known_by.errors,)
    knitted = () if mixture.simulated else (KNITTED,)
    return (known_by.errors if known_by else errors, *knitted, GAUGE_SD_SOURCE)


def _of_size(note: str, known_by: KnownBy | None) -> tuple[str, ...]:
    match known_by:
        case None:
            return (f"{note} {COUNT}",)
        case KnownBy.RELAXATION:
            return (f"{note} {COUNT}", RELAXED)
        case KnownBy.GAUGE:
            return (note,)


def _along(
    found: LearnedAnswer, direction: Direction, own_size_log_sd: float, pure: float
) -> Along:
    response = _response(found, direction)
    parts = found.mixture.parts
    own_poisson_sd = pure * sum(share * r.uncertainty.poisson(direction) for share, r in parts)
    held = float(found.mixture.shares_of_strain(direction, 0.0)[1])
    bounds = (*found.mixture.bounds_n_per_mm(direction), response.modulus_n_per_mm)
    return Along(
        response,
        _response(found, direction, -Z_SCORE),
        _response(found, direction, Z_SCORE),
        partial(found.across_strain, direction),
        Response(response.modulus_n_per_mm / held, partial(found.held_strain, direction)),
        poisson=float(found.poisson[direction.axis]),
        poisson_sd=math.hypot(found.poisson_sd[direction.axis], own_poisson_sd),
        relaxed_mm=float(found.size_mm[direction.axis]),
        relaxed_log_sd=math.hypot(found.size_log_sd[direction.axis], own_size_log_sd),
        bounds_n_per_mm=Interval(min(bounds), max(bounds)),
    )


def _response(found: LearnedAnswer, direction: Direction, deviations: float = 0.0) -> Response:
    """The stretch, moved by ``deviations`` standard deviations of the log strain."""

    def strain(stress: ArrayLike) -> Array:
        spread = deviations * found.strain_log_sd(direction, stress) if deviations else 0.0
        return np.asarray(found.strain(direction, stress) * np.exp(spread))

    softer = math.exp(deviations * found.modulus_log_sd(direction))
    return Response(found.modulus_n_per_mm(direction) / softer, strain)


def _notes(mixture: Mixture, material: Material) -> tuple[str, ...]:
    found = []
    if any(share > 0.5 and r.fabric is Fabric.STOCKINETTE for share, r in mixture.parts):
        found.append(CURL)
    lengths = {r.fabric: r.loop_length_mm for _, r in mixture.parts if r.loop_length_mm is not None}
    if lengths and max(lengths.values()) > _LOOP_SPREAD * min(lengths.values()):
        listed = ", ".join(f"{fabric} {length:g} mm" for fabric, length in lengths.items())
        found.append(
            f"The fabrics of this material were knitted at different loop lengths ({listed}); a "
            "mixed chart lies between them."
        )
    return (*found, material.note) if material.note else tuple(found)
