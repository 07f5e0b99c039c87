"""Results of relaxations and stretches at the yarn level, the same for every branch."""

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from knitcore.base import showing
from knitcore.base.arrays import Array
from knitcore.base.choice import Choice
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.yarn_model import YarnModel


class Branch(Choice):
    """Shapes of the yarn that are admitted."""

    PUBLISHED = "published"
    MIRRORED = "mirrored"
    FREE = "free"


@dataclass(frozen=True, repr=False)
class StartReport(Result):
    """Outcome of one start.

    Attributes
    ----------
    name : of the start.
    outcome : ``relaxed``, ``not converged``, or the reason of a failure.
    energy_n_mm, cell_course_mm, cell_wale_mm : per stitch; nan where it failed.
    """

    name: str
    outcome: str
    energy_n_mm: float
    cell_course_mm: float
    cell_wale_mm: float


@dataclass(frozen=True, eq=False, repr=False)
class RelaxedCell(Result):
    """A cell of yarn at the lowest energy that was found.

    Parameters
    ----------
    branch : the shapes that were admitted.
    convention : the factors of the energy.
    chart : the repeat that the centre lines show; in the free branch at least two stitches each
        way, as neighbours need not look alike there.
    yarn : the yarn.
    loop_lengths_mm : length of yarn per stitch of every course of the solved cell, (rows,), or of
        every stitch, (rows, wales).
    cell_course_mm, cell_wale_mm : size of one stitch, mm (of a repeat: its mean stitch).
    energy_n_mm : energy of one stitch, N·mm: bending, regularisation and contact.
    bending_share : share of bending and regularisation in it.
    contact_share : share of contact in it.
    yarn_length_mm : length of yarn in one stitch, mm.
    seconds : CPU time it took, s.
    evaluations : evaluations of the energy with its gradient.
    converged : whether the optimiser reached its tolerance.
    force_n : dE/d(size of a stitch) of one stitch, course-wise and wale-wise.
    min_distance_mm : smallest distance of centre lines that may touch.
    centre_lines : centre lines, mm, shape (courses, points, 3), bottom course first: each runs
        once across the repeat.
    state : unknowns of the branch, from which it can be continued.
    notes : remarks for the user, in sentences.
    starts : all starts and their outcomes.
    """

    branch: Branch
    convention: Convention
    chart: StitchChart
    yarn: YarnModel
    loop_lengths_mm: Array
    cell_course_mm: float
    cell_wale_mm: float
    energy_n_mm: float
    bending_share: float
    contact_share: float
    yarn_length_mm: float
    seconds: float
    evaluations: int
    converged: bool
    force_n: tuple[float, float]
    min_distance_mm: float
    centre_lines: Array
    state: Array
    notes: tuple[str, ...] = ()
    starts: tuple[StartReport, ...] = ()

    not_listed: ClassVar = ("state",)

    def cell_mm(self, direction: Direction) -> float:
        """Size of one stitch along a direction, mm."""
        return direction.of(self.cell_course_mm, self.cell_wale_mm)

    @property
    def thickness_mm(self) -> float:
        """From the lowest to the highest yarn, mm."""
        return float(np.ptp(self.centre_lines[..., 2])) + 2.0 * self.yarn.radius_mm

    def _repr_html_(self) -> str:
        lines = self.tiled_lines()
        diameter = 2 * self.yarn.core_radius_mm
        picture = showing.in_space(lines, "The relaxed yarn", thickness=diameter, tilt=0.6)
        size = f"stitch {self.cell_course_mm:.3f} × {self.cell_wale_mm:.3f} mm"
        energy = f"energy of a stitch {self.energy_n_mm:.4f} N·mm: {self.bending_share:.0%} bending"
        contact = f"{self.contact_share:.0%} contact; branch {self.branch}"
        return showing.captioned(picture, f"{size}, {energy}, {contact}", *self.notes)

    def tiled_lines(self, least: int = 4) -> list[Array]:
        """The centre lines of as many repeats as make ``least`` stitches each way, (points, 3)."""
        rows, columns = self.chart.rows, self.chart.columns
        shift = np.array([columns * self.cell_course_mm, rows * self.cell_wale_mm, 0.0])
        up, along = -(-least // rows), -(-least // columns)
        return [
            np.concatenate([line + shift * (right, above, 0) for right in range(along)])
            for above in range(up)
            for line in self.centre_lines
        ]


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Result):
    """A stretch in one direction while the other is free of force, or its size prescribed.

    Parameters
    ----------
    direction : the stretched direction.
    zero : the force-free cell that strain and stress refer to.
    cells : the cell at each point, by increasing stretch; a release in falling order.
    stress_n_per_mm : nominal stress at each cell: ∂E/∂l over the transverse size at zero force.
    jumps : indices i where the lowest state changes shape abruptly between cell i - 1 and cell i.
    notes : remarks for the user, in sentences.
    """

    direction: Direction
    zero: RelaxedCell
    cells: tuple[RelaxedCell, ...]
    stress_n_per_mm: Array
    jumps: tuple[int, ...] = ()
    notes: tuple[str, ...] = field(default=())

    also_listed: ClassVar = ("strain", "transverse_strain")

    @property
    def strain(self) -> Array:
        """Strain along the stretch."""
        return self._strain(self.direction)

    @property
    def transverse_strain(self) -> Array:
        """Strain across the stretch (negative where the fabric narrows)."""
        return self._strain(self.direction.other)

    @property
    def energy_n_mm(self) -> Array:
        """Energy of one stitch at each cell, N·mm."""
        return np.array([cell.energy_n_mm for cell in self.cells])

    @property
    def bending_share(self) -> Array:
        """Share of bending (with regularisation) in the energy at each cell (paper, Fig. S7)."""
        return np.array([cell.bending_share for cell in self.cells])

    @property
    def contact_share(self) -> Array:
        """Share of contact in the energy at each cell."""
        return np.array([cell.contact_share for cell in self.cells])

    @property
    def contact_overtakes_at_strain(self) -> float | None:
        """Strain at which contact first makes up half of the energy (linear between points).

        0 if it does from the start, None if bending dominates throughout (paper, Fig. S7).
        """
        above = np.flatnonzero(self.contact_share >= 0.5)
        if not len(above):
            return None
        pair = slice(max(above[0] - 1, 0), above[0] + 1)
        return float(np.interp(0.5, self.contact_share[pair], self.strain[pair]))

    @property
    def seconds(self) -> float:
        """CPU time of the whole sweep, without the force-free cell."""
        return float(sum(cell.seconds for cell in self.cells))

    @property
    def converged(self) -> bool:
        """Tell whether every cell converged."""
        return all(cell.converged for cell in self.cells)

    def _repr_html_(self) -> str:
        drawn = [(f"pulled {self.direction}-wise", self.strain, self.stress_n_per_mm, None)]
        caption = f"{len(self.cells)} relaxed cells; {len(self.jumps)} jumps"
        picture = showing.curves(drawn, "strain", "stress, N/mm")
        return showing.captioned(picture, caption, *self.notes)

    def _strain(self, direction: Direction) -> Array:
        rest = self.zero.cell_mm(direction)
        return np.array([cell.cell_mm(direction) / rest - 1.0 for cell in self.cells])
