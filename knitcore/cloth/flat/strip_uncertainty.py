"""Uncertainty of a strip test: intervals of force, strain and lock-up utilisation.

The clamps prescribe the stretch, so a common factor on the stiffness changes the force but no
strain. Strains change where one fabric is stiffer *relative to its neighbours* than expected, or
along its courses but not its wales. To first order (delta method) a parameter p of the laws moves
nodes by

    du/dp = -K⁻¹ dR/dp

with the tangent K and the internal forces R of the equilibrium, and variances of independent
parameters add up. The parameters are

- the logarithm of each fabric's scale of stress along course and wale (C_aaaa and beta together),
  as uncertain as the curve at the test's stress;
- each fabric's coupling, at fixed moduli, with the deviation of its Poisson ratios;
- the logarithm of each fabric's shear modulus, and of all where it is the assumed one;
- what blocks of stitches leave out (:mod:`knitcore.cloth.flat.coarse`), where fabrics are mixed;
- the model's own error, where fabrics are mixed: for the force that of the chart's prediction
  (:mod:`knitcore.prediction.quarter_laws`), for strains one for each fabric separately.

The lock-up (1 / alpha) is itself uncertain, and its utilisation with it.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.chart.fabric import PHASES, Direction
from knitcore.cloth.flat import coarse
from knitcore.cloth.flat.fields import (
    cell_strains,
    corner_means,
    stiffening_of,
    strain_slopes,
    utilisation,
)
from knitcore.cloth.flat.grid_kernel import Nodes
from knitcore.cloth.flat.grid_sheet import Sheet
from knitcore.cloth.flat.strip import Clamps, clamp_edges, clamp_mask, waist_strain
from knitcore.cloth.flat.strip_results import StripTest
from knitcore.law.constitutive import (
    DEFAULT_SHEAR_MODULUS_N_PER_MM,
    ConstitutiveLaw,
    Symmetrisation,
)
from knitcore.law.stiffening import StiffeningForm
from knitcore.linear.grid_factor import GridFactor
from knitcore.materials.law_uncertainty import (
    Z_SCORE,
    Interval,
    LawUncertainty,
    in_a_sentence,
    log_interval,
)
from knitcore.materials.material import Material
from knitcore.prediction.quarter_laws import SPREAD_AT

Vary = Callable[[ConstitutiveLaw, float], ConstitutiveLaw]
"""A law after a step of one of its parameters."""
LOG_SHEAR_PRIOR = (float(np.log(0.02)), 1.0)
"""Mean and standard deviation of ln(C_xyxy / (N/mm)). In acrylic garter, for which it was chosen,
0.02 N/mm is 0.2 sqrt(Y_x Y_y), the mean of a strip fit's prior; other fabrics may be far from it.
Its deviation is also that of a shear modulus that was not fitted."""
MODEL_LOG_SD = {"flat": math.log(3.5) / Z_SCORE, "patchwork": 0.05}
"""The composite's own error, for stitches of mixed quarters and of one fabric."""
MODEL_ERRORS = "the mixture's own error, as for the chart's moduli"
BLOCKS = "what blocks of stitches leave out"
SHEAR_ASSUMED = (
    f"an assumed shear modulus, within a factor of {np.exp(Z_SCORE * LOG_SHEAR_PRIOR[1]):.0f}"
)
LOG_SHEAR_STIFFENING = 1.0
"""Standard deviation of the logarithm of the growth of the shear stiffness, found on one jersey. To
first order its 90 % interval is -2.6 to 10.6 rad⁻²; the yarn level, without friction, has -2.5."""
STEP = 1e-3
"""Step of a parameter, for differences of forces."""


@dataclass(frozen=True, eq=False)
class StepSpread:
    """Standard deviations at one load step.

    Attributes
    ----------
    force_n : interval of the force (90 %).
    force_log_sd : of the logarithm of force and stress.
    waist_sd : of the waist strain.
    strain_xx_sd, strain_yy_sd, utilisation_sd : (rows + 1, columns + 1) at the cells' corners, as
        :class:`knitcore.cloth.flat.fields.Fields` has the values; NaN without cloth.
    """

    force_n: Interval
    force_log_sd: float
    waist_sd: float
    strain_xx_sd: Array
    strain_yy_sd: Array
    utilisation_sd: Array


