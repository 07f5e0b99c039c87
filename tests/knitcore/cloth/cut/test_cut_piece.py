"""Equilibria of cut pieces: exact cases, derivatives, and the grid's compiled assembly."""

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from skfem import ElementTriP1

from knitcore import (
    CancelledError,
    Direction,
    Fabric,
    InputError,
    RelaxedSize,
    StitchChart,
    material,
    predict,
)  # fmt: skip
from knitcore.cloth.cut import (
    Cloth,
    Condition,
    CutPiece,
    Framed,
    Held,
    PieceTest,
    Pulled,
    Sewn,
    Traction,
    cloth_under,
    solve,
)
from knitcore.cloth.cut.assembly import PieceEnergy
from knitcore.cloth.cut.conditions import Constraints
from knitcore.cloth.cut.cut_mesh import mesh_of
from knitcore.cloth.cut.equilibrium import Balance
from knitcore.cloth.flat import Clamps, EnergyModel, QuarterGrid, Sheet, SheetModel
from knitcore.cloth.flat.equilibrium_path import Tolerance, run_path
from knitcore.cloth.flat.strip import chart_sheet, clamp_mask, stretched
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import free_strains_at_stress, uniaxial_response
from tests.knitcore.cloth.flat.crossed_mesh import crossed_mesh
from tests.knitcore.refusals import refuses

ACRYLIC = material("acrylic")
LAW = replace(ACRYLIC.law(Fabric.STOCKINETTE).symmetrised(), shear_stiffening=4.0)
KITE = CutPiece(
    [(0, 0), (50, 10), (60, 70), (10, 60)],
    holes=[[(20, 25), (35, 30), (28, 45)]],
    grain_deg=35.0,
    edges={"all": (1, 2, 3, 4), "hole": (5, 6, 7), "low": (1,), "high": (3,)},
)
STRIP = CutPiece.rectangle(30.0, 60.0, grain_deg=45.0)


def cloth_of(law: ConstitutiveLaw = LAW, model: SheetModel | None = None) -> Cloth:
    """Cloth of one law everywhere."""
    sheet = Sheet(QuarterGrid.uniform(1, 1, 1.0, 1.0), [law], model or SheetModel())
    return Cloth(sheet, (0.0, 0.0))


def stretched_by(piece: CutPiece, y_mm: float, mesh_mm: float = 10.0, steps: int = 1) -> PieceTest:
    """A piece held at the bottom whose top is pulled upwards."""
    conditions = [Held("bottom"), Held("top", y_mm=y_mm)]
    return solve(piece, cloth_of(), conditions, steps=steps, mesh_mm=mesh_mm)


def test_the_equilibrium_on_the_grids_mesh_is_the_grids() -> None:
    """Energy and clamp force of a stretched chart to 1e-9, solved by either."""
    sheet = chart_sheet(StitchChart.parse("KKPP\nKPKP\nPPKK\nKKKK"), ACRYLIC)
    grid = sheet.grid
    targets = [stretched(grid, Direction.WALE, strain) for strain in (0.15, 0.3)]
    held = clamp_mask(grid, Direction.WALE, Clamps.CLAMPED)
    path = run_path(sheet, held, targets, tolerance=Tolerance(1e-11))
    cloth = Cloth(sheet, (float(grid.column_lines[0]), float(grid.row_lines[0])))
    energy = PieceEnergy(crossed_mesh(grid), cloth, np.eye(2), element=ElementTriP1(), order=1)
    piece = CutPiece.rectangle(grid.width_mm, grid.length_mm)
    conditions = [Held("bottom"), Held("top", y_mm=0.3 * grid.length_mm)]
    constraints = Constraints(energy.basis, piece, conditions)
    equilibria = list(Balance(energy, constraints).follow(np.array([0.5, 1.0])))
    for step, equilibrium in enumerate(equilibria):
        force = constraints.forces(equilibrium.internal, equilibrium.share)[1, 1]
        assert equilibrium.energy == pytest.approx(path.energies[step], rel=1e-9)
        assert force == pytest.approx(path.forces(grid.edge("top"), 1)[step], rel=1e-9)


