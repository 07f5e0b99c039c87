"""From the first shape to a relaxed one: the yarn's hard core grows from the inside.

The first shape brings strands nearer than two hard cores. Its yarn begins with the thickest core
that fits, at a fixed size of the cell and with a stiffened shell, so that the strands push each
other apart; the core then grows as far as the distances allow until it is the real one.
"""

from dataclasses import dataclass, replace

import numpy as np

from knitcore.base.arrays import Array, scattered
from knitcore.base.errors import Cancelled, ConvergenceError
from knitcore.yarn.model.cell import YarnCell
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import SPACING_PER_BENDING, CellEnergy
from knitcore.yarn.model.start_shape import COURSE_PER_LOOP, WALE_PER_LOOP, start_state
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.newton import COURSE, SPARSE_FROM, WALE, Minimum, Options, minimise
from knitcore.yarn.solve.topology import clearance_at

FIRST_OPENING = 0.2
"""Opening of the nearest contact (in shells) with the first core: enough room for smooth steps."""
OPENING = 0.02
"""Opening of the nearest contact (in shells) with later cores."""
_STIFFENED = 20.0
"""Factor on the contact stiffness while the core grows."""
_STAGES = 40
STAGE = Options(tolerance=1e-3, iterations=12)
_SHORT_STAGE = Options(tolerance=1e-3, slack=1e-2, iterations=3)
"""Settings of a stage in large cells: a few steps part the strands, and more would only relax the
shape under a stiffened shell, which is not the final one."""
START_HEIGHT = 0.8
"""Height of the first shape's crossings above the middle plane, in radii."""


@dataclass(frozen=True)
class Start:
    """One starting shape.

    Parameters
    ----------
    name : its name in reports.
    course, wale : size of the first cell relative to the usual one.
    noise : standard deviation of random displacements of the control points, in radii.
    seed : of these displacements.
    """

    name: str
    course: float = 1.0
    wale: float = 1.0
    noise: float = 0.0
    seed: int = 0


def grow(
    cell: YarnCell,
    yarn: YarnModel,
    loop_length_mm: Array,
    convention: Convention,
    start: Start,
    *,
    options: Options,
    flat: bool = False,
    spacing_per_bending: float = SPACING_PER_BENDING,
    cancelled: Cancelled | None = None,
) -> Minimum:
    """Relax a cell from a start.

    Raises
    ------
    ConvergenceError
        If the yarn does not fit into its loop, so that the core cannot grow to its size.
    UnravelledError, CancelledError
        See :func:`~knitcore.yarn.solve.newton.minimise`.
    """
    radius = yarn.radius_mm
    state = start_state(
        cell,
        float(np.mean(loop_length_mm)),
        START_HEIGHT * radius,
        course_per_loop=start.course * COURSE_PER_LOOP,
        wale_per_loop=start.wale * WALE_PER_LOOP,
    )
    state = shaken(cell, state, start.noise * radius, start.seed)
    energy = CellEnergy(cell, yarn, loop_length_mm, convention, flat, (), spacing_per_bending)
    core = core_that_fits(yarn, clearance_at(energy, state).min_distance_mm, FIRST_OPENING)
    tension: Array | None = None
    settings = STAGE if cell.stitches < SPARSE_FROM else _SHORT_STAGE
    steps = evaluations = 0
    for stage in range(_STAGES):
        minimum = minimise(
            replace(energy, yarn=with_stiff_shell(replace(yarn, core_radius_mm=core))),
            state,
            tension=tension,
            fixed=(COURSE, WALE) if stage == 0 else (),
            options=settings,
            cancelled=cancelled,
        )
        state, tension = minimum.state, minimum.tension
        steps += minimum.steps
        evaluations += minimum.evaluations
        grown = core_that_fits(yarn, minimum.min_distance_mm, OPENING)
        stuck = grown <= core and minimum.converged and stage > 0
        if stuck or grown >= yarn.core_radius_mm:
            break
        core = max(core, grown)
    # where bending presses weak shells together there is no more room around a grown core
    short = grown < yarn.core_radius_mm
    if short and (core < yarn.core_radius_mm or minimum.min_distance_mm <= 2.0 * core):
        raise ConvergenceError(does_not_fit(yarn, core))
    minimum = minimise(energy, state, tension=tension, options=options, cancelled=cancelled)
    steps, evaluations = steps + minimum.steps, evaluations + minimum.evaluations
    return replace(minimum, steps=steps, evaluations=evaluations)


def does_not_fit(yarn: YarnModel, core_mm: float) -> str:
    """The message for yarn of which only a part of the core fits."""
    return (
        f"The yarn does not fit into its loop: of a core radius of {yarn.core_radius_mm:g} mm "
        f"only {core_mm:.3g} mm fits. Give a longer loop or a thinner core."
    )


def with_stiff_shell(yarn: YarnModel) -> YarnModel:
    """The yarn with a shell so stiff that its strands push each other apart."""
    return replace(yarn, contact_stiffness_n_per_mm3=_STIFFENED * yarn.contact_stiffness_n_per_mm3)


def shaken(cell: YarnCell, state: Array, noise_mm: float, seed: int) -> Array:
    """The state with its control points displaced at random, by ``noise_mm`` in the mean square."""
    if noise_mm == 0.0:
        return state
    return np.append(state[:-2] + scattered((len(state) - 2,), noise_mm, seed), state[-2:])


def core_that_fits(yarn: YarnModel, distance_mm: float, opening: float) -> float:
    """Core radius at which the nearest strands are open by a part of the shell."""
    core = (distance_mm - 2.0 * opening * yarn.radius_mm) / (2.0 - 2.0 * opening)
    return float(min(max(core, 0.0), yarn.core_radius_mm))
