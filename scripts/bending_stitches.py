"""Bend the stored repeats: ``python -m scripts.bending_stitches``.

The linear response of every repeat of the store to bending and shear, and that of the minimum that
its instability leads to if it has one, are written to the library's ``data/bending.json``. Finished
repeats are kept in a folder, so an interrupted run can be resumed.
"""

from __future__ import annotations

from knitcore.chart import StitchChart
from knitcore.yarnlevel.bending import repeat_bending
from knitcore.yarnlevel.cell import mirrored_cell
from knitcore.yarnlevel.relax import Branch
from knitcore.yarnlevel.solver import TIGHT, minimise
from knitcore.yarnlevel.splines import relaxed_repeat
from knitcore.yarnlibrary.bending_table import document_of
from knitcore.yarnlibrary.characterise import Document
from scripts.from_store import FromStore, StoredTask


def bend(task: StoredTask) -> Document:
    """Bending of a repeat (:func:`knitcore.yarnlibrary.bending_table.document_of`).

    A few steps from the stored shape recover the tension of the yarn and the digits that the store
    leaves out.
    """
    energy, state = task.begun(mirrored_cell)
    found = minimise(energy, state, options=TIGHT)
    relaxed = relaxed_repeat(
        StitchChart.parse(task.chart), energy, Branch.MIRRORED, found, seconds=0.0,
        evaluations=found.evaluations,
    )  # fmt: skip
    return document_of(repeat_bending(relaxed))


BENDING = FromStore("bending", "bending.json", bend, "knitcore.yarnlevel.bending")

if __name__ == "__main__":
    BENDING.main()
