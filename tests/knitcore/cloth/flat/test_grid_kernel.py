"""The compiled kernel against the laws, scikit-fem's assembly and finite differences."""

from dataclasses import replace

import numpy as np
import pytest
from skfem import Basis, ElementTriP1, ElementVector

from knitcore.cloth.cut import Cloth
from knitcore.cloth.cut.assembly import PieceEnergy
from knitcore.cloth.flat import EnergyModel, QuarterGrid, Sheet, SheetModel, State
from knitcore.cloth.flat.fields import cell_strains
from knitcore.cloth.flat.grid_kernel import Nodes
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.stiffening import StiffeningForm
from tests.knitcore.cloth.flat.crossed_mesh import crossed_mesh

LAWS = (
    ConstitutiveLaw(
        0.241, 0.060, 0.036, 0.029, 1.17, 0.802, 0.022, 0.022, 0.01, shear_stiffening=6.0
    ),
    ConstitutiveLaw(0.204, 0.930, 0.088, 0.413, 1.111, 2.537, 0.046, 0.010, 0.03),
)

COUPLED = tuple(replace(law, kappa_xx=0.3, kappa_yy=0.5) for law in LAWS)


def mixed_grid(rng: np.random.Generator) -> QuarterGrid:
    columns, rows = 5, 4
    return QuarterGrid.between(
        np.cumsum(rng.uniform(0.5, 2.0, columns + 1)),
        np.cumsum(rng.uniform(0.5, 2.0, rows + 1)),
        rng.integers(0, 2, (rows, columns)).astype(np.uint8),
    )


def disturbed(
    model: SheetModel, laws: tuple[ConstitutiveLaw, ...] = LAWS, seed: int = 7
) -> tuple[Sheet, State]:
    """A sheet of cells of all sizes, stretched unevenly."""
    rng = np.random.default_rng(seed)
    sheet = Sheet(mixed_grid(rng), laws, model)
    stretch = np.array([[1.08, 0.03], [-0.02, 1.2]])
    nodes = (at @ stretch for at in (sheet.grid.corners, sheet.grid.centres))
    return sheet, State(*(at + rng.uniform(-0.03, 0.03, at.shape) for at in nodes))


def full_tangent(sheet: Sheet, state: State) -> np.ndarray:
    """By central differences of the kernel's forces."""
    sizes = state.corners.size, state.centres.size
    x = np.concatenate([state.corners.ravel(), state.centres.ravel()])

    def force(x: np.ndarray) -> np.ndarray:
        lin = sheet.linearise(State(x[: sizes[0]].reshape(-1, 2), x[sizes[0] :].reshape(-1, 2)))
        return np.concatenate([force.ravel() for force in lin.force])

    step = 1e-6
    columns = [(force(x + step * e) - force(x - step * e)) / (2 * step) for e in np.eye(sum(sizes))]
    return np.array(columns).T


@pytest.mark.parametrize("laws", [LAWS, COUPLED], ids=["plain", "coupled"])
@pytest.mark.parametrize("energy", list(EnergyModel))
def test_the_energy_is_that_of_the_laws(
    energy: EnergyModel, laws: tuple[ConstitutiveLaw, ...]
) -> None:
    sheet, state = disturbed(SheetModel(energy), laws)
    strains = cell_strains(sheet, state)
    expected = 0.0
    for code, law in enumerate(sheet.laws):
        of_law = sheet.grid.law_of_cell == code
        densities = law.energy_density(
            *(part[of_law] for part in (strains.xx, strains.yy, strains.xy)),
            form=StiffeningForm(energy.value),
        )
        expected += (sheet.grid.cell_area[of_law] * densities.mean(axis=1)).sum()
    assert sheet.energy(state) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("energy", list(EnergyModel))
