"""The one rule: which law a chart of a material gets.

1. A chart that is one pure fabric has that fabric's own law and gauge (*measured*).
2. A repeat that was stretched on the yarn level has that law, carried to the material (*swept*).
3. A rib or welt of a known relaxed size is a series of its phases, corrected for its draw-in
   (*composite with known size*).
4. Anything else is the composite of its quarter cells (*composite*), corrected by what is known of
   the repeats of 1 to 3 that parts of it look like (:mod:`knitcore.answer.resemblance`). So the
   answer does not jump when one stitch makes a known repeat an unknown chart.

A known gauge replaces the relaxed size, and corrects ribs and welts.
"""

from __future__ import annotations

from knitcore.answer.answer import Answer
from knitcore.answer.composite import composite
from knitcore.answer.folded import folded
from knitcore.answer.measured import measured
from knitcore.answer.relaxed import RelaxedSize, known_size
from knitcore.answer.repeat import Repeat
from knitcore.answer.resemblance import corrected
from knitcore.answer.swept import swept
from knitcore.chart import StitchChart
from knitcore.materials import Material


def choose(chart: StitchChart, material: Material, gauge: RelaxedSize | None = None) -> Answer:
    """What a chart of a material does.

    Parameters
    ----------
    chart : a repeat, or a swatch that may cut its last repeat off.
    material : one yarn on one setting.
    gauge : relaxed size of the chart's mean stitch, where it was measured.

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> garter = choose(StitchChart.of_fabric("garter", 31, 31), material("acrylic"))
    >>> round(garter.modulus_course_n_per_mm, 3), round(garter.modulus_wale_n_per_mm, 3)
    (0.223, 0.056)
    >>> choose(StitchChart.parse("KKPP"), material("acrylic")).provenance
    <Source.COMPOSITE_OF_SIZE: 'composite with known size'>
    """
    repeat = Repeat.of(chart)
    answer = known(repeat, material, gauge)
    if answer is None:
        answer = corrected(composite(repeat, material), repeat, material, known, composite)
    return answer if gauge is None else answer.with_size(gauge)


def known(repeat: Repeat, material: Material, gauge: RelaxedSize | None = None) -> Answer | None:
    """The answer of a repeat that is known by itself, or None."""
    if repeat.fabric is not None:
        return measured(repeat.fabric, material)
    if repeat.layout is not None:
        size = gauge or known_size(repeat, material)
        return None if size is None else folded(repeat, material, size)
    return swept(repeat, material)
