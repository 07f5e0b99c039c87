"""The strip test: a swatch pulled between two clamps."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_count
from knitcore.base.choice import Choice
from knitcore.base.errors import Cancelled, InputError, Progress
from knitcore.base.kinds import as_numbers, check_callables, check_kind
from knitcore.chart.fabric import PHASES, Direction
from knitcore.chart.phases import as_stitches
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, StitchChart, as_chart
from knitcore.cloth.flat.coarse import coarse_grid
from knitcore.cloth.flat.equilibrium_path import Path, run_path
from knitcore.cloth.flat.grid import QuarterGrid, check_cloth
from knitcore.cloth.flat.grid_sheet import Sheet
from knitcore.cloth.flat.sheet_models import EnergyModel, SheetModel, energy_model
from knitcore.cloth.flat.strip_results import StripTest
from knitcore.materials import Material, as_material
from knitcore.prediction.patches import MAX_SIDE
from knitcore.prediction.quarter_laws import QuarterLaws, quarter_laws
from knitcore.prediction.size import RelaxedSize

DEFAULT_STEPS = 10
MAX_STEPS = 1000
MAX_STRAIN = 5.0
"""Largest strain of a test of laws that never lock."""
LOCK_UP_SHARE = 0.98
"""Largest strain of a test, as a share of the lock-up strain."""


class Clamps(Choice):
    """Ends of a strip: gripped, or free to slide along the clamp."""

    CLAMPED = "clamped"
    SLIDING = "sliding"


def strip_test(
    chart: StitchChart | str,
    material: Material | str,
    direction: Direction | str,
    strain: float | Sequence[float],
    *,
    steps: int = DEFAULT_STEPS,
    model: EnergyModel | str | SheetModel = EnergyModel.FULL,
    shear_modulus: float | None = None,
    clamps: Clamps | str = Clamps.CLAMPED,
    stitch: NDArray[np.bool_] | None = None,
    size: RelaxedSize | None = None,
    laws: QuarterLaws | None = None,
    width_mm: float | None = None,
    length_mm: float | None = None,
    block: int = 1,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> StripTest:
    """Pull a chart of a material.

    Parameters
    ----------
    chart : the stitches, face side.
    material : yarn and laws of its fabrics.
    direction : of the pull; ``course`` clamps the left and right edges, ``wale`` bottom and top.
    strain : last clamp-to-clamp strain, reached in equal steps, or all strains in order.
    steps : number of load steps if one strain is given.
    model : energy model by name, or with all its options.
    shear_modulus : N/mm, replaces the laws' assumed one.
    clamps : gripped or sliding ends.
    stitch : bool (rows, columns), where a shaped piece has stitches, row 0 at the bottom; the
        clamps hold those of its outermost rows or columns. All of the rectangle by default.
    size : relaxed size of the chart's mean stitch, if known; not used beside ``laws``.
    laws : of the quarter cells; by default those with which the swatch agrees with
        :func:`knitcore.prediction.predict.predict`.
    width_mm, length_mm : size course-wise and wale-wise; by default from the gauge.
    block : stitches a side of the blocks that a large chart is computed in
        (:mod:`knitcore.cloth.flat.coarse`); 1 for quarters of stitches.
    progress : called with (steps done, steps in all).
    cancelled : called from time to time; True stops the test.

    Returns
    -------
    StripTest
        With ``converged`` False and ``problem`` set if it stopped short; the steps before that
        are valid.

    Raises
    ------
    InputError
        For strains at or beyond the lock-up, sizes, steps or meshes that cannot be used, or a
        shaped piece that is not connected.
    CancelledError
        If ``cancelled`` returned True.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> chart = StitchChart.of_fabric("garter", rows=4, columns=6)
    >>> test = strip_test(chart, material("acrylic"), "wale", 0.3, steps=3)
    >>> test.converged, test.strain.round(2).tolist()
    (True, [0.1, 0.2, 0.3])
    """
    check_callables(progress=progress, cancelled=cancelled)
    sheet = chart_sheet(
        as_chart(chart),
        as_material(material),
        model,
        shear_modulus,
        stitch=stitch,
        size=size,
        laws=laws,
        width_mm=width_mm,
        length_mm=length_mm,
        block=block,
    )
    return pull(
        sheet,
        Direction.parse(direction),
        load_levels(strain, steps),
        clamps=Clamps.parse(clamps),
        progress=progress,
        cancelled=cancelled,
    )


def chart_sheet(
    chart: StitchChart,
    material: Material,
    model: EnergyModel | str | SheetModel = EnergyModel.FULL,
    shear_modulus: float | None = None,
    *,
    stitch: NDArray[np.bool_] | None = None,
    size: RelaxedSize | None = None,
    laws: QuarterLaws | None = None,
    width_mm: float | None = None,
    length_mm: float | None = None,
    block: int = 1,
) -> Sheet:
    """The sheet of a chart of a material; parameters as for :func:`strip_test`.

    Its cells' laws and sizes are such that a large swatch agrees with
    :func:`knitcore.prediction.predict.predict`.
    """
    chosen = sheet_model(model, shear_modulus)
    if stitch is not None:
        stitch = as_stitches(stitch, chart)
    if laws is not None:
        check_kind("laws", laws, QuarterLaws, "Give QuarterLaws, as quarter_laws() returns them.")
    sizes = {fabric: record.stitch_mm for fabric, record in material.fabrics.items()}
    check_count("block", block, 1, max(chart.purl.shape))
    local = laws or _local_laws(chart, material, stitch, size, even=block > 1)
    grid = QuarterGrid.of_chart(
        chart, sizes, local.scale, stitch=stitch, width_mm=width_mm, length_mm=length_mm
    )
    place = local.place.repeat(2, axis=0).repeat(2, axis=1)
    grid = replace(grid, law_of_cell=len(PHASES) * place + grid.law_of_cell)
    if block == 1:
        return Sheet(grid, local.laws, chosen, local.mixing, local.log_sd)
    coarse, mixing = coarse_grid(grid, local.mixing, block)
    return Sheet(coarse, local.laws, chosen, mixing, local.log_sd, grid, block)


def _local_laws(
    chart: StitchChart,
    material: Material,
    stitch: NDArray[np.bool_] | None,
    size: RelaxedSize | None,
    *,
    even: bool,
) -> QuarterLaws:
    """Laws of a piece; a shaped one counts as its bounding rectangle, filled with its pattern."""
    most = MAX_STITCHES_PER_SIDE if even else MAX_SIDE  # even laws know a part by its patches only
    if stitch is None or np.all(stitch):
        return quarter_laws(chart, material, size, even=even, most=most)
    check_cloth(stitch, chart.rows, chart.columns)
    rows, columns = (np.flatnonzero(stitch.any(axis=axis)) for axis in (1, 0))
    here = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    filled = _continued(chart.purl[here], stitch[here])
    laws = quarter_laws(filled, material, size, even=even, most=most)
    place, scale = np.zeros(stitch.shape, dtype=np.intp), np.ones((*stitch.shape, 2))
    place[here], scale[here] = laws.place, laws.scale
    return replace(laws, place=place, scale=scale)


def _continued(purl: NDArray[np.bool_], stitch: NDArray[np.bool_]) -> StitchChart:
    """A shaped piece with its repeat where it has no stitch; without one, with its rows mirrored
    about their first and last stitch.
    """
    rows, columns = _period(purl, stitch), _period(purl.T, stitch.T)
    row, column = np.arange(len(stitch))[:, None], np.arange(stitch.shape[1])[None, :]
    place = (row % rows) * columns + column % columns
    known = np.bincount(place[stitch], minlength=rows * columns) > 0
    repeat = np.bincount(place[stitch], purl[stitch], minlength=rows * columns) > 0
    first = stitch.argmax(axis=1)[:, None]
    last = stitch.shape[1] - 1 - stitch[:, ::-1].argmax(axis=1)[:, None]
    mirrored = np.where(column < first, 2 * first - column, column)
    mirrored = np.where(column > last, 2 * last - column, mirrored).clip(first, last)
    filled = np.where(known[place], repeat[place], purl[row, mirrored])
    return StitchChart(np.where(stitch, purl, filled))


def _period(purl: NDArray[np.bool_], stitch: NDArray[np.bool_]) -> int:
    """Smallest number of rows after which the stitches repeat, all of them if they do not."""
    n = len(purl)
    return next(
        (
            p
            for p in range(1, n // 2 + 1)
            if not np.any((purl[p:] != purl[:-p]) & stitch[p:] & stitch[:-p])
        ),
        n,
    )


def sheet_model(
    model: EnergyModel | str | SheetModel, shear_modulus: float | None = None
) -> SheetModel:
    """A model, given by name or as an object, with a shear modulus."""
    if isinstance(model, SheetModel):
        if shear_modulus is not None:
            raise InputError(
                "shear_modulus", "is given twice.", "Give it in the model or on its own, not both."
            )
        return model
    return SheetModel(energy_model(model), shear_modulus=shear_modulus)


def pull(
    sheet: Sheet,
    direction: Direction,
    levels: Array,
    *,
    clamps: Clamps = Clamps.CLAMPED,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> StripTest:
    """A strip test of any sheet at the given strains.

    Raises
    ------
    InputError
        If a strain reaches the lock-up.
    """
    check_lock_up(sheet, direction, float(levels.max()))
    fixed = clamp_mask(sheet.grid, direction, clamps)
    targets = [stretched(sheet.grid, direction, e) for e in levels]
    path = run_path(sheet, fixed, targets, progress=progress, cancelled=cancelled)
    return strip_result(sheet, direction, levels, path)


def strip_result(sheet: Sheet, direction: Direction, levels: Array, path: Path) -> StripTest:
    """The result of a path whose steps are the strains ``levels``."""
    grid, axis = sheet.grid, direction.axis
    length = _length(grid, direction)
    width = grid.area_mm2 / length
    _, end = clamp_edges(direction)
    force = path.forces(grid.edge(end), axis)
    return StripTest.of(
        sheet,
        path,
        direction=direction,
        strain=levels[: len(path.equilibria)],
        force_n=force,
        stress_n_per_mm=force / width,
        waist_strain=np.array([waist_strain(grid, s.corners, direction) for s in path.states]),
        width_mm=width,
        length_mm=length,
    )


def load_levels(strain: float | Sequence[float], steps: int) -> Array:
    """Strains of the load steps.

    Raises
    ------
    InputError
        If they are not positive and increasing, or the number of steps cannot be used.
    """
    check_count("steps", steps, 1, MAX_STEPS)
    values = as_numbers("strain", strain, "Give a number above 0, or several.")
    levels = values * (np.arange(1, steps + 1) / steps) if values.ndim == 0 else values
    if levels.ndim > 1 or levels.size == 0 or not np.all(np.isfinite(levels)) or levels[0] <= 0:
        raise InputError("strain", f"{strain} is not a stretch.", "Give a number above 0.")
    if np.any(np.diff(levels) <= 0):
        raise InputError("strain", "the strains do not increase.", "Give increasing strains.")
    return levels


def lock_up_strain(sheet: Sheet, direction: Direction) -> float:
    """Clamp-to-clamp strain at which the first straight line of cells locks.

    Infinite for laws that never lock, and for a shape of which no line runs straight through.
    """
    if sheet.model.energy is EnergyModel.PUBLISHED:
        return float("inf")
    grid, axis = sheet.grid, direction.axis
    with np.errstate(divide="ignore"):
        limits = 1.0 / sheet.parameters[direction.of("alpha_xx", "alpha_yy")][grid.law_of_cell]
    along = 1 - axis
    through = grid.cloth.sum(axis=along) == np.count_nonzero(grid.cloth.any(axis=axis))
    reach = np.where(grid.cloth, grid.cell_size[axis] * (1 + limits), 0.0)
    longest = np.sum(reach, axis=along)[through]
    return float(longest.min(initial=np.inf) / _length(grid, direction) - 1)


def check_lock_up(sheet: Sheet, direction: Direction, strain: float) -> None:
    """Refuse a strain that a line of cells cannot reach.

    Raises
    ------
    InputError
        Naming the largest strain that is accepted.
    """
    limit = min(LOCK_UP_SHARE * lock_up_strain(sheet, direction), MAX_STRAIN)
    if strain > limit:
        why = (
            "this swatch runs out of stretch before that"
            if limit < MAX_STRAIN
            else "no fabric stretches that far"
        )
        most = float(np.floor(1000 * limit) / 1000)
        raise InputError(
            "strain",
            f"{strain:.3g} {direction}-wise is too much: {why}.",
            f"Use at most {most:.3f}.",
            most=most,
        )


def clamp_edges(direction: Direction) -> tuple[str, str]:
    """Names of the clamped edges, the fixed and the pulled one."""
    return direction.of(("left", "right"), ("bottom", "top"))


def clamp_mask(grid: QuarterGrid, direction: Direction, clamps: Clamps) -> NDArray[np.bool_]:
    """Mask (corners, 2) of the unknowns that the clamps hold."""
    fixed = np.zeros((len(grid.corners), 2), dtype=bool)
    edges = [grid.edge(name) for name in clamp_edges(direction)]
    for nodes in edges:
        fixed[nodes, direction.axis] = True
        if clamps is Clamps.CLAMPED:
            fixed[nodes, direction.other.axis] = True
    if clamps is Clamps.SLIDING:  # one node keeps the strip from drifting along the clamps
        middle = edges[0][len(edges[0]) // 2]
        fixed[middle, direction.other.axis] = True
    return fixed


def stretched(grid: QuarterGrid, direction: Direction, strain: float) -> Array:
    """Corner positions of the uniformly stretched grid; the clamps' targets are among them."""
    corners = grid.corners.copy()
    corners[:, direction.axis] *= 1 + strain
    return corners


def _length(grid: QuarterGrid, direction: Direction) -> float:
    """Distance of the clamps at rest."""
    return direction.of(grid.width_mm, grid.length_mm)


def waist_strain(grid: QuarterGrid, corners: Array, direction: Direction) -> float:
    """Relative change of width, from edge to edge, half-way between the clamps."""
    shape = (grid.rows + 1, grid.columns + 1)
    used = grid.used_corners.reshape(shape)
    if direction is Direction.COURSE:  # a line of corners across the pull becomes a row
        used = used.T
    lines = np.flatnonzero(used.any(axis=1))
    first = used.argmax(axis=1)[lines]
    last = used.shape[1] - 1 - used[:, ::-1].argmax(axis=1)[lines]

    def widths(positions: Array) -> Array:
        across = positions[:, direction.other.axis].reshape(shape)
        across = direction.of(across.T, across)
        return np.asarray(across[lines, last] - across[lines, first])

    at = direction.of(grid.column_lines, grid.row_lines)[lines]
    ratio = widths(corners) / widths(grid.corners)
    return float(np.interp((at[0] + at[-1]) / 2, at, ratio)) - 1
