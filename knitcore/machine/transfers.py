"""Transfer planning: the passes that bring loops to other needles of a two-bed machine.

A pass moves loops from one bed to the needles that face them at one racking: ``f(n + r)`` faces
``bn`` at rack ``r``. Loops are given in the order of the yarn that runs through them, so that
neighbours hang together. Planning searches passes in the order of their number; for each series of
rackings it assigns a way to every loop, from left to right, such that

- every loop reaches its needle, and loops that share a needle arrive in the order given;
- no loop is laid onto one that has to move on, since a needle lets go of all its loops at once;
- neighbours are never further apart than where they start or end, or the yarn to spare allows;
- loops cross only where start and target lie on other sides of each other, and the one meant to lie
  in front does: it is on the front bed when racking carries the other past it. What crosses and
  comes back the same way is not twisted.

This model of slack and the count of passes are those of J. Lin, V. Narayanan and J. McCann,
"Efficient transfer planning for flat knitting", SCF 2018 (collapse-shift-expand; schoolbus with
sliders), for loops of both beds, with cables and a limit to racking. The search differs: for a
series of rackings the assignment is exact, so up to four passes the plan has the fewest of all in
this model; beyond, loops go to the back in one pass and return rack by rack (schoolbus).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations, pairwise, permutations
from typing import Any, NamedTuple

from knitcore.base.errors import InputError

MOST_PASSES = 8
EXACT_PASSES = 4
"""Up to so many passes all series of rackings are tried."""
MOST_SERIES = 3_000
"""Series that are tried for one number of passes, those with little racking first."""
MOST_STATES = 300
"""Assignments kept of the loops on the left, those with few transfers first."""


class Needle(NamedTuple):
    """A needle: its bed, ``f`` or ``b``, and its number."""

    bed: str
    number: int

    def __str__(self) -> str:
        return f"{self.bed}{self.number}"

    def at(self, rack: int) -> int:
        """Its position across the machine: that of the front needle that it is or faces."""
        return self.number + (rack if self.bed == "b" else 0)

    def facing(self, rack: int) -> "Needle":
        """The needle of the other bed that it faces."""
        return Needle("b", self.number - rack) if self.bed == "f" else Needle("f", self.at(rack))


@dataclass(frozen=True)
class LoopMove:
    """A loop, or all loops of a needle, and where they have to go.

    Attributes
    ----------
    start, target : needles.
    order : of arrival on a shared target, from 0; loops of one order arrive as it suits.
    layer : of two loops that cross, the higher layer passes in front; of one layer, as it suits.
    """

    start: Needle
    target: Needle
    order: int = 0
    layer: int = 0


@dataclass(frozen=True)
class TransferPass:
    """One pass of the carriage: transfers from one bed at one racking, from left to right."""

    rack: int
    transfers: tuple[tuple[Needle, Needle], ...]


@dataclass(frozen=True)
class TransferPlan:
    """The passes that move loops, in their order.

    Attributes
    ----------
    moves : what is moved, in the order of the yarn.
    passes : of the carriage.
    places : the loops' needles before each pass and after the last, a row each.
    """

    moves: tuple[LoopMove, ...]
    passes: tuple[TransferPass, ...]
    places: tuple[tuple[Needle, ...], ...]

    @property
    def transfers(self) -> int:
        """Number of transfers from needle to needle."""
        return sum(len(step.transfers) for step in self.passes)

    @property
    def most_rack(self) -> int:
        """The furthest racking, in needles."""
        return max((abs(step.rack) for step in self.passes), default=0)

    def lines(self) -> Iterator[str]:
        """The plan in knitout, from rack 0 and back to it."""
        rack = 0
        for step in self.passes:
            if step.rack != rack:
                rack = step.rack
                yield f"rack {rack}"
            yield from (f"xfer {here} {there}" for here, there in step.transfers)
        if rack:
            yield "rack 0"

    def to_dict(self) -> dict[str, Any]:
        """Collect the passes by names of needles."""
        return {
            "passes": [
                {"rack": step.rack, "transfers": [[str(a), str(b)] for a, b in step.transfers]}
                for step in self.passes
            ],
            "transfers": self.transfers,
            "most_rack": self.most_rack,
        }


def plan_transfers(
    moves: Sequence[LoopMove],
    *,
    most_rack: int,
    spare_needles: int = 1,
    most_passes: int = MOST_PASSES,
) -> TransferPlan:
    """Plan the fewest passes; of those, the least racking; of those, the fewest transfers.

    Parameters
    ----------
    moves : loops in the order of their yarn. Give those beside the moved ones too: they hold them.
    most_rack : the machine's limit, in needles.
    spare_needles : how far apart the yarn lets any two neighbours be.
    most_passes : passes after which no plan is sought.

    Raises
    ------
    InputError
        If two loops start on one needle, or no such plan exists.

    Examples
    --------
    A 2/2 cable, whose left loops pass in front, between two loops that stay:

    >>> shifts = [0, 2, 2, -2, -2, 0]
    >>> plan = plan_transfers(
    ...     [
    ...         LoopMove(Needle("f", n), Needle("f", n + shift), layer=shift)
    ...         for n, shift in enumerate(shifts)
    ...     ],
    ...     most_rack=2,
    ... )
    >>> [step.rack for step in plan.passes]
    [0, 2, -2]
    """
    _check(moves)
    for passes in range(most_passes + 1):
        for series in _series(moves, passes, most_rack):
            ways = _cheapest_ways(moves, series, spare_needles)
            if ways is not None:
                return _plan(moves, series, ways)
    furthest = max(abs(move.target.number - move.start.number) for move in moves)
    raise InputError(
        "transfers",
        f"no {most_passes} passes move these {len(moves)} loops by up to {furthest} needles at "
        f"rackings of up to {most_rack}, with {spare_needles} needles between neighbours.",
        "Shift fewer stitches at once, or in two rows, or allow more yarn with a larger stitch.",
    )


def _check(moves: Sequence[LoopMove]) -> None:
    if len({move.start for move in moves}) < len(moves):
        raise InputError(
            "transfers",
            "two loops start on one needle, which lets go of both at once.",
            "Give the loops of one needle as one.",
        )


@dataclass(frozen=True)
class _Step:
    """A racking and the bed that gives its loops."""

    rack: int
    bed: str


_Kind = tuple[str, str, int]
"""Beds of start and target, and the needles between them."""
_Way = tuple[Needle, ...]
"""A loop's needle before the first pass and after each."""


