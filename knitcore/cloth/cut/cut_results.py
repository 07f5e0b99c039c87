"""Results of a test of a piece: positions, forces and fields."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.result import Result
from knitcore.cloth.cut.assembly import PieceEnergy
from knitcore.cloth.cut.conditions import Condition, Constraints
from knitcore.cloth.cut.equilibrium import PieceEquilibrium
from knitcore.cloth.cut.outline import CutPiece
from knitcore.cloth.flat.fields import fibre_strains, response, stiffening_of
from knitcore.law.stiffening import EXTENSION_START, StiffeningForm

SUFFIXES = (".npz", ".csv", ".vtu")


@dataclass(frozen=True, eq=False, repr=False)
class ElementFields(Result):
    """Means over each element, (elements,).

    Attributes
    ----------
    x_mm, y_mm : centres at rest.
    strain_course, strain_wale : elongations along rows and columns.
    shear_angle : rad, change of the angle between them.
    stress_course, stress_wale, stress_shear : N/mm, force per width at rest.
    energy_density : N·mm per mm² at rest.
    utilisation : alpha * strain, the larger of the two directions; 1 is the lock-up.
    """

    x_mm: Array
    y_mm: Array
    strain_course: Array
    strain_wale: Array
    shear_angle: Array
    stress_course: Array
    stress_wale: Array
    stress_shear: Array
    energy_density: Array
    utilisation: Array


@dataclass(frozen=True, eq=False, repr=False)
class PieceTest(Result):
    """The load steps of a piece that converged.

    Attributes
    ----------
    piece : its outline.
    energy : mesh, laws and assembly.
    constraints : the conditions on the mesh.
    equilibria : the balanced states, step by step.
    problem : why the test ended early, else None.
    seconds : wall-clock time of the solution.
    """

    piece: CutPiece
    energy: PieceEnergy
    constraints: Constraints
    equilibria: tuple[PieceEquilibrium, ...]
    problem: str | None
    seconds: float

    also_listed: ClassVar = ("converged", "share", "energy_n_mm", "force_n", "moved_mm")

    def write(self, path: Path | str) -> None:
        """Write by the file's suffix: ``.npz`` all steps, ``.csv`` forces per step, ``.vtu`` the
        last step for ParaView.

        Raises
        ------
        InputError
            If the suffix is none of these, or there is no step to write.
        """
        target = Path(path)
        writers = dict(zip(SUFFIXES, (_write_npz, _write_csv, _write_vtu), strict=True))
        suffix = target.suffix.lower()
        if suffix not in writers:
            raise InputError(
                "out", f"{target.name} has an unknown suffix.", "Use .npz, .csv or .vtu."
            )
        if not self.equilibria:
            raise InputError(
                "out", "no step converged, so there is nothing to write.", "Use a smaller load."
            )
        writers[suffix](self, target)

    @property
    def converged(self) -> bool:
        """True if all requested steps converged."""
        return self.problem is None

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """The conditions on the edges."""
        return self.constraints.conditions

    @property
    def mesh(self) -> Any:
        """The mesh, of scikit-fem."""
        return self.energy.basis.mesh

    @property
    def nodes_mm(self) -> Array:
        """Places of the nodes at rest, (2, nodes)."""
        places: Array = self.energy.basis.doflocs
        return places

    @property
    def share(self) -> Array:
        """Share of the load per step."""
        return np.array([e.share for e in self.equilibria])

    @property
    def displacement_mm(self) -> Array:
        """Displacements of the nodes per step, (steps, 2, nodes)."""
        return np.array([e.displacement for e in self.equilibria]).reshape(-1, *self.nodes_mm.shape)

    @property
    def energy_n_mm(self) -> Array:
        """Stored energy per step."""
        return np.array([e.energy for e in self.equilibria])

    @property
    def force_n(self) -> Array:
        """Force on the edge of each condition, (steps, conditions, 2): x and y.

        A tape has a force of 0. A corner that two held edges share counts for the first.
        """
        forces = [self.constraints.forces(e.internal, e.share) for e in self.equilibria]
        return np.array(forces).reshape(-1, len(self.conditions), 2)

    @property
    def moved_mm(self) -> Array:
        """Mean displacement of the edge of each condition, (steps, conditions, 2)."""
        means = [
            [e.displacement[:, n].mean(axis=1) for n in self.constraints.nodes]
            for e in self.equilibria
        ]
        return np.array(means).reshape(-1, len(self.conditions), 2)

    @property
    def corners_mm(self) -> Array:
        """Positions of the mesh's corners per step, (steps, 2, corners)."""
        at_corners = self.energy.basis.nodal_dofs[0]
        moved: Array = self.mesh.p + self.displacement_mm[:, :, at_corners]
        return moved

    def fields(self, step: int = -1) -> ElementFields:
        """Fields of a step (the last one by default)."""
        strains, used = self._strains(step)
        sheet, codes = self.energy.cloth.sheet, self.energy.law_of_point
        weights = self.energy.basis.dx / self.energy.basis.dx.sum(axis=1, keepdims=True)
        answers = response(sheet, codes, *strains)

        def mean(values: Array) -> Array:
            return np.asarray(np.sum(values * weights, axis=1))

        x, y = (mean(at) for at in np.asarray(self.energy.basis.global_coordinates()))
        return ElementFields(
            x_mm=x,
            y_mm=y,
            strain_course=mean(strains[0]),
            strain_wale=mean(strains[1]),
            shear_angle=mean(2 * strains[2]),
            stress_course=mean(answers["stress_xx"]),
            stress_wale=mean(answers["stress_yy"]),
            stress_shear=mean(answers["stress_xy"]),
            energy_density=mean(answers["energy_density"]),
            utilisation=mean(used.max(axis=0)),
        )

    def utilisation(self, step: int = -1) -> float:
        """Largest alpha * strain at any point of the quadrature; 1 is the lock-up."""
        return float(self._strains(step)[1].max())

    def is_past_the_law(self, step: int = -1) -> bool:
        """True if some cloth is past 98 % of its lock-up, where its law is extrapolated."""
        return self.utilisation(step) > EXTENSION_START + 1e-6

    def _strains(self, step: int) -> tuple[tuple[Array, Array, Array], Array]:
        """Strains xx, yy and xy, and alpha * strain (2, elements, points)."""
        fibres = self.energy.fibres(self.equilibria[step].displacement)
        sheet, codes = self.energy.cloth.sheet, self.energy.law_of_point
        model = sheet.model.energy
        xx, yy, xy = fibre_strains(model, fibres[..., :2], fibres[..., 2:])
        form = StiffeningForm(model.value)
        return (xx, yy, xy), np.stack(stiffening_of(sheet, codes).arguments(xx, yy, form))


