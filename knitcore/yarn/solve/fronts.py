"""Cholesky factors of a sparse symmetric matrix made of square tiles: the multifrontal method.

Stitches far apart do not touch, so the Hessian of a large cell is sparse. Which of them touch is
not known beforehand, since fabric folds; the fronts are therefore found from the tiles that are
there, in an order of elimination by nested dissection. Blocks that are eliminated together own a
dense front.
"""

from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.linear.dense import backward, eliminate, forward, subtract_product
from knitcore.linear.elimination_order import dissected
from knitcore.yarn.kernels.structures import Ints
from knitcore.yarn.kernels.tiles import TiledMatrix

_PASSING_ON = 3.0
"""Passing on a tile of a remainder takes as long as this many products of tiles."""

_STALE = 1.1
"""An order is found again where its work has grown by this factor."""

Floats = NDArray[np.floating]
Precision = type[np.float32] | type[np.float64]


@dataclass(frozen=True, eq=False)
class Front:
    """Blocks that are eliminated together.

    Attributes
    ----------
    own, border : the blocks, and those that they touch among the later ones, in the order of
        elimination.
    children : fronts whose remainders are added to this one, with the place of their border blocks
        among this front's own and border blocks.
    """

    own: Ints
    border: Ints
    children: tuple[tuple[int, Ints], ...]


def elimination(touching: NDArray[np.bool_], preferred: Ints) -> tuple[Front, ...]:
    """The fronts of a symmetric pattern (blocks, blocks) in about the preferred order.

    Blocks that touch the same others are eliminated together, and so are those that touch nearly
    all that the next ones touch: fewer remainders are passed on, at the price of some zeros.
    """
    order, first, border, border_first = _eliminated(touching.copy(), preferred)
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    own, edge = [], []
    for f in range(len(first) - 1):
        blocks = border[border_first[f] : border_first[f + 1]]
        own.append(order[first[f] : first[f + 1]])
        edge.append(blocks[np.argsort(rank[blocks])])
    owner = np.repeat(np.arange(len(own)), np.diff(first))[rank]
    kept = []
    for f in range(len(own)):
        parent = int(owner[edge[f][0]]) if len(edge[f]) else f
        s, t, b = len(own[f]), len(own[parent]), len(edge[parent])
        if parent > f and _cost(s + t, b) < _cost(s, len(edge[f])) + _cost(t, b):
            both = np.concatenate([own[f], own[parent]])
            own[parent] = both[np.argsort(rank[both])]
            owner[own[f]] = parent
        else:
            kept.append(f)
    number = {f: k for k, f in enumerate(kept)}
    children: list[list[tuple[int, Ints]]] = [[] for _ in kept]
    for f in kept:
        if len(edge[f]):
            parent = int(owner[edge[f][0]])
            places = np.searchsorted(
                rank[np.concatenate([own[parent], edge[parent]])], rank[edge[f]]
            )
            children[number[parent]].append((number[f], places))
    return tuple(
        Front(own[f], edge[f], tuple(below)) for f, below in zip(kept, children, strict=True)
    )


def work(fronts: tuple[Front, ...]) -> float:
    """Arithmetic that a factor takes, in products of tiles."""
    return sum(_cost(len(front.own), len(front.border)) for front in fronts)


def _cost(own: int, border: int) -> float:
    """Products of tiles of a front, and what passing on its remainder is worth of them."""
    return own**3 / 3 + own**2 * border + own * border**2 + _PASSING_ON * border**2


class Dissection:
    """The fronts of a pattern that changes little from step to step, as yarn touches and parts."""

    def __init__(self) -> None:
        self._touching: NDArray[np.bool_] | None = None
        self._order: Ints | None = None
        self._fronts: tuple[Front, ...] = ()
        self._fresh = 0.0

    def fronts(self, touching: NDArray[np.bool_]) -> tuple[Front, ...]:
        """The fronts of a symmetric pattern (blocks, blocks)."""
        if self._touching is None or not np.array_equal(self._touching, touching):
            self._touching = touching
            if self._order is not None:
                self._fronts = elimination(touching, self._order)
            if self._order is None or work(self._fronts) > _STALE * self._fresh:
                self._order = dissected(touching)
                self._fronts = elimination(touching, self._order)
                self._fresh = work(self._fronts)
        return self._fronts


