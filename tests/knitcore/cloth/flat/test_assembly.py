"""The compiled kernel against scikit-fem's general assembly, and against finite differences."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from skfem import Basis, BilinearForm, ElementTriP1, ElementVector, Functional, LinearForm
from skfem.helpers import grad

from knitcore.cloth.flat import EnergyModel, QuarterGrid, Sheet, SheetModel, State
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


def disturbed(sheet: Sheet, rng: np.random.Generator) -> State:
    stretch = np.array([[1.08, 0.03], [-0.02, 1.2]])
    corners, centres = sheet.grid.corners @ stretch, sheet.grid.centres @ stretch
    return State(
        corners + rng.uniform(-0.03, 0.03, corners.shape),
        centres + rng.uniform(-0.03, 0.03, centres.shape),
    )


def full_tangent(sheet: Sheet, state: State) -> sp.csr_matrix:
    """By central differences of the kernel's forces."""
    sizes = state.corners.size, state.centres.size
    x = np.concatenate([state.corners.ravel(), state.centres.ravel()])

    def force(x: np.ndarray) -> np.ndarray:
        lin = sheet.linearise(State(x[: sizes[0]].reshape(-1, 2), x[sizes[0] :].reshape(-1, 2)))
        return np.concatenate([force.ravel() for force in lin.force])

    step = 1e-6
    columns = [(force(x + step * e) - force(x - step * e)) / (2 * step) for e in np.eye(sum(sizes))]
    return np.array(columns).T


def skfem_assembly(sheet: Sheet, state: State) -> tuple[float, np.ndarray, np.ndarray]:
    """Energy, forces and tangent by scikit-fem, from Notes 7 and 9 written down directly."""
    mesh = crossed_mesh(sheet.grid)
    basis = Basis(mesh, ElementVector(ElementTriP1()), intorder=2)
    law_of_triangle = np.repeat(sheet.grid.law_of_cell.ravel(), 4)[:, None]
    law = {
        name: np.array([getattr(law, name) for law in sheet.laws])[law_of_triangle]
        for name in ConstitutiveLaw.__dataclass_fields__
    }
    displacement = np.vstack([state.corners, state.centres]) - mesh.p.T
    u = basis.interpolate(displacement.ravel())
    du = grad(u)
    a = np.array([1 + du[0, 0], du[1, 0]])
    b = np.array([du[0, 1], 1 + du[1, 1]])
    published = sheet.model.energy is EnergyModel.PUBLISHED
    if published:
        ex, ey, gamma = a[0] - 1, b[1] - 1, a[1] + b[0]
        zero, one = np.zeros_like(ex), np.ones_like(ex)
        d_ex, d_ey = np.array([one, zero, zero, zero]), np.array([zero, zero, zero, one])
        d_gamma = np.array([zero, one, one, zero])
        dd = [np.zeros((4, 4, *ex.shape))] * 3
    else:
        la, lb = np.hypot(*a), np.hypot(*b)
        ex, ey = la - 1, lb - 1
        gamma = np.arctan2(a[1], a[0]) - np.arctan2(-b[0], b[1])
        zero = np.zeros_like(ex)
        d_ex = np.array([a[0] / la, a[1] / la, zero, zero])
        d_ey = np.array([zero, zero, b[0] / lb, b[1] / lb])
        d_gamma = np.array([-a[1] / la**2, a[0] / la**2, b[1] / lb**2, -b[0] / lb**2])
        dd = [np.zeros((4, 4, *ex.shape)) for _ in range(3)]
        for k, (v, length) in enumerate(((a, la), (b, lb))):
            o = 2 * k
            dd[k][o, o], dd[k][o + 1, o + 1] = v[1] ** 2 / length**3, v[0] ** 2 / length**3
            dd[k][o, o + 1] = dd[k][o + 1, o] = -v[0] * v[1] / length**3
            sign = 1 if k == 0 else -1  # gamma = angle(a) - (angle(b) - 90 degrees)
            dd[2][o, o] = sign * 2 * v[0] * v[1] / length**4
            dd[2][o + 1, o + 1] = -dd[2][o, o]
            dd[2][o, o + 1] = dd[2][o + 1, o] = sign * (v[1] ** 2 - v[0] ** 2) / length**4
    from knitcore.law.stiffening import stiffening

    form = StiffeningForm(sheet.model.energy.value)
    wx, wx1, wx2 = stiffening(law["alpha_xx"] * ex, form)
    wy, wy1, wy2 = stiffening(law["alpha_yy"] * ey, form)
    cxx, cyy, cxy = law["stiffness_xxxx"], law["stiffness_yyyy"], law["stiffness_xxyy"]
    g, grown = law["shear_modulus"], np.zeros_like(gamma)
    if not published:
        grown = law["shear_stiffening"] * gamma**2
    density = (
        cxx * ex**2 / 2 + cyy * ey**2 / 2 + cxy * ex * ey + g * gamma**2 / 2 * (1 + grown / 2)
        + law["beta_xx"] / law["alpha_xx"] * wx + law["beta_yy"] / law["alpha_yy"] * wy
    )  # fmt: skip
    s = [cxx * ex + cxy * ey + law["beta_xx"] * wx1, cyy * ey + cxy * ex + law["beta_yy"] * wy1]
    s.append(g * gamma * (1 + grown))
    kxx = cxx + law["alpha_xx"] * law["beta_xx"] * wx2
    kyy = cyy + law["alpha_yy"] * law["beta_yy"] * wy2
    p = s[0] * d_ex + s[1] * d_ey + s[2] * d_gamma

    def outer(m: np.ndarray, n: np.ndarray) -> np.ndarray:
        return m[:, None] * n[None]

    kxy = g * (1 + 3 * grown)
    h = (
        kxx * outer(d_ex, d_ex) + kyy * outer(d_ey, d_ey) + kxy * outer(d_gamma, d_gamma)
        + cxy * (outer(d_ex, d_ey) + outer(d_ey, d_ex))
        + s[0] * dd[0] + s[1] * dd[1] + s[2] * dd[2]
    )  # fmt: skip

    def flat(v: object) -> np.ndarray:
        dv = grad(v)
        return np.array([dv[0, 0], dv[1, 0], dv[0, 1], dv[1, 1]])

    energy = Functional(lambda w: density).assemble(basis)
    force = LinearForm(lambda v, w: np.einsum("i...,i...", p, flat(v))).assemble(basis)
    tangent = BilinearForm(
        lambda u, v, w: np.einsum("i...,ij...,j...", flat(v), h, flat(u))
    ).assemble(basis)
    return energy, force, tangent.toarray()


