"""Characterise a yarn: its pure fabrics, relaxed and stretched, at several stitch settings.

A plan names the fabrics and the loop lengths of each; every pair of fabric and loop length is a
task of one batch (:mod:`knitcore.base.batch`), for one yarn or many. The rows returned are the
table of the yarn; read along the settings they are the table of manufacturing tension (paper,
Supplementary Fig. 9: a machine that pulls harder puts less yarn into a stitch).
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from knitcore.base.arrays import sum_in_order
from knitcore.base.batch import BatchProgress, run_batch
from knitcore.base.errors import Cancelled, InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import Material
from knitcore.yarn.library.characterise import Document, RepeatTask, characterise_repeat, law_of
from knitcore.yarn.library.law_of_stretches import MAX_STRESS_N_PER_MM
from knitcore.yarn.library.yarns import yarn_for
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.study.relax import Branch

TENSIONS = (0.92, 1.0, 1.08)
"""Loop lengths of the tension table unless others are asked for, as fractions of the material's."""


@dataclass(frozen=True)
class StitchSetting:
    """One setting of the machine.

    Attributes
    ----------
    name : such as ``x1.08`` or ``11.5mm``.
    loop_length_mm : yarn in a stitch of each fabric.
    """

    name: str
    loop_length_mm: Mapping[Fabric, float]


@dataclass(frozen=True, repr=False)
class YarnPlan(Result):
    """The fabrics and settings to compute for a yarn.

    Attributes
    ----------
    identifier, name : of the resulting material.
    yarns : the yarn in each fabric.
    settings : at least one; ``reference`` is the index of the one that the material is made at.
    provenance : where the yarn's numbers come from, and whether they were ``estimated``.
    branch, convention, max_stress_n_per_mm : as in :class:`RepeatTask`.
    """

    identifier: str
    name: str
    yarns: Mapping[Fabric, YarnModel]
    settings: tuple[StitchSetting, ...]
    reference: int
    provenance: str
    estimated: bool
    branch: Branch = Branch.MIRRORED
    convention: Convention = Convention.PUBLISHED
    max_stress_n_per_mm: float = MAX_STRESS_N_PER_MM

    def tasks(self) -> Iterator[tuple[str, Fabric, StitchSetting, RepeatTask]]:
        """Every fabric at every setting, with a key for the batch."""
        for setting in self.settings:
            for fabric, yarn in self.yarns.items():
                task = RepeatTask(
                    StitchChart.of_fabric(fabric).repeat().key,
                    yarn, setting.loop_length_mm[fabric], self.branch, self.convention,
                    self.max_stress_n_per_mm,
                )  # fmt: skip
                label = f"{self.identifier.replace(':', '-')}.{fabric}.{task.loop_length_mm:.2f}"
                yield f"{label}.{task.key}", fabric, setting, task


def plan_for_material(
    material: Material,
    *,
    fabrics: Sequence[Fabric] = tuple(Fabric),
    loop_lengths_mm: Sequence[float] = (),
    tensions: Sequence[float] = TENSIONS,
    branch: Branch = Branch.MIRRORED,
    convention: Convention = Convention.PUBLISHED,
    max_stress_n_per_mm: float = MAX_STRESS_N_PER_MM,
) -> YarnPlan:
    """The plan for a material's yarn, at its own loop lengths or at given ones.

    Parameters
    ----------
    loop_lengths_mm : the same for all fabrics; the material is made at the one nearest to its
        own. If left out, `tensions` times each fabric's own length.

    Raises
    ------
    InputError
        If the material cannot give its yarn (see :func:`yarn_for`), or a number cannot be used.
    """
    used = {f: yarn_for(material, StitchChart.of_fabric(f)) for f in _distinct(fabrics)}
    own = {fabric: entry.loop_length_mm for fabric, entry in used.items()}
    if loop_lengths_mm:
        settings = _given_settings(loop_lengths_mm, tuple(used))
        mean = sum_in_order(own.values()) / len(own)
        lengths = [setting.loop_length_mm[next(iter(own))] for setting in settings]
    else:
        settings = tuple(
            StitchSetting(f"x{part:g}", {f: round(part * length, 6) for f, length in own.items()})
            for part in _increasing("tensions", tensions)
        )
        lengths, mean = sorted(tensions), 1.0
    return YarnPlan(
        identifier=f"{material.identifier.partition(':')[0]}-yarn-level",
        name=f"{material.name}, yarn level",
        yarns={fabric: entry.yarn for fabric, entry in used.items()},
        settings=settings,
        reference=_nearest(lengths, mean),
        provenance=next(iter(used.values())).provenance,
        estimated=any(entry.estimated for entry in used.values()),
        branch=branch,
        convention=convention,
        max_stress_n_per_mm=max_stress_n_per_mm,
    )


