"""Compile a share of a study's kernels beside the process that needs them.

numba compiles on one core only. The share is what the study needs late; it imports what it needs
and no more, to be done in time.
"""

import sys

import numpy as np


def _factors_of_yarn() -> None:
    from knitcore import StitchChart, material
    from knitcore.linear.dense import eliminate, product, solved, substitute, times
    from knitcore.yarn.kernels.scatter import scatter_local
    from knitcore.yarn.kernels.tiles import one_tile
    from knitcore.yarn.library.yarns import yarn_for
    from knitcore.yarn.model.cell import plain_cell
    from knitcore.yarn.model.conventions import Convention
    from knitcore.yarn.model.energy import CellEnergy
    from knitcore.yarn.solve.clasps import knitted_code
    from knitcore.yarn.solve.splines import COARSE

    chart = StitchChart.parse("K/P")
    used = yarn_for(material("acrylic"), chart)
    cell = plain_cell(chart, COARSE)
    lengths = np.full(cell.rows, used.loop_length_mm)
    energy = CellEnergy(cell, used.yarn, lengths, Convention.PUBLISHED)
    curve = np.ones((cell.rows * len(cell.layout.place), 4, 3))
    still, tension = np.zeros(len(curve)), np.zeros(len(lengths))
    energy.gathered(np.zeros((len(curve), 3)), np.zeros((len(curve), 3, 3)))
    matrix, sizes = one_tile(cell.unknowns), np.zeros((2, cell.unknowns))
    local, nothing = np.zeros((len(curve), 9, 9)), np.zeros((len(curve), 3, 3))
    scatter_local(local, nothing, nothing, cell.layout, matrix.tiles, matrix.where, sizes)
    factor = np.eye(2)
    eliminate(factor)
    substitute(factor, np.eye(2))
    solved(np.eye(2), np.ones(2))
    product(factor, factor)
    times(factor, np.ones(2))
    knitted_code(chart)
    energy.along_yarn(curve, tension, still)


def _contact_of_yarn() -> None:
    from knitcore.yarn.kernels.contact import contact_hessian
    from knitcore.yarn.kernels.structures import ContactLaw, Layout

    basis, sign = np.zeros((4, 1, 6)), np.zeros((0, 1, 3))
    layout = Layout(0, 0, 1, np.zeros(1), basis, sign.astype(np.int64), sign, 2)
    contact_hessian(
        np.zeros((0, 4, 3)), 1.0, 1.0, np.zeros((0, 5), np.int32), np.zeros(1, np.int64), layout,
        ContactLaw(1.0, 1.0, 2.0, 1.0, 0.0), np.zeros((0, 1, 1)), np.zeros((0, 0), np.int32),
    )  # fmt: skip


def _factors_of_sheets() -> None:
    import scipy

    from knitcore.linear.sheet_factor import SheetFactor

    SheetFactor(scipy.sparse.bsr_matrix(np.eye(12), blocksize=(3, 3)), columns=2).solve(np.ones(12))


def _hinges_of_sheets() -> None:
    from knitcore.cloth.space.tangent import _hinges

    nodes, places = np.zeros((0, 6), np.int64), np.zeros((0, 6, 6), np.int64)
    _hinges(np.zeros((0, 3)), nodes, np.zeros((0, 4)), places, True, np.zeros((0, 3, 3)))


SHARES = {
    "knitcore.yarn": (_factors_of_yarn, _contact_of_yarn),
    "knitcore.cloth.space": (_factors_of_sheets, _hinges_of_sheets),
}
"""By the room in which a study begins."""

if __name__ == "__main__":
    module, number = sys.argv[1:]
    for room, shares in SHARES.items():
        if module.startswith(room):
            shares[int(number)]()
