"""Relax a chart of a material: the library's yarn and loop length, the yarn level's solver."""

from typing import Any, overload

from numpy.typing import ArrayLike

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart, as_chart
from knitcore.materials import Material, as_material
from knitcore.yarn.library.yarns import yarn_for
from knitcore.yarn.model.relaxed_cell import Branch, RelaxedCell
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.splines import RelaxedRepeat, loop_lengths
from knitcore.yarn.study.relax import OnSplines
from knitcore.yarn.study.relax import relax as relax_yarn


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


def relax(
    chart: StitchChart | str,
    material: Material | str | YarnModel | None = None,
    loop_length_mm: ArrayLike | None = None,
    *,
    branch: Branch | str | None = None,
    **options: Any,
) -> RelaxedCell:
    """Find the shape of least energy of a repeat of a material.

    Parameters
    ----------
    chart : the repeat (or any number of repeats), or its text.
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
    chart = as_chart(chart)
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
    return relax_yarn(chart, yarn, loop_length_mm, branch=branch, **options)
