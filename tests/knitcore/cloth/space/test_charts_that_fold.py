"""Charts that fold themselves, of the seven kinds that Niu, Dion and Kamien knitted
(arXiv 2408.08409), each by a rule of its own."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space.curl import CurledPiece, curl
from knitcore.materials import material

Ints = NDArray[np.int64]
SIDE = 48


def _zigzag(at: Ints, period: int) -> Ints:
    """Distance from the nearest multiple of a period."""
    return np.abs((at + period // 2) % period - period // 2)


PURL: dict[str, Callable[[Ints, Ints], NDArray[np.generic]]] = {
    "miura": lambda r, c: (c + _zigzag(r // 2, 12)) // 6 % 2,
    "chains": lambda r, c: (r % 6 < 2) | (c // 4 % 2 == 0),
    "columns": lambda r, c: np.where(
        _zigzag(c, 24) > 4 + _zigzag(r, 24) // 2, r // 6 % 2, c // 6 % 2
    ),
    "peaks": lambda r, c: np.where(_zigzag(c, 48) > _zigzag(r, 48), r // 4 % 2, c // 4 % 2),
    "squiggles": lambda r, c: ((c + 2 * (r // 5 % 2)) // 12 + r // 5) % 2,
    "bars": lambda r, c: _zigzag(c, 16) < 8 - r % 9,
    "weave": lambda r, c: np.where(r % 12 < 2, 0, (c // 12 + r // 12) % 2),
}
"""Where a stitch of a row and column is a purl."""


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
    """Share of the folding that goes as the natural curvature does, and the mean fold of a panel.

    Folds are in degrees: knits and purls along the rows, then along the columns.
    """
    mean_folds, right, total = [], 0.0, 0.0
    for purl, corners, sign in (
        (piece.chart.purl, piece.corners_mm, 1.0),
        (piece.chart.purl.T, piece.corners_mm.transpose(1, 0, 2), -1.0),
    ):
        turn = sign * turns(corners)
        inside = purl[:, 1:] == purl[:, :-1]
        for kind in (False, True):
            alike = inside & (purl[:, 1:] == kind)
            begins = alike & ~np.pad(alike, ((0, 0), (1, 0)))[:, :-1]
            panels = max(np.count_nonzero(begins), 1)
            mean_folds.append(float(np.degrees(turn[alike].sum() / panels)))
            natural = -sign if kind else sign
            right += float(np.maximum(natural * turn[alike], 0.0).sum())
            total += float(np.abs(turn[alike]).sum())
    return right / total, mean_folds


@pytest.mark.slow
@pytest.mark.parametrize("kind", PURL)
def test_panels_fold_as_their_natural_curvature_says(kind: str) -> None:
    """Knits into ridges along the wales and valleys along the courses, purls the other way, so
    that the sheet bends over where knits meet purls; half of the folding would be chance."""
    purl = np.asarray(PURL[kind](*np.indices((SIDE, SIDE))), dtype=bool)
    piece = curl(StitchChart(purl), material("acrylic"))
    assert piece.converged
    assert piece.depth_mm > 4.0 * piece.thickness_mm
    share, (knits_across, purls_across, knits_up, purls_up) = folds(piece)
    assert share > 0.75
    across, up = knits_across - purls_across, purls_up - knits_up
    assert max(across, up) > 30.0
    assert min(across, up) > -10.0
