"""Laws for the quarter cells of a piece, such that the piece as a whole agrees with its prediction.

The quarter grid with the pure fabrics' own laws and sizes is the flat composite, without folds. So
each patch of a mixed chart (:mod:`knitcore.prediction.patches`) gets laws of its own. At every
stress a phase's strain over the patch's lies between 1 and what it is in the flat composite,

    strain_p = prediction (1 + c (strain_p of the pure fabric / strain of the flat composite - 1)),

and laws are fitted to that, all strains scaled at each stress so that the phases add up to the
prediction, in series or side by side. The quarters that stretch most in the flat composite still
do. In fine textures c is a half: neighbours restrain each other (and neighbouring cells that
differed as much as the pure fabrics would be crushed). With the share of wide areas of one phase it
rises to 1. Like the predictions, these parts pass gradually from those of the whole chart to those
of its patches. From patch to patch the laws change gradually
(:func:`knitcore.prediction.patches.shares_of_patches`): cloth of one texture has no step.
Stitch sizes are those of their surroundings (:mod:`knitcore.prediction.neighbourhood`), scaled
to the prediction's relaxed size. Poisson's ratios are the prediction's, or less where one
energy for both directions requires it. A piece of one pure fabric keeps its own law.

Finite elements larger than a stitch take even laws instead: one for all quarters of a place, with
the strains of its patches.

The flat composite is taken as lines of cells along the pull: in a line the phases are in series at
one force, and all lines are strained alike.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from itertools import pairwise

import numpy as np
import scipy

from knitcore.base.arrays import Array, Codes, Indices
from knitcore.chart.fabric import PHASES, Direction
from knitcore.chart.phases import pure_fabric, quarter_phases
from knitcore.chart.stitch_chart import StitchChart
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.stiffening import stiffening
from knitcore.materials import FabricRecord, Material
from knitcore.materials.law_uncertainty import Z_SCORE
from knitcore.prediction.mixture import law_strains
from knitcore.prediction.neighbourhood import sizes_and_folds
from knitcore.prediction.patches import MAX_SIDE, Patches, shares_of_patches
from knitcore.prediction.predict import patches_of
from knitcore.prediction.prediction import Prediction
from knitcore.prediction.size import RelaxedSize

STRESSES: Array = np.geomspace(0.003, 0.5, 24)
"""Stresses (N/mm) at which laws are fitted."""
SPREAD_AT: Array = np.array([0.005, 0.02, 0.05, 0.1, 0.2, 0.4])
"""Stresses (N/mm) at which the model's own error is kept."""
_FINE: Array = np.concatenate([[0.0], np.geomspace(1e-4, 8.0, 200)])
_COMMON: Array = np.linspace(0.0, 1.0, 400) ** 2
"""Parts of the largest strain at which stresses of lines are added up."""
_TO_LOCK_UP: Array = np.append(0.0, np.geomspace(1e-4, 1.0, 400))
"""Shares of the lock-up strain at which stresses of a law are computed."""
_LOCKED: Array = np.concatenate([np.linspace(0.3, 0.9, 25), np.linspace(0.905, 0.995, 19)])
"""Shares of the lock-up strain that the largest of the strains may be."""
ROUNDS = 4
"""Times that strains of phases are scaled so that they add up."""
HELD = 0.75
"""Weight of lines that hold each other, in the logarithm of the strain: with it, sliding strips of
charts that repeat over two rows agree with their laws."""
_WIDE = 9
"""Quarter cells a side of an area of one phase that counts as wide: two stitches around one."""
_MAX_POISSON = 0.9
"""Limit of the product of both Poisson ratios, so that the law is stable."""