@dataclass(frozen=True, eq=False)
class LawParameter:
    """An uncertain parameter of the laws.

    Attributes
    ----------
    up, down : (codes,), the kernel's laws with this one raised and lowered by ``STEP``; 0 for
        laws without it.
    sd : of the parameter.
    model_sd : of the composite's error in it, which counts for strains.
    """

    up: NDArray[np.void]
    down: NDArray[np.void]
    sd: float
    model_sd: float


class StripSpread:
    """Intervals of a strip test of a chart.

    Parameters
    ----------
    test : the test.
    material : with the uncertainty of its laws.
    clamps : as in the test.

    Examples
    --------
    >>> from knitcore import StitchChart
    >>> from knitcore.materials import material
    >>> from knitcore.cloth.flat import strip_test
    >>> chart = StitchChart.of_fabric("garter", rows=4, columns=6)
    >>> test = strip_test(chart, material("acrylic"), "wale", 0.3, steps=3)
    >>> force = StripSpread(test, material("acrylic")).at(-1).force_n
    >>> bool(force.low < test.force_n[-1] < force.high)
    True
    """

    def __init__(
        self, test: StripTest, material: Material, clamps: Clamps = Clamps.CLAMPED
    ) -> None:
        grid = test.sheet.grid
        fixed = clamp_mask(grid, test.direction, clamps) | ~grid.used_corners[:, None]
        self.test = test
        self._fixed = fixed
        self._factor = GridFactor(grid.columns, grid.rows, fixed.ravel())
        self._model_sd = model_log_sd(test.sheet)
        self._material = material
        self._lock_up_sd = _lock_up_sd(test.sheet, material)

    def at(self, step: int) -> StepSpread:
        """The standard deviations at a load step (negative ones count from the last)."""
        test, sheet = self.test, self.test.sheet
        grid, state, axis = sheet.grid, test.states[step], test.direction.axis
        lin = sheet.linearise(state)
        self._factor.factorise(lin.tangent.matrix)
        pulled = grid.edge(clamp_edges(test.direction)[1])
        slope = self._utilisation_slope(step)
        strain_by_position = strain_slopes(sheet, state)
        force_variance = waist_variance = 0.0
        variances = np.zeros((3, grid.rows + 1, grid.columns + 1))
        for parameter in law_parameters(
            sheet, self._material, self._model_sd, float(test.stress_n_per_mm[step])
        ):
            raised = sheet.law_force(parameter.up, state)
            lowered = sheet.law_force(parameter.down, state)
            force = Nodes(*((u - d) / (2 * STEP) for u, d in zip(raised, lowered, strict=True)))
            change = replace(lin, force=force)
            condensed = change.condensed_force()
            free = np.where(self._fixed, 0.0, -condensed)
            corner_step = self._factor.solve(free).reshape(condensed.shape)
            held = condensed[pulled, axis].sum() + lin.apply(corner_step)[pulled, axis].sum()
            force_variance += (parameter.sd * held / test.force_n[step]) ** 2
            waist = waist_strain(grid, state.corners + corner_step, test.direction)
            full_sd = math.hypot(parameter.sd, parameter.model_sd)
            waist_variance += (full_sd * (waist - test.waist_strain[step])) ** 2
            moved = np.concatenate([part.ravel() for part in change.newton_step(corner_step)])
            strains = (strain_by_position @ moved).reshape(slope.shape)
            used = (slope * strains).sum(axis=0)
            for name, cells in enumerate((*strains, used)):
                variances[name] += (full_sd * corner_means(grid, cells)) ** 2
        locks = self._lock_up_sd[grid.law_of_cell % len(PHASES)]
        used = utilisation(sheet, cell_strains(sheet, state))
        direct = np.where(used[0] >= used[1], used[0] * locks[..., 0], used[1] * locks[..., 1])
        variances[2] += corner_means(grid, direct) ** 2
        force_log_sd = math.hypot(math.sqrt(force_variance), self._force_model_sd(step))
        if _is_blurred(sheet):
            force_log_sd = math.hypot(force_log_sd, coarse.LOG_FORCE_SD)
            waist_variance += coarse.WAIST_SD**2
        return StepSpread(
            log_interval(float(test.force_n[step]), force_log_sd),
            force_log_sd,
            math.sqrt(waist_variance),
            *np.sqrt(variances),
        )

    def _force_model_sd(self, step: int) -> float:
        """The model's own error of the log force: by the prediction, at the step's stress."""
        spread = self.test.sheet.stress_log_sd
        if spread is None:
            return self._model_sd
        stress = float(self.test.stress_n_per_mm[step])
        return float(np.interp(stress, SPREAD_AT, spread[self.test.direction.axis]))

    def _utilisation_slope(self, step: int) -> Array:
        """d utilisation / d (strain course-wise, wale-wise) of every cell, (2, rows, columns)."""
        sheet = self.test.sheet
        strains = cell_strains(sheet, self.test.states[step])
        used = utilisation(sheet, strains)
        stiff = stiffening_of(sheet, sheet.grid.law_of_cell)
        form = StiffeningForm(sheet.model.energy.value)
        (xx, xy), (yx, yy) = stiff.argument_slopes(*strains.mean[:2], form)
        course = used[0] >= used[1]
        return np.stack([np.where(course, xx, yx), np.where(course, xy, yy)])


