"""What a chart looks like: shares of known repeats in it, and what they teach.

Known are the pure fabrics, and the repeats of the packaged store. The windows of a chart (5 x 5
stitches around every stitch, :class:`knitcore.answer.repeat.Windows`) are unmixed: shares c of the
known repeats, none negative, whose windows together come nearest to the chart's,

    min |h - sum_k c_k h_k|².

A known repeat itself has the share 1; one stitch changed in n takes about 25 / n from it; large
areas of known repeats side by side have the shares of their areas, and the rest looks like nothing
known. A model's logarithms of sizes, moduli and strains are then moved by c_k times what it misses
of repeat k, and its interval is that of the known repeats as far as they reach. All this is
continuous in the windows' shares.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from knitcore.answer.answer import Along, Answer
from knitcore.answer.composite import STRESSES
from knitcore.answer.repeat import Repeat, Windows
from knitcore.chart import StitchChart
from knitcore.fabric import Direction, Fabric
from knitcore.law.response import Response, Tabled
from knitcore.materials import Interval, Material
from knitcore.yarnlibrary.store import MATERIALS, stored_charts

Array = NDArray[np.float64]
Model = Callable[[Repeat, Material], Answer]
Known = Callable[[Repeat, Material], Answer | None]

LEAST_SHARE = 0.05
"""Shares count as far as they are above this, so that chance resemblances do not."""


def corrected(
    answer: Answer, repeat: Repeat, material: Material, known: Known, model: Model
) -> Answer:
    """A model's answer, corrected by the known repeats that the chart resembles.

    Parameters
    ----------
    answer : of the model for the repeat.
    known : the answer of a repeat that is known in a material, or None.
    model : the model.
    """
    taught = [
        (share, other, found, model(other, material))
        for share, other in resemblances(repeat)
        if (found := known(other, material)) is not None
    ]
    if not taught:
        return answer
    course, wale = (
        _moved(answer.along(d), [(c, known.along(d), own.along(d)) for c, _, known, own in taught])
        for d in Direction
    )
    alike = ", ".join(
        f"{share:.0%} like {other.fabric or other.chart.text.replace(chr(10), '/')}"
        for share, other, _, _ in sorted(taught, key=lambda entry: -entry[0])[:3]
    )
    return replace(answer, course=course, wale=wale, method=f"{answer.method}; {alike}")


def resemblances(repeat: Repeat) -> list[tuple[float, Repeat]]:
    """Shares of known repeats in a chart, those above 0."""
    catalogue = _catalogue()
    wanted = catalogue.windows @ catalogue.dense(repeat.windows)
    near = np.flatnonzero(wanted > 0)
    if not len(near):
        return []
    gram = catalogue.gram[np.ix_(near, near)]
    root = np.linalg.cholesky(gram + 1e-12 * np.eye(len(near)))
    shares, _ = nnls(root.T, np.linalg.solve(root, wanted[near]))
    shares = np.maximum(shares / max(shares.sum(), 1.0) - LEAST_SHARE, 0.0) / (1 - LEAST_SHARE)
    return [(float(shares[k]), catalogue.repeats[near[k]]) for k in np.flatnonzero(shares)]


@dataclass(frozen=True, eq=False)
class _Catalogue:
    """Known repeats with their windows.

    Attributes
    ----------
    repeats : the repeats.
    codes : (windows,) all that they show, increasing.
    windows : (repeats, windows) shares.
    gram : (repeats, repeats) their products.
    """

    repeats: tuple[Repeat, ...]
    codes: NDArray[np.int64]
    windows: Array
    gram: Array

    def dense(self, windows: Windows) -> Array:
        """(windows,) shares of the catalogue's windows in others."""
        return _dense(self.codes, windows)


@cache
def _catalogue() -> _Catalogue:
    charts = [StitchChart.of_fabric(fabric, 2, 2) for fabric in Fabric]
    charts += [chart.tile(2, 2) for yarn in MATERIALS for chart in stored_charts(yarn)]
    repeats = tuple({r.chart: r for r in map(Repeat.of, charts)}.values())
    codes = np.unique(np.concatenate([repeat.windows.codes for repeat in repeats]))
    windows = np.array([_dense(codes, repeat.windows) for repeat in repeats])
    return _Catalogue(repeats, codes, windows, windows @ windows.T)


def _dense(codes: NDArray[np.int64], windows: Windows) -> Array:
    shares = np.zeros(len(codes))
    place = np.minimum(np.searchsorted(codes, windows.codes), len(codes) - 1)
    there = codes[place] == windows.codes
    shares[place[there]] = windows.shares[there]
    return shares


def _moved(answer: Along, taught: list[tuple[float, Along, Along]]) -> Along:
    """An answer moved by shares of what its model misses: (share, known, model's) of repeats."""
    rest = 1.0 - sum(share for share, _, _ in taught)

    def value(of: Callable[[Along], Array]) -> Array:
        return sum((c * (of(known) - of(own)) for c, known, own in taught), of(answer))

    def spread(of: Callable[[Along], Array]) -> Array:
        return sum((c * of(known) for c, known, _ in taught), rest * of(answer))

    middle = value(lambda a: _logs(a.response))
    stiffer = spread(lambda a: _logs(a.stiff) - _logs(a.response))
    softer = spread(lambda a: _logs(a.soft) - _logs(a.response))
    poisson, log_relaxed = value(lambda a: np.array([a.poisson, math.log(a.relaxed_mm)]))
    poisson_sd, relaxed_log_sd = spread(lambda a: np.array([a.poisson_sd, a.relaxed_log_sd]))
    response, bounds = _of_logs(middle), answer.bounds_n_per_mm
    modulus = response.modulus_n_per_mm
    return Along(
        response,
        _of_logs(middle + stiffer),
        _of_logs(middle + softer),
        poisson=float(poisson),
        poisson_sd=float(poisson_sd),
        relaxed_mm=math.exp(log_relaxed),
        relaxed_log_sd=float(relaxed_log_sd),
        bounds_n_per_mm=Interval(min(bounds.low, modulus), max(bounds.high, modulus)),
    )


def _logs(response: Response) -> Array:
    """Logarithms of the modulus, and of strains at :data:`STRESSES`."""
    logs: Array = np.log(np.append(response.modulus_n_per_mm, response.strain(STRESSES)))
    return logs


def _of_logs(logs: Array) -> Tabled:
    """Inverse of :func:`_logs`."""
    values = np.exp(logs)
    return Tabled(float(values[0]), STRESSES, values[1:])