@dataclass(frozen=True, eq=False)
class QuarterLaws:
    """Laws and sizes of a chart's quarter cells.

    Attributes
    ----------
    laws : four for each patch, in the order of the phase codes; a phase that is not in the chart
        has the law of another one.
    place : (rows, columns) number of each stitch's place among the patches.
    mixing : (4 * places, laws) shares of the laws in those of each place, four for each as above.
    scale : (rows, columns, 2) width and height of the stitches over those of their phases.
    log_sd : gives the standard deviation of the logarithm of stress course-wise and wale-wise,
        (2, stresses) at :data:`SPREAD_AT`: the model's own error, not that of the pure fabrics'
        laws.
    """

    laws: tuple[ConstitutiveLaw, ...]
    place: Indices
    mixing: scipy.sparse.csr_array
    scale: Array
    log_sd: Callable[[], Array]


def quarter_laws(
    chart: StitchChart,
    material: Material,
    size: RelaxedSize | None = None,
    *,
    even: bool = False,
    most: int = MAX_SIDE,
) -> QuarterLaws:
    """Compute the laws and sizes of the quarter cells of a piece.

    Parameters
    ----------
    chart : the piece.
    material : a yarn at one setting.
    size : relaxed size of the chart's mean stitch, if known.
    even : give all quarters of a mixed patch one law, that of the patch.
    most : patches along each side, at most.

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.
    """
    pure = pure_fabric(chart) is not None
    if pure and size is None:
        return flat_laws(chart, material)
    patches = patches_of(chart, material, size, most=most)
    phases = quarter_phases(chart)
    scale = _scale(chart, phases, patches, material)
    if pure:
        return replace(flat_laws(chart, material), scale=scale)
    records = _records(phases, material)
    whole = _Lines.of(phases, records)
    whole_parts = _parts(phases, whole, records)
    laws: list[ConstitutiveLaw] = []
    for cells, prediction in _each(patches, phases):
        lines = _Lines.of(cells, records)
        parts = patches.alike * whole_parts + (1 - patches.alike) * _parts(cells, lines, records)
        cloths = [(patches.alike, whole), (1 - patches.alike, lines)]
        laws += _fitted_laws(cells, prediction, records, None if even else (parts, cloths))
    own_error = partial(_stress_log_sd, phases, patches, records)
    return QuarterLaws(tuple(laws), *_mixing(patches, chart), scale, own_error)


def _mixing(patches: Patches, chart: StitchChart) -> tuple[Indices, scipy.sparse.csr_array]:
    """Place of each stitch, and the shares of the patches' laws there."""
    (along_rows, row), (along_columns, column) = (
        np.unique(shares_of_patches(cuts, count), axis=0, return_inverse=True)
        for cuts, count in zip((patches.rows, patches.columns), chart.purl.shape, strict=True)
    )
    shares = scipy.sparse.kron(along_rows, along_columns)
    mixing = scipy.sparse.kron(shares, np.eye(len(PHASES)))
    place = row[:, None] * len(along_columns) + column
    return place.astype(np.intp), scipy.sparse.csr_array(mixing)


def _each(patches: Patches, phases: Codes) -> Iterator[tuple[Codes, Prediction]]:
    """Quarter cells and prediction of each patch."""
    for (below, above), line in zip(pairwise(patches.rows), patches.predictions, strict=True):
        for (left, right), prediction in zip(pairwise(patches.columns), line, strict=True):
            cells = phases[2 * below : 2 * above, 2 * left : 2 * right]
            yield cells, prediction


def _stress_log_sd(phases: Codes, patches: Patches, records: list[FabricRecord]) -> Array:
    """The mean of the patches."""
    spread, all_cells = np.zeros((2, len(SPREAD_AT))), 4 * patches.rows[-1] * patches.columns[-1]
    for cells, prediction in _each(patches, phases):
        for direction in Direction:
            own = _own_log_sd(cells, prediction, records, direction)
            spread[direction.axis] += own * (cells.size / all_cells)
    return spread


