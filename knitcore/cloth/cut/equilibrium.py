"""Equilibria of a piece along a load: Newton's method with an energy line search.

A load step starts from the last tangent. Where the tangent is indefinite on the way, a growing
share of the sheet's tangent at rest is added to it, which shortens the step. A state is accepted
only where its forces balance and its tangent is positive definite; a step that fails is halved.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, check_cancelled
from knitcore.cloth.cut.assembly import Assembled, PieceEnergy
from knitcore.cloth.cut.conditions import Constraints
from knitcore.cloth.flat.equilibrium_path import MAX_HALVINGS, MAX_NEWTON_STEPS, StepError
from knitcore.linear.grid_factor import IndefiniteTangentError, positive_definite_factor

Solve = Callable[[Array], Array]
"""A function that solves a linear system with a tangent for the unknowns."""

BALANCED = 1e-9
"""Residual of a balanced state, over the forces at the edges."""
FLOOR_N = 1e-12
MAX_SHIFT = 1e4


@dataclass(frozen=True, eq=False)
class PieceEquilibrium:
    """A balanced state.

    Attributes
    ----------
    share : of the load.
    displacement : (2, nodes), mm.
    energy : N·mm.
    internal : N, (2, nodes), internal forces; outside the edges they are 0.
    iterations : linear systems solved since the last level.
    """

    share: float
    displacement: Array
    energy: float
    internal: Array
    iterations: int


class Balance:
    """Follows the equilibria of a piece as its load grows.

    Parameters
    ----------
    energy : of the piece.
    constraints : on its nodes.
    cancelled : called between linear systems; True stops with :class:`CancelledError`.
    """

    def __init__(
        self, energy: PieceEnergy, constraints: Constraints, cancelled: Cancelled | None = None
    ) -> None:
        self.energy = energy
        self.constraints = constraints
        self.cancelled = cancelled or (lambda: False)
        self._spread = constraints.spread
        self._rest = self._reduced(self.at(np.zeros(constraints.held.shape)))

    def at(self, displacement: Array) -> Assembled:
        """Energy, forces and tangent of a state.

        Raises
        ------
        CancelledError
        """
        check_cancelled(self.cancelled)
        return self.energy.at(displacement, self.constraints.tapes)

    def follow(self, shares: Array) -> Iterator[PieceEquilibrium]:
        """Equilibria at increasing shares of the load.

        Raises
        ------
        StepError
            When a step fails even after halving; states yielded before that stay valid.
        CancelledError
        """
        state = np.zeros(self.constraints.held.shape)
        assembled = self.at(state)
        solve = self._factor(assembled)
        reached = 0.0
        for target in shares:
            step, iterations, halvings = target - reached, 0, 0
            while reached < target:
                goal = min(reached + step, float(target))
                try:
                    guess = self._along_tangent(state, assembled, solve, (reached, goal))
                    state, assembled, solve, count = self._balanced(guess, goal)
                except StepError as reason:
                    halvings += 1
                    if halvings > MAX_HALVINGS:
                        raise StepError(
                            f"{reason} {reached:.0%} of the load was reached."
                        ) from None
                    step /= 2
                    continue
                iterations += count
                reached, step = goal, 2 * step
            yield PieceEquilibrium(
                float(target), state, assembled.energy, assembled.force, iterations
            )

    def _along_tangent(
        self, state: Array, assembled: Assembled, solve: Solve, shares: tuple[float, float]
    ) -> Array:
        """The state at another share of the load, predicted along the tangent of a balanced one."""
        before, after = (self.constraints.displacements(share) for share in shares)
        move = after - before
        pushed = (assembled.tangent @ move.ravel()).reshape(move.shape)
        force = self.constraints.loads(shares[1]) - assembled.force - pushed
        return np.asarray(state + move + self._spread_out(solve(self._gathered(force))))

    def _balanced(self, state: Array, share: float) -> tuple[Array, Assembled, Solve, int]:
        """Balance the state near another; return it, its assembly, a solver with its tangent, and
        the number of linear systems solved.
        """
        loads = self.constraints.loads(share)
        assembled = self.at(state)
        for iteration in range(1, MAX_NEWTON_STEPS + 1):
            if not np.isfinite(assembled.energy):
                raise StepError("A fibre collapsed to a point.")
            residual = self._gathered(loads - assembled.force)
            if np.linalg.norm(residual) <= self._tolerated(assembled, loads):
                return state, assembled, self._stable(assembled), iteration
            step = self._spread_out(self._factor(assembled)(residual))
            state, assembled = self._line_search(state, assembled, step, loads)
        raise StepError(f"Newton's method did not balance the forces in {MAX_NEWTON_STEPS} steps.")

    def _tolerated(self, assembled: Assembled, loads: Array) -> float:
        outer = np.where(self.constraints.held, assembled.force, loads)
        return max(BALANCED * float(np.linalg.norm(outer)), FLOOR_N)

    def _line_search(
        self, state: Array, assembled: Assembled, step: Array, loads: Array
    ) -> tuple[Array, Assembled]:
        slope = float(np.sum((assembled.force - loads) * step))
        noise = 1e-13 * (abs(assembled.energy) + abs(float(np.sum(loads * state)))) + 1e-300
        share = 1.0
        while share > 1e-6:
            trial = state + share * step
            there = self.at(trial)
            gained = there.energy - assembled.energy - share * float(np.sum(loads * step))
            if gained <= 1e-4 * share * slope + noise:
                return trial, there
            share /= 2
        raise StepError("The line search found no state of lower energy.")

    def _stable(self, assembled: Assembled) -> Solve:
        try:
            return positive_definite_factor(self._reduced(assembled))
        except IndefiniteTangentError:
            raise StepError(
                "The balanced state is unstable (its tangent is not positive definite)."
            ) from None

    def _factor(self, assembled: Assembled) -> Solve:
        """Factorise the tangent, shifted as far as it needs to be positive definite."""
        tangent = self._reduced(assembled)
        shift = 0.0
        while shift <= MAX_SHIFT:
            try:
                return positive_definite_factor(tangent + shift * self._rest)
            except IndefiniteTangentError:
                shift = max(4 * shift, 1e-2)
        raise StepError("The tangent could not be factorised.")

    def _reduced(self, assembled: Assembled) -> Any:
        return scipy.sparse.csc_array(self._spread.T @ assembled.tangent @ self._spread)

    def _gathered(self, force: Array) -> Array:
        return np.asarray(self._spread.T @ force.ravel())

    def _spread_out(self, unknowns: Array) -> Array:
        return np.asarray(self._spread @ unknowns).reshape(self.constraints.held.shape)
