"""Courses and wales of the stitches that a program knits, and the kind of every stitch.

A pass is what one yarn knits in one direction. A course is made of passes that are not pulled
through each other, such as blocks of colour. A wale is a needle, of either bed; it is a needle of
one bed where one pass knits on both at the same number (a rib with racked beds).

Every kind of stitch has a name here. Charts hold knits and purls: a program with any other kind is
refused by course, needle, line and kind. A kind that charts learn to hold leaves
:data:`NOT_CHARTED`.
"""

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

from knitcore.base.errors import InputError
from knitcore.formats.read.knitout_parts import named, stitches_of
from knitcore.machine.knitout_machine import Loop
from knitcore.machine.program_body import TAG_STITCHES

MOST_LEFT_OUT = 0.25
"""Part of the stitches that may stand below or hang above a piece on other needles."""
NEW_NEEDLES = 0.2
"""Part of a course's needles that make it the beginning of something else."""
MOST_EMPTY_NEEDLES = 3
MOST_INLAID_TUCKS = 3
EDGE_WALES = 2


class StitchWithoutSign(StrEnum):
    """A kind of stitch for which a chart of knits and purls has no sign."""

    TUCK = "a tuck within the piece"
    MISS = "a missed stitch (slip or float)"
    LACE = "a lace transfer: a hole or a decrease within the piece"
    YARN_OVER = "a loop begun on an empty needle within the piece (a yarn over)"
    CABLE = "a cable: stitches change places"
    MOVED = "a loop that came from another needle"
    SPLIT = "a split, which makes two loops of one"
    DROPPED = "a dropped stitch"
    TWO_BEDS = "knitting on both beds (interlock, a tube or a double cloth)"
    SHORT_ROW = "a short row"


NOT_CHARTED = {
    StitchWithoutSign.TUCK: "knit it instead",
    StitchWithoutSign.MISS: "knit every needle in every course",
    StitchWithoutSign.LACE: "shape at the edges only",
    StitchWithoutSign.YARN_OVER: "cast on every needle before the first course",
    StitchWithoutSign.CABLE: "knit without crossing",
    StitchWithoutSign.MOVED: "bring each loop back to its needle before it is knitted",
    StitchWithoutSign.SPLIT: "cast on at the edge instead",
    StitchWithoutSign.DROPPED: "keep its loop",
    StitchWithoutSign.TWO_BEDS: "knit one face of it, each wale on one bed at a time",
    StitchWithoutSign.SHORT_ROW: "knit every course from edge to edge",
}
"""Kinds that are refused, with what to do."""


@dataclass(frozen=True)
class KnittedCourses:
    """Stitches with their columns, course by course, from the bottom."""

    courses: tuple[dict[Loop, int], ...]
    columns: int
    notes: tuple[str, ...]


def fabric_of(loops: Sequence[Loop], stitches: Sequence[Loop]) -> KnittedCourses:
    """Put the stitches of a piece into courses and wales.

    Raises
    ------
    InputError
        If one is of a kind that charts do not hold.
    """
    passes = _passes(loops, stitches)
    if not passes:
        raise InputError(
            "knitout", "the program knits no stitch.", "Give one that knits courses of stitches."
        )
    wale = _Wales(passes)
    courses = _without_tag(_courses(passes), ends_it=stitches[-1].number == _last_knit(loops))
    notes: list[str] = []
    for trimmed in (
        _without_tubular_start,
        _without_other_needles,
        _without_slipped_edges,
        _without_unfinished_start,
    ):
        courses, trimmings = trimmed(courses, wale)
        notes += trimmings
    reading = _Reading(courses, wale)
    reading.check_tucks(loops)
    for row in range(len(courses)):
        reading.check(row)
    notes += reading.notes
    used = sorted({wale(loop) for loop in reading.all})
    notes += _empty_needles(used, wale)
    column = {place: index for index, place in enumerate(used)}
    return KnittedCourses(
        tuple({loop: column[wale(loop)] for run in course for loop in run} for course in courses),
        len(used),
        tuple(notes),
    )


