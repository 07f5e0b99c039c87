"""The strip test of charts: symmetries, regions, files, and what is refused."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.flat import (
    EnergyModel,
    QuarterGrid,
    SheetModel,
    chart_sheet,
    misfit,
    relaxed_shape,
    strip_test,
)
from knitcore.cloth.flat.grid import MAX_CELLS
from knitcore.cloth.flat.strip import load_levels
from knitcore.law.constitutive import Symmetrisation
from knitcore.materials import Laws, load_library, material

ACRYLIC = material("acrylic:published")
GARTER = StitchChart.of_fabric("garter", rows=6, columns=8)


def test_the_first_swatch_converges() -> None:
    chart = StitchChart.of_fabric("garter", rows=20, columns=31)
    test = strip_test(chart, ACRYLIC, "wale", 0.5)
    assert test.converged
    assert test.strain[-1] == 0.5
    assert test.force_n[-1] == pytest.approx(6.29, rel=2e-3)
    assert -0.06 < test.waist_strain[-1] < -0.02
    assert test.nearest_lock_up is not None
    assert test.nearest_lock_up.direction is Direction.WALE
    assert len(test.strain) == len(test.iterations) == test.steps == 10


@settings(max_examples=12, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    rows=st.integers(1, 9),
    columns=st.integers(1, 9),
    direction=st.sampled_from(Direction),
    name=st.sampled_from(list(load_library(Laws.PUBLISHED))),
)
def test_random_charts_stretch_and_their_back_does_likewise(
    seed: int, rows: int, columns: int, direction: Direction, name: str
) -> None:
    chart = StitchChart(np.random.default_rng(seed).random((rows, columns)) < 0.5)
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


def test_one_gauge_has_no_misfit_and_two_have() -> None:
    assert misfit(chart_sheet(GARTER, ACRYLIC, draw_in=True).grid).largest < 1e-12
    halves = StitchChart(np.hstack([GARTER.purl, np.zeros_like(GARTER.purl)]))
    report = misfit(chart_sheet(halves, ACRYLIC, draw_in=True).grid)
    assert report.largest > 0.05
    assert report.by_fabric[Fabric.GARTER][1] * report.by_fabric[Fabric.STOCKINETTE][1] < 0


def test_draw_in_relaxes_the_misfit() -> None:
    halves = StitchChart(np.vstack([GARTER.purl, np.zeros_like(GARTER.purl)]))
    sheet = chart_sheet(halves, material("cotton:published"), draw_in=True)
    shape = relaxed_shape(sheet)
    assert shape.converged, shape.problem
    assert shape.energy_n_mm[-1] < sheet.energy(sheet.reference)
    drawn = strip_test(halves, material("cotton:published"), "wale", 0.2, steps=2, draw_in=True)
    assert drawn.converged, drawn.problem


def test_wrinkling_hardly_changes_a_wide_swatch() -> None:
    plain = strip_test(GARTER, ACRYLIC, "wale", 0.4, steps=4)
    wrinkled = strip_test(
        GARTER, ACRYLIC, "wale", 0.4, steps=4, model=SheetModel(tension_field=True)
    )
    assert wrinkled.converged
    assert wrinkled.force_n == pytest.approx(plain.force_n, rel=1e-3)


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


def test_npz_has_all_steps(tmp_path: Path) -> None:
    test = strip_test(GARTER, ACRYLIC, "course", 0.3, steps=2)
    test.write(tmp_path / "swatch.npz")
    with np.load(tmp_path / "swatch.npz") as archive:
        for name in ("ux_mm", "uy_mm", "strain_xx", "strain_yy", "strain_xy"):
            assert archive[name].shape == (2, *archive["x_mm"].shape)
        assert archive["ux_mm"] == pytest.approx(test.ux_mm)


def test_vtu_can_be_read_back(tmp_path: Path) -> None:
    test = strip_test(GARTER, ACRYLIC, "course", 0.3, steps=2)
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
    with pytest.raises(InputError) as caught:
        strip_test(GARTER, ACRYLIC, **given)
    assert caught.value.field == field


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
