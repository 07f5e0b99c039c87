"""Repeats that were relaxed and stretched on the yarn level, as a measured material has them.

The yarn level has no friction and an idealised yarn: its moduli of the pure fabrics miss the
measured ones by up to a factor of two. Set beside measured fabrics, a repeat's law from there would
then compare the models, not the stitches. So each constant is multiplied by what the pure fabrics
of the same yarn-level model need to meet the measurement: the geometric mean over the repeat's
phases, weighted by their shares. A pure fabric gets its measured moduli back.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from knitcore.answer.answer import Answer, Source
from knitcore.answer.relaxed import RelaxedSize, SizeSource, stored_pure
from knitcore.answer.repeat import Repeat
from knitcore.errors import InputError
from knitcore.fabric import Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import Material
from knitcore.materials.uncertainty import MODEL_POISSON_SD, YARN_LEVEL_LOG_SD
from knitcore.phases import reference_fabric
from knitcore.yarnlibrary.store import MATERIALS, stored_stitch

NO_FRICTION = "The yarn level has no friction or set: draw-in is probably exaggerated."
JUMPS = (
    "Stretched on the yarn level, the folds of this repeat open abruptly; its law is a smooth "
    "curve through that."
)
MOST_STITCHES = 16
"""Larger repeats are not in the store, and not looked for."""


def swept(repeat: Repeat, material: Material) -> Answer | None:
    """What the packaged store knows of a repeat, or None.

    Ribs and welts are left to :mod:`knitcore.answer.folded`, which was checked against sweeps more
    closely.

    Examples
    --------
    >>> from knitcore.chart import StitchChart
    >>> from knitcore.materials import material
    >>> basket = Repeat.of(StitchChart.parse("KKPP\\nKKPP\\nPPKK\\nPPKK"))
    >>> found = swept(basket, material("acrylic"))
    >>> found is not None and found.course.modulus_n_per_mm < 0.05  # it unfolds
    True
    """
    chart = repeat.chart
    if (
        material.identifier not in MATERIALS
        or chart.rows * chart.columns > MOST_STITCHES
        or repeat.layout is not None
        or repeat.fabric is not None
    ):
        return None
    stored = stored_stitch(chart, material.identifier)
    if stored is None or stored.law is None or not stored.converged:
        return None
    pure = {fabric: stored_pure(fabric, material.identifier) for fabric in Fabric}
    laws = {f: s.law for f, s in pure.items() if s is not None and s.law is not None}
    reference = pure[reference_fabric(chart)]
    if reference is None or any(fabric not in laws for fabric in repeat.present):
        return None
    notes = (NO_FRICTION, JUMPS) if any(stored.law_jumps) else (NO_FRICTION,)
    return swept_answer(
        stored.law,
        (stored.cell_course_mm, stored.cell_wale_mm),
        laws,
        (reference.cell_course_mm, reference.cell_wale_mm),
        repeat,
        material,
        notes,
    )


def swept_answer(
    law: ConstitutiveLaw,
    cell_mm: tuple[float, float],
    pure: Mapping[Fabric, ConstitutiveLaw],
    reference_mm: tuple[float, float],
    repeat: Repeat,
    material: Material,
    notes: tuple[str, ...] = (NO_FRICTION,),
) -> Answer:
    """The answer of a sweep of this very repeat.

    Parameters
    ----------
    law : fitted to the sweep.
    cell_mm : width and height of the relaxed mean stitch.
    pure : laws of the pure fabrics from the same yarn-level model and yarn.
    reference_mm : the same size of the pure fabric that the repeat resembles.

    Raises
    ------
    InputError
        If a phase of the repeat is missing in ``pure`` or in the material.
    """
    record = material.record(reference_fabric(repeat.chart))
    size = RelaxedSize(
        cell_mm[0] / reference_mm[0] * record.stitch_course_mm,
        cell_mm[1] / reference_mm[1] * record.stitch_wale_mm,
        SizeSource.YARN_LEVEL,
    )
    return Answer.of_law(
        law_in_material(law, pure, repeat, material),
        size,
        log_sd=(YARN_LEVEL_LOG_SD, YARN_LEVEL_LOG_SD),
        poisson_sd=(MODEL_POISSON_SD, MODEL_POISSON_SD),
        provenance=Source.SWEPT,
        method="law fitted to a yarn-level stretch of this repeat",
        notes=notes,
    )


def law_in_material(
    law: ConstitutiveLaw,
    pure: Mapping[Fabric, ConstitutiveLaw],
    repeat: Repeat,
    material: Material,
) -> ConstitutiveLaw:
    """The law of a repeat as the measured material would have it.

    Parameters
    ----------
    law : fitted to a yarn-level sweep of the repeat.
    pure : laws of the pure fabrics from the same yarn-level model and yarn; at least the repeat's
        phases.

    Raises
    ------
    InputError
        If a phase of the repeat is missing in ``pure`` or in the material.

    Examples
    --------
    >>> from knitcore.chart import StitchChart
    >>> from knitcore.materials import material
    >>> simulated, measured = material("acrylic:simulation"), material("acrylic")
    >>> laws = {fabric: simulated.law(fabric) for fabric in Fabric}
    >>> rib = Repeat.of(StitchChart.parse("KP"))
    >>> round(law_in_material(laws[Fabric.RIB], laws, rib, measured).modulus_wale, 3)
    0.119
    """
    logs = dict.fromkeys(("modulus_course", "modulus_wale", *_STIFFENING), 0.0)
    for fabric in repeat.present:
        if fabric not in pure:
            raise InputError(
                "pure", f"lacks {fabric}, a phase of the repeat.", "Sweep that pure fabric too."
            )
        measured, modelled = material.law(fabric), pure[fabric]
        for name in logs:
            have, need = getattr(modelled, name), getattr(measured, name)
            # A constant that is 0 in either (no stiffening) has no ratio: it is left as it is.
            if have > 0 and need > 0:
                logs[name] += float(repeat.shares[fabric.phase]) * math.log(need / have)
    course, wale = math.exp(logs["modulus_course"]), math.exp(logs["modulus_wale"])
    coupling = math.sqrt(course * wale)
    return replace(
        law,
        stiffness_xxxx=law.stiffness_xxxx * course,
        stiffness_yyyy=law.stiffness_yyyy * wale,
        stiffness_xxyy=law.stiffness_xxyy * coupling,
        stiffness_yyxx=law.stiffness_yyxx * coupling,
        **{name: getattr(law, name) * math.exp(logs[name]) for name in _STIFFENING},
    )


_STIFFENING = ("alpha_xx", "alpha_yy", "beta_xx", "beta_yy")
