"""Draw the figures of the pages on mechanics: ``python -m studies.figures.mechanics``."""

from collections.abc import Iterable

import numpy as np

from knitcore import StitchChart, predict
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import material
from knitcore.mechanics.reduced_symmetry import MATERIALS, rs_fabrics
from studies.figures.plot import (
    FABRICS,
    INKS,
    MUTED,
    chart,
    diagonal,
    logarithmic,
    name_fabrics,
    panels,
    save,
)


def laws() -> None:
    """Stress against strain of the four acrylic fabrics."""
    both = panels(2)
    stress = np.linspace(0, 0.3, 60)
    for axes, direction in zip(both, Direction, strict=True):
        for fabric in Fabric:
            law = material("acrylic").law(fabric)
            strain = free_strains_at_stress(law, direction, stress)
            axes.plot(strain, stress, color=FABRICS[fabric], label=fabric)
        axes.set(title=f"acrylic, pulled {direction}-wise", xlabel="strain", ylabel="stress, N/mm")
        axes.set(xlim=(0, None), ylim=(0, 0.3))
    both[0].legend(loc="upper center")
    save(both[0], "laws")


def reduced_symmetry() -> None:
    """Computed against published moduli: even segments filled, odd ones open."""
    axes = chart("published modulus, N/mm", "computed modulus, N/mm")
    ticks = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
    logarithmic(axes, ticks, ticks)
    diagonal(axes)
    for yarn in MATERIALS:
        for fabric, moduli in rs_fabrics(yarn).items():
            for direction in Direction:
                segment = moduli.segment(direction)
                even = segment.geometry.parity == "even"
                if segment.published_n_per_mm is None:
                    continue
                axes.plot(
                    segment.published_n_per_mm,
                    segment.modulus_n_per_mm,
                    "o",
                    color=FABRICS[fabric],
                    fillstyle="full" if even else "none",
                    markersize=8,
                )
    dots = [
        axes.plot([], [], "o", color=MUTED, fillstyle=style, label=f"{parity} segments")[0]
        for style, parity in (("full", "even"), ("none", "odd"))
    ]
    name_fabrics(axes, *dots)
    save(axes, "reduced-symmetry")


def continuity() -> None:
    """Strain of charts that change little by little, in acrylic at 0.05 N/mm."""
    purls, ribs = panels(2)
    sides, runs = np.array([2, 3, 4, 6, 8, 12, 16]), np.arange(1, 13)
    purl = np.zeros((sides[-1], sides[-1]), dtype=bool)
    purl[0, 0] = True
    charts = [StitchChart(purl[:side, :side]) for side in sides]
    for direction, name, colour in zip(
        Direction, ("ribs, course-wise", "welts, wale-wise"), INKS, strict=False
    ):
        purls.plot(sides**2, _strains(charts, direction), color=colour, label=f"{direction}-wise")
        joined = "" if direction is Direction.COURSE else "/"
        texts = [joined.join("K" * n + "P" * n) for n in runs]
        ribs.plot(
            runs, _strains(map(StitchChart.parse, texts), direction), color=colour, label=name
        )
    purls.set(title="one purl among knits", xlabel="stitches of the repeat", ylabel="strain")
    logarithmic(purls, (4, 16, 64, 256), (0.05, 0.1, 0.2, 0.5, 1))
    ribs.set(title="n × n ribs and n-row welts", xlabel="n", ylabel="strain")
    ribs.set(xticks=[1, 4, 8, 12], ylim=(0, None))
    for axes in (purls, ribs):
        axes.legend(loc="upper right")
    save(purls, "continuity")


def _strains(charts: Iterable[StitchChart], direction: Direction) -> list[float]:
    acrylic = material("acrylic")
    return [float(predict(chart, acrylic).along(direction).strain(0.05)) for chart in charts]


if __name__ == "__main__":
    laws()
    reduced_symmetry()
    continuity()