def model_log_sd(sheet: Sheet) -> float:
    """The composite's own error in a sheet, by its share of stitches with mixed quarters."""
    grid = sheet.quarters
    codes, there = grid.law_of_cell % len(PHASES), grid.cloth[::2, ::2]
    quarters = np.stack([codes[i::2, j::2][there] for i in (0, 1) for j in (0, 1)])
    pure = float(np.mean(np.ptp(quarters, axis=0) == 0))
    if len(np.unique(codes[grid.cloth])) == 1:
        return 0.0
    return pure * MODEL_LOG_SD["patchwork"] + (1 - pure) * MODEL_LOG_SD["flat"]


def _lock_up_sd(sheet: Sheet, material: Material) -> Array:
    """Standard deviation of ln(lock-up strain), course-wise and wale-wise, (phases, 2)."""
    log_sd = np.zeros((len(PHASES), 2))
    for phase in _phases(sheet):
        spread = material.record(PHASES[phase]).uncertainty
        log_sd[phase] = [spread.curve(direction).log_lock_up for direction in Direction]
    return log_sd


def law_parameters(
    sheet: Sheet, material: Material, model_sd: float, stress_n_per_mm: float
) -> Iterator[LawParameter]:
    """The uncertain parameters of a sheet's fabrics, one by one, and of the assumed shear modulus.

    ``stress_n_per_mm`` is the approximate stress of the cloth.
    """

    def varied(phases: list[int], vary: Vary, sd: float, of_model: float = 0.0) -> LawParameter:
        return LawParameter(*_varied(sheet, phases, vary), sd, of_model)

    for phase in _phases(sheet):
        record = material.record(PHASES[phase])
        spread = record.uncertainty
        for direction in Direction:
            sd = float(spread.log_stress(direction, stress_n_per_mm))
            yield varied([phase], partial(_stress_scaled, direction), sd, model_sd)
        yield varied([phase], _coupled, _coupling_sd(record.law, sheet.model.rule, spread))
        if sheet.model.shear_modulus is None and spread.log_shear is not None:
            yield varied([phase], partial(_scaled, "shear_modulus"), spread.log_shear)
            yield varied([phase], partial(_scaled, "shear_stiffening"), LOG_SHEAR_STIFFENING)
    assumed = _of_assumed_shear(sheet, material)
    if assumed:
        yield varied(assumed, partial(_scaled, "shear_modulus"), LOG_SHEAR_PRIOR[1])


def interval_source(sheet: Sheet, material: Material) -> str:
    """Name the sources of the intervals of a test of a sheet, in words."""
    said = [material.record(PHASES[phase]).uncertainty.source for phase in _phases(sheet)]
    said += [SHEAR_ASSUMED] if _of_assumed_shear(sheet, material) else []
    said += [MODEL_ERRORS] if model_log_sd(sheet) else []
    said += [BLOCKS] if _is_blurred(sheet) else []
    return in_a_sentence(said)


