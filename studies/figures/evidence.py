"""Draw the charts of docs/evidence.md from the numbers that ``studies.evidence`` writes."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction, Fabric
from knitcore.materials import Interval, material
from knitcore.materials.law_uncertainty import Z_SCORE, log_interval
from knitcore.measure.bending_modulus import MeasuredBending
from knitcore.measure.compression import CompressionSample
from studies.figures.plot import (
    FABRICS,
    INKS,
    MUTED,
    PALE,
    chart,
    columns,
    diagonal,
    level,
    logarithmic,
    name_fabrics,
    save,
)
from studies.true_to_tests import LeftOut, Row

Test = tuple[Fabric, Direction]
WITHIN = np.array([0.3, 0.5, 0.7])
"""Places of three stresses within a test's column."""


def left_out_pulls(pulls: Sequence[LeftOut]) -> None:
    """Simulated over measured force of pulls predicted from the others."""
    tests = list(dict.fromkeys((pull.fabric, pull.direction) for pull in pulls))
    axes = _by_test(tests, "simulated / measured force")
    level(axes, 1.0)
    for place, (fabric, direction) in enumerate(tests):
        sd = float(material("acrylic").record(fabric).uncertainty.log_stress(direction, 0.1))
        low, high = np.exp([-Z_SCORE * sd, Z_SCORE * sd])
        axes.bar(place + 0.5, high - low, 0.6, low, color=PALE, alpha=0.5)
        rows = [p.other_sample[0] for p in pulls if (p.fabric, p.direction) == (fabric, direction)]
        axes.plot(place + WITHIN, np.transpose(rows), "o", color=FABRICS[fabric])
    save(axes, "left-out-pulls")


def waists(published: Mapping[Test, Row], refitted: Mapping[Test, Row]) -> None:
    """Simulated less measured waist of the eight tests at the three stresses, by both laws."""
    axes = _by_test(list(refitted), "simulated − measured waist strain")
    level(axes, 0.0)
    for place, test in enumerate(refitted):
        axes.plot(place + WITHIN, published[test][1], "o", color=MUTED, fillstyle="none")
        axes.plot(place + WITHIN, refitted[test][1], "o", color=FABRICS[test[0]])
    axes.plot([], [], "o", color=MUTED, fillstyle="none", label="published laws")
    axes.plot([], [], "o", color=MUTED, label="refitted laws, in the fabric's colour")
    axes.legend()
    save(axes, "evidence-waists")


def pressures(rows: Sequence[tuple[Fabric, Interval, Interval]]) -> None:
    """Pressure by the measured force, against the predicted interval, mmHg."""
    top = 80.0
    axes = chart("by the measured force, mmHg", "predicted, mmHg", xlim=(0, top), ylim=(0, top))
    diagonal(axes)
    for fabric, measured, predicted in rows:
        middle = (measured.low + measured.high) / 2
        axes.plot([middle] * 2, [predicted.low, predicted.high], color=FABRICS[fabric])
        level_mmhg = np.sqrt(predicted.low * predicted.high)
        axes.plot([measured.low, measured.high], [level_mmhg] * 2, color=FABRICS[fabric])
    name_fabrics(axes)
    save(axes, "evidence-pressure")


def moduli() -> None:
    """Young's moduli of acrylic, refitted with their intervals against published."""
    axes = chart("published modulus, N/mm", "refitted modulus, N/mm")
    logarithmic(axes, (0.003, 0.01, 0.03, 0.1, 0.3, 1), (0.003, 0.01, 0.03, 0.1, 0.3, 1))
    diagonal(axes)
    old, new = material("acrylic:published"), material("acrylic")
    markers = dict(zip(Direction, "os", strict=True))
    for fabric in Fabric:
        for direction in Direction:
            record, x = new.record(fabric), old.law(fabric).modulus(direction)
            value = record.law.modulus(direction)
            ends = log_interval(value, record.uncertainty.log_modulus(direction))
            axes.plot([x, x], [ends.low, ends.high], color=FABRICS[fabric], linewidth=1.2)
            axes.plot(x, value, markers[direction], color=FABRICS[fabric])
    dots = [
        axes.plot([], [], marker, color=MUTED, label=f"{direction}-wise")[0]
        for direction, marker in markers.items()
    ]
    name_fabrics(axes, *dots)
    save(axes, "evidence-moduli")


def field(rows: Mapping[str, Sequence[float]], stretch: Sequence[float], noise: float) -> None:
    """Differences of the displacements across the pull, in percent of the width."""
    axes = chart("stretch", "u_x, rms in % of the width", ylim=(0, 1))
    for name, values in rows.items():
        axes.plot(stretch, values, "o-", label=name)
    axes.axhline(noise, color=MUTED, linestyle="--", linewidth=1, label="left against right")
    axes.legend()
    save(axes, "evidence-field")


