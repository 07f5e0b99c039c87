"""Check stretch tests for slack, strains not zeroed, and units or signs that cannot be right.

A strain that begins late is corrected and told, where the readings leave no doubt. What cannot be
corrected with certainty is refused if it is impossible for knitted fabric, and told if it is rare.
"""

from dataclasses import replace

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.measure.stretch_test import StretchRun, StretchTest

STIFF_N_PER_MM = (0.002, 2.0)
"""Force per width over strain, half-way up a pull, that knitted fabric usually has: from lace to a
dense double knit. Farther than a factor of five outside, the units are wrong."""
IMPOSSIBLE = 5.0
APART = 40.0
"""Ratio of the stiffness of the two directions beyond which one of them is in another unit; ribs
reach about 20."""
NARROW_MM = 20.0
"""A strip narrower than this is rare; a width of 7 may be 7 cm."""
ZERO_STRAIN = 0.005
"""Strain of the first reading from which on a pull was not zeroed."""
AT_REST = 0.02
"""Force over the largest one below which a strip hangs free."""
MIN_SLACK = 0.008
"""Smallest strain that counts as slack."""
WIDENS = 0.1
"""Widening over strain at the end of a pull, beyond which the sign is wrong."""
_WINDOW = 0.25
"""Force over the largest one up to which the beginning of a pull is looked at."""
_CLEARER = 3.0
"""How many times smaller the squared misfit must be with slack than without."""


def plausible(run: StretchRun, notes: list[str]) -> StretchRun:
    """A pull whose strain begins where its force does; what was corrected is noted.

    With a slack s the strip is longer at rest, so that strains become (e - s) / (1 + s).

    Raises
    ------
    InputError
        If the strain looks like a stretch ratio, or the fabric widens.
    """
    _check_ratio(run)
    _check_waist(run)
    first, at_rest = float(run.strain_along[0]), AT_REST * float(run.stress.max())
    if abs(first) > ZERO_STRAIN:
        if run.stress[0] > at_rest:
            notes.append(
                f"{run.name} begins at a strain of {first:.3f} and under load, so the length at"
                " rest is uncertain: zero the strain before the pull."
            )
            return run
        run = _from(run, first)
        notes.append(f"{run.name}: strains are counted from the first reading, {first:.3f}.")
    start = slack(run)
    if start > 0:
        run = _from(run.only(run.strain_along >= start), start)
        notes.append(
            f"{run.name}: the force begins to rise at a strain of {start:.3f}; the slack before is"
            " left out, and strains are counted from there."
        )
    elif run.stress[0] > 2 * at_rest:
        notes.append(
            f"{run.name} begins under {run.stress[0]:.3g} N/mm: a preload, or a force that was not"
            " zeroed. Strains count from there."
        )
    return run


def slack(run: StretchRun) -> float:
    """Strain at which the force begins to rise; 0 where it does from the first reading on.

    A parabola that begins at rest is compared with one that begins at a later strain, rises at once
    and is preceded by nothing. Cloth that unfolds slowly is a parabola from the beginning.
    """
    strain, stress = run.strain_along, run.stress
    end = int(np.argmax(stress > _WINDOW * stress.max()))
    if end < 12:
        return 0.0
    x, y = strain[:end], stress[:end]
    tried = np.unique(x[(x >= MIN_SLACK) & (x < 0.7 * x[-1])])
    tried = tried[:: max(1, len(tried) // 60)]
    without, _ = _misfit(x, y, 0.0)
    if not tried.size:
        return 0.0
    fits = [_misfit(x, y, float(start)) for start in tried]
    best = int(np.argmin([misfit for misfit, _ in fits]))
    misfit, slope = fits[best]
    start = float(tried[best])
    usual = y[-1] / (x[-1] - start)
    before = x < start
    sharp = slope > 0.4 * usual
    level = before.sum() >= 4 and abs(np.median(y[before])) < AT_REST * stress.max()
    return start if sharp and level and without > _CLEARER * misfit else 0.0


def _misfit(x: Array, y: Array, start: float) -> tuple[float, float]:
    """Sum of squares of a parabola from a start on, and its first slope."""
    beyond = np.maximum(x - start, 0.0)
    columns = np.stack([beyond, beyond**2], axis=1)
    slopes, *_ = np.linalg.lstsq(columns, y, rcond=None)
    return float(((columns @ slopes - y) ** 2).sum()), float(slopes[0])


def _from(run: StretchRun, start: float) -> StretchRun:
    across = run.strain_across - (run.strain_across[0] if np.isfinite(run.strain_across[0]) else 0)
    return replace(run, strain_along=(run.strain_along - start) / (1 + start), strain_across=across)


def _check_ratio(run: StretchRun) -> None:
    along, across = float(run.strain_along[0]), float(run.strain_across[0])
    if abs(along - 1) < 0.05 and (not np.isfinite(across) or abs(across - 1) < 0.05):
        problem = f"begins at {along:.3g}, so it looks like a stretch ratio, length over length."
        remedy = "Subtract 1: strain is change of length over length at rest."
        raise InputError(f"{run.name}, strain_along", problem, remedy)


def _check_waist(run: StretchRun) -> None:
    top = int(np.argmax(run.strain_along))
    across, along = float(run.strain_across[top]), float(run.strain_along[top])
    if across > WIDENS * along:
        problem = f"says that the fabric is {across:.0%} wider at a strain of {along:.2f}."
        remedy = "Fabric that is pulled narrows: give narrowing as a negative strain."
        raise InputError(f"{run.name}, column strain_across", problem, remedy)


def check_units(course: StretchTest, wale: StretchTest) -> list[str]:
    """Notes about forces and widths that are rare for knitted fabric.

    Raises
    ------
    InputError
        If they are impossible, so that a unit must be wrong.
    """
    tests = {Direction.COURSE: course, Direction.WALE: wale}
    stiffness = {d: _stiffness(test) for d, test in tests.items()}
    low, high = STIFF_N_PER_MM
    notes = []
    for direction, value in stiffness.items():
        test, other = tests[direction], stiffness[direction.other]
        outside = max(value / high, low / value)
        apart = max(value / other, other / value)
        how = f"carries {value:.3g} N/mm per strain"
        guess = _guess(test, tests[direction.other])
        if outside > IMPOSSIBLE or (outside > 1 and apart > APART):
            remedy = f"Give the force in newton and the width in mm.{guess}"
            raise InputError(
                f"{test.source}, force over width", f"{how}; knitted fabric carries {low:g} to"
                f" {high:g}.", remedy,
            )  # fmt: skip
        if outside > 1 or (apart > APART and value > other):
            notes.append(
                f"{test.source} {how}, which is rare for knitted fabric (the other direction"
                f" carries {other:.3g}): check that force is in newton and width in mm.{guess}"
            )
    return notes


def _guess(test: StretchTest, other: StretchTest) -> str:
    width, beside = test.width_mm[0], other.width_mm[0]
    for factor, unit in ((10, "cm"), (1000, "m"), (25.4, "inches")):
        if abs(width * factor / beside - 1) < 0.02:
            return f" A width of {width:g} beside {beside:g} looks like {unit}."
    return f" A width of {width:g} may be in cm." if width < NARROW_MM else ""


def _stiffness(test: StretchTest) -> float:
    """Force per width over strain where the force is half of the largest, N/mm."""
    run = test.pooled()
    half = np.abs(run.stress - 0.5 * np.max(run.stress))
    near = half <= np.quantile(half, 0.1)
    strain = float(np.median(run.strain_along[near]))
    return float(np.median(run.stress[near])) / max(strain, 1e-3)
