"""Measures: further numbers of a chart of a material, which extensions compute."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.extensions import Group, offered, running
from knitcore.materials import Material
from knitcore.prediction.prediction import Prediction


@dataclass(frozen=True)
class Measure:
    """A number that an extension adds (:mod:`knitcore.extensions`).

    Attributes
    ----------
    identifier : name used in requests.
    unit : of its value; empty for a ratio.
    description : one sentence.
    of : computes it; may raise InputError if the material lacks something.
    """

    identifier: str
    unit: str
    description: str
    of: Callable[[StitchChart, Material, Prediction], float]

    def value(self, chart: StitchChart, material: Material, prediction: Prediction) -> float:
        """Its value, given the prediction for the chart of the material.

        Raises
        ------
        ExtensionError
            If it fails.
        """
        with running(Group.MEASURES, self.identifier):
            return float(self.of(chart, material, prediction))


def measure(identifier: str) -> Measure:
    """A measure by its name.

    Raises
    ------
    InputError
        If no extension offers it.

    Warns
    -----
    knitcore.extensions.ExtensionWarning
        Of every extension that cannot be used.
    """
    offers = offered(Group.MEASURES, Measure)
    if identifier not in offers:
        known = f"Use one of {', '.join(offers)}." if offers else "Install a package that has it."
        raise InputError("measures", f"there is no measure {identifier!r}.", known)
    return offers[identifier]