def _write_csv(test: PieceTest, path: Path) -> None:
    names = ["share", "energy_n_mm"]
    columns = [test.share, test.energy_n_mm]
    for number, condition in enumerate(test.conditions):
        for axis, letter in enumerate("xy"):
            names += [f"{condition.edge}_{letter}_mm", f"{condition.edge}_{letter}_n"]
            columns += [test.moved_mm[:, number, axis], test.force_n[:, number, axis]]
    table = np.column_stack(columns)
    np.savetxt(path, table, fmt="%.9g", delimiter=",", header=",".join(names), comments="")


def _write_npz(test: PieceTest, path: Path) -> None:
    """``nodes_mm``, ``displacement_mm``, ``elements`` (corners of each, from 0), per condition
    ``force_n`` and ``moved_mm``, and the element fields (steps, elements).
    """
    steps = [test.fields(step) for step in range(len(test.equilibria))]
    arrays = {name: np.array([vars(s)[name] for s in steps]) for name in vars(steps[0])}
    arrays |= {
        name: getattr(test, name)
        for name in ("share", "energy_n_mm", "force_n", "moved_mm", "nodes_mm", "displacement_mm")
    }
    arrays |= {"elements": test.mesh.t.T, "edges": np.array([c.edge for c in test.conditions])}
    np.savez_compressed(path, allow_pickle=False, **arrays)


def _write_vtu(test: PieceTest, path: Path) -> None:
    import meshio

    fields = test.fields()
    corners, elements = test.mesh.p, test.mesh.t.T
    moved = test.corners_mm[-1] - corners
    flat = np.zeros(corners.shape[1])
    meshio.Mesh(
        points=np.column_stack([*corners, flat]),
        cells=[("quad" if elements.shape[1] == 4 else "triangle", elements)],
        point_data={"displacement_mm": np.column_stack([*moved, flat])},
        cell_data={name: [values] for name, values in vars(fields).items()},
    ).write(path, file_format="vtu")
