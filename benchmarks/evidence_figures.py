"""Plots of docs/evidence.md, drawn by benchmarks/evidence.py from the numbers that it writes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from benchmarks.true_to_tests import LeftOut, Row
from docs.figures.measure_figures import COLOURS, Plot
from knitcore.fabric import Direction, Fabric
from knitcore.materials import Interval, material
from knitcore.materials.uncertainty import Z_SCORE, log_interval
from knitcore.measure.bending import MeasuredBending
from knitcore.measure.compression import CompressionSample

Array = NDArray[np.float64]
Test = tuple[Fabric, Direction]
INKS = ("#3b7dd8", "#e08a2c", "#3c9d5c", "#8a5cc2")
GREY = "#999"
"""Of what is drawn for comparison; seen on white and on black, like the others."""
BAND = 0.35
"""Opacity of intervals."""
SMALL = 9


def left_out_pulls(pulls: Sequence[LeftOut]) -> None:
    """Simulated over measured force of pulls predicted from the others."""
    tests = list(dict.fromkeys((pull.fabric, pull.direction) for pull in pulls))
    plot = _by_test(tests, (0.8, 1.2), "simulated / measured force")
    plot.line((0, len(tests)), (1, 1), GREY, "4")
    for place, key in enumerate(tests):
        sd = float(material("acrylic").record(key[0]).uncertainty.log_stress(key[1], 0.1))
        ends = np.exp([-Z_SCORE * sd, Z_SCORE * sd])
        plot.line([place + 0.5] * 2, ends.tolist(), GREY, width=34, opacity=BAND)
        rows = [p.other_sample[0] for p in pulls if (p.fabric, p.direction) == key]
        for shift, ratios in zip((0.3, 0.5, 0.7), np.transpose(rows), strict=True):
            known = ratios[np.isfinite(ratios)]
            plot.dots([place + shift] * len(known), known.tolist(), COLOURS[key[0]])
    plot.save("left-out-pulls.svg")


def waists(published: Mapping[Test, Row], refitted: Mapping[Test, Row]) -> None:
    """Simulated less measured waist of the eight tests at the three stresses, by both laws."""
    tests = list(refitted)
    plot = _by_test(tests, (-0.1, 0.3), "simulated − measured waist strain")
    plot.line((0, len(tests)), (0, 0), GREY, "4")
    for place, test in enumerate(tests):
        for rows, colour in ((published, GREY), (refitted, COLOURS[test[0]])):
            shifts = place + np.array([0.3, 0.5, 0.7])
            plot.dots(shifts.tolist(), rows[test][1].tolist(), colour, 3.5)
    plot.text(0.1, 0.28, "grey: published laws; in colour: refitted")
    plot.save("evidence-waists.svg")


def pressures(rows: Sequence[tuple[Fabric, Interval, Interval]]) -> None:
    """Pressure by the measured force, against the predicted interval, mmHg."""
    top = 80.0
    plot = Plot((0, top), (0, top), ("by the measured force, mmHg", "predicted, mmHg"), (5, 5))
    plot.line((0, top), (0, top), GREY, "4")
    for fabric, measured, predicted in rows:
        middle = (measured.low + measured.high) / 2
        plot.line([middle] * 2, [predicted.low, predicted.high], COLOURS[fabric], width=3)
        ends = [measured.low, measured.high]
        plot.line(ends, [np.sqrt(predicted.low * predicted.high)] * 2, COLOURS[fabric], width=3)
    _fabrics(plot, 3.0, 75.0, 4.5)
    plot.save("evidence-pressure.svg")


def moduli() -> None:
    """Young's moduli of acrylic, refitted with their intervals against published."""
    axes = ("published Y, log10 N/mm", "refitted Y, log10 N/mm")
    plot = Plot((-2.5, 0), (-2.5, 0), axes)
    plot.line((-2.5, 0), (-2.5, 0), GREY, "4")
    old, new = material("acrylic:published"), material("acrylic")
    for fabric in Fabric:
        for direction in Direction:
            record, x = new.record(fabric), np.log10(old.law(fabric).modulus(direction))
            value = record.law.modulus(direction)
            ends = log_interval(value, record.uncertainty.log_modulus(direction))
            plot.line([x, x], np.log10([ends.low, ends.high]).tolist(), COLOURS[fabric])
            plot.dots([x], [np.log10(value)], COLOURS[fabric], 3 + 2 * direction.axis)
    _fabrics(plot, -2.45, -0.1, 0.13)
    plot.text(-2.45, -0.65, "large dots: along the columns")
    plot.save("evidence-moduli.svg")


def field(rows: Mapping[str, Sequence[float]], stretch: Sequence[float], noise: float) -> None:
    """Differences of the displacements across the pull, in percent of the width."""
    plot = Plot((0, 0.9), (0, 1), ("stretch", "u_x, rms in % of the width"), (4, 6))
    plot.line((0, 0.5), (noise, noise), GREY, "4")
    plot.text(0.51, noise - 0.05, "left against right")
    for (name, values), colour in zip(rows.items(), INKS, strict=True):
        plot.line(stretch, values, colour)
        plot.dots(stretch, values, colour, 3.5)
        plot.text(stretch[-1] + 0.01, values[-1] + 0.01, name, colour)
    plot.save("evidence-field.svg")