def _series(moves: Sequence[LoopMove], passes: int, most_rack: int) -> list[tuple[_Step, ...]]:
    """Series of passes after which loops of each kind can be in place, with least racking first."""
    kinds = frozenset(
        (move.start.bed, move.target.bed, move.target.number - move.start.number) for move in moves
    )
    return _series_of(kinds, passes, most_rack)


@lru_cache(maxsize=1000)
def _series_of(kinds: frozenset[_Kind], passes: int, most_rack: int) -> list[tuple[_Step, ...]]:
    if passes <= EXACT_PASSES:
        series = _all_series(kinds, passes, most_rack)
    else:
        series = [of for of in _buses(kinds, most_rack) if len(of) == passes]
    series.sort(key=lambda of: (_racking(of), [abs(step.rack) for step in of]))
    return series[:MOST_SERIES]


def _all_series(kinds: frozenset[_Kind], passes: int, most_rack: int) -> list[tuple[_Step, ...]]:
    """Series of any steps.

    A bed's needles that loops of a kind may be on are bits of a number: a step shifts them all.
    """
    middle = (passes + 2) * most_rack + max(abs(shift) for _, _, shift in kinds)
    racks = range(-most_rack, most_rack + 1)
    homes = [_homes(end, middle + shift, passes, racks) for _, end, shift in kinds]
    starts = [(1 << middle, 0) if start == "f" else (0, 1 << middle) for start, _, _ in kinds]
    level: list[tuple[tuple[_Step, ...], list[tuple[int, int]]]] = [((), starts)]
    for left in range(passes - 1, -1, -1):
        level = [
            ((*series, _Step(rack, bed)), after)
            for series, places in level
            for rack in racks
            for bed in "fb"
            if not series or series[-1] != _Step(rack, bed)
            for after in [[_stepped(at, rack, bed) for at in places]]
            if all(
                front & home[left][0] or back & home[left][1]
                for (front, back), home in zip(after, homes, strict=True)
            )
        ]
    return [
        series
        for series, places in level
        if all(f & home[0][0] or b & home[0][1] for (f, b), home in zip(places, homes, strict=True))
    ]


