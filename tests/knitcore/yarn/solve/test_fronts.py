"""Sparse factors against dense linear algebra."""

import numpy as np
import pytest

from knitcore.yarn.kernels.tiles import empty_tiles, tiled_product
from knitcore.yarn.solve.fronts import FrontalFactor, Room, elimination

SIZE, UNKNOWNS = 3, 58


def _ring_with_chords():
    """A tiled matrix on a ring of 20 blocks with some chords, and the same matrix dense."""
    rng = np.random.default_rng(4)
    blocks = -(-UNKNOWNS // SIZE)
    touching = np.eye(blocks, dtype=bool)
    for a, b in [(k, (k + 1) % blocks) for k in range(blocks)] + [(0, 7), (3, 12), (5, 16)]:
        touching[a, b] = touching[b, a] = True
    matrix = empty_tiles(touching, SIZE, UNKNOWNS)
    dense = np.zeros((blocks * SIZE, blocks * SIZE))
    for a, b in np.argwhere(np.tril(touching)):
        tile = rng.standard_normal((SIZE, SIZE))
        dense[a * SIZE : (a + 1) * SIZE, b * SIZE : (b + 1) * SIZE] = tile
    dense = dense + dense.T + 12.0 * np.eye(len(dense))
    dense[UNKNOWNS:] = 0.0
    dense[:, UNKNOWNS:] = 0.0
    for a, b in np.argwhere(np.tril(touching)):
        part = dense[a * SIZE : (a + 1) * SIZE, b * SIZE : (b + 1) * SIZE]
        matrix.tiles[matrix.where[a, b]] = part
    return touching, matrix, dense[:UNKNOWNS, :UNKNOWNS]


def test_every_block_is_eliminated_once_and_borders_come_later():
    touching, _, _ = _ring_with_chords()
    fronts = elimination(touching, np.arange(len(touching)))
    order = np.concatenate([front.own for front in fronts])
    assert sorted(order) == list(range(len(touching)))
    rank = np.argsort(order)
    for front in fronts:
        assert all(rank[front.border] > rank[front.own].max())


def test_a_chain_whose_members_pass_on_nearly_all_is_one_front():
    band = np.abs(np.subtract.outer(np.arange(30), np.arange(30))) <= 12
    fronts = elimination(band, np.arange(30))
    assert len(fronts) < 8
    assert sorted(np.concatenate([front.own for front in fronts])) == list(range(30))


@pytest.mark.parametrize("damping", [0.0, 5.0])
def test_solves_like_a_dense_solver(damping):
    touching, matrix, dense = _ring_with_chords()
    fronts = elimination(touching, np.arange(len(touching)))
    factor = FrontalFactor(matrix, fronts, Room(), np.float64)
    assert factor.factorise(damping)
    right = np.random.default_rng(5).standard_normal((UNKNOWNS, 2))
    expected = np.linalg.solve(dense + damping * np.eye(UNKNOWNS), right)
    np.testing.assert_allclose(factor.solve(right), expected, atol=1e-12)


def test_tells_an_indefinite_matrix_and_how_much_damping_it_takes():
    touching, matrix, dense = _ring_with_chords()
    matrix.tiles[matrix.where[4, 4]] -= 20.0 * np.eye(SIZE)
    dense[4 * SIZE : 5 * SIZE, 4 * SIZE : 5 * SIZE] -= 20.0 * np.eye(SIZE)
    lowest = np.linalg.eigvalsh(dense)[0]
    fronts = elimination(touching, np.arange(len(touching)))
    factor = FrontalFactor(matrix, fronts, Room(), np.float64)
    assert lowest < 0.0
    assert not factor.factorise(0.0)
    assert not factor.factorise(-0.99 * lowest)
    assert factor.factorise(-1.01 * lowest)


def test_memory_is_used_again_and_blank():
    room = Room()
    first, second = room.zeros(5, 3, np.float64), room.zeros(4, 4, np.float64)
    assert not np.shares_memory(first, second)
    first += 1.0
    again = [room.zeros(3, 5, np.float64)]
    assert not np.shares_memory(first, again[0])
    room.take_back(first)
    again.append(room.zeros(4, 7, np.float32))
    assert np.shares_memory(first, again[1])
    assert not again[1].any()
    room.take_all_back()
    assert np.shares_memory(second, room.zeros(4, 4, np.float64))


def test_product_with_a_vector():
    _, matrix, dense = _ring_with_chords()
    vector = np.linspace(-1.0, 2.0, UNKNOWNS)
    np.testing.assert_allclose(tiled_product(matrix.tiles, matrix.where, vector), dense @ vector)
