"""Draw the shapes of ``docs/curl.md``: ``python -m studies.figures.curl`` (a minute)."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space.curl import curl
from knitcore.materials import material

Array = NDArray[np.float64]

FACE, BACK = np.array([92, 138, 184]), np.array([226, 150, 84])
SIDE = 330
FONT = ImageFont.load_default(21)
CAPTION = 60
"""Height of two lines below a picture, pixels."""

TOWARDS = np.array([0.42, -0.62, 0.66])
"""From where the pieces are seen."""

BASKET = "\n".join(["KKKKPPPP"] * 4 + ["PPPPKKKK"] * 4)
MIURA = "\n".join(
    ("K" * s + "P" * 6 + "K" * (12 - 6 - s)) for s in (*range(7), *range(5, 0, -1)) for _ in "12"
)
FRAMED = "\n".join(
    "".join("P" if row % 2 and not (4 <= row < 24 and 4 <= at < 18) else "K" for at in range(22))
    for row in range(28)
)
PIECES = {
    "stockinette, 20 x 20": StitchChart.parse("K").tile(20, 20),
    "stockinette, 8 x 30": StitchChart.parse("K").tile(30, 8),
    "stockinette, 30 x 2": StitchChart.parse("K").tile(2, 30),
    "reverse stockinette, 8 x 30": StitchChart.parse("P").tile(30, 8),
    "garter": StitchChart.of_fabric("garter", rows=24, columns=12),
    "1x1 rib": StitchChart.of_fabric("rib", rows=20, columns=20),
    "seed": StitchChart.of_fabric("seed", rows=20, columns=14),
    "2x2 rib": StitchChart.parse("KKPP").tile(24, 6),
    "6x6 rib": StitchChart.parse("K" * 6 + "P" * 6).tile(20, 3),
    "4x2 rib": StitchChart.parse("KKKKPP").tile(24, 4),
    "5x1 rib": StitchChart.parse("KKKKKP").tile(24, 4),
    "3x3 welt": StitchChart.parse("P\nP\nP\nK\nK\nK").tile(4, 20),
    "8x8 rib": StitchChart.parse("K" * 8 + "P" * 8).tile(20, 2),
    "4x4 basket": StitchChart.parse(BASKET).tile(3, 3),
    "shifted stripes": StitchChart.parse(MIURA).tile(2, 2),
    "stockinette in garter": StitchChart.parse(FRAMED),
}
IMAGES = Path(__file__).parents[2] / "docs" / "images"


def drawn(
    corners_mm: Array, purl: NDArray[np.bool_], stitches: NDArray[np.bool_] | None = None
) -> Image.Image:
    """A sheet as quadrilaterals, the far ones first: blue the face, orange the back.

    Corners (rows + 1, columns + 1, 3) may be NaN where there is nothing; ``purl`` and ``stitches``
    (rows, columns), the latter False where there is no stitch.
    """
    ahead = TOWARDS / np.linalg.norm(TOWARDS)
    right = np.cross([0.0, 0.0, 1.0], ahead)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(ahead, right), ahead], axis=1)
    seen = corners_mm @ axes
    flat = seen.reshape(-1, 3)
    scale = 2 * 0.9 * SIDE / (np.nanmax(flat[:, :2], axis=0) - np.nanmin(flat[:, :2], axis=0)).max()
    middle = 0.5 * (np.nanmax(flat[:, :2], axis=0) + np.nanmin(flat[:, :2], axis=0))
    place = SIDE + (seen[..., :2] - middle) * scale * (1, -1)
    quads = np.stack([seen[:-1, :-1], seen[:-1, 1:], seen[1:, 1:], seen[1:, :-1]], axis=2).reshape(
        -1, 4, 3
    )
    corners = np.stack(
        [place[:-1, :-1], place[:-1, 1:], place[1:, 1:], place[1:, :-1]], axis=2
    ).reshape(-1, 4, 2)
    normal = np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    there = np.ones(purl.size, dtype=bool) if stitches is None else stitches.ravel()
    purl = purl.ravel()
    picture = Image.new("RGB", (2 * SIDE, 2 * SIDE), "white")
    pen = ImageDraw.Draw(picture)
    for k in np.argsort(quads[:, :, 2].mean(axis=1)):
        if np.isnan(quads[k]).any() or not there[k]:
            continue
        light = 0.5 + 0.5 * abs(normal[k] @ np.array([-0.3, 0.5, 0.81]))
        colour = (FACE if normal[k, 2] > 0 else BACK) * light * (0.82 if purl[k] else 1.0)
        tone = tuple(int(value) for value in colour)
        pen.polygon([tuple(at) for at in corners[k]], fill=tone, outline=(70, 70, 70))
    return picture.resize((SIDE, SIDE), Image.Resampling.LANCZOS)


def save(pictures: Mapping[str, Image.Image], path: Path, *, across: int) -> None:
    """Save pictures, ``across`` in a row, each over its name; a colon ends its line."""
    down = -(-len(pictures) // across)
    sheet = Image.new("RGB", (across * SIDE, down * (SIDE + CAPTION)), "white")
    pen = ImageDraw.Draw(sheet)
    for place, (name, picture) in enumerate(pictures.items()):
        at = (place % across) * SIDE, (place // across) * (SIDE + CAPTION)
        sheet.paste(picture, at)
        words = name.replace(": ", ":\n")
        pen.text((at[0] + 12, at[1] + SIDE), words, fill=(40, 40, 40), font=FONT)
    sheet.quantize(128).save(path, optimize=True)


def main() -> None:
    """Write the picture."""
    pictures = {}
    for name, chart in PIECES.items():
        piece = curl(chart, material("acrylic"))
        size = f"{piece.width_mm:.0f} x {piece.height_mm:.0f} x {piece.depth_mm:.0f} mm"
        print(name, size, "" if piece.converged else "NOT converged", f"{piece.seconds:.1f} s")
        pictures[f"{name}: {size}"] = drawn(piece.corners_mm, chart.purl)
    save(pictures, IMAGES / "curl.png", across=4)


if __name__ == "__main__":
    main()
