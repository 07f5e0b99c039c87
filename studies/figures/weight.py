"""Draw the tests with weight of ``docs/curl.md``: ``python -m studies.figures.weight``."""

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space.even_cloth import EvenCloth, cloth_of
from knitcore.cloth.space.hang import HungBy, hang
from knitcore.cloth.space.weighing import advice, drape, overhang
from knitcore.materials import material
from studies.figures.curl import FONT, IMAGES, SIDE, drawn, save

DENSITY_G_PER_M = 0.5
ACRYLIC = material("acrylic")


def main() -> None:
    """Write the picture."""
    pictures: dict[str, Image.Image] = {}
    for name, repeat in (("garter", "K/P"), ("seed", "KP/PK"), ("1x1 rib", "KP")):
        draped = drape(_cloth(repeat), across=40, starts=(6,))
        shape = draped.corners_mm.shape
        picture = drawn(draped.corners_mm, np.zeros((shape[0] - 1, shape[1] - 1), bool))
        pictures[f"{name} over a disc: {draped.coefficient:.0%}, {draped.folds} folds"] = picture
    for name, chart, by in (
        ("garter, by its corners", StitchChart.parse("K/P").tile(15, 30), HungBy.CORNERS),
        ("stockinette, by its edge", StitchChart.parse("K").tile(50, 20), HungBy.EDGE),
    ):
        hung = hang(chart, ACRYLIC, linear_density_g_per_m=DENSITY_G_PER_M, by=by)
        upright = hung.corners_mm[..., [0, 2, 1]] * (1.0, -1.0, 1.0)
        pictures[f"{name}: {hung.drop_mm:.0f} mm down"] = drawn(upright, chart.purl)
    lines = {}
    for name, repeat in (("garter", "K/P"), ("seed", "KP/PK"), ("1x1 rib", "KP")):
        strip = overhang(_cloth(repeat), 0)
        lines[f"{name} {strip.bending_length_mm:.0f} mm"] = strip.corners_mm[:, 1, ::2]
    pictures["strips at 41.5 degrees: bending length"] = _profiles(lines)
    lines = {}
    for name, repeat in (("garter", "K/P"), ("1x1 rib", "KP")):
        border = advice(_cloth("K"), _cloth(repeat), 0)
        lines[f"{name} {1.2 * border.width_mm:.0f} mm wide"] = border.line_mm
    pictures["stockinette between borders: on a table"] = _profiles(lines)
    save(pictures, IMAGES / "weight.png", across=3)


def _cloth(repeat: str) -> EvenCloth:
    return cloth_of(StitchChart.parse(repeat), ACRYLIC, linear_density_g_per_m=DENSITY_G_PER_M)


def _profiles(lines: dict[str, NDArray[np.float64]]) -> Image.Image:
    """Cross-sections one below the other, in one scale."""
    picture = Image.new("RGB", (SIDE, SIDE), "white")
    pen = ImageDraw.Draw(picture)
    wide, high = np.max([np.ptp(line, axis=0) for line in lines.values()], axis=0)
    scale = SIDE * min(0.9 / wide, 0.6 / len(lines) / high)
    for place, (name, line) in enumerate(lines.items()):
        top = (place + 0.35) * SIDE / len(lines)
        x = 0.05 * SIDE + (line[:, 0] - line[:, 0].min()) * scale
        y = top + (line[:, 1].max() - line[:, 1]) * scale
        pen.line(list(zip(x, y, strict=True)), fill=(92, 138, 184), width=3)
        pen.text((12, top - 30), name, fill=(40, 40, 40), font=FONT)
    return picture


if __name__ == "__main__":
    main()
