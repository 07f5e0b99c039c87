"""Minima among mirrored states, and the way from the others once their mirrors are dropped.

The state is laid out over the free cell (at least two stitches each way). Where the Hessian there
has a negative curvature, the solver leaves along its lowest eigenvector, to either side, and
descends.
"""

import time
from dataclasses import dataclass, replace

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, ConvergenceError, KnitcoreError, UnravelledError
from knitcore.chart.stitch_chart import StitchChart, check_stitches
from knitcore.yarn.model.cell import free_cell, plain_cell
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.relaxed_cell import Branch
from knitcore.yarn.model.tiling import tiled_state
from knitcore.yarn.solve.newton import TIGHT, Minimum, minimise
from knitcore.yarn.solve.search import RELAXED, SAME_ENERGY, UNSETTLED, lowest_of, outcome
from knitcore.yarn.solve.splines import RelaxedRepeat, check_unheld, relaxed_repeat

MAX_STITCHES = 100
"""Largest free cell."""
FOLLOWED_UP_TO = 16
"""Free cells of up to this many stitches are followed along with every relaxation or bending."""

_LITTLE = 0.1
"""First damping in cells of up to four stitches, as those of pure fabrics, relative to the usual
one: a minimum is known after one step."""


@dataclass(frozen=True, eq=False)
class Followed:
    """A mirrored state without its mirrors.

    Attributes
    ----------
    minimum : whether it is still a minimum (samples that find a slightly better place along the
        yarn may lower its energy by less than ``SAME_ENERGY``).
    state : that minimum, or the one that its instability leads to, in the free branch.
    lower : part of the mirrored state's energy by which ``state`` is lower.
    """

    minimum: bool
    state: RelaxedRepeat
    lower: float


def followed(
    energy: CellEnergy, state: Array, *, tension: Array | None = None,
    cancelled: Cancelled | None = None,
) -> tuple[Minimum, list[Minimum]]:  # fmt: skip
    """The minimum that a state of a free cell leads to, along its instability if it has one, and
    others that are as low.

    A saddle is left to both sides, and the lower minimum counts (:func:`lowest_of`).

    Parameters
    ----------
    energy : of the free cell.
    state : unknowns, such as those of a mirrored state laid out over it.
    tension : (courses,) to begin with, N.

    Raises
    ------
    ConvergenceError, UnravelledError
        If the descent finds no state of the fabric.
    """
    options = replace(TIGHT, damping=_LITTLE) if energy.cell.stitches <= 4 else TIGHT
    minima: list[Minimum] = []
    errors: list[KnitcoreError] = []
    for side in (1.0, -1.0):
        try:
            end = minimise(
                energy, state, tension=tension, options=replace(options, side=side),
                cancelled=cancelled,
            )  # fmt: skip
        except (ConvergenceError, UnravelledError) as error:
            errors.append(error)
            continue
        became = outcome(energy, end)
        if became in (RELAXED, UNSETTLED):
            minima.append(end)
        else:
            how = f"Without its symmetries the repeat does not settle: {became}."
            errors.append(ConvergenceError(how))
        if not end.saddles:
            break
    if not minima:
        raise errors[0]
    return lowest_of(minima)


def can_be_followed(relaxed: RelaxedRepeat, most_stitches: int = FOLLOWED_UP_TO) -> bool:
    """Tell whether a repeat of the mirrored branch is not held, and its free cell has at most
    ``most_stitches``."""
    stitches = free_cell(relaxed.chart, relaxed.cell.grid).stitches
    return relaxed.branch is Branch.MIRRORED and not relaxed.held and stitches <= most_stitches


def without_mirrors(
    relaxed: RelaxedRepeat, *, part: StitchChart | None = None, cancelled: Cancelled | None = None
) -> Followed:
    """Drop the symmetries of a relaxed repeat, and follow its instability if there is one.

    Parameters
    ----------
    relaxed : the repeat, free of force.
    part : several repeats to do this in, where they need not look alike; by default one, or two
        where one is a single row or column.
    cancelled : called before every step; True stops with CancelledError.

    Raises
    ------
    InputError
        If the repeat is held, or too large.
    ConvergenceError, UnravelledError
        If the descent from it finds no state of the fabric.
    CancelledError
        If ``cancelled`` says so.
    """
    grid = relaxed.cell.grid
    cell = free_cell(relaxed.chart, grid) if part is None else plain_cell(part, grid)
    check_unheld(relaxed)
    check_stitches(cell.stitches, MAX_STITCHES, "its cell")
    lengths = np.resize(relaxed.loop_lengths_mm, cell.rows)
    energy = CellEnergy(cell, relaxed.yarn, lengths, relaxed.convention)
    clock = time.process_time()
    minimum, others = followed(
        energy, tiled_state(relaxed.cell, relaxed.state, cell),
        tension=np.resize(relaxed.tension_n, cell.rows), cancelled=cancelled,
    )  # fmt: skip
    shown = relaxed_repeat(
        StitchChart(cell.purl), energy, Branch.FREE, minimum,
        seconds=time.process_time() - clock, evaluations=minimum.evaluations, others=others,
    )  # fmt: skip
    lower = 1.0 - shown.energy_n_mm / relaxed.energy_n_mm
    state = replace(shown, minimum=minimum.stable, notes=(*relaxed.notes, *shown.notes))
    return Followed(lower < SAME_ENERGY and minimum.stable, state, lower)


def lowest(relaxed: RelaxedRepeat, *, cancelled: Cancelled | None = None) -> RelaxedRepeat:
    """The minimum that a relaxed repeat is, or leads to, without the symmetries of its chart.

    Its ``mirrored`` is the state that led to it. A repeat that cannot be followed is returned
    unchanged; one that leads to no state of the fabric gets a note.
    """
    if relaxed.minimum or not can_be_followed(relaxed):
        return relaxed
    try:
        followed_state = without_mirrors(relaxed, cancelled=cancelled)
    except (ConvergenceError, UnravelledError):
        lost = "Without its mirror symmetries no shape was found."
        return replace(relaxed, notes=(*relaxed.notes, lost))
    seconds = relaxed.seconds + followed_state.state.seconds
    if followed_state.lower < SAME_ENERGY:
        return replace(relaxed, minimum=followed_state.minimum, seconds=seconds)
    return replace(
        followed_state.state, mirrored=relaxed, starts=relaxed.starts, seconds=seconds,
        evaluations=relaxed.evaluations + followed_state.state.evaluations,
    )  # fmt: skip
