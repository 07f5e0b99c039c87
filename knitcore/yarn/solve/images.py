"""Repeats as other images of their fabrics: shifted, mirrored, or seen from the back.

Images of one fabric have the same states, but a search that begins with each of them may end in
different ones. So one image is relaxed (:meth:`StitchChart.canonical`) for all, and turned.
"""

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
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

Grid = NDArray[np.bool_]


@dataclass(frozen=True)
class Symmetry:
    """How a chart follows from another image of its fabric.

    ``chart = shift(swap(mirror(image)))``: mirrored left to right, K and P swapped (the back of the
    fabric seen through it), then moved up and to the right by whole stitches.
    """

    up: int
    right: int
    mirror: bool
    swap: bool

    def points(self, points: Array, wales: int) -> Array:
        """Control points (rows, controls, 3) of an image that has ``wales`` wales."""
        if self.mirror:  # the yarn runs the other way, from the same foot
            points = np.roll(points[:, ::-1], 1, axis=1) * (-1.0, 1.0, 1.0)
        if self.swap:
            points = points * (1.0, 1.0, -1.0)
        per_stitch = points.shape[1] // wales
        return np.roll(points, (self.up, self.right * per_stitch), axis=(0, 1))


def placements(purl: Grid) -> Iterator[tuple[Symmetry, Grid]]:
    """All charts of the same size that are the same fabric, with their placements."""
    rows, columns = purl.shape
    for mirror, swap in product((False, True), repeat=2):
        image = purl[:, ::-1] if mirror else purl
        image = ~image if swap else image
        for up, right in product(range(rows), range(columns)):
            yield Symmetry(up, right, mirror, swap), np.roll(image, (up, right), axis=(0, 1))


def placement(chart: StitchChart, image: StitchChart) -> Symmetry | None:
    """How a repeat follows from another image of its fabric; None if it does not."""
    purl = chart.repeat().purl
    return next((p for p, grid in placements(image.purl) if np.array_equal(grid, purl)), None)


def same_for_images(
    search: Callable[[StitchChart], RelaxedRepeat], repeat: StitchChart, *,
    fixed: tuple[int, ...] = (), cancelled: Cancelled | None = None,
) -> RelaxedRepeat:  # fmt: skip
    """Relax a repeat by a search, to the same shape for every image of its fabric.

    Parameters
    ----------
    search : relaxes a repeat of one loop length, not in the published branch.
    fixed : which sizes it holds, as in :func:`turned`.

    Raises
    ------
    What the search raises, and CancelledError.
    """
    canonical = repeat.canonical()
    if canonical != repeat:
        relaxed = search(canonical)
        with suppress(ConvergenceError, UnravelledError):  # then from the image itself
            return turned(relaxed, repeat, fixed=fixed, cancelled=cancelled)
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
    charts = placements(relaxed.chart.resized(free.rows, free.wales).purl)
    same = [placed for placed, purl in charts if np.array_equal(purl, free.purl)]
    if not same:
        raise ValueError("This is no image of the repeat, shifted, mirrored or turned over.")
    placed = min(same, key=lambda symmetry: symmetry.swap)  # from the same side if possible
    points, tension = placed.points(points, free.wales), np.roll(tension, placed.up)
    energy = CellEnergy(
        cell, relaxed.yarn, np.resize(relaxed.loop_lengths_mm, cell.rows), relaxed.convention,
        relaxed.flat,
    )  # fmt: skip
    state = cell.state(
        points[: cell.rows, : cell.controls_per_course],
        relaxed.cell_course_mm, relaxed.cell_wale_mm,
    )  # fmt: skip
    minimum = minimise(
        energy, state, tension=np.append(tension[: cell.rows], np.zeros(len(energy.held))),
        fixed=fixed, options=TIGHT, cancelled=cancelled,
    )  # fmt: skip
    part = minimum.terms.energy / cell.stitches / relaxed.energy_n_mm
    if outcome(energy, minimum) not in (RELAXED, UNSETTLED) or abs(part - 1.0) > SAME_ENERGY:
        raise ConvergenceError("Another image of the fabric has another shape.")
    shown = relaxed_repeat(
        StitchChart(free.purl) if relaxed.branch is Branch.FREE else image,
        energy, relaxed.branch, minimum, seconds=relaxed.seconds,
        evaluations=relaxed.evaluations + minimum.evaluations,
        starts=relaxed.starts, notes=relaxed.notes,
    )  # fmt: skip
    mirrored = relaxed.mirrored and turned(relaxed.mirrored, image, cancelled=cancelled)
    return replace(
        shown, converged=relaxed.converged, minimum=relaxed.minimum, mirrored=mirrored,
        other_minima_mm=relaxed.other_minima_mm,
    )  # fmt: skip
