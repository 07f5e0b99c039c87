"""Check stretch tests for slack, strains not zeroed, and units or signs that cannot be right.

A strain that begins late is corrected, with a note, where the readings leave no doubt. What cannot
be corrected with certainty is refused if it is impossible for knitted fabric, and noted if it is
rare. In both cases a doubt lists the ways in which the table may be meant.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction, Fabric
from knitcore.measure.stretch_test import StretchRun, StretchTest
from knitcore.measure.table_reading import (
    Doubt,
    DoubtError,
    OtherReading,
    TableReading,
    doubt_of_width,
)
from knitcore.measure.tester_tables import RATIO, UNITS

STIFF_N_PER_MM = (0.002, 2.0)
"""Force per width over strain, half-way up a pull, that knitted fabric usually has: from lace to a
dense double knit. Farther than a factor of five outside, the units are wrong."""
IMPOSSIBLE = 5.0
APART = 40.0
"""Ratio of the stiffness of the two directions beyond which one of them is in another unit; ribs
reach about 20."""
ZERO_STRAIN = 0.005
"""Strain of the first reading from which on a pull was not zeroed."""
AT_REST = 0.02
"""Force over the largest one below which a strip hangs free."""
MIN_SLACK = 0.008
"""Smallest strain that counts as slack."""
WIDENS = 0.1
"""Widening over strain at the end of a pull, beyond which the sign is wrong."""
_NEAR_ONE = 0.05
MOST_STRAIN = 3.0
"""Strain that no knitted fabric reaches before it locks; ribs reach about 2."""
_WINDOW = 0.25
"""Force over the largest one up to which the beginning of a pull is looked at."""
_CLEARER = 3.0
"""How many times smaller the squared misfit must be with slack than without."""


def plausible(
    run: StretchRun, reading: TableReading, notes: list[str], doubts: list[Doubt]
) -> StretchRun:
    """A pull whose strain begins where its force does; what was corrected is noted.

    With a slack s the strip is longer at rest, so that strains become (e - s) / (1 + s).

    Parameters
    ----------
    run : as it stands in the file.
    reading : says whether slack is left out.
    notes, doubts : what is added to.

    Raises
    ------
    DoubtError
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
        longer = "longer" if first > 0 else "shorter"
        notes.append(
            f"{run.name}: strains are counted from the first reading, {first:.3f}, as if the strip"
            f" was {abs(first):.1%} {longer} at rest."
        )
    start = slack(run)
    if start > 0:
        doubts.append(_slack_doubt(run, start))
    if start > 0 and reading.keeps_slack:
        notes.append(
            f"{run.name}: the force begins to rise at a strain of {start:.3f}; strains are counted"
            " from the first reading all the same."
        )
    elif start > 0:
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


def _slack_doubt(run: StretchRun, start: float) -> Doubt:
    left_out = OtherReading("it hung slack: count strains from there", {"keeps_slack": False})
    kept = OtherReading("it unfolds: count from the first reading", {"keeps_slack": True})
    problem = f"The force begins to rise at a strain of {start:.3f}."
    return Doubt(run.name, problem, "", (left_out, kept), is_open=False)


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
    """Refuse strains that begin at 1: each may be a length over the length at rest."""
    strains = {"strain_along": run.strain_along, "strain_across": run.strain_across}
    ratios = [name for name, values in strains.items() if abs(float(values[0]) - 1) < _NEAR_ONE]
    if not ratios:
        return
    values = strains[ratios[0]]
    last = float(values[np.argmax(np.abs(values - 1))])
    problem = f"begins at {values[0]:.3g}, so it looks like a stretch ratio, length over length."
    remedy = "Subtract 1: strain is change of length over length at rest."
    words = f"stretch ratio: {last:.3g} is a strain of {last - 1:.3g}"
    answer = OtherReading(words, {"units": dict.fromkeys(ratios, RATIO)})
    raise DoubtError.of(f"{run.name}, {ratios[0]}", problem, remedy, answer)


def _check_waist(run: StretchRun) -> None:
    top = int(np.argmax(run.strain_along))
    across, along = float(run.strain_across[top]), float(run.strain_along[top])
    if across > WIDENS * along:
        raise DoubtError.of(
            f"{run.name}, column strain_across",
            f"says that the fabric is {across:.0%} wider at a strain of {along:.2f}.",
            "Fabric that is pulled narrows: give narrowing as a negative strain.",
            OtherReading(f"it narrows by {across:.0%}", {"narrowing_is_positive": True}),
            OtherReading("leave the strain across out", {"columns": {"strain_across": ""}}),
        )


def check_units(course: StretchTest, wale: StretchTest) -> list[str]:
    """Notes about forces and widths that are rare for knitted fabric.

    Raises
    ------
    DoubtError
        If they are impossible, or fit another unit only.
    """
    notes = []
    for doubts in unit_doubts(course, wale).values():
        for doubt in doubts:
            if doubt.is_open:
                raise DoubtError.about(doubt)
            notes.append(doubt.note)
    notes += [
        f"{test.source}: the strip is shorter ({test.length_mm:g} mm) than wide "
        f"({min(test.width_mm):g} mm), so its clamps keep it from narrowing."
        for test in (course, wale)
        if test.length_mm is not None and test.length_mm < min(test.width_mm)
    ]
    return notes


