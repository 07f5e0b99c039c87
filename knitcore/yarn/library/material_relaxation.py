"""Relax a chart of a material: the library's yarn and loop length, the yarn level's solver.

A chart of knits and purls keeps its own path; any other takes that of
:mod:`knitcore.yarn.loops.relaxed_stitches`.
"""

from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart, as_chart
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.materials import Material, as_material
from knitcore.yarn.library.yarns import yarn_for
from knitcore.yarn.loops.relaxed_stitches import RelaxedStitches, relax_stitches
from knitcore.yarn.model.relaxed_cell import Branch, RelaxedCell
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.splines import RelaxedRepeat, loop_lengths
from knitcore.yarn.study.relax import OnSplines
from knitcore.yarn.study.relax import relax as relax_yarn

_OF_STITCHES = {"history", "friction", "per_act", "convention", "cancelled"}
"""Options of a chart with other stitches than knits and purls."""


@overload
def relax(
    chart: StitchChart | str,
    material: Material | str | YarnModel | None = ...,
    loop_length_mm: ArrayLike | None = ...,
    *,
    branch: OnSplines | None = ...,
    **options: Any,
) -> RelaxedRepeat: ...


@overload
def relax(
    chart: StitchChart | str,
    material: Material | str | YarnModel | None = ...,
    loop_length_mm: ArrayLike | None = ...,
    *,
    branch: Branch | str | None,
    **options: Any,
) -> RelaxedCell: ...


@overload
def relax(
    chart: SymbolChart,
    material: Material | str | YarnModel | None = ...,
    loop_length_mm: ArrayLike | None = ...,
    *,
    branch: Branch | str | None = ...,
    **options: Any,
) -> RelaxedCell | RelaxedStitches: ...


def relax(
    chart: StitchChart | SymbolChart | str,
    material: Material | str | YarnModel | None = None,
    loop_length_mm: ArrayLike | None = None,
    *,
    branch: Branch | str | None = None,
    **options: Any,
) -> RelaxedCell | RelaxedStitches:
    """Find the shape of least energy of a repeat of a material.

    Parameters
    ----------
    chart : the repeat (or any number of repeats), or its text. One of other stitches than knits
        and purls takes the options of
        :func:`~knitcore.yarn.loops.relaxed_stitches.relax_stitches` instead: the history, the
        friction and the yarn of every stitch.
    material : whose yarn and loop length are taken, or its identifier; or a yarn.
    loop_length_mm : mm of yarn per stitch instead of the material's; needed beside a yarn. One
        number, one for every course, or one for every stitch.
    branch, options : as for :func:`knitcore.yarn.study.relax.relax`: the factors of the energy,
        sizes to hold, a flat fabric, resolution, starts, a time limit and cancellation.

    Raises
    ------
    InputError
        If neither a material nor a yarn with a loop length is given, the material's yarn is not
        known well enough, or as the solver says.
    ConvergenceError, UnravelledError, CancelledError
        As the solver says.

    Examples
    --------
    >>> cell = relax("K", "acrylic", branch="mirrored")
    >>> 2.5 < cell.cell_course_mm < 4.5
    True
    """
    stitches = chart if isinstance(chart, SymbolChart) else None
    chart = chart.plain if isinstance(chart, SymbolChart) else as_chart(chart)
    yarn = None
    if isinstance(material, YarnModel):
        yarn = material
    elif material is not None:
        length = (
            None if loop_length_mm is None else float(loop_lengths(loop_length_mm, chart)[1].mean())
        )
        used = yarn_for(as_material(material), chart, length)
        yarn = used.yarn
        loop_length_mm = used.loop_length_mm if loop_length_mm is None else loop_length_mm
    if yarn is None:
        raise InputError("material", "is missing.", "Give one, or a yarn and loop_length_mm.")
    if loop_length_mm is None:
        raise InputError("loop_length_mm", "is missing.", "Give it beside a yarn, or a material.")
    if stitches is None or stitches.is_plain:
        return relax_yarn(chart, yarn, loop_length_mm, branch=branch, **options)
    refused = [*options.keys() - _OF_STITCHES, *(["branch"] if branch is not None else [])]
    if refused or np.size(loop_length_mm) != 1:
        raise InputError(
            min(refused, default="loop_length_mm"),
            "is for charts of knits and purls only.",
            "Leave it out, or give one loop length: that of a knit.",
        )
    return relax_stitches(stitches, yarn, np.asarray(loop_length_mm, float).item(), **options)
