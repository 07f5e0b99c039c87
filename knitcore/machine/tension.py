"""The tension of a loop that is transferred: the yarn it needs, has and can borrow.

Between the hooks of two neighbouring loops lies the yarn of one stitch, l. Take-down pulls it into
a V: with the hooks D apart and a force f on each loop, its tension is

    T = f / (2 sqrt(1 - (D / l)²)),

which grows without limit as the V becomes straight. D is the distance of the hooks, along the beds
and across the gap between them, and a length w is bound where the yarn turns around hooks and old
loops. When a transfer or a racking pulls two hooks apart, the link takes yarn from its neighbours
("robbing back"), against friction: the k-th neighbour feels exp(-k μ θ) of the tension (capstan),
and gives what its own V has to spare at that tension. What is still lacking stretches the yarn,
T = EA × strain. The balance of yarn,

    l(T) - (L - w) (1 + T / EA) = Σ yarn that the neighbours give at T exp(-k μ θ),

has one solution for T. Sources: the form of robbing back is that of J. J. F. Knapton and D. L.
Munden, "A study of the mechanism of loop formation on weft-knitting machinery", Textile Research
Journal 36 (1966); friction of yarn is :func:`knitcore.yarn.library.yarns.yarn_friction`. Strength
and stretch of yarns, the gap, the take-down and the angle of wrap are stated guesses
(:data:`GUESSES`), so tensions have wide 90 % intervals, which come from drawing all of them. A
machine's profile may give gap and take-down, and :class:`LoopYarn` the yarn's strength.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.machine.profile import MachineProfile
from knitcore.machine.program_passes import Link, PulledLink, pulls_of, read_passes
from knitcore.machine.transfers import LoopMove, TransferPlan, plan_transfers
from knitcore.materials import Interval, Material
from knitcore.materials.estimate.without_tester import COUNTED_TEX
from knitcore.materials.yarn_per_stitch import LOOP_LENGTH_LOG_SD
from knitcore.yarn.library.yarns import yarn_friction

TENACITY_AND_STRETCH = {
    "cotton": (0.14, 0.07),
    "nylon": (0.25, 0.25),
    "polyamide": (0.25, 0.25),
    "polyester": (0.25, 0.15),
    "acrylic": (0.12, 0.18),
    "viscose": (0.11, 0.13),
    "rayon": (0.11, 0.13),
    "bamboo": (0.11, 0.13),
    "silk": (0.18, 0.15),
    "wool": (0.06, 0.20),
    "mohair": (0.06, 0.20),
    "cashmere": (0.05, 0.20),
    "alpaca": (0.06, 0.20),
}
"""Breaking force, N/tex, and strain of spun yarns: stated guesses, about half the strength of the
fibres in Morton and Hearle, "Physical Properties of Textile Fibres". EA is their ratio."""
_UNLISTED = (0.10, 0.12)
GUESSES = (
    "stated guesses: strength and stretch by fibre (half the fibre's strength), 0.7 of it in a "
    "loop; gap between the beds 1.1 needles; take-down 0.1 N a loop; angle of wrap 2.5 π a loop"
)
LOOP_EFFICIENCY = 0.7
"""Strength of yarn around a hook, over that of straight yarn."""
GAP_PITCHES = 1.1
"""Distance of facing hooks across the gap, in distances of needles."""
HOOK_PITCHES = 0.17
"""Thickness of a hook's wire, in distances of needles."""
TAKE_DOWN_N = 0.1
WRAP_RAD = 2.5 * math.pi
"""Angle that the yarn of a stitch turns: half a circle around its hook, the rest at old loops."""
TIGHT_DENSITY = 0.8e-3
"""Density of yarn under tension, g/mm³."""
WOUND_DENSITY = 0.12e-3
"""Density of yarn with its diameter by wraps, g/mm³: the library's three counted yarns."""
LOG_SDS = {"loop": LOOP_LENGTH_LOG_SD, "gap": 0.2, "take_down": 0.4, "strength": 0.3, "wrap": 0.15}
SAMPLES = 400
BREAK_CHANCE = 0.1
"""A chance of breaking that counts as a break: a program repeats its tightest pull many times."""
BREAK_RISK = 0.02
"""A chance of breaking that calls for less racking in more passes, or for a slow carriage."""
MOST_SPARE_NEEDLES = 3
"""Columns that neighbours may be pulled apart for a while, where their yarn stands it."""
_STEPS = 50


