"""Rest states by protocol, and what resists rolling: ``python -m studies.rest_states FOLDER``.

FOLDER holds ``measured.csv`` of KnitDB (:mod:`studies.knitdb`). Cloth comes off the machine flat.
Here a repeat is relaxed flat, and the forces that hold it are taken away in steps, against whatever
the yarn resists with; each jump is followed in small damped steps, so that the yarn keeps its
history. Where it stops is its rest state.

A candidate adds one thing to friction between yarns, with a number that no size has a part in
(:data:`CANDIDATES`). Bending inside the yarn has a memory: a part of its stiffness, up to a moment,
acts from a curvature that follows the yarn (an element of Prandtl's). Whether the yarn can turn
about its own axis is open, since nothing in the energy resists that: *turning* yarn remembers how
strongly it is bent, yarn that is *held* also to which side. The truth lies between.

It prints sizes over stockinette's, rms factors, what is chosen on the other fabrics
(:mod:`studies.claims`), and the stretch of acrylic seed along the rows.
"""

import argparse
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from knitcore import StitchChart, material, relax
from knitcore.base.arrays import Array
from knitcore.base.errors import KnitcoreError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials.yarn_per_stitch import change_rule
from knitcore.prediction.densities import densities
from knitcore.prediction.mixture import Mixture
from knitcore.yarn.kernels.scatter import scatter_gradient, scatter_local
from knitcore.yarn.kernels.structures import Ints, Pairs
from knitcore.yarn.kernels.tiles import one_tile
from knitcore.yarn.library.yarns import yarn_for
from knitcore.yarn.model.energy import CellEnergy, Slope, Terms
from knitcore.yarn.model.relaxed_cell import Branch
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.friction import Rubbing, rub
from knitcore.yarn.solve.newton import Options, minimise
from knitcore.yarn.solve.search import check_reached
from knitcore.yarn.solve.splines import RelaxedRepeat
from scripts.training.charts import YARN_POINTS
from studies.claims import nested
from studies.knitdb import factor, measured_swatches

FABRICS = {
    "garter": ("K/P", "1_1_001Garter"),
    "1×1 rib": ("KP", "3_3_009k1p1rib"),
    "seed": ("KP/PK", "2_3_006Seed"),
    "2×2 rib": ("KKPP", "4_3_012Ribk2p2"),
    "welt": ("K/K/P/P", "1_2_002FourRowWelting"),
    "moss": ("KP/KP/PK/PK", "3_1_007Moss"),
    "basket": ("KKPP/KKPP/PPKK/PPKK", "3_2_008SmallBlocks"),
    "KK/KP": ("KK/KP", "4_2_011BrokenSingleRib"),
    "seeded rib": ("KKKP/PKPP", "98_1_205Seeded_Rib"),
}
"""Repeats, and their swatches. The last is a sparse one that crumples."""
STOCKINETTE = "2_1_004Stockinette"
FRICTION = 0.26
"""Between yarns, see :func:`knitcore.yarn.library.yarns.yarn_friction`."""
WIDE, TALL = 1.03, 1.25
"""Width on the machine over that of stockinette at rest (needles 1.69 mm apart, stitches of 1.65 mm
in KnitDB), and height over that of the same fabric laid flat."""
STEPS = 5
"""In which the forces that hold the fabric are taken away."""
_MOST, _STILL = 0.25, 0.002
"""Largest movement in a step, and that of a state at rest, in radii."""
_OPTIONS = Options(tolerance=1e-8, iterations=80)
_ROUND = 0.05
"""Least curvature of yarn that turns, 1/mm: where it bends to neither side, it turns over."""
_TINY = 1e-5
"""Curvature, 1/mm, and change of a derivative, relative, that count as none."""


class Bending(NamedTuple):
    """Memory of the bending.

    Attributes
    ----------
    share : of the bending stiffness that acts from the remembered curvature.
    most : curvature from there, 1/mm, beyond which the memory follows; infinite for set.
    held : whether the yarn is kept from turning about its own axis.
    added : whether the memory's moment adds to the bending, or is a part of it.
    """

    share: float
    most: float = math.inf
    held: bool = False
    added: bool = False


