"""Results of the yarn level and of curling, made without solving."""

from collections.abc import Sequence

import numpy as np

from knitcore import Direction, StitchChart
from knitcore.base.arrays import Array
from knitcore.cloth.space.curl import CurledPiece
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.relaxed_cell import Branch, RelaxedCell, Sweep
from knitcore.yarn.model.yarn_model import YarnModel


def relaxed_cell(
    repeat: str, course_mm: float = 3.0, wale_mm: float = 2.0, contact_share: float = 0.2
) -> RelaxedCell:
    """A cell whose courses are waves."""
    chart = StitchChart.parse(repeat)
    t = np.linspace(0, chart.columns, 20 * chart.columns + 1)
    wave = np.stack([3.0 * t, np.sin(2 * np.pi * t), 0.5 * np.cos(2 * np.pi * t)], axis=-1)
    lines = np.stack([wave + np.array([0.0, 2.0 * row, 0.0]) for row in range(chart.rows)])
    return RelaxedCell(
        branch=Branch.MIRRORED, convention=Convention.PUBLISHED, chart=chart,
        yarn=YarnModel(0.045, 1e-3, 2.6, 0.7, 0.3), loop_lengths_mm=np.array([11.0]),
        cell_course_mm=course_mm, cell_wale_mm=wale_mm, energy_n_mm=0.2,
        bending_share=1.0 - contact_share, contact_share=contact_share, yarn_length_mm=11.0,
        seconds=0.5, evaluations=1, converged=True, force_n=(0.0, 0.0), min_distance_mm=0.6,
        centre_lines=lines, state=np.zeros(1),
    )  # fmt: skip


def sweep(
    direction: Direction = Direction.COURSE,
    strain: Sequence[float] | Array = (0.0, 0.1, 0.2),
    transverse: Sequence[float] | Array = (0.0, 0.0, 0.0),
    stress: Sequence[float] | Array = (0.0, 0.05, 0.2),
    contact_share: Sequence[float] | None = None,
) -> Sweep:
    """Stretched cells of these strains and stresses."""
    cells = []
    shares = contact_share or [0.2] * len(strain)
    for along, across, share in zip(strain, transverse, shares, strict=True):
        course, wale = direction.of((along, across), (across, along))
        cells.append(relaxed_cell("K", 3.0 * (1 + course), 2.0 * (1 + wale), share))
    return Sweep(direction, relaxed_cell("K"), tuple(cells), np.asarray(stress, dtype=float))


def curled() -> CurledPiece:
    """A piece bent about its wales."""
    chart = StitchChart.of_fabric("stockinette", rows=3, columns=4)
    x, y = np.meshgrid(3.0 * np.arange(5), 2.0 * np.arange(4))
    flat = np.stack([x, y, np.zeros_like(x)], axis=-1)
    bent = np.stack([x, y, -0.1 * (x - 6) ** 2], axis=-1)
    return CurledPiece(chart, bent, flat, 1.0, 12.0, 6.0, 3.6, -1.0, 0.0, 0.1, True, 0.0, 0.0)
