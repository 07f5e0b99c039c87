"""Equilibria: exact solutions, the published demonstration, and what must never fail."""

import numpy as np
import pytest

from knitcore import CancelledError, Direction, InputError
from knitcore.cloth.flat import (
    Clamps,
    EnergyModel,
    QuarterGrid,
    Sheet,
    SheetModel,
    pull,
    strain_at_force,
)
from knitcore.cloth.flat import equilibrium_path as solver
from knitcore.cloth.flat.equilibrium_path import run_path
from knitcore.cloth.flat.strip import load_levels, lock_up_strain
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials import Laws, load_library

GARTER = ConstitutiveLaw(0.241, 0.060, 0.036, 0.029, 1.17, 0.802, 0.022, 0.022, 0.01)
SCRIPT = ConstitutiveLaw(
    0.240872, 0.0599528, 0.0362245, 0.0362245, 1.16995, 0.802057, 0.0223765, 0.0219965, 0.01
)
"""Unrounded constants of the authors' finite-element script (sabetta/stitch-by-stitch)."""
LINEAR = ConstitutiveLaw(0.241, 0.060, 0.036, 0.036, 0.0, 0.0, 0.0, 0.0, 0.02)


def homogeneous_sheet(
    law: ConstitutiveLaw = GARTER,
    size_mm: tuple[float, float] = (60.0, 40.0),
    cells: tuple[int, int] = (8, 6),
) -> Sheet:
    return Sheet(QuarterGrid.uniform(*cells, *size_mm), [law], SheetModel())


def test_the_energy_of_the_published_demonstration() -> None:
    """FEniCS 2019.2 gives 0.0799830383302 on the same mesh (50x50 crossed, U = 0.75 H)."""
    sheet = Sheet(
        QuarterGrid.uniform(50, 50, 3.15, 1.0), [SCRIPT], SheetModel(EnergyModel.PUBLISHED)
    )
    test = pull(sheet, Direction.WALE, load_levels(0.75, 20))
    assert test.energy_n_mm[-1] == pytest.approx(0.0799830383302, rel=1e-9)
    assert test.force_n[-1] == pytest.approx(0.268498, rel=1e-5)


def edges_mask(grid: QuarterGrid, *edges: str) -> np.ndarray:
    fixed = np.zeros((len(grid.corners), 2), dtype=bool)
    for name in edges or ("left", "right", "bottom", "top"):
        fixed[grid.edge(name)] = True
    return fixed


@pytest.mark.parametrize("model", [SheetModel(EnergyModel.PUBLISHED), SheetModel()])
def test_a_uniform_deformation_is_reproduced_exactly(model: SheetModel) -> None:
    """Patch test on cells of all sizes: the inner nodes follow an affine motion of the edges."""
    rng = np.random.default_rng(5)
    lines = [np.cumsum(rng.uniform(0.5, 2.0, n)) for n in (8, 6)]
    grid = QuarterGrid.between(lines[0], lines[1], np.zeros((5, 7), dtype=np.uint8))
    target = grid.corners @ np.array([[1.1, 0.05], [0.1, 1.3]])
    path = run_path(Sheet(grid, [GARTER], model), edges_mask(grid), [target])
    assert path.problem is None
    assert np.abs(path.states[-1].corners - target).max() < 1e-7


def test_displacements_converge_at_second_order() -> None:
    """Linear law; u = (a sin kx cosh my, b cos kx sinh my) is in equilibrium for one m(k).

    With c = C_xxyy + G the equations are (G m2 - C_xxxx k2) a - c k m b = 0 and
    c k m a + (C_yyyy m2 - G k2) b = 0, so that m2 solves a quadratic equation.
    """
    cx, cy, g = LINEAR.stiffness_xxxx, LINEAR.stiffness_yyyy, LINEAR.shear_modulus
    c, k = LINEAR.stiffness_xxyy + LINEAR.shear_modulus, 2.0
    m = np.sqrt(
        max(np.roots([g * cy, c**2 * k**2 - g**2 * k**2 - cx * cy * k**2, cx * g * k**4]).real)
    )
    a, b = 1e-2, 1e-2 * (g * m**2 - cx * k**2) / (c * k * m)

    def exact(p: np.ndarray) -> np.ndarray:
        x, y = p.T
        return p + np.column_stack(
            [a * np.sin(k * x) * np.cosh(m * y), b * np.cos(k * x) * np.sinh(m * y)]
        )

    errors = []
    for n in (6, 12, 24):
        grid = QuarterGrid.uniform(n, n, 1.0, 1.0)
        sheet = Sheet(grid, [LINEAR], SheetModel(EnergyModel.PUBLISHED))
        path = run_path(sheet, edges_mask(grid), [exact(grid.corners)])
        difference = path.states[-1].centres - exact(grid.centres)
        errors.append(np.sqrt(np.mean(difference**2)))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx([2, 2], abs=0.1)