@pytest.mark.parametrize("energy", list(EnergyModel))
def test_the_kernel_equals_scikit_fem(energy: EnergyModel) -> None:
    rng = np.random.default_rng(7)
    sheet = Sheet(mixed_grid(rng), LAWS, SheetModel(energy))
    state = disturbed(sheet, rng)
    lin = sheet.linearise(state)
    expected, force, tangent = skfem_assembly(sheet, state)
    assert lin.energy == pytest.approx(expected, rel=1e-12)
    assert sheet.energy(state) == pytest.approx(expected, rel=1e-12)
    found = np.concatenate([force.ravel() for force in lin.force])
    assert np.abs(found - force).max() <= 1e-12 * np.abs(force).max()
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
    [
        (SheetModel(EnergyModel.PUBLISHED), LAWS),
        (SheetModel(), LAWS),
        (SheetModel(), COUPLED),
        (SheetModel(tension_field=True), LAWS),
        (SheetModel(tension_field=True), COUPLED),
    ],
    ids=["published", "full", "coupled", "tension field", "coupled tension field"],
)
def test_force_and_tangent_are_derivatives_of_the_energy(
    model: SheetModel, laws: tuple[ConstitutiveLaw, ...]
) -> None:
    rng = np.random.default_rng(3)
    sheet = Sheet(mixed_grid(rng), laws, model)
    state = disturbed(sheet, rng)
    lin = sheet.linearise(state)
    direction = Nodes(*(rng.normal(size=vectors.shape) for vectors in state))
    step = 1e-6
    ahead, behind = (sheet.energy(state.moved(direction, s)) for s in (step, -step))
    slope = sum(np.sum(f * d) for f, d in zip(lin.force, direction, strict=True))
    assert (ahead - behind) / (2 * step) == pytest.approx(slope, rel=1e-6)
    tangent = full_tangent(sheet, state)
    n = state.corners.size
    condensed = tangent[:n, :n] - tangent[:n, n:] @ np.linalg.solve(
        tangent[n:, n:], tangent[n:, :n]
    )
    assert lin.apply(direction.corners).ravel() == pytest.approx(
        condensed @ direction.corners.ravel(), abs=2e-6 * np.abs(condensed).max()
    )


def test_two_threads_assemble_what_one_does(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(11)
    sheet = Sheet(mixed_grid(rng), LAWS, SheetModel())
    state = disturbed(sheet, rng)
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
