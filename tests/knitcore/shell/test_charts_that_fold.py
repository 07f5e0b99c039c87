"""Charts that fold themselves, of the seven kinds that Niu, Dion and Kamien knitted
(arXiv 2408.08409), each by a rule of its own."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks.knitogami import folds
from knitcore.chart import StitchChart
from knitcore.materials import material
from knitcore.shell.curl import curl

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
