"""The stretch of a stitch by its old name, until the service calls :func:`~..sweep.sweep`."""

from __future__ import annotations

from typing import Any

from knitcore.yarnlevel.results import RelaxedCell, Sweep
from knitcore.yarnlevel.sweep import sweep


def sweep_published(
    fabric: Any, yarn: Any, loop_length_mm: float, direction: Any, max_strain: float, points: int,
    convention: Any, *, zero: RelaxedCell, max_stress_n_per_mm: float, cancel: Any,
) -> Sweep:  # fmt: skip
    """See :func:`knitcore.yarnlevel.sweep.sweep`."""
    return sweep(
        zero, direction, max_strain, points=points, max_stress_n_per_mm=max_stress_n_per_mm,
        cancel=cancel,
    )  # fmt: skip
