"""Charts that fold themselves: ``python -m benchmarks.knitogami FOLDER [PICTURE]``.

FOLDER holds the seven charts (``knit_3a_miura.txt`` …) of L. Niu, G. Dion and R. D. Kamien,
"Geometric mechanics of knitted fabrics", arXiv 2408.08409: a first line ``# rows columns`` that
says how often the repeat was knitted, then K and P. In that paper a knit is a piece of plate with
the natural curvature −1 along the courses and +1 along the wales, a purl the opposite. A panel of
knits is therefore a ridge along the wales and a valley along the courses, a panel of purls the
reverse. Printed is how much of the folding goes that way (half would be chance), how far panels
fold in the mean along rows and columns, and the energy given off.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from docs.figures.draw_curl import drawn, save
from knitcore.arrays import Array
from knitcore.chart import StitchChart
from knitcore.materials import material
from knitcore.shell.curl import CurledPiece, curl
from knitcore.shell.sheet import sheet_of

LARGEST = 48
"""Stitches each way up to which a repeat is tiled."""
NAMES = ("knits along rows", "purls along rows", "knits along columns", "purls along columns")


def charts(folder: Path) -> Iterator[tuple[str, StitchChart]]:
    """Names and pieces."""
    for path in sorted(folder.glob("knit_*.txt")):
        head, *lines = path.read_text(encoding="utf-8").splitlines()
        repeat = StitchChart.parse("\n".join(line.replace(" ", "") for line in lines))
        rows, columns = (int(count) for count in head.split()[1:])
        rows = min(rows, max(1, LARGEST // repeat.rows))
        columns = min(columns, max(1, LARGEST // repeat.columns))
        yield path.stem.split("_")[-1], repeat.tile(rows, columns)


def turns(corners_mm: Array) -> Array:
    """Turn between neighbours along the rows, (rows, columns - 1), rad, positive over a ridge."""
    diagonals = corners_mm[1:, 1:] - corners_mm[:-1, :-1], corners_mm[1:, :-1] - corners_mm[:-1, 1:]
    normal = np.cross(*diagonals)
    normal /= np.linalg.norm(normal, axis=2)[..., None]
    line = corners_mm[1:, 1:-1] - corners_mm[:-1, 1:-1]
    line /= np.linalg.norm(line, axis=2)[..., None]
    across = np.cross(normal[:, :-1], normal[:, 1:])
    sine = np.einsum("ijm,ijm->ij", across, line)
    return np.asarray(np.arctan2(sine, np.einsum("ijm,ijm->ij", normal[:, :-1], normal[:, 1:])))


def folds(piece: CurledPiece) -> tuple[float, list[float]]:
    """Share of the folding that goes as the natural curvature does; and the mean fold of a panel,
    in degrees: knits and purls along the rows, then along the columns."""
    found, right, all_of = [], 0.0, 0.0
    for purl, corners, sign in (
        (piece.chart.purl, piece.corners_mm, 1.0),
        (piece.chart.purl.T, piece.corners_mm.transpose(1, 0, 2), -1.0),
    ):
        turn = sign * turns(corners)
        inside = purl[:, 1:] == purl[:, :-1]
        for kind in (False, True):
            mine = inside & (purl[:, 1:] == kind)
            begins = mine & ~np.pad(mine, ((0, 0), (1, 0)))[:, :-1]
            panels = max(np.count_nonzero(begins), 1)
            found.append(float(np.degrees(turn[mine].sum() / panels)))
            wanted = -sign if kind else sign
            right += float(np.maximum(wanted * turn[mine], 0.0).sum())
            all_of += float(np.abs(turn[mine]).sum())
    return right / all_of, found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("picture", type=Path, nargs="?", help="Of all shapes, a PNG.")
    asked = parser.parse_args()
    yarn = material("acrylic")
    pictures = {}
    print("chart, stitches, share as named,", ", ".join(NAMES), "(°), energy given off, s of CPU")
    for name, chart in charts(asked.folder):
        piece, sheet = curl(chart, yarn), sheet_of(chart, yarn)
        flat, _ = sheet.energy(sheet.flat_mm, sheet.pairs(sheet.flat_mm))
        share, by_kind = folds(piece)
        state = "" if piece.converged else " NOT converged"
        print(
            f"{name:10} {chart.columns} x {chart.rows}  {share:.0%}  "
            + " ".join(f"{fold:+5.0f}" for fold in by_kind)
            + f"  {1 - piece.energy_n_mm / flat:.0%} of {flat:.0f} N·mm, {piece.depth_mm:.0f} mm "
            f"deep{state}, {piece.seconds:.1f} s",
            flush=True,
        )
        label = f"{name}, {chart.columns} x {chart.rows}: {piece.depth_mm:.0f} mm deep"
        pictures[label] = drawn(piece.corners_mm, chart.purl)
    if asked.picture is not None:
        save(pictures, asked.picture, across=4)


if __name__ == "__main__":
    main()
