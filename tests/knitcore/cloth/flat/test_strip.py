"""The strip test of charts: symmetries, regions, outlines, files, and what is refused."""

from itertools import pairwise
from pathlib import Path

import meshio
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from knitcore import Direction, Fabric, InputError, StitchChart, material, predict, strip_test
from knitcore.cloth.flat import EnergyModel, QuarterGrid, SheetModel, chart_sheet
from knitcore.cloth.flat.grid import MAX_CELLS
from knitcore.cloth.flat.strip import load_levels
from knitcore.garment.shaped import outline_marks
from knitcore.law.constitutive import Symmetrisation
from knitcore.materials import Laws, load_library
from tests.knitcore.charts import stitch_charts
from tests.knitcore.refusals import refuses

ACRYLIC = material("acrylic:published")
MEASURED_ACRYLIC = material("acrylic")
GARTER = StitchChart.of_fabric("garter", rows=6, columns=8)
RIB = StitchChart.parse("\n".join(["KKPPKKPP"] * 3 + ["KKKKPPPP"] * 3))
WAISTED = outline_marks("xxxxxxxx\n.xxxxxx.\n..xxxx..\n..xxxx..\n.xxxxxx.\nxxxxxxxx")


def test_the_first_swatch_converges() -> None:
    chart = StitchChart.of_fabric("garter", rows=20, columns=31)
    test = strip_test(chart, ACRYLIC, "wale", 0.5)
    assert test.converged
    assert test.strain[-1] == 0.5
    assert test.force_n[-1] == pytest.approx(6.29, rel=2e-3)
    assert -0.06 < test.waist_strain[-1] < -0.02
    assert test.nearest_lock_up.direction is Direction.WALE
    assert len(test.strain) == len(test.iterations) == test.steps == 10


@settings(max_examples=12)
@given(
    stitch_charts(9),
    st.sampled_from(Direction),
    st.sampled_from(list(load_library(Laws.PUBLISHED))),
)
def test_random_charts_stretch_and_their_back_does_likewise(
    chart: StitchChart, direction: Direction, name: str
) -> None:
    front = strip_test(chart, material(name), direction, 0.25, steps=3)
    back = strip_test(chart.turn_over(), material(name), direction, 0.25, steps=3)
    assert front.converged, front.problem
    assert back.force_n == pytest.approx(front.force_n, rel=1e-6)
    assert back.ux_mm[-1] == pytest.approx(-front.ux_mm[-1][:, ::-1], abs=1e-5)


def test_force_and_energy_belong_together() -> None:
    """The clamp's work is the stored energy."""
    test = strip_test(GARTER, ACRYLIC, "wale", 0.4, steps=40)
    strain = np.concatenate([[0], test.strain])
    force = np.concatenate([[0], test.force_n])
    work = np.trapezoid(force, strain * test.length_mm)
    assert test.energy_n_mm[-1] == pytest.approx(work, rel=1e-3)


def test_fields_are_consistent() -> None:
    test = strip_test(GARTER, ACRYLIC, "wale", 0.3, steps=2)
    fields = test.fields()
    larger, smaller = fields.principal_strain
    assert larger + smaller == pytest.approx(fields.strain_xx + fields.strain_yy)
    turned = (
        larger * np.cos(fields.principal_angle) ** 2 + smaller * np.sin(fields.principal_angle) ** 2
    )
    assert turned == pytest.approx(fields.strain_xx, abs=1e-12)
    assert fields.uy_mm[-1] == pytest.approx(0.3 * test.length_mm / 2)
    assert test.utilisation[-1] >= fields.utilisation.max()


def test_files_have_displacements_and_strains(tmp_path: Path) -> None:
    """All steps as npz, the last one as vtu."""
    test = strip_test(GARTER, ACRYLIC, "course", 0.3, steps=2)
    test.write(tmp_path / "swatch.npz")
    with np.load(tmp_path / "swatch.npz") as archive:
        for name in ("ux_mm", "uy_mm", "strain_xx", "strain_yy", "strain_xy"):
            assert archive[name].shape == (2, *archive["x_mm"].shape)
        assert archive["ux_mm"] == pytest.approx(test.ux_mm)
    test.write(tmp_path / "swatch.vtu")
    mesh = meshio.read(tmp_path / "swatch.vtu")
    assert mesh.point_data["displacement_mm"][:, 0] == pytest.approx(test.ux_mm[-1].ravel())
    assert len(mesh.cells_dict["quad"]) == 4 * GARTER.rows * GARTER.columns


def test_sizes_can_be_given() -> None:
    test = strip_test(GARTER, ACRYLIC, "wale", 0.3, steps=2, width_mm=127, length_mm=40)
    assert (test.width_mm, test.length_mm) == pytest.approx((127, 40))


