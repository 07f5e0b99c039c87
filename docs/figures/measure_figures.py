"""Draw the figures of the pages on fitting, measuring, estimating and pressure.

    python docs/figures/measure_figures.py

Everything is computed from the library or from made measurements; no measured data is needed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from knitcore.arrays import Array
from knitcore.estimate.mixed_model import leave_one_out
from knitcore.estimate.model import library_table, mask_of
from knitcore.fabric import Direction, Fabric
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials import material
from knitcore.measure.elastica import heavy_elastica
from knitcore.measure.law_fit import fit_direction
from knitcore.mechanics.pressure import limb_pressure

Numbers = Sequence[float] | Array

HERE = Path(__file__).parent
WIDTH, HEIGHT, MARGIN = 560, 360, 56
FONT = 13
COLOURS = {
    Fabric.STOCKINETTE: "#3b7dd8",
    Fabric.GARTER: "#e08a2c",
    Fabric.RIB: "#3c9d5c",
    Fabric.SEED: "#8a5cc2",
}


class Plot:
    """Lines and points in two axes, as SVG."""

    def __init__(
        self,
        x: tuple[float, float],
        y: tuple[float, float],
        labels: tuple[str, str],
        ticks: tuple[int, int] = (6, 6),
    ):
        self.x, self.y = x, y
        self.parts: list[str] = []
        self._frame(labels, ticks)

    def place(self, x: float, y: float) -> tuple[float, float]:
        (x0, x1), (y0, y1) = self.x, self.y
        return (
            MARGIN + (x - x0) / (x1 - x0) * (WIDTH - 1.5 * MARGIN),
            HEIGHT - MARGIN - (y - y0) / (y1 - y0) * (HEIGHT - 1.5 * MARGIN),
        )

    def line(
        self,
        xs: Numbers,
        ys: Numbers,
        colour: str,
        dash: str = "",
        width: float = 2,
        opacity: float = 1,
    ) -> None:
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in map(self.place, xs, ys))
        faint = "" if opacity == 1 else f' stroke-opacity="{opacity:g}"'
        self.parts.append(
            f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}"'
            f' stroke-dasharray="{dash}"{faint}/>'
        )

    def dots(self, xs: Numbers, ys: Numbers, colour: str, r: float = 2.5) -> None:
        for a, b in map(self.place, xs, ys):
            self.parts.append(f'<circle cx="{a:.1f}" cy="{b:.1f}" r="{r}" fill="{colour}"/>')

    def text(self, x: float, y: float, words: str, colour: str = "#777", size: int = FONT) -> None:
        a, b = self.place(x, y)
        font = "" if size == FONT else f' font-size="{size}"'
        self.parts.append(f'<text x="{a:.0f}" y="{b:.0f}" fill="{colour}"{font}>{words}</text>')

    def _frame(self, labels: tuple[str, str], ticks: tuple[int, int]) -> None:
        for axis, (low, high) in enumerate((self.x, self.y)):
            for value in np.linspace(low, high, ticks[axis]):
                at = (value, self.y[0]) if axis == 0 else (self.x[0], value)
                a, b = self.place(*at)
                dx, dy, anchor = (0, 18, "middle") if axis == 0 else (-8, 4, "end")
                self.parts.append(
                    f'<text x="{a + dx:.0f}" y="{b + dy:.0f}" text-anchor="{anchor}"'
                    f' fill="#777">{value:.3g}</text>'
                )
        (a0, b0), (a1, b1) = self.place(self.x[0], self.y[0]), self.place(self.x[1], self.y[1])
        self.parts.append(f'<path d="M{a0} {b1}V{b0}H{a1}" fill="none" stroke="#777"/>')
        self.parts.append(
            f'<text x="{(a0 + a1) / 2}" y="{HEIGHT - 12}" text-anchor="middle" fill="#777">'
            f"{labels[0]}</text>"
            f'<text x="{MARGIN}" y="{b1 - 12}" fill="#777">{labels[1]}</text>'
        )

    def save(self, name: str) -> None:
        body = "\n".join(self.parts)
        (HERE / name).write_text(
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}"'
            f' font-family="system-ui, sans-serif" font-size="{FONT}">\n{body}\n</svg>\n'
        )


def fit() -> None:
    """A made test of acrylic garter with the noise of real ones (1.5 % of the peak)."""
    law = material("acrylic").law(Fabric.GARTER)
    random = np.random.default_rng(1)
    plot = Plot((0, 1.0), (0, 0.4), ("strain", "stress N/mm"))
    for direction, colour in zip(Direction, ("#3b7dd8", "#e08a2c"), strict=True):
        curve = uniaxial_response(
            law, direction, np.linspace(0, 0.7 * law.lock_up_strain(direction), 150)
        )
        stress = curve.stress + 0.015 * curve.stress.max() * random.normal(size=150)
        ratio = law.poisson_xy if direction is Direction.COURSE else law.poisson_yx
        found = fit_direction(curve.strain, curve.transverse_strain, stress, np.ones(150), ratio)
        fitted = found.stress(curve.strain, curve.transverse_strain, ratio)
        plot.dots(curve.strain, stress, colour, 1.8)
        plot.line(curve.strain, fitted, colour)
        plot.line(
            [0, curve.strain[-1]],
            [0, law.modulus(direction) * curve.strain[-1]],
            colour,
            "4 4",
        )
        plot.text(curve.strain[-1] + 0.01, float(fitted[-1]), str(direction), colour)
    plot.save("fit.svg")


def hanging_yarn() -> None:
    plot = Plot((0, 1.2), (-1, 0), ("distance from the clamp / L", "depth / L"))
    for load in (3, 10, 30, 100, 1000):
        _, x, y = heavy_elastica(load)
        plot.line(x, -y, "#3b7dd8")
        plot.text(float(x[-1]) + 0.01, -float(y[-1]) + 0.02, f"{load}")
    plot.text(0.72, -0.06, "Γ = w L³ / B beside the tip")
    plot.save("hanging-yarn.svg")


def left_out_moduli() -> None:
    """Predicted from one stockinette swatch against measured, all yarns left out in turn."""
    table = library_table()
    mask = mask_of((Fabric.STOCKINETTE,))
    predicted, _ = leave_one_out(table.modulus, mask)
    ten = math.log(10)
    plot = Plot((-3, 0), (-3, 0), ("measured Y, log10 N/mm", "predicted Y, log10 N/mm"))
    for shift, dash in ((0.0, ""), (math.log10(2), "4 4"), (-math.log10(2), "4 4")):
        low, high = max(-3, -3 - shift), min(0, -shift)
        plot.line([low, high], [low + shift, high + shift], "#999", dash)
    for i, fabric in enumerate(Fabric):
        if fabric is Fabric.STOCKINETTE:
            continue
        plot.dots(
            ((table.modulus + table.scale)[:, i] / ten).ravel(),
            ((predicted + table.scale)[:, i] / ten).ravel(),
            COLOURS[fabric],
            3.5,
        )
        plot.text(-2.9, -0.15 - 0.14 * i, str(fabric), COLOURS[fabric])
    plot.save("left-out.svg")


def pressure() -> None:
    law = material("glove-wool:glove").law(Fabric.STOCKINETTE)
    strains = np.linspace(0.005, 0.3, 60)
    found = [limb_pressure(law, Direction.WALE, 180 / (1 + e), 180) for e in strains]
    plot = Plot((0, 0.3), (0, 300), ("strain around the limb", "mmHg at C = 180 mm"))
    plot.line(strains, [p.mmhg.high for p in found], "#3b7dd8")
    plot.line(strains, [p.mmhg.low for p in found], "#3b7dd8", "6 3")
    force_over_area = [
        float(uniaxial_response(law, Direction.WALE, e).stress[0]) / 180 * 1000 * 7.50062
        for e in strains
    ]
    plot.line(strains, force_over_area, "#c0392b", "2 3")
    plot.text(0.08, 150, "axially fixed; dashed: free", "#3b7dd8")
    plot.text(0.23, 60, "force over area", "#c0392b")
    plot.save("pressure.svg")


if __name__ == "__main__":
    fit()
    hanging_yarn()
    left_out_moduli()
    pressure()
