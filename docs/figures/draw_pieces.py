"""Draw the figure of docs/piece.md: python docs/figures/draw_pieces.py [FOLDER]."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from knitcore import StitchChart
from knitcore.materials import material
from knitcore.piece import CutPiece, Held, PieceTest, Pulled, Sewn, cloth_under, solve

LOW, HIGH = np.array([247, 251, 255]), np.array([178, 24, 43])
SCALE, GAP, TOP, BOTTOM = 2.2, 30.0, 26.0, 44.0
"""Pixels per mm; pixels between pieces, above and below them."""


def strip(grain_deg: float) -> PieceTest:
    """A strip of stockinette pulled by 25 %."""
    piece = CutPiece.rectangle(40.0, 100.0, grain_deg=grain_deg)
    cloth = cloth_under(piece, StitchChart.parse("K"), material("acrylic"))
    return solve(piece, cloth, [Held("bottom"), Held("top", y_mm=25.0)], mesh_mm=5.0)


def collar() -> PieceTest:
    """A notched piece with a hole that an elastic is sewn on."""
    piece = CutPiece(
        [(0, 0), (60, 0), (60, 100), (30, 70), (0, 100)],
        holes=[[(20, 20), (40, 20), (40, 40), (20, 40)]],
        grain_deg=30.0,
        edges={"hem": (1,), "top": (3, 4), "hole": (6, 7, 8, 9)},
    )
    cloth = cloth_under(piece, StitchChart.parse("K"), material("acrylic"))
    conditions = [Held("hem"), Pulled("top", y_n=1.5), Sewn("hole", 20.0)]
    return solve(piece, cloth, conditions, mesh_mm=5.0)


def drawn(test: PieceTest, left: float, height: float, title: str) -> tuple[list[str], float]:
    """Elements coloured by how much the angle of rows and columns changes; the width taken."""
    at = test.corners_mm[-1]
    x = left + SCALE * (at[0] - min(at[0].min(), test.mesh.p[0].min()))
    y = TOP + height - SCALE * (at[1] - at[1].min())
    share = np.clip(np.abs(test.fields().shear_angle) / 0.8, 0, 1)[:, None]
    colours = (LOW + share * (HIGH - LOW)).astype(int)
    lines = []
    for element, (r, g, b) in zip(test.mesh.t.T, colours, strict=True):
        points = " ".join(f"{x[i]:.1f},{y[i]:.1f}" for i in element)
        lines.append(
            f'<polygon points="{points}" fill="rgb({r},{g},{b})" stroke="#777" stroke-width=".4"/>'
        )
    width = float(np.ptp(x))
    middle, below = left + width / 2, TOP + height + 18
    lines.append(f'<text x="{middle:.0f}" y="{below:.0f}" text-anchor="middle">{title}</text>')
    return lines, width


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    tests = {f"rows at {angle}°": strip(angle) for angle in (0, 20, 45)}
    tests["notched, elastic round the hole"] = collar()
    height = SCALE * max(np.ptp(test.corners_mm[-1][1]) for test in tests.values())
    lines, left = [], GAP
    for title, test in tests.items():
        assert test.converged, test.problem
        part, width = drawn(test, left, height, title)
        lines += part
        left += max(width, 110.0) + GAP
    legend = "white: rows and columns at right angles; red: sheared by 0.8 rad"
    size = f'width="{left:.0f}" height="{TOP + height + BOTTOM:.0f}"'
    style = 'font-family="sans-serif" font-size="12" fill="#333"'
    text = f'<text x="{GAP}" y="{TOP + height + 38:.0f}">{legend}</text>'
    svg = "\n".join(
        [f'<svg xmlns="http://www.w3.org/2000/svg" {size} {style}>', *lines, text, "</svg>"]
    )
    (folder / "pieces.svg").write_text(svg + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