class Verdict(StrEnum):
    """How a loop stands a transfer."""

    FREE = "free"
    TIGHT = "tight"
    BREAKS = "would break"


@dataclass(frozen=True)
class LoopYarn:
    """The yarn of the loops that a machine holds.

    Attributes
    ----------
    loop_length_mm : yarn of a stitch.
    tex : linear density, g/km.
    breaking_force_n : straight.
    axial_stiffness_n : EA, force over strain up to the break.
    friction, friction_interval : of yarn on yarn and hooks, with its 90 % interval.
    source : of these, in words.
    """

    loop_length_mm: float
    tex: float
    breaking_force_n: float
    axial_stiffness_n: float
    friction: float
    friction_interval: tuple[float, float]
    source: str = GUESSES

    @property
    def diameter_mm(self) -> float:
        """Diameter under tension."""
        return math.sqrt(4 * self.tex * 1e-6 / (math.pi * TIGHT_DENSITY))

    @classmethod
    def of(
        cls,
        material: Material,
        *,
        loop_length_mm: float | None = None,
        linear_density_tex: float | None = None,
    ) -> "LoopYarn":
        """The yarn of a material.

        Parameters
        ----------
        material : its fibre gives strength and friction.
        loop_length_mm : the mean of the material's fabrics if left out.
        linear_density_tex : counted, or guessed from the diameter, if left out.

        Raises
        ------
        InputError
            If neither the material nor the caller knows a loop length or a linear density.
        """
        lengths = [r.loop_length_mm for r in material.fabrics.values() if r.loop_length_mm]
        if loop_length_mm is None:
            if not lengths:
                problem = f"{material.identifier} has no loop length."
                remedy = "Unravel ten stitches of a swatch, and add loop_length_mm."
                raise InputError("material", problem, remedy)
            loop_length_mm = sum(lengths) / len(lengths)
        tex = linear_density_tex or COUNTED_TEX.get(material.sample)
        if tex is None:
            if material.yarn.diameter_mm is None:
                problem = f"{material.identifier} has no diameter to guess its linear density from."
                raise InputError("linear_density_tex", problem, "Give it, in tex (g/km).")
            tex = WOUND_DENSITY * math.pi / 4 * material.yarn.diameter_mm**2 * 1e6
        fibre = material.yarn.fibre.lower()
        named = [(fibre.find(name), name) for name in TENACITY_AND_STRETCH if name in fibre]
        tenacity, strain = TENACITY_AND_STRETCH[min(named)[1]] if named else _UNLISTED
        friction = yarn_friction(material)
        return cls(
            loop_length_mm,
            tex,
            tenacity * tex,
            tenacity * tex / strain,
            friction.coefficient,
            (friction.low, friction.high),
        )


@dataclass(frozen=True)
class LoopTension:
    """A pulled link of yarn.

    Attributes
    ----------
    needles, across : between its hooks.
    tension_n, tension_interval_n : the middle, and a 90 % interval.
    needed_mm, own_mm : yarn that the way needs, and that the stitch has.
    stretch : strain of the yarn.
    break_chance : of breaking.
    verdict : free if its own yarn reaches; would break from :data:`BREAK_CHANCE` on.
    """

    needles: float
    across: bool
    tension_n: float
    tension_interval_n: Interval
    needed_mm: float
    own_mm: float
    stretch: float
    break_chance: float
    verdict: Verdict

    def __str__(self) -> str:
        low, high = self.tension_interval_n
        needles = "1 needle" if self.needles == 1 else f"{self.needles:g} needles"
        chance = f", breaks with a chance of {self.break_chance:.0%}" * (self.break_chance >= 0.01)
        return (
            f"{self.verdict}, {needles} apart{' across the gap' * self.across}, "
            f"{_shown(self.tension_n)} N ({_shown(low)} to {_shown(high)}){chance}"
        )

    def to_dict(self) -> dict[str, Any]:
        """Collect the figures by name."""
        return {
            "needles": self.needles,
            "across": self.across,
            "tension_n": self.tension_n,
            "tension_interval_n": list(self.tension_interval_n),
            "needed_mm": self.needed_mm,
            "own_mm": self.own_mm,
            "stretch": self.stretch,
            "break_chance": self.break_chance,
            "verdict": str(self.verdict),
        }