def _scale(chart: StitchChart, phases: Codes, patches: Patches, material: Material) -> Array:
    """Folded sizes of the stitches over those of their phases, with the predicted mean.

    Each stitch folds by its surroundings, so that a hem is narrower than the cloth above it.
    """
    _, folds = sizes_and_folds(chart, material)
    records = _records(phases, material)
    for direction in Direction:
        flat = np.array([record.stitch_size_mm(direction) for record in records])[phases]
        flat = flat.reshape(chart.rows, 2, chart.columns, 2).mean(axis=(1, 3))
        mean = float((flat * folds[..., direction.axis]).mean())
        folds[..., direction.axis] *= patches.relaxed_mm(direction) / mean
    return folds


def flat_laws(chart: StitchChart, material: Material) -> QuarterLaws:
    """The pure fabrics' own laws and sizes: the flat composite, without folds.

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.
    """
    laws = tuple(record.law for record in _records(quarter_phases(chart), material))
    shape = chart.purl.shape
    own = scipy.sparse.eye_array(len(laws), format="csr")
    none = partial(np.zeros, (2, len(SPREAD_AT)))
    return QuarterLaws(laws, np.zeros(shape, dtype=np.intp), own, np.ones((*shape, 2)), none)


def _records(cells: Codes, material: Material) -> list[FabricRecord]:
    """Records of the four phases; one that does not occur is replaced by one that does."""
    present = np.unique(cells)
    return [material.record(PHASES[k if k in present else present[0]]) for k in range(4)]


def _shares(cells: Codes) -> Array:
    return np.bincount(cells.ravel(), minlength=4) / cells.size


def _own_log_sd(
    cells: Codes, prediction: Prediction, records: list[FabricRecord], direction: Direction
) -> Array:
    """Part of the predicted stress interval that does not come from the laws' own uncertainty."""
    along = prediction.along(direction)
    low, high = along.stress_interval(along.strain(SPREAD_AT))
    whole = np.log(high / low) / (2 * Z_SCORE)
    laws = [r.uncertainty.log_stress(direction, SPREAD_AT) for r in records]
    return np.sqrt(np.maximum(whole**2 - _shares(cells) ** 2 @ np.square(laws), 0.0))


def _fitted_laws(
    cells: Codes,
    prediction: Prediction,
    records: list[FabricRecord],
    phases: tuple[Array, list[tuple[float, _Lines]]] | None,
) -> list[ConstitutiveLaw]:
    """Laws of the phases that give a patch its predicted response.

    All phases get the same law, or have these parts in the strains of these cloths, which are
    between the whole chart and the patch.

    A phase keeps its couplings kappa as far as it is as stiff as in its pure fabric: cloth that
    unfolds first has little strain in its yarn. So a patch that is all but pure has nearly the
    laws of its pure fabric.
    """
    shear = np.array([r.law.shear_modulus for r in records])
    growth = np.array([r.law.shear_stiffening for r in records])
    constants = np.zeros((2, len(records), 3))  # Young's modulus, alpha, beta
    for direction in Direction:
        strains = prediction.along(direction).strain(STRESSES)
        if phases is None:
            constants[direction.axis] = _fitted(strains[None])
            continue
        parts, cloths = phases
        constants[direction.axis] = _fitted(
            _added_up(cloths, direction, strains, parts[direction.axis])
        )
    alone = np.array([[_fitted_alone(r.law, d) for r in records] for d in Direction])
    own = np.array(
        [[(r.law.modulus(d), r.law.alpha(d), r.law.beta(d)) for r in records] for d in Direction]
    )
    kept = np.minimum((constants / alone)[..., 0].min(axis=0), 1.0)[:, None]
    kappa = kept * [(r.law.kappa_xx, r.law.kappa_yy) for r in records]
    regained = kept * np.log(np.divide(own, alone, out=np.ones_like(own), where=alone * own > 0))
    if phases is None:
        shares = _shares(cells)
        shear[:], growth[:] = np.exp(shares @ np.log(shear)), shares @ growth
        kappa[:], regained[:] = shares @ kappa, (shares @ regained)[:, None]
    constants *= np.exp(regained)
    most_yx, most_xy = (max(prediction.along(d).poisson, 0.0) for d in Direction)
    laws = []
    for (modulus_x, alpha_x, beta_x), (modulus_y, alpha_y, beta_y), coupled, modulus, grown in zip(
        *(values.tolist() for values in (*constants, kappa, shear, growth)), strict=True
    ):
        # One coupling for both, as an energy needs; neither contraction exceeds the predicted one.
        nu_xy = min(most_xy, most_yx * modulus_y / modulus_x)
        nu_yx = nu_xy * modulus_x / modulus_y
        held = 1 - min(nu_yx * nu_xy, _MAX_POISSON)
        laws.append(
            ConstitutiveLaw(
                stiffness_xxxx=modulus_x / held,
                stiffness_yyyy=modulus_y / held,
                stiffness_xxyy=nu_xy * modulus_x / held,
                stiffness_yyxx=nu_yx * modulus_y / held,
                alpha_xx=alpha_x,
                alpha_yy=alpha_y,
                beta_xx=beta_x,
                beta_yy=beta_y,
                shear_modulus=modulus,
                kappa_xx=coupled[0],
                kappa_yy=coupled[1],
                shear_stiffening=grown,
            )
        )
    return laws


