"""From the first shape to the prescribed yarn: the rows are drawn tight under a pull.

The first shape has far more yarn than the cloth. As on a machine, the cloth hangs from its needles
under a take-down while the yarn of every row is drawn in by small parts; steps that lock are taken
back and made smaller, and where that does not help the cloth is pulled more gently. Where a cable
locks all the same, the row below it gets more yarn, as knitters loosen that row. Every step of the
yarn is certified, so the crossings stay those of the first shape. That may take a fine grid; tight
yarn is smooth, so the usual one takes over as soon as it can.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, ConvergenceError, UnravelledError
from knitcore.chart.stitch_graph import StitchGraph
from knitcore.yarn.loops.drawn_yarn import DrawableYarn, DrawnYarn
from knitcore.yarn.loops.stitch_energy import StitchEnergy
from knitcore.yarn.model.cell import YarnCell
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import STIFF_SPACING_PER_BENDING
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.tiling import centre_lines, refined_state
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.newton import Minimum, Options, minimise
from knitcore.yarn.solve.topology import clearance_at

_PULLS_N_PER_MM = 0.01, 0.003
"""Take-down along the wale; the next is tried where the yarn locks."""
ACROSS = 1.0
"""Pull along the course over that along the wale: the rollers keep the cloth spread."""
_COURSE_PER_LOOP, _WALE_PER_LOOP = 0.27, 0.19
"""Size of a stitch over its loop length, by which pulls per mm become forces."""
_SCALES = tuple(0.45 * 1.2**k for k in range(8))
"""Widths of a drawn wale over the loop length: the least that leaves room for the cores."""
_LAYERS_RADII = 1.8, 2.4
"""Distances of layers in the first shape, in radii; the next is tried where the cores lack room."""
_ROOM = 1.1
"""Least distance of strands in the first shape, in diameters of the core."""
_LAST_STEP, _LEAST_STEP = 0.08, 0.015
"""Parts that are not halved towards the end, and the least that is tried after a lock."""
_LOOSER, _LOOSEST = 1.1, 3.0
"""Yarn of loops that cross, over what they had when they locked, and the most that is tried."""
_OVERLONG = 0.02
"""Excess of a row's yarn, in loop lengths, with which the last stage still counts."""
_STAGE = Options(tolerance=1e-2, slack=1e-2, iterations=5, leaves_saddles=False, rounded=True)
GRID = SplineGrid(16, 3)
"""Resolution of the shape, as soon as it is fine enough."""
_UNEVEN = 2.0
"""Samples in a diameter of the core; certified steps need one and a half, evenly spread."""
_MOST = 10
"""Most samples per control point."""
_COMPARED = 192
"""Samples of a stitch by which two resolutions are compared."""


def room_for_yarn(graph: StitchGraph, yarn: YarnModel, loop_length_mm: float) -> DrawnYarn:
    """Draw the first shape so large that the yarn's core has room.

    Raises
    ------
    ConvergenceError
        If it cannot be drawn.
    """
    drawing = DrawableYarn(graph)
    for layer, scale in product(_LAYERS_RADII, _SCALES):
        size = scale * loop_length_mm
        drawn = drawing(size, size, layer * yarn.radius_mm)
        energy = StitchEnergy(drawn.cell, yarn, drawn.loop_lengths_mm, Convention.PUBLISHED)
        if clearance_at(energy, drawn.state).min_distance_mm > 2.0 * _ROOM * yarn.core_radius_mm:
            return drawn
    raise ConvergenceError("The yarn is too thick for this chart. Give a thinner core.")


