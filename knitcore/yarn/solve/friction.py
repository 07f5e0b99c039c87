"""Dry friction between yarns, step by step along a history of loading.

Every pair of samples that press on each other holds a friction force of two components, along
either strand. As the pair slides, this force grows like that of a spring until it reaches its
limit, the coefficient of friction times the normal force, after a small elastic slip (an
elastic-plastic return mapping for Coulomb friction: Wriggers, Computational Contact Mechanics, 2nd
ed., section 5.2). The normal forces are given in a step, so its equilibrium is the minimum of a
potential: first those at its beginning, then those of the end so found. The model is independent of
rate. Rolling of one strand over the other is free.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_range
from knitcore.base.errors import Cancelled
from knitcore.chart.stitch_chart import check_stitches
from knitcore.yarn.kernels.friction_kernels import Sliding, normal_forces, slides
from knitcore.yarn.kernels.structures import Pairs
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.solve.newton import Minimum, Options, minimise
from knitcore.yarn.solve.search import check_reached
from knitcore.yarn.solve.splines import RelaxedRepeat, check_unheld

MAX_COEFFICIENT = 2.0
MAX_STITCHES = 36
"""Largest cell; the unknowns fill a dense matrix."""
SLIP_RADII = 0.02
"""Elastic slip of a contact, in radii of the yarn."""
_NORMAL_FORCES = 2
"""Times that a step is solved, each with the normal forces that the last one found."""
_LEAST = 1e-12
"""Limit, N, and stiffness, N/mm, of a pair without pressure."""
_IMAGES = 64
"""Repeats on either side whose samples get numbers of their own; farther ones cannot touch."""


@dataclass(frozen=True, eq=False)
class Rubbing:
    """The friction forces that a state of yarn holds.

    Attributes
    ----------
    key : (n,) which pair of samples, sorted.
    force_n : (n, 2) friction force of each, N, along its two strands.
    """

    key: NDArray[np.int64]
    force_n: Array


@dataclass(frozen=True, eq=False)
class RubbedCell:
    """A state of yarn with friction, and how it came about.

    Attributes
    ----------
    cell : the state in equilibrium; its energy is without friction, its forces with it.
    rubbing : the friction forces that it holds.
    lost_n_mm : work per stitch against friction since the history began, N·mm. Some of it is held
        elastically and comes back.
    """

    cell: RelaxedRepeat
    rubbing: Rubbing
    lost_n_mm: float


def check_coefficient(coefficient: float) -> None:
    """Refuse what is no coefficient of friction.

    Raises
    ------
    InputError
    """
    check_range("friction", coefficient, 0, MAX_COEFFICIENT, what="a coefficient of friction")


def agitated(relaxed: RelaxedRepeat) -> RubbedCell:
    """The state without any friction force: where shaking and washing take the fabric.

    Raises
    ------
    InputError
        If the cell is too large, or is held.
    """
    check_stitches(relaxed.cell.stitches, MAX_STITCHES, "its cell")
    check_unheld(relaxed)
    return RubbedCell(relaxed, Rubbing(np.zeros(0, np.int64), np.zeros((0, 2))), 0.0)


def rubbed(
    last: RubbedCell,
    coefficient: float,
    *,
    fixed: tuple[int, ...] = (),
    target: Array | None = None,
    cancelled: Cancelled | None = None,
) -> RubbedCell:
    """The equilibrium after one small step of the history.

    Parameters
    ----------
    last : the state before.
    coefficient : of friction between yarns.
    fixed : cell sizes that are prescribed (``COURSE``, ``WALE`` of the solver); the others are
        free of force.
    target : (2,) sizes of a stitch to move the fixed ones to, mm.

    Raises
    ------
    InputError
        If the coefficient is out of range.
    ConvergenceError, UnravelledError
        If the yarn locks or unravels on the way.
    CancelledError
        If ``cancelled`` says so.
    """
    check_coefficient(coefficient)
    began = time.process_time()
    cell = last.cell
    energy = cell.energy
    small = cell.cell.stitches <= 4
    minimum, rubbing, lost = rub(
        energy, cell.state, cell.tension_n, last.rubbing, coefficient, check=check_reached,
        fixed=fixed, target=target, cancelled=cancelled,
        options=Options(tolerance=1e-8 if small else 1e-6, iterations=80),
    )  # fmt: skip
    shown = cell.at(energy, minimum, time.process_time() - began)
    return RubbedCell(shown, rubbing, last.lost_n_mm + lost / cell.cell.stitches)


def rub(
    energy: CellEnergy, begin: Array, tension: Array, before: Rubbing, coefficient: float, *,
    options: Options, check: Callable[[CellEnergy, Minimum], None],
    fixed: tuple[int, ...] = (), target: Array | None = None, cancelled: Cancelled | None = None,
) -> tuple[Minimum, Rubbing, float]:  # fmt: skip
    """One small step with friction: where it ends, the forces that it holds, the work it took.

    Parameters
    ----------
    energy : of the cell, as it is in this step.
    begin, tension, before : state, tensions and friction forces where it begins.
    check : refuses a state on the way.

    Returns
    -------
    Its end, the friction forces there, and the work against friction in the whole cell, N·mm.
    """
    state, evaluations = begin, 0
    for _ in range(_NORMAL_FORCES):
        sliding, pairs = _sliding(energy, begin, state, before, coefficient)
        minimum = minimise(
            replace(energy, sliding=sliding), state, tension=tension, fixed=fixed, target=target,
            options=options, cancelled=cancelled,
        )  # fmt: skip
        check(energy, minimum)
        state, tension = minimum.state, minimum.tension
        evaluations += minimum.evaluations
    held, lost = _held(energy, sliding, begin, state)
    return replace(minimum, evaluations=evaluations), Rubbing(pairs, held), lost


def _sliding(
    energy: CellEnergy, begin: Array, end: Array, before: Rubbing, coefficient: float
) -> tuple[Sliding, NDArray[np.int64]]:
    """The pairs that touch at the end of a step, as far as it is known, and their keys.

    They begin with the forces that they hold. They stick with the mean of the stiffness at the
    beginning and the end, and slip at the limit of the end.
    """
    curve, layout = energy.curve(end), energy.cell.layout
    pairs, _ = energy.pairs(curve, end, 2.0 * energy.yarn.radius_mm)
    key = _keys(pairs, len(curve))
    order = np.argsort(key)
    pairs, key = pairs[order], key[order]
    first, limit = (
        coefficient
        * normal_forces(
            energy.curve(state), float(state[-2]), float(state[-1]), pairs, layout,
            energy.contact_law,
        )
        for state in (begin, end)
    )  # fmt: skip
    slide, cosine = slides(
        energy.curve(begin), float(begin[-2]), float(begin[-1]), pairs, layout, energy.speeds
    )
    force = np.zeros((len(key), 2))
    if len(before.key):
        place = np.minimum(np.searchsorted(before.key, key), len(before.key) - 1)
        known = before.key[place] == key
        force[known] = before.force_n[place[known]]
    mean = 0.5 * (first + limit)
    stiffness = np.maximum(mean / (SLIP_RADII * energy.yarn.radius_mm), _LEAST)
    slip = np.maximum(limit, _LEAST) / stiffness
    scale = 1.0 / np.sqrt(1.0 + cosine**2)
    rest = slide - force / (stiffness * scale)[:, None]
    return Sliding(pairs, limit, rest, scale, slip), key


def _held(energy: CellEnergy, sliding: Sliding, begin: Array, end: Array) -> tuple[Array, float]:
    """(n, 2) friction forces after a step, N, and the work against friction in it, N·mm."""
    before, after = (
        sliding.scale[:, None]
        * (
            slides(
                energy.curve(state), float(state[-2]), float(state[-1]), sliding.pairs,
                energy.cell.layout, energy.speeds,
            )[0]
            - sliding.rest
        )
        for state in (begin, end)
    )  # fmt: skip
    force = (
        after * (sliding.limit / np.maximum(np.sqrt((after**2).sum(axis=1)), sliding.slip))[:, None]
    )
    first = before * (sliding.limit / sliding.slip)[:, None]
    return force, float(np.sum(0.5 * (first + force) * (after - before)))


def _keys(pairs: Pairs, samples: int) -> NDArray[np.int64]:
    """A number for every pair of samples and image."""
    wide = pairs.astype(np.int64)
    key = wide[:, 0] * samples + wide[:, 1]
    for image in (wide[:, 2], wide[:, 3]):
        key = key * 2 * _IMAGES + image + _IMAGES
    return np.asarray(key)
