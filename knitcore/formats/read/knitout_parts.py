"""The loops of a program that are the piece, told from waste and from other pieces.

Decided by the graph of loops: what stands on what, and which yarn goes on. Programs knit waste
yarn before and after a piece; it is what the piece stands on, or what hangs from it. The piece is
what is bound off, and what lies between two courses of a draw thread. Otherwise sections are
compared by size. One that has a shape or a pattern of its own counts more than one that only
repeats the beds below it, and one knitted on both beds at once (interlock, a tube) counts less,
since only waste is knitted so around a piece of knits and purls. Sections that are not clearly
smaller are stripes, and so is what lies between two sections of the piece.
"""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from knitcore.base.errors import InputError
from knitcore.machine.knitout_machine import Loop

PATTERNED, TWO_BEDS = 4.0, 0.01
CLEARLY_SMALLER = 0.5
"""A section with less than this part of the main one's weight, before or after it, is waste."""
MOST_TUCKS = 4
"""Tucks between two links of a bind-off."""

Carriers = tuple[str, ...]


@dataclass(frozen=True)
class KnittedPart:
    """The stitches of the piece, in the order in which they are made."""

    stitches: tuple[Loop, ...]
    notes: tuple[str, ...]


@dataclass
class _Section:
    """Stitches of one yarn, or of yarns that take turns; named after the first."""

    carriers: Carriers
    stitches: list[Loop]
    factor: float = 1.0

    @property
    def weight(self) -> float:
        """Number of stitches, more or less by what they are."""
        return self.factor * len(self.stitches)

    def in_words(self) -> str:
        lines = f"lines {self.stitches[0].line} to {self.stitches[-1].line}"
        number = len(self.stitches)
        return f"{number} {'stitch' if number == 1 else 'stitches'}, {lines}"


def bound_off_by(loops: Iterable[Loop]) -> set[Loop]:
    """Loops that bind off: the links of each chain, and the tag that is knitted onto its last one.

    A link is pulled through the one before it, which was moved to its needle. The last link of a
    chain is a stitch if its yarn knits on along the course, or another yarn through it.
    """
    links: set[Loop] = set()
    for loop in loops:
        if _is_linked(loop) or _begins_chain(loop):
            links.add(loop)
        elif loop in links:
            continue
        elif (before := _neighbour(loop, "before")) in links and before in loop.parents:
            tag = [loop, *_following(loop)]
            if len({(o.bed, o.needle) for o in tag}) == 1 and tag[-1].child is None:
                links.update(tag)
    return links


def _is_linked(loop: Loop) -> bool:
    before, after = _neighbour(loop, "before"), _neighbour(loop, "after")
    return (
        before is not None
        and after is not None
        and before in loop.parents
        and before.needle != loop.needle
        and loop.child is after
        and after.needle != loop.needle
    )


def _begins_chain(loop: Loop) -> bool:
    """Say whether a loop is the first link: knitted where the yarn turns, and moved at once."""
    before, after = loop.before, _neighbour(loop, "after")
    return (
        after is not None
        and loop.child is after
        and after.needle != loop.needle
        and after.rightwards == loop.rightwards
        and bool(loop.parents)
        and (before is None or (before in loop.parents and before.needle == loop.needle))
    )


def _neighbour(loop: Loop, side: Literal["before", "after"]) -> Loop | None:
    """The next stitch on the strand: some bind-offs tuck between two links."""
    beside: Loop | None = getattr(loop, side)
    for _ in range(MOST_TUCKS):
        if beside is None or beside.kind != "tuck":
            return beside
        beside = getattr(beside, side)
    return None


def _following(loop: Loop) -> Iterator[Loop]:
    while loop.after is not None:
        loop = loop.after
        yield loop


def part_knitted_by(loops: Sequence[Loop], carriers: Collection[Carriers]) -> KnittedPart:
    """The stitches of carriers that the program itself names; others are waste."""
    stitches = tuple(loop for loop in stitches_of(loops) if loop.carriers in carriers)
    others = dict.fromkeys(loop.carriers for loop in loops if loop.carriers not in carriers)
    return KnittedPart(
        stitches, tuple(f"Yarn of carrier {named(other)} counts as waste yarn." for other in others)
    )


def main_part(loops: Sequence[Loop]) -> KnittedPart:
    """The piece among everything that a program knits.

    Raises
    ------
    InputError
        If it knits two pieces of similar size that are not joined.
    """
    stitches, notes = _joined(stitches_of(loops), loops)
    if not stitches:
        return KnittedPart((), ())
    bound_off = {parent for loop in bound_off_by(loops) for parent in loop.parents}
    sections = _sections(stitches, bound_off)
    first, last = _span_of_piece(sections, bound_off)
    inside = sections[first : last + 1]
    likeliest = max(section.factor for section in inside)
    for is_before, side in ((True, sections[:first]), (False, sections[last + 1 :])):
        for carriers in dict.fromkeys(section.carriers for section in side):
            name = f"carrier {named(carriers)}"
            relation = (
                f"the piece stands on what {name} knits before it"
                if is_before
                else f"what {name} knits after the piece hangs from it"
            )
            left_out = [section for section in side if section.carriers == carriers]
            sizes = "; ".join(section.in_words() for section in left_out)
            alike = max(section.factor for section in left_out) == likeliest
            notes.append(
                f"Waste{', by its size alone' if alike else ''}: {relation} ({sizes}). It is left "
                "out; if it belongs to the piece, name the yarns of the piece by lines such as: "
                f"; carrier {carriers[0]} knits #efe9dd wool"
            )
    return KnittedPart(tuple(loop for section in inside for loop in section.stitches), tuple(notes))