@lru_cache(maxsize=64)
def _fitted_alone(law: ConstitutiveLaw, direction: Direction) -> Array:
    """The constants that a law has by :func:`_fitted`, which knows no kappa."""
    return np.asarray(_fitted(_own_strains(law, direction)[0][None])[0])


@lru_cache(maxsize=64)
def _own_strains(law: ConstitutiveLaw, direction: Direction) -> tuple[Array, Array]:
    """Strains of a law at :data:`STRESSES` and at :data:`_FINE`."""
    return law_strains(law, direction, STRESSES), law_strains(law, direction, _FINE)


@dataclass(frozen=True, eq=False)
class _Lines:
    """Kinds of lines of cells, course-wise and wale-wise.

    Attributes
    ----------
    lengths : for each direction, how much of each phase there is along them, (kinds, phases), mm.
    widths : for each direction, how wide all lines of each kind are together, (kinds,), mm.
    """

    lengths: tuple[Array, Array]
    widths: tuple[Array, Array]

    @classmethod
    def of(cls, cells: Codes, records: list[FabricRecord]) -> _Lines:
        """The lines of a patch."""
        size = [np.array([r.stitch_size_mm(d) for r in records]) for d in Direction]
        lengths, widths = [], []
        for along, lines in zip(Direction, (cells, cells.T), strict=True):
            counts = np.stack([(lines == phase).sum(axis=1) for phase in range(4)], axis=1)
            kinds, same = np.unique(counts, axis=0, return_inverse=True)
            lengths.append(kinds * size[along.axis])
            widths.append(np.bincount(same.ravel()) * (kinds @ size[along.other.axis]))
        return cls((lengths[0], lengths[1]), (widths[0], widths[1]))

    def free_strain(self, along: Direction, strains: Array) -> Array:
        """Strain at :data:`STRESSES` of lines along the pull that do not hold each other.

        The phases have the ``strains`` (phases, stresses) at :data:`_FINE`. In a line all carry the
        same force, and all lines are strained alike.
        """
        lengths, widths = self.lengths[along.axis], self.widths[along.axis]
        of_line = lengths @ strains / lengths.sum(axis=1, keepdims=True)
        common = _COMMON * of_line[:, -1].min()
        stress = widths @ np.array([np.interp(common, line, _FINE) for line in of_line])
        return np.asarray(np.interp(STRESSES, stress / widths.sum(), common))

    def held_strain(self, along: Direction, strains: Array) -> Array:
        """Strain at :data:`STRESSES` of lines across the pull that are strained alike throughout.

        One after the other, they carry the same force.
        """
        widths, lengths = self.lengths[along.other.axis], self.widths[along.other.axis]
        common = _COMMON * strains[:, -1].max()
        stress = np.array([np.interp(common, phase, _FINE) for phase in strains])
        of_line = widths @ stress / widths.sum(axis=1, keepdims=True)
        strain = lengths @ np.array([np.interp(STRESSES, line, common) for line in of_line])
        return np.asarray(strain / lengths.sum())


