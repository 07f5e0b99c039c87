"""Arguments of the kernels: arrays and numbers under their names."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array

Ints = NDArray[np.int64]
Pairs = NDArray[np.int32]
"""(n, 5): sample i, sample j, image across, image up, sign of z of that image; each pair once."""


class Layout(NamedTuple):
    """The map from the unknowns of a cell to its curves.

    Unknowns are the control points (through an index map that ties symmetric ones together and
    carries their signs) and the size of a stitch, course-wise and wale-wise (the last two).

    Attributes
    ----------
    rows, wales : stitches of the cell.
    mirror : -1 if z changes its sign from one cell to the next along the course, else 1.
    place : (samples,) t of the samples of a course, in stitches.
    basis : (4, per_span, 6) weights of the six control points around a sample, by derivative.
    dof : (rows, controls, 3) unknown behind each control coordinate.
    sign : (rows, controls, 3) its sign there; 0 where symmetry makes the coordinate zero.
    unknowns : their number.
    """

    rows: int
    wales: int
    mirror: int
    place: Array
    basis: Array
    dof: Ints
    sign: Array
    unknowns: int


class ContactLaw(NamedTuple):
    """Energy of a pair of samples: weight * V(R) |d1_i| |d1_j|.

    Attributes
    ----------
    weight : factor of an unordered pair times the squared step of the parameter.
    stiffness, exponent, radius, core : k (N/mm³), p, r and r_core (mm) of the potential V.
    """

    weight: float
    stiffness: float
    exponent: float
    radius: float
    core: float


class RodLaw(NamedTuple):
    """Terms of the energy that depend on one sample only.

    Attributes
    ----------
    bend : factor of ∫κ² ds, N·mm².
    regular : factor of ∫|∂_ss t|² ds, N·mm⁴.
    spacing : stiffness that keeps the samples evenly spread, N·mm.
    step : of the parameter from sample to sample.
    """

    bend: float
    regular: float
    spacing: float
    step: float
