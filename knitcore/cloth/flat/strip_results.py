"""Results of tests of a swatch."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np

from knitcore.base import showing
from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.fabric import PHASES, Direction
from knitcore.chart.result import Result
from knitcore.cloth.flat.equilibrium_path import Path as LoadPath
from knitcore.cloth.flat.fields import (
    Fields,
    cell_strains,
    node_fields,
    triangle_utilisation,
    utilisation,
)
from knitcore.cloth.flat.grid_sheet import Sheet, State
from knitcore.law.stiffening import EXTENSION_START

TAUT = 0.95
"""Share of its stretch from which cloth counts as taut."""
_SAME = 1e-6
"""Part by which two cells' uses of their stretch may differ and still count as equal."""


@dataclass(frozen=True, repr=False)
class LockUp(Result):
    """The place in a swatch that is nearest to its lock-up.

    Attributes
    ----------
    utilisation : alpha * strain there; 1 is the lock-up.
    step : index of the load step.
    x_mm, y_mm : rest position of the quarter cell.
    direction : which of the cell's two fibres.
    fabric : the cell's phase.
    """

    utilisation: float
    step: int
    x_mm: float
    y_mm: float
    direction: Direction
    fabric: str


@dataclass(frozen=True, eq=False, repr=False)
class SwatchTest(Result):
    """The load steps of a test that converged.

    Attributes
    ----------
    sheet : grid, laws and model that were solved.
    states : node positions at each step.
    energy_n_mm : stored energy per step.
    iterations : linear systems solved per step.
    converged : whether all requested steps converged.
    problem : why the test ended early, else None.
    seconds : wall-clock time of the solution.
    """

    sheet: Sheet
    states: tuple[State, ...]
    energy_n_mm: Array
    iterations: tuple[int, ...]
    converged: bool
    problem: str | None
    seconds: float

    not_listed: ClassVar = ("states",)

    @classmethod
    def of(cls, sheet: Sheet, path: LoadPath, **more: Any) -> Self:
        """The result of a path on a sheet; ``more`` are fields of this kind of test."""
        return cls(
            sheet=sheet,
            states=path.states,
            energy_n_mm=path.energies,
            iterations=path.iterations,
            converged=path.problem is None,
            problem=path.problem,
            seconds=path.seconds,
            **more,
        )

    def write(self, path: Path | str) -> None:
        """Write the fields by the file's suffix: ``.npz`` (all steps) or ``.vtu`` (the last step).

        Raises
        ------
        InputError
            If the suffix is neither of these, or there is no step to write.
        """
        target = Path(path)
        writers = {".npz": _write_npz, ".vtu": _write_vtu}
        if target.suffix.lower() not in writers:
            raise InputError("out", f"{target.name} has an unknown suffix.", "Use .npz or .vtu.")
        writers[target.suffix.lower()](self, target)

    @property
    def steps(self) -> int:
        """Number of load steps that converged."""
        return len(self.states)

    @property
    def dofs(self) -> int:
        """Displacement unknowns."""
        return self.sheet.grid.dofs

    @property
    def x_mm(self) -> Array:
        """Rest positions of the nodes, (rows + 1, columns + 1)."""
        return self.sheet.grid.corners[:, 0].reshape(self._shape)

    @property
    def y_mm(self) -> Array:
        """Rest positions of the nodes, (rows + 1, columns + 1)."""
        return self.sheet.grid.corners[:, 1].reshape(self._shape)

    @property
    def ux_mm(self) -> Array:
        """Course-wise displacements, (steps, rows + 1, columns + 1); NaN without fabric."""
        return self._displacements(0)

    @property
    def uy_mm(self) -> Array:
        """Wale-wise displacements, (steps, rows + 1, columns + 1); NaN without fabric."""
        return self._displacements(1)

    def fields(self, step: int = -1) -> Fields:
        """All fields at the nodes after a load step (the last one by default)."""
        return node_fields(self.sheet, self.states[step])

    @property
    def utilisation(self) -> Array:
        """Largest alpha * strain of any quarter cell, per step."""
        return np.array([self._utilisation(state).max() for state in self.states])

    def is_past_the_law(self, step: int = -1) -> bool:
        """True if some triangle of a quarter cell is past 98 % of its lock-up, where ``full`` only
        extrapolates its law: force and strains are then not physical.
        """
        return bool(self.tightest(step) > EXTENSION_START + 1e-6)

    def tightest(self, step: int = -1) -> float:
        """Largest alpha * strain of any triangle of a quarter cell after a load step."""
        used = triangle_utilisation(self.sheet, cell_strains(self.sheet, self.states[step]))
        return float(used.max())

    @property
    def nearest_lock_up(self) -> LockUp | None:
        """The quarter cell nearest to its lock-up in the last step (None without steps)."""
        if not self.states:
            return None
        used = self._utilisation(self.states[-1])
        # the first of those that are equal but for rounding, on every processor
        first = int(np.argmax(used >= (1 - _SAME) * used.max()))
        axis, row, column = np.unravel_index(first, used.shape)
        grid = self.sheet.grid
        return LockUp(
            utilisation=float(used[axis, row, column]),
            step=self.steps - 1,
            x_mm=float(grid.column_lines[column : column + 2].mean()),
            y_mm=float(grid.row_lines[row : row + 2].mean()),
            direction=Direction.COURSE if axis == 0 else Direction.WALE,
            fabric=PHASES[grid.law_of_cell[row, column] % len(PHASES)].value,
        )

    def _net_html(self) -> str:
        """The deformed net of the last step, drawn every few cells."""
        if not self.states:
            return ""
        points = np.stack([self.x_mm + self.ux_mm[-1], self.y_mm + self.uy_mm[-1]], axis=-1)
        step = max(1, max(self._shape) // 24)
        across = points.transpose(1, 0, 2)
        lines = [line[np.isfinite(line).all(axis=1)] for line in (*points[::step], *across[::step])]
        return showing.net([line for line in lines if len(line) > 1], "The deformed swatch")

    @property
    def _shape(self) -> tuple[int, int]:
        return self.sheet.grid.rows + 1, self.sheet.grid.columns + 1

    def _displacements(self, axis: int) -> Array:
        rest = self.sheet.grid.corners[:, axis]
        rest = np.where(self.sheet.grid.used_corners, rest, np.nan)
        moved = [(s.corners[:, axis] - rest).reshape(self._shape) for s in self.states]
        return np.array(moved).reshape(-1, *self._shape)

    def _utilisation(self, state: State) -> Array:
        return utilisation(self.sheet, cell_strains(self.sheet, state))


@dataclass(frozen=True, eq=False)
class StripTest(SwatchTest):
    """A simulated strip test (geometry after ISO 20932-1), not a certified test.

    Attributes
    ----------
    direction : of the pull.
    strain : clamp-to-clamp engineering strain per step.
    force_n : force on a clamp per step.
    stress_n_per_mm : force per initial width.
    waist_strain : change of width half-way between the clamps, over the initial width there.
    width_mm, length_mm : initial size across and along the pull; of a shaped piece its mean width.
    """

    direction: Direction
    strain: Array
    force_n: Array
    stress_n_per_mm: Array
    waist_strain: Array
    width_mm: float
    length_mm: float

    @property
    def first_taut(self) -> tuple[float, float] | None:
        """Strain and force in N at which the tightest cloth has used 95 % of its stretch.

        Between steps the strain is linear in the share that is used and the force exponential,
        since it diverges at the lock-up. None where no cloth gets there.
        """
        used, strain, force = 0.0, 0.0, 0.0
        for step in range(self.steps):
            before = used, strain, force
            used, strain, force = self.tightest(step), self.strain[step], self.force_n[step]
            if used >= TAUT:
                share = (TAUT - before[0]) / (used - before[0])
                at = before[1] + share * (strain - before[1])
                there = before[2] ** (1 - share) * force**share if step else share * force
                return float(at), float(there)
        return None

    def __repr__(self) -> str:
        size = f"{self.width_mm:.3g} x {self.length_mm:.3g} mm"
        end = (
            f", {self.force_n[-1]:.3g} N at a strain of {self.strain[-1]:.3g}" if self.steps else ""
        )
        return f"StripTest({size} pulled {self.direction}-wise, {self.steps} steps{end})"

    def _repr_html_(self) -> str:
        strain, stress = (np.append(0.0, a) for a in (self.strain, self.stress_n_per_mm))
        drawn = [(f"pulled {self.direction}-wise", strain, stress, None)]
        curve = showing.curves(drawn, "strain", "stress, N/mm") if self.steps else ""
        caption = f"{self.width_mm:.0f} mm wide, {self.length_mm:.0f} mm between the clamps"
        if self.steps:
            end = f"at a strain of {self.strain[-1]:.2f}: {self.force_n[-1]:.3g} N"
            caption = f"{caption}; {end}, waist {self.waist_strain[-1]:+.3f}"
        net = self._net_html()
        return showing.captioned(showing.beside(curve, net), caption, self.problem or "")


def _write_npz(test: SwatchTest, path: Path) -> None:
    """Write all steps at the nodes.

    ``x_mm``, ``y_mm`` (rows + 1, columns + 1) are rest positions; ``ux_mm``, ``uy_mm``,
    ``strain_xx``, ``strain_yy``, ``strain_xy``, ``energy_density``, ``utilisation`` (steps,
    rows + 1, columns + 1). A strip test adds ``strain``, ``force_n``, ``stress_n_per_mm`` and
    ``waist_strain`` (steps,).
    """
    names = ("strain_xx", "strain_yy", "strain_xy", "energy_density", "utilisation")
    steps = [test.fields(step) for step in range(test.steps)]
    shape = (0, *test.x_mm.shape)
    arrays = {
        name: np.array([getattr(step, name) for step in steps]) if steps else np.empty(shape)
        for name in names
    }
    arrays |= {name: getattr(test, name) for name in ("x_mm", "y_mm", "ux_mm", "uy_mm")}
    if isinstance(test, StripTest):
        for name in ("strain", "force_n", "stress_n_per_mm", "waist_strain"):
            arrays[name] = getattr(test, name)
    # the stub of savez_compressed takes keywords for its own option
    np.savez_compressed(path, allow_pickle=False, **arrays)


def _write_vtu(test: SwatchTest, path: Path) -> None:
    """Write the last step on the rest shape: quarter cells as quadrilaterals, to be warped by
    ``displacement_mm``.

    Cells without fabric are left out.

    Raises
    ------
    InputError
        If no step converged.
    """
    import meshio

    if test.steps == 0:
        raise InputError("out", "no step converged, so there is no field.", "Use a smaller strain.")
    fields = test.fields(-1)
    grid = test.sheet.grid
    used, cloth = grid.used_corners, grid.cloth.ravel()
    flat = np.zeros(fields.x_mm.size)

    def column(*parts: Array) -> Array:
        return np.column_stack([np.asarray(part).ravel()[used] for part in parts])

    larger, smaller = fields.principal_strain
    meshio.Mesh(
        points=column(fields.x_mm, fields.y_mm, flat),
        cells=[("quad", (np.cumsum(used) - 1)[grid.cell_corners[cloth]])],
        point_data={
            "displacement_mm": column(fields.ux_mm, fields.uy_mm, flat),
            "strain_xx_yy_xy": column(fields.strain_xx, fields.strain_yy, fields.strain_xy),
            "principal_strain": column(larger, smaller),
            "principal_direction": column(
                np.cos(fields.principal_angle), np.sin(fields.principal_angle), flat
            ),
            "stress_xx_yy_xy_n_per_mm": column(
                fields.stress_xx, fields.stress_yy, fields.stress_xy
            ),
            "energy_density_n_per_mm": fields.energy_density.ravel()[used],
            "utilisation": fields.utilisation.ravel()[used],
        },
        cell_data={"phase": [(grid.law_of_cell.ravel()[cloth] % len(PHASES)).astype(np.int32)]},
    ).write(path, file_format="vtu")