@dataclass(frozen=True, eq=False)
class TakeDown:
    """The yarn of a repeat being drawn in.

    Parameters
    ----------
    yarn, convention : of the energy.
    goal_mm : (rows,) mean loop length of each row in the cloth.
    crossing_mm : (rows,) yarn of the loops that cross others, mm per site, which grows where it
        locks; None where all keep their lengths.
    cancelled : called before every step; True stops with CancelledError.
    longest : longest part of the way at a time, in logarithms of the length.
    """

    yarn: YarnModel
    convention: Convention
    goal_mm: Array
    crossing_mm: Array | None = None
    cancelled: Cancelled | None = None
    longest: float = 0.25

    def __call__(self, drawn: DrawnYarn) -> tuple[StitchEnergy, Minimum]:
        """The state with the prescribed yarn, under the take-down.

        Raises
        ------
        ConvergenceError
            If the yarn locks on the way whatever the pull.
        """
        for pull in _PULLS_N_PER_MM:
            try:
                return self._drawn_in(drawn, pull)
            except (ConvergenceError, UnravelledError):
                continue
        raise ConvergenceError(
            "The yarn locks while it is drawn in: a crossing has too little yarn. Give its loops "
            "more yarn (crossing), longer loops, or a plain row between the crossings."
        )

    def energy(self, cell: YarnCell, lengths_mm: Array, pull_n_per_mm: float) -> StitchEnergy:
        """The energy under a take-down; long loops are soft, so that it pulls them less."""
        loop_mm = float(self.goal_mm.mean())
        larger = float(lengths_mm.mean()) / loop_mm
        samples = _UNEVEN * float(lengths_mm.max()) / (2.0 * self.yarn.core_radius_mm)
        per_span = int(np.clip(np.ceil(samples / cell.grid.controls), GRID.per_span, _MOST))
        sampled = replace(cell, grid=SplineGrid(cell.grid.controls, per_span))
        return StitchEnergy(
            sampled, self.yarn, lengths_mm, self.convention,
            spacing_per_bending=STIFF_SPACING_PER_BENDING,
            pull_n=pulls_n(cell.stitches, loop_mm, pull_n_per_mm / larger**2),
        )  # fmt: skip

    def _drawn_in(self, drawn: DrawnYarn, pull: float) -> tuple[StitchEnergy, Minimum]:
        begin, goal, looser = drawn.loop_lengths_mm, self.goal_mm, 1.0
        whole = float(np.log(begin / goal).max())
        energy, last, done = self.begun(drawn, pull)
        most = self.longest
        while done < 1.0:
            left = whole * (1.0 - done)
            step = min(left, most, max(0.5 * left, _LAST_STEP))
            part = 1.0 if step == left else done + step / whole
            nearer = self.energy(energy.cell, between(begin, goal, part), pull)
            try:
                minimum = self.stage(nearer, last.state, last.tension)
                if part == 1.0:
                    check_length(nearer, minimum)
            except (ConvergenceError, UnravelledError):
                most = 0.5 * step
                if most < _LEAST_STEP:
                    looser *= _LOOSER
                    if self.crossing_mm is None or pull > _PULLS_N_PER_MM[-1] or looser > _LOOSEST:
                        raise
                    begin, done, most = energy.loop_length_mm, 0.0, _LAST_STEP
                    goal = self.goal_mm + (looser - 1.0) * self.crossing_mm
                    whole = float(np.abs(np.log(begin / goal)).max())
                continue
            energy, last = self._coarser(nearer, minimum, pull)
            done = part
            self.reached(energy, last, done)
            most = min(1.3 * most, self.longest)
        return energy, last

    def begun(self, drawn: DrawnYarn, pull: float) -> tuple[StitchEnergy, Minimum, float]:
        """The first shape under its pull, and the part of the way that is done."""
        energy = self.energy(drawn.cell, drawn.loop_lengths_mm, pull)
        return energy, self.stage(energy, drawn.state, None), 0.0

    def reached(self, energy: StitchEnergy, minimum: Minimum, done: float) -> None:
        """Take note of a part of the way that is done."""

    def _coarser(
        self, energy: StitchEnergy, minimum: Minimum, pull: float
    ) -> tuple[StitchEnergy, Minimum]:
        """The state on the usual grid, if no strand moves by half of what keeps it from another."""
        cell, state = energy.cell, minimum.state
        if cell.grid.controls <= GRID.controls:
            return energy, minimum
        coarser = self.energy(replace(cell, grid=GRID), energy.loop_length_mm, pull)
        coarse = refined_state(cell, state, coarser.cell)
        moved = np.linalg.norm(_compared(cell, state) - _compared(coarser.cell, coarse), axis=2)
        apart = clearance_at(coarser, coarse).min_distance_mm
        if moved.max() > 0.45 * minimum.min_distance_mm or apart <= 2.0 * self.yarn.core_radius_mm:
            return energy, minimum
        return coarser, replace(minimum, state=coarse)

    def stage(self, energy: StitchEnergy, state: Array, tension: Array | None) -> Minimum:
        """The state with the lengths of an energy, near enough to go on from.

        Raises
        ------
        ConvergenceError, UnravelledError
            If the yarn locks.
        """
        minimum = minimise(energy, state, tension=tension, options=_STAGE, cancelled=self.cancelled)
        if minimum.min_distance_mm <= 2.0 * energy.yarn.core_radius_mm:
            raise ConvergenceError("cores overlap")
        return minimum


def between(begin_mm: Array, goal_mm: Array, part: float) -> Array:
    """(rows,) loop lengths where a part of the way is done."""
    return np.asarray(begin_mm ** (1.0 - part) * goal_mm**part)


def _compared(cell: YarnCell, state: Array) -> Array:
    """Centre lines at places that do not depend on the resolution."""
    grid = cell.grid
    samples = _COMPARED // grid.controls
    dense = replace(cell, grid=SplineGrid(grid.controls, samples))
    return centre_lines(dense, state, cell.rows, cell.wales)


def pulls_n(stitches: int, loop_mm: float, n_per_mm: float) -> tuple[float, float]:
    """Forces of a take-down along the course and the wale, N times the stitches."""
    force = n_per_mm * stitches * loop_mm
    return ACROSS * _WALE_PER_LOOP * force, _COURSE_PER_LOOP * force


def check_length(energy: StitchEnergy, minimum: Minimum) -> None:
    """Refuse a state whose yarn has not its length.

    Raises
    ------
    ConvergenceError
    """
    excess = np.abs(minimum.terms.excess_mm).max() / energy.cell.wales
    if excess > _OVERLONG * energy.mean_loop_mm:
        raise ConvergenceError("too little yarn")
