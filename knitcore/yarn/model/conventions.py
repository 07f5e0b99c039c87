"""Factors of the terms in the yarn's energy: three conventions, by name.

The energy of one stitch is, with ordered pairs of contact points and ``V`` of
:mod:`knitcore.yarn.kernels.potential`,

    bending_factor * B ∮ κ² ds  +  regularisation_factor * C ∮ |∂_ss t|² ds
    +  ordered_pair_factor * Σ_(i,j) V(R_ij) w_i w_j

In the paper's text every factor is halved, in the authors' public code none is. The published
energies and moduli follow from the mixture called ``published`` here (all eight energies of
Supplementary Table 8 within 2 %), so it is the default, and the published core radii belong to it.
"""

from knitcore.base.choice import Choice

REGULARISATION_N_MM4 = 0.002
"""C, N·mm⁴: weight of the rate of change of curvature (authors' configuration files; the paper's
table leaves it out)."""


class Convention(Choice):
    """A reading of the paper's energy."""

    PUBLISHED = "published"
    PAPER = "paper"
    AUTHORS_CODE = "authors-code"

    @property
    def bending_factor(self) -> float:
        """Factor of ``B ∮ κ² ds``."""
        return 1.0 if self is Convention.AUTHORS_CODE else 0.5

    @property
    def regularisation_factor(self) -> float:
        """Factor of ``C ∮ |∂_ss t|² ds`` (with its κ⁴ part)."""
        return 0.5 if self is Convention.PAPER else 1.0

    @property
    def ordered_pair_factor(self) -> float:
        """Factor of the contact sum over ordered pairs, each counted as (i, j) and as (j, i)."""
        return 0.5 if self is Convention.PAPER else 1.0

    @property
    def unordered_pair_factor(self) -> float:
        """Factor of the contact sum over unordered pairs."""
        return 2.0 * self.ordered_pair_factor

    @property
    def source(self) -> str:
        """Where the reading comes from, in one sentence."""
        return _SOURCES[self]


_SOURCES = {
    Convention.PUBLISHED: "Inferred from the paper's Supplementary Table 8, which it reproduces.",
    Convention.PAPER: "The text of the paper's section Simulation method, equation by equation.",
    Convention.AUTHORS_CODE: "The authors' public code (sabetta/stitch-by-stitch) as it stands.",
}