@pytest.mark.parametrize("model", [SheetModel(), SheetModel(EnergyModel.PUBLISHED)])
def test_forces_and_tangent_are_derivatives_of_the_energy(model: SheetModel) -> None:
    energy = PieceEnergy(mesh_of(KITE, 15.0), cloth_of(model=model), KITE.turn)
    tapes = [(energy.basis.boundary(energy.basis.mesh.boundaries["hole"]), 3.0)]
    rng = np.random.default_rng(2)
    u = rng.normal(size=energy.basis.doflocs.shape) * 0.05 + 0.2 * energy.basis.doflocs
    way, step = rng.normal(size=u.shape), 1e-6
    here = energy.at(u, tapes)
    ahead, behind = (energy.at(u + s * way, tapes) for s in (step, -step))
    slope = (ahead.energy - behind.energy) / (2 * step)
    assert np.sum(here.force * way) == pytest.approx(slope, rel=1e-7)
    change = ((ahead.force - behind.force) / (2 * step)).ravel()
    assert here.tangent @ way.ravel() == pytest.approx(change, abs=1e-7 * np.abs(change).max())


def test_moving_and_turning_a_piece_costs_nothing() -> None:
    energy = PieceEnergy(mesh_of(KITE, 15.0), cloth_of(), KITE.turn)
    x, y = energy.basis.doflocs
    c, s = math.cos(1.0), math.sin(1.0)
    moved = energy.at(np.array([c * x - s * y - x + 7.0, s * x + c * y - y - 3.0]), [])
    assert moved.energy == pytest.approx(0.0, abs=1e-20)
    assert np.abs(moved.force).max() < 1e-12


def test_an_affine_motion_of_the_boundary_is_one_of_the_whole_piece() -> None:
    """The patch test, on a mesh of any triangles, with a sheared frame as the affine motion."""
    piece = CutPiece(KITE.outline, grain_deg=35.0, edges={"all": (1, 2, 3, 4)})
    test = solve(piece, cloth_of(), [Framed("all", 0.1)], steps=1, mesh_mm=12.0)
    c, s = math.cos(0.05), math.sin(0.05)
    affine = np.array([[c, s], [s, c]]) @ test.nodes_mm - test.nodes_mm
    assert test.displacement_mm[-1] == pytest.approx(affine, abs=1e-9)
    assert np.ptp(test.fields().stress_course) < 1e-9


@pytest.mark.parametrize(("grain", "direction"), [(0.0, "wale"), (90.0, "course")])
def test_a_strip_free_to_narrow_follows_the_law(grain: float, direction: str) -> None:
    piece = CutPiece.rectangle(20.0, 50.0, grain_deg=grain)
    conditions = [
        Held("bottom", x_mm=None, y_mm=0.0),
        Held("top", x_mm=None, y_mm=20.0),
        Held("left", x_mm=0.0, y_mm=None),
    ]
    test = solve(piece, cloth_of(), conditions, steps=2, mesh_mm=10.0)
    curve = uniaxial_response(LAW, Direction(direction), np.array([0.4]))
    assert test.force_n[-1, 1, 1] / 20.0 == pytest.approx(curve.stress[0], rel=1e-9)


def test_a_fabric_alike_in_both_directions_answers_alike_in_both() -> None:
    law = ConstitutiveLaw(0.1, 0.1, 0.03, 0.03, 1.0, 1.0, 0.02, 0.02, 0.03)
    piece = CutPiece.rectangle(40.0, 40.0)
    conditions = [
        Held("left", y_mm=None),
        Held("right", x_mm=8.0, y_mm=None),
        Held("bottom", x_mm=None),
        Held("top", x_mm=None, y_mm=8.0),
    ]
    force = solve(piece, cloth_of(law), conditions, steps=2, mesh_mm=10.0).force_n[-1]
    assert force[1, 0] == pytest.approx(force[3, 1], rel=1e-10)
    assert force[0, 0] == pytest.approx(-force[1, 0], rel=1e-10)


