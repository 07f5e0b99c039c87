"""Cholesky factors on a tree of dense fronts (multifrontal method).

Corners of a grid are eliminated box by box: those that only a box holds, as one dense front with
the corners around it that are eliminated later. What is left for these is added to the front of the
box that the first one is a half of.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.threads import side_by_side
from knitcore.linear import elimination

Block = NDArray[np.floating]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class CornerFront:
    """Corners that are eliminated together, those after them that they touch, and the fronts whose
    remainders are added to this one."""

    own: Indices
    border: Indices
    children: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class BlockRows:
    """A symmetric matrix by rows of blocks: ``blocks`` (count, n, n) of the ``columns`` (count,),
    those of a row from ``starts`` (rows + 1,)."""

    starts: NDArray[np.int32]
    columns: NDArray[np.int32]
    blocks: Array


class FrontTree:
    """The order of elimination of matrices of one pattern.

    Parameters
    ----------
    fronts : children before their parents; every corner is one front's own.
    size : unknowns of a corner.
    two_threads : whether each works on one of the branches at the root.
    """

    def __init__(self, fronts: list[CornerFront], size: int, *, two_threads: bool = False) -> None:
        order = np.concatenate([front.own for front in fronts])
        self._rank = np.empty(len(order), np.int64)
        self._rank[order] = np.arange(len(order))
        borders = [front.border[np.argsort(self._rank[front.border])] for front in fronts]
        places: list[Indices] = [np.empty(0, np.int64)] * len(fronts)
        for front, border in zip(fronts, borders, strict=True):
            ranks = self._rank[np.concatenate([front.own, border])]
            for child in front.children:
                places[child] = np.searchsorted(ranks, self._rank[borders[child]])
        self._own, self._border, self._places = (
            (size * corners[:, None] + np.arange(size)).ravel()
            for corners in (order, np.concatenate(borders), np.concatenate(places))
        )
        s = size * np.array([len(front.own) for front in fronts])
        b = size * np.array([len(border) for border in borders])
        children = np.full((len(fronts), 2), -1)
        for row, front in zip(children, fronts, strict=True):
            row[: len(front.children)] = front.children
        room, self.work = _room(children, b)
        self.entries = int((s * (s + b)).sum())
        starts = (np.cumsum(ends) - ends for ends in (s * (s + b), s, b))
        offset, own, border_at = starts
        self._boxes = np.column_stack([offset, s, b, children, room, own, border_at])
        self._widest = int((s + b).max())
        self._half = int(children[-1, 0]) + 1 if two_threads else 0

    def eliminate(self, matrix: BlockRows, factor: Block, work: Block) -> bool:
        """Factorise a matrix; False if it is not positive definite in the factor's precision.

        Parameters
        ----------
        matrix : of the pattern; an entry counts where its row is eliminated before its column.
        factor, work : (entries,) and (work,), the factor and room for what waits.
        """

        def branch(first: int, last: int) -> bool:
            done: bool = elimination.eliminate(
                first, last, self._boxes, self._own, self._border, self._places, self._rank,
                matrix.starts, matrix.columns, matrix.blocks, factor, work,
            )  # fmt: skip
            return done

        root = len(self._boxes) - 1
        if self._half == 0:
            return branch(0, root + 1)
        both = side_by_side(lambda: branch(0, self._half), lambda: branch(self._half, root))
        return all(both) and branch(root, root + 1)

    def solve(self, factor: Block, right: Array) -> Array:
        """The inverse times a vector, (unknowns,), to the factor's precision."""
        x = right.ravel().astype(factor.dtype)
        half, root = self._half, len(self._boxes) - 1
        tree = factor, self._boxes, self._own, self._border
        v, w = np.empty((2, self._widest), x.dtype)
        if half == 0:
            elimination.forward(0, root + 1, *tree, v, x)
            elimination.backward(0, root + 1, *tree, v, x)
            return x.astype(np.float64)
        # Both branches add to the unknowns of the root, so each has a copy of its own on the way
        # up.
        second, top = np.split(self._own[self._boxes[half, 6] :], [-self._boxes[root, 1]])
        other = x.copy()
        other[top] = 0.0
        side_by_side(
            lambda: elimination.forward(0, half, *tree, v, x),
            lambda: elimination.forward(half, root, *tree, w, other),
        )
        x[top] += other[top]
        x[second] = other[second]
        elimination.forward(root, root + 1, *tree, v, x)
        elimination.backward(root, root + 1, *tree, v, x)
        side_by_side(
            lambda: elimination.backward(0, half, *tree, v, x),
            lambda: elimination.backward(half, root, *tree, w, x),
        )
        return x.astype(np.float64)


def _room(children: Indices, border: Indices) -> tuple[Indices, int]:
    """Where the remainder of each front waits for its parent, and how much room all need.

    The first child's waits while the second branch is eliminated; below it is used again. The
    branches of the root do not share room, so that two threads can work on them.
    """
    own = border**2
    extent = own.copy()
    for k, (one, two) in enumerate(children):
        if one >= 0:
            extent[k] += max(extent[one], own[one] + extent[two])
    room = np.zeros(len(own), np.int64)
    root = len(own) - 1
    for k in range(root, -1, -1):
        one, two = children[k]
        if one >= 0:
            room[one] = room[k] + own[k]
            room[two] = room[one] + (extent if k == root else own)[one]
    return room, int((room + extent).max())