def named(carriers: Carriers) -> str:
    """Names of carriers that knit together."""
    return " and ".join(carriers)


def stitches_of(loops: Iterable[Loop]) -> list[Loop]:
    """Loops that were pulled through others, without bind-offs."""
    links = bound_off_by(loops)
    return [loop for loop in loops if loop.parents and loop not in links]


def _joined(stitches: list[Loop], loops: Sequence[Loop]) -> tuple[list[Loop], list[str]]:
    """The largest set of stitches joined by loops or yarn, and notes on the rest."""
    group = list(range(len(loops)))

    def root(number: int) -> int:
        while group[number] != number:
            group[number] = group[group[number]]
            number = group[number]
        return number

    for loop in loops:
        for other in (*loop.parents, *([loop.before] if loop.before else [])):
            group[root(other.number)] = root(loop.number)
        if loop.onto and loop.child is not None:
            group[root(loop.child.number)] = root(loop.number)
    sizes = Counter(root(loop.number) for loop in stitches)
    if len(sizes) < 2:
        return stitches, []
    (main, most), (second, next_most), *_ = sizes.most_common()
    if next_most > CLEARLY_SMALLER * most:
        line = next(loop.line for loop in stitches if root(loop.number) == second)
        raise InputError(
            "knitout",
            f"the program knits {len(sizes)} pieces that are not joined; another one is that of "
            f"line {line}.",
            "Give a program for each piece.",
        )
    rest = [loop for loop in stitches if root(loop.number) != main]
    note = (
        f"{len(rest)} stitches from line {rest[0].line} on are not joined to the piece and are "
        "left out."
    )
    return [loop for loop in stitches if root(loop.number) == main], [note]


def _sections(stitches: Sequence[Loop], bound_off: Collection[Loop]) -> list[_Section]:
    """Split stitches where the yarn changes, but not where yarns take turns."""
    turns: list[_Section] = []
    for loop in stitches:
        if not turns or turns[-1].carriers != loop.carriers:
            turns.append(_Section(loop.carriers, []))
        turns[-1].stitches.append(loop)
    sections: list[_Section] = []
    end = -1
    last_of = _ends_of_turns([turn.carriers for turn in turns])
    for index, turn in enumerate(turns):
        if index > end:
            sections.append(_Section(turn.carriers, []))
        sections[-1].stitches += turn.stitches
        end = max(end, last_of[index])
    _weigh(sections, bound_off)
    return sections


def _ends_of_turns(carriers: Sequence[Carriers]) -> list[int]:
    """How far the yarns of a turn go on taking turns with others; else the turn itself.

    They take turns if they come three times, or if two alternate. A yarn before and after all of
    another is waste or a border.
    """
    places: dict[Carriers, list[int]] = {}
    for index, name in enumerate(carriers):
        places.setdefault(name, []).append(index)
    spans = [(turns[0], turns[-1]) for turns in places.values()]
    return [
        places[name][-1]
        if len(places[name]) > 2
        or any(
            a < places[name][0] < b < places[name][-1] or places[name][0] < a < places[name][-1] < b
            for a, b in spans
        )
        else index
        for index, name in enumerate(carriers)
    ]


def _weigh(sections: Sequence[_Section], bound_off: Collection[Loop]) -> None:
    """Give each section its factor: 0 outside what surrounds the piece, and for yarn from there."""
    inside = _without_surroundings(sections, bound_off)
    outer = {section.carriers for section in sections[: inside.start]}
    outer -= {sections[inside.start].carriers}
    sizes = [len(sections[place].stitches) for place in inside]
    are_stripes = (
        len(sizes) > 2
        and min(sizes) >= CLEARLY_SMALLER * max(sizes)
        and all(_has_two_beds(sections[place].stitches) for place in inside)
    )
    for place, section in enumerate(sections):
        is_inside = place in inside and section.carriers not in outer
        section.factor = _factor(section.stitches, bound_off) if is_inside else 0.0
        if are_stripes and section.factor == 1.0:
            section.factor = PATTERNED