def unit_doubts(course: StretchTest, wale: StretchTest) -> dict[Direction, list[Doubt]]:
    """Doubts about the units of each test, from the other one and from what fabric carries.

    What the user has stated is not doubted.
    """
    tests = {Direction.COURSE: course, Direction.WALE: wale}
    doubts: dict[Direction, list[Doubt]] = {}
    for direction, test in tests.items():
        sizes = [_size_doubt(test, tests[direction.other], name) for name in _SIZES]
        known = [doubt for doubt in (*sizes, _strain_doubt(test)) if doubt is not None]
        doubts[direction] = known or [*_stiffness_doubts(test, tests[direction.other])]
    return doubts


_SIZES = ("width_mm", "length_mm")
_FORCES = ("cN", "g", "mN", "kN", "kg")


def _size_doubt(test: StretchTest, other: StretchTest, name: str) -> Doubt | None:
    """The doubt about a width or a length that agrees with the other test's in another unit."""
    of, beside = ((t.width_mm[0] if name == "width_mm" else t.length_mm) for t in (test, other))
    if of is None or beside is None or name in test.sure:
        return None
    return doubt_of_width(test.source, of, beside_mm=(beside,), name=name)


def _strain_doubt(test: StretchTest) -> Doubt | None:
    """The doubt about a strain that is too large, which may be in per cent or another column."""
    largest = test.largest_strain
    if largest <= MOST_STRAIN or "strain_along" in test.sure:
        return None
    percent = dict.fromkeys(("strain_along", "strain_across"), "%")
    in_percent = OtherReading(f"per cent: {largest / 100:.3g}", {"units": percent})
    stands = OtherReading(f"{largest:.3g}, as it stands", {"units": {"strain_along": "1"}})
    return Doubt(
        f"{test.source}, strain_along",
        f"reaches {largest:.3g}; no knitted fabric becomes {1 + largest:.3g} times as long.",
        "Give strain as change of length over length at rest; are force and strain exchanged?",
        (stands,) if "length_mm" in test.sure else (in_percent, stands),
    )


def _stiffness_doubts(test: StretchTest, other: StretchTest) -> Iterator[Doubt]:
    if "force_n" in test.sure:
        return
    value, beside = _stiffness(test), _stiffness(other)
    low, high = STIFF_N_PER_MM
    outside, apart = max(value / high, low / value), max(value / beside, beside / value)
    is_impossible = outside > IMPOSSIBLE or (outside > 1 and apart > APART)
    if not is_impossible and not (outside > 1 or (apart > APART and value > beside)):
        return
    answers = [
        (
            value * UNITS["force"][unit.lower()],
            OtherReading(f"{unit}", {"units": {"force_n": unit}}),
        )
        for unit in _FORCES
    ]
    width = None if "width_mm" in test.sure else doubt_of_width(test.source, test.width_mm[0])
    for reading in width.readings[:-1] if width else ():
        scale = test.width_mm[0] / reading.changes["width_mm"]
        answers.append((value * scale, replace(reading, words=f"width in {reading.words}")))
    fitting = [
        (round(abs(np.log10(v / beside))), reading)
        for v, reading in answers
        if low <= v <= high and max(v / beside, beside / v) < min(apart, APART)
    ]
    likely = [reading for _, reading in sorted(fitting, key=lambda pair: pair[0])[:3]]
    stands = OtherReading("N, as it stands", {"units": {"force_n": "N"}})
    guess = f" It may be in {' or '.join(r.words for r in likely)}." if likely else ""
    if is_impossible:
        problem = (
            f"carries {value:.3g} N/mm per strain; knitted fabric carries {low:g} to {high:g}."
        )
    else:
        problem = (
            f"carries {value:.3g} N/mm per strain, which is rare for knitted fabric (the other "
            f"direction carries {beside:.3g})."
        )
    yield Doubt(
        f"{test.source}, force over width", problem,
        f"Give the force in newton and the width in mm.{guess}",
        (*likely, stands), is_open=is_impossible,
    )  # fmt: skip


_SOFTER = {
    Fabric.STOCKINETTE: Direction.COURSE,
    Fabric.RIB: Direction.COURSE,
    Fabric.GARTER: Direction.WALE,
}
"""The direction in which a fabric gives way more in all yarns that were measured."""
_CLEARLY = 2.0


def order_doubt(course: StretchTest, wale: StretchTest, fabric: Fabric) -> Doubt | None:
    """The doubt whether the tests of a fabric are exchanged: the wrong one is clearly softer."""
    stiffness = {Direction.COURSE: _stiffness(course), Direction.WALE: _stiffness(wale)}
    softer = _SOFTER.get(fabric)
    if softer is None or stiffness[softer] < _CLEARLY * stiffness[softer.other]:
        return None
    words = {Direction.COURSE: "rows", Direction.WALE: "columns"}
    return Doubt(
        f"{course.source} and {wale.source}",
        f"say that this {fabric} is {stiffness[softer] / stiffness[softer.other]:.3g} times stiffer"
        f" along its {words[softer]}; that of other yarns is softer there.",
        "Are the two files exchanged?",
        (OtherReading("exchange them", exchanges=True), OtherReading("they stand as they are")),
        is_open=False,
    )


def _stiffness(test: StretchTest) -> float:
    """Force per width over strain where the force is half of the largest, N/mm."""
    run = test.pooled()
    half = np.abs(run.stress - 0.5 * np.max(run.stress))
    near = half <= np.quantile(half, 0.1)
    strain = float(np.median(run.strain_along[near]))
    return float(np.median(run.stress[near])) / max(strain, 1e-3)