Pass = list[Loop]
Course = list[Pass]


def _last_knit(loops: Sequence[Loop]) -> int:
    return stitches_of(loops)[-1].number


def _passes(loops: Sequence[Loop], stitches: Sequence[Loop]) -> list[Pass | None]:
    """Passes in the order in which they are knitted; None where something else comes between.

    That is a cast-on, a link of a chain, or the work of other yarn.
    """
    mine = set(stitches)
    passes: list[Pass | None] = []
    run: Pass = []
    for loop in loops:
        if loop not in mine:
            if not _is_within_pass(loop):
                run = []
                passes.append(None)
            continue
        if (
            not run
            or run[-1].strand != loop.strand
            or run[-1].rightwards != loop.rightwards
            or any(p.parents and p.number >= run[0].number for p in loop.parents)
        ):
            run = []
            passes.append(run)
        run.append(loop)
    return passes if any(passes) else []


def _is_within_pass(loop: Loop) -> bool:
    """Say whether a yarn that knits on lays a loop: a tie, or a lone one on a free needle."""
    if loop.parents:
        return False
    if loop.onto:
        return True
    beside = (loop.before, loop.after)
    return loop.kind == "knit" and all(o is not None and o.parents for o in beside)


class _Wales:
    """Places of wales across the machine, in half needles."""

    def __init__(self, passes: Iterable[Pass | None]) -> None:
        runs = [run for run in passes if run]
        self.both = next((run for run in runs if _is_on_both_beds(run)), None)
        racks = Counter(o.place - o.needle for run in runs for o in run if o.bed == "b")
        rack = racks.most_common(1)[0][0] if racks else 0.0
        self._back = 2 * math.floor(rack) + (self.both is not None)

    def __call__(self, loop: Loop) -> int:
        return 2 * loop.needle + (self._back if loop.bed == "b" else 0)


def _is_on_both_beds(run: Pass) -> bool:
    beds = {(loop.needle, loop.bed) for loop in run}
    both = sum((needle, "b") in beds for needle, bed in beds if bed == "f")
    return both > 0 and any(loop.place % 1 for loop in run)


def _courses(passes: Iterable[Pass | None]) -> list[Course]:
    courses: list[Course] = []
    begins = True
    first = 0
    for run in passes:
        if run is None:
            begins = True
        elif begins or any(p.parents and p.number >= first for o in run for p in o.parents):
            courses.append([run])
            first, begins = run[0].number, False
        else:
            courses[-1].append(run)
    return courses


def _without_tag(courses: list[Course], *, ends_it: bool) -> list[Course]:
    """Remove the few stitches on one needle that hold a bind-off: its last link, and a tag."""
    tag = TAG_STITCHES + 1
    end = courses[-tag:]
    needles = {loop.needle for course in end for run in course for loop in run}
    stitches = sum(len(run) for course in end for run in course)
    wide_below = len(courses) > tag and sum(map(len, courses[-tag - 1])) > 1
    is_tag = ends_it and wide_below and len(needles) == 1 and stitches == tag
    return courses[:-tag] if is_tag else courses


def _without_tubular_start(courses: list[Course], wale: _Wales) -> tuple[list[Course], list[str]]:
    """Remove first courses that go around: one bed there, the other bed back, no wale in common."""
    first = 0
    while first < len(courses) and _is_around(courses[first], wale):
        first += 1
    above = courses[first] if first < len(courses) else []
    if not first or len(above) != 1 or len({loop.bed for loop in above[0]}) < 2:
        return courses, []
    lines = f"lines {courses[0][0][0].line} to {courses[first - 1][-1][-1].line}"
    note = f"A tubular start ({lines}) is left out as part of the cast-on."
    return courses[first:], [note]


def _is_around(course: Course, wale: _Wales) -> bool:
    beds = [{loop.bed for loop in run} for run in course]
    wales = [{wale(loop) for loop in run} for run in course]
    return (
        len(course) == 2
        and [*map(len, beds)] == [1, 1]
        and beds[0] != beds[1]
        and (
            not wales[0] & wales[1]
            and min(wales[1]) < max(wales[0])
            and min(wales[0]) < max(wales[1])
        )
    )