def test_turning_the_whole_test_turns_the_answer() -> None:
    """A strip along y and the same strip, turned by 90°, along x."""
    upright = CutPiece.rectangle(30.0, 60.0, grain_deg=30.0)
    lying = CutPiece(
        [(y, -x) for x, y in upright.outline], grain_deg=-60.0, edges=dict(upright.edges)
    )
    a = stretched_by(upright, 15.0, steps=2)
    b = solve(lying, cloth_of(), [Held("bottom"), Held("top", x_mm=15.0)], steps=2, mesh_mm=10.0)
    (ax, ay), (bx, by) = a.force_n[-1, 1], b.force_n[-1, 1]
    assert (bx, by) == pytest.approx((ay, -ax), rel=1e-9)
    assert b.energy_n_mm == pytest.approx(a.energy_n_mm, rel=1e-9)


def test_a_finer_mesh_changes_little_and_from_above() -> None:
    energies = [stretched_by(STRIP, 15.0, size).energy_n_mm[-1] for size in (15.0, 7.5, 3.75)]
    assert energies[0] > energies[1] > energies[2]
    assert energies[1] - energies[2] < 0.7 * (energies[0] - energies[1])
    assert energies[1] == pytest.approx(energies[2], rel=0.02)


def test_triangles_and_quadrilaterals_agree() -> None:
    (a, b, c, d) = STRIP.outline
    five = CutPiece([a, b, (15.0, 0.0), c, d], grain_deg=45.0, edges={"bottom": (1,), "top": (4,)})
    assert five.is_upright_rectangle is False
    first, second = (stretched_by(piece, 12.0, 5.0).energy_n_mm[-1] for piece in (STRIP, five))
    assert first == pytest.approx(second, rel=0.02)


def test_the_work_of_the_edges_is_the_energy() -> None:
    test = stretched_by(STRIP, 12.0, 15.0, steps=10)
    force = np.concatenate([[0.0], test.force_n[:, 1, 1]])
    assert np.trapezoid(force, dx=12.0 / 10) == pytest.approx(test.energy_n_mm[-1], rel=5e-3)


def test_a_force_that_was_measured_gives_the_stretch_again() -> None:
    x, y = stretched_by(STRIP, 12.0, steps=2).force_n[-1, 1].tolist()
    pulled = solve(STRIP, cloth_of(), [Held("bottom"), Pulled("top", x, y)], steps=3, mesh_mm=10.0)
    assert pulled.converged
    assert pulled.moved_mm[-1, 1] == pytest.approx((0.0, 12.0), abs=1e-6)
    assert pulled.force_n[-1, 0] == pytest.approx((-x, -y), rel=1e-7)


def test_a_load_along_an_edge_is_carried_by_the_other() -> None:
    test = solve(
        KITE, cloth_of(), [Held("low"), Traction("high", 0.001, 0.02)], steps=2, mesh_mm=10.0
    )
    length = math.hypot(50.0, 10.0)
    assert test.converged, test.problem
    assert test.force_n[-1, 1] == pytest.approx((0.001 * length, 0.02 * length))
    assert test.force_n[-1].sum(axis=0) == pytest.approx((0.0, 0.0), abs=1e-8)


def test_a_tape_keeps_an_edge_short() -> None:
    piece = CutPiece.rectangle(20.0, 60.0, grain_deg=45.0)

    def stretched_side(*more: Condition) -> float:
        conditions = [Held("bottom"), Pulled("top", y_n=1.0), *more]
        test = solve(piece, cloth_of(), conditions, steps=2, mesh_mm=10.0)
        assert test.converged, test.problem
        return float(test.moved_mm[-1, 1, 1])

    free, elastic = stretched_side(), stretched_side(Sewn("left", 1.0), Sewn("right", 1.0))
    tape = stretched_side(Sewn("left", 1e3), Sewn("right", 1e3))
    assert free > 1.2 * elastic
    assert tape == pytest.approx(1.0 / 2e3 * 60.0, rel=0.2)  # the tapes carry nearly all of it


def test_a_test_past_the_lock_up_is_marked() -> None:
    piece = CutPiece.rectangle(20.0, 40.0)
    law = replace(LAW, kappa_xx=0.0, kappa_yy=0.0)
    lock = law.lock_up_strain(Direction.WALE)
    for share, past in ((0.9, False), (1.02, True)):
        conditions = [Held("bottom"), Held("top", y_mm=share * lock * 40.0)]
        test = solve(piece, cloth_of(law), conditions, steps=3, mesh_mm=10.0)
        assert test.is_past_the_law() is past


