"""Knitout programs of any stitches, read as charts from what the machine holds.

Before each pass, every wale has one needle of either bed, with the loops that the site below left
and others brought to it. So its sources are known, in the order in which they lie; of loops that
changed places, the one that was on the front bed while the bed was racked passed in front. The pass
then knits, tucks or misses the needle.
"""

from collections.abc import Collection, Mapping, Sequence

from knitcore.base.errors import InputError
from knitcore.chart.stitch_kinds import Site, YarnAct
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.machine.knitout_machine import Loop, LoopState


def chart_of_states(
    loops: Sequence[Loop], states: Sequence[LoopState], first: int, last: int
) -> SymbolChart:
    """The chart of a piece of one yarn, all rows of which reach over the same wales.

    Parameters
    ----------
    loops, states : of the whole program.
    first, last : numbers of the first and the last stitch of the piece.

    Raises
    ------
    InputError
        If a row is no row of such a chart; it names the course.
    """
    mine = loops[first].carriers
    ends = [*(state.before for state in states[1:]), len(loops)]
    passes = [
        (state, loops[state.before : min(end, last + 1)])
        for state, end in zip(states, ends, strict=True)
        if first < end and state.before <= last
    ]
    wales = sorted({loop.needle for _, made in passes for loop in made})
    column = {needle: index for index, needle in enumerate(wales)}
    holder = {loop: column[loop.needle] for loop in loops[:first] if loop.needle in column}
    rows = []
    for number, (state, made) in enumerate(passes, start=1):
        if any(loop.carriers != mine for loop in made):
            raise _refused(number, "is knitted with another yarn.", "Knit it with one carrier.")
        course = _Course(number, column, holder, state)
        rows.append(course.sites({(loop.bed, loop.needle): loop for loop in made}))
    return SymbolChart.of_sites(rows)


def _refused(course: int, problem: str, remedy: str) -> InputError:
    return InputError("knitout", f"course {course} {problem}", remedy)


class _Course:
    """One pass over all wales.

    Parameters
    ----------
    number : of the course, from 1.
    column : of each needle.
    holder : column of the site below that holds each loop; brought up to date.
    state : what the needles hold before it.
    """

    def __init__(
        self, number: int, column: Mapping[int, int], holder: dict[Loop, int], state: LoopState
    ) -> None:
        self._number, self._column, self._holder, self._state = number, column, holder, state
        self._held: dict[int, tuple[str, tuple[Loop, ...]]] = {}
        for (bed, needle), loops in state.held.items():
            if needle not in column:
                if any(loop in holder for loop in loops):
                    raise self._refused("leaves loops on other needles.")
                continue
            if column[needle] in self._held:
                raise self._refused("has a wale with loops on both beds.")
            self._held[column[needle]] = bed, loops

    def _refused(self, problem: str) -> InputError:
        return _refused(self._number, problem, "Charts hold single fabrics from edge to edge.")

    def sites(self, made: Mapping[tuple[str, int], Loop]) -> list[Site]:
        """The sites, and the new holders of their loops."""
        worked: dict[int, Loop] = {}
        for (_, needle), loop in made.items():
            if self._column[needle] in worked or loop.kind == "split":
                raise self._refused("works a wale twice.")
            worked[self._column[needle]] = loop
        taken = {c: self._sources(c) for c in range(len(self._column))}
        layers = self._layers(taken)
        sites, holder = [], {}
        for c, sources in taken.items():
            bed, loops = self._held.get(c, ("f", ()))
            made_here = worked.get(c)
            if made_here is None and not sources:
                raise self._refused(f"leaves wale {c + 1} without a loop.")
            layer = layers.get(c, 0)
            if made_here is None:
                sites.append(Site(YarnAct.MISS, sources, front=bed == "b", layer=layer))
                holder.update(dict.fromkeys(loops, c))
            elif made_here.kind == "knit":
                sites.append(Site(sources=sources, purl=made_here.bed == "b", layer=layer))
                holder[made_here] = c
            else:
                front = bool(sources) and made_here.bed == "b"
                sites.append(Site(YarnAct.OVER, sources, purl=front, layer=layer))
                holder.update(dict.fromkeys((*loops, made_here), c))
        self._holder.clear()
        self._holder.update(holder)
        return sites

    def _sources(self, column: int) -> tuple[int, ...]:
        """Columns below of the loops on a wale's needle, the front of the fabric first."""
        bed, loops = self._held.get(column, ("f", ()))
        if any(loop not in self._holder for loop in loops):
            raise self._refused(f"takes a loop at wale {column + 1} that no course made.")
        below = list(dict.fromkeys(self._holder[loop] for loop in loops))
        return tuple(below if bed == "f" else below[::-1])

    def _layers(self, taken: Mapping[int, tuple[int, ...]]) -> dict[int, int]:
        """Layer of each site whose loop changes places with another's."""
        ways = [(sources[0], c) for c, sources in taken.items() if len(sources) == 1]
        layers: dict[int, int] = {}
        loops_of: dict[int, list[int]] = {}
        for loop, c in self._holder.items():
            loops_of.setdefault(c, []).append(loop.number)
        for here, (start, end) in enumerate(ways):
            for other, beyond in ways[here + 1 :]:
                if other > start:
                    continue
                for site, below, its in ((end, start, other), (beyond, other, start)):
                    front = self._in_front(loops_of[below], loops_of[its])
                    if layers.setdefault(site, front) != front:
                        raise self._refused("crosses stitches that are in front and behind.")
        return layers

    def _in_front(self, loops: Collection[int], others: Collection[int]) -> int:
        """1 where loops pass in front of others, -1 where behind."""
        for loop in loops:
            for other in others:
                if crossings := self._state.crossed.get(frozenset((loop, other))):
                    return 1 if crossings[-1] == loop else -1
        raise self._refused("crosses stitches without racking one past the other.")
