"""Sweeps made of numbers, for what only reads them."""

import numpy as np

from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.relaxed_cell import Branch, RelaxedCell, Sweep
from knitcore.yarn.model.yarn_model import YarnModel


def cell(course_mm=3.0, wale_mm=2.0, energy=0.2, contact_share=0.2, height=1.0):
    line = np.array([[[0.0, 0.0, 0.0], [1.0, 1.0, height], [2.0, 0.0, 0.0]]])
    return RelaxedCell(
        branch=Branch.PUBLISHED,
        convention=Convention.PUBLISHED,
        chart=StitchChart.parse("K"),
        yarn=YarnModel(0.045, 6e-4, 2.4, 0.74, 0.1),
        loop_lengths_mm=np.array([12.0]),
        cell_course_mm=course_mm,
        cell_wale_mm=wale_mm,
        energy_n_mm=energy,
        bending_share=1.0 - contact_share,
        contact_share=contact_share,
        yarn_length_mm=12.0,
        seconds=0.5,
        evaluations=100,
        converged=True,
        force_n=(0.0, 0.0),
        min_distance_mm=0.5,
        centre_lines=line,
        state=np.zeros(30),
    )


def sweep(direction, strain, transverse, stress, contact_share=None, jumps=(), heights=None):
    rest = cell()
    shares = np.full(len(strain), 0.2) if contact_share is None else contact_share
    heights = np.ones(len(strain)) if heights is None else heights
    cells = []
    for along, across, share, height in zip(strain, transverse, shares, heights, strict=True):
        course, wale = (along, across) if direction is Direction.COURSE else (across, along)
        cells.append(cell(3.0 * (1 + course), 2.0 * (1 + wale), 0.2, share, height))
    return Sweep(direction, rest, tuple(cells), np.asarray(stress, dtype=float), jumps)