class Candidate(NamedTuple):
    """One thing that resists when the fabric is released.

    Attributes
    ----------
    friction : coefficient between yarns.
    bending : memory inside the yarn.
    solid : least radius of the core, mm, such as that of the yarn's fibres packed without air.
    """

    friction: float = 0.0
    bending: Bending | None = None
    solid: float = 0.0


CANDIDATES = {
    "nothing": Candidate(),
    "friction between yarns": Candidate(FRICTION),
    **{
        f"{what} of yarn that {how}": Candidate(FRICTION, bending._replace(held=held))
        for how, held in (("turns", False), ("is held", True))
        for what, bending in (("friction", Bending(1.0, 0.2, added=True)), ("set", Bending(0.25)))
    },
}
"""Residual curvature of 0.2/mm, or a quarter of the bending that has set, where a stitch of
``middle`` bends by 1/mm. No test of such yarn at such bends is known to us: these are guesses of
the right size."""


@dataclass(frozen=True, eq=False)
class Memory:
    """Memory of a cell's yarn: per sample, the curvature at which it has no moment, and the
    direction of the yarn at that time.

    Attributes
    ----------
    bending : the law.
    stiffness : bending stiffness times the length of yarn of a sample, N·mm³.
    tangent, curvature : (n, 3); curvature is (n, 1) where the yarn turns.
    """

    bending: Bending
    stiffness: Array
    tangent: Array
    curvature: Array

    @classmethod
    def of(cls, energy: CellEnergy, state: Array, bending: Bending) -> "Memory":
        """Memory of straight yarn that was bent to a state; of this state if it has set."""
        d = energy.curve(state)
        tangent, curvature = _bent(d[:, 1], d[:, 2])
        if not bending.held:
            curvature = _length(curvature, _ROUND)[:, None]
        law = energy.rod_law
        stiffness = 2.0 * law.bend * law.step * energy.speeds
        if math.isfinite(bending.most):
            curvature = curvature * _beyond(curvature, bending.most)[:, None]
        return cls(bending, stiffness, tangent, curvature)

    def away(self, d1: Array, d2: Array) -> tuple[Array, Array, Array, Array]:
        """Direction, curvature, what is remembered of it, turned with the yarn, and the rest."""
        tangent, bent = _bent(d1, d2)
        if not self.bending.held:
            bends = _length(bent, _ROUND)[:, None]
            return tangent, bent, self.curvature, bends - self.curvature
        along = (self.curvature * tangent).sum(axis=1) / (
            1.0 + (self.tangent * tangent).sum(axis=1)
        )
        turned = self.curvature - along[:, None] * (self.tangent + tangent)
        return tangent, bent, turned, bent - turned

    def energy(self, d1: Array, d2: Array) -> Array:
        """(n,) energy of the memory at every sample, N·mm, of real or complex derivatives."""
        share, most, _, added = self.bending
        _, bent, _, away = self.away(d1, d2)
        square = (away**2).sum(axis=1)
        if math.isfinite(most):
            length = np.sqrt(square + _TINY**2)
            square = np.where(length.real < most, square, 2.0 * most * length - most**2)
        if not added:
            square = square - (bent**2).sum(axis=1)
        return np.asarray(0.5 * share * self.stiffness * square)

    def slopes(self, d: Array) -> Array:
        """(n, 6) derivatives of the energy by d1 and d2, by steps in the complex plane."""
        return np.stack([self.energy(*_moved(d, m, 1e-20j)).imag / 1e-20 for m in range(6)], axis=1)

    def curvatures(self, d: Array) -> Array:
        """(n, 6, 6) second derivatives."""
        out = np.empty((len(d), 6, 6))
        scale = np.sqrt((d[:, 1:3] ** 2).sum(axis=2)).mean(axis=0)
        for m in range(6):
            step = _TINY * scale[m // 3]
            up, down = (self.slopes(_stacked(d, *_moved(d, m, s))) for s in (step, -step))
            out[:, m] = (up - down) / (2.0 * step)
        return np.asarray(0.5 * (out + out.transpose(0, 2, 1)))

    def after(self, d: Array) -> "Memory":
        """The memory after a step."""
        tangent, _, turned, away = self.away(d[:, 1], d[:, 2])
        most = self.bending.most
        if math.isfinite(most):
            turned = turned + away * _beyond(away, most)[:, None]
        return replace(self, tangent=tangent, curvature=turned)


@dataclass(frozen=True, eq=False)
class LoadedEnergy(CellEnergy):
    """Energy of a cell with dead loads, damping of a step, and memory of the bending.

    Attributes
    ----------
    load : (unknowns,) forces against the unknowns.
    begin : (unknowns,) where the step begins.
    damping : stiffness towards there, N/mm.
    """

    load: Array | None = None
    begin: Array | None = None
    damping: float = 0.0
    memory: Memory | None = None

    def value(self, state: Array, curve: Array, pairs: Pairs) -> Terms:
        """Parts of the energy; loads, damping and memory count as friction."""
        terms = super().value(state, curve, pairs)
        assert self.load is not None and self.begin is not None  # noqa: PT018
        moved = state - self.begin
        more = self.load @ moved + 0.5 * self.damping * moved @ moved
        if self.memory is not None:
            more += self.memory.energy(curve[:, 1], curve[:, 2]).sum()
        return replace(terms, friction=terms.friction + float(more))

    def derivatives(
        self, state: Array, curve: Array, pairs: Pairs, start: Ints, tension: Array,
        *, hessian: bool = True, sparse: bool = False, lengths: bool = True,
    ) -> Slope:  # fmt: skip
        """Gradient and Hessian of the Lagrangian."""
        options = {"hessian": hessian, "sparse": sparse, "lengths": lengths}
        slope = super().derivatives(state, curve, pairs, start, tension, **options)
        assert self.load is not None and self.begin is not None  # noqa: PT018
        gradient = slope.gradient + self.load + self.damping * (state - self.begin)
        layout, n = self.cell.layout, len(curve)
        local = np.zeros((n, 9, 9))
        if self.memory is not None:
            slopes = np.zeros((n, 3, 3))
            slopes[:, :2] = self.memory.slopes(curve).reshape(n, 2, 3)
            gradient += scatter_gradient(np.zeros((n, 3)), slopes, layout)
            if hessian:
                local[:, :6, :6] = self.memory.curvatures(curve)
        if not hessian:
            return replace(slope, gradient=gradient)
        if slope.sparse is not None:
            matrix, sizes = slope.sparse.matrix, slope.sparse.sizes
            for block, tile in enumerate(np.diag(matrix.where)):
                few = min(matrix.tiles.shape[1], matrix.unknowns - block * matrix.tiles.shape[1])
                matrix.tiles[tile, range(few), range(few)] += self.damping
            sizes[range(2), (-2, -1)] += self.damping
        else:
            matrix, sizes = one_tile(self.cell.unknowns), np.zeros((2, self.cell.unknowns))
        none = np.zeros((n, 3, 3))
        if self.memory is not None:
            scatter_local(local, none, none, layout, matrix.tiles, matrix.where, sizes)
        if slope.hessian is not None:
            more = matrix.tiles[0]
            more[-2:], more[:, -2:] = sizes, sizes.T
            slope.hessian[:] += more + self.damping * np.eye(len(more))
        return replace(slope, gradient=gradient)


@dataclass
class Rest:
    """A state on the way to rest.

    Attributes
    ----------
    energy, state, tension, rubbing : of the cell.
    coefficient : of friction between yarns.
    """

    energy: LoadedEnergy
    state: Array
    tension: Array
    coefficient: float
    rubbing: Rubbing

    @classmethod
    def held(cls, flat: RelaxedRepeat, candidate: Candidate) -> "Rest":
        """A repeat that is held, in equilibrium under its holding forces as dead loads."""
        cell, yarn, state = flat.cell, flat.yarn, flat.state
        loops = flat.loop_lengths_mm
        tension = flat.tension_n[: loops.size]
        none = np.zeros(cell.unknowns)
        energy = LoadedEnergy(cell, yarn, loops, flat.convention, load=none, begin=state)
        if candidate.bending is not None:
            energy = replace(energy, memory=Memory.of(energy, state, candidate.bending))
        curve = energy.curve(state)
        pairs, start = energy.pairs(curve, state, 2.0 * yarn.radius_mm)
        slope = energy.derivatives(state, curve, pairs, start, tension, hessian=False)
        energy = replace(energy, load=-slope.gradient)
        rubbing = Rubbing(np.zeros(0, np.int64), np.zeros((0, 2)))
        return cls(energy, state, tension, candidate.friction, rubbing)

    @property
    def size_mm(self) -> Array:
        """(2,) width and height of a stitch."""
        return self.state[-2:]

    def follow(self, loads: Array) -> None:
        """Go on from load to load, then to rest."""
        for load in loads:
            self._under(load)
        for _ in range(20):
            if self._under(loads[-1]) < _STILL:
                return

    def release(self) -> "Rest":
        """Take the loads away in steps."""
        load = np.asarray(self.energy.load)
        self.follow(np.linspace(1.0, 0.0, STEPS + 1)[1:, None] * load)
        return self

    def pull(self, stress_n_per_mm: float, steps: int = 8) -> float:
        """Strain along the rows under a stress, from here."""
        load, width = np.zeros(len(self.state)), self.size_mm[0]
        load[-2] = -stress_n_per_mm * self.size_mm[1] * self.energy.cell.stitches
        self.follow(np.linspace(0.0, 1.0, steps + 1)[1:, None] * load)
        return float(self.size_mm[0] / width - 1.0)

    def _under(self, load: Array) -> float:
        """Settle under a load, jumps in damped steps; the largest movement, in radii."""
        unit = self.energy.unit / self.energy.mean_loop_mm**2
        damping, way = 0.0, 0.0
        for _ in range(80):
            begin, radius = self.state, self.energy.yarn.radius_mm
            energy = replace(self.energy, load=load, begin=begin, damping=damping)
            try:
                state, tension, rubbing = self._step(energy)
                moved = float(np.abs(state - begin).max()) / radius
            except KnitcoreError:
                moved = math.inf
            if moved > _MOST and damping < 1e4 * unit:
                damping = max(4.0 * damping, unit)
                continue
            if not math.isfinite(moved):
                raise ArithmeticError("does not settle")
            self.state, self.tension, self.rubbing = state, tension, rubbing
            memory = energy.memory and energy.memory.after(energy.curve(state))
            self.energy = replace(energy, memory=memory)
            way += moved
            if damping == 0.0:
                return way
            if moved < 0.5 * _MOST:
                damping = damping / 4.0 if damping > unit else 0.0
        raise ArithmeticError("does not settle")

    def _step(self, energy: LoadedEnergy) -> tuple[Array, Array, Rubbing]:
        if self.coefficient == 0.0:
            end = minimise(energy, self.state, tension=self.tension, options=_OPTIONS)
            check_reached(energy, end)
            return end.state, end.tension, self.rubbing
        end, rubbing, _ = rub(
            energy, self.state, self.tension, self.rubbing, self.coefficient, options=_OPTIONS,
            check=check_reached,
        )  # fmt: skip
        return end.state, end.tension, rubbing


def held_flat(
    chart: StitchChart, yarn: YarnModel, loops: Array, width_mm: float | None = None,
    tall: float = 1.0,
) -> RelaxedRepeat:  # fmt: skip
    """A repeat laid flat, at a width if it can be reached, and taller than it would be.

    What cannot be reached is made less by a quarter, until it can.
    """
    flat = relax(chart, yarn, loops, branch=Branch.MIRRORED, flat=True)
    if width_mm is None:
        return flat
    wide = width_mm / flat.cell_course_mm
    for part in 0.75 ** np.arange(12):
        size = {"cell_course_mm": flat.cell_course_mm * wide**part}
        size["cell_wale_mm"] = flat.cell_wale_mm * tall**part
        try:
            held = relax(chart, yarn, loops, branch=Branch.MIRRORED, flat=True, **size)
        except KnitcoreError:
            continue
        if held.converged:
            return held
    return flat


def off_machine(
    chart: StitchChart, yarn: YarnModel, loops: Array, needle_mm: float | None
) -> RelaxedRepeat:
    """A repeat as the machine holds it: the same width for all charts, and taller."""
    return held_flat(chart, yarn, loops, needle_mm, TALL)


def lengths(chart: StitchChart, loop_mm: float) -> Array:
    """(rows,) yarn per stitch of each row, by its changes."""
    changes = (chart.purl != np.roll(chart.purl, 1, axis=1)).mean(axis=1)
    return np.asarray(loop_mm * (1.0 + change_rule().per_change * changes))


def _bent(d1: Array, d2: Array) -> tuple[Array, Array]:
    """Direction and curvature of the yarn, (n, 3) each."""
    square = (d1**2).sum(axis=1)[:, None]
    tangent = d1 / np.sqrt(square)
    return tangent, (d2 - tangent * (tangent * d2).sum(axis=1)[:, None]) / square


def _length(vectors: Array, least: float = _TINY) -> Array:
    return np.asarray(np.sqrt((vectors**2).sum(axis=1) + least**2))


def _beyond(vectors: Array, most: float) -> Array:
    """The part of vectors (n, k) that lies beyond a length."""
    return np.asarray(np.maximum(0.0, 1.0 - most / _length(vectors)))


def _moved(d: Array, m: int, step: complex) -> tuple[Array, Array]:
    both = d[:, 1:3].reshape(len(d), 6).astype(np.result_type(d, step))
    both[:, m] += step
    return both[:, :3], both[:, 3:]


def _stacked(d: Array, d1: Array, d2: Array) -> Array:
    out = d.copy()
    out[:, 1], out[:, 2] = d1, d2
    return out


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--part", choices=("sizes", "acrylic"))
    arguments = parser.parse_args()
    if arguments.part in (None, "sizes"):
        _print_sizes(arguments.folder)
    if arguments.part in (None, "acrylic"):
        _print_acrylic()


def _print_sizes(folder: Path) -> None:
    true, simpler = measured(folder)
    missed = {name: logs - true for name, logs in (simpler | simulated()).items()}
    print("rms factors of sizes over stockinette's; then each fabric's width and height over it")
    print(f"{'measured':48}{'':24}", *map(_shown, true))
    for name, logs in missed.items():
        print(f"{name:48}{factor(logs):24}", *map(_shown, logs + true))
    every = {name: logs for name, logs in missed.items() if np.isfinite(logs).all()}
    within = {name: logs for name, logs in every.items() if name not in (ALIKE, MIXTURE)}
    for what, candidates in (("any of the yarn's", within), ("or null or mixture", every)):
        choice = nested(np.array([*candidates.values()]), list(FABRICS))
        print(f"chosen on the other fabrics, {what:19}{factor(choice.missed)}")
        print("  chosen:", *sorted({[*candidates][index] for index in choice.chosen}), sep="; ")


def measured(folder: Path) -> tuple[Array, dict[str, Array]]:
    """Logarithms (fabrics, 2) of sizes over stockinette's: of the swatches, and of simpler models.

    The mixture is that of ``lace-acrylic``, whose pure fabrics are of the same yarn.
    """
    rows = {row["name"]: row for row in measured_swatches(folder)}
    sides = "relaxed_width_mm", "relaxed_height_mm"
    names = [STOCKINETTE, *(name for _, name in FABRICS.values())]
    logs = np.log([[float(rows[name][side]) for side in sides] for name in names])
    lace = material("lace-acrylic")
    charts = [StitchChart.parse(text) for text in ("K", *(text for text, _ in FABRICS.values()))]
    mixture = [Mixture.of(densities(chart).shares, lace).size_mm for chart in charts]
    mixed = np.log(mixture) - np.log(mixture[0])
    return logs[1:] - logs[0], {ALIKE: np.zeros_like(mixed[1:]), MIXTURE: mixed[1:]}


def simulated() -> dict[str, Array]:
    """Logarithms (fabrics, 2) of sizes over stockinette's, by candidate."""
    point = YARN_POINTS[0]
    sizes: dict[str, list[Array]] = {}
    needle = math.nan
    for text in ("K", *(text for text, _ in FABRICS.values())):
        chart = StitchChart.parse(text)
        loops = lengths(chart, point.loop_length_mm)
        laid = held_flat(chart, point.yarn, loops)
        needle = WIDE * laid.cell_course_mm if text == "K" else needle
        machine = off_machine(chart, point.yarn, loops, needle)
        for name, branch in (("today, with mirrors", Branch.MIRRORED), ("today, lowest", None)):
            cell = relax(chart, point.yarn, loops, branch=branch)
            sizes.setdefault(name, []).append(np.array([cell.cell_course_mm, cell.cell_wale_mm]))
        for name, candidate in CANDIDATES.items():
            sizes.setdefault(name, []).append(rest_size_mm(machine, candidate))
            if candidate.bending is None:
                sizes.setdefault(f"{name}, laid flat", []).append(rest_size_mm(laid, candidate))
    logs = {name: np.log(columns) for name, columns in sizes.items()}
    return {name: columns[1:] - columns[0] for name, columns in logs.items()}


def rest_size_mm(held: RelaxedRepeat, candidate: Candidate) -> Array:
    """(2,) size of a stitch at rest after a release; nan if it does not settle."""
    try:
        return Rest.held(held, candidate).release().size_mm.copy()
    except ArithmeticError:
        return np.full(2, np.nan)


def _print_acrylic() -> None:
    acrylic = material("acrylic")
    print("acrylic: sizes over knitted ones, and seed's stretch along the rows over the tested")
    for name, candidate in (ACRYLIC | CANDIDATES).items():
        shown, stretch = [], math.nan
        for fabric in Fabric:
            chart, record = StitchChart.of_fabric(fabric, 2, 2), acrylic.record(fabric)
            used = yarn_for(acrylic, chart)
            yarn = used.yarn
            yarn = replace(yarn, core_radius_mm=max(yarn.core_radius_mm, candidate.solid))
            laid = held_flat(chart, yarn, np.array([used.loop_length_mm]))
            needle = WIDE * laid.cell_course_mm
            machine = off_machine(chart, yarn, np.array([used.loop_length_mm]), needle)
            rest = Rest.held(machine, candidate).release()
            shown.append(np.log(rest.size_mm / [record.stitch_course_mm, record.stitch_wale_mm]))
            if fabric is Fabric.SEED:  # last, as a pull changes the state
                tested = free_strains_at_stress(record.law, Direction.COURSE, [STRESS])
                stretch = rest.pull(STRESS) / float(tested[0])
        print(f"{name:36}{factor(np.array(shown))} seed {stretch:.2f}", *map(_shown, shown))


def _shown(logs: Array) -> str:
    return "×".join(f"{size:.2f}" for size in np.exp(logs))


ALIKE, MIXTURE = "all like stockinette", "mixture of lace-acrylic's fabrics"
STRESS = 0.1
"""N/mm, at which seed's stretch is compared."""
ACRYLIC = {"solid fibres as a core": Candidate(FRICTION, solid=math.sqrt(0.5 / 1.18 / math.pi))}
"""A core as thick as 500 tex of acrylic fibres (as in the bending tests), of 1.18 g/cm³."""


if __name__ == "__main__":
    main()