def test_a_piece_covers_itself_with_whole_repeats() -> None:
    chart = StitchChart.parse("KP\nKP")
    piece = CutPiece.rectangle(40.0, 60.0, grain_deg=30.0)
    cloth = cloth_under(piece, chart, ACRYLIC)
    corners = np.asarray(piece.outline) @ piece.turn - cloth.corner_mm
    assert corners.min(axis=0) == pytest.approx(0.0, abs=1e-9)
    assert corners[:, 0].max() <= cloth.sheet.grid.width_mm
    assert corners[:, 1].max() <= cloth.sheet.grid.length_mm


def test_a_piece_of_counted_cloth_has_as_many_stitches_as_its_gauge_says() -> None:
    square, size = CutPiece.rectangle(100.0, 100.0), RelaxedSize.from_gauge(20, 25)
    grid = cloth_under(square, StitchChart.parse("K"), ACRYLIC, size=size).sheet.grid
    assert (grid.columns, grid.rows) == (2 * 20, 2 * 25)  # quarters


def test_a_patch_of_mixed_stitches_has_one_law_with_the_strains_of_its_answer() -> None:
    chart = StitchChart.parse("KKPP\nKKPP")
    cloth = cloth_under(CutPiece.rectangle(40.0, 40.0), chart, ACRYLIC)
    used = {cloth.sheet.laws[code] for code in np.unique(cloth.sheet.grid.law_of_cell)}
    assert len(used) == 1
    law, stress = used.pop(), np.array([0.01, 0.02, 0.05, 0.1, 0.2])
    for direction in Direction:
        predicted = predict(chart, ACRYLIC).along(direction).strain(stress)
        strains = free_strains_at_stress(law, direction, stress)
        # the rib unfolds at once between 0.01 and 0.02 N/mm, which no law that only stiffens can
        assert strains == pytest.approx(predicted, rel=0.22)
        assert strains.mean() == pytest.approx(predicted.mean(), rel=0.05)


def test_results_are_written(tmp_path: Path) -> None:
    test = solve(KITE, cloth_of(), [Held("low"), Pulled("high", y_n=1.0)], steps=2, mesh_mm=12.0)
    for suffix in (".csv", ".npz", ".vtu"):
        test.write(tmp_path / f"out{suffix}")
    table = np.genfromtxt(tmp_path / "out.csv", delimiter=",", names=True)
    assert table["high_y_n"] == pytest.approx([0.5, 1.0])
    stored = np.load(tmp_path / "out.npz")
    assert stored["displacement_mm"].shape == (2, *test.nodes_mm.shape)
    assert stored["strain_wale"].shape == (2, test.mesh.nelements)
    assert "utilisation" in (tmp_path / "out.vtu").read_text(errors="ignore")
    with pytest.raises(InputError):
        test.write(tmp_path / "out.xlsx")


@pytest.mark.parametrize(
    ("field", "conditions"),
    [
        ("conditions", []),
        ("conditions", [Pulled("high", y_n=1.0)]),
        ("conditions", [Held("low", x_mm=None), Pulled("high", y_n=1.0)]),
        ("conditions", [Held("all"), Held("high", y_mm=1.0)]),
        ("conditions", [Held("all"), Pulled("high", y_n=1.0)]),
        ("x_mm", [Held("low", x_mm=math.nan)]),
        ("stiffness_n", [Held("low"), Sewn("hole", 0.0)]),
        ("shear_angle", [Framed("all", 2.0)]),
        ("edge", [Held("hem")]),
    ],
)
def test_conditions_that_make_no_test_are_refused(
    field: str, conditions: Sequence[Condition]
) -> None:
    with refuses(field):
        solve(KITE, cloth_of(), conditions, steps=1)


def test_a_test_can_be_stopped() -> None:
    with pytest.raises(CancelledError):
        solve(KITE, cloth_of(), [Held("all")], cancelled=lambda: True)
