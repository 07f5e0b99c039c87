"""Transfer planning: against a search of all passes, collapse-shift-expand, and a machine."""

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations, product

import pytest

from knitcore.base.errors import InputError
from knitcore.machine.knitout_machine import knitting_of
from knitcore.machine.transfers import LoopMove, Needle, TransferPlan, plan_transfers

Places = tuple[Needle, ...]


def shifted(
    shifts: Sequence[int], orders: Sequence[int] = (), layers: Sequence[int] = ()
) -> list[LoopMove]:
    """Loops of the front bed, needle by needle, and how far each has to go."""
    return [
        LoopMove(
            Needle("f", n),
            Needle("f", n + shift),
            orders[n] if orders else 0,
            layers[n] if layers else 0,
        )
        for n, shift in enumerate(shifts)
    ]


def parents_on_machine(plan: TransferPlan) -> dict[str, tuple[str, ...]]:
    """Knit the loops, carry out the plan and knit again: the needles of each new loop's parents."""
    starts = [move.start for move in plan.moves]
    ends = dict.fromkeys(move.target for move in plan.moves)
    lines = ["inhook 1", *(f"knit + {needle} 1" for needle in starts), *plan.lines()]
    lines += [f"knit + {needle} 1" for needle in ends]
    loops = knitting_of("\n".join(lines)).loops[len(starts) :]
    return {loop.name: tuple(parent.name for parent in loop.parents) for loop in loops}


State = tuple[Places, tuple[int, ...], tuple[tuple[int, ...], ...]]


def racked(moves: Sequence[LoopMove], state: State, rack: int, spare: int) -> State | None:
    """Rack the beds; None if neighbours are pulled too far apart."""
    places, sides, words = state
    after_sides, after_words = [], []
    pairs = list(combinations(range(len(moves)), 2))
    for (i, j), side, word in zip(pairs, sides, words, strict=True):
        offset = places[i].at(rack) - places[j].at(rack)
        if j == i + 1:
            ends = (
                moves[i].start.number - moves[j].start.number,
                moves[i].target.number - moves[j].target.number,
            )
            if abs(offset) > max(spare, *map(abs, ends)):
                return None
        if offset * side < 0:
            front = 1 if places[i].bed == "f" else -1
            after_words.append(word[:-1] if word[-1:] == (front,) else (*word, front))
        else:
            after_words.append(word)
        after_sides.append(offset or side)
    return places, tuple(after_sides), tuple(after_words)


def finished(moves: Sequence[LoopMove], state: State) -> bool:
    places, _, words = state
    for (a, b), word in zip(combinations(moves, 2), words, strict=True):
        crosses = (a.start.number - b.start.number) * (a.target.number - b.target.number) < 0
        if len(word) != crosses:
            return False
        if word and a.layer != b.layer and word[0] != (1 if a.layer > b.layer else -1):
            return False
    return all(place == move.target for place, move in zip(places, moves, strict=True))


Subsets = Callable[[Places, str], Iterator[tuple[int, ...]]]


def any_of_a_bed(places: Places, bed: str) -> Iterator[tuple[int, ...]]:
    here = [i for i, place in enumerate(places) if place.bed == bed]
    for size in range(1, len(here) + 1):
        yield from combinations(here, size)


def collapse_or_expand(places: Places, bed: str) -> Iterator[tuple[int, ...]]:
    """All loops from the front; from the back those at the ends, towards the middle."""
    here = [i for i, place in enumerate(places) if place.bed == bed]
    if bed == "f":
        if len(here) == len(places):
            yield tuple(here)
        return
    for left in range(len(here) + 1):
        for right in range(len(here) - left + 1):
            if left + right:
                yield (*here[:left], *here[len(here) - right :])


def fewest_passes(
    moves: Sequence[LoopMove],
    most_rack: int,
    spare: int,
    subsets: Subsets = any_of_a_bed,
    *,
    moves_stacks: bool = False,
    most: int = 8,
) -> int | None:
    """The fewest passes by trying every one."""
    pairs = list(combinations(moves, 2))
    sides = tuple(a.start.number - b.start.number for a, b in pairs)
    states: set[State] = {(tuple(m.start for m in moves), sides, ((),) * len(pairs))}
    seen = set(states)
    for passes in range(most + 1):
        for state in states:
            home = racked(moves, state, 0, spare)
            if home and finished(moves, home):
                return passes
        following: set[State] = set()
        for state, rack in product(states, range(-most_rack, most_rack + 1)):
            ready = racked(moves, state, rack, spare)
            if ready is None:
                continue
            for bed in "fb":
                for chosen in subsets(ready[0], bed):
                    after = transferred(moves, ready, rack, chosen, moves_stacks=moves_stacks)
                    after = after and racked(moves, after, rack, spare)
                    if after and after not in seen:
                        following.add(after)
        seen |= following
        states = following
    return None


def transferred(
    moves: Sequence[LoopMove],
    state: State,
    rack: int,
    chosen: tuple[int, ...],
    *,
    moves_stacks: bool,
) -> State | None:
    places, sides, words = state
    after = [p.facing(rack) if i in chosen else p for i, p in enumerate(places)]
    for i, j in combinations(range(len(places)), 2):
        a, b = moves[i], moves[j]
        if places[i] == places[j] and (i in chosen or j in chosen):
            if not (moves_stacks and i in chosen and j in chosen):
                return None
        elif after[i] == after[j] and places[i] != places[j]:
            late, early = (a, b) if i in chosen else (b, a)
            if a.target != b.target or late.order < early.order:
                return None
            if not moves_stacks and after[i] != a.target:
                return None
    return tuple(after), sides, words


