"""Draw the figures of the mechanics pages: python docs/figures/draw_mechanics.py [FOLDER]."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from knitcore import StitchChart, predict
from knitcore.fabric import Direction, Fabric
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import material
from knitcore.mechanics.reduced_symmetry import MATERIALS, rs_fabrics

COLOURS = {"stockinette": "#2f6fb7", "garter": "#d9822b", "rib": "#3a9a5c", "seed": "#8a56b0"}
WIDTH, HEIGHT, LEFT, BOTTOM, TOP, RIGHT = 380, 296, 52, 44, 44, 12


@dataclass
class Axes:
    """Axes of one panel; draws as SVG."""

    title: str
    x_label: str
    y_label: str
    x_ticks: Sequence[float]
    y_ticks: Sequence[float]
    log: bool = False

    def __post_init__(self) -> None:
        self._marks: list[str] = []
        self._legend: list[str] = []

    def _place(self, x: ArrayLike, y: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        def share(value: ArrayLike, ticks: Sequence[float]) -> np.ndarray:
            scale = np.log if self.log else np.asarray
            low, high = scale(ticks[0]), scale(ticks[-1])
            return (scale(np.asarray(value, dtype=float)) - low) / (high - low)

        return (
            LEFT + share(x, self.x_ticks) * (WIDTH - LEFT - RIGHT),
            HEIGHT - BOTTOM - share(y, self.y_ticks) * (HEIGHT - BOTTOM - TOP),
        )

    def line(self, x: ArrayLike, y: ArrayLike, colour: str, name: str = "", dash: str = "") -> None:
        px, py = self._place(x, y)
        inside = (py >= TOP) & (px <= WIDTH - RIGHT + 1)
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(px[inside], py[inside], strict=True))
        style = f' stroke-dasharray="{dash}"' if dash else ""
        self._marks.append(
            f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"{style}/>'
        )
        if name:
            self._legend.append(f'<tspan fill="{colour}" dx="12">{name}</tspan>')

    def dot(self, x: float, y: float, colour: str, filled: bool) -> None:
        px, py = self._place([x], [y])
        fill = colour if filled else "#fff"
        self._marks.append(
            f'<circle cx="{px[0]:.1f}" cy="{py[0]:.1f}" r="5" fill="{fill}" stroke="{colour}" '
            'stroke-width="2"/>'
        )

    def svg(self, offset: int) -> str:
        right, base = WIDTH - RIGHT, HEIGHT - BOTTOM
        parts = [f'<text x="{LEFT}" y="16" font-weight="600">{self.title}</text>']
        parts.append(f'<text x="{LEFT - 12}" y="34">{"".join(self._legend)}</text>')
        for tick in self.x_ticks:
            (x,), _ = self._place([tick], [self.y_ticks[0]])
            parts.append(f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{TOP}" y2="{base}" stroke="#ddd"/>')
            parts.append(f'<text x="{x:.1f}" y="{base + 16}" text-anchor="middle">{tick:g}</text>')
        for tick in self.y_ticks:
            _, (y,) = self._place([self.x_ticks[0]], [tick])
            parts.append(
                f'<line x1="{LEFT}" x2="{right}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>'
            )
            parts.append(f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{tick:g}</text>')
        middle = (LEFT + right) / 2
        parts.append(
            f'<text x="{middle}" y="{HEIGHT - 8}" text-anchor="middle">{self.x_label}</text>'
        )
        parts.append(
            f'<text transform="translate(13 {(TOP + base) / 2}) rotate(-90)" '
            f'text-anchor="middle">{self.y_label}</text>'
        )
        return f'<g transform="translate({offset} 0)">{"".join(parts + self._marks)}</g>'


def page(*panels: Axes) -> str:
    """Panels side by side."""
    width = WIDTH * len(panels)
    body = "".join(panel.svg(WIDTH * i) for i, panel in enumerate(panels))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {HEIGHT}" width="{width}" '
        f'font-family="system-ui, sans-serif" font-size="13" fill="#333">'
        f'<rect width="{width}" height="{HEIGHT}" fill="#fff"/>{body}</svg>\n'
    )


def laws() -> str:
    """Stress against strain of the four acrylic fabrics."""
    panels = []
    stress = np.linspace(0, 0.3, 200)
    for direction, ticks in (
        (Direction.COURSE, (0, 0.5, 1, 1.5, 2, 2.5)),
        (Direction.WALE, (0, 0.25, 0.5, 0.75, 1, 1.25, 1.5)),
    ):
        axes = Axes(
            f"acrylic, pulled {direction}-wise", "strain", "stress, N/mm", ticks, (0, 0.1, 0.2, 0.3)
        )
        for fabric in Fabric:
            law = material("acrylic").law(fabric)
            strain = free_strains_at_stress(law, direction, stress)
            axes.line(strain, stress, COLOURS[fabric], fabric)
        panels.append(axes)
    return page(*panels)


def reduced_symmetry() -> str:
    """Computed against published moduli; even filled, odd open."""
    ticks = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
    axes = Axes(
        "RS moduli (filled: even)", "published, N/mm", "computed, N/mm", ticks, ticks, log=True
    )
    axes.line((0.02, 1), (0.02, 1), "#888", dash="4 4")
    for yarn in MATERIALS:
        for fabric, found in rs_fabrics(yarn).items():
            for direction in Direction:
                part = found.segment(direction)
                assert part.published_n_per_mm is not None
                even = part.geometry.parity == "even"
                axes.dot(part.published_n_per_mm, part.modulus_n_per_mm, COLOURS[fabric], even)
    return page(axes)


def wide_rib() -> str:
    """Width and strain of 2x2 rib against stress."""
    acrylic, stress = material("acrylic"), np.linspace(0, 0.2, 200)
    wide, narrow = (predict(StitchChart.parse(t), acrylic).course for t in ("KKPP", "KP"))
    ticks = (0, 0.05, 0.1, 0.15, 0.2)
    width = Axes("width of a stitch, acrylic", "stress, N/mm", "mm", ticks, (0, 2, 4, 6, 8))
    strain = Axes("strain course-wise", "stress, N/mm", "strain", ticks, (0, 1, 2, 3))
    for along, colour, name, dash in (
        (wide, COLOURS["rib"], "2×2 rib", None),
        (narrow, "#444", "1×1 rib", "5 4"),
    ):
        at = along.strain(stress)
        width.line(stress, along.relaxed_mm * (1 + at), colour, name, dash=dash)
        strain.line(stress, at, colour, name, dash=dash)
    return page(width, strain)


def continuity() -> str:
    """Strain of charts that change little by little, in acrylic at 0.05 N/mm."""
    acrylic, sides = material("acrylic"), np.array([2, 3, 4, 6, 8, 12, 16])
    purls = Axes(
        "one purl in so many knits",
        "stitches",
        "strain",
        (4, 16, 64, 256),
        (0.05, 0.1, 0.2, 0.5, 1),
        log=True,
    )
    ribs = Axes("n × n rib and n-row welts", "n", "strain", (1, 4, 8, 12), (0, 0.5, 1, 1.5))
    for direction, colour in (
        (Direction.COURSE, COLOURS["rib"]),
        (Direction.WALE, COLOURS["seed"]),
    ):
        strains = []
        for side in sides:
            purl = np.zeros((side, side), dtype=bool)
            purl[0, 0] = True
            strains.append(predict(StitchChart(purl), acrylic).along(direction).strain(0.05))
        purls.line(sides**2, strains, colour, f"{direction}-wise")
        runs = np.arange(1, 13)
        texts = ["K" * n + "P" * n for n in runs]
        if direction is Direction.WALE:
            texts = ["/".join(text) for text in texts]
        found = [
            predict(StitchChart.parse(t), acrylic).along(direction).strain(0.05) for t in texts
        ]
        name = "ribs, course-wise" if direction is Direction.COURSE else "welts, wale-wise"
        ribs.line(runs, found, colour, name)
    return page(purls, ribs)


FIGURES = {
    "laws.svg": laws,
    "reduced-symmetry.svg": reduced_symmetry,
    "wide-rib.svg": wide_rib,
    "continuity.svg": continuity,
}


def main(folder: Path) -> None:
    """Write all figures."""
    for name, draw in FIGURES.items():
        (folder / name).write_text(draw(), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
