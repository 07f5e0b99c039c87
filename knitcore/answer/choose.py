"""The one rule: which law a chart of a material gets.

1. A chart that is one pure fabric has that fabric's own law and gauge (*measured*; *estimated* or
   *swept* if the record is).
2. A chart with a yarn-level sweep of its own has that sweep's correction of the mixture of its pure
   fabrics (*swept*). The caller gives the sweep; for a simulated material, which the yarn level
   defines, it is also looked up among the packaged ones.
3. Any other chart is a mixture of the pure fabrics with a correction learned from yarn-level
   simulations of mixed charts (*learned*). It is close to every simulated repeat and continuous in
   the shares of a chart's stitches, so one stitch more or less changes little.
4. A chart too large for one repeat is answered patch by patch (:mod:`knitcore.answer.patches`).
5. A known gauge replaces the relaxed size and narrows the intervals of the stretch (*learned with
   known size*).

Measured materials do not look sweeps up: the packaged ones are of one of several shapes that a
repeat may take, and no nearer to another of its shapes than the learned answer is.
"""

from __future__ import annotations

from knitcore.answer.answer import Answer
from knitcore.answer.learned import SweptChart
from knitcore.answer.patches import patches_of
from knitcore.answer.relaxed import RelaxedSize
from knitcore.chart import StitchChart
from knitcore.materials import Material


def choose(
    chart: StitchChart,
    material: Material,
    gauge: RelaxedSize | None = None,
    swept: SweptChart | None = None,
) -> Answer:
    """What a chart of a material does: relaxed size, moduli and curves, with intervals and source.

    Parameters
    ----------
    chart : a repeat, or a swatch that may cut its last repeat off.
    material : a yarn at one setting.
    gauge : relaxed size of the chart's mean stitch, if known.
    swept : yarn-level sweep of the chart's repeat (:mod:`knitcore.answer.swept`), if there is one.

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> garter = choose(StitchChart.of_fabric("garter", 31, 31), material("acrylic"))
    >>> round(garter.modulus_course_n_per_mm, 3), round(garter.modulus_wale_n_per_mm, 3)
    (0.134, 0.081)
    >>> choose(StitchChart.parse("KKPP"), material("acrylic")).provenance
    <Source.LEARNED: 'learned'>
    >>> choose(StitchChart.parse("KKPP"), material("acrylic:simulation")).provenance
    <Source.SWEPT: 'swept'>
    """
    return patches_of(chart, material, gauge, swept).together()
