"""Equilibrium of a sheet along a path of prescribed edge positions.

One load step: predict (polynomial extrapolation of the last equilibria; along the tangent while
there are too few), then Newton steps with an energy line search. The linear systems are solved by
conjugate gradients on the true tangent, preconditioned by the last factorised one, so that a
factorisation serves several Newton steps. A state is accepted only where its forces balance and
its tangent is positive definite. A step that fails is halved; once it cannot be halved further, the
failure is reported with the part of the path that was reached.
"""

import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, Progress, check_cancelled
from knitcore.base.threads import one_blas_thread
from knitcore.cloth.flat.grid_sheet import Linearisation, Sheet, State
from knitcore.linear.grid_factor import GridFactor, IndefiniteTangentError

Balanced = TypeVar("Balanced")

MAX_NEWTON_STEPS = 30
MAX_HALVINGS = 7
FORCING = 1e-2
"""Relative accuracy of the linear systems far from balance."""
PATIENCE = 3
"""Conjugate gradient steps before the tangent is factorised again."""
CLOSE = 0.05
"""Unbalanced force over the force at the clamps up to which an extrapolation is trusted."""
FAR = 0.01
"""Unbalanced force over the force at the clamps beyond which a predicted state's tangent is
factorised before the first step."""
HISTORY = 4
"""Equilibria used by the extrapolation."""


