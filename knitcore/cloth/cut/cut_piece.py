"""Loading a piece of cloth cut along any outline."""

import time
from collections.abc import Sequence

import numpy as np

from knitcore.base.bounds import check_range
from knitcore.base.errors import Cancelled, Progress
from knitcore.cloth.cut.assembly import PieceEnergy
from knitcore.cloth.cut.conditions import Condition, Constraints
from knitcore.cloth.cut.cut_cloth import Cloth
from knitcore.cloth.cut.cut_mesh import mesh_of
from knitcore.cloth.cut.cut_results import PieceTest
from knitcore.cloth.cut.equilibrium import Balance
from knitcore.cloth.cut.outline import CutPiece
from knitcore.cloth.flat.equilibrium_path import as_far_as_it_converges

MAX_STEPS = 1000


def solve(
    piece: CutPiece,
    cloth: Cloth,
    conditions: Sequence[Condition],
    *,
    steps: int = 10,
    mesh_mm: float | None = None,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> PieceTest:
    """Load a piece in equal steps.

    Parameters
    ----------
    piece : the outline.
    cloth : under it, of :func:`knitcore.cloth.cut.cut_cloth.cloth_under`.
    conditions : on the edges.
    steps : of the load.
    mesh_mm : length of an element's side, about.
    progress : called with (steps done, steps in all).
    cancelled : called from time to time; True stops the test.

    Returns
    -------
    PieceTest
        With ``converged`` False and ``problem`` set if it stopped short; the steps before that are
        valid.

    Raises
    ------
    InputError
        If the mesh cannot be made, or the conditions contradict each other or hold too little.
    CancelledError
        If ``cancelled`` returned True.

    Examples
    --------
    >>> from knitcore import StitchChart
    >>> from knitcore.materials import material
    >>> from knitcore.cloth.cut import CutPiece, Held, cloth_under
    >>> strip = CutPiece.rectangle(40.0, 100.0, grain_deg=45.0)
    >>> cloth = cloth_under(strip, StitchChart.parse("K"), material("acrylic"))
    >>> test = solve(strip, cloth, [Held("bottom"), Held("top", y_mm=10.0)], steps=2, mesh_mm=10.0)
    >>> test.converged, bool(test.force_n[-1, 1, 1] > 0)
    (True, True)
    """
    check_range("steps", steps, 1, MAX_STEPS)
    begin = time.perf_counter()
    energy = PieceEnergy(mesh_of(piece, mesh_mm), cloth, piece.turn)
    constraints = Constraints(energy.basis, piece, conditions)
    path = Balance(energy, constraints, cancelled).follow(np.arange(1, steps + 1) / steps)
    equilibria, problem = as_far_as_it_converges(path, steps, progress)
    return PieceTest(piece, energy, constraints, equilibria, problem, time.perf_counter() - begin)
