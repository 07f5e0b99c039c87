"""Figures and views of the notebook extra."""

import numpy as np
import pytest

from knitcore import StitchChart, curve, material, predict, strip_test
from knitcore.notebook import figure, view
from tests.knitcore.results import curled, relaxed_cell, sweep

ACRYLIC = material("acrylic")
RIB = StitchChart.of_fabric("rib", rows=4, columns=4)


def test_a_figure_has_the_curve_and_its_band() -> None:
    drawn = curve(RIB, ACRYLIC, "course", [0.0, 0.1, 0.2])
    line, band = figure(drawn).data
    assert np.array_equal(line.x, drawn.strain)
    assert np.array_equal(line.y, drawn.stress_n_per_mm)
    assert np.array_equal(band.x, np.append(drawn.strain_low, drawn.strain_high[::-1]))


def test_an_answer_has_both_directions_and_a_sweep_its_points() -> None:
    names = [trace.name for trace in figure(predict(RIB, ACRYLIC)).data if trace.name]
    assert names == ["course", "wale"]
    (line,) = figure(sweep()).data
    assert np.allclose(line.x, [0.0, 0.1, 0.2])
    test = strip_test(RIB, ACRYLIC, "wale", 0.1, steps=1)
    (line,) = figure(test).data
    assert np.array_equal(line.y, [0.0, *test.stress_n_per_mm])


def test_yarn_in_space_has_a_tube_for_every_course() -> None:
    tubes = view(relaxed_cell("KP")).data
    assert len(tubes) == 4
    assert np.isclose(max(tubes[0].z), 0.5 + 0.3, atol=0.02)  # wave and core radius


def test_a_curled_piece_in_space_is_its_corners() -> None:
    piece = curled()
    (surface,) = view(piece).data
    assert np.array_equal(surface.z, piece.corners_mm[..., 2])


@pytest.mark.parametrize("show", [figure, view])
def test_objects_without_a_picture_are_refused(show) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(TypeError, match="str has no"):
        show("KP")
