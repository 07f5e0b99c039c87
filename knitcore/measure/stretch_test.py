"""Uniaxial stretch tests as arrays: returned by the readers, taken by the fit."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

import numpy as np
import scipy

from knitcore.base.arrays import Array, Mask
from knitcore.base.bounds import check_positive
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.measure.table_reading import Doubt, DoubtError, OtherReading

MIN_POINTS = 20
"""Fewest points of a pull; with fewer, a linear part looks like a stiffening one."""
PERCENT_STRAIN = 6.0
"""A strain above this (600 %) must be in per cent: no knit reaches it before it locks."""
SPIKE_SHARE = 0.1
"""Distance from the median of the six neighbours, over the peak, that marks a misreading."""
FALL_SHARE = 0.35
"""Fall below the running maximum, over the peak, that marks an unloading or a rupture."""
_NAMED = re.compile(r"(?<![a-z])(course|wale)(?:wise)?(?![a-z])", re.IGNORECASE)
"""A direction by name in a description or a file's name."""


@dataclass(frozen=True, eq=False)
class StretchRun:
    """One pull of one sample; arrays of one length.

    Attributes
    ----------
    name : where the run comes from, for messages.
    strain_along, strain_across : engineering strains, dimensionless.
    stress : N/mm, force per clamped width.
    """

    name: str
    strain_along: Array
    strain_across: Array
    stress: Array

    @property
    def length(self) -> int:
        """Number of points."""
        return len(self.stress)

    def only(self, points: slice | Mask) -> StretchRun:
        """The run with some of its points."""
        return StretchRun(
            self.name, self.strain_along[points], self.strain_across[points], self.stress[points]
        )

    def averaged(self, steps: int, top: float, *, below: bool = False) -> StretchRun:
        """Means over equal steps of the strain along, which removes a camera's noise.

        Parameters
        ----------
        steps : from a strain of 0 to ``top``; those without a point are left out.
        top : points beyond it are left out.
        below : whether points just below 0, noise at rest, belong to the first step.
        """
        inside = (self.strain_along <= top) & ((self.strain_along >= 0.0) | below)
        place = (self.strain_along[inside] * steps / top).astype(np.intp).clip(0, steps - 1)
        count = np.bincount(place, minlength=steps)
        along, across, stress = (
            np.bincount(place, values[inside], minlength=steps)[count > 0] / count[count > 0]
            for values in (self.strain_along, self.strain_across, self.stress)
        )
        return StretchRun(self.name, along, across, stress)