def plan_for_yarn(
    identifier: str,
    yarn: YarnModel,
    loop_lengths_mm: Sequence[float],
    *,
    fabrics: Sequence[Fabric] = tuple(Fabric),
    branch: Branch = Branch.MIRRORED,
    convention: Convention = Convention.PUBLISHED,
    max_stress_n_per_mm: float = MAX_STRESS_N_PER_MM,
) -> YarnPlan:
    """The plan for a yarn given by its parameters; the material is made at the middle length.

    Raises
    ------
    InputError
        If there is no loop length, or a number cannot be used.
    """
    if not loop_lengths_mm:
        raise InputError(
            "loop_lengths", "no length is given.", "Give one or more, in mm of yarn per stitch."
        )
    settings = _given_settings(loop_lengths_mm, tuple(_distinct(fabrics)))
    return YarnPlan(
        identifier=identifier,
        name=identifier,
        yarns=dict.fromkeys(_distinct(fabrics), yarn),
        settings=settings,
        reference=len(settings) // 2,
        provenance="parameters given by the user",
        estimated=False,
        branch=branch,
        convention=convention,
        max_stress_n_per_mm=max_stress_n_per_mm,
    )


_LAW = {
    "modulus_course_n_per_mm": "modulus_course",
    "modulus_wale_n_per_mm": "modulus_wale",
    "poisson_yx": "poisson_yx",
    "poisson_xy": "poisson_xy",
    "alpha_xx": "alpha_xx",
    "alpha_yy": "alpha_yy",
    "beta_xx_n_per_mm": "beta_xx",
    "beta_yy_n_per_mm": "beta_yy",
}
_ENERGY = ("energy_n_mm", "bending_share", "contact_share")
_RANGE = (
    "max_stress_n_per_mm",
    *("largest_strain_course", "largest_strain_wale"),
    *("rms_course_n_per_mm", "rms_wale_n_per_mm"),
)


@dataclass(frozen=True)
class YarnRow:
    """A pure fabric of a yarn at one setting.

    Attributes
    ----------
    fabric, setting, loop_length_mm, yarn : of the fabric.
    document : the result of :func:`characterise_repeat`.
    """

    fabric: Fabric
    setting: str
    loop_length_mm: float
    yarn: YarnModel
    document: Document

    @property
    def failure(self) -> str:
        """Why there is no relaxed stitch, empty if there is one."""
        return str(self.document.get("failure", ""))

    @property
    def law(self) -> ConstitutiveLaw | None:
        """The fitted law."""
        return law_of(self.document)

    @property
    def stitches_per_cm2(self) -> float | None:
        """Stitch density at rest."""
        if self.failure:
            return None
        area: float = self.document["cell_course_mm"] * self.document["cell_wale_mm"]
        return 100.0 / area

    def flat(self) -> dict[str, str | float | bool | None]:
        """One row of the table: sizes (mm), energy (N·mm), law (N/mm) with its range."""
        document, law = self.document, self.law
        span, curves = document.get("law_range") or {}, document.get("curves", {})
        row: dict[str, str | float | bool | None] = {
            "fabric": str(self.fabric),
            "setting": self.setting,
            "loop_length_mm": self.loop_length_mm,
            "stitch_course_mm": document.get("cell_course_mm"),
            "stitch_wale_mm": document.get("cell_wale_mm"),
            "stitches_per_cm2": self.stitches_per_cm2,
            **{name: document.get(name) for name in _ENERGY},
        }
        for direction in Direction:
            curve = curves.get(str(direction), {})
            overtakes = "contact_overtakes_at_strain"
            row[f"{overtakes}_{direction}"] = curve.get(overtakes)
            row[f"jumps_{direction}"] = len(curve["jumps"]) if curve else None
        row |= {
            **{name: getattr(law, field, None) for name, field in _LAW.items()},
            **{name: span.get(name) for name in _RANGE},
            "converged": document.get("converged"),
            "remark": self.failure or document.get("law_failure") or " ".join(document["notes"]),
        }
        return row


