"""Compressibility of a yarn, k and p, from squeezing it under a flat probe (the paper's Note 3).

    F = A k (rho_0 / p) ((rho_0 / rho)**p - 1),   rho = depth_core - depth

with A the probe's width times the yarn's diameter, depth_core the depth at 3 N (the yarn's
incompressible core) and rho_0 = depth_core - depth_0, where depth_0 is the depth beyond which the
force stays above 1 mN. k and p by least squares over the readings from 1 mN to 1 N.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_range
from knitcore.base.errors import InputError
from knitcore.chart.result import Result
from knitcore.measure.compression_files import CompressionTest

PROBE_WIDTH_MM = 5.0
TOUCH_N = 1e-3
FIT_LIMIT_N = 1.0
CORE_N = 3.0
CORE_TOLERANCE = 0.02
MIN_READINGS = 15
THICKNESS_TIMES = 4.0
"""The squeezed thickness is between the diameter over this and the diameter times this."""


@dataclass(frozen=True, eq=False, repr=False)
class CompressionSample(Result):
    """Result of one test.

    Attributes
    ----------
    name, yarn : of the sample.
    k_n_per_mm3, p : constants of the force law, with their standard errors of the fit.
    thickness_mm : rho_0, the compressible thickness.
    diameter_mm : used for the area.
    rms_n : of the residuals.
    depth_mm, force_n, fitted_n : the readings fitted, for plots.
    """

    name: str
    yarn: str
    k_n_per_mm3: float
    k_error_n_per_mm3: float
    p: float
    p_error: float
    thickness_mm: float
    diameter_mm: float
    rms_n: float
    depth_mm: Array
    force_n: Array
    fitted_n: Array


@dataclass(frozen=True)
class CompressionMean:
    """Mean and standard deviation over the samples of one yarn (None for a single sample)."""

    yarn: str
    samples: int
    k_n_per_mm3: float
    k_standard_deviation_n_per_mm3: float | None
    p: float
    p_standard_deviation: float | None


def fit_compression(
    test: CompressionTest,
    *,
    diameter_mm: float | None = None,
    probe_width_mm: float = PROBE_WIDTH_MM,
) -> CompressionSample:
    """k and p of one test.

    Parameters
    ----------
    test : the readings.
    diameter_mm : of the yarn; needed if the test does not carry it.
    probe_width_mm : of the flat probe.

    Raises
    ------
    InputError
        If the diameter is missing or the test is cut off, in other units, or starts in contact.
    """
    diameter = diameter_mm if diameter_mm is not None else test.diameter_mm
    if diameter is None:
        remedy = "Give it, or a sheet 'Yarn Diameters' with a column that names the yarn."
        raise InputError(f"{test.name}, diameter_mm", "the yarn's diameter is unknown.", remedy)
    for name, value in (("diameter_mm", diameter), ("probe_width_mm", probe_width_mm)):
        check_range(f"{test.name}, {name}", value, 0.01, 50, "mm", "its size")
    depth, force, depth_core, thickness = _loading(test)
    area = probe_width_mm * diameter
    if not diameter / THICKNESS_TIMES < thickness < diameter * THICKNESS_TIMES:
        problem = f"a yarn {diameter:g} mm thick is squeezed by {thickness:.3g} mm."
        remedy = "Give depth and diameter in mm, not in µm or m."
        raise InputError(f"{test.name}, depth_mm", problem, remedy)

    def law(at: Array, k: float, p: float) -> Array:
        ratio = thickness / (depth_core - at)
        return np.asarray(area * k * thickness / p * (ratio**p - 1))

    try:
        best, covariance = scipy.optimize.curve_fit(
            law,
            depth,
            force,
            p0=(1e-3, 2.5),
            bounds=((1e-9, 0.05), (10.0, 20.0)),
            x_scale=(1e-3, 1),
        )
    except RuntimeError:
        raise InputError(
            test.name, "the force law does not fit.", "Check that the columns are depth and force."
        ) from None
    errors = np.sqrt(np.diag(covariance))
    fitted = law(depth, *best)
    return CompressionSample(
        name=test.name,
        yarn=test.yarn,
        k_n_per_mm3=float(best[0]),
        k_error_n_per_mm3=float(errors[0]),
        p=float(best[1]),
        p_error=float(errors[1]),
        thickness_mm=thickness,
        diameter_mm=float(diameter),
        rms_n=float(np.sqrt(np.mean((fitted - force) ** 2))),
        depth_mm=depth,
        force_n=force,
        fitted_n=fitted,
    )


def _loading(test: CompressionTest) -> tuple[Array, Array, float, float]:
    """Depths (mm) and forces (N) to fit, depth (mm) of the core, and that over the contact depth.

    The readings go from contact up to :data:`FIT_LIMIT_N`.

    Raises
    ------
    InputError
        If the readings are too few, or depth does not grow with force.
    """
    touch, core = _touch_and_core(test)
    depth_core = float(test.depth_mm[core])
    thickness = depth_core - float(test.depth_mm[touch])
    if thickness <= 0:
        remedy = "Depth must increase towards the yarn, in mm."
        raise InputError(f"{test.name}, depth", "does not grow while the force does.", remedy)
    depth, force = test.depth_mm[touch:core], test.force_n[touch:core]
    used = (force <= FIT_LIMIT_N) & (depth < depth_core)
    if used.sum() < MIN_READINGS:
        problem = f"has {used.sum()} readings between 1 mN and 1 N."
        raise InputError(test.name, problem, f"Record at least {MIN_READINGS}.")
    return depth[used], force[used], depth_core, thickness


def average_compression(samples: Sequence[CompressionSample]) -> list[CompressionMean]:
    """Means by yarn, in the order of their first sample."""
    means = []
    for yarn in dict.fromkeys(sample.yarn for sample in samples):
        k = np.array([s.k_n_per_mm3 for s in samples if s.yarn == yarn])
        p = np.array([s.p for s in samples if s.yarn == yarn])
        several = len(k) > 1
        means.append(
            CompressionMean(
                yarn=yarn,
                samples=len(k),
                k_n_per_mm3=float(k.mean()),
                k_standard_deviation_n_per_mm3=float(k.std(ddof=1)) if several else None,
                p=float(p.mean()),
                p_standard_deviation=float(p.std(ddof=1)) if several else None,
            )
        )
    return means


def _touch_and_core(test: CompressionTest) -> tuple[int, int]:
    """Indices of the first reading in contact for good, and of the one at the core's depth."""
    force, depth = test.force_n, test.depth_mm
    if len(force) < MIN_READINGS or len(force) != len(depth):
        raise InputError(
            test.name, f"has {len(force)} readings.", f"Record at least {MIN_READINGS}."
        )
    if not (np.all(np.isfinite(force)) and np.all(np.isfinite(depth))):
        row = int(np.argmax(~(np.isfinite(force) & np.isfinite(depth))))
        raise InputError(test.name, f"reading {row + 1} is not a number.", "Remove it.")
    peak = float(force.max())
    if peak > 100:
        raise InputError(
            f"{test.name}, force", f"reaches {peak:.4g} N.", "Give newton; the readings may be mN."
        )
    if peak < CORE_N * (1 - CORE_TOLERANCE):
        remedy = f"The test must reach {CORE_N:g} N, where the yarn's core is taken to be."
        raise InputError(test.name, f"is cut off: the force ends at {peak:.3g} N.", remedy)
    beyond = peak > CORE_N * (1 + CORE_TOLERANCE)
    core = int(np.argmax(force >= CORE_N)) if beyond else int(np.argmax(force))
    below = np.flatnonzero(force[:core] < TOUCH_N)
    if below.size == 0:
        remedy = "Record from before the probe touches the yarn (below 1 mN)."
        raise InputError(test.name, f"starts in contact, at {force[0]:.3g} N.", remedy)
    return int(below[-1]) + 1, core
