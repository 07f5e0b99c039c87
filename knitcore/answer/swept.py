"""Repeats that were relaxed and stretched on the yarn level, scaled to a measured material.

The yarn level has no friction and an idealised yarn: its moduli of the pure fabrics differ from the
measured ones by up to a factor of two. Comparing a repeat's yarn-level law with measured fabrics
would then compare the models, not the stitches. So each constant is multiplied by the factor that
takes the pure fabrics of the same yarn-level model to their measurements: the geometric mean over
the repeat's phases, weighted by their shares. A pure fabric gets its measured moduli back.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from knitcore.answer.answer import Answer, Source
from knitcore.answer.relaxed import RelaxedSize
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import PHASES, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import Material
from knitcore.materials.uncertainty import MODEL_POISSON_SD, YARN_LEVEL_LOG_SD, LawUncertainty
from knitcore.phases import quarter_phases, reference_fabric

NO_FRICTION = "The yarn level has no friction or set: draw-in is probably exaggerated."
SIZE_LOG_SD = 0.10
"""Standard deviation of the logarithm of a yarn-level size: its branches differ by that."""


def swept_answer(
    law: ConstitutiveLaw,
    cell_mm: tuple[float, float],
    pure: Mapping[Fabric, ConstitutiveLaw],
    reference_mm: tuple[float, float],
    repeat: StitchChart,
    material: Material,
) -> Answer:
    """Answer from a sweep of this repeat itself.

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
    record = material.record(reference_fabric(repeat))
    size = RelaxedSize(
        cell_mm[0] / reference_mm[0] * record.stitch_course_mm,
        cell_mm[1] / reference_mm[1] * record.stitch_wale_mm,
        SIZE_LOG_SD,
    )
    return Answer.of_law(
        law_in_material(law, pure, repeat, material),
        size,
        spread=LawUncertainty(
            YARN_LEVEL_LOG_SD, YARN_LEVEL_LOG_SD, MODEL_POISSON_SD, MODEL_POISSON_SD, "yarn level"
        ),
        provenance=Source.SWEPT,
        method="law fitted to a yarn-level stretch of this repeat",
        relaxed_source="yarn level",
        notes=(NO_FRICTION,),
    )


def law_in_material(
    law: ConstitutiveLaw,
    pure: Mapping[Fabric, ConstitutiveLaw],
    repeat: StitchChart,
    material: Material,
) -> ConstitutiveLaw:
    """The law of a repeat, scaled to the measured material.

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
    >>> from knitcore.materials import material
    >>> simulated, measured = material("acrylic:simulation"), material("acrylic:published")
    >>> laws = {fabric: simulated.law(fabric) for fabric in Fabric}
    >>> rib = StitchChart.parse("KP")
    >>> round(law_in_material(laws[Fabric.RIB], laws, rib, measured).modulus_wale, 3)
    0.119
    """
    logs = dict.fromkeys(("modulus_course", "modulus_wale", *_STIFFENING), 0.0)
    kappa = dict.fromkeys(("kappa_xx", "kappa_yy"), 0.0)
    counts = np.bincount(quarter_phases(repeat, periodic=True).ravel(), minlength=4)
    for phase in np.flatnonzero(counts):
        fabric, share = PHASES[phase], float(counts[phase] / counts.sum())
        if fabric not in pure:
            raise InputError(
                "pure", f"lacks {fabric}, a phase of the repeat.", "Sweep that pure fabric too."
            )
        measured, modelled = material.law(fabric), pure[fabric]
        for name in logs:
            have, need = getattr(modelled, name), getattr(measured, name)
            # A constant that is 0 in either (no stiffening) has no ratio: it is left as it is.
            if have > 0 and need > 0:
                logs[name] += share * math.log(need / have)
        for name in kappa:
            kappa[name] += share * getattr(measured, name)
    course, wale = math.exp(logs["modulus_course"]), math.exp(logs["modulus_wale"])
    coupling = math.sqrt(course * wale)
    return replace(
        law,
        stiffness_xxxx=law.stiffness_xxxx * course,
        stiffness_yyyy=law.stiffness_yyyy * wale,
        stiffness_xxyy=law.stiffness_xxyy * coupling,
        stiffness_yyxx=law.stiffness_yyxx * coupling,
        **{name: getattr(law, name) * math.exp(logs[name]) for name in _STIFFENING},
        **kappa,
    )


_STIFFENING = ("alpha_xx", "alpha_yy", "beta_xx", "beta_yy")
