"""A yarn after one pull of one of its fabrics.

In a yarn whose laws were estimated, errors of fabrics belong together as the library's yarns differ
(:mod:`knitcore.materials.estimate.mixed_model`), as far as the yarn's own uncertainty goes: one
pull of any fabric updates all of them. Laws that rest on tests of their own err each by itself, so
that a pull tells of its own fabric and direction only.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials.estimate.mixed_model import LogStrain, MixedModel
from knitcore.materials.estimate.without_tester import library_values, log_strain, points_of_law
from knitcore.materials.estimate.yarn_statistics import DIRECTIONS, FABRICS, LOAD_N_PER_MM
from knitcore.materials.law_uncertainty import CurveUncertainty, LawUncertainty
from knitcore.materials.material import Material, Origin
from knitcore.measure.stretch_points import StretchPoint

_Known = tuple[Fabric, ConstitutiveLaw, LawUncertainty, Origin]
_STEP = 0.05
_LEAST_ALPHA, _LEAST_BETA = 0.05, 1e-4
"""Floors for a law without stiffening, where logarithms are taken."""


def pulled(material: Material, points: Sequence[StretchPoint]) -> Material:
    """The material with laws and intervals as points of stretch curves leave them.

    Parameters
    ----------
    material : with the fabrics that were pulled.
    points : of any of its fabrics, all that there are: a second call counts as another yarn's.

    Raises
    ------
    InputError
        If the material lacks a fabric that was pulled, or there is no point.
    """
    if not points:
        raise InputError("points", "there are none.", "Give at least one point of a pull.")
    known = tuple((f, r.law, r.uncertainty, r.origin) for f, r in material.fabrics.items())
    before = _belief(known)
    laws = [material.law(point.fabric) for point in points]
    after = before.knowing(
        [_over_law(law, before, point) for law, point in zip(laws, points, strict=True)]
    )
    change = np.exp(after.mean - before.mean)
    pulls = ", ".join(dict.fromkeys(f"{p.fabric} pulled {p.direction}-wise" for p in points))
    records = {
        fabric: replace(
            record,
            law=_changed(record.law, change[:, FABRICS.index(fabric)]),
            uncertainty=_narrowed(fabric, record.uncertainty, before, after, pulls),
        )
        for fabric, record in material.fabrics.items()
    }
    return replace(material, fabrics=records)


def if_pulled(material: Material, fabric: Fabric, direction: Direction) -> Material:
    """The material with the intervals that a pull would leave which says what is expected of it.

    Raises
    ------
    InputError
        If the material lacks the fabric.
    """
    material.record(fabric)
    known = tuple((f, r.law, r.uncertainty, r.origin) for f, r in material.fabrics.items())
    left = dict(_if_pulled(known, fabric, direction))
    return replace(
        material, fabrics={f: replace(r, uncertainty=left[f]) for f, r in material.fabrics.items()}
    )


@lru_cache(maxsize=256)
def _if_pulled(
    known: tuple[_Known, ...], fabric: Fabric, direction: Direction
) -> tuple[tuple[Fabric, LawUncertainty], ...]:
    before = _belief(known)
    law = next(law for f, law, _, _ in known if f is fabric)
    points = [point for point in points_of_law(fabric, law) if point.direction is direction]
    after = before.knowing([_over_law(law, before, point) for point in points])
    pull = f"{fabric} pulled {direction}-wise"
    return tuple((f, _narrowed(f, of, before, after, pull)) for f, _, of, _ in known)


@lru_cache(maxsize=16)
def _belief(known: tuple[_Known, ...]) -> MixedModel:
    """The logarithms of modulus, alpha and beta of a material's fabrics, as far as known."""
    others = MixedModel.fit(library_values())
    mean, estimated = others.mean.copy(), np.ones((4, 2), dtype=bool)
    for fabric, law, _, origin in known:
        i = FABRICS.index(fabric)
        estimated[i] = origin is Origin.ESTIMATED
        for d in DIRECTIONS:
            constants = law.modulus(d), law.alpha(d), law.beta(d)
            mean[:, i, d.axis] = np.log(np.maximum(constants, (1e-9, _LEAST_ALPHA, _LEAST_BETA)))
    model, wider = MixedModel(mean, others.covariance), np.ones((4, 2))
    for fabric, law, uncertainty, _ in known:
        i = FABRICS.index(fabric)
        for d in DIRECTIONS:
            own = float(uncertainty.log_stress(d, LOAD_N_PER_MM)) * _slope(law, d)
            wider[i, d.axis] = own / model.log_strain(i, d.axis, LOAD_N_PER_MM)[1]
    together = np.logical_and.outer(estimated.ravel(), estimated.ravel()) | np.eye(8, dtype=bool)
    scale = np.tile(wider.ravel(), 3)
    covariance = others.covariance * np.outer(scale, scale) * np.tile(together, (3, 3))
    return MixedModel(mean, covariance)


def _slope(law: ConstitutiveLaw, direction: Direction) -> float:
    """d ln strain / d ln stress at the load of use."""
    stresses = (LOAD_N_PER_MM * math.exp(-_STEP), LOAD_N_PER_MM * math.exp(_STEP))
    low, high = np.log(free_strains_at_stress(law, direction, stresses)).tolist()
    return float(high - low) / (2 * _STEP)


def _over_law(law: ConstitutiveLaw, belief: MixedModel, point: StretchPoint) -> LogStrain:
    """A point as far above the belief as it is above the law, whose width narrows."""
    own = float(free_strains_at_stress(law, point.direction, point.force_n_per_mm))
    read = log_strain(point)
    expected = belief.log_strain(read.fabric, read.direction, read.stress_n_per_mm)[0]
    return replace(read, value=read.value - math.log(own) + expected)


def _narrowed(
    fabric: Fabric, known: LawUncertainty, before: MixedModel, after: MixedModel, pulls: str
) -> LawUncertainty:
    """The uncertainty of a fabric's law, narrower by as much as the belief is."""
    i, moduli, curves = FABRICS.index(fabric), [], []
    for d in DIRECTIONS:
        first = after.deviation[0, i, d.axis] / before.deviation[0, i, d.axis]
        old, new = (model.log_strain(i, d.axis, LOAD_N_PER_MM)[1] for model in (before, after))
        curve = known.curve(d)
        moduli.append(float(first) * known.log_modulus(d))
        curves.append(CurveUncertainty(new / old * curve.log_stress, curve.log_lock_up))
    return replace(
        known,
        log_modulus_course=moduli[0],
        log_modulus_wale=moduli[1],
        curve_course=curves[0],
        curve_wale=curves[1],
        source=f"{known.source}; {pulls}",
    )


def _changed(law: ConstitutiveLaw, change: Array) -> ConstitutiveLaw:
    """A law with its moduli, alpha and beta times a change, (3, 2)."""
    modulus, alpha, beta = change.tolist()
    return ConstitutiveLaw.of_moduli(
        law.modulus_course * modulus[0],
        law.modulus_wale * modulus[1],
        law.poisson_yx,
        law.poisson_xy,
        alpha_xx=law.alpha_xx * alpha[0],
        alpha_yy=law.alpha_yy * alpha[1],
        beta_xx=law.beta_xx * beta[0],
        beta_yy=law.beta_yy * beta[1],
        shear_modulus=law.shear_modulus * math.sqrt(modulus[0] * modulus[1]),
        kappa_xx=law.kappa_xx,
        kappa_yy=law.kappa_yy,
        shear_stiffening=law.shear_stiffening,
    )