def _added_up(
    cloths: list[tuple[float, _Lines]], direction: Direction, strains: Array, parts: Array
) -> Array:
    """Strains (phases, stresses) of phases that add up to those of their patch, (stresses,).

    Where phases lie side by side, one carries more than the mean stress and the other less, so
    that the parts of their strains do not add up. All are scaled alike, at each stress, until
    together they have the law that is fitted to the patch. Lines of stitches hold each other, but
    not quite: the strain is a mean of both bounds, :data:`HELD`.
    """
    even = _strains_of(_fitted(strains[None]), STRESSES)[0]
    scaled = even * parts
    for _ in range(ROUNDS):
        own = _strains_of(_fitted(scaled), _FINE)
        for weight, lines in cloths:
            if weight:
                free, held = lines.free_strain(direction, own), lines.held_strain(direction, own)
                scaled *= (even / (free ** (1 - HELD) * held**HELD)) ** weight
    return np.asarray(scaled)


def _strains_of(constants: Array, stresses: Array) -> Array:
    """Strains (laws, stresses) of laws with the constants (laws, 3) of :func:`_fitted`."""
    modulus, alpha, beta = constants.T[..., None]
    at = _TO_LOCK_UP / alpha
    stress = modulus * at + beta * stiffening(alpha * at)[1]
    pairs = zip(stress, at, strict=True)
    return np.stack([np.interp(stresses, carried, strain) for carried, strain in pairs])


def _parts(cells: Codes, lines: _Lines, records: list[FabricRecord]) -> Array:
    """Ratios of the phases' strains to the cloth's at :data:`STRESSES`, (2, phases, stresses).

    They are half as far from 1 as in the flat composite, and as far in wide areas of one phase.
    """
    wide = scipy.ndimage.maximum_filter(cells, _WIDE) == scipy.ndimage.minimum_filter(cells, _WIDE)
    contrast = (1 + wide.mean()) / 2
    ratios = []
    for direction in Direction:
        own = [_own_strains(r.law, direction) for r in records]
        strains, fine = (np.array(values) for values in zip(*own, strict=True))
        ratios.append(1 + contrast * (strains / lines.free_strain(direction, fine) - 1))
    return np.array(ratios)


def _fitted(strains: Array) -> Array:
    """Young's moduli (N/mm), alphas and betas (N/mm), (laws, 3), of laws with the ``strains``
    (laws, stresses) at :data:`STRESSES`.

    For each alpha, modulus and beta, not below 0, follow by least squares of the relative stress.
    """
    alpha = _LOCKED / strains[:, -1:]
    slopes = stiffening(alpha[..., None] * strains[:, None])[1] / STRESSES
    line = (strains / STRESSES)[:, None]
    # the normal equations of two unknowns, for all alphas at once
    mixed, total, square = (slopes * line).sum(-1), line.sum(-1), (line**2).sum(-1)
    determinant = square * (slopes**2).sum(-1) - mixed**2
    beta = np.maximum((square * slopes.sum(-1) - mixed * total) / determinant, 0.0)
    modulus = (total - mixed * beta) / square
    off = ((modulus[..., None] * line + beta[..., None] * slopes - 1) ** 2).sum(-1)
    best = np.where(modulus > 0, off, np.inf).argmin(axis=1)[:, None]
    chosen = [np.take_along_axis(values, best, axis=1)[:, 0] for values in (modulus, alpha, beta)]
    return np.stack(chosen, axis=1)