@dataclass(frozen=True, eq=False, repr=False)
class StretchTest(Result):
    """Repeated pulls of one fabric in one direction.

    Attributes
    ----------
    source : file name, for messages.
    description : of the sample, from the file ("" if there is none).
    runs : at least one.
    width_mm : clamped width at rest, per run.
    length_mm : distance of the clamps at rest; None where the file does not say.
    notes : readings left out and why, in sentences.
    across_mm : distance at rest of the points between which the strain across is read; None for
        the edges.
    doubts : about a reading that was made in one of several ways.
    sure : names of the quantities whose size the user has stated.
    """

    source: str
    description: str
    runs: tuple[StretchRun, ...]
    width_mm: tuple[float, ...]
    notes: tuple[str, ...] = field(default=())
    length_mm: float | None = None
    across_mm: float | None = None
    doubts: tuple[Doubt, ...] = ()
    sure: frozenset[str] = frozenset()

    @property
    def peak_stress(self) -> float:
        """Largest stress of all runs (N/mm)."""
        return max(float(run.stress.max()) for run in self.runs)

    @property
    def largest_strain(self) -> float:
        """Largest strain along the pull of all runs."""
        return max(float(run.strain_along.max()) for run in self.runs)

    @property
    def usual_strain(self) -> float:
        """Largest strain along the pull that at least half of the runs reach."""
        ends = sorted(float(run.strain_along.max()) for run in self.runs)
        return ends[(len(ends) - 1) // 2]

    def pooled(self) -> StretchRun:
        """All points of all runs, one after the other."""
        return StretchRun(
            name=self.source,
            strain_along=np.concatenate([run.strain_along for run in self.runs]),
            strain_across=np.concatenate([run.strain_across for run in self.runs]),
            stress=np.concatenate([run.stress for run in self.runs]),
        )

    def without(self, index: int) -> StretchTest:
        """The test with one run left out (for the jackknife)."""
        keep = [i for i in range(len(self.runs)) if i != index]
        return replace(
            self,
            runs=tuple(self.runs[i] for i in keep),
            width_mm=tuple(self.width_mm[i] for i in keep),
        )

    def with_width(self, width_mm: float) -> StretchTest:
        """The test with another clamped width: stress is force over that one.

        Raises
        ------
        InputError
            If it is not a positive width.
        """
        check_positive("width_mm", width_mm, "mm", "a width")
        runs = tuple(
            replace(run, stress=run.stress * (old / width_mm))
            for run, old in zip(self.runs, self.width_mm, strict=True)
        )
        sure = self.sure | {"width_mm"}
        return replace(self, runs=runs, width_mm=(width_mm,) * len(runs), sure=sure)


def misread_forces(force: Array) -> Mask:
    """Isolated readings far from their neighbours (a digit misread from a display)."""
    if len(force) < 7:
        return np.zeros(len(force), dtype=bool)
    away = np.abs(force - scipy.ndimage.median_filter(force, size=7, mode="nearest"))
    return away > SPIKE_SHARE * float(force.max(initial=0.0))


def until_unloaded(run: StretchRun) -> StretchRun:
    """A pull up to its largest stress, if it is unloaded or tears afterwards."""
    peak = int(np.argmax(run.stress))
    lowest = float(run.stress[peak:].min(initial=np.inf))
    if peak < MIN_POINTS or lowest > (1 - FALL_SHARE) * run.stress[peak]:
        return run
    return run.only(slice(0, peak + 1))


def check_run(run: StretchRun, *, first_row: int = 1) -> None:
    """Refuse a run that cannot be fitted.

    Parameters
    ----------
    run : the run, free of NaN.
    first_row : row number of the first point in its file, for messages.

    Raises
    ------
    InputError
        If the points are too few, a strain is in percent, the columns are exchanged, the force is
        in another unit, falls, or never rises.
    """
    if run.length < MIN_POINTS:
        remedy = f"Give at least {MIN_POINTS} points between rest and the largest force."
        raise InputError(run.name, f"has {run.length} usable points.", remedy)
    _check_percent(run, first_row)
    _check_stress(run, first_row)
    for name, values in (("strain_along", run.strain_along), ("force", run.stress)):
        if np.ptp(values) == 0:
            remedy = "Give the readings of a pull from rest to the largest force."
            raise InputError(f"{run.name}, {name}", "is the same in every row.", remedy)
    along, across = run.strain_along, run.strain_across
    if along.max() < 0.01:
        problem = f"the strain along the pull never exceeds {along.max():.4f}."
        remedy = "Give strain as change of length over initial length, and the whole pull."
        raise InputError(run.name, problem, remedy)
    if across[np.argmax(along)] > 0.5 * along.max() and np.ptp(across) > np.ptp(along):
        remedy = "Exchange strain_along and strain_across, or course and wale."
        raise InputError(run.name, "the sample grows more across than along the pull.", remedy)
    if _rank_correlation(along, run.stress) < 0.3:
        problem = "the force does not grow with the strain along the pull."
        remedy = "Check that force and strain belong to the same run and are in the same order."
        raise InputError(run.name, problem, remedy)


def _check_percent(run: StretchRun, first_row: int) -> None:
    along, across = run.strain_along, run.strain_across
    looks, narrower = "looks like a strain in percent (%).", "-0.05 means 5 % narrower"
    negative = f"would make the width negative; it {looks}"
    for name, values, wrong, how, example in (
        ("strain_along", along, np.abs(along) > PERCENT_STRAIN, looks, "0.25 means 25 %"),
        ("strain_across", across, across > PERCENT_STRAIN, looks, narrower),
        ("strain_across", across, across <= -1, negative, narrower),
    ):
        if wrong.any():
            worst = int(np.argmax(np.where(wrong, np.abs(values), 0.0)))
            problem = f"{values[worst]:.4g} in row {worst + first_row} {how}"
            remedy = f"Divide the strains by 100: {example}."
            units = dict.fromkeys(("strain_along", "strain_across"), "%")
            percent = OtherReading(f"per cent: {values[worst] / 100:.3g}", {"units": units})
            raise DoubtError.of(f"{run.name}, {name}", problem, remedy, percent)


def _check_stress(run: StretchRun, first_row: int) -> None:
    peak = float(run.stress.max())
    if peak <= 0:
        remedy = "Give tension as a positive force in newton."
        raise InputError(f"{run.name}, force", "never rises above zero.", remedy)
    if peak > 50.0:
        problem = f"gives a stress of {peak:.3g} N/mm, more than yarn carries."
        remedy = "Give the force in newton (not mN, gram or kgf) and the width in mm."
        raise InputError(f"{run.name}, force", problem, remedy)
    pushed = int(np.argmin(run.stress))
    if run.stress[pushed] < -0.5 * peak:
        problem = f"is compression in row {pushed + first_row} ({run.stress[pushed]:.3g} N/mm)."
        remedy = "Give tension as a positive force in newton, zeroed before the pull."
        raise InputError(f"{run.name}, force", problem, remedy)
    fall = np.maximum.accumulate(run.stress) - run.stress
    fallen = fall > FALL_SHARE * peak
    if fallen.mean() > 0.02:
        row = int(np.argmax(fallen)) + first_row
        raise InputError(
            f"{run.name}, force",
            f"is not monotone: it has fallen by more than {FALL_SHARE:.0%} of its peak in row"
            f" {row} and {int(fallen.sum())} rows in all.",
            "Cut the unloading part off; give one pull from rest to the largest force.",
        )


def _rank_correlation(a: Array, b: Array) -> float:
    ranks = [np.argsort(np.argsort(v)).astype(float) for v in (a, b)]
    return float(np.corrcoef(ranks[0], ranks[1])[0, 1])


def check_pair(course: StretchTest, wale: StretchTest) -> tuple[str, ...]:
    """Notes about whether two tests belong together; refuses exchanged directions.

    Raises
    ------
    InputError
        If a file says that it was pulled in the other direction, or both are the same test.
    """
    if _same_points(course, wale):
        problem = f"{wale.source} holds the same points as {course.source}."
        raise InputError("test_wale", problem, "Give one test course-wise and one wale-wise.")
    stated = {d: stated_direction(t) for d, t in zip(Direction, (course, wale), strict=True)}
    for direction, test in zip(Direction, (course, wale), strict=True):
        said = stated[direction]
        if said is not None and said is not direction:
            raise DoubtError.of(
                f"test_{direction}",
                f"{test.source} states that it was pulled {said}-wise.",
                "Give the test pulled along the rows (x) first and the one along the columns (y)"
                " second.",
                OtherReading("exchange the two files", exchanges=True),
            )
    samples = [
        " ".join(w for w in test.description.split() if w not in ("X", "Y", "New")).lower()
        for test in (course, wale)
    ]
    if all(samples) and samples[0] != samples[1]:
        return (
            f"The tests name different samples ({course.description!r}, {wale.description!r}).",
        )
    return ()


def stated_direction(test: StretchTest) -> Direction | None:
    """The direction that description and file name state, if they agree.

    They state it in words (``course``, ``wale``, ``course-wise``), or as a lone X or Y.
    """
    stated = set()
    for text in (test.description, test.source.rsplit(".", 1)[0]):
        named = {Direction(word.lower()) for word in _NAMED.findall(text)}
        letters = [w for w in text.replace("_", " ").replace("-", " ").split() if w in ("X", "Y")]
        if len(named) == 1:
            stated |= named
        elif letters and not named:
            stated.add(Direction.COURSE if letters[-1] == "X" else Direction.WALE)
    return stated.pop() if len(stated) == 1 else None


def _same_points(a: StretchTest, b: StretchTest) -> bool:
    first, second = a.runs[0], b.runs[0]
    return first.length == second.length and bool(
        np.array_equal(first.strain_along, second.strain_along)
        and np.array_equal(first.stress, second.stress)
    )
