"""Several starts on one cell, and the outcome of each."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, ConvergenceError, KnitcoreError, UnravelledError
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.relaxed_cell import StartReport
from knitcore.yarn.model.tiling import refined_state, tiled_state
from knitcore.yarn.solve.clasps import cell_is_knitted
from knitcore.yarn.solve.growth import STAGE, Start, grow, shaken, with_stiff_shell
from knitcore.yarn.solve.newton import Minimum, Options, minimise
from knitcore.yarn.solve.topology import clearance_at

SAME_ENERGY = 1e-3
"""Starts whose energies agree within this part of them are the same minimum."""
SAME_SIZE = 1e-3
"""Relative difference of sizes up to which states that are as low count as the same."""
OVERLONG = 1e-4
"""Relative error of the length beyond which a state does not count."""
_STRAIGHT = 0.9
"""Size over loop length at which a stitch is pulled straight."""

_REMEDY = (
    "Give the stitches more yarn, a thinner yarn, or a core of 0.25 to 0.6 of the radius, as the "
    "paper's yarns have."
)

RELAXED = "relaxed"
UNSETTLED = "not converged"


def lowest_of(minima: Sequence[Minimum]) -> tuple[Minimum, list[Minimum]]:
    """The lowest of some states, by a rule that rounding cannot turn, and the others that are as
    low.

    States whose energies agree within ``SAME_ENERGY`` count as equally low: the first of them is
    taken. Those of the others that differ in size are returned, too.
    """
    least = min(m.terms.energy for m in minima)
    level = [m for m in minima if m.terms.energy <= least * (1.0 + SAME_ENERGY)]
    size = level[0].state[-2:]
    return level[0], [m for m in level[1:] if np.abs(m.state[-2:] / size - 1.0).max() > SAME_SIZE]


def overlong(energy: CellEnergy, minimum: Minimum) -> bool:
    """Tell whether a prescribed length is missed: jammed or locked, not a state of the fabric."""
    lengths = minimum.terms.excess_mm[: len(energy.prescribed_mm)]
    return bool(np.any(np.abs(lengths) > OVERLONG * energy.prescribed_mm))


def outcome(energy: CellEnergy, minimum: Minimum) -> str:
    """``relaxed``, ``not converged``, or why the state is not one of the fabric."""
    if not np.all(np.isfinite(minimum.state)) or not np.isfinite(minimum.terms.energy):
        return "not finite"
    if overlong(energy, minimum):
        return "too little yarn"
    if minimum.min_distance_mm <= 2.0 * energy.yarn.core_radius_mm:
        return "cores overlap"
    if minimum.state[-2] > _STRAIGHT * energy.mean_loop_mm:
        return "pulled straight"
    if not cell_is_knitted(energy.cell, minimum.state):
        return "unravelled"
    return RELAXED if minimum.converged else UNSETTLED


def check_reached(energy: CellEnergy, minimum: Minimum) -> None:
    """Refuse a state on the way of a stretch that is not one of the fabric.

    Raises
    ------
    ConvergenceError, UnravelledError
        If the yarn locks or unravels.
    """
    became = outcome(energy, minimum)
    if became == "unravelled":
        raise UnravelledError("the stitches come undone.")
    if became not in (RELAXED, UNSETTLED, "pulled straight"):
        raise ConvergenceError(f"the yarn locks before it gets there ({became}).")


class Search:
    """Runs starts on one cell and records their outcomes."""

    def __init__(self, energy: CellEnergy, options: Options, cancelled: Cancelled | None) -> None:
        self.energy = energy
        self.options = options
        self.cancelled = cancelled
        self.minima: list[Minimum] = []
        self.reports: list[StartReport] = []
        self.evaluations = 0
        self._errors: list[KnitcoreError] = []
        self._other: tuple[float, Array] | None = None

    def try_starts(self, starts: Sequence[Start]) -> None:
        """Grow the yarn from each of the starts."""
        for start in starts:
            self.run(start.name, partial(self._grow, self.energy, start))

    def continue_from(
        self, smaller: CellEnergy, starts: Sequence[Start], seeds: Sequence[int], *, follow: bool
    ) -> None:
        """Continue from the lowest state of a more symmetric cell, randomly perturbed.

        ``follow`` also starts from it unperturbed: the solver leaves a saddle along the direction
        of lowest curvature.
        """
        mirrored: list[Minimum] = []

        def run(seed: int | None) -> Minimum:
            if not mirrored:
                mirrored.append(self._lowest(smaller, starts))
                per_stitch = mirrored[0].terms.energy / smaller.cell.stitches
                self._other = per_stitch, mirrored[0].state[-2:]
            state = tiled_state(smaller.cell, mirrored[0].state, self.energy.cell)
            if seed is not None:
                state = _shaken_safely(self.energy, state, seed)
            return minimise(self.energy, state, options=self.options, cancelled=self.cancelled)

        if follow:
            self.run("mirrored, followed", partial(run, None))
        for seed in seeds:
            name = "mirrored, shaken" + (f" again ({seed})" if seed != seeds[0] else "")
            self.run(name, partial(run, seed))

    def run(self, name: str, solve: Callable[[], Minimum]) -> None:
        """Run one start and report it."""
        nan = float("nan")
        try:
            minimum = solve()
        except (UnravelledError, ConvergenceError) as error:
            self._errors.append(error)
            self.reports.append(StartReport(name, str(error), nan, nan, nan))
            return
        self.evaluations += minimum.evaluations
        became = outcome(self.energy, minimum)
        self.reports.append(
            StartReport(
                name, became, minimum.terms.energy / self.energy.cell.stitches,
                float(minimum.state[-2]), float(minimum.state[-1]),
            )
        )  # fmt: skip
        if became in (RELAXED, UNSETTLED):
            self.minima.append(minimum)

    def best(self) -> tuple[Minimum, list[Minimum]]:
        """The lowest state of the fabric, and others that are as low (:func:`lowest_of`).

        Raises
        ------
        ConvergenceError, UnravelledError
            If there is none.
        """
        if not self.minima:
            if self._errors:
                if isinstance(self._errors[0], UnravelledError):
                    raise UnravelledError(f"{self._errors[0]} {_REMEDY}")
                raise self._errors[0]
            reasons = ", ".join(sorted({r.outcome for r in self.reports}))
            raise UnravelledError(
                f"No start kept the stitches of this repeat: {reasons}. {_REMEDY}"
            )
        settled = [m for m in self.minima if m.converged] or self.minima
        return lowest_of(settled)

    def refined(self, best: Minimum, energy: CellEnergy, options: Options) -> Minimum:
        """A state on a finer grid.

        Raises
        ------
        ConvergenceError
            If it is not a state of the fabric there.
        """
        state = refined_state(self.energy.cell, best.state, energy.cell)
        tension = None if energy.held.size else best.tension
        finer = self._minimised(energy, state, tension, options)
        if outcome(energy, finer) not in (RELAXED, UNSETTLED):
            # between the old samples the cores may overlap: push them apart first
            apart = self._minimised(
                replace(energy, yarn=with_stiff_shell(energy.yarn)), state, tension, STAGE
            )
            finer = self._minimised(energy, apart.state, apart.tension, options)
        became = outcome(energy, finer)
        if became not in (RELAXED, UNSETTLED):
            raise ConvergenceError(f"The relaxed shape does not hold on a finer grid: {became}.")
        return finer

    def _minimised(
        self, energy: CellEnergy, state: Array, tension: Array | None, options: Options
    ) -> Minimum:
        minimum = minimise(
            energy, state, tension=tension, options=options, cancelled=self.cancelled
        )  # fmt: skip
        self.evaluations += minimum.evaluations
        return minimum

    def notes(self, best: Minimum) -> tuple[str, ...]:
        """Notes for the user: higher minima, and how much the mirrored state differs."""
        notes = []
        energies = [m.terms.energy for m in self.minima]
        others = sum(e > min(energies) * (1.0 + SAME_ENERGY) for e in energies)
        if others:
            notes.append(f"{others} of {len(self.reports)} starts ended in a higher minimum.")
        failed = len(self.reports) - len(self.minima)
        if failed:
            notes.append(f"{failed} of {len(self.reports)} starts failed.")
        if not best.converged:
            notes.append("The solver stopped before its tolerance.")
        if self._other is not None:
            energy, size = self._other
            lower = 1.0 - best.terms.energy / self.energy.cell.stitches / energy
            if lower > SAME_ENERGY:
                wide, high = (float(v) for v in best.state[-2:] / size)
                notes.append(
                    f"The free shape differs from the mirrored one: its energy is {lower:.1%} "
                    f"lower, a stitch {wide:.2f} times as wide and {high:.2f} times as high."
                )
        return tuple(notes)

    def _lowest(self, energy: CellEnergy, starts: Sequence[Start]) -> Minimum:
        """The shape from the first start, unless another start ends distinctly lower."""
        best = self._grow(energy, starts[0])
        self.evaluations += best.evaluations
        for start in starts[1:]:
            try:
                minimum = self._grow(energy, start)
            except (UnravelledError, ConvergenceError):
                continue
            self.evaluations += minimum.evaluations
            lower = minimum.terms.energy < best.terms.energy * (1.0 - SAME_ENERGY)
            if lower and outcome(energy, minimum) == RELAXED:
                best = minimum
        return best

    def _grow(self, energy: CellEnergy, start: Start) -> Minimum:
        return grow(
            energy.cell, energy.yarn, energy.loop_length_mm, energy.convention, start,
            options=self.options, flat=energy.flat, spacing_per_bending=energy.spacing_per_bending,
            cancelled=self.cancelled,
        )  # fmt: skip


def _shaken_safely(energy: CellEnergy, state: Array, seed: int) -> Array:
    """The state displaced at random by 0.02 r or as much less as keeps the yarn apart."""
    radius = energy.yarn.radius_mm
    clearance = clearance_at(energy, state, 3.0)
    # half of the way to the hard cores at most
    room = 0.25 * max(clearance.min_distance_mm - 2.0 * energy.yarn.core_radius_mm, 0.0)
    moved = shaken(energy.cell, state, min(0.02 * radius, 0.3 * room), seed=seed)
    scale, _ = clearance.longest_step(moved, energy.curve(moved), radius)
    return np.asarray(state + scale * (moved - state))