def test_the_kernel_assembles_what_scikit_fem_does(energy: EnergyModel) -> None:
    sheet, state = disturbed(SheetModel(energy))
    grid = sheet.grid
    lin = sheet.linearise(state)
    cloth = Cloth(sheet, (float(grid.column_lines[0]), float(grid.row_lines[0])))
    piece = PieceEnergy(crossed_mesh(grid), cloth, np.eye(2), element=ElementTriP1(), order=1)
    moved = np.vstack(state) - np.vstack([grid.corners, grid.centres])
    expected = piece.at(moved.T, [])
    by_node = np.arange(moved.size).reshape(2, -1).T.ravel()  # it has all x before all y
    force, tangent = (
        expected.force.ravel()[by_node],
        expected.tangent.toarray()[by_node][:, by_node],
    )
    assert lin.energy == pytest.approx(expected.energy, rel=1e-12)
    own_force = np.concatenate([part.ravel() for part in lin.force])
    assert np.abs(own_force - force).max() <= 1e-12 * np.abs(force).max()
    # the cells' centres eliminated from scikit-fem's tangent
    n = state.corners.size
    inverse = np.linalg.inv(tangent[n:, n:])
    condensed = tangent[:n, :n] - tangent[:n, n:] @ inverse @ tangent[n:, :n]
    columns = np.array([lin.apply(e.reshape(-1, 2)).ravel() for e in np.eye(n)]).T
    assert np.abs(columns - condensed).max() <= 1e-12 * np.abs(condensed).max()
    reduced = force[:n] - tangent[:n, n:] @ inverse @ force[n:]
    assert np.abs(lin.condensed_force().ravel() - reduced).max() <= 1e-12 * np.abs(force).max()


@pytest.mark.parametrize(
    ("model", "laws"),
    [(SheetModel(EnergyModel.PUBLISHED), LAWS), (SheetModel(), LAWS), (SheetModel(), COUPLED)],
    ids=["published", "full", "coupled"],
)
def test_force_and_tangent_are_derivatives_of_the_energy(
    model: SheetModel, laws: tuple[ConstitutiveLaw, ...]
) -> None:
    sheet, state = disturbed(model, laws, seed=3)
    lin = sheet.linearise(state)
    rng = np.random.default_rng(4)
    direction = Nodes(*(rng.normal(size=vectors.shape) for vectors in state))
    step = 1e-6
    ahead, behind = (sheet.energy(state.moved(direction, s)) for s in (step, -step))
    slope = sum(np.sum(f * d) for f, d in zip(lin.force, direction, strict=True))
    assert (ahead - behind) / (2 * step) == pytest.approx(slope, rel=1e-8)
    tangent = full_tangent(sheet, state)
    n = state.corners.size
    condensed = tangent[:n, :n] - tangent[:n, n:] @ np.linalg.solve(
        tangent[n:, n:], tangent[n:, :n]
    )
    assert lin.apply(direction.corners).ravel() == pytest.approx(
        condensed @ direction.corners.ravel(), abs=2e-8 * np.abs(condensed).max()
    )


def test_two_threads_assemble_what_one_does(monkeypatch: pytest.MonkeyPatch) -> None:
    sheet, state = disturbed(SheetModel(), seed=11)
    alone = sheet.linearise(state)
    monkeypatch.setattr("knitcore.cloth.flat.grid_sheet.SIDE_BY_SIDE", 1)
    together = sheet.linearise(state)
    assert together.energy == pytest.approx(alone.energy, rel=1e-14)
    for ours, theirs in zip(together.force, alone.force, strict=True):
        assert ours == pytest.approx(theirs, abs=1e-15)
    assert np.array_equal(together.tangent.matrix, alone.tangent.matrix)


def test_cloth_pulled_to_a_point_has_infinite_energy_and_raises_nothing() -> None:
    sheet = Sheet(mixed_grid(np.random.default_rng(3)), LAWS, SheetModel())
    point = State(np.zeros_like(sheet.grid.corners), np.zeros_like(sheet.grid.centres))
    assert sheet.energy(point) == np.inf
    assert [sheet.linearise(point).energy for _ in range(5)] == [np.inf] * 5


def test_the_grid_numbers_its_nodes_and_edges_like_its_mesh() -> None:
    grid = mixed_grid(np.random.default_rng(0))
    mesh = crossed_mesh(grid)
    basis = Basis(mesh, ElementVector(ElementTriP1()))
    for name in ("left", "right", "bottom", "top"):
        by_mesh = basis.get_dofs(name).all()
        by_grid = (2 * grid.edge(name)[:, None] + np.arange(2)).ravel()
        assert sorted(by_mesh) == sorted(by_grid)
    assert grid.dofs == basis.N
    assert np.abs(mesh.p.T - np.vstack([grid.corners, grid.centres])).max() == 0
