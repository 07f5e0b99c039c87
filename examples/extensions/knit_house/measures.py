"""Measures of the house."""

import math

import numpy as np

from knitcore.chart import StitchChart
from knitcore.fabric import PHASES
from knitcore.materials import Material
from knitcore.phases import quarter_phases
from knitcore.prediction.measures import Measure
from knitcore.prediction.prediction import Prediction


def measures() -> list[Measure]:
    """What the house tells its customers of a cloth."""
    return [
        Measure("stitches-per-cm2", "1/cm²", "Stitches in a square centimetre at rest.", _density),
        Measure("cover-factor", "", "Area of the yarn over that of its stitch at rest.", _cover),
    ]


def _density(chart: StitchChart, material: Material, answer: Prediction) -> float:
    del chart, material
    return 100.0 / (answer.relaxed_course_mm * answer.relaxed_wale_mm)


def _cover(chart: StitchChart, material: Material, answer: Prediction) -> float:
    """Loop length times diameter over the area of a stitch; NaN where one is not known."""
    counts = np.bincount(quarter_phases(chart).ravel(), minlength=len(PHASES))
    yarn_mm2 = 0.0
    for fabric, count in zip(PHASES, counts / counts.sum(), strict=True):
        if count:
            loop = material.record(fabric).loop_length_mm
            diameter = material.yarn_diameter_mm(fabric)
            yarn_mm2 += count * (math.nan if None in (loop, diameter) else loop * diameter)
    return yarn_mm2 / (answer.relaxed_course_mm * answer.relaxed_wale_mm)
