from __future__ import annotations

import numpy as np
import pytest

from knitcore import Fabric, StitchChart
from knitcore.geometry.lattice import flat_lattice, stretched_sizes_mm
from knitcore.materials import material


@pytest.mark.parametrize("fabric", list(Fabric))
def test_a_pure_fabric_is_a_regular_lattice(fabric: Fabric) -> None:
    record = material("acrylic").record(fabric)
    lattice = flat_lattice(StitchChart.of_fabric(fabric, rows=4, columns=6), material("acrylic"))
    np.testing.assert_allclose(lattice.sizes_mm[..., 0], record.stitch_course_mm)
    np.testing.assert_allclose(lattice.sizes_mm[..., 1], record.stitch_wale_mm)
    np.testing.assert_allclose(np.diff(lattice.centres_mm[..., 0], axis=1), record.stitch_course_mm)
    np.testing.assert_allclose(np.diff(lattice.centres_mm[..., 1], axis=0), record.stitch_wale_mm)


def test_stretched_stitches_grow_with_their_distances() -> None:
    chart = StitchChart.parse("KKPP\nKPKP\nPPKK")
    lattice = flat_lattice(chart, material("cotton"))
    stretched = stretched_sizes_mm(lattice.centres_mm * [0.8, 1.5], lattice)
    np.testing.assert_allclose(stretched, lattice.sizes_mm * [0.8, 1.5])


def test_a_lone_stitch_keeps_its_size() -> None:
    lattice = flat_lattice(StitchChart.parse("K"), material("acrylic"))
    np.testing.assert_allclose(stretched_sizes_mm(lattice.centres_mm, lattice), lattice.sizes_mm)
