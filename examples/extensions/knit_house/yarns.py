"""Yarns of the house, estimated from what its lab measured of them.

The bending moduli and loop lengths are made up for the example.
"""

from knitcore.chart.fabric import Fabric
from knitcore.materials import Material
from knitcore.materials.estimate.estimate import estimate_yarn
from knitcore.materials.estimate.estimated_material import estimated_material

LAB = {"house-dk": ("House DK", 0.05, 11.5), "house-sport": ("House Sport", 0.03, 10.0)}
"""Name, bending modulus in N·mm², mm of yarn per stitch."""


def materials() -> list[Material]:
    """The house's yarns."""
    return [_material(identifier, *measured) for identifier, measured in LAB.items()]


def _material(identifier: str, name: str, bending_n_mm2: float, loop_mm: float) -> Material:
    estimate = estimate_yarn(bending_n_mm2, dict.fromkeys(Fabric, loop_mm))
    return estimated_material(estimate, identifier, name)
