"""Damped Newton iterations on the energy of a cell, every step certified.

The Hessian is exact (three unknowns a control point, half of that with a wale axis), dense in small
cells and sparse in large ones. Where the energy is not convex, H + mu I is factorised with
increasing mu until a factor exists (Levenberg-Marquardt); inverse iterations with the factor then
find the lowest curvature, and the next steps are damped just beyond it, so that they leave a saddle
fast. The length of each course is a constraint: a step and the change of the tensions follow from
one system (Newton on the Lagrangian), and the augmented Lagrangian with these tensions is the merit
function, which must fall. Inextensible yarn makes the valley of the merit narrow and curved, so
that a step along the valley leaves it; chord steps, with the factor of the last Hessian, return to
it at a fraction of the cost.

On convergence the Hessian distinguishes a minimum from a saddle, where a state can be trapped by a
symmetry of the first shape; a saddle is left along its direction of most negative curvature, to a
side that is fixed.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, ConvergenceError, UnravelledError, check_cancelled
from knitcore.base.threads import in_one_blas_thread
from knitcore.yarn.model.energy import CellEnergy, Slope, Terms
from knitcore.yarn.solve.fronts import Dissection, Room
from knitcore.yarn.solve.systems import DenseSystem, SparseSystem, System
from knitcore.yarn.solve.topology import Trajectory, rounded

COURSE, WALE = -2, -1
"""Places of the two cell sizes among the unknowns."""

_DAMPING = 100.0
"""First damping, in B / L³."""
_MIN_DAMPING = 1e-6
"""Least damping, relative to the first."""
_INDEFINITE_DAMPING = 0.05
"""Least damping that is tried where the Hessian is not positive definite, relative to the first."""
SPARSE_FROM = 12
"""Cells of at least this many stitches have a sparse factor."""
_MIN_DAMPING_SINGLE = 1e-3
"""Least damping for a factor in single precision. Scaled to a diagonal of one, the damped matrix
has a condition of some 1e5, which leaves steps of two digits: enough on the way, in half the
time."""
_SINGLE_DOWN_TO = 1e-6
"""Gain of a step, relative to the energy, below which sparse factors are in double precision."""
_TRIALS = 60
_WORTH = 0.2
"""A step with an old factor that gains less than this part of the step before is the last."""
_NO_STEP = 1e-9
_STABLE = 0.02
"""Damping, relative to the first, with which the Hessian of a minimum is positive definite (rigid
motions of the sheet have no stiffness)."""
_STABLE_LARGE = 2e-3
"""Damping of cells with a sparse factor, whose folds are softer."""
_NUDGES = 4
_NUDGE = 0.03
"""First displacement with which a saddle is left, in radii: far above rounding, and small enough to
follow the direction in which it falls."""
_BEYOND_LOWEST = 1.3
"""Damping where the lowest curvature is negative, relative to it."""
_BESIDE_LOWEST = 1.02
"""Damping for the direction of the lowest curvature alone, and not that of the next."""
_INDEFINITE_GROWTH = 3.0
_POWER_STEPS = 2
_SADDLE_STEPS = 40
"""Inverse iterations for the direction of lowest curvature, on the way and at a saddle."""
_PLACES, _TENSIONS, _DIGITS = 2.0**-13, 2.0**-8, 2.0**-8
"""Steps to which a way is rounded: of places, in radii; of tensions, in B / L²; of curvatures,
relative to them."""
_GREATEST = 0.99
"""Components of a direction from this part of the greatest on count as equal to it."""


@dataclass(frozen=True)
class Options:
    """Settings of the minimisation.

    Parameters
    ----------
    pair_cap : longest change of the vector between near samples in one step, in radii.
    relief : factor on the damping after a step that went as predicted.
    chord_steps : most steps with an old factor after each new one.
    tolerance : stop when a Newton step would lower the energy by less than this part of it.
    slack : stop only when the lengths are within this part of a loop length.
    iterations : most Newton steps.
    damping : of the first step, relative to the usual one; little where a minimum is near.
    side : of the first saddle to which it is left, 1 or -1.
    mended : whether steps of a large cell are mended so that the yarn keeps its length; a
        straight step stretches it, and would have to be short. Small cells do without.
    leaves_saddles : whether the search goes on from a saddle; on the way to another shape it need
        not.
    rounded : whether places, tensions and curvatures are rounded after every step, far above the
        last bit, which another processor may have otherwise. A way past saddles, which would
        enlarge that difference to another shape, is then the same everywhere. Not with fixed sizes,
        which need not be such numbers.
    """

    pair_cap: float = 0.3
    relief: float = 6.0
    chord_steps: int = 3
    tolerance: float = 1e-7
    slack: float = 1e-7
    iterations: int = 400
    damping: float = 1.0
    side: float = 1.0
    mended: bool = True
    leaves_saddles: bool = True
    rounded: bool = False


TIGHT = Options(tolerance=1e-10, slack=1e-9)
"""Settings for a final shape: soft sizes are then known to some 1e-6, energies better."""


@dataclass(frozen=True, eq=False)
class Minimum:
    """The result of a minimisation.

    Attributes
    ----------
    state : unknowns.
    tension : (constraints,) tension of each course or stitch, then forces of other constraints, N.
    terms : parts of the energy.
    force : (2,) dE/d(size of a stitch), N, course-wise and wale-wise, for the whole cell.
    min_distance_mm : smallest distance of centre lines.
    converged : whether the tolerance was reached.
    stable : whether it is a minimum among the shapes of its cell, not a saddle.
    saddles : how many saddles were left on the way.
    steps, evaluations : Newton steps taken, energies evaluated.
    """

    state: Array
    tension: Array
    terms: Terms
    force: Array
    min_distance_mm: float
    converged: bool
    stable: bool
    steps: int
    evaluations: int
    saddles: int = 0


@in_one_blas_thread
def minimise(
    energy: CellEnergy,
    state: Array,
    *,
    tension: Array | None = None,
    fixed: tuple[int, ...] = (),
    target: Array | None = None,
    options: Options | None = None,
    cancelled: Cancelled | None = None,
) -> Minimum:
    """Minimise the energy from a state, without yarn passing through yarn.

    Parameters
    ----------
    energy : the energy of the cell.
    state : unknowns to begin with.
    tension : (constraints,) tensions to begin with, N.
    fixed : COURSE and/or WALE: cell sizes that are prescribed.
    target : (2,) sizes of a stitch to move the fixed ones to, mm; by default where they are.
    cancelled : called before every step; True stops with CancelledError.

    Raises
    ------
    ConvergenceError
        If the Hessian is not finite.
    UnravelledError
        If no step can be certified any more.
    CancelledError
        If ``cancelled`` says so.
    """
    opts = options or Options()
    held = np.array(sorted(f % energy.cell.unknowns for f in fixed), int)
    goal = state[held] if target is None else target[held - energy.cell.unknowns + 2]
    descent = _Descent(energy, state, tension, held, goal, opts)
    while not descent.converged and descent.steps < opts.iterations:
        check_cancelled(cancelled)
        if not descent.step():
            break
    return descent.minimum()


class _Descent:
    """State of one minimisation."""

    def __init__(
        self, energy: CellEnergy, state: Array, tension: Array | None,
        held: NDArray[np.int64], goal: Array, options: Options,
    ) -> None:  # fmt: skip
        self.energy = energy
        self.options = options
        place_mm = _PLACES * energy.yarn.radius_mm if options.rounded else 0.0
        self.trajectory = Trajectory(energy, state, options.pair_cap, place_mm)
        self.tension = np.zeros(energy.constraints) if tension is None else tension.copy()
        self.free = np.ones(energy.cell.unknowns, bool)
        self.free[held] = False
        self.held, self.goal = held, goal
        self.first_damping = _DAMPING * energy.unit / energy.mean_loop_mm**2
        self.damping = options.damping * self.first_damping
        self.sparse = energy.cell.stitches >= SPARSE_FROM and not energy.slides
        self.single = self.sparse
        self.dissection = Dissection()
        self.room = Room()
        self.lowest = 0.0
        self.softest: Array | None = None
        self.steps, self.evaluations, self.saddles = 0, 1, 0
        self.converged = self.stable = False

    def step(self) -> bool:
        """One Newton step and the chord steps after it; False where there is none."""
        trajectory, energy = self.trajectory, self.energy
        here = trajectory.here
        slope = trajectory.slope(self.tension, hessian=True, sparse=self.sparse)
        remaining = self.goal - here.state[self.held]
        moving = bool(np.abs(remaining).max(initial=0.0) > 1e-12)
        system = self._system(slope)
        excess = here.terms.excess_mm
        blocked = False
        self.damping = max(self.damping, -_BEYOND_LOWEST * self.lowest)
        for _ in range(_TRIALS):
            self._factorise(system)
            step, change = system.solve(slope, excess, remaining)
            taken = trajectory.certified(step, self._mending(system, slope))
            blocked = taken.fraction < _NO_STEP
            if blocked:
                self._damp(4.0)
                continue
            self.evaluations += 2
            predicted = system.decrease(slope, taken.fraction * step, change, excess)
            before = energy.merit(here.terms, self.tension + change)
            actual = before - energy.merit(taken.to.terms, self.tension + change)
            ratio = actual / predicted if predicted > 0.0 else -1.0
            rounding = abs(predicted) < 1e-11 * abs(before)
            if rounding:
                ratio = 1.0
            if moving or ratio > 1e-3:
                break
            self._damp(4.0)
        else:
            if blocked:
                raise UnravelledError("No step from here keeps the strands apart.")
            return False
        damping = self.damping
        if ratio > 0.5:
            self._damp(1.0 / self.options.relief)
        elif ratio < 0.2 and not moving:
            self._damp(2.0)
        trajectory.advance(taken)
        self.tension = self._rounded(self.tension + change)
        self.steps += 1
        if not moving:
            self._take_chord_steps(system, predicted)
        terms = trajectory.here.terms
        self.single = self.single and predicted > _SINGLE_DOWN_TO * abs(terms.energy)
        # rounding moves the yarn along itself, which lengthens it: further steps bring no gain
        slack = (10.0 if rounding else 1.0) * self.options.slack
        self.converged = bool(
            taken.fraction == 1.0
            and not moving
            and (self.damping <= 0.1 * self.first_damping or self.lowest < 0.0)
            and predicted < self.options.tolerance * abs(terms.energy)
            and np.abs(terms.excess_mm).max() < slack * energy.mean_loop_mm
        )
        if self.converged and self.options.leaves_saddles:
            least = (_STABLE_LARGE if self.sparse else _STABLE) * self.first_damping
            self.stable = damping <= least or system.factorise(least)
            if not self.stable:
                self.converged = not self._leave_saddle(system, slope.lengths, least)
        return True

    def _rounded(self, tension: Array) -> Array:
        """Tensions, rounded where that is wanted."""
        if not self.options.rounded:
            return tension
        return rounded(tension, _TENSIONS * self.energy.unit / self.energy.mean_loop_mm)

    def _system(self, slope: Slope) -> System:
        if slope.sparse is None:
            return DenseSystem(slope, self.energy.penalty, self.free)
        fronts = self.dissection.fronts(slope.sparse.touching)
        precision = np.float32 if self.single else np.float64
        return SparseSystem(slope, self.energy.penalty, self.free, fronts, self.room, precision)

    def _mending(self, system: System, slope: Slope) -> Callable[[Array], Array] | None:
        """How the yarn is brought back to its length where a step ends, if it is."""
        mended = self.sparse and self.options.mended
        return partial(system.mending, slope.lengths) if mended else None

    def _factorise(self, system: System) -> None:
        """Factorise with as much damping as it takes, and learn how negative the lowest
        curvature is: damping just beyond it leaves a saddle fast."""
        indefinite = False
        while not system.factorise(self.damping):
            if not np.isfinite(self.damping):  # then the Hessian is not finite either
                raise ConvergenceError("the Hessian of the yarn's energy is not finite.")
            indefinite = True
            self._damp(_INDEFINITE_GROWTH, _INDEFINITE_DAMPING)
        if indefinite or self.lowest < 0.0:
            self.lowest, self.softest = system.softest(self.softest, _POWER_STEPS)
            if self.options.rounded and self.lowest:
                digit = 2.0 ** np.floor(np.log2(abs(self.lowest)))
                self.lowest = float(rounded(self.lowest, _DIGITS * digit))

    def _leave_saddle(self, system: System, lengths: Array, least: float) -> bool:
        """Descend along the most negative curvature that the constraints allow; False if there is
        none, as then it is a minimum, or if that does not lower the energy."""
        energy, trajectory = self.energy, self.trajectory
        here = trajectory.here
        self.damping = 2.0 * least
        while not system.factorise(self.damping):  # the nearer the shift, the faster the iteration
            self._damp(2.0)
        curvature, direction = system.softest(None, _SADDLE_STEPS, lengths)
        if curvature > -least:
            self.stable = True
            return False
        near = -_BESIDE_LOWEST * curvature
        if near < self.damping and system.factorise(near):  # apart from the next lowest
            _, direction = system.softest(direction, _SADDLE_STEPS, lengths)
        side = self.options.side if self.saddles == 0 else 1.0
        step = np.zeros(len(self.free))
        step[self.free] = side * _NUDGE * energy.yarn.radius_mm * signed(direction)
        before = energy.merit(here.terms, self.tension)
        for _ in range(_NUDGES):
            taken = trajectory.certified(step)
            self.evaluations += 1
            if taken.fraction > _NO_STEP and energy.merit(taken.to.terms, self.tension) < before:
                trajectory.advance(taken)
                self.saddles += 1
                return True
            step = 0.25 * step
        return False

    def _take_chord_steps(self, system: System, gain: float) -> None:
        """Steps with the factor of the last Hessian, as long as they pay off."""
        trajectory, energy = self.trajectory, self.energy
        none = np.zeros(len(self.held))
        for _ in range(self.options.chord_steps):
            here = trajectory.here
            excess = here.terms.excess_mm
            slope = trajectory.slope(self.tension, hessian=False)
            step, change = system.solve(slope, excess, none)
            taken = trajectory.certified(step, self._mending(system, slope))
            self.evaluations += 2
            tension = self.tension + change
            actual = energy.merit(here.terms, tension) - energy.merit(taken.to.terms, tension)
            if taken.fraction < _NO_STEP or actual < 0.2 * system.decrease_solved(
                slope, taken.fraction * step, change, excess, taken.fraction
            ):
                return
            trajectory.advance(taken)
            self.tension = self._rounded(tension)
            if actual < _WORTH * gain:
                return
            gain = actual

    def _damp(self, factor: float, least: float = 0.0) -> None:
        least = max(least, _MIN_DAMPING_SINGLE if self.single else _MIN_DAMPING)
        self.damping = max(factor * self.damping, least * self.first_damping)

    def minimum(self) -> Minimum:
        """The result so far."""
        here = self.trajectory.here
        slope = self.trajectory.slope(self.tension, hessian=False)
        return Minimum(
            state=here.state,
            tension=self.tension,
            terms=here.terms,
            force=slope.gradient[-2:].copy(),
            min_distance_mm=self.trajectory.min_distance_mm,
            converged=self.converged,
            stable=self.stable,
            steps=self.steps,
            evaluations=self.evaluations,
            saddles=self.saddles,
        )


def signed(direction: Array) -> Array:
    """A direction (n,) turned so that the first of its greatest components is positive."""
    sizes = np.abs(direction)
    first = np.argmax(sizes > _GREATEST * sizes.max())
    return np.asarray(direction * np.sign(direction[first]))