@pytest.mark.parametrize(
    ("field", "options"),
    [
        ("strain", {"strain": 1.3}),
        ("strain", {"strain": 0.0}),
        ("strain", {"strain": [0.2, 0.1]}),
        ("steps", {"steps": 0}),
        ("model", {"model": "linear"}),
        ("direction", {"direction": "bias"}),
        ("shear_modulus", {"shear_modulus": -1.0}),
        ("width_mm", {"width_mm": 0.0}),
        ("length_mm", {"length_mm": -40.0}),
    ],
)
def test_unusable_input_is_refused_by_name(field: str, options: dict[str, object]) -> None:
    given = {"direction": "wale", "strain": 0.3} | options
    with refuses(field):
        strip_test(GARTER, ACRYLIC, **given)


def test_a_strain_beyond_lock_up_is_refused_with_the_largest_accepted() -> None:
    with pytest.raises(InputError) as caught:
        strip_test(GARTER, ACRYLIC, "wale", 1.3)
    accepted = float(caught.value.remedy.split()[-1].rstrip("."))
    assert strip_test(GARTER, ACRYLIC, "wale", accepted, steps=8).converged


def test_the_last_level_is_the_requested_strain() -> None:
    """Not the next number above it, which may be beyond a limit that it just reaches."""
    for strain in (0.8, 0.3, 0.7):
        for steps in range(1, 60):
            assert load_levels(strain, steps)[-1] == strain


def test_a_mesh_that_would_not_fit_is_refused() -> None:
    side = int(MAX_CELLS**0.5) + 2
    with pytest.raises(InputError, match="memory"):
        QuarterGrid.uniform(side, side, 1.0, 1.0)


def test_a_rule_that_makes_a_law_indefinite_names_the_way_out() -> None:
    law = material("lace-bamboo:published").law(Fabric.STOCKINETTE)
    with pytest.raises(InputError, match="geometric"):
        SheetModel(EnergyModel.PUBLISHED, coupling=Symmetrisation.ARITHMETIC).prepare(law)


def test_a_checkerboard_is_stretched_up_to_its_lock_up() -> None:
    """Corners between clamp and free edge narrow most, and must not fold over."""
    test = strip_test(StitchChart.parse("KP\nPK").resized(16, 16), MEASURED_ACRYLIC, "course", 0.75)
    assert test.converged, test.problem


@pytest.mark.parametrize("extreme", [{"shear_modulus": 1e300}, {"width_mm": 1e-9}])
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_sheet_that_numbers_cannot_hold_gives_no_result(extreme: dict[str, float]) -> None:
    chart = StitchChart.parse("KKPP\nKKPP\nPPKK\nPPKK")
    test = strip_test(chart, ACRYLIC, "wale", 0.1, steps=2, **extreme)
    assert not test.converged
    assert test.problem
    assert test.steps == len(test.strain) == 0


@pytest.mark.parametrize("direction", Direction)
def test_a_rectangle_in_a_larger_chart_is_that_rectangle(direction: Direction) -> None:
    """Empty rows and columns around it change nothing, nor does what is drawn in them."""
    larger = StitchChart(np.pad(RIB.purl, 2, constant_values=True))
    stitch = np.pad(np.ones((6, 8), dtype=bool), 2)
    alone = strip_test(RIB, ACRYLIC, direction, 0.3, steps=3)
    inside = strip_test(larger, ACRYLIC, direction, 0.3, steps=3, stitch=stitch)
    assert inside.converged, inside.problem
    assert inside.energy_n_mm == pytest.approx(alone.energy_n_mm, rel=1e-7)
    assert inside.stress_n_per_mm == pytest.approx(alone.stress_n_per_mm, rel=1e-6)
    assert inside.waist_strain == pytest.approx(alone.waist_strain, abs=1e-7)
    assert inside.ux_mm[-1][4:-4, 4:-4] == pytest.approx(alone.ux_mm[-1], abs=1e-6)
    assert np.isnan(inside.ux_mm[-1][:4]).all()
    size = {"width_mm": 120, "length_mm": 90}
    sized = strip_test(larger, ACRYLIC, direction, 0.3, steps=1, stitch=stitch, **size)
    assert sized.sheet.grid.width_mm == pytest.approx(120)
    assert sized.sheet.grid.length_mm == pytest.approx(90)
    nearest, alone_nearest = inside.nearest_lock_up, alone.nearest_lock_up
    assert nearest.utilisation == pytest.approx(alone_nearest.utilisation, abs=1e-6)
    with pytest.raises(InputError) as caught:
        strip_test(larger, ACRYLIC, direction, 5.0, stitch=stitch)
    with pytest.raises(InputError) as of_rectangle:
        strip_test(RIB, ACRYLIC, direction, 5.0)
    assert caught.value.remedy == of_rectangle.value.remedy


@settings(max_examples=10)
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
    junk = StitchChart(np.where(stitch, chart.purl, ~chart.purl))
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
    grid = chart_sheet(garter, ACRYLIC).grid
    size = {"width_mm": grid.width_mm, "length_mm": grid.length_mm}
    forces = []
    for times in (1, 2, 4):
        chart = StitchChart.of_fabric("garter", rows=6 * times, columns=8 * times)
        stitch = WAISTED.repeat(times, axis=0).repeat(times, axis=1)
        test = strip_test(chart, ACRYLIC, "wale", 0.3, steps=4, stitch=stitch, **size)
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
    with refuses("outline", problem):
        strip_test(chart, ACRYLIC, "wale", 0.2, stitch=stitch)