def _shown(value: float) -> str:
    return f"{float(f'{value:.2g}'):g}"


def loop_tension(pull: PulledLink, yarn: LoopYarn, machine: MachineProfile) -> LoopTension:
    """The tension of a pulled link of yarn.

    Examples
    --------
    >>> from knitcore.machine.profile import profile
    >>> from knitcore.materials import material
    >>> rest = Link(1, False, 1)
    >>> pull = PulledLink(Link(1, True, 1), (rest,) * 3, (rest,) * 3)
    >>> yarn = LoopYarn.of(material("acrylic"), loop_length_mm=11.3)
    >>> loop_tension(pull, yarn, profile("kniterate")).verdict
    <Verdict.FREE: 'free'>
    """
    hooks = _Hooks(
        machine.pitch_mm, machine.needles_per_column, machine.bed_gap_mm, machine.take_down_n
    )
    return _loop_tension(pull, yarn, hooks)


class _Hooks(NamedTuple):
    """The figures of a machine that a loop feels; None is guessed."""

    pitch_mm: float
    per_column: int
    gap_mm: float | None
    take_down_n: float | None


@lru_cache(maxsize=10_000)
def _loop_tension(pull: PulledLink, yarn: LoopYarn, hooks: _Hooks) -> LoopTension:
    draws = _draws(yarn, hooks)
    tension = draws.tension(pull)
    middle = float(np.median(tension))
    needed, own = float(np.median(draws.span(pull.link))), float(np.median(draws.yarn(pull.link)))
    chance = float(np.mean(tension >= draws.strength))
    verdict = (
        Verdict.BREAKS
        if chance >= BREAK_CHANCE
        else Verdict.TIGHT
        if needed > own
        else Verdict.FREE
    )
    low, high = np.quantile(tension, (0.05, 0.95))
    bound = draws.bound_mm
    return LoopTension(
        pull.link.needles,
        pull.link.across,
        middle,
        Interval(float(low), float(high)),
        needed + bound,
        own + bound,
        middle / yarn.axial_stiffness_n,
        chance,
        verdict,
    )


class _Draws:
    """Draws of everything uncertain, (samples,) each."""

    def __init__(self, yarn: LoopYarn, hooks: _Hooks) -> None:
        noise = dict(
            zip(LOG_SDS, np.random.default_rng(0).standard_normal((5, SAMPLES)), strict=True)
        )
        scale = {name: np.exp(sd * noise[name]) for name, sd in LOG_SDS.items()}
        pitch_mm = hooks.pitch_mm
        self._pitch, self._columns = pitch_mm, hooks.per_column
        self._length = yarn.loop_length_mm * scale["loop"]
        gap = GAP_PITCHES * pitch_mm * scale["gap"]
        self._gap = gap if hooks.gap_mm is None else np.full(SAMPLES, hooks.gap_mm)
        force = TAKE_DOWN_N * scale["take_down"]
        self._pull = (
            force if hooks.take_down_n is None else np.full(SAMPLES, hooks.take_down_n)
        ) / 2
        low, high = yarn.friction_interval
        spread = math.log(high / low) / (2 * 1.645)
        other = np.random.default_rng(1).standard_normal(SAMPLES)
        friction = yarn.friction * np.exp(spread * other)
        self._kept = np.exp(-friction * WRAP_RAD * scale["wrap"])
        self._stiffness = yarn.axial_stiffness_n * scale["strength"]
        self.strength = yarn.breaking_force_n * LOOP_EFFICIENCY * scale["strength"]
        diameter, hook = yarn.diameter_mm, HOOK_PITCHES * pitch_mm
        self.bound_mm = (math.pi / 2 - 1) * (hook + diameter) + 2 * diameter

    def span(self, link: Link) -> Array:
        """Distance of the hooks, mm."""
        along = link.needles * self._pitch
        return np.asarray(np.hypot(along, self._gap * link.across))

    def yarn(self, link: Link) -> Array:
        """Yarn that can lie straight between the hooks, mm."""
        more = max(link.laid - self._columns, 0) * self._pitch
        return np.asarray(np.maximum(self._length + more - self.bound_mm, 0.1))

    def _path(self, link: Link, tension: Array) -> Array:
        """The length of the V at a tension, mm; without limit where take-down wins."""
        sine = np.clip(self._pull / tension, 0, 1 - 1e-9)
        return np.asarray(self.span(link) / np.sqrt(1 - sine**2))

    def _given(self, links: Sequence[Link], tension: Array) -> Array:
        total, on = np.zeros(SAMPLES), np.ones(SAMPLES, dtype=bool)
        for link in links:
            tension = tension * self._kept
            spare = self.yarn(link) - self._path(link, tension)
            on &= (spare > 0) & (tension > self._pull)
            total += np.where(on, spare, 0)
        return total

    def tension(self, pull: PulledLink) -> Array:
        """Bisect the balance of yarn, N."""
        low, high = np.log(self._pull * (1 + 1e-6)), np.full(SAMPLES, math.log(1e5))
        for _ in range(_STEPS):
            middle = (low + high) / 2
            tension = np.exp(middle)
            own = self.yarn(pull.link) * (1 + tension / self._stiffness)
            lacking = self._path(pull.link, tension) - own
            lacking -= self._given(pull.left, tension) + self._given(pull.right, tension)
            low = np.where(lacking > 0, middle, low)
            high = np.where(lacking > 0, high, middle)
        return np.asarray(np.exp((low + high) / 2))