def shear(ratios: Mapping[str, Array], at: Array) -> None:
    """Simulated over measured force of the bias strip: (assumptions, strains) by law."""
    plot = Plot((0, 0.35), (0, 1.6), ("strain", "simulated / measured force"), (8, 9))
    plot.line((0, 0.35), (1, 1), GREY, "4")
    for k, ((name, values), colour) in enumerate(zip(ratios.items(), INKS, strict=False)):
        for row in values:
            plot.line(at.tolist(), row.tolist(), colour, width=1.5)
        plot.text(0.01, 0.3 - 0.1 * k, name, colour)
    plot.save("evidence-shear.svg")


def side_by_side(bands: Mapping[str, Array], at: Array) -> None:
    """Least and greatest force of the strip of two halves, N: (2, strains) measured, simulated."""
    plot = Plot((0, 0.3), (0, 25), ("strain", "force, N"), (4, 6))
    for k, ((name, ends), colour) in enumerate(zip(bands.items(), INKS, strict=False)):
        for row in ends:
            plot.line(at.tolist(), row.tolist(), colour)
        plot.text(0.01, 23 - 1.6 * k, name, colour)
    plot.save("evidence-loop-length.svg")


def relaxed_sizes(true: Array, predicted: Array, log_sd: Array) -> None:
    """Logarithms of widths and heights (swatches, 2) over those of stockinette."""
    plot = Plot(
        (0.5, 1.7), (0.5, 1.7), ("knitted / stockinette", "predicted / stockinette"), (7, 7)
    )
    plot.line((0.5, 1.7), (0.5, 1.7), GREY, "4")
    for axis, (name, colour) in enumerate(zip(("width", "height"), INKS, strict=False)):
        for x, y, sd in zip(true[:, axis], predicted[:, axis], log_sd[:, axis], strict=True):
            ends = np.exp([y - Z_SCORE * sd, y + Z_SCORE * sd])
            plot.line([np.exp(x)] * 2, ends.tolist(), colour, width=1, opacity=BAND)
            plot.dots([np.exp(x)], [np.exp(y)], colour, 3.5)
        plot.text(0.52, 1.65 - 0.07 * axis, name, colour)
    plot.save("evidence-relaxed-sizes.svg")


def yarn_models(errors: Mapping[str, Array]) -> None:
    """Simulated over knitted values, and the intervals that the models state."""
    plot = Plot((0, len(errors)), (-1, 1), ("", "log10 simulated / knitted"), ticks=(0, 5))
    plot.line((0, len(errors)), (0, 0), GREY, "4")
    for place, ((name, logs), colour) in enumerate(zip(errors.items(), INKS, strict=False)):
        tens = np.ravel(logs) / np.log(10)
        half = Z_SCORE * float(np.sqrt(np.mean(tens**2)))
        plot.line([place + 0.5] * 2, [-half, half], GREY, width=90, opacity=BAND)
        spread = place + np.linspace(0.3, 0.7, tens.size)
        plot.dots(spread.tolist(), tens.tolist(), colour, 3)
        plot.text(place + 0.1, -1.12, name, size=SMALL)
    plot.save("evidence-yarn-models.svg")


def bending(found: MeasuredBending, paper_n_mm2: float) -> None:
    """Bending modulus of every photo over the hanging length."""
    plot = Plot((0, 300), (0, 80), ("hanging length, mm", "B, mN·mm²"), (4, 5))
    plot.line((0, 300), [1000 * paper_n_mm2] * 2, GREY, "4")
    plot.text(5, 1000 * paper_n_mm2 + 2, "paper")
    lengths = [photo.length_mm for photo in found.photos]
    values = [1000 * photo.bending_modulus_n_mm2 for photo in found.photos]
    plot.dots(lengths, values, INKS[0], 3.5)
    plot.save("evidence-bending.svg")


def compression(
    samples: Sequence[CompressionSample], paper: Mapping[str, tuple[float, float]]
) -> None:
    """Stiffness and exponent of every sample, and the paper's, by yarn."""
    plot = Plot((-1, 2), (1.5, 4), ("log10 k, mN/mm³", "p"), (4, 6))
    for place, ((yarn, (k, p)), colour) in enumerate(zip(paper.items(), INKS, strict=False)):
        own = [sample for sample in samples if sample.yarn == yarn]
        at = [float(np.log10(1000 * sample.k_n_per_mm3)) for sample in own]
        plot.dots(at, [sample.p for sample in own], colour, 3.5)
        plot.text(float(np.log10(k)) - 0.025, p - 0.04, "×", GREY)
        plot.text(-0.95, 3.9 - 0.15 * place, yarn, colour)
    plot.text(-0.95, 3.6, "×: paper")
    plot.save("evidence-compression.svg")


def _by_test(tests: Sequence[Test], span: tuple[float, float], label: str) -> Plot:
    """A plot with a column for each test."""
    plot = Plot((0, len(tests)), span, ("", label), ticks=(0, 5))
    height = span[1] - span[0]
    for place, (fabric, direction) in enumerate(tests):
        plot.text(place + 0.05, span[0] - 0.0625 * height, fabric, size=SMALL)
        plot.text(place + 0.05, span[0] - 0.1125 * height, f"{direction}-wise", size=SMALL)
    return plot


def _fabrics(plot: Plot, x: float, y: float, step: float) -> None:
    """The colours of the fabrics, from a place downwards."""
    for k, (fabric, colour) in enumerate(COLOURS.items()):
        plot.text(x, y - k * step, fabric, colour)