def test_an_outline_of_another_size_is_refused() -> None:
    with pytest.raises(InputError, match="8x6"):
        strip_test(RIB, ACRYLIC, "wale", 0.2, stitch=np.ones((3, 3), dtype=bool))


def test_files_hold_the_cloth_alone(tmp_path: Path) -> None:
    test = strip_test(RIB, ACRYLIC, "wale", 0.2, steps=2, stitch=WAISTED)
    test.write(tmp_path / "piece.vtu")
    mesh = meshio.read(tmp_path / "piece.vtu")
    assert len(mesh.cells_dict["quad"]) == 4 * WAISTED.sum()
    assert np.isfinite(mesh.point_data["displacement_mm"]).all()
    x = mesh.points[mesh.cells_dict["quad"]][..., 0]
    assert np.all(x[:, 1] > x[:, 0])


def cloth(text: str, rows: int, columns: int) -> NDArray[np.bool_]:
    return StitchChart.parse(text).resized(rows, columns).purl


def bands(lower: str, upper: str, rows: int, of_lower: int = 10) -> StitchChart:
    """Two textures one above the other, 16 stitches wide."""
    both = np.vstack([cloth(lower, of_lower, 16), cloth(upper, 80, 16)])
    return StitchChart(both[:rows])


HEMS = {
    "rib": ("KKPP", "K"),
    "welt": ("K/K/P/P", "K"),
    "garter": ("K/P", "K"),
    "seed": ("KKPP", "KP/PK"),
}


@pytest.mark.parametrize("rows", [6, 17, 24])
@pytest.mark.parametrize("hem", HEMS)
@pytest.mark.parametrize("direction", Direction)
def test_a_long_free_strip_with_a_hem_stretches_like_its_curve(
    direction: Direction, hem: str, rows: int
) -> None:
    """Ends that slide; within 17 % of the strain at each stress, and of one area at rest."""
    chart = bands(*HEMS[hem], rows)
    answer = predict(chart, MEASURED_ACRYLIC)
    along = answer.along(direction)
    strains = along.strain([0.05, 0.1, 0.2])
    test = strip_test(chart, MEASURED_ACRYLIC, direction, strains.tolist(), clamps="sliding")
    np.testing.assert_allclose(along.strain(test.stress_n_per_mm), strains, rtol=0.17)
    area = 16 * rows * answer.relaxed_course_mm * answer.relaxed_wale_mm
    assert test.length_mm * test.width_mm == pytest.approx(area, rel=0.01)


def stress(chart: StitchChart) -> NDArray[np.float64]:
    """Logarithms of the stresses of a strip with sliding ends at strains of 0.1 to 0.3."""
    strains = [0.1, 0.2, 0.3]
    tests = (strip_test(chart, MEASURED_ACRYLIC, d, strains, clamps="sliding") for d in Direction)
    return np.log(np.concatenate([test.stress_n_per_mm for test in tests]))


@pytest.mark.parametrize("hem", HEMS)
def test_a_strip_that_outgrows_one_patch_is_as_stiff_as_before(hem: str) -> None:
    """16 and 17 rows."""
    lower, upper = HEMS[hem]
    small, large = (stress(bands(lower, upper, rows)) for rows in (16, 17))
    assert np.abs(large - small).max() < 0.1


@pytest.mark.slow
@pytest.mark.parametrize("hem", HEMS)
def test_a_row_more_changes_the_force_little(hem: str) -> None:
    """Where a patch is added, and between: 27 % at most."""
    lower, upper = HEMS[hem]
    for begin in (16, 24, 32, 48):
        forces = [stress(bands(lower, upper, rows)) for rows in range(begin, begin + 3)]
        most = max(float(np.abs(b - a).max()) for a, b in pairwise(forces))
        assert most < np.log(1.27)


def test_the_first_taut_cloth_has_its_place_on_the_curve() -> None:
    """Finer steps find the same; a test that ends before it has none."""
    chart = StitchChart.of_fabric("garter", rows=6, columns=8)
    coarse, fine = (strip_test(chart, ACRYLIC, "wale", 1.2, steps=steps) for steps in (24, 48))
    strain, force = fine.first_taut
    assert coarse.first_taut == pytest.approx((strain, force), rel=0.1)
    after = int(np.searchsorted(fine.strain, strain))
    assert fine.force_n[after - 1] < force < fine.force_n[after]
    assert fine.tightest() > 0.95
    short = strip_test(chart, ACRYLIC, "wale", 0.9 * strain)
    assert short.first_taut is None
    assert 0.5 < short.tightest() < 0.95


def test_of_cells_that_are_equally_near_to_lock_up_the_first_is_named() -> None:
    """Garter is the same to the left and to the right of its middle, but for rounding."""
    test = strip_test(StitchChart.of_fabric("garter", 8, 8), ACRYLIC, "wale", 0.3, steps=2)
    lock_up = test.nearest_lock_up
    assert lock_up is not None
    assert lock_up.x_mm < test.sheet.grid.column_lines.mean()