def _factor(
    stitches: Sequence[Loop], bound_off: Collection[Loop], *, start_counts: bool = True
) -> float:
    """How much a stitch of a section counts: by its edge, shape or pattern, or by its two beds."""
    if is_on_two_beds(stitches):
        return TWO_BEDS
    inside = set(stitches)
    links = [(loop, parent) for loop in stitches for parent in loop.parents]
    begun = start_counts and all(parent in inside or not parent.parents for _, parent in links)
    has_two_beds = _has_two_beds(stitches)
    changed = any(
        (parent.parents and parent.bed != loop.bed and has_two_beds)
        or (parent in inside and parent.needle != loop.needle)
        for loop, parent in links
    )
    ended = any(loop in bound_off for loop in stitches)
    patterned = changed or ended or (begun and has_two_beds)
    return PATTERNED if patterned else 1.0


def _has_two_beds(stitches: Iterable[Loop]) -> bool:
    return len({loop.bed for loop in stitches}) > 1


def _is_cast_on(stitches: Sequence[Loop]) -> bool:
    """Say whether a section is cast on anew, on needles that hold loops of another yarn."""
    inside = set(stitches)
    begin = [loop for loop in stitches if inside.isdisjoint(loop.parents)]
    own = [o for o in begin if any(p.onto and p.carriers == o.carriers for p in o.parents)]
    return 2 * len(own) > len(begin)


def _is_course(stitches: Sequence[Loop], width: int) -> bool:
    """Say whether stitches are one course, over most of a width."""
    return len({loop.name for loop in stitches}) == len(stitches) > width / 2


def is_on_two_beds(stitches: Sequence[Loop]) -> bool:
    """Say whether stitches that lie over each other are knitted in turn on both beds."""
    last: dict[int, Loop] = {}
    over, alone = 0, 0
    for loop in stitches:
        other = last.get(loop.needle)
        if other is not None:
            crossed = other.bed != loop.bed and other not in loop.parents
            over, alone = over + crossed, alone + (not crossed)
        last[loop.needle] = loop
    return over > alone


def _without_surroundings(sections: Sequence[_Section], bound_off: Collection[Loop]) -> range:
    """Places of sections between courses of a draw thread, or from the last cast-on on."""
    width = len({loop.needle for section in sections for loop in section.stitches})
    threads = [i for i, section in enumerate(sections) if _is_course(section.stitches, width)]
    for begin, end in pairwise(threads):
        if end > begin + 1 and sections[begin].carriers == sections[end].carriers:
            return range(begin + 1, end)
    if len(threads) == 1 and 0 < (thread := threads[0]) < len(sections) - 1:
        around = {sections[place].carriers for place in (thread - 1, thread, thread + 1)}
        if len(around) == 3:
            return _side_of_thread(sections, thread, bound_off)
    begun = max((i for i, s in enumerate(sections) if _is_cast_on(s.stitches)), default=0)
    while begun < len(sections) - 1 and is_on_two_beds(sections[begun].stitches):
        begun += 1
    return range(begun, len(sections))


def _side_of_thread(
    sections: Sequence[_Section], thread: int, bound_off: Collection[Loop]
) -> range:
    """Places of the piece before or after the only course of a draw thread.

    Raises
    ------
    InputError
        If more is knitted before it than after it, and neither has a pattern or an edge.
    """
    sides = range(thread), range(thread + 1, len(sections))
    before, after = (
        max(_factor(sections[i].stitches, bound_off, start_counts=False) for i in side)
        for side in sides
    )
    sizes = [sum(len(sections[i].stitches) for i in side) for side in sides]
    if after > before or (after == before and sizes[1] >= sizes[0]):
        return sides[1]
    if before > after:
        return sides[0]
    first, second = (sections[thread + step].carriers for step in (-1, 1))
    raise InputError(
        "knitout",
        f"carrier {named(sections[thread].carriers)} knits one course (line "
        f"{sections[thread].stitches[0].line}), as a draw thread does; the piece may be what "
        f"carrier {named(first)} knits before it or what carrier {named(second)} knits after it.",
        f"Name the yarn of the piece by a line such as: ; carrier {second[0]} knits #efe9dd wool",
    )


def _span_of_piece(sections: Sequence[_Section], bound_off: Collection[Loop]) -> tuple[int, int]:
    """The first and the last section of the piece."""
    bound = [i for i, s in enumerate(sections) if any(o in bound_off for o in s.stitches)]
    main = max(bound or range(len(sections)), key=lambda i: sections[i].weight)
    enough = CLEARLY_SMALLER * sections[main].weight
    yarn = sections[main].carriers
    alike = [i for i, s in enumerate(sections) if s.carriers == yarn and s.weight >= enough]
    first, last = min(alike + bound), max(alike + bound)
    while first > 0 and sections[first - 1].weight >= enough:
        first -= 1
    while last + 1 < len(sections) and sections[last + 1].weight >= enough:
        last += 1
    # Plain courses of one yarn before and after a patterned piece are waste, whatever their number.
    if (
        first == 0 < last == len(sections) - 1
        and sections[0].carriers == sections[-1].carriers
        and sections[0].factor == sections[-1].factor < sections[main].factor
    ):
        return 1, last - 1
    return first, last
