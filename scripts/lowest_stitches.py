"""Follow the stored repeats without their mirrors: ``python -m scripts.lowest_stitches``.

Every repeat of the store is laid out over its free cell, followed along its instability if it has
one, and what it leads to is written to the library's ``data/lowest.json``. Finished repeats are
kept in a folder, so an interrupted run can be resumed.
"""

from __future__ import annotations

from knitcore.base.errors import ConvergenceError, UnravelledError
from knitcore.yarn.library.characterise import Document
from knitcore.yarn.model.cell import free_cell
from knitcore.yarn.solve.search import SAME_ENERGY
from knitcore.yarn.study.lowest import followed
from scripts.from_store import FromStore, StoredTask


def follow(task: StoredTask) -> Document:
    """Drop the mirrors of a repeat and follow its instability.

    Returns
    -------
    A JSON document: ``failure`` alone where the descent finds no state of the fabric; otherwise
    ``minimum``, whether the mirrored state is one without its mirrors, and size (mm) and energy
    (N·mm) of a stitch of the minimum that it is or leads to.
    """
    energy, state = task.begun(free_cell)
    try:
        minimum, _ = followed(energy, state)
    except (ConvergenceError, UnravelledError) as error:
        return {"failure": str(error)}
    reached = minimum.terms.energy / energy.cell.stitches
    lower = 1.0 - reached / task.energy_n_mm
    return {
        "minimum": bool(minimum.stable and lower < SAME_ENERGY),
        "cell_course_mm": float(f"{minimum.state[-2]:.7g}"),
        "cell_wale_mm": float(f"{minimum.state[-1]:.7g}"),
        "energy_n_mm": float(f"{reached:.7g}"),
        "converged": minimum.converged,
    }


LOWEST = FromStore("lowest", "lowest.json", follow, "knitcore.yarn.study.lowest")

if __name__ == "__main__":
    LOWEST.main()
