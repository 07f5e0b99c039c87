"""Direct factors of any sparse positive definite matrix, in double precision."""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.sparse import csc_matrix

from knitcore.base.arrays import Array


class IndefiniteTangentError(Exception):
    """The matrix is not positive definite; the caller decides what to do."""


def positive_definite_factor(matrix: Any) -> Callable[[Array], Array]:
    """SuperLU of a sparse symmetric matrix, in double precision: a function that solves with it.

    Raises
    ------
    IndefiniteTangentError
        If the matrix is not positive definite.
    """
    from scipy.sparse.linalg import splu  # slow to import

    # pivots stay on the diagonal, so that their signs are those of the eigenvalues
    options = {"SymmetricMode": True}
    try:
        factor = splu(csc_matrix(matrix), "MMD_AT_PLUS_A", 0.0, options=options)
    except RuntimeError as error:  # exactly singular
        raise IndefiniteTangentError from error
    if not np.all(factor.U.diagonal() > 0.0):
        raise IndefiniteTangentError
    return factor.solve