@dataclass(frozen=True, repr=False)
class YarnTable(Result):
    """A characterised yarn.

    Attributes
    ----------
    plan : the plan that was computed.
    rows : every fabric at every setting, setting by setting.
    """

    plan: YarnPlan
    rows: tuple[YarnRow, ...]

    def at(self, setting: str) -> dict[Fabric, YarnRow]:
        """The fabrics at one setting."""
        return {row.fabric: row for row in self.rows if row.setting == setting}

    def of(self, fabric: Fabric) -> list[YarnRow]:
        """One fabric by increasing loop length: the table of manufacturing tension."""
        return sorted(
            (row for row in self.rows if row.fabric is fabric), key=lambda row: row.loop_length_mm
        )


def characterise_yarns(
    plans: Sequence[YarnPlan],
    *,
    scheduler: str | None = None,
    workers: int | None = None,
    keep: Path | None = None,
    progress: Callable[[BatchProgress], None] | None = None,
    cancelled: Cancelled | None = None,
) -> tuple[YarnTable, ...]:
    """The tables of one yarn or several, as one batch.

    Parameters
    ----------
    scheduler, workers, keep, progress, cancelled : as in :func:`knitcore.base.batch.run_batch`.

    Raises
    ------
    InputError, CancelledError
        As :func:`knitcore.base.batch.run_batch`. A stitch that cannot be relaxed is a row with its
        reason, not an error.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> plan = plan_for_material(material("cotton"), fabrics=[Fabric.STOCKINETTE], tensions=[1.0])
    >>> (table,) = characterise_yarns([plan], workers=1)
    >>> 0.2 < table.rows[0].law.modulus_course < 0.5
    True
    """
    tasks = {key: task for plan in plans for key, _, _, task in plan.tasks()}
    batch = run_batch(
        characterise_repeat, tasks, scheduler=scheduler, workers=workers, keep=keep,
        progress=progress, cancelled=cancelled,
    )  # fmt: skip
    lost = {key: {"failure": reason} for key, reason in batch.failures.items()}
    documents = {**batch.results, **lost}
    return tuple(
        YarnTable(
            plan,
            tuple(
                YarnRow(fabric, setting.name, task.loop_length_mm, task.yarn, documents[key])
                for key, fabric, setting, task in plan.tasks()
            ),
        )
        for plan in plans
    )


def _distinct(fabrics: Sequence[Fabric]) -> list[Fabric]:
    if not fabrics:
        raise InputError("fabrics", "is empty.", "Name at least one pure fabric.")
    return list(dict.fromkeys(fabrics))


def _given_settings(
    loop_lengths_mm: Sequence[float], fabrics: Sequence[Fabric]
) -> tuple[StitchSetting, ...]:
    return tuple(
        StitchSetting(f"{length:g}mm", dict.fromkeys(fabrics, length))
        for length in _increasing("loop_lengths", loop_lengths_mm)
    )


def _increasing(field: str, values: Sequence[float]) -> list[float]:
    wrong = [value for value in values if not (math.isfinite(value) and value > 0)]
    if wrong or not values:
        raise InputError(
            field, f"{wrong[0] if wrong else 'nothing'} cannot be used.", "Give numbers above 0."
        )
    return sorted(set(values))


def _nearest(values: Sequence[float], target: float) -> int:
    return min(range(len(values)), key=lambda i: abs(values[i] - target))