def _without_slipped_edges(courses: list[Course], wale: _Wales) -> tuple[list[Course], list[str]]:
    """Remove wales at the edge that are knitted in every second course only."""
    stitches: dict[int, list[tuple[int, Loop]]] = {}
    for row, course in enumerate(courses):
        for run in course:
            for loop in run:
                stitches.setdefault(wale(loop), []).append((row, loop))
    used = sorted(stitches)
    slipped = [
        place
        for place in {*used[:EDGE_WALES], *used[-EDGE_WALES:]}
        if len(used) > 2 * EDGE_WALES
        and len(stitches[place]) > 2
        and all(b - a == 2 and o in p.parents for (a, o), (b, p) in pairwise(stitches[place]))
    ]
    if not slipped:
        return courses, []
    names = {o.name for course in courses for run in course for o in run if wale(o) in slipped}
    kept = [[[o for o in run if wale(o) not in slipped] for run in course] for course in courses]
    cleaned = [[run for run in course if run] for course in kept]
    note = (
        f"The edge wale at {', '.join(sorted(names))} is slipped in every second course; it is "
        "left out."
    )
    return [course for course in cleaned if course], [note]


def _without_other_needles(courses: list[Course], wale: _Wales) -> tuple[list[Course], list[str]]:
    """Remove what lies below or above the piece on other needles, such as the start of a rib."""
    needles = [{o.name: wale(o) for run in course for o in run} for course in courses]
    sizes = [len(names) for names in needles]
    total = sum(sizes)
    first, last = 0, len(courses)
    seen: set[str] = set()
    for row, names in enumerate(needles):
        if row and _is_inside(names, seen, needles[row - 1]):
            if sum(sizes[:row]) > MOST_LEFT_OUT * total:
                break
            first = row
        seen |= names.keys()
    seen = set()
    for row in range(len(courses) - 1, first, -1):
        if row + 1 < len(courses) and _is_inside(needles[row], seen, needles[row + 1]):
            if sum(sizes[row + 1 :]) > MOST_LEFT_OUT * total:
                break
            last = row + 1
        seen |= needles[row].keys()
    notes = []
    for part, where in ((courses[:first], "before"), (courses[last:], "after")):
        if part:
            lines = f"lines {part[0][0][0].line} to {part[-1][-1][-1].line}"
            courses_are = "course is" if len(part) == 1 else "courses are"
            notes.append(
                f"{len(part)} {courses_are} knitted on other needles {where} the piece ({lines}) "
                "and left out."
            )
    return courses[first:last], notes


def _without_unfinished_start(
    courses: list[Course], wale: _Wales
) -> tuple[list[Course], list[str]]:
    """Remove a first course that does not reach a needle at the edge that was cast on before it."""
    if len(courses) < 2:
        return courses, []
    begins = courses[0][0][0].number
    here = {wale(loop) for run in courses[0] for loop in run}
    left_over = [
        loop
        for run in courses[1]
        for loop in run
        if wale(loop) not in here
        and all(not parent.parents and parent.number < begins for parent in loop.parents)
    ]
    inside = any(min(here) < wale(loop) < max(here) for loop in left_over)
    if not left_over or inside or len(left_over) > EDGE_WALES:
        return courses, []
    note = (
        f"The first course (line {courses[0][0][0].line}) does not reach needle "
        f"{left_over[0].name}, which is cast on; it is left out as part of the cast-on."
    )
    return courses[1:], [note]


def _is_inside(names: Mapping[str, int], seen: set[str], beside: Mapping[str, int]) -> bool:
    """Say whether a course has many new needles between its outermost ones."""
    low, high = min(beside.values()), max(beside.values())
    new = [name for name, place in names.items() if name not in seen and low < place < high]
    places = set(beside.values())
    added = sum(names[name] not in places for name in new)
    return added >= max(2, NEW_NEEDLES * len(names))


