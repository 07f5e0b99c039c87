"""The flat composite: a chart as quarter cells of the four pure fabrics, held flat.

Its modulus is that of the periodic quarter grid (:mod:`knitcore.mechanics.homogenisation`). Under
larger stress the cells count as lines along the pull: in a line the phases are in series at one
force, and all lines are strained alike; the stresses are scaled so that the first slope is the
homogenised modulus. Beside the full nonlinear solution of the periodic cell
(:mod:`knitcore.mechanics.repeat_curve`), which takes some hundred times longer, the strains of
repeats up to 4x4 are within 9 % between 0.01 and 0.2 N/mm, 2-3 % in the mean.

It is right for stretched cloth. At rest, repeats with runs of like stitches fold and draw in.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from knitcore.answer.answer import Along, Answer, Source
from knitcore.answer.measured import CURL
from knitcore.answer.relaxed import RelaxedSize, SizeSource
from knitcore.answer.repeat import Repeat
from knitcore.fabric import PHASES, Direction, Fabric
from knitcore.law.response import Tabled
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import Material
from knitcore.materials.uncertainty import MODEL_POISSON_SD, Z_SCORE
from knitcore.mechanics.homogenisation import EffectiveSheet, PhaseGrid, homogenise, phase_grid

Array = NDArray[np.float64]

MODEL_LOG_SD = {"flat": math.log(3.5) / Z_SCORE, "patchwork": 0.05}
"""The composite's own error: where fabrics are mixed stitch by stitch (the strain of 90 % of the
stored 2-D repeats is within that factor at 0.05 N/mm, benchmarks/stored_repeats.py), and inside
large regions of pure fabrics."""

FOLDS_AT_REST = (
    "Composite of flat quarter cells: right for the stretched cloth (above about 0.05 N/mm). At "
    "rest a repeat with runs of like stitches folds and draws in; relax this repeat on the yarn "
    "level, or give your own gauge."
)

STRESSES: Array = np.array(
    [0.001, 0.002, 0.005, 0.01, 0.02, 0.03, 0.05, 0.075, 0.1, 0.15, 0.2, 0.3, 0.5, 1.0, 2.0]
)
"""Stresses (N/mm) at which composites are computed; smooth between them."""

_FINE: Array = np.concatenate([[0.0], np.geomspace(1e-4, 8.0, 240)])
_LOOP_SPREAD = 1.15


def composite(repeat: Repeat, material: Material) -> Answer:
    """What the flat composite of a repeat does.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the repeat needs.
    """
    sheet, grid = homogenise(repeat.chart, material), phase_grid(repeat.chart, material)
    size = RelaxedSize(
        2 * float(grid.width_mm.mean()), 2 * float(grid.height_mm.mean()), SizeSource.COMPOSITE
    )
    course, wale = (_along(sheet, grid, repeat, material, d, size) for d in Direction)
    return Answer(
        course,
        wale,
        sheet.shear_modulus_n_per_mm,
        Source.COMPOSITE,
        f"periodic homogenisation of the quarter cells of {repeat.chart.columns} x "
        f"{repeat.chart.rows} stitches",
        str(size.source),
        (FOLDS_AT_REST, *mixture_notes(repeat, material)),
    )


def _along(
    sheet: EffectiveSheet,
    grid: PhaseGrid,
    repeat: Repeat,
    material: Material,
    direction: Direction,
    size: RelaxedSize,
) -> Along:
    modulus = sheet.modulus_n_per_mm(direction)
    response = Tabled(modulus, STRESSES, _strains(grid, material, direction, modulus))
    laws = phase_log_sd(sheet.energy_shares[direction.axis], material, direction)
    model = MODEL_LOG_SD["flat"] if repeat.fabric is None else 0.0
    course = direction is Direction.COURSE
    return Along.of_response(
        response,
        math.hypot(model, laws),
        (sheet.poisson_yx if course else sheet.poisson_xy, mixture_poisson_sd(material, direction)),
        (size.extent_mm(direction), size.log_sd),
        sheet.bounds_n_per_mm(direction),
    )


def _strains(grid: PhaseGrid, material: Material, direction: Direction, modulus: float) -> Array:
    """Strains at :data:`STRESSES`."""
    course = direction is Direction.COURSE
    lines = grid.phases if course else grid.phases.T
    along, across = (grid.width_mm, grid.height_mm) if course else (grid.height_mm, grid.width_mm)
    in_line = np.stack([(lines == phase) @ along for phase in range(4)], axis=1) / along.sum()
    in_line, same = np.unique(in_line.round(12), axis=0, return_inverse=True)
    share = np.bincount(same.ravel(), weights=across) / across.sum()
    phases = np.zeros((4, len(_FINE)))
    for phase in np.unique(grid.phases):
        phases[phase] = free_strains_at_stress(material.law(PHASES[phase]), direction, _FINE)
    strains = in_line @ phases
    common = np.linspace(0.0, 1.0, 600) ** 2 * strains[:, -1].min()
    stress = np.zeros_like(common)
    for weight, line in zip(share, strains, strict=True):
        stress += weight * np.interp(common, line, _FINE)
    first = float(stress[1] / common[1])
    found: Array = np.interp(STRESSES, stress * (modulus / first), common)
    return found


def phase_log_sd(shares: Array, material: Material, direction: Direction) -> float:
    """Uncertainty of a modulus by that of its phases' laws.

    Delta method: d ln Y / d ln C of a phase is its share of the energy.
    """
    return math.hypot(
        *(
            float(shares[phase]) * material.record(PHASES[phase]).uncertainty.log_modulus(direction)
            for phase in np.flatnonzero(shares > 0)
        )
    )


def mixture_poisson_sd(material: Material, direction: Direction) -> float:
    """Standard deviation of a composite's contraction across a pull."""
    spread = [record.uncertainty for record in material.fabrics.values()]
    course = direction is Direction.COURSE
    return math.hypot(
        MODEL_POISSON_SD, max(s.poisson_yx if course else s.poisson_xy for s in spread)
    )


def mixture_notes(repeat: Repeat, material: Material) -> tuple[str, ...]:
    """What a user should know of a chart that mixes pure fabrics."""
    found = []
    if repeat.shares[Fabric.STOCKINETTE.phase] > 0.5:
        found.append(CURL)
    lengths = {fabric: material.record(fabric).loop_length_mm for fabric in repeat.present}
    known = {fabric: length for fabric, length in lengths.items() if length is not None}
    if known and max(known.values()) > _LOOP_SPREAD * min(known.values()):
        listed = ", ".join(f"{fabric} {length:g} mm" for fabric, length in known.items())
        found.append(
            f"The fabrics of this material were knitted at different loop lengths ({listed}); a "
            "mixed chart lies between them."
        )
    return (*found, material.note) if material.note else tuple(found)