@dataclass(frozen=True)
class Tolerance:
    """The condition for balance.

    Attributes
    ----------
    relative : residual force over the force at the prescribed nodes (Euclidean norms).
    absolute_n : N, floor below which a residual counts as 0.
    """

    relative: float = 1e-7
    absolute_n: float = 1e-10


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A balanced state.

    Attributes
    ----------
    state : positions.
    energy : N·mm.
    reaction : N, (corners, 2), force that holds the prescribed unknowns; 0 elsewhere.
    iterations : linear systems solved since the last level.
    """

    state: State
    energy: float
    reaction: Array
    iterations: int


@dataclass(frozen=True, eq=False)
class Path:
    """Equilibria found, the reason if the path stopped early, and the time taken."""

    equilibria: tuple[Equilibrium, ...]
    problem: str | None
    seconds: float

    @property
    def states(self) -> tuple[State, ...]:
        """Positions per step."""
        return tuple(e.state for e in self.equilibria)

    @property
    def energies(self) -> Array:
        """N·mm per step."""
        return np.array([e.energy for e in self.equilibria])

    @property
    def iterations(self) -> tuple[int, ...]:
        """Linear systems solved per step."""
        return tuple(e.iterations for e in self.equilibria)

    def forces(self, nodes: NDArray[np.int64], axis: int) -> Array:
        """Force (N) on prescribed nodes along an axis, per step."""
        return np.array([e.reaction[nodes, axis].sum() for e in self.equilibria])


class StepError(Exception):
    """A load step found no equilibrium; the message says why."""


class PathSolver:
    """Follows the equilibria of a sheet as prescribed corner positions change.

    Parameters
    ----------
    sheet : the sheet.
    fixed : bool array (corners, 2)
        Unknowns that are prescribed. They must at least exclude rigid motions. Corners
        without fabric are prescribed in any case.
    tolerance : when a state counts as balanced.
    cancelled : called between linear solves; True stops with :class:`CancelledError`.
    """

    def __init__(
        self,
        sheet: Sheet,
        fixed: NDArray[np.bool_],
        *,
        tolerance: Tolerance | None = None,
        cancelled: Cancelled | None = None,
    ) -> None:
        self.sheet = sheet
        self.fixed = fixed | ~sheet.grid.used_corners[:, None]
        self.free = (~self.fixed).astype(float)
        self.tolerance = tolerance or Tolerance()
        self.cancelled = cancelled or (lambda: False)
        self.factor = GridFactor(sheet.grid.columns, sheet.grid.rows, self.fixed.ravel())
        self._has_factor = False
        self._factor_is_current = False
        self._accepted: Linearisation | None = None  # of the last balanced state
        self._history: list[tuple[float, State]] = []
        self._spare: Linearisation | None = None

    def follow(self, start: State, targets: list[Array]) -> Iterator[Equilibrium]:
        """Equilibria at each target, the corner positions (corners, 2) of the prescribed unknowns.

        The first target is approached from ``start``. Between targets the prescribed positions
        move along straight lines.

        Raises
        ------
        StepError
            When a step fails even after halving; states yielded before that stay valid.
        CancelledError
            When the caller asked to stop.
        """
        state = start
        origin = start.corners
        self._history, self._accepted = [], None
        for number, target in enumerate(targets):
            done, share, iterations, halvings = 0.0, 1.0, 0, 0
            while done < 1.0:
                goal = min(1.0, done + share)
                prescribed = target if goal == 1.0 else origin + goal * (target - origin)
                try:
                    balanced = self._step(state, prescribed, number + goal)
                except StepError as reason:
                    halvings += 1
                    if halvings > MAX_HALVINGS:
                        raise StepError(
                            f"{reason} {done:.0%} of this step was reached, and halving it "
                            f"{MAX_HALVINGS} times did not help."
                        ) from reason
                    share /= 2
                    continue
                state, done = balanced.state, goal
                iterations += balanced.iterations
                share = min(2 * share, 1.0 - done) if done < 1.0 else share
            origin = target
            yield Equilibrium(balanced.state, balanced.energy, balanced.reaction, iterations)

    # -- one step ---------------------------------------------------------------------------

    def _step(self, state: State, prescribed: Array, level: float) -> Equilibrium:
        """Equilibrium with the prescribed positions, near a balanced state."""
        iterations = 0
        guess = self._extrapolated(level, prescribed)
        if guess is not None:  # one tangent at a time: that of a large sheet takes 0.3 GB
            self._spare, self._accepted = self._accepted, None
        lin = None if guess is None else self._linearise(guess)
        if guess is None or lin is None or not self._is_close(lin):
            residual, self._spare = np.inf if lin is None else self._residual(lin)[0], lin
            other = self._along_tangent(state, prescribed)
            lin = self._linearise(other)
            iterations += 1
            if guess is None or self._residual(lin)[0] < residual:
                guess = other
            else:
                self._spare = lin
                lin = self._linearise(guess)
        if not np.isfinite(lin.energy):
            raise StepError("A predicted fibre collapsed to a point.")
        state = guess
        for count in range(MAX_NEWTON_STEPS):
            residual, limit = self._residual(lin)
            if residual <= limit:
                return self._accept(state, lin, level, iterations)
            force = lin.condensed_force() * self.free
            far = residual * self.tolerance.relative > FAR * limit
            if not self._has_factor or (count == 0 and far):
                self._try_factorise(lin)
            step = self._solve(lin, -force, max(0.3 * limit / residual, FORCING))
            iterations += 1
            state, lin = self._line_search(state, lin, step)
        raise StepError(
            f"Newton's method did not balance the forces in {MAX_NEWTON_STEPS} steps "
            f"(residual {residual:.2g} N, allowed {limit:.2g} N)."
        )

    def _accept(
        self, state: State, lin: Linearisation, level: float, iterations: int
    ) -> Equilibrium:
        try:
            self._factorise(lin)
        except IndefiniteTangentError:
            raise StepError(
                "The balanced state is unstable (its tangent is not positive definite)."
            ) from None
        self._accepted = lin
        self._history = [*self._history[1 - HISTORY :], (level, state)]
        return Equilibrium(
            state, lin.energy, np.where(self.fixed, lin.force.corners, 0), iterations
        )

    def _is_close(self, lin: Linearisation) -> bool:
        """Tell if an extrapolated state is near enough to balance to start from."""
        free, limit = self._residual(lin)
        return free * self.tolerance.relative <= CLOSE * limit

    def _along_tangent(self, state: State, prescribed: Array) -> State:
        """Prediction along the tangent of a balanced state, whose factor is available."""
        lin = self._accepted or self._linearise(state)
        move = np.where(self.fixed, prescribed - state.corners, 0.0)
        force = lin.condensed_force() + lin.apply(move)
        if not self._has_factor:
            self._try_factorise(lin)
        step = move + self._solve(lin, -force * self.free, 1e-3)
        guess = state.moved(lin.newton_step(step))
        guess.corners[self.fixed] = prescribed[self.fixed]
        self._spare, self._accepted = lin, None
        return guess

    def _extrapolated(self, level: float, prescribed: Array) -> State | None:
        if len(self._history) < 3:
            return None
        levels = np.array([known for known, _ in self._history])
        weights = [
            float(np.prod((level - np.delete(levels, i)) / (levels[i] - np.delete(levels, i))))
            for i in range(len(levels))
        ]
        guess = State(
            *(
                sum((w * at for w, at in zip(weights, places, strict=True)), np.zeros(()))
                for places in zip(*(state for _, state in self._history), strict=True)
            )
        )
        guess.corners[self.fixed] = prescribed[self.fixed]
        return guess

    def _residual(self, lin: Linearisation) -> tuple[float, float]:
        """Norm of the unbalanced force, and the largest norm that is tolerated, N."""
        corners, centres = lin.force
        free = float(np.sqrt(np.sum((corners * self.free) ** 2) + np.sum(centres**2)))
        held = float(np.linalg.norm(corners[self.fixed]))
        return free, max(self.tolerance.relative * held, self.tolerance.absolute_n)

    def _line_search(
        self, state: State, lin: Linearisation, corner_step: Array
    ) -> tuple[State, Linearisation]:
        step = lin.newton_step(corner_step)
        slope = sum(float(np.sum(f * d)) for f, d in zip(lin.force, step, strict=True))
        energy = lin.energy
        noise = 1e-13 * abs(energy) + 1e-300
        share = 1.0
        self._spare = lin
        while share > 1e-6:
            trial = state.moved(step, share)
            there = self._linearise(trial)
            if there.energy <= energy + 1e-4 * share * slope + noise:
                return trial, there
            share /= 2
        raise StepError("The line search found no state of lower energy.")

    # -- linear algebra ----------------------------------------------------------------------

    def _linearise(self, state: State) -> Linearisation:
        check_cancelled(self.cancelled)
        reuse, self._spare = self._spare, None
        self._factor_is_current = False
        lin = self.sheet.linearise(state, reuse)
        return lin

    def _factorise(self, lin: Linearisation) -> None:
        self._has_factor = False  # a factorisation that failed half-way is useless
        self.factor.factorise(lin.tangent.matrix)
        self._has_factor = True
        self._factor_is_current = True

    def _try_factorise(self, lin: Linearisation) -> None:
        """Factorise a tangent during the iteration; where it is indefinite, that of the sheet at
        rest instead, which is positive definite up to rounding.

        Raises
        ------
        StepError
            If the cells' proportions or stiffnesses are too extreme even for that.
        """
        try:
            self._factorise(lin)
        except IndefiniteTangentError:
            try:
                self._factorise(self.sheet.linearise(self.sheet.reference))
            except IndefiniteTangentError:
                raise StepError(
                    "Not even the sheet at rest can be factorised: its sizes or stiffnesses "
                    "differ by more than double precision can hold."
                ) from None
            self._factor_is_current = False

    def _solve(self, lin: Linearisation, force: Array, relative: float) -> Array:
        """Step (corners, 2) with K step = force on the free unknowns, by preconditioned CG.

        Stops early in a direction of negative curvature, so that the step always goes downhill.
        """
        x = np.zeros_like(force)
        r = force.copy()
        z = self.factor.solve(r).reshape(r.shape)
        p = z
        rz = float(np.sum(r * z))
        goal = relative * float(np.linalg.norm(r))
        for count in range(40):
            q = lin.apply(p) * self.free
            curvature = float(np.sum(p * q))
            if curvature <= 0:
                return p if count == 0 else x
            a = rz / curvature
            x = x + a * p
            r = r - a * q
            if float(np.linalg.norm(r)) <= goal:
                return x
            renewed = count == PATIENCE and not self._factor_is_current
            if renewed:
                self._try_factorise(lin)
            z = self.factor.solve(r).reshape(r.shape)
            new = float(np.sum(r * z))
            # Directions of another preconditioner are not conjugate to the new ones: start afresh.
            p = z if renewed else z + (new / rz) * p
            rz = new
        return x


def as_far_as_it_converges(
    path: Iterator[Balanced], steps: int, progress: Progress | None
) -> tuple[tuple[Balanced, ...], str | None]:
    """Follow a path of at most ``steps`` steps; also say why it stopped early, if it did."""
    reached: list[Balanced] = []
    try:
        with one_blas_thread():
            for equilibrium in path:
                reached.append(equilibrium)
                if progress is not None:
                    progress(len(reached), steps)
    except StepError as error:
        return tuple(reached), f"Step {len(reached) + 1} of {steps} did not converge. {error}"
    return tuple(reached), None


def run_path(
    sheet: Sheet,
    fixed: NDArray[np.bool_],
    targets: list[Array],
    *,
    start: State | None = None,
    tolerance: Tolerance | None = None,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> Path:
    """Follow the targets as far as they converge.

    Raises
    ------
    CancelledError
        If ``cancelled`` returned True.
    """
    begin = time.perf_counter()
    solver = PathSolver(sheet, fixed, tolerance=tolerance, cancelled=cancelled)
    path = solver.follow(start or sheet.reference, targets)
    equilibria, problem = as_far_as_it_converges(path, len(targets), progress)
    return Path(equilibria, problem, time.perf_counter() - begin)
