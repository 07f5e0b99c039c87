"""Conditions on the edges of a piece."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.cloth.cut.outline import CutPiece

Indices = NDArray[np.int64]

MAX_SHEAR_ANGLE = 1.2
"""Largest shear of a frame, rad; beyond it courses and wales touch in any knit."""


@dataclass(frozen=True)
class Held:
    """An edge that is gripped, or sewn to something stiff, and moved as a whole.

    Parameters
    ----------
    edge : its name.
    x_mm, y_mm : displacement at the last step; None where it is free to slide.
    """

    edge: str
    x_mm: float | None = 0.0
    y_mm: float | None = 0.0


@dataclass(frozen=True)
class Pulled:
    """An edge in a clamp that does not turn and moves freely under a force.

    Parameters
    ----------
    edge : its name.
    x_n, y_n : the force in the end, N.
    """

    edge: str
    x_n: float = 0.0
    y_n: float = 0.0


@dataclass(frozen=True)
class Traction:
    """A load spread evenly along an edge, which changes its shape freely.

    Parameters
    ----------
    edge : its name.
    x_n_per_mm, y_n_per_mm : the load in the end per length of the edge at rest, N/mm.
    """

    edge: str
    x_n_per_mm: float = 0.0
    y_n_per_mm: float = 0.0


@dataclass(frozen=True)
class Sewn:
    """An edge with a tape or elastic sewn on, which resists stretching and bends freely.

    Parameters
    ----------
    edge : its name.
    stiffness_n : force of the tape over its strain, N.
    """

    edge: str
    stiffness_n: float


@dataclass(frozen=True)
class Framed:
    """An edge on the bars of a hinged frame, along x and y at rest, that shears the piece.

    Parameters
    ----------
    edge : its name.
    shear_angle : rad, by which the bars' right angle has closed in the end.
    """

    edge: str
    shear_angle: float


Condition = Held | Pulled | Traction | Sewn | Framed


def frame(angle: float) -> Array:
    """Images, as rows, of the unit vectors along the bars of a frame sheared by an angle (rad)."""
    c, s = math.cos(angle / 2), math.sin(angle / 2)
    return np.array([[c, s], [s, c]])


def frame_rate(angle: float) -> Array:
    """Derivative of :func:`frame`."""
    c, s = math.cos(angle / 2) / 2, math.sin(angle / 2) / 2
    return np.array([[-s, c], [c, -s]])


class Constraints:
    """Conditions on the nodes of a mesh.

    The displacements (2, nodes), flattened, are ``displacements(share) + spread @ q``: the
    prescribed ones, and the unknowns q. A clamp that moves freely has one unknown in each
    direction.

    Parameters
    ----------
    basis : a scalar basis of scikit-fem on the piece's mesh.
    piece : with the edges' names.
    conditions : enough of them that the piece cannot move or turn as a whole.

    Raises
    ------
    InputError
        If conditions contradict each other or leave the piece free to move.

    Attributes
    ----------
    held : bool (2, nodes), True where displacements are prescribed.
    spread : sparse (2 * nodes, unknowns).
    nodes : of each condition.
    """

    def __init__(self, basis: Any, piece: CutPiece, conditions: Sequence[Condition]) -> None:
        if not conditions:
            raise InputError("conditions", "no edge is held.", "Hold an edge, and pull another.")
        self.conditions = tuple(conditions)
        self._places: Array = basis.doflocs
        for condition in conditions:
            _check(condition)
            piece.sides_of(condition.edge)
        facets = {edge: basis.mesh.boundaries[edge] for edge in piece.edges}
        self.nodes: tuple[Indices, ...] = tuple(
            basis.get_dofs(facets[condition.edge]).all() for condition in conditions
        )
        self._edges = [basis.boundary(facets[condition.edge]) for condition in conditions]
        self.held = ~np.isnan(self._prescribed(1.0))
        self.spread = self._spread()
        self._check_rest()

    @property
    def tapes(self) -> list[tuple[Any, float]]:
        """Bases of sewn edges, and the stiffnesses (N) of their tapes."""
        return [
            (edge, condition.stiffness_n)
            for edge, condition in zip(self._edges, self.conditions, strict=True)
            if isinstance(condition, Sewn)
        ]

    def displacements(self, share: float) -> Array:
        """Prescribed displacements (2, nodes), mm, at a share of the load; 0 elsewhere."""
        return np.nan_to_num(self._prescribed(share))

    def loads(self, share: float) -> Array:
        """Forces (2, nodes), N, at a share of the load."""
        from skfem import LinearForm

        loads = np.zeros(self.held.shape)
        for condition, nodes, edge in zip(self.conditions, self.nodes, self._edges, strict=True):
            match condition:
                case Pulled():  # the clamp's unknown sums them, so one node may carry all
                    loads[:, nodes[0]] += share * condition.x_n, share * condition.y_n
                case Traction():
                    along = LinearForm(lambda v, _: v).assemble(edge)
                    load = np.array([condition.x_n_per_mm, condition.y_n_per_mm])
                    loads += share * np.outer(load, along)
        return loads

    def forces(self, internal: Array, share: float) -> Array:
        """Force on each edge, (conditions, 2) in N, from the internal forces (2, nodes).

        A corner that two held edges share counts for the first.
        """
        outer = internal - self.loads(share)
        counted = np.zeros(self.held.shape, dtype=bool)
        on_edges = np.zeros((len(self.nodes), 2))
        for i, (condition, nodes) in enumerate(zip(self.conditions, self.nodes, strict=True)):
            match condition:
                case Held() | Framed():
                    new = self.held[:, nodes] & ~counted[:, nodes] & self._holds(condition)
                    on_edges[i] = np.sum(np.where(new, outer[:, nodes], 0.0), axis=1)
                    counted[:, nodes] |= new
                case Pulled():
                    on_edges[i] = share * condition.x_n, share * condition.y_n
                case Traction():
                    length = float(np.sum(self._edges[i].dx))
                    on_edges[i] = condition.x_n_per_mm, condition.y_n_per_mm
                    on_edges[i] *= share * length
        return on_edges

    @staticmethod
    def _holds(condition: Held | Framed) -> NDArray[np.bool_]:
        """Mask (2, 1) of the directions that a condition holds."""
        if isinstance(condition, Framed):
            return np.ones((2, 1), dtype=bool)
        return np.array([[condition.x_mm is not None], [condition.y_mm is not None]])

    def _prescribed(self, share: float) -> Array:
        """Displacements (2, nodes); NaN where they are free."""
        prescribed = np.full(self._places.shape, np.nan)
        for condition, nodes in zip(self.conditions, self.nodes, strict=True):
            match condition:
                case Held():
                    ends = (condition.x_mm, condition.y_mm)
                    moved = np.array([[np.nan if e is None else share * e] for e in ends])
                case Framed():
                    at = self._places[:, nodes]
                    moved = frame(share * condition.shear_angle) @ at - at
                case _:
                    continue
            before = prescribed[:, nodes]
            if np.any(np.abs(before - moved) > 1e-9 * (1 + np.abs(moved))):
                raise InputError(
                    "conditions",
                    f"edge {condition.edge!r} meets another edge that moves differently.",
                    "Leave a free side between them, or let one of them slide.",
                )
            prescribed[:, nodes] = np.where(np.isnan(before), moved, before)
        return prescribed

    def _spread(self) -> scipy.sparse.csr_array:
        """Matrix (2 * nodes, unknowns) that turns the unknowns into displacements."""
        count = self.held.size
        leader = np.arange(count).reshape(self.held.shape)
        clamped = np.zeros(self.held.shape[1], dtype=bool)
        for condition, nodes in zip(self.conditions, self.nodes, strict=True):
            if not isinstance(condition, Pulled):
                continue
            if self.held[:, nodes].any() or clamped[nodes].any():
                raise InputError(
                    "conditions",
                    f"edge {condition.edge!r} is pulled and meets an edge that is held.",
                    "Leave a free side between them.",
                )
            clamped[nodes] = True
            leader[:, nodes] = leader[:, nodes[:1]]
        free = ~self.held.ravel()
        leaders, unknown = np.unique(leader.ravel()[free], return_inverse=True)
        rows = np.flatnonzero(free)
        ones = np.ones(len(rows))
        return scipy.sparse.csr_array((ones, (rows, unknown)), shape=(count, len(leaders)))

    def _check_rest(self) -> None:
        """Refuse a piece that can move or turn as a whole."""
        x, y = self._places - self._places.mean(axis=1, keepdims=True)
        size = float(np.hypot(x, y).max())
        motions = np.zeros((2, len(x), 3))
        motions[0, :, 0] = motions[1, :, 1] = 1.0
        motions[:, :, 2] = -y / size, x / size
        resisted = [motions[self.held]]
        for condition, nodes in zip(self.conditions, self.nodes, strict=True):
            if isinstance(condition, Pulled):
                resisted.append(np.concatenate(motions[:, nodes] - motions[:, nodes[:1]]))
        if np.linalg.matrix_rank(np.concatenate(resisted), tol=1e-6) < 3:
            raise InputError(
                "conditions",
                "the piece can still move or turn as a whole.",
                "Hold an edge in x and y.",
            )


def _check(condition: Condition) -> None:
    """Refuse values that are not numbers or out of range."""
    for name, value in vars(condition).items():
        if isinstance(value, float | int) and not math.isfinite(value):
            raise InputError(name, f"{value} is not a number.", "Give a finite number.")
    if isinstance(condition, Sewn) and condition.stiffness_n <= 0:
        raise InputError("stiffness_n", "must be above 0 N.", "Give the tape's force over strain.")
    if isinstance(condition, Framed) and not 0 < abs(condition.shear_angle) <= MAX_SHEAR_ANGLE:
        raise InputError(
            "shear_angle",
            f"{condition.shear_angle} rad is out of range.",
            f"Give {-MAX_SHEAR_ANGLE} to {MAX_SHEAR_ANGLE} rad, but not 0.",
        )
