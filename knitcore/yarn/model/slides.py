"""Slide quenching on splines: yarn that may not slide where it touches.

The paper keeps the length of yarn between the middles of neighbouring crossovers as it is at rest.
On a spline the middle of a crossover is where the strands of two courses are nearest to each other.
It stays at the same points of the yarn if these points stay the nearest, that is if the vector d
between them keeps its components along both strands,

    c = d · γ'_i / L,   and the same with γ'_j.

Both are bilinear in the unknowns. This is weaker than the paper's rule, whose crossovers cannot
change their shape.
"""

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array
from knitcore.linear.dense import dot, product, times
from knitcore.yarn.kernels.curve_samples import control_of
from knitcore.yarn.kernels.structures import Pairs
from knitcore.yarn.model.cell import YarnCell
from knitcore.yarn.model.constraints import beyond


@dataclass(frozen=True, eq=False)
class SlideConstraint:
    """A rule that keeps two touching points of yarn from sliding along one of the strands.

    It holds the component, along that strand, of the vector from one point to the other.

    Attributes
    ----------
    apart : (3, unknowns), the vector between the points as a function of the unknowns.
    along : (3, unknowns), the direction of the strand, in loop lengths.
    rest_mm : the component in the state where the rule was made.
    """

    apart: Array
    along: Array
    rest_mm: float

    def value(self, state: Array) -> float:
        """Component in a state less ``rest_mm``, mm; 0 where the rule is kept."""
        return dot(times(self.apart, state), times(self.along, state)) - self.rest_mm

    def gradient(self, state: Array) -> Array:
        """Derivative of the component by the unknowns, mm per unknown."""
        apart, along = times(self.apart, state), times(self.along, state)
        return times(self.apart.T, along) + times(self.along.T, apart)

    def hessian(self) -> Array:
        """Second derivative of the component by the unknowns, which is the same in every state."""
        half = product(self.apart.T, self.along)
        return half + half.T


def slides_at(
    cell: YarnCell, state: Array, pairs: Pairs, distances: Array, touch_mm: float, loop_mm: float
) -> tuple[SlideConstraint, ...]:
    """Slides at the crossovers of a state, two to a stitch.

    Parameters
    ----------
    pairs, distances : pairs of near samples (see neighbours) and their distances, mm.
    touch_mm : crossovers are nearer than this.
    loop_mm : loop length.
    """
    near = {tuple(pair[:4]): d for pair, d in zip(pairs.tolist(), distances, strict=True)}
    slides: list[SlideConstraint] = []
    base = np.zeros((0, cell.unknowns))
    crossovers = 0
    for pair, distance in sorted(zip(pairs.tolist(), distances, strict=True), key=lambda p: p[1]):
        if distance >= touch_mm or crossovers == 2 * cell.stitches:
            break
        if not _is_crossover(cell, pair) or not _is_nearest(pair, distance, near, len(cell.place)):
            continue
        crossovers += 1
        apart, first, second = _operators(cell, pair)
        for along in (first / loop_mm, second / loop_mm):
            slide = SlideConstraint(apart, along, 0.0)
            slide = SlideConstraint(apart, along, slide.value(state))
            left = beyond(base, slide.gradient(state))
            if left is not None:  # symmetry makes some contacts images of others
                base = np.concatenate([base, left[None]])
                slides.append(slide)
    return tuple(slides)


def _is_crossover(cell: YarnCell, pair: list[int]) -> bool:
    """Tell whether two samples belong to courses next to each other."""
    i, j, _, up = pair[:4]
    samples = len(cell.place)
    return abs(j // samples + up * cell.rows - i // samples) == 1


def _is_nearest(
    pair: list[int], distance: float, near: dict[tuple[int, ...], float], samples: int
) -> bool:
    """Tell whether no neighbouring pair of samples is nearer; the ends of a course are left out."""
    i, j, across, up = pair[:4]
    if min(i % samples, j % samples) == 0 or max(i % samples, j % samples) == samples - 1:
        return False
    around = ((i + a, j + b, across, up) for a in (-1, 0, 1) for b in (-1, 0, 1) if a or b)
    return all(near.get(key, np.inf) >= distance for key in around)


def _operators(cell: YarnCell, pair: list[int]) -> tuple[Array, Array, Array]:
    """Vector between two samples and the two tangents as functions of the unknowns."""
    i, j, across, up, flip = pair
    samples = len(cell.place)
    turned = np.array([1.0, 1.0, float(flip)])[:, None]
    point_i, speed_i = _sample(cell, i)
    point_j, speed_j = _sample(cell, j)
    apart = turned * point_j - point_i
    apart[0, -2] += cell.place[j % samples] + across * cell.wales - cell.place[i % samples]
    apart[1, -1] += j // samples + up * cell.rows - i // samples
    return apart, speed_i, turned * speed_j


def _sample(cell: YarnCell, i: int) -> tuple[Array, Array]:
    """Position (without drift) and d/dt of a sample as functions of the unknowns."""
    grid = cell.grid
    course, s = divmod(i, len(cell.place))
    span, offset = divmod(s, grid.per_span)
    out = np.zeros((2, 3, cell.unknowns))
    for a in range(6):
        c, z_sign = control_of(span, a, cell.controls_per_course, cell.mirror[0])
        for m in range(3):
            sign = cell.sign[course, c, m] * (z_sign if m == 2 else 1.0)
            out[:, m, cell.dof[course, c, m]] += sign * grid.basis[:2, offset, a]
    out[1, 0, -2] += 1.0
    return out[0], out[1]
