"""Results of the yarn level and of curling, made without solving."""

import numpy as np

from knitcore import Direction, StitchChart
from knitcore.cloth.space.curl import CurledPiece
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.relaxed_cell import Branch, RelaxedCell, Sweep
from knitcore.yarn.model.yarn_model import YarnModel

YARN = YarnModel(
    bending_modulus_n_mm2=0.045,
    contact_stiffness_n_per_mm3=1e-3,
    contact_exponent=2.6,
    radius_mm=0.7,
    core_radius_mm=0.3,
)


def relaxed_cell(repeat: str, course_mm: float = 3.0) -> RelaxedCell:
    """A cell whose courses are waves."""
    chart = StitchChart.parse(repeat)
    t = np.linspace(0, chart.columns, 20 * chart.columns + 1)
    wave = np.stack([3.0 * t, np.sin(2 * np.pi * t), 0.5 * np.cos(2 * np.pi * t)], axis=-1)
    lines = np.stack([wave + np.array([0.0, 2.0 * row, 0.0]) for row in range(chart.rows)])
    return RelaxedCell(
        branch=Branch.MIRRORED, convention=Convention.PUBLISHED, chart=chart, yarn=YARN,
        loop_lengths_mm=np.array([11.0]), cell_course_mm=course_mm, cell_wale_mm=2.0,
        energy_n_mm=0.2, bending_share=0.8, contact_share=0.2, yarn_length_mm=11.0, seconds=0.0,
        evaluations=1, converged=True, force_n=(0.0, 0.0), min_distance_mm=0.6,
        centre_lines=lines, state=np.zeros(1),
    )  # fmt: skip


def sweep() -> Sweep:
    """Three cells, evenly stretched along the course."""
    cells = tuple(relaxed_cell("K", course) for course in (3.0, 3.3, 3.6))
    return Sweep(Direction.COURSE, cells[0], cells, np.array([0.0, 0.05, 0.2]))


def curled() -> CurledPiece:
    """A piece bent about its wales."""
    chart = StitchChart.of_fabric("stockinette", rows=3, columns=4)
    x, y = np.meshgrid(3.0 * np.arange(5), 2.0 * np.arange(4))
    flat = np.stack([x, y, np.zeros_like(x)], axis=-1)
    bent = np.stack([x, y, -0.1 * (x - 6) ** 2], axis=-1)
    return CurledPiece(chart, bent, flat, 1.0, 12.0, 6.0, 3.6, -1.0, 0.0, 0.1, True, 0.0, 0.0)