def _is_blurred(sheet: Sheet) -> bool:
    """Return whether cells hold stitches of several fabrics."""
    return sheet.block > 1 and len(_phases(sheet)) > 1


def _phases(sheet: Sheet) -> list[int]:
    """Phases of the cells of a sheet's cloth."""
    cells = sheet.quarters
    phases: list[int] = np.unique(cells.law_of_cell[cells.cloth] % len(PHASES)).tolist()
    return phases


def _of_assumed_shear(sheet: Sheet, material: Material) -> list[int]:
    """Phases whose shear modulus is the assumed one."""
    return [
        phase
        for phase in _phases(sheet)
        if sheet.model.shear_modulus is None
        and material.record(PHASES[phase]).uncertainty.log_shear is None
        and sheet.laws[phase].shear_modulus == DEFAULT_SHEAR_MODULUS_N_PER_MM
    ]


def _varied(
    sheet: Sheet, phases: list[int], vary: Vary
) -> tuple[NDArray[np.void], NDArray[np.void]]:
    """The kernel's records of the laws of these phases with a parameter raised and lowered; 0 for
    the others.
    """
    varied = [code for code in range(len(sheet.laws)) if code % len(PHASES) in phases]
    tables = []
    for step in (STEP, -STEP):
        table = np.zeros_like(sheet.model.parameters(sheet.laws))
        table[varied] = sheet.model.parameters([vary(sheet.laws[code], step) for code in varied])
        tables.append(sheet.by_code(table))
    return tables[0], tables[1]


def _stress_scaled(direction: Direction, law: ConstitutiveLaw, step: float) -> ConstitutiveLaw:
    """The law for a step of ln(stress scale) in one direction, with ν_xy ν_yx fixed."""
    factor, axis = math.exp(step), "xx" if direction is Direction.COURSE else "yy"
    stiffness, stiffening = f"stiffness_{axis * 2}", f"beta_{axis}"
    coupling = law.stiffness_xxyy * math.sqrt(factor)
    return replace(
        law,
        stiffness_xxyy=coupling,
        stiffness_yyxx=coupling,
        **{name: getattr(law, name) * factor for name in (stiffness, stiffening)},
    )


def _coupled(law: ConstitutiveLaw, step: float) -> ConstitutiveLaw:
    """The law for a step of r = C_xxyy / sqrt(C_xxxx C_yyyy), with Young's moduli fixed."""
    r = law.stiffness_xxyy / math.sqrt(law.stiffness_xxxx * law.stiffness_yyyy)
    grown = (1 - r**2) / (1 - (r + step) ** 2)
    xxxx, yyyy = law.stiffness_xxxx * grown, law.stiffness_yyyy * grown
    coupling = (r + step) * math.sqrt(xxxx * yyyy)
    return replace(
        law,
        stiffness_xxxx=xxxx,
        stiffness_yyyy=yyyy,
        stiffness_xxyy=coupling,
        stiffness_yyxx=coupling,
    )


def _scaled(constant: str, law: ConstitutiveLaw, step: float) -> ConstitutiveLaw:
    """The law for a step of the logarithm of a constant."""
    return replace(law, **{constant: getattr(law, constant) * math.exp(step)})


def _coupling_sd(measured: ConstitutiveLaw, rule: Symmetrisation, spread: LawUncertainty) -> float:
    """Standard deviation of r, from those of the Poisson ratios that the model's rule uses."""
    nu_yx, nu_xy = measured.poisson_yx, measured.poisson_xy
    if rule is Symmetrisation.GEOMETRIC and nu_yx * nu_xy > 0:  # r = sqrt(nu_yx nu_xy)
        aspect = math.sqrt(nu_yx / nu_xy)
    else:
        aspect = math.sqrt(measured.stiffness_xxxx / measured.stiffness_yyyy)
    if rule is Symmetrisation.SCRIPT:  # r = nu_xy aspect
        return spread.poisson_xy * aspect
    return math.hypot(spread.poisson_yx / aspect, spread.poisson_xy * aspect) / 2
