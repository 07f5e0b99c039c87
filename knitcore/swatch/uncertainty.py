"""How sure a strip test is: intervals of force, strain and lock-up utilisation.

The clamps prescribe the stretch, so a factor on the stiffness of all cloth changes the force and no
strain. Strains change where one fabric is stiffer than expected *beside another one*, or along its
courses but not its wales. To first order (delta method) a parameter p of the laws moves nodes by

    du/dp = -K⁻¹ dR/dp

with the tangent K and the internal forces R of the equilibrium, and variances of independent
parameters add up. The parameters are

- the logarithm of each fabric's scale of stress along course and wale (C_aaaa and beta together;
  alpha, and with it the lock-up strain, stays: tests fix it best), with the standard deviation of
  the material's modulus;
- each fabric's coupling, at fixed moduli, with that of its Poisson ratios;
- the logarithm of the shear modulus of all fabrics, where it is the assumed one;
- the composite's own error, where fabrics are mixed: one of the whole scale for the force, one of
  each fabric apart for strains.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.errors import InputError
from knitcore.fabric import PHASES, Direction
from knitcore.gridsolver.dissection import GridFactor
from knitcore.law.constitutive import DEFAULT_SHEAR_MODULUS_N_PER_MM, ConstitutiveLaw
from knitcore.materials.material import Material
from knitcore.materials.uncertainty import Z_SCORE, Interval, LawUncertainty, log_interval
from knitcore.swatch.calibration import LOG_SHEAR_PRIOR
from knitcore.swatch.fields import cell_strains, corner_means, utilisation
from knitcore.swatch.models import Coupling
from knitcore.swatch.results import StripTest
from knitcore.swatch.sheet import Sheet
from knitcore.swatch.strip import Clamps, clamp_edges, clamp_mask, waist_strain

Array = NDArray[np.float64]


MODEL_LOG_SD = {"flat": math.log(3.5) / Z_SCORE, "patchwork": 0.05}
"""The composite's own error, stitches of mixed quarters and of one fabric."""


@dataclass(frozen=True, eq=False)
class StepSpread:
    """Standard deviations at one load step.

    Attributes
    ----------
    force_n : interval of the force (90 %).
    force_log_sd : of the logarithm of force and stress.
    waist_sd : of the waist strain.
    strain_xx_sd, strain_yy_sd, utilisation_sd : (rows + 1, columns + 1) at the cells' corners, as
        :class:`knitcore.swatch.fields.Fields` has the values; NaN without cloth.
    """

    force_n: Interval
    force_log_sd: float
    waist_sd: float
    strain_xx_sd: Array
    strain_yy_sd: Array
    utilisation_sd: Array


@dataclass(frozen=True, eq=False)
class _Parameter:
    """Something that the laws are not sure of.

    Attributes
    ----------
    laws : (laws, 10), derivative of the kernel's parameters.
    sd : of the parameter.
    model_sd : of the composite's error in it, which counts for strains.
    """

    laws: Array
    sd: float
    model_sd: float


class StripSpread:
    """Intervals of a strip test of a chart.

    Parameters
    ----------
    test : the test.
    material : whose uncertainty it is.
    clamps : as in the test.

    Raises
    ------
    InputError
        If the sheet may wrinkle (``tension_field``): its forces are not linear in the laws.

    Examples
    --------
    >>> from knitcore import StitchChart
    >>> from knitcore.materials import material
    >>> from knitcore.swatch import strip_test
    >>> chart = StitchChart.of_fabric("garter", rows=4, columns=6)
    >>> test = strip_test(chart, material("acrylic"), "wale", 0.3, steps=3)
    >>> force = StripSpread(test, material("acrylic")).at(-1).force_n
    >>> bool(force.low < test.force_n[-1] < force.high)
    True
    """

    def __init__(
        self, test: StripTest, material: Material, clamps: Clamps = Clamps.CLAMPED
    ) -> None:
        if test.sheet.model.tension_field:
            raise InputError(
                "tension_field", "there are no intervals for a sheet that wrinkles.", "Turn it off."
            )
        grid = test.sheet.grid
        fixed = clamp_mask(grid, test.direction, clamps) | ~grid.used_corners[:, None]
        self.test = test
        self._fixed = fixed
        self._factor = GridFactor(grid.columns, grid.rows, fixed.ravel())
        self._model_sd = model_log_sd(test.sheet)
        self._parameters = _parameters(test.sheet, material, self._model_sd)

    def at(self, step: int) -> StepSpread:
        """The standard deviations at a load step (negative ones count from the last)."""
        test, sheet = self.test, self.test.sheet
        grid, state, axis = sheet.grid, test.states[step], test.direction.axis
        lin = sheet.linearise(state)
        self._factor.factorise(lin.matrix)
        pulled = grid.edge(clamp_edges(test.direction)[1])
        slope = self._utilisation_slope(step)
        force_variance = waist_variance = 0.0
        variances = np.zeros((3, grid.rows + 1, grid.columns + 1))
        for parameter in self._parameters:
            corner_force, centre_force = sheet.law_force(parameter.laws, state)
            change = lin.with_force(corner_force, centre_force)
            condensed = change.condensed_force()
            free = np.where(self._fixed, 0.0, -condensed)
            corner_step = self._factor.solve(free).reshape(condensed.shape)
            held = condensed[pulled, axis].sum() + lin.apply(corner_step)[pulled, axis].sum()
            force_variance += (parameter.sd * held / test.force_n[step]) ** 2
            waist = waist_strain(grid, state.corners + corner_step, test.direction)
            full_sd = math.hypot(parameter.sd, parameter.model_sd)
            waist_variance += (full_sd * (waist - test.waist_strain[step])) ** 2
            strains = sheet.strain_change(state, corner_step, change.centre_step(corner_step))
            used = (slope * strains).sum(axis=0)
            for name, cells in enumerate((*strains, used)):
                variances[name] += (full_sd * corner_means(grid, cells)) ** 2
        force_log_sd = math.hypot(math.sqrt(force_variance), self._model_sd)
        return StepSpread(
            log_interval(float(test.force_n[step]), force_log_sd),
            force_log_sd,
            math.sqrt(waist_variance),
            *np.sqrt(variances),
        )

    def _utilisation_slope(self, step: int) -> Array:
        """d utilisation / d (strain course-wise, wale-wise) of every cell, (2, rows, columns)."""
        sheet = self.test.sheet
        used = utilisation(sheet, cell_strains(sheet, self.test.states[step]))
        alpha = np.array([(law.alpha_xx, law.alpha_yy) for law in sheet.laws])
        cell_alpha = alpha[sheet.grid.law_of_cell]
        kappa = sheet.model.stiffening_coupling
        course = used[0] >= used[1]
        return np.stack(
            [
                np.where(course, cell_alpha[..., 0], kappa * cell_alpha[..., 1]),
                np.where(course, kappa * cell_alpha[..., 0], cell_alpha[..., 1]),
            ]
        )


