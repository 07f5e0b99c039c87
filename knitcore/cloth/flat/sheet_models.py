"""Energy models of the sheet, by name.

``published``
    The model of the paper's demonstration (Note 9): linearised strain and the stiffening energy
    truncated at quartic order. It never locks and is not objective.
``full``
    Fibre strains ``e_x = |F X| - 1`` and ``e_y = |F Y| - 1`` along the courses and wales and the
    change ``gamma`` of the angle between them, as an extensometer and a protractor would read
    them; the whole stiffening term in tension only, continued beyond 98 % of the lock-up by its
    osculating quadratic.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from knitcore.base.bounds import check_positive
from knitcore.base.errors import InputError
from knitcore.law.constitutive import ConstitutiveLaw, Symmetrisation

LAW = np.dtype([(f.name, float) for f in fields(ConstitutiveLaw) if f.name != "stiffness_yyxx"])
"""A symmetric law as the kernel reads it; attributes of ConstitutiveLaw by name."""


class EnergyModel(StrEnum):
    """The energy of a sheet."""

    PUBLISHED = "published"
    FULL = "full"


def energy_model(name: str) -> EnergyModel:
    """The energy of a name.

    Raises
    ------
    InputError
        If there is none.
    """
    try:
        return EnergyModel(name)
    except ValueError:
        known = " or ".join(EnergyModel)
        raise InputError("model", f"{name!r} is not known.", f"Use {known}.") from None


@dataclass(frozen=True)
class SheetModel:
    """An energy model and its assumptions.

    Parameters
    ----------
    energy : ``full`` or ``published``.
    coupling : symmetrisation rule; by default the model's own: ``geometric`` for ``full``,
        ``script`` for ``published``, because the published figures were made with it.
    shear_modulus : N/mm, replaces the laws' assumed shear modulus if given.

    Raises
    ------
    InputError
        If an option is out of range or not one of the model.
    """

    energy: EnergyModel = EnergyModel.FULL
    coupling: Symmetrisation | None = None
    shear_modulus: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "energy", energy_model(self.energy))
        if self.shear_modulus is not None:
            check_positive("shear_modulus", self.shear_modulus, "N/mm", "a stiffness")

    @property
    def rule(self) -> Symmetrisation:
        """The symmetrisation rule in force."""
        if self.coupling is not None:
            return self.coupling
        published = self.energy is EnergyModel.PUBLISHED
        return Symmetrisation.SCRIPT if published else Symmetrisation.GEOMETRIC

    def prepare(self, law: ConstitutiveLaw) -> ConstitutiveLaw:
        """The symmetric law, with this model's shear modulus.

        Raises
        ------
        InputError
            If the rule makes the stiffness indefinite.
        """
        if self.shear_modulus is not None:
            law = replace(law, shear_modulus=self.shear_modulus)
        try:
            return law.symmetrised(self.rule)
        except InputError:
            raise InputError(
                "coupling",
                f"the {self.rule} rule makes this law's stiffness indefinite.",
                "Use the geometric rule, which never does, or the full model.",
            ) from None

    def parameters(self, laws: Sequence[ConstitutiveLaw]) -> NDArray[np.void]:
        """Symmetric laws as records of :data:`LAW`, shape (laws,)."""
        constants = attrgetter(*(LAW.names or ()))
        return np.array([constants(self.prepare(law)) for law in laws], LAW)
