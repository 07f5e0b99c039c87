"""Yarn in the stitches of a chart, at one setting of the machine.

Where a row changes between knit and purl, the yarn crosses from one side of the cloth to the other,
so that a row of loop length L has L (1 + c · changes per stitch); changes between rows take none.
A fabric's own loop length comes before this rule, which gives only those that a material lacks. A
mixed stitch has the mean of its quarters' fabrics. A measured length comes before both: it sets the
mean, and they share it out. The constant c and its errors are packaged data with their sources
(``data/yarn_per_stitch.csv``), made by ``studies/yarn_per_stitch.py``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from knitcore.base.arrays import Array, Mask, sum_in_order
from knitcore.base.bounds import check_count, check_positive
from knitcore.base.errors import InputError
from knitcore.chart.fabric import PHASES, Fabric
from knitcore.chart.phases import stitch_quarters
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.stitch_graph import StitchGraph
from knitcore.chart.stitch_kinds import YarnAct
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.materials.law_uncertainty import Interval, log_interval
from knitcore.materials.material import Material
from knitcore.materials.printed_figures import read_packaged

SAME_LENGTH = 1e-9
"""Part of a loop length by which rows may differ and still count as equal."""
YARN_OF_TUCK, YARN_OF_FLOAT = 0.75, 0.27
"""Yarn in a tuck, and in the float past a slipped stitch, over that of a knit: stated guesses."""
LOOP_LENGTH_LOG_SD = 0.05
"""Standard deviation of the logarithm of a loop length: the median of the 37 the paper prints."""


@dataclass(frozen=True)
class ChangeRule:
    """Extra yarn where a row changes between knit and purl.

    Attributes
    ----------
    per_change : yarn of a change, over that of a stitch without one.
    per_change_sd : its standard deviation on the machine on which it was measured.
    log_sd : standard deviation of the logarithm of rib's or seed's loop length by the rule, on
        other machines and by hand.
    alike_log_sd : the same where garter is taken to have the loops of stockinette, or seed of rib.
    measured_log_sd : standard deviation of the logarithm of the yarn in a swatch knitted again.
    source : of the constant.
    """

    per_change: float
    per_change_sd: float
    log_sd: float
    alike_log_sd: float
    measured_log_sd: float
    source: str

    def factor(self, fabric: Fabric, over: Fabric) -> float:
        """Loop length of a pure fabric over that of another."""
        longer, shorter = (1 + self.per_change * f.course_odd for f in (fabric, over))
        return longer / shorter


@cache
def change_rule() -> ChangeRule:
    """The rule with its packaged constants."""
    rows = {row["quantity"]: row for row in read_packaged("yarn_per_stitch.csv")}
    numbers = {name: float(row["value"]) for name, row in rows.items()}
    return ChangeRule(**numbers, source=rows["per_change"]["source"])


@dataclass(frozen=True)
class MeasuredYarn:
    """Yarn in a stitch that was measured on knitted cloth.

    Attributes
    ----------
    mm : mean of its stitches: unravel ten or more, and measure the yarn under a slight pull.
    fabric : of the cloth; None if it is the chart itself.
    """

    mm: float
    fabric: Fabric | None = None

    def __post_init__(self) -> None:
        check_positive("yarn_per_stitch_mm", self.mm, "mm", "a length of yarn", 1000)

    @classmethod
    def weighed(
        cls, mass_g: float, stitches: int, linear_density_tex: float, fabric: Fabric | None = None
    ) -> MeasuredYarn:
        """Yarn in a stitch of cloth that was weighed.

        Examples
        --------
        >>> MeasuredYarn.weighed(12.0, stitches=2000, linear_density_tex=500).mm
        12.0
        """
        check_positive("mass_g", mass_g, "g", "a mass")
        check_count("stitches", stitches, 1, 10**7)
        check_positive("linear_density_tex", linear_density_tex, "tex", "a linear density", 1e5)
        return cls(1e6 * mass_g / stitches / linear_density_tex, fabric)


@dataclass(frozen=True)
class LoopLength:
    """Yarn in a stitch of a pure fabric.

    Attributes
    ----------
    mm : the length.
    log_sd : standard deviation of its logarithm, besides that of the lengths it is derived from.
    like : fabrics from which it follows by the rule; empty if it is the material's own.
    """

    mm: float
    log_sd: float = 0.0
    like: tuple[Fabric, ...] = ()


@dataclass(frozen=True, eq=False, repr=False)
class YarnPerStitch(Result):
    """Yarn in the stitches of a chart.

    Attributes
    ----------
    stitch_mm : (rows, columns) of each stitch.
    mean_mm : of the stitches that are counted.
    log_sd : standard deviation of the logarithm of the mean.
    source : where it comes from, in words.
    """

    stitch_mm: Array
    mean_mm: float
    log_sd: float
    source: str

    @property
    def rows_mm(self) -> Array:
        """(rows,) loop length of each row, bottom first."""
        return np.asarray(self.stitch_mm.mean(axis=1))

    @property
    def row_shares(self) -> Array:
        """(rows,) loop length of each row over the mean of the rows."""
        return np.asarray(self.rows_mm / self.rows_mm.mean())

    @property
    def rows_are_equal(self) -> bool:
        """True if all rows have one loop length."""
        return float(np.ptp(self.row_shares)) <= SAME_LENGTH

    @property
    def mean_interval_mm(self) -> Interval:
        """90 % interval of the mean."""
        return log_interval(self.mean_mm, self.log_sd)


def loop_length(material: Material, fabric: Fabric) -> LoopLength:
    """Loop length of a pure fabric: the material's own, or by the rule from those that it has.

    A fabric with as many changes comes first: seed is like rib, and garter like stockinette.

    Raises
    ------
    InputError
        If the material has no loop length at all.
    """
    return _loop_length(_own_lengths(material), material, fabric)


def has_loop_length(material: Material) -> bool:
    """Say whether the yarn in its stitches is known."""
    return bool(_own_lengths(material))


def mean_yarn(
    chart: StitchChart | SymbolChart, material: Material, measured: MeasuredYarn | None = None
) -> tuple[float, Interval]:
    """Yarn in the mean stitch of a chart, mm, with its 90 % interval.

    Other stitches take parts of it (:func:`yarn_of_acts`). ``measured`` is of its knits and purls.

    Raises
    ------
    InputError
        If the material has no loop length.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> round(mean_yarn(SymbolChart.parse("VK;KK"), material("acrylic"))[0], 2)
    9.22
    """
    plain = chart if isinstance(chart, StitchChart) else chart.plain
    used = yarn_per_stitch(plain, material, measured=measured)
    share = 1.0 if isinstance(chart, StitchChart) else float(yarn_of_acts(chart.graph).mean())
    return share * used.mean_mm, log_interval(share * used.mean_mm, used.log_sd)


def yarn_of_acts(
    graph: StitchGraph, *, yarn_over: float = 1.0, tuck: float = YARN_OF_TUCK,
    slip: float = YARN_OF_FLOAT, crossing: float = 1.0,
) -> Array:  # fmt: skip
    """Yarn of every site as a part of a knit's, (rows, columns).

    Parameters
    ----------
    yarn_over, tuck : of a loop that is laid over the needle.
    slip : of the float that passes a slipped stitch.
    crossing : of a loop that changes places with others in a cable: one of the row below it.
    """
    sources = np.diff(graph.first, axis=1)
    passing = np.zeros(graph.act.shape, dtype=bool)
    above, crossed = np.repeat(np.arange(graph.rows), sources.sum(axis=1)), graph.layer != 0
    passing[above[crossed] - 1, graph.source[crossed] % graph.columns] = True
    over = np.where(sources > 0, tuck, yarn_over)
    through = np.where(passing, crossing, 1.0)
    acts = [graph.act == act for act in (YarnAct.OVER, YarnAct.MISS)]
    return np.asarray(np.select(acts, [over, np.full_like(over, slip)], through))


def yarn_per_stitch(
    chart: StitchChart,
    material: Material,
    *,
    measured: MeasuredYarn | None = None,
    periodic: bool = False,
    stitch: Mask | None = None,
    cells: Mask | None = None,
) -> YarnPerStitch:
    """Yarn in the stitches of a chart, at one setting of the machine.

    Parameters
    ----------
    chart, material : the chart, and the yarn as knitted.
    measured : yarn in a stitch of a swatch, or of this chart, which replaces the material's.
    periodic : treat the chart as a repeat.
    stitch : bool (rows, columns), where a chart with an outline has stitches.
    cells : bool (rows, columns), stitches whose mean and interval are given; all by default.

    Raises
    ------
    InputError
        If the material has no loop length, and none is measured.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> used = yarn_per_stitch(StitchChart.parse("KP/KK"), material("acrylic"), periodic=True)
    >>> used.rows_mm.round(1).tolist()
    [10.9, 15.9]
    """
    quarters = stitch_quarters(chart, periodic=periodic, stitch=stitch)
    there = np.ones_like(chart.purl) if stitch is None else stitch
    counted = there if cells is None else there & cells
    own = _own_lengths(material)
    if measured is not None and not own:
        own = {measured.fabric or Fabric.STOCKINETTE: measured.mm}
    lengths = [_loop_length(own, material, fabric) for fabric in PHASES]
    table = np.array([length.mm for length in lengths])
    spread = table * [length.log_sd for length in lengths]
    whole = table[quarters].mean(axis=-1)
    present = {PHASES[phase]: lengths[phase] for phase in np.unique(quarters[counted])}
    factor, log_sd, source = 1.0, LOOP_LENGTH_LOG_SD, _source(material, present)
    if measured is not None:
        log_sd, source = change_rule().measured_log_sd, "the yarn measured in this cloth"
        if measured.fabric is None:
            factor, spread = measured.mm / float(whole[there].mean()), np.zeros_like(spread)
        else:
            factor = measured.mm / _loop_length(own, material, measured.fabric).mm
            spread = np.maximum(spread, LOOP_LENGTH_LOG_SD * table)
            spread[measured.fabric.phase] = 0.0
            source = f"the yarn measured in {measured.fabric}; other fabrics in proportion"
    mean = float(whole[counted].mean())
    shared = float(spread[quarters[counted]].mean()) / mean
    return YarnPerStitch(factor * whole, factor * mean, math.hypot(log_sd, shared), source)


def _own_lengths(material: Material) -> dict[Fabric, float]:
    lengths = {fabric: record.loop_length_mm for fabric, record in material.fabrics.items()}
    return {fabric: length for fabric, length in lengths.items() if length is not None}


def _loop_length(own: Mapping[Fabric, float], material: Material, fabric: Fabric) -> LoopLength:
    if fabric in own:
        return LoopLength(own[fabric])
    if not own:
        problem = f"{material.identifier} has no loop length."
        remedy = "Unravel ten stitches of a swatch, measure the yarn, and add loop_length_mm."
        raise InputError("material", problem, remedy)
    rule = change_rule()
    alike = tuple(f for f in own if f.course_odd == fabric.course_odd)
    like = alike or tuple(own)
    logs = [math.log(own[f] * rule.factor(fabric, f)) for f in like]
    log_sd = rule.alike_log_sd if alike else rule.log_sd
    return LoopLength(math.exp(sum_in_order(logs) / len(logs)), log_sd, like)


def _source(material: Material, lengths: Mapping[Fabric, LoopLength]) -> str:
    ruled = [fabric for fabric, length in lengths.items() if length.like]
    words = f"the loop lengths of {material.identifier}"
    if not ruled:
        return words
    like = dict.fromkeys(other for fabric in ruled for other in lengths[fabric].like)
    return (
        f"{words}; {', '.join(ruled)} from {', '.join(like)}, by the changes between knit and purl "
        "along the rows"
    )