_draws = lru_cache(maxsize=10)(_Draws)


def _tightest(
    pulls: frozenset[PulledLink], yarn: LoopYarn, machine: MachineProfile
) -> LoopTension | None:
    tensions = (loop_tension(pull, yarn, machine) for pull in pulls)
    return max(tensions, key=lambda of: (of.break_chance, of.tension_n), default=None)


@dataclass(frozen=True)
class PassTension:
    """A pass of transfers and its tightest loop.

    Attributes
    ----------
    number : of the pass, from 1, among all passes of the program.
    line : of the program.
    rack : in needles.
    transfers : loops that it moves.
    tightest : None if no loop is pulled.
    pulls : on its loops.
    """

    number: int
    line: int
    rack: float
    transfers: int
    tightest: LoopTension | None
    pulls: frozenset[PulledLink] = field(default=frozenset(), repr=False, compare=False)

    def to_dict(self) -> dict[str, Any]:
        """Collect the figures by name."""
        tightest = self.tightest and self.tightest.to_dict()
        figures = {name: value for name, value in vars(self).items() if name != "pulls"}
        return {**figures, "tightest": tightest}


def pass_tensions(
    program: str,
    yarn: LoopYarn,
    machine: MachineProfile,
    looser: Mapping[float, LoopYarn] | None = None,
) -> tuple[PassTension, ...]:
    """The passes of a program that transfer, each with its tightest loop.

    ``looser`` has the yarn of loops that another stitch number than the piece's made.
    """
    others = looser or {}
    return tuple(
        PassTension(
            number,
            step.line,
            step.rack,
            step.loops,
            _tightest(step.pulls, others.get(step.number or 0.0, yarn), machine),
            step.pulls,
        )
        for number, step in enumerate(read_passes(program).passes, 1)
        if step.kind == "transfer"
    )


def tightest_of(passes: Sequence[PassTension]) -> PassTension | None:
    """The pass with the tightest loop."""
    pulled = [step for step in passes if step.tightest]
    return max(
        pulled,
        key=lambda of: (of.tightest.break_chance, of.tightest.tension_n) if of.tightest else (0, 0),
        default=None,
    )


def plan_tension(plan: TransferPlan, yarn: LoopYarn, machine: MachineProfile) -> LoopTension | None:
    """The tightest loop of a plan; None if no loop is pulled."""
    return _tightest(_plan_pulls(plan), yarn, machine)


