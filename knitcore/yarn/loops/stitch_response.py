"""Pulling and bending a repeat of any stitches from its shape at rest."""

from knitcore.base.errors import Cancelled, InputError
from knitcore.chart.fabric import Direction
from knitcore.yarn.loops.relaxed_stitches import RelaxedStitches, StitchHistory
from knitcore.yarn.model.relaxed_cell import Sweep
from knitcore.yarn.study.bending import FabricBending, bending_response
from knitcore.yarn.study.hysteresis import pull
from knitcore.yarn.study.sweep import DEFAULT_POINTS, sweep


def stretch_stitches(
    rest: RelaxedStitches,
    direction: Direction | str,
    max_strain: float,
    *,
    points: int = DEFAULT_POINTS,
    max_stress_n_per_mm: float | None = None,
    cancelled: Cancelled | None = None,
) -> Sweep:
    """Stretch from rest, the other direction free of force, with the friction of the history.

    Parameters
    ----------
    rest : the repeat at rest.
    direction, max_strain, points, max_stress_n_per_mm, cancelled : as for
        :func:`knitcore.yarn.study.sweep.sweep`.

    Raises
    ------
    InputError
        If the cloth folds at rest, or an input is out of range.
    CancelledError
        If ``cancelled`` says so.
    """
    _check_unfolded(rest, "Take it blocked, which lies flatter, or give longer loops.")
    if rest.friction is None:
        return sweep(
            rest.state.cell, direction, max_strain, points=points,
            max_stress_n_per_mm=max_stress_n_per_mm, cancelled=cancelled,
        )  # fmt: skip
    return pull(
        rest.state, direction, max_strain, rest.friction, points=points,
        max_stress_n_per_mm=max_stress_n_per_mm, cancelled=cancelled,
    )  # fmt: skip


def bend_stitches(rest: RelaxedStitches) -> FabricBending:
    """Bending, curl and shear of a repeat at rest without friction.

    Raises
    ------
    InputError
        If friction holds it, or the cloth folds at rest.
    ConvergenceError, UnravelledError
        If it has no equilibrium nearby, or a rigidity is not positive.
    """
    if rest.history is not StitchHistory.AGITATED:
        raise InputError("history", "friction holds this shape.", "Relax it agitated.")
    _check_unfolded(
        rest,
        "Bending is computed without friction, which alone keeps it flat: measure a strip that "
        "hangs over an edge.",
    )
    bent, image = bending_response(rest.state.cell), rest.image
    if image.turned:
        bent = bent.swapped()
    return bent.mirror_image() if image.mirrored != image.turned else bent


def _check_unfolded(rest: RelaxedStitches, remedy: str) -> None:
    if rest.folded:
        raise InputError(
            "chart",
            f"as {rest.history} cloth it folds, so it has no size that strains, stresses or "
            "rigidities could refer to.",
            remedy,
        )
