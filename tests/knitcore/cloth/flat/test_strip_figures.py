"""The figures show the fields of the test."""

import numpy as np
import pytest

from knitcore import StitchChart, material, strip_test
from knitcore.cloth.flat.strip_figures import displacement_figure, strain_crosses_figure

GARTER = StitchChart.of_fabric("garter", rows=5, columns=8)
TEST = strip_test(GARTER, material("acrylic:published"), "wale", 0.4, steps=2)


def test_the_displacement_is_drawn_on_the_deformed_shape() -> None:
    carpet, contour = displacement_figure(TEST).data
    assert np.asarray(carpet.y).max() == pytest.approx(1.4 * TEST.y_mm.max())
    assert np.asarray(contour.z).max() == pytest.approx(TEST.ux_mm[-1].max())


def test_crosses_show_extension_along_the_pull() -> None:
    extension = strain_crosses_figure(TEST).data[0]
    arms = np.asarray(extension.y).reshape(-1, 3)
    lengths = arms[:, 1] - arms[:, 0]
    assert np.abs(lengths).max() > 0
