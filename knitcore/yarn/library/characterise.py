"""All yarn-level results for one repeat: the relaxed state, both stretches, and the fitted law.

One call is one task of a batch (:mod:`knitcore.base.batch`): its input can be pickled and its
result is JSON, so that it runs the same in this process, in another, or on a cluster.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import KnitcoreError
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.yarn.library.fingerprint import content_key
from knitcore.yarn.library.law_of_stretches import MAX_STRESS_N_PER_MM, fit_sweeps
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.relaxed_cell import RelaxedCell, Sweep
from knitcore.yarn.model.tiling import tiled_controls
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.study.relax import Branch, RelaxedRepeat, relax
from knitcore.yarn.study.sweep import sweep

Document = dict[str, Any]

_FAR_STRAIN = {Direction.COURSE: 3.0, Direction.WALE: 2.0}
"""Largest strain of a stretch, unless its stress ends it before."""
_POINTS = 36
_FEW_IN_RANGE = 12
"""A stretch with fewer points below the fitted stress is repeated in smaller steps."""
_BEYOND = 1.1
"""Largest stress of a stretch over the fitted stress."""


@dataclass(frozen=True)
class RepeatTask:
    """A repeat to relax and to stretch both ways.

    Parameters
    ----------
    chart : rows from the top, separated by ``/``.
    yarn, loop_length_mm : the yarn, and mm of it per stitch.
    branch : which shapes are admitted.
    convention : factors of the energy.
    max_stress_n_per_mm : the law is fitted from 0 to this.
    """

    chart: str
    yarn: YarnModel
    loop_length_mm: float
    branch: Branch = Branch.MIRRORED
    convention: Convention = Convention.PUBLISHED
    max_stress_n_per_mm: float = MAX_STRESS_N_PER_MM

    @property
    def key(self) -> str:
        """A name made of everything that decides the result."""
        return content_key(asdict(self))


def characterise_repeat(task: RepeatTask) -> Document:
    """Relax a repeat, stretch it along the course and the wale, and fit its law.

    Returns
    -------
    A JSON document. Where the repeat does not relax it holds ``failure``, the reason, alone: the
    same inputs would fail again. Otherwise sizes (mm), energy (N·mm) and shares of a mean stitch,
    ``curves`` by direction, ``law`` with ``law_range`` (or None, and ``law_failure``), and
    ``controls``, the control points of the repeat without the drift (mm; None in the published
    branch, whose curves are not splines).
    """
    chart = StitchChart.parse(task.chart)
    try:
        rest = relax(
            chart, task.yarn, task.loop_length_mm, branch=task.branch, convention=task.convention
        )
    except KnitcoreError as error:
        return {"failure": str(error)}
    stretches: dict[Direction, Sweep] = {}
    law: dict[str, float] | None = None
    law_range: dict[str, float] | None = None
    reason = ""
    try:
        for direction in Direction:
            stretches[direction] = _stretch(rest, direction, task.max_stress_n_per_mm)
        fit = fit_sweeps(
            stretches[Direction.COURSE], stretches[Direction.WALE], task.max_stress_n_per_mm
        )
        fields = asdict(fit)
        law = {name: _round(value) for name, value in fields.pop("law").items()}
        law_range = {name: _round(value) for name, value in fields.items()}
    except KnitcoreError as error:
        reason = str(error)
    return {
        "cell_course_mm": _round(rest.cell_course_mm),
        "cell_wale_mm": _round(rest.cell_wale_mm),
        "energy_n_mm": _round(rest.energy_n_mm),
        "bending_share": _round(rest.bending_share),
        "contact_share": _round(rest.contact_share),
        "converged": rest.converged,
        "notes": list(rest.notes),
        "curves": {str(d): _curve(stretch) for d, stretch in stretches.items()},
        "law": law,
        "law_range": law_range,
        "law_failure": reason,
        "controls": _controls(rest) if isinstance(rest, RelaxedRepeat) else None,
    }


def law_of(document: Document) -> ConstitutiveLaw | None:
    """The fitted law of a characterised repeat, None where there is none."""
    law = document.get("law")
    return None if law is None else ConstitutiveLaw(**law)


def _controls(rest: RelaxedRepeat) -> list[list[list[float]]]:
    points = tiled_controls(rest.cell, rest.state, rest.chart.rows, rest.chart.columns)
    rounded: list[list[list[float]]] = np.round(points, 5).tolist()
    return rounded


def _stretch(rest: RelaxedCell, direction: Direction, max_stress: float) -> Sweep:
    end = _BEYOND * max_stress
    far, points = _FAR_STRAIN[direction], _POINTS
    curve = sweep(rest, direction, far, points=points, max_stress_n_per_mm=end, back=False)
    if np.count_nonzero(curve.stress_n_per_mm <= max_stress) < _FEW_IN_RANGE:
        # a stiff direction leaves the range within a few of these steps
        far = float(curve.strain[-1]) if len(curve.strain) > 1 else far / points
        curve = sweep(rest, direction, far, points=points, max_stress_n_per_mm=end, back=False)
    return curve


def _curve(stretch: Sweep) -> Document:
    return {
        "strain": _rounded(stretch.strain),
        "transverse_strain": _rounded(stretch.transverse_strain),
        "stress_n_per_mm": _rounded(stretch.stress_n_per_mm),
        "bending_share": _rounded(stretch.bending_share),
        "contact_share": _rounded(stretch.contact_share),
        "contact_overtakes_at_strain": stretch.contact_overtakes_at_strain,
        "jumps": list(stretch.jumps),
        "notes": [note for note in stretch.notes if note not in stretch.zero.notes],
    }


def _round(value: float) -> float:
    """The document to seven significant digits, the accuracy of the solver's tolerance."""
    return float(f"{value:.7g}")


def _rounded(values: Array) -> list[float]:
    return [_round(float(value)) for value in values]
