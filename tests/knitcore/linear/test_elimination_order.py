"""Orders of elimination by nested dissection."""

import numpy as np
import pytest

from knitcore.linear.elimination_order import dissected, vertex_cover
from knitcore.yarn.solve.fronts import Dissection, elimination, work


def _sheet(side: int) -> np.ndarray:
    """Pattern of blocks on a closed sheet, each touching its eight neighbours."""
    row, column = np.divmod(np.arange(side * side), side)
    near = [np.abs(p[:, None] - p) for p in (row, column)]
    return np.all([np.minimum(d, side - d) <= 1 for d in near], axis=0)


def _fill(touching: np.ndarray, order: np.ndarray) -> int:
    """Entries of the factor."""
    left, count = touching.copy(), 0
    alive = np.ones(len(order), bool)
    for k in order:
        alive[k] = False
        around = np.flatnonzero(left[k] & alive)
        left[np.ix_(around, around)] = True
        count += 1 + len(around)
    return count


def test_the_order_holds_every_block_once_and_fills_far_less_than_row_by_row():
    touching = _sheet(16)
    order = dissected(touching)
    assert sorted(order) == list(range(256))
    assert _fill(touching, order) < 0.75 * _fill(touching, np.arange(256))


def test_the_order_is_kept_while_little_changes_and_found_anew_where_its_work_has_grown():
    touching = _sheet(12)
    plan = Dissection()
    first = plan.fronts(touching)
    assert plan.fronts(touching.copy()) is first
    shuffled = np.random.default_rng(3).permutation(len(touching))
    elsewhere = touching[np.ix_(shuffled, shuffled)]
    stale = elimination(elsewhere, np.concatenate([front.own for front in first]))
    assert work(stale) > 2.0 * work(first)
    assert work(plan.fronts(elsewhere)) < 1.2 * work(first)


def test_blocks_that_all_touch_or_never_touch_are_ordered_too():
    assert sorted(dissected(np.ones((30, 30), bool))) == list(range(30))
    assert sorted(dissected(np.eye(30, dtype=bool))) == list(range(30))


@pytest.mark.parametrize("seed", range(4))
def test_a_vertex_cover_holds_every_crossing_and_is_as_small_as_the_largest_matching(seed):
    crossing = np.random.default_rng(seed).random((6, 7)) < 0.25
    rows, columns = vertex_cover(crossing)
    assert not crossing[~rows][:, ~columns].any()
    smaller = min(
        r.bit_count() + int(crossing[[not r >> i & 1 for i in range(6)]].any(axis=0).sum())
        for r in range(64)
    )
    assert rows.sum() + columns.sum() == smaller
