"""Random charts, yarns and starts: no unravelled shape may be returned as a result.

Each trial draws a chart, a yarn, a loop length, a branch and rough starts and relaxes it; every
tenth also takes a few steps of a stretch. The result must be finite, with the right length of yarn,
no overlapping cores and clasps as knitted. Errors of Knitcore's own classes are allowed; others
are crashes.
"""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from knitcore.base.errors import KnitcoreError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.relaxed_cell import RelaxedCell
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.paper.bezier_relax import relax_published
from knitcore.yarn.paper.bezier_stitch import Stitch
from knitcore.yarn.paper.certificate import is_clasped
from knitcore.yarn.solve.clasps import cell_is_knitted
from knitcore.yarn.solve.growth import Start
from knitcore.yarn.solve.splines import ROUGH_FROM
from knitcore.yarn.study.relax import OnSplines, RelaxedRepeat, relax
from knitcore.yarn.study.sweep import sweep

LARGEST = 3
"""Most rows and columns of a chart."""


def trial(seed: int) -> str:
    """Outcome of one random relaxation: its kind, or the fault in it."""
    rng = np.random.default_rng(seed)
    radius = float(10.0 ** rng.uniform(-1.0, 0.7))
    length = radius * float(rng.uniform(9.0, 40.0))
    bending = 0.045 * (radius / 0.74) ** 3 * float(10.0 ** rng.uniform(-1.0, 1.0))
    stiffness = float(10.0 ** rng.uniform(-4.5, -2.0))
    yarn = YarnModel(
        bending, stiffness, float(rng.uniform(1.2, 4.0)), radius,
        radius * float(rng.uniform(0.0, 0.7)),
    )  # fmt: skip
    try:
        if rng.random() < 0.1:
            fabric = list(Fabric)[rng.integers(4)]
            published = relax_published(fabric, yarn, length, starts=2)
            return _judged_published(published, Stitch(fabric, yarn), length)
        rows, columns = rng.integers(1, LARGEST + 1, 2)
        chart = StitchChart(rng.random((rows, columns)) < 0.5)
        start = Start(
            "random", course=float(rng.uniform(0.7, 1.5)), wale=float(rng.uniform(0.7, 1.5)),
            noise=float(rng.uniform(0.0, 0.4)), seed=seed,
        )  # fmt: skip
        small = rows * columns <= 4
        branch: OnSplines = "free" if rng.random() < 0.2 and small else "mirrored"
        starts = [start] if chart.stitches < ROUGH_FROM else None
        found = relax(chart, yarn, length, branch=branch, starts=starts)
        outcome = _judged(found)
        if outcome == "relaxed" and seed % 10 == 0:
            along = Direction.COURSE if rng.random() < 0.5 else Direction.WALE
            curve = sweep(found, along, 0.5, points=4)
            worst = [_judged(cell) for cell in curve.cells if isinstance(cell, RelaxedRepeat)]
            outcome = next((w for w in worst if w.startswith("WRONG")), outcome)
        return outcome
    except KnitcoreError as error:
        return type(error).__name__
    except Exception as error:  # the trials look for crashes
        return f"WRONG: crash, {error!r}"


def _judged(found: RelaxedRepeat) -> str:
    numbers = [found.energy_n_mm, found.cell_course_mm, found.cell_wale_mm, found.contact_share]
    if not np.all(np.isfinite(numbers)) or not np.all(np.isfinite(found.centre_lines)):
        return "WRONG: not finite"
    if abs(found.yarn_length_mm / float(np.mean(found.loop_lengths_mm)) - 1.0) > 2e-4:
        return "WRONG: length"
    if found.min_distance_mm <= 2.0 * found.yarn.core_radius_mm:
        return "WRONG: cores overlap"
    if not cell_is_knitted(found.cell, found.state):
        return "WRONG: unravelled"
    return "relaxed" if found.converged else "relaxed, not to the tolerance"


def _judged_published(found: RelaxedCell, stitch: Stitch, length: float) -> str:
    if not np.isfinite(found.energy_n_mm) or not np.all(np.isfinite(found.centre_lines)):
        return "WRONG: published, not finite"
    if abs(found.yarn_length_mm / length - 1.0) > 1e-4:
        return "WRONG: published, length"
    if not is_clasped(stitch, found.state):
        return "WRONG: published, unravelled"
    return "published, relaxed"


@pytest.mark.slow
def test_random_starts_never_return_unravelled_stitches() -> None:
    outcomes = Counter(trial(seed) for seed in range(5000, 5010))
    assert not [outcome for outcome in outcomes if outcome.startswith("WRONG")]
    assert outcomes["relaxed"] >= 2