def _plan_pulls(plan: TransferPlan) -> frozenset[PulledLink]:
    starts = [move.start.number for move in plan.moves]
    laid = [abs(b - a) for a, b in pairwise(starts)]
    racks = [step.rack for step in plan.passes]
    states = [*zip(plan.places, racks, strict=False), *zip(plan.places[1:], racks, strict=True)]
    pulls = (pulls_of(places, laid, rack) for places, rack in [*states, (plan.places[-1], 0)])
    return frozenset[PulledLink]().union(*pulls)


@dataclass(frozen=True)
class SafePlan:
    """A plan with its tightest loop, and what was done to spare it, in words."""

    plan: TransferPlan
    tightest: LoopTension | None
    note: str = ""

    def to_dict(self) -> dict[str, Any]:
        """Collect the plan, its tightest loop and the note."""
        tightest = self.tightest and self.tightest.to_dict()
        return {**self.plan.to_dict(), "tightest": tightest, "note": self.note}


def plan_safely(moves: Sequence[LoopMove], yarn: LoopYarn, machine: MachineProfile) -> SafePlan:
    """Plan transfers that the yarn stands, in the fewest passes that do not strain it.

    Raises
    ------
    InputError
        If the machine has one bed, or every plan would break the yarn; the remedy is then the loop
        length that stands it.
    """
    if machine.beds == 1:
        raise InputError(
            "machine",
            f"{machine.name} has no second bed to transfer to.",
            "Move the loops by hand with a transfer tool, or choose a machine with two beds.",
        )
    plans = sorted(
        (SafePlan(plan, plan_tension(plan, yarn, machine)) for plan in _plans(moves, machine)),
        key=lambda of: (len(of.plan.passes), of.plan.most_rack),
    )
    fewest = len(plans[0].plan.passes)
    for safe in plans:
        if safe.tightest is None or safe.tightest.break_chance < BREAK_RISK:
            passes = len(safe.plan.passes)
            staged = f"Staged in {passes} passes instead of {fewest} to spare the yarn."
            return replace(safe, note=staged if passes > fewest else "")
    best = min(plans, key=lambda of: of.tightest.break_chance if of.tightest else 0.0)
    pulls = _plan_pulls(best.plan)
    if (refusal := _refusal(best.tightest, pulls, yarn, machine)) is not None:
        raise refusal
    return replace(best, note="Slow this transfer down and watch it: the yarn may break.")


def breaking(step: PassTension, yarn: LoopYarn, machine: MachineProfile) -> InputError | None:
    """The refusal of a pass that would break the yarn; None if it may be made."""
    return _refusal(step.tightest, step.pulls, yarn, machine)


def _refusal(
    tightest: LoopTension | None,
    pulls: frozenset[PulledLink],
    yarn: LoopYarn,
    machine: MachineProfile,
) -> InputError | None:
    if tightest is None or tightest.verdict is not Verdict.BREAKS:
        return None
    enough = _loop_that_stands(pulls, yarn, machine)
    return InputError(
        "transfers",
        f"tightest loop: {tightest}; the yarn holds about "
        f"{LOOP_EFFICIENCY * yarn.breaking_force_n:.2g} N in a loop.",
        f"Knit with loops of {enough:.1f} mm instead of {yarn.loop_length_mm:.1f} mm (a larger "
        "stitch number), take a stronger yarn, or a machine with needles closer together.",
    )


def _plans(moves: Sequence[LoopMove], machine: MachineProfile) -> list[TransferPlan]:
    """Plans with more and less yarn to spare between neighbours, and with more and less racking.

    Raises
    ------
    InputError
        If there is none.
    """
    plans: list[TransferPlan] = []
    for spare_needles in range(MOST_SPARE_NEEDLES * machine.needles_per_column, 0, -1):
        for most_rack in range(int(machine.racking.most_needles), -1, -1):
            try:
                plans.append(
                    plan_transfers(moves, most_rack=most_rack, spare_needles=spare_needles)
                )
            except InputError:
                if not plans:
                    raise
                break
    return plans


def _loop_that_stands(
    pulls: frozenset[PulledLink], yarn: LoopYarn, machine: MachineProfile
) -> float:
    length = yarn.loop_length_mm
    for _ in range(20):
        length *= 1.05
        tightest = _tightest(pulls, replace(yarn, loop_length_mm=length), machine)
        if tightest is None or tightest.break_chance < BREAK_RISK:
            break
    return length
