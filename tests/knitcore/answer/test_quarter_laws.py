"""Laws of the quarter cells of a piece."""

import numpy as np

from knitcore import StitchChart, material
from knitcore.answer.quarter_laws import quarter_laws


def test_patches_of_a_repeat_go_on_through_the_piece() -> None:
    """Garter beside rib repeats every two rows; every row has the laws and sizes of both halves."""
    garter, rib = (StitchChart.of_fabric(f, rows=10, columns=20) for f in ("garter", "rib"))
    piece = StitchChart([[*g, *r] for g, r in zip(garter.purl, rib.purl, strict=True)])
    acrylic = material("acrylic")
    found = quarter_laws(piece, acrylic)
    assert (found.patch == found.patch[0]).all()
    assert (found.scale == found.scale[0]).all()
    patches = {int(found.patch[0, 0]), int(found.patch[0, -1])}
    assert len(patches) == 2
    for patch, fabric in zip(sorted(patches), ("garter", "rib"), strict=True):
        laws = found.laws[4 * patch : 4 * patch + 4]
        assert acrylic.law(fabric) in laws
    assert np.isfinite(found.scale).all()
