"""A relaxed repeat as another image of its fabric: shifted, mirrored, or seen from the back.

Images of one fabric have the same states, but a search that begins with each of them may end in
different ones. So one image is relaxed (:meth:`StitchChart.canonical`) for all, and turned.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, ConvergenceError, UnravelledError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.cell import free_cell, mirrored_cell
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.relaxed_cell import Branch
from knitcore.yarn.model.tiling import tiled_controls
from knitcore.yarn.solve.newton import TIGHT, minimise
from knitcore.yarn.solve.search import RELAXED, SAME_ENERGY, UNSETTLED, outcome
from knitcore.yarn.solve.splines import RelaxedRepeat, relaxed_repeat


def same_for_images(
    search: Callable[[StitchChart], RelaxedRepeat], repeat: StitchChart, *,
    fixed: tuple[int, ...] = (), cancelled: Cancelled | None = None,
) -> RelaxedRepeat:  # fmt: skip
    """What a search finds for a repeat, the same for every image of its fabric.

    Parameters
    ----------
    search : relaxes a repeat of one loop length, not in the published branch.
    fixed : which sizes it holds, as in :func:`turned`.

    Raises
    ------
    What the search raises, and CancelledError.
    """
    one = repeat.canonical()
    if one != repeat:
        found = search(one)
        with suppress(ConvergenceError, UnravelledError):  # then from the image itself
            return turned(found, repeat, fixed=fixed, cancelled=cancelled)
    return search(repeat)


def turned(
    relaxed: RelaxedRepeat, image: StitchChart, *, fixed: tuple[int, ...] = (),
    cancelled: Cancelled | None = None,
) -> RelaxedRepeat:  # fmt: skip
    """A relaxed repeat as another image of its fabric.

    Parameters
    ----------
    relaxed : of one loop length; not of the published branch.
    image : a repeat with the same canonical image.
    fixed : which of its sizes are held, as in :func:`knitcore.yarn.solve.newton.minimise`.

    Raises
    ------
    ConvergenceError, UnravelledError
        If the image does not rest in the same shape.
    CancelledError
        If ``cancelled`` says so.
    ValueError
        If ``image`` is of another fabric.
    """
    grid = relaxed.cell.grid
    free = free_cell(image, grid)
    cell = mirrored_cell(image, grid) if relaxed.branch is Branch.MIRRORED else free
    points = tiled_controls(relaxed.cell, relaxed.state, free.rows, free.wales)
    tension = np.resize(relaxed.tension_n[: relaxed.cell.rows], free.rows)
    points, tension = _turned(
        relaxed.chart.resized(free.rows, free.wales).purl, free.purl, points, tension
    )
    energy = CellEnergy(
        cell, relaxed.yarn, np.resize(relaxed.loop_lengths_mm, cell.rows), relaxed.convention,
        relaxed.flat,
    )  # fmt: skip
    state = cell.state(
        points[: cell.rows, : cell.controls_per_course],
        relaxed.cell_course_mm, relaxed.cell_wale_mm,
    )  # fmt: skip
    found = minimise(
        energy, state, tension=np.append(tension[: cell.rows], np.zeros(len(energy.held))),
        fixed=fixed, options=TIGHT, cancelled=cancelled,
    )  # fmt: skip
    part = found.terms.energy / cell.stitches / relaxed.energy_n_mm
    if outcome(energy, found) not in (RELAXED, UNSETTLED) or abs(part - 1.0) > SAME_ENERGY:
        raise ConvergenceError("Another image of the fabric has another shape.")
    shown = relaxed_repeat(
        StitchChart(free.purl) if relaxed.branch is Branch.FREE else image,
        energy, relaxed.branch, found, seconds=relaxed.seconds,
        evaluations=relaxed.evaluations + found.evaluations,
        starts=relaxed.starts, notes=relaxed.notes,
    )  # fmt: skip
    mirrored = relaxed.mirrored and turned(relaxed.mirrored, image, cancelled=cancelled)
    return replace(
        shown, converged=relaxed.converged, minimum=relaxed.minimum, mirrored=mirrored,
        other_minima_mm=relaxed.other_minima_mm,
    )  # fmt: skip


def _turned(
    purl: NDArray[np.bool_], image: NDArray[np.bool_], points: Array, tension: Array
) -> tuple[Array, Array]:
    """Control points (rows, controls, 3) and tensions (rows,) of a chart as those of an image."""
    rows, wales = purl.shape
    count = points.shape[1] // wales
    for back, mirrored in product((False, True), repeat=2):
        seen = purl ^ back
        seen = seen[:, ::-1] if mirrored else seen
        for up, right in np.ndindex(rows, wales):
            if np.array_equal(np.roll(seen, (up, right), axis=(0, 1)), image):
                found = points * (1.0, 1.0, -1.0 if back else 1.0)
                if mirrored:  # the yarn runs the other way, from the same foot
                    found = np.roll(found[:, ::-1], 1, axis=1) * (-1.0, 1.0, 1.0)
                return np.roll(found, (up, count * right), axis=(0, 1)), np.roll(tension, up)
    raise ValueError("It is no image of the same fabric.")