def _stepped(places: tuple[int, int], rack: int, bed: str) -> tuple[int, int]:
    front, back = places
    if bed == "f":
        return front, back | _shifted_bits(front, -rack)
    return front | _shifted_bits(back, rack), back


def _shifted_bits(bits: int, by: int) -> int:
    return bits << by if by >= 0 else bits >> -by


def _homes(end: str, target: int, passes: int, racks: range) -> list[tuple[int, int]]:
    """Needles of the front and back bed from which 0, 1, … passes may lead to a target."""
    homes = [(1 << target, 0) if end == "f" else (0, 1 << target)]
    for _ in range(passes):
        front, back = homes[-1]
        for rack in racks:
            front |= _shifted_bits(homes[-1][1], rack)
            back |= _shifted_bits(homes[-1][0], -rack)
        homes.append((front, back))
    return homes


def _buses(kinds: frozenset[_Kind], most_rack: int) -> Iterator[tuple[_Step, ...]]:
    """Series that bring loops to the back in one pass, and from there to the front rack by rack."""
    if any(end == "b" for _, end, _ in kinds):
        return
    for first in range(-most_rack, most_rack + 1):
        racks = {shift + (first if start == "f" else 0) for start, _, shift in kinds}
        racks |= {shift for start, _, shift in kinds if start == "b"}
        if len(racks) <= MOST_PASSES - 1 and max(map(abs, racks)) <= most_rack:
            for order in permutations(sorted(racks)):
                yield _Step(first, "f"), *(_Step(rack, "b") for rack in order)


def _racking(series: tuple[_Step, ...]) -> int:
    """Needles racked from rack 0 through a series and back."""
    return sum(abs(b - a) for a, b in pairwise((0, *(step.rack for step in series), 0)))


def _cheapest_ways(
    moves: Sequence[LoopMove], series: tuple[_Step, ...], spare_needles: int
) -> tuple[_Way, ...] | None:
    """The ways of all loops with the fewest transfers; None if there are none.

    Loops are assigned from left to right. A state is the ways of the last few loops, as many as can
    meet a later one.
    """
    choices = [_ways(move, series) for move in moves]
    spans = [_span(ways, series) for ways in choices]
    window = max(
        (j - i for i, j in combinations(range(len(moves)), 2) if spans[i][1] >= spans[j][0]),
        default=1,
    )
    states: dict[tuple[_Way, ...], tuple[int, Any]] = {(): (0, None)}
    for j, ways in enumerate(choices):
        following: dict[tuple[_Way, ...], tuple[int, Any]] = {}
        for recent, (cost, chain) in states.items():
            for way in ways:
                if all(
                    _compatible(moves, j - back, j, recent[-back], way, series, spare_needles)
                    for back in range(1, len(recent) + 1)
                ):
                    state = (*recent, way)[-window:]
                    total = cost + _transfers(way)
                    if state not in following or total < following[state][0]:
                        following[state] = total, (chain, way)
        states = dict(sorted(following.items(), key=lambda of: of[1][0])[:MOST_STATES])
        if not states:
            return None
    _, chain = min(states.values(), key=lambda of: of[0])
    ways_taken: list[_Way] = []
    while chain is not None:
        chain, way = chain
        ways_taken.append(way)
    return tuple(reversed(ways_taken))


def _ways(move: LoopMove, series: tuple[_Step, ...]) -> list[_Way]:
    ways: list[_Way] = [(move.start,)]
    for step in series:
        moved = [(*way, way[-1].facing(step.rack)) for way in ways if way[-1].bed == step.bed]
        ways = [(*way, way[-1]) for way in ways] + moved
    return [way for way in ways if way[-1] == move.target]


def _transfers(way: _Way) -> int:
    return sum(a != b for a, b in pairwise(way))