class Room:
    """Memory for factors, used again by the next one: touching new pages would take as long as
    the arithmetic."""

    def __init__(self) -> None:
        self._spare: defaultdict[int, list[NDArray[np.uint8]]] = defaultdict(list)
        self._lent: dict[int, NDArray[np.uint8]] = {}

    def zeros(self, columns: int, rows: int, precision: Precision) -> Floats:
        """A lent array of zeros (columns, rows)."""
        count = rows * columns * np.dtype(precision).itemsize
        spare = self._spare[count.bit_length()]
        flat = spare.pop() if spare else np.empty(1 << count.bit_length(), np.uint8)
        array = np.asarray(flat[:count].view(precision).reshape((columns, rows)))
        array.fill(0.0)
        self._lent[array.ctypes.data] = flat
        return array

    def take_back(self, array: Floats) -> None:
        """Take a lent array back; its memory is lent again."""
        flat = self._lent.pop(array.ctypes.data)
        self._spare[len(flat).bit_length() - 1].append(flat)

    def take_all_back(self) -> None:
        """Take all lent arrays back."""
        for flat in self._lent.values():
            self._spare[len(flat).bit_length() - 1].append(flat)
        self._lent.clear()


class FrontalFactor:
    """Factors of one matrix, scaled to a unit diagonal.

    Parameters
    ----------
    matrix : the matrix.
    fronts : its order of elimination.
    room : memory; whoever factorises in it overwrites the factor that was there.
    precision : of the factor.
    """

    def __init__(
        self, matrix: TiledMatrix, fronts: tuple[Front, ...], room: Room, precision: Precision
    ) -> None:
        self._matrix = matrix
        self._fronts = fronts
        self._room = room
        self._precision = precision
        size = matrix.tiles.shape[1]
        inside = np.arange(size)
        self._places = [
            (np.concatenate([front.own, front.border])[:, None] * size + inside).ravel()
            for front in fronts
        ]

    def factorise(self, damping: float) -> bool:
        """Factorise the matrix plus ``damping`` on its diagonal; False if not positive definite."""
        matrix = self._matrix
        size = matrix.tiles.shape[1]
        self._scale = _scale(matrix.tiles, matrix.where, matrix.unknowns, damping)
        room = self._room
        room.take_all_back()
        self._factors: list[Floats] = []
        remainders: list[Floats | None] = []
        for front in self._fronts:
            own, edge = len(front.own) * size, len(front.border) * size
            columns = room.zeros(own, own + edge, self._precision)
            rest = room.zeros(edge, edge, self._precision)
            _assemble(
                matrix.tiles, matrix.where, self._scale, damping, matrix.unknowns,
                front.own, front.border, columns,
            )  # fmt: skip
            for child, places in front.children:
                remainder = remainders[child]
                assert remainder is not None  # noqa: S101 - a child has one parent
                _extend(remainder, places, len(front.own), size, columns, rest)
                room.take_back(remainder)
                remainders[child] = None
            if not _reduced(columns, rest):
                return False
            self._factors.append(columns)
            remainders.append(rest)
        return True

    def keep(self) -> None:
        """Leave the room to others, and free what only another factorisation would need."""
        self._factors = [columns.copy() for columns in self._factors]
        del self._matrix, self._room

    def solve(self, right: Array) -> Array:
        """The inverse times the columns (unknowns, k)."""
        scale = self._scale[: len(right)]
        x = np.zeros((right.shape[1], len(self._scale)), self._precision)
        x[:, : len(right)] = right.T * scale
        fronts = list(zip(self._factors, self._places, strict=True))
        for columns, places in fronts:
            _substituted(columns, places, x, False)
        for columns, places in reversed(fronts):
            _substituted(columns, places, x, True)
        return np.asarray(x[:, : len(right)].T * scale[:, None], dtype=float)


@compiled
def _reduced(columns: Floats, rest: Floats) -> bool:
    """Eliminate a front's own unknowns, and take their share from the rest; False if they are not
    positive definite."""
    own = columns.shape[0]
    if not eliminate(columns):
        return False
    subtract_product(rest[:, :], columns[:, own:], columns[:, own:], True)
    return True


@compiled
def _substituted(columns: Floats, places: Ints, x: Floats, back: bool) -> None:
    """Forward or backward substitution of a front in every row of ``x``, in place."""
    part = np.empty(columns.shape[1], columns.dtype)
    for row in x:
        for k in range(part.shape[0]):
            part[k] = row[places[k]]
        if back:
            backward(columns, part)
        else:
            forward(columns, part)
        for k in range(part.shape[0]):
            row[places[k]] = part[k]


