"""Sizes of pieces as they lie beside those of `predict`: ``python -m benchmarks.curl_sizes``.

The tables of ``docs/curl.md``: the mean stitch of the inner repeats of a free piece, and of the
whole of a rib whose knits and purls do not balance, laid flat with one column of every repeat held
in the plane.
"""

from __future__ import annotations

import numpy as np

from benchmarks.curl import squares
from knitcore.chart import StitchChart
from knitcore.fabric import Direction
from knitcore.materials import Material, material
from knitcore.prediction.predict import predict
from knitcore.shell.curl import curl
from knitcore.shell.relax import settle, shake_mm
from knitcore.shell.sheet import sheet_of

MATERIALS = ("acrylic", "cotton")
SIDE = 24
"""About so many stitches a side, of three whole repeats at least."""
RIBS = (2, 3, 4, 5, 6, 7, 8)
WELTS = (2, 3, 6, 8)
BASKETS = (3, 4)
UNBALANCED = ((2, 1), (3, 1), (4, 2), (5, 1))


def lying_mm(repeat: StitchChart, yarn: Material) -> tuple[float, float]:
    """Width and height of the mean stitch of the inner repeats of a free piece."""
    up, across = (max(3, round(SIDE / count)) for count in repeat.purl.shape)
    piece = curl(repeat.tile(up, across), yarn)
    assert piece.converged
    found = []
    for axis in (1, 0):
        count = repeat.purl.shape[axis]
        line = piece.corners_mm.mean(axis=1 - axis)
        inner = len(line) - 1 - 2 * count
        found.append(float(np.linalg.norm(line[-1 - count] - line[count])) / inner)
    return found[0], found[1]


def laid_flat_mm(repeat: StitchChart, yarn: Material) -> float:
    """Width of the mean stitch of the inner repeats of a rib, one column of each in the plane."""
    wide, chart = repeat.columns, repeat.tile(8, 4)
    sheet = sheet_of(chart, yarn)
    held = np.zeros((chart.rows + 1, chart.columns + 1, 3), dtype=bool)
    held[:, ::wide, 2] = True
    in_plane = held.reshape(-1, 3)
    begin = sheet.flat_mm + shake_mm(sheet.flat_mm.shape)
    begin[in_plane] = 0.0
    flat = settle(sheet, begin, held=in_plane)
    assert flat.converged
    line = flat.x.reshape(chart.rows + 1, -1, 3)[:, :, 0].mean(axis=0)
    return float(line[-1 - wide] - line[wide]) / (chart.columns - 2 * wide)


def main() -> None:
    rib = [(f"{n}×{n} rib", StitchChart.parse("K" * n + "P" * n)) for n in RIBS]
    welt = [(f"{n}-{n} welt", StitchChart.parse("\n".join("P" * n + "K" * n))) for n in WELTS]
    basket = [(f"{n}×{n} basket", StitchChart.parse(squares(n))) for n in BASKETS]
    for name, repeat in (*rib, *welt, *basket):
        cells = []
        for yarn in map(material, MATERIALS):
            answer = predict(repeat, yarn)
            told = [answer.along(direction).relaxed_mm for direction in Direction]
            for width, height in (lying_mm(repeat, yarn), told):
                words = {"rib": f"{width:.2f}", "welt": f"{height:.2f}"}
                cells.append(words.get(name.split()[1], f"{width:.2f} × {height:.2f}"))
        side = {"rib": ", width", "welt": ", height"}.get(name.split()[1], "")
        print(f"| {name}{side} | {' | '.join(cells)} |", flush=True)
    for knits, purls in UNBALANCED:
        repeat = StitchChart.parse("K" * knits + "P" * purls)
        cells = []
        for yarn in map(material, MATERIALS):
            width = predict(repeat, yarn).course.relaxed_mm
            cells += [f"{laid_flat_mm(repeat, yarn):.2f}", f"{width:.2f}"]
        print(f"| {knits}×{purls} rib, width | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
