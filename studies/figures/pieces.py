"""Draw the figure of docs/piece.md: ``python -m studies.figures.pieces``."""

import numpy as np
from matplotlib.collections import PolyCollection

from knitcore import StitchChart
from knitcore.cloth.cut import (
    Condition,
    CutPiece,
    Held,
    PieceTest,
    Pulled,
    Sewn,
    cloth_under,
    solve,
)
from knitcore.materials import material
from studies.figures.plot import MUTED, chart, save

LARGEST_SHEAR = 0.8
"""Change of the angle between rows and columns at the end of the scale, rad."""

PITCH_MM = 75.0


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
    conditions: list[Condition] = [Held("hem"), Pulled("top", y_n=1.5), Sewn("hole", 20.0)]
    return solve(piece, cloth, conditions, mesh_mm=5.0)


def main() -> None:
    """Draw each piece with its elements coloured by the shear of rows against columns."""
    tests = {f"rows at {angle}°": strip(angle) for angle in (0, 20, 45)}
    tests["notched, elastic\nround the hole"] = collar()
    axes = chart()
    for place, (title, test) in enumerate(tests.items()):
        assert test.converged, test.problem
        corners = test.corners_mm[-1].T - test.mesh.p.min(axis=1) + (PITCH_MM * place, 0)
        elements = PolyCollection(corners[test.mesh.t.T], cmap="Reds", edgecolor=MUTED)
        elements.set(
            array=np.abs(test.fields().shear_angle), clim=(0, LARGEST_SHEAR), linewidth=0.4
        )
        axes.add_collection(elements)
        axes.annotate(title, (corners[:, 0].mean(), -4), ha="center", va="top")
    axes.figure.colorbar(elements, ax=axes, label="shear of rows against columns, rad", shrink=0.8)
    axes.set(aspect="equal", xlim=(-10, None), ylim=(-25, None))
    axes.axis("off")
    save(axes, "pieces")


if __name__ == "__main__":
    main()
