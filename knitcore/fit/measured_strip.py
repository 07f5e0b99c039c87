"""A stretch test as a fit sees it: force and waist at some strains, and the strip simulated."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.cloth.flat.grid import QuarterGrid
from knitcore.cloth.flat.grid_sheet import Sheet
from knitcore.cloth.flat.sheet_models import SheetModel
from knitcore.cloth.flat.strip import Clamps, pull, waist_strain
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials.law_uncertainty import QUIET_STRESS_N_PER_MM
from knitcore.measure.stretch_test import StretchRun, StretchTest

LEVELS = 14
"""Strains at which force and waist are compared."""
BINS = 80
"""Strain intervals over which a pull is averaged first."""
CELLS = 10
"""Cells across the shorter side of the strip."""
MAX_CELLS = 60
FORCE_NOISE = 0.04
"""Relative error of a force that a fit may leave, above about ``QUIET_STRESS_N_PER_MM``."""
WAIST_NOISE = 0.015
"""Error of a measured waist strain that a fit may leave."""


@dataclass(frozen=True, eq=False)
class MeasuredStrip:
    """A test as the fit sees it.

    Attributes
    ----------
    direction : of the pull.
    width_mm, length_mm : of the strip at rest; length None where it is unknown.
    strain : (levels,) clamp to clamp, increasing.
    stress_n_per_mm, waist : (pulls, levels); NaN where a pull does not reach, or the strain across
        was not measured.
    across_mm : distance at rest of the two points, half-way between the clamps and as far from the
        middle, between which the waist is read; None for the edges.
    """

    direction: Direction
    width_mm: float
    length_mm: float | None
    strain: Array
    stress_n_per_mm: Array
    waist: Array
    across_mm: float | None = None

    @classmethod
    def of(cls, test: StretchTest, direction: Direction) -> MeasuredStrip:
        """A test at equal steps of strain, as far as half of its pulls go.

        Raises
        ------
        InputError
            If no pull covers that range.
        """
        top = test.usual_strain
        strain = np.linspace(0.08, 0.995, LEVELS) * top
        columns = [_resampled(run, strain, top) for run in test.runs]
        stress, waist = (np.array(part) for part in zip(*columns, strict=True))
        if not np.all(np.isfinite(stress).any(axis=0)):
            problem = "has no readings over part of the pull."
            raise InputError(test.source, problem, "Give readings from rest to the largest force.")
        width = float(np.mean(test.width_mm))
        across = None if test.across_mm is None else min(test.across_mm, width)
        return cls(direction, width, test.length_mm, strain, stress, waist, across)

    def without(self, index: int) -> MeasuredStrip:
        """The test with one pull left out."""
        keep = np.arange(len(self.stress_n_per_mm)) != index
        return replace(self, stress_n_per_mm=self.stress_n_per_mm[keep], waist=self.waist[keep])

    @property
    def pulls(self) -> int:
        """Number of pulls."""
        return len(self.stress_n_per_mm)

    @property
    def means(self) -> tuple[Array, Array]:
        """Mean stress and waist over the pulls, (levels,); NaN where none reaches."""
        with np.errstate(invalid="ignore"):
            stress, waist = (
                np.nansum(values, axis=0) / np.isfinite(values).sum(axis=0)
                for values in (self.stress_n_per_mm, self.waist)
            )
        return np.asarray(stress), np.asarray(waist)

    def sheet(self, law: ConstitutiveLaw, cells: int = CELLS) -> Sheet:
        """A strip of the measured size."""
        if self.length_mm is None:  # strains evenly, so that any mesh is exact
            return Sheet(QuarterGrid.uniform(2, 2, 10.0, 10.0), [law], SheetModel())
        sides = (self.length_mm, self.width_mm)
        width, height = self.direction.of(sides, sides[::-1])
        step = min(sides) / cells
        columns, rows = (min(MAX_CELLS, round(side / step)) for side in (width, height))
        return Sheet(QuarterGrid.uniform(columns, rows, width, height), [law], SheetModel())

    def simulate(
        self, law: ConstitutiveLaw, strain: Array | None = None, cells: int = CELLS
    ) -> tuple[Array, Array]:
        """Stress (N/mm) and waist strain at the test's strains; NaN beyond what converges."""
        levels = self.strain if strain is None else strain
        clamps = Clamps.SLIDING if self.length_mm is None else Clamps.CLAMPED
        run = pull(self.sheet(law, cells), self.direction, levels, clamps=clamps)
        stress, waist = np.full(len(levels), np.nan), np.full(len(levels), np.nan)
        stress[: run.steps] = run.stress_n_per_mm
        waist[: run.steps] = [self._waist(run.sheet.grid, s.corners) for s in run.states]
        return stress, waist

    def _waist(self, grid: QuarterGrid, corners: Array) -> float:
        """Strain between the points where the test reads it."""
        if self.across_mm is None or self.length_mm is None:
            return waist_strain(grid, corners, self.direction)
        shape = (grid.rows + 1, grid.columns + 1)
        across = self.direction.other.axis
        rest, now = (p[:, across].reshape(shape) for p in (grid.corners, corners))
        if self.direction is Direction.COURSE:
            rest, now = rest.T, now.T
        middle = [(len(rest) - 1) // 2, len(rest) // 2]
        points = self.across_mm * np.array([-0.5, 0.5]) + rest[0].mean()
        left, right = np.interp(points, rest[0], now[middle].mean(axis=0))
        return float((right - left) / self.across_mm - 1)


def _resampled(run: StretchRun, strain: Array, top: float) -> tuple[Array, Array]:
    mean = run.averaged(BINS, top)
    along = mean.strain_along
    if not mean.length:
        return np.full(len(strain), np.nan), np.full(len(strain), np.nan)
    outside = (strain < along[0] - top / LEVELS) | (strain > along[-1] + top / BINS)
    return tuple(
        np.where(outside, np.nan, np.interp(strain, along, values))
        for values in (mean.stress, mean.strain_across)
    )  # type: ignore[return-value]


def force_noise(stress_n_per_mm: Array) -> Array:
    """Error of a force per width (N/mm) that a fit may leave."""
    return np.asarray(FORCE_NOISE * np.hypot(stress_n_per_mm, QUIET_STRESS_N_PER_MM))
