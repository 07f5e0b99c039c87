"""The strip test of pieces with an outline: what has no stitch is left out."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.flat import chart_sheet, misfit, relaxed_shape, strip_test
from knitcore.garment.shaped import outline_marks
from knitcore.materials import material

ACRYLIC = material("acrylic:published")
RIB = StitchChart.parse("\n".join(["KKPPKKPP"] * 3 + ["KKKKPPPP"] * 3))
WAISTED = outline_marks("xxxxxxxx\n.xxxxxx.\n..xxxx..\n..xxxx..\n.xxxxxx.\nxxxxxxxx")


def with_other_stitches_outside(chart: StitchChart, stitch: NDArray[np.bool_]) -> StitchChart:
    return StitchChart(np.where(stitch, chart.purl, ~chart.purl))


@pytest.mark.parametrize("direction", Direction)
def test_a_full_outline_is_the_rectangle(direction: Direction) -> None:
    plain = strip_test(RIB, ACRYLIC, direction, 0.3, steps=3)
    full = strip_test(RIB, ACRYLIC, direction, 0.3, steps=3, stitch=np.ones((6, 8), dtype=bool))
    assert full.energy_n_mm.tolist() == plain.energy_n_mm.tolist()
    assert full.force_n.tolist() == plain.force_n.tolist()
    assert full.width_mm == plain.width_mm


@pytest.mark.parametrize("direction", Direction)
def test_a_rectangle_in_a_larger_chart_is_that_rectangle(direction: Direction) -> None:
    """Empty rows and columns around it change nothing, nor does what is drawn in them."""
    larger = np.pad(RIB.purl, 2, constant_values=True)
    stitch = np.pad(np.ones((6, 8), dtype=bool), 2)
    alone = strip_test(RIB, ACRYLIC, direction, 0.3, steps=3)
    inside = strip_test(StitchChart(larger), ACRYLIC, direction, 0.3, steps=3, stitch=stitch)
    assert inside.converged, inside.problem
    assert inside.energy_n_mm == pytest.approx(alone.energy_n_mm, rel=1e-7)
    assert inside.stress_n_per_mm == pytest.approx(alone.stress_n_per_mm, rel=1e-6)
    assert inside.waist_strain == pytest.approx(alone.waist_strain, abs=1e-7)
    assert inside.ux_mm[-1][4:-4, 4:-4] == pytest.approx(alone.ux_mm[-1], abs=1e-6)
    assert np.isnan(inside.ux_mm[-1][:4]).all()
    sized = strip_test(
        StitchChart(larger),
        ACRYLIC,
        direction,
        0.3,
        steps=1,
        stitch=stitch,
        width_mm=120,
        length_mm=90,
    )
    assert sized.sheet.grid.width_mm == pytest.approx(120)
    assert sized.sheet.grid.length_mm == pytest.approx(90)
    nearest, alone_nearest = inside.nearest_lock_up, alone.nearest_lock_up
    assert nearest is not None
    assert alone_nearest is not None
    assert nearest.utilisation == pytest.approx(alone_nearest.utilisation, abs=1e-6)
    with pytest.raises(InputError) as caught:
        strip_test(StitchChart(larger), ACRYLIC, direction, 5.0, stitch=stitch)
    with pytest.raises(InputError) as of_rectangle:
        strip_test(RIB, ACRYLIC, direction, 5.0)
    assert caught.value.remedy == of_rectangle.value.remedy


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(Direction))
def test_any_shape_is_pulled_and_its_mirror_image_does_likewise(
    seed: int, direction: Direction
) -> None:
    random = np.random.default_rng(seed)
    chart = StitchChart(random.random((7, 8)) < 0.5)
    stitch = np.ones((7, 8), dtype=bool)
    for row in range(7):  # a spine in column 4 holds the rows together
        stitch[row, : random.integers(0, 5)] = False
        stitch[row, random.integers(5, 9) :] = False
    test = strip_test(chart, ACRYLIC, direction, 0.2, steps=2, stitch=stitch)
    assert test.converged, test.problem
    junk = with_other_stitches_outside(chart, stitch)
    other = strip_test(junk, ACRYLIC, direction, 0.2, steps=2, stitch=stitch)
    assert other.energy_n_mm.tolist() == test.energy_n_mm.tolist()
    mirrored = strip_test(
        StitchChart(chart.purl[:, ::-1]), ACRYLIC, direction, 0.2, steps=2, stitch=stitch[:, ::-1]
    )
    assert mirrored.force_n == pytest.approx(test.force_n, rel=1e-5)
    assert mirrored.uy_mm[-1][:, ::-1] == pytest.approx(test.uy_mm[-1], abs=1e-5, nan_ok=True)


def test_less_cloth_pulls_less_and_gives_most_at_its_waist() -> None:
    plain = strip_test(RIB, ACRYLIC, "wale", 0.2, steps=4)
    test = strip_test(RIB, ACRYLIC, "wale", 0.2, steps=4, stitch=WAISTED)
    assert test.converged, test.problem
    assert np.all(test.force_n < plain.force_n)
    assert test.energy_n_mm[-1] < plain.energy_n_mm[-1]
    along = test.fields().strain_yy
    assert np.nanmean(along[5:8]) > 1.3 * np.nanmean(along[[0, 1, 2, -3, -2, -1]])
    work = np.trapezoid(
        np.concatenate([[0], test.force_n]), np.concatenate([[0], test.strain]) * test.length_mm
    )
    assert test.energy_n_mm[-1] == pytest.approx(work, rel=0.02)
    area = 36 / 48 * plain.width_mm * plain.length_mm
    assert test.width_mm * test.length_mm == pytest.approx(area, rel=0.1)


def test_a_slit_piece_and_a_hole_are_pulled_too() -> None:
    """Two legs on one row, as fingers on a palm, and a ring."""
    legs = outline_marks("xxx..xxx\nxxx..xxx\nxxxxxxxx\nxxxxxxxx\nxxxxxxxx\nxxxxxxxx")
    ring = outline_marks("xxxxxxxx\nxxxxxxxx\nxxx..xxx\nxxx..xxx\nxxxxxxxx\nxxxxxxxx")
    for stitch in (legs, ring):
        for direction in Direction:
            test = strip_test(RIB, ACRYLIC, direction, 0.15, steps=2, stitch=stitch)
            assert test.converged, test.problem


def test_ends_that_slide_leave_a_rectangle_of_one_fabric_uniform() -> None:
    chart = StitchChart.of_fabric("garter", rows=6, columns=8)
    stitch = np.pad(np.ones((6, 4), dtype=bool), ((0, 0), (2, 2)))
    test = strip_test(chart, ACRYLIC, "wale", 0.3, steps=2, stitch=stitch, clamps="sliding")
    strain = test.fields().strain_yy
    assert np.nanmin(strain) == pytest.approx(0.3, abs=1e-6)
    assert np.nanmax(strain) == pytest.approx(0.3, abs=1e-6)


def test_finer_grids_of_one_shape_converge_to_one_force() -> None:
    """Each refinement of a waisted piece changes less than the one before."""
    garter = StitchChart.of_fabric("garter", rows=6, columns=8)
    size = (chart_sheet(garter, ACRYLIC).grid.width_mm, chart_sheet(garter, ACRYLIC).grid.length_mm)
    forces = []
    for times in (1, 2, 4):
        chart = StitchChart.of_fabric("garter", rows=6 * times, columns=8 * times)
        stitch = WAISTED.repeat(times, axis=0).repeat(times, axis=1)
        test = strip_test(
            chart, ACRYLIC, "wale", 0.3, steps=4, stitch=stitch, width_mm=size[0], length_mm=size[1]
        )
        forces.append(test.force_n[-1])
    assert abs(forces[2] - forces[1]) < 0.7 * abs(forces[1] - forces[0])
    assert forces[2] == pytest.approx(forces[0], rel=0.07)


@pytest.mark.parametrize(
    ("outline", "problem"),
    [
        ("xxxx....\n....xxxx", "2 pieces"),
        ("xxxxxxxx\n........\nxxxxxxxx", "2 pieces"),
        ("........\n........", "no stitch"),
    ],
)
def test_disconnected_fabric_is_refused(outline: str, problem: str) -> None:
    stitch = outline_marks(outline)
    chart = StitchChart(np.zeros(stitch.shape, dtype=bool))
    with pytest.raises(InputError, match=problem) as caught:
        strip_test(chart, ACRYLIC, "wale", 0.2, stitch=stitch)
    assert caught.value.field == "outline"


def test_an_outline_of_another_size_is_refused() -> None:
    with pytest.raises(InputError, match="8x6"):
        strip_test(RIB, ACRYLIC, "wale", 0.2, stitch=np.ones((3, 3), dtype=bool))


def test_a_shaped_piece_draws_in() -> None:
    halves = StitchChart(np.hstack([RIB.purl, np.zeros_like(RIB.purl)]))
    stitch = np.hstack([WAISTED, np.ones_like(WAISTED)])
    stitch[2:4] = True
    sheet = chart_sheet(halves, ACRYLIC, draw_in=True, stitch=stitch)
    assert misfit(sheet.grid).largest > 0.01
    shape = relaxed_shape(sheet)
    assert shape.converged, shape.problem
    assert shape.energy_n_mm[-1] < sheet.energy(sheet.reference)


def test_files_hold_the_cloth_alone(tmp_path: Path) -> None:
    test = strip_test(RIB, ACRYLIC, "wale", 0.2, steps=2, stitch=WAISTED)
    test.write(tmp_path / "piece.vtu")
    mesh = meshio.read(tmp_path / "piece.vtu")
    assert len(mesh.cells_dict["quad"]) == 4 * WAISTED.sum()
    assert np.isfinite(mesh.point_data["displacement_mm"]).all()
    x = mesh.points[mesh.cells_dict["quad"]][..., 0]
    assert np.all(x[:, 1] > x[:, 0])
