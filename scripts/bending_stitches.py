"""Bend the stored repeats: ``python -m scripts.bending_stitches``.

The linear response of every repeat of the store to bending and shear, and that of the minimum that
its instability leads to if it has one, are written to the library's ``data/bending.json``. Finished
repeats are kept in a folder, so an interrupted run can be resumed.
"""

from __future__ import annotations

from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.library.bending_table import document_of
from knitcore.yarn.library.characterise import Document
from knitcore.yarn.model.cell import mirrored_cell
from knitcore.yarn.solve.newton import TIGHT, minimise
from knitcore.yarn.solve.splines import relaxed_repeat
from knitcore.yarn.study.bending import repeat_bending
from knitcore.yarn.study.relax import Branch
from scripts.from_store import FromStore, StoredTask


def bend(task: StoredTask) -> Document:
    """Bending of a repeat (:func:`knitcore.yarn.library.bending_table.document_of`).

    A few steps from the stored shape recover the tension of the yarn and the digits that the store
    leaves out.
    """
    energy, state = task.begun(mirrored_cell)
    minimum = minimise(energy, state, options=TIGHT)
    relaxed = relaxed_repeat(
        StitchChart.parse(task.chart), energy, Branch.MIRRORED, minimum, seconds=0.0,
        evaluations=minimum.evaluations,
    )  # fmt: skip
    return document_of(repeat_bending(relaxed))


BENDING = FromStore("bending", "bending.json", bend, "knitcore.yarn.study.bending")

if __name__ == "__main__":
    BENDING.main()