def model_log_sd(sheet: Sheet) -> float:
    """The composite's own error in a sheet, by its share of stitches with mixed quarters."""
    grid = sheet.grid
    codes, there = grid.law_of_cell, grid.cloth[::2, ::2]
    quarters = np.stack([codes[i::2, j::2][there] for i in (0, 1) for j in (0, 1)])
    pure = float(np.mean(np.ptp(quarters, axis=0) == 0))
    if len(np.unique(codes[grid.cloth])) == 1:
        return 0.0
    return pure * MODEL_LOG_SD["patchwork"] + (1 - pure) * MODEL_LOG_SD["flat"]


def _parameters(sheet: Sheet, material: Material, model_sd: float) -> list[_Parameter]:
    found = []
    shear = np.zeros((len(sheet.laws), 10))
    for code in np.unique(sheet.grid.law_of_cell[sheet.grid.cloth]):
        law, spread = sheet.laws[code], material.record(PHASES[code]).uncertainty
        for direction in Direction:
            sd = spread.log_modulus(direction)
            found.append(_Parameter(_table(sheet, code, _scale(law, direction)), sd, model_sd))
        sd = _coupling_sd(material.law(PHASES[code]), sheet.model.rule, spread)
        found.append(_Parameter(_table(sheet, code, _coupling(law)), sd, 0.0))
        if (
            sheet.model.shear_modulus is None
            and law.shear_modulus == DEFAULT_SHEAR_MODULUS_N_PER_MM
        ):
            shear += _table(sheet, code, (0, 0, 0, law.shear_modulus, 0, 0))
    if shear.any():
        found.append(_Parameter(shear, LOG_SHEAR_PRIOR[1], 0.0))
    return found


def _table(sheet: Sheet, code: int, change: tuple[float, ...]) -> Array:
    """Kernel parameters of a change (C_xxxx, C_yyyy, C_xxyy, C_xyxy, beta_xx, beta_yy) of a law."""
    law = sheet.laws[code]
    table = np.zeros((len(sheet.laws), 10))
    table[code, :4], table[code, 6:8] = change[:4], change[4:]
    table[code, 4:6] = law.alpha_xx, law.alpha_yy
    table[code, 8] = sheet.model.stiffening_coupling
    return table


def _scale(law: ConstitutiveLaw, direction: Direction) -> tuple[float, ...]:
    """By the logarithm of the scale of stress in a direction, Poisson's ratios' product fixed."""
    coupling = law.stiffness_xxyy / 2
    if direction is Direction.COURSE:
        return law.stiffness_xxxx, 0, coupling, 0, law.beta_xx, 0
    return 0, law.stiffness_yyyy, coupling, 0, 0, law.beta_yy


def _coupling(law: ConstitutiveLaw) -> tuple[float, ...]:
    """By r = C_xxyy / sqrt(C_xxxx C_yyyy), Young's moduli fixed."""
    mean = math.sqrt(law.stiffness_xxxx * law.stiffness_yyyy)
    r = law.stiffness_xxyy / mean
    grown = 2 * r / (1 - r * r)
    return (
        grown * law.stiffness_xxxx,
        grown * law.stiffness_yyyy,
        mean * (1 + r * grown),
        0,
        0,
        0,
    )


def _coupling_sd(measured: ConstitutiveLaw, rule: Coupling, spread: LawUncertainty) -> float:
    """Of r, by those of the measured Poisson ratios that the model's rule makes it of."""
    nu_yx, nu_xy = measured.poisson_yx, measured.poisson_xy
    if rule is Coupling.GEOMETRIC and nu_yx * nu_xy > 0:  # r = sqrt(nu_yx nu_xy)
        aspect = math.sqrt(nu_yx / nu_xy)
    else:
        aspect = math.sqrt(measured.stiffness_xxxx / measured.stiffness_yyyy)
    if rule is Coupling.SCRIPT:  # r = nu_xy aspect
        return spread.poisson_xy * aspect
    return math.hypot(spread.poisson_yx / aspect, spread.poisson_xy * aspect) / 2