def _empty_needles(used: Sequence[int], wale: _Wales) -> Iterator[str]:
    """Yield notes on needles that stay empty within the piece, such as every second one."""
    steps = {b - a for a, b in pairwise(used)}
    if wale.both is not None:
        yield "Both beds knit at every number, racked between each other: each needle is a wale."
        return
    if len(steps) == 1 and (step := min(steps) // 2) > 1:
        ordinal = {2: "second", 3: "third"}.get(step, f"{step}th")
        yield f"Every {ordinal} needle knits; the wales are taken as neighbours."
    if len(steps) > 1:
        least, most = min(steps), max(steps)
        place = next(a for a, b in pairwise(used) if b - a == most)
        if most - least > 2 * MOST_EMPTY_NEEDLES:
            raise InputError(
                "knitout",
                f"the needles from {place // 2 + 1} on stay empty within the piece.",
                "Give a program for each piece.",
            )
        yield (
            f"Needles within the piece stay empty, the first after {place // 2}; the wales beside "
            "them are taken as neighbours."
        )


class _Reading:
    """The check of every stitch for its kind."""

    def __init__(self, courses: Sequence[Course], wale: _Wales) -> None:
        self.notes: list[str] = []
        self._courses, self._wale = courses, wale
        self._by_wale: list[dict[int, Loop]] = []
        self._row: dict[Loop, int] = {}
        self._colours_noted = False
        for row, course in enumerate(courses):
            self._by_wale.append({wale(o): o for run in course for o in run})
            self._row.update((o, row) for run in course for o in run)
        self.all = list(self._row)
        self._wales = sorted({wale(o) for o in self.all})

    def check_tucks(self, loops: Iterable[Loop]) -> None:
        """Refuse tucks that are neither a cast-on nor tie two yarns of a course."""
        inlaid: list[Loop] = []
        for tuck in loops:
            stitch = tuck.child
            row = self._row.get(stitch) if stitch is not None else None
            if not tuck.onto or stitch is None or not row:
                continue
            laid = self._row_of_pass(tuck)
            if laid is None:
                inlaid.append(tuck)
                if len(inlaid) > MOST_INLAID_TUCKS:
                    raise self._refused(row - 1, inlaid[0], StitchWithoutSign.TUCK)
                continue
            needle_mates = [p for p in stitch.parents if p is not tuck and p in self._row]
            if row != laid and all(self._row[p] != laid for p in needle_mates):
                raise self._refused(laid, tuck, StitchWithoutSign.TUCK)
        if inlaid:
            self.notes.append(
                f"{len(inlaid)} tucks of carrier {named(inlaid[0].carriers)} from line "
                f"{inlaid[0].line} on are left out."
            )

    def _row_of_pass(self, tuck: Loop) -> int | None:
        """The course in which a tuck is laid: that of the stitches beside it on its yarn."""
        before, after = tuck.before, tuck.after
        while before is not None and before not in self._row and not before.parents:
            before = before.before
        while after is not None and after not in self._row and not after.parents:
            after = after.after
        rows = [
            self._row[o]
            for o in (before, after)
            if o in self._row and o.rightwards == tuck.rightwards
        ]
        if rows:
            return rows[0]
        return next((self._row[o] for o in (before, after) if o in self._row), None)

    def check(self, row: int) -> None:
        """Refuse a course with a stitch of another kind."""
        self._check_passes(row)
        course, below = self._by_wale[row], self._by_wale[row - 1] if row else {}
        for place in self._gaps(row):
            self._refuse_gap(row, place)
        for place, loop in course.items():
            if loop.kind == "split":
                raise self._refused(row, loop, StitchWithoutSign.SPLIT)
            own = below.get(place)
            if own is not None and own not in loop.parents:
                kind = self._kind_of_moved(loop, own, below)
                raise self._refused(row, loop, kind)
            places = {self._wale(p): p for p in loop.parents if self._row.get(p) == row - 1}
            if row and any(at != place and at in course for at in places):
                raise self._refused(row, loop, StitchWithoutSign.LACE)
            if row and own is None and any(parent.parents for parent in loop.parents):
                rows = [self._row.get(p, -1) for p in loop.parents if self._wale(p) == place]
                kind = StitchWithoutSign.SHORT_ROW if rows else StitchWithoutSign.MOVED
                raise self._refused(row, loop, kind)

    def _check_passes(self, row: int) -> None:
        """Refuse passes of one course that lie over each other, except for floats of colour."""
        runs = sorted(self._courses[row], key=lambda run: min(map(self._wale, run)))
        end, widest = -math.inf, runs[0]
        for run in runs:
            places = [self._wale(loop) for loop in run]
            if min(places) <= end:
                mine = set(places)
                beds = {o.bed for o in (*run, *widest)}
                clash = any(self._wale(o) in mine for o in widest)
                if clash or len(beds) > 1:
                    raise self._refused(row, run[0], StitchWithoutSign.TWO_BEDS)
                if run[0].strand == widest[0].strand:
                    raise self._refused(row, run[0], StitchWithoutSign.MISS)
                self._tell_colours(row)
            if max(places) > end:
                end, widest = max(places), run
        held = Counter(self._wale(loop) for run in runs for loop in run)
        if len(held) < sum(map(len, runs)):
            place = held.most_common(1)[0][0]
            twice = [loop for run in runs for loop in run if self._wale(loop) == place]
            raise self._refused(row, twice[1], StitchWithoutSign.TWO_BEDS)

    def _tell_colours(self, row: int) -> None:
        if not self._colours_noted:
            self.notes.append(
                f"From course {row + 1} on yarns float behind each other's stitches (stranded "
                "colours); the floats are left out."
            )
        self._colours_noted = True

    def _gaps(self, row: int) -> Iterator[int]:
        course = self._by_wale[row]
        low, high = min(course), max(course)
        if len(course) < sum(low <= place <= high for place in self._wales):
            yield from (p for p in self._wales if low < p < high and p not in course)

    def _refuse_gap(self, row: int, place: int) -> None:
        course, below = self._by_wale[row], self._by_wale[row - 1] if row else {}
        beside = course[max(p for p in course if p < place)]
        own = below.get(place)
        kind, loop = StitchWithoutSign.MISS, beside
        if own is None:
            later = next((held[place] for held in self._by_wale[row + 1 :] if place in held), None)
            begun = later is not None and all(not parent.parents for parent in later.parents)
            if begun:
                kind = StitchWithoutSign.YARN_OVER
            elif any(place in held for held in self._by_wale[:row]):
                kind = StitchWithoutSign.LACE
        elif own.child is None:
            kind = StitchWithoutSign.DROPPED if own.dropped else StitchWithoutSign.MISS
        elif own.child in self._row and self._wale(own.child) != place:
            kind, loop = StitchWithoutSign.LACE, own.child
        held = own or next((h[place] for h in self._by_wale if place in h), loop)
        raise self._refused(row, loop, kind, needle=held.name)

    def _kind_of_moved(self, loop: Loop, own: Loop, below: Mapping[int, Loop]) -> StitchWithoutSign:
        """The kind of a stitch that is not pulled through the one below it."""
        if own.child is None:
            return StitchWithoutSign.DROPPED
        if own.child not in self._row:
            return StitchWithoutSign.MOVED
        moved = [parent for parent in loop.parents if parent in below.values()]
        alone = len(loop.parents) == 1 and len(own.child.parents) == 1
        return StitchWithoutSign.CABLE if moved and alone else StitchWithoutSign.LACE

    def _refused(
        self, row: int, loop: Loop, kind: StitchWithoutSign, *, needle: str | None = None
    ) -> InputError:
        return InputError(
            "knitout",
            f"course {row + 1}, needle {needle or loop.name} (line {loop.line}): {kind}.",
            f"Charts hold knits and purls, shaped at the edges: {NOT_CHARTED[kind]}, or give a "
            "part without it.",
        )
