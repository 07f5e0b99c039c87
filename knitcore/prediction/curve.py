"""Strains of a chart at given stresses, with their interval."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base import showing
from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.base.kinds import as_numbers
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.materials import Material
from knitcore.materials.interval_parts import Part, shared_out
from knitcore.materials.law_uncertainty import in_a_sentence
from knitcore.prediction.predict import predict
from knitcore.prediction.prediction import Source
from knitcore.prediction.size import RelaxedSize

DEFAULT_STRESS_N_PER_MM = tuple(float(s) for s in np.linspace(0.0, 0.3, 31))
MAX_STRESS_N_PER_MM = 100.0
"""Largest stress of a curve; laws are not known beyond it."""


@dataclass(frozen=True, eq=False)
class ChartCurve(Result):
    """A stress-strain curve of a chart, transverse direction free; arrays of one length.

    Attributes
    ----------
    stress_n_per_mm : stresses, N/mm of relaxed width.
    strain : from the relaxed size.
    strain_low, strain_high : 90 % interval of the strain at each stress.
    stress_low, stress_high : the same of the stress (N/mm) at each strain; at most 10 N/mm.
    provenance : source of the curve.
    shares : of the parts in the variance of the strain's logarithm at each stress; they add up to
        1.
    interval_source : what its intervals rest on, in words.
    """

    stress_n_per_mm: Array
    strain: Array
    strain_low: Array
    strain_high: Array
    stress_low: Array
    stress_high: Array
    shares: Mapping[Part, Array]
    provenance: Source
    interval_source: str

    def __repr__(self) -> str:
        end = f"strain {self.strain[-1]:.3g} at {self.stress_n_per_mm[-1]:.3g} N/mm"
        return f"ChartCurve({len(self.strain)} points to {end}, {self.provenance})"

    def _repr_html_(self) -> str:
        ends = self.strain_low, self.strain_high
        drawn = [(str(self.provenance), self.strain, self.stress_n_per_mm, ends)]
        picture = showing.curves(drawn, "strain", "stress, N/mm")
        band = f"The band is the 90 % interval of the strain. {self.interval_source}"
        return showing.captioned(picture, band)


def increasing(stress_n_per_mm: ArrayLike) -> Array:
    """Stresses of a curve as an array, N/mm.

    Raises
    ------
    InputError
        If they do not increase from 0 to at most :data:`MAX_STRESS_N_PER_MM`.
    """
    remedy = "Give, for example, 0, 0.1, 0.2 N/mm."
    stress = np.atleast_1d(as_numbers("stress", stress_n_per_mm, remedy))
    if stress.ndim > 1 or not stress.size:
        raise InputError("stress", "is not a list of numbers.", remedy)
    if not np.all(np.isfinite(stress)) or np.any(np.diff(stress) <= 0) or np.any(stress < 0):
        problem = "must be finite, increasing and at least 0."
        raise InputError("stress", problem, remedy)
    if stress[-1] > MAX_STRESS_N_PER_MM:
        problem = f"{stress[-1]:g} N/mm is more than any fabric carries."
        remedy = f"Give at most {MAX_STRESS_N_PER_MM:g} N/mm."
        raise InputError("stress", problem, remedy, most=MAX_STRESS_N_PER_MM)
    return stress


def curve(
    chart: StitchChart | SymbolChart | str,
    material: Material | str,
    direction: Direction | str,
    stress_n_per_mm: ArrayLike = DEFAULT_STRESS_N_PER_MM,
    *,
    size: RelaxedSize | None = None,
) -> ChartCurve:
    """Stress and strain of a chart that is free to narrow, with 90 % intervals.

    Parameters
    ----------
    chart, material : as for :func:`knitcore.prediction.predict.predict`.
    direction : of the pull.
    stress_n_per_mm : increasing stresses at which strains are given, N/mm; at most 100.
    size : relaxed size of the chart's mean stitch, if known.

    Raises
    ------
    InputError
        If the stresses do not increase from 0 to at most 100 N/mm, the chart needs a pure fabric
        that the material lacks, or an argument is not of its kind.

    Examples
    --------
    >>> wide = curve("KKPP", "acrylic", "course", [0.1])
    >>> flat = curve("K", "acrylic", "course", [0.1])
    >>> bool(wide.strain[0] > flat.strain[0])
    True
    """
    stress = increasing(stress_n_per_mm)
    prediction = predict(chart, material, size)
    along = prediction.along(Direction.parse(direction))
    strain = along.strain(stress)
    return ChartCurve(
        stress,
        strain,
        *along.strain_interval(stress),
        *along.stress_interval(strain),
        shared_out(np.ones_like(stress), along.strain_parts(stress)),
        prediction.provenance,
        in_a_sentence(prediction.stretch_errors),
    )