def test_sliding_clamps_give_the_uniaxial_response() -> None:
    sheet = homogeneous_sheet()
    test = pull(sheet, Direction.WALE, load_levels(0.9, 6), clamps=Clamps.SLIDING)
    exact = uniaxial_response(sheet.laws[0], Direction.WALE, test.strain)
    assert test.converged
    assert test.stress_n_per_mm == pytest.approx(exact.stress, rel=1e-6)
    assert test.waist_strain == pytest.approx(exact.transverse_strain, abs=1e-6)


def test_force_control_finds_the_strains_of_strain_control() -> None:
    sheet = homogeneous_sheet()
    by_strain = pull(sheet, Direction.COURSE, load_levels(0.5, 3))
    strains = [strain_at_force(sheet, Direction.COURSE, force) for force in by_strain.force_n]
    assert strains == pytest.approx(by_strain.strain, rel=1e-5)


def test_a_force_short_of_the_largest_strain_is_found() -> None:
    """The secant comes to that strain and has to turn back."""
    sheet = homogeneous_sheet(cells=(4, 4))
    limit = 0.98 * lock_up_strain(sheet, Direction.WALE)
    near = pull(sheet, Direction.WALE, load_levels(0.999 * limit, 6))
    strain = strain_at_force(sheet, Direction.WALE, near.force_n[-1])
    assert strain == pytest.approx(0.999 * limit, rel=1e-5)


def test_a_force_that_cannot_be_reached_is_refused_with_the_largest() -> None:
    sheet = homogeneous_sheet(cells=(4, 4))
    with pytest.raises(InputError, match="runs out of stretch") as refused:
        strain_at_force(sheet, Direction.WALE, 1e6)
    most = refused.value.most
    assert strain_at_force(sheet, Direction.WALE, most) > 0.0


@pytest.mark.parametrize("direction", list(Direction))
def test_every_measured_law_is_stretched_to_four_fifths_of_its_lock_up(
    direction: Direction,
) -> None:
    for material in load_library(Laws.PUBLISHED).values():
        for fabric, record in material.fabrics.items():
            limit = 0.8 * record.law.lock_up_strain(direction)
            sheet = homogeneous_sheet(record.law, (127, 40), (32, 10))
            test = pull(sheet, direction, load_levels(limit, 8))
            assert test.converged, f"{material.identifier} {fabric}: {test.problem}"
            assert np.all(np.diff(test.force_n) > 0)


def test_a_compressed_sheet_buckles_into_a_stable_state() -> None:
    """Straight compression is an equilibrium too, but not a stable one: it is not accepted."""
    law = ConstitutiveLaw(0.2, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-3)
    sheet = homogeneous_sheet(law, (20, 20), (8, 8))
    targets = [sheet.grid.corners * np.array([1.0, 1 - s]) for s in (0.001, 0.3)]
    path = run_path(sheet, edges_mask(sheet.grid, "bottom", "top"), targets)
    assert path.problem is None
    assert path.equilibria[-1].energy < 0.9 * (0.2 * 0.3**2 / 2 * 20 * 20)


def test_a_failed_step_is_reported_and_the_steps_before_it_returned(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(solver, "MAX_NEWTON_STEPS", 4)
    monkeypatch.setattr(solver, "MAX_HALVINGS", 0)
    sheet = homogeneous_sheet()
    test = pull(sheet, Direction.WALE, np.array([0.05, 0.1, 1.2]))
    assert not test.converged
    assert test.steps == len(test.force_n) == 2
    assert "Step 3 of 3" in test.problem


def test_a_test_can_be_cancelled() -> None:
    sheet = homogeneous_sheet()
    seen: list[tuple[int, int]] = []
    with pytest.raises(CancelledError):
        pull(
            sheet,
            Direction.WALE,
            load_levels(0.5, 5),
            progress=lambda done, total: seen.append((done, total)),
            cancelled=lambda: len(seen) == 2,
        )
    assert seen == [(1, 5), (2, 5)]
