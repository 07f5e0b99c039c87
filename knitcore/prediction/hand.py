"""Stretch of a chart at the pull of a hand, with a word and its place among the yarn's fabrics."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import Interval
from knitcore.prediction.prediction import Along, Prediction

PULLS_N_PER_MM = {"light": 0.03, "hand": 0.1, "firm": 0.3}
"""Forces per width of cloth: a hand that feels, that tries, and that tugs. The middle one is 10 N
on 10 cm."""

_WORDS = ((0.15, "firm"), (0.35, "slightly stretchy"), (0.70, "stretchy"))
_MOST = "very stretchy"
"""Words by the strain below which they are used."""
_ALIKE = 1.05
"""Fabrics whose stretches differ by less than this factor stretch alike."""


@dataclass(frozen=True)
class HandStretch:
    """Stretch along one direction at one pull.

    Attributes
    ----------
    strain : from the size at rest, the other direction free.
    strain_interval : its 90 % interval.
    word : from firm to very stretchy.
    more_than, less_than : pure fabrics of the same yarn that stretch less, and that stretch more.
    """

    strain: float
    strain_interval: Interval
    word: str
    more_than: tuple[Fabric, ...]
    less_than: tuple[Fabric, ...]


@dataclass(frozen=True)
class HandPull:
    """Stretch of a chart at one pull.

    Attributes
    ----------
    pull : light, hand or firm.
    n_per_mm : force per width, of :data:`PULLS_N_PER_MM`.
    course, wale : pulled along the rows, and along the columns.
    """

    pull: str
    n_per_mm: float
    course: HandStretch
    wale: HandStretch


def hand_pulls(
    material: Material, prediction: Prediction, pulls: Iterable[str] = tuple(PULLS_N_PER_MM)
) -> tuple[HandPull, ...]:
    """Tell how far a chart of a material stretches at pulls of :data:`PULLS_N_PER_MM`."""
    forces = {pull: PULLS_N_PER_MM[pull] for pull in pulls}
    along = {
        d: _stretches(prediction.along(d), material, d, tuple(forces.values())) for d in Direction
    }
    return tuple(
        HandPull(pull, force, along[Direction.COURSE][k], along[Direction.WALE][k])
        for k, (pull, force) in enumerate(forces.items())
    )


def _stretches(
    along: Along, material: Material, direction: Direction, forces: tuple[float, ...]
) -> list[HandStretch]:
    strains = along.strain(forces).tolist()
    low, high = (ends.tolist() for ends in along.strain_interval(forces))
    pure = {
        fabric: _strains(record.law, direction, forces)
        for fabric, record in material.fabrics.items()
    }
    return [
        HandStretch(
            strain,
            Interval(low[k], high[k]),
            next((word for below, word in _WORDS if strain < below), _MOST),
            tuple(fabric for fabric, of in pure.items() if strain > _ALIKE * of[k]),
            tuple(fabric for fabric, of in pure.items() if of[k] > _ALIKE * strain),
        )
        for k, strain in enumerate(strains)
    ]


@lru_cache(maxsize=512)
def _strains(
    law: ConstitutiveLaw, direction: Direction, forces: tuple[float, ...]
) -> tuple[float, ...]:
    """Strains of a pure fabric, which are the same for every chart of the yarn."""
    return tuple(free_strains_at_stress(law, direction, forces).tolist())
