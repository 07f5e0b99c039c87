"""The energy of a repeat of any stitches: yarn by acts, and pulls on the cloth."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_range
from knitcore.chart.stitch_graph import StitchGraph
from knitcore.materials.yarn_per_stitch import YARN_OF_FLOAT, YARN_OF_TUCK, yarn_of_acts
from knitcore.yarn.kernels.structures import Ints, Pairs
from knitcore.yarn.model.energy import CellEnergy, Slope, Terms


@dataclass(frozen=True)
class YarnPerAct:
    """Yarn that a site takes, as a part of a knit's.

    The value of yarn overs follows from the weights of lace swatches; the others are guesses.

    Parameters
    ----------
    yarn_over, tuck : of a loop that is laid over the needle.
    slip : of the float that passes a slipped stitch.
    crossing : of a loop that changes places with others in a cable: one of the row below it.
    """

    yarn_over: float = 1.0
    tuck: float = YARN_OF_TUCK
    slip: float = YARN_OF_FLOAT
    crossing: float = 1.0

    def __post_init__(self) -> None:
        for field in fields(self):
            check_range(field.name, getattr(self, field.name), 0.1, 5)

    def of_rows(self, graph: StitchGraph) -> Array:
        """(rows,) mean over the sites of each row."""
        return np.asarray(yarn_of_acts(graph, **vars(self)).mean(axis=1))


@dataclass(frozen=True, eq=False)
class StitchEnergy(CellEnergy):
    """The energy of a repeat of any stitches.

    Parameters
    ----------
    pull_n : force along the course and along the wale that stretches a stitch of the cell, N times
        the number of stitches.
    """

    pull_n: tuple[float, float] = (0.0, 0.0)

    @property
    def stitch_of_yarn_mm(self) -> float:
        """The mean loop length of the course that has the least: rows of floats are short."""
        return float(self.loop_length_mm.min())

    def value(self, state: Array, curve: Array, pairs: Pairs) -> Terms:
        """Parts of the energy; the work of the pulls counts with the spacing."""
        terms = super().value(state, curve, pairs)
        work = self.pull_n[0] * state[-2] + self.pull_n[1] * state[-1]
        return replace(terms, spacing=terms.spacing - float(work))

    def derivatives(
        self, state: Array, curve: Array, pairs: Pairs, start: Ints, tension: Array,
        *, hessian: bool = True, sparse: bool = False, lengths: bool = True,
    ) -> Slope:  # fmt: skip
        """Gradient and Hessian of the Lagrangian, with the pulls."""
        slope = super().derivatives(
            state, curve, pairs, start, tension, hessian=hessian, sparse=sparse, lengths=lengths
        )
        slope.gradient[-2:] -= self.pull_n
        return slope


@dataclass(frozen=True, eq=False)
class SpreadEnergy(StitchEnergy):
    """The energy of a cloth that is held spread.

    Parameters
    ----------
    spread_n_per_mm : even pull both ways, per mm of the cloth as it then is. Its work is the pull
        times the area.
    """

    spread_n_per_mm: float = 0.0

    @property
    def _per_stitch_n_per_mm(self) -> float:
        return self.spread_n_per_mm * self.cell.stitches

    def value(self, state: Array, curve: Array, pairs: Pairs) -> Terms:
        """Parts of the energy; the work of the pulls counts with the spacing."""
        terms = super().value(state, curve, pairs)
        work = self._per_stitch_n_per_mm * float(state[-2] * state[-1])
        return replace(terms, spacing=terms.spacing - work)

    def derivatives(
        self, state: Array, curve: Array, pairs: Pairs, start: Ints, tension: Array,
        *, hessian: bool = True, sparse: bool = False, lengths: bool = True,
    ) -> Slope:  # fmt: skip
        """Gradient and Hessian of the Lagrangian, with the pulls."""
        slope = super().derivatives(
            state, curve, pairs, start, tension, hessian=hessian, sparse=sparse, lengths=lengths
        )
        pull = self._per_stitch_n_per_mm
        slope.gradient[-2:] -= pull * state[[-1, -2]]
        if slope.hessian is not None:
            slope.hessian[[-2, -1], [-1, -2]] -= pull
        if slope.sparse is not None:
            slope.sparse.sizes[[0, 1], [-1, -2]] -= pull
        return slope
