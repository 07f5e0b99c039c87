"""A material of an estimate, to save and to design with."""

import math

from knitcore.chart.fabric import Direction
from knitcore.materials import FabricRecord, LawUncertainty, Material, Origin, Yarn
from knitcore.materials.estimate.estimate import FabricEstimate, YarnEstimate
from knitcore.materials.law_uncertainty import Z_SCORE

MEASURED_LOG_SD = 0.1
"""Relative standard deviation of the moduli of a measured swatch: the paper's median."""


def estimated_material(estimate: YarnEstimate, identifier: str, name: str = "") -> Material:
    """The material of an estimate; its intervals become the uncertainty of its laws.

    Parameters
    ----------
    estimate : of :func:`knitcore.materials.estimate.estimate.estimate_yarn`.
    identifier : by which commands and files refer to it.
    name : for people; the identifier if left out.
    """
    return Material(
        identifier,
        name or identifier,
        Yarn(bending_modulus_n_mm2=estimate.bending_modulus_n_mm2),
        {
            fabric: _record(fabric_estimate, estimate.product_setting)
            for fabric, fabric_estimate in estimate.fabrics.items()
        },
        note="Estimated from the library's yarns: see the intervals of `knitcore estimate`.",
    )


def _record(estimate: FabricEstimate, setting: str) -> FabricRecord:
    deviations = {
        d: MEASURED_LOG_SD
        if estimate.measured
        else math.log(estimate.modulus[d].high / estimate.modulus[d].value) / Z_SCORE
        for d in Direction
    }
    return FabricRecord(
        fabric=estimate.fabric,
        law=estimate.law,
        stitch_course_mm=estimate.stitch_course_mm,
        stitch_wale_mm=estimate.stitch_wale_mm,
        stitch_size_source="the library's mean proportion of stitch to loop length",
        uncertainty=LawUncertainty(
            log_modulus_course=deviations[Direction.COURSE],
            log_modulus_wale=deviations[Direction.WALE],
            poisson_yx=0.02 if estimate.measured else 0.1,
            poisson_xy=0.02 if estimate.measured else 0.2,
            source="assumed: the paper's median"
            if estimate.measured
            else "yarns of the library left out",
        ),
        origin=Origin.FITTED if estimate.measured else Origin.ESTIMATED,
        loop_length_mm=estimate.loop_length_mm,
        setting=setting,
        measured=estimate.curves,
    )