def _span(ways: list[_Way], series: tuple[_Step, ...]) -> tuple[int, int]:
    """The furthest positions to the left and right that a loop can come to."""
    at = [
        place.at(rack)
        for way in ways
        for step, before, after in zip(
            (*series, _Step(0, "f")), way, (*way[1:], way[-1]), strict=True
        )
        for place, rack in ((before, 0), (before, step.rack), (after, step.rack))
    ]
    return min(at), max(at)


def _compatible(
    moves: Sequence[LoopMove],
    i: int,
    j: int,
    left: _Way,
    right: _Way,
    series: tuple[_Step, ...],
    spare_needles: int,
) -> bool:
    origin = moves[i].start.number
    pair = [
        LoopMove(_shifted(m.start, -origin), _shifted(m.target, -origin), m.order, m.layer)
        for m in (moves[i], moves[j])
    ]
    return _pass_each_other(
        pair[0],
        pair[1],
        tuple(_shifted(place, -origin) for place in left),
        tuple(_shifted(place, -origin) for place in right),
        series,
        spare_needles if j == i + 1 else None,
    )


def _shifted(place: Needle, by: int) -> Needle:
    return Needle(place.bed, place.number + by)


@lru_cache(maxsize=100_000)
def _pass_each_other(
    a: LoopMove,
    b: LoopMove,
    left: _Way,
    right: _Way,
    series: tuple[_Step, ...],
    spare_needles: int | None,
) -> bool:
    """Say whether two loops can go these ways: not too far apart, not stacked early, not twisted.

    ``spare_needles`` is None for loops that are no neighbours.
    """
    most = None
    if spare_needles is not None:
        apart = (abs(a.start.number - b.start.number), abs(a.target.number - b.target.number))
        most = max(spare_needles, *apart)
    crossings: list[int] = []
    side = a.start.number - b.start.number
    steps = zip(
        (*series, _Step(0, "f")),
        pairwise((*left, left[-1])),
        pairwise((*right, right[-1])),
        strict=True,
    )
    for step, (here, there), (across, beyond) in steps:
        for p, q in ((here, across), (there, beyond)):
            offset = p.at(step.rack) - q.at(step.rack)
            if most is not None and abs(offset) > most:
                return False
            if offset * side < 0:
                front = 1 if p.bed == "f" else -1
                if crossings and crossings[-1] == front:
                    crossings.pop()
                else:
                    crossings.append(front)
            side = offset or side
        if there == beyond and not _stacked(a, b, left, right, there):
            return False
    return _lie_as_meant(a, b, crossings)


def _stacked(a: LoopMove, b: LoopMove, left: _Way, right: _Way, place: Needle) -> bool:
    """Say whether two loops on one needle are there to stay, and came in their order."""
    if not a.target == b.target == place:
        return False
    arrivals = [next(t for t in range(len(w)) if len(set(w[t:])) == 1) for w in (left, right)]
    meeting = next(t for t, (p, q) in enumerate(zip(left, right, strict=True)) if p == q)
    if max(arrivals) > meeting:
        return False
    return a.order == b.order or (a.order < b.order) == (arrivals[0] < arrivals[1])


def _lie_as_meant(a: LoopMove, b: LoopMove, crossings: list[int]) -> bool:
    sides = (a.start.number - b.start.number) * (a.target.number - b.target.number)
    if a.target == b.target and a.order != b.order and len(crossings) == 1:
        is_front = (a.order < b.order) == (a.target.bed == "f")  # it comes round to its side
        return crossings[0] == (1 if is_front else -1)
    if sides >= 0:
        return not crossings
    return len(crossings) == 1 and (
        a.layer == b.layer or crossings[0] == (1 if a.layer > b.layer else -1)
    )


def _plan(
    moves: Sequence[LoopMove], series: tuple[_Step, ...], ways: tuple[_Way, ...]
) -> TransferPlan:
    places = tuple(zip(*ways, strict=True))
    passes = tuple(
        TransferPass(step.rack, tuple(sorted((p, q) for p, q in zip(*pair, strict=True) if p != q)))
        for step, pair in zip(series, pairwise(places), strict=True)
    )
    return TransferPlan(tuple(moves), passes, places)
