"""Claims on outside data, and the one protocol by which they are made.

Whatever was chosen on data (form, features, limits, a number) is chosen again in an inner loop,
and the claim is made by an outer loop that never saw the choice: samples of one group, such as one
texture, are left out together. The null model and the simplest model are candidates like others and
are judged on the same samples. :func:`nested` does this; a figure that it did not make is labelled
*in sample*, unless nothing was chosen on the data.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array


class Basis(StrEnum):
    """How the figure of a claim relates to the choices that were made."""

    NESTED = "left out, choice and all"
    LEFT_OUT = "left out; form chosen on all"
    IN_SAMPLE = "in sample"
    NOTHING_CHOSEN = "nothing chosen on it"


@dataclass(frozen=True, eq=False)
class Nested:
    """Errors of an outer loop.

    Attributes
    ----------
    missed : (samples, ...) error of each sample by the candidate that the others chose.
    chosen : for each group, in order of their names, the index of that candidate.
    """

    missed: Array
    chosen: tuple[int, ...]


def nested(missed: ArrayLike, groups: Sequence[str]) -> Nested:
    """Leave out each group in turn, and judge it by the candidate that is best on the others.

    Parameters
    ----------
    missed : (candidates, samples, ...) errors, logarithms for sizes and forces. A candidate that is
        fitted must be fitted without the group of the sample.
    groups : of each sample; those of one group are left out together.

    Raises
    ------
    ValueError
        If there are fewer than two groups.
    """
    errors = np.asarray(missed, dtype=float)
    names = np.array(groups)
    if len(set(groups)) < 2:
        raise ValueError("groups: give at least two, so that one can be left out")
    squares = (errors**2).reshape(*errors.shape[:2], -1).sum(axis=2)
    left_out, chosen = np.empty_like(errors[0]), []
    for group in sorted(set(groups)):
        out = names == group
        best = int(squares[:, ~out].sum(axis=1).argmin())
        left_out[out] = errors[best, out]
        chosen.append(best)
    return Nested(left_out, tuple(chosen))


@dataclass(frozen=True)
class Claim:
    """One row of the table of verdicts.

    Attributes
    ----------
    what, data : what is claimed, and on which data.
    basis : see :class:`Basis`.
    figure : the error, in words that can stand alone.
    null : the same for the null and the simplest model on the same data; "" if there is none.
    cover : share inside the intervals; "" if there are none.
    verdict : three words at most.
    """

    what: str
    data: str
    basis: Basis
    figure: str
    null: str
    cover: str
    verdict: str

    def __post_init__(self) -> None:
        if len(self.verdict.split()) > 3:
            raise ValueError(f"verdict: three words at most, not {self.verdict!r}")

    @property
    def cells(self) -> tuple[str, ...]:
        """Cells of the row, dashes where there is nothing to say."""
        row = (self.what, self.data, self.basis, self.figure, self.null, self.cover, self.verdict)
        return tuple(cell or "–" for cell in row)