@compiled
def _eliminated(  # noqa: PLR0912, PLR0915 - compiled: one block after the other
    touching: NDArray[np.bool_], preferred: Ints
) -> tuple[Ints, Ints, Ints, Ints]:
    """Order of elimination, first of each front in it, border blocks of all fronts, their firsts.

    ``touching`` is overwritten.
    """
    n = touching.shape[0]
    alive = np.ones(n, np.bool_)
    degree = np.zeros(n, np.int64)
    for i in range(n):
        touching[i, i] = False
        for j in range(n):
            degree[i] += touching[i, j]
    order = np.empty(n, np.int64)
    first = np.zeros(n + 1, np.int64)
    border_first = np.zeros(n + 1, np.int64)
    border = np.empty(16 * n, np.int64)
    around = np.empty(n, np.int64)
    done = fronts = stored = 0
    for k in preferred:
        if not alive[k]:
            continue
        count = 0
        for j in range(n):
            if alive[j] and touching[k, j]:
                around[count] = j
                count += 1
        order[done] = k
        done += 1
        alive[k] = False
        for q in range(count):
            j = around[q]
            same = degree[j] == count
            for other in range(count):
                same = same and (other == q or touching[j, around[other]])
            if same:  # it touches the same blocks, so it goes at the same time
                order[done] = j
                done += 1
                alive[j] = False
        gone = 1
        edge = 0
        for q in range(count):
            if alive[around[q]]:
                around[edge] = around[q]
                edge += 1
            else:
                gone += 1
        for q in range(edge):
            a = around[q]
            degree[a] -= gone
            for other in range(q):
                b = around[other]
                if not touching[a, b]:
                    touching[a, b] = True
                    touching[b, a] = True
                    degree[a] += 1
                    degree[b] += 1
        if stored + edge > border.shape[0]:
            grown = np.empty(2 * (stored + edge), np.int64)
            for q in range(stored):
                grown[q] = border[q]
            border = grown
        for q in range(edge):
            border[stored + q] = around[q]
        stored += edge
        fronts += 1
        first[fronts] = done
        border_first[fronts] = stored
    return order, first[: fronts + 1], border[:stored], border_first[: fronts + 1]


@compiled
def _scale(tiles: Array, where: NDArray[np.int32], unknowns: int, damping: float) -> Array:
    blocks, size = where.shape[0], tiles.shape[1]
    scale = np.ones(blocks * size)
    for u in range(unknowns):
        b, o = u // size, u % size
        scale[u] = 1.0 / np.sqrt(abs(tiles[where[b, b], o, o]) + damping)
    return scale


@compiled
def _assemble(
    tiles: Array, where: NDArray[np.int32], scale: Array, damping: float, unknowns: int,
    own: Ints, border: Ints, columns: Floats,
) -> None:  # fmt: skip
    """A front's part of the damped, scaled matrix; filled up with ones on the diagonal."""
    size = tiles.shape[1]
    for q in range(own.shape[0]):
        b = own[q]
        for p in range(q, own.shape[0] + border.shape[0]):
            a = own[p] if p < own.shape[0] else border[p - own.shape[0]]
            tile = where[max(a, b), min(a, b)]
            if tile < 0:
                continue
            for n in range(size):
                column = columns[q * size + n]
                for m in range(size):
                    value = tiles[tile, m, n] if a >= b else tiles[tile, n, m]
                    column[p * size + m] = value * scale[a * size + m] * scale[b * size + n]
        for n in range(size):
            u = b * size + n
            at = q * size + n
            columns[at, at] = columns[at, at] + damping * scale[u] ** 2 if u < unknowns else 1.0


@compiled
def _extend(
    remainder: Floats, places: Ints, own: int, size: int, columns: Floats, rest: Floats
) -> None:
    """Add what a child leaves of its border to its parent's front (lower triangles)."""
    count = places.shape[0]
    end = np.empty(count, np.int64)  # of the run of neighbours that a place belongs to
    for p in range(count - 1, -1, -1):
        last = p == count - 1 or places[p + 1] != places[p] + 1 or places[p + 1] == own
        end[p] = p + 1 if last else end[p + 1]
    for q in range(count):
        inside = places[q] < own
        target, column = (columns, places[q]) if inside else (rest, places[q] - own)
        p = q
        while p < count:
            row = places[p] - (0 if inside else own)
            length = (end[p] - p) * size
            for n in range(size):
                to = target[column * size + n, row * size : row * size + length]
                left = remainder[q * size + n, p * size : p * size + length]
                for m in range(length):
                    to[m] += left[m]
            p = end[p]