def legal(moves: Sequence[LoopMove], most_rack: int, spare: int, plan: TransferPlan) -> bool:
    """Say whether the machine can carry out a plan, step by step."""
    sides = tuple(a.start.number - b.start.number for a, b in combinations(moves, 2))
    state: State | None = (tuple(m.start for m in moves), sides, ((),) * len(sides))
    for step in plan.passes:
        assert abs(step.rack) <= most_rack
        assert len({here.bed for here, _ in step.transfers}) == 1
        assert state is not None
        state = racked(moves, state, step.rack, spare)
        givers = dict(step.transfers)
        assert state is not None
        assert all(here.facing(step.rack) == there for here, there in step.transfers)
        chosen = tuple(i for i, place in enumerate(state[0]) if place in givers)
        assert len(chosen) == len(step.transfers)
        state = transferred(moves, state, step.rack, chosen, moves_stacks=False)
        state = state and racked(moves, state, step.rack, spare)
    state = state and racked(moves, state, 0, spare)
    return state is not None and finished(moves, state)


def check_against_all_passes(moves: Sequence[LoopMove], most_rack: int, spare: int = 1) -> None:
    best = fewest_passes(moves, most_rack, spare, most=4)
    usual = fewest_passes(moves, most_rack, spare, collapse_or_expand, moves_stacks=True, most=5)
    try:
        plan = plan_transfers(moves, most_rack=most_rack, spare_needles=spare, most_passes=5)
    except InputError:
        assert best is None
        assert usual is None
        return
    assert legal(moves, most_rack, spare, plan)
    assert best is None or len(plan.passes) == best
    assert usual is None or len(plan.passes) <= usual
    arrived: dict[str, set[str]] = {}
    for move in moves:
        arrived.setdefault(str(move.target), set()).add(str(move.start))
    parents = parents_on_machine(plan)
    assert {name: set(of) for name, of in parents.items()} == arrived
    orders = {str(move.start): move.order for move in moves}
    for stack in parents.values():
        arrivals = [orders[name] for name in stack]
        assert arrivals == sorted(arrivals)


@pytest.mark.parametrize(
    "shifts",
    [
        pytest.param(shifts, marks=[pytest.mark.slow] if number % 4 else [])
        for number, shifts in enumerate(product((-1, 0, 1), repeat=4))
    ],
)
def test_four_loops_by_up_to_a_needle_take_the_fewest_passes(shifts: tuple[int, ...]) -> None:
    check_against_all_passes(shifted(shifts, layers=shifts), 1)


@pytest.mark.parametrize("shifts", [(0, 2, -1), (2, 0, 0), (2, 1, -2), (-2, 0, 2), (1, -1, 0)])
@pytest.mark.parametrize("spare", [1, 3])
def test_three_loops_by_up_to_two_needles_take_the_fewest_passes(
    shifts: tuple[int, ...], spare: int
) -> None:
    check_against_all_passes(shifted(shifts), 2, spare)


@pytest.mark.slow
@pytest.mark.parametrize("shifts", [(0, 1, 0, -1, 0), (1, 1, 0, 0, -1), (0, 1, -1, 1, -1)])
def test_five_loops_take_the_fewest_passes(shifts: tuple[int, ...]) -> None:
    check_against_all_passes(shifted(shifts), 1)


@pytest.mark.parametrize("orders", [(0, 1, 2), (2, 0, 1), (1, 0, 2), (0, 0, 0)])
def test_loops_of_a_decrease_arrive_in_their_order(orders: tuple[int, ...]) -> None:
    check_against_all_passes(shifted((1, 0, -1), orders), 1)


@pytest.mark.parametrize("over", [1, -1])
def test_the_higher_layer_of_a_cable_passes_in_front(over: int) -> None:
    shifts = (0, 2, 2, -2, -2, 0)
    moves = shifted(shifts, layers=[over * shift for shift in shifts])
    plan = plan_transfers(moves, most_rack=2)
    assert legal(moves, 2, 1, plan)
    assert [step.rack for step in plan.passes] == [0, 2 * over, -2 * over]
    assert parents_on_machine(plan)["f3"] == ("f1",)


def test_straight_transfers_between_beds_take_a_pass_for_each_bed() -> None:
    moves = [
        LoopMove(Needle("fb"[n % 2], n), Needle("bf"[n % 2] if n < 6 else "fb"[n % 2], n))
        for n in range(12)
    ]
    plan = plan_transfers(moves, most_rack=0)
    assert [len(step.transfers) for step in plan.passes] == [3, 3]
    assert plan.most_rack == 0
    assert not [line for line in plan.lines() if line.startswith("rack")]


def test_repeats_across_a_wide_row_share_their_passes() -> None:
    shifts = (0, 2, 2, -2, -2, 0) * 30
    plan = plan_transfers(shifted(shifts, layers=shifts), most_rack=2)
    assert len(plan.passes) == 3
    assert plan.transfers == 30 * 8


def test_a_shift_beyond_the_racking_limit_is_made_in_two_half_shifts() -> None:
    plan = plan_transfers(shifted((0, 4, 4)), most_rack=2)
    assert plan.most_rack == 2
    assert len(plan.passes) == 2


def test_what_no_passes_reach_is_refused_with_the_limit() -> None:
    with pytest.raises(InputError, match="rackings of up to 1"):
        plan_transfers(shifted((0, 2, 2, -2, -2, 0)), most_rack=1)


def test_two_loops_of_one_needle_are_refused() -> None:
    same = LoopMove(Needle("f", 1), Needle("b", 1))
    with pytest.raises(InputError, match="start on one needle"):
        plan_transfers([same, same], most_rack=1)


def test_to_dict_names_needles() -> None:
    plan = plan_transfers(shifted((0, 1)), most_rack=1)
    assert plan.to_dict()["passes"][-1]["transfers"][0][1] == "f2"