def shear(ratios: Mapping[str, Array], at: Array) -> None:
    """Simulated over measured force of the bias strip: (assumptions, strains) by law."""
    axes = chart("strain", "simulated / measured force", xlim=(0, 0.35), ylim=(0, 1.6))
    level(axes, 1.0)
    for (name, values), colour in zip(ratios.items(), INKS, strict=False):
        for row in values:
            axes.plot(at, row, color=colour, linewidth=1.2)
        axes.plot([], [], color=colour, label=name)
    axes.legend(loc="lower left")
    save(axes, "evidence-shear")


def side_by_side(bands: Mapping[str, Array], at: Array) -> None:
    """Least and greatest force of the strip of two halves, N: (2, strains) measured, simulated."""
    axes = chart("strain", "force, N")
    for (name, (low, high)), colour in zip(bands.items(), INKS, strict=False):
        axes.fill_between(at, low, high, color=colour, alpha=0.15, linewidth=0)
        axes.plot(at, low, color=colour, linewidth=1.2, label=name)
        axes.plot(at, high, color=colour, linewidth=1.2)
    axes.set(xlim=(0, 0.32), ylim=(0, None))
    axes.legend()
    save(axes, "evidence-loop-length")


def relaxed_sizes(true: Array, predicted: Array, log_sd: Array) -> None:
    """Logarithms of widths and heights (swatches, 2) over those of stockinette."""
    axes = chart("knitted / stockinette", "predicted / stockinette")
    axes.set(xlim=(0.5, 1.7), ylim=(0.5, 1.7))
    diagonal(axes)
    for axis, (name, colour) in enumerate(zip(("width", "height"), INKS, strict=False)):
        knitted, expected = np.exp(true[:, axis]), np.exp(predicted[:, axis])
        factor = np.exp(Z_SCORE * log_sd[:, axis])
        axes.vlines(knitted, expected / factor, expected * factor, colour, linewidth=1, alpha=0.4)
        axes.plot(knitted, expected, "o", color=colour, label=name)
    axes.legend()
    save(axes, "evidence-relaxed-sizes")


def yarn_models(errors: Mapping[str, Array]) -> None:
    """Simulated over knitted values, and the intervals that the models state."""
    axes = columns([name.replace(", ", ",\n") for name in errors], "simulated / knitted")
    axes.set(yscale="log", ylim=(0.1, 10))
    axes.set_yticks([0.1, 0.3, 1, 3, 10], ["0.1", "0.3", "1", "3", "10"])
    axes.minorticks_off()
    level(axes, 1.0)
    for place, (logs, colour) in enumerate(zip(errors.values(), INKS, strict=False)):
        half = Z_SCORE * float(np.sqrt(np.mean(logs**2)))
        low, high = np.exp([-half, half])
        axes.bar(place + 0.5, high - low, 0.8, low, color=PALE, alpha=0.5)
        spread = place + np.linspace(0.3, 0.7, logs.size)
        axes.plot(spread, np.exp(logs.ravel()), "o", color=colour)
    save(axes, "evidence-yarn-models")


def bending(measured: MeasuredBending, paper_n_mm2: float) -> None:
    """Bending modulus of every photo over the hanging length."""
    axes = chart("hanging length, mm", "B, mN·mm²", xlim=(0, 300), ylim=(0, 80))
    lengths = [photo.length_mm for photo in measured.photos]
    values = [1000 * photo.bending_modulus_n_mm2 for photo in measured.photos]
    axes.plot(lengths, values, "o", label="photos")
    axes.axhline(1000 * paper_n_mm2, color=MUTED, linestyle="--", linewidth=1, label="paper")
    axes.legend(loc="lower left")
    save(axes, "evidence-bending")


def compression(
    samples: Sequence[CompressionSample], paper: Mapping[str, tuple[float, float]]
) -> None:
    """Stiffness and exponent of every sample, and the paper's, by yarn."""
    axes = chart("k, mN/mm³", "p", xscale="log", ylim=(1.5, 4))
    for (yarn, (k, p)), colour in zip(paper.items(), INKS, strict=False):
        own = [sample for sample in samples if sample.yarn == yarn]
        stiffness = [1000 * sample.k_n_per_mm3 for sample in own]
        axes.plot(stiffness, [sample.p for sample in own], "o", color=colour, label=yarn)
        axes.plot(k, p, "x", color=colour, markersize=8)
    axes.plot([], [], "x", color=MUTED, label="paper")
    axes.set_xticks([0.1, 1, 10, 100], ["0.1", "1", "10", "100"])
    axes.legend()
    save(axes, "evidence-compression")


def _by_test(tests: Sequence[Test], y_label: str) -> Axes:
    """Axes with a column for each test."""
    return columns([f"{fabric}\n{direction}-wise" for fabric, direction in tests], y_label)
