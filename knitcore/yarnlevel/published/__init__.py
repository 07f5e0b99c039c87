"""Branch ``published``: the paper's own description of a stitch, eight Bezier curves in a row."""

from knitcore.yarnlevel.published.relax import relax_published
from knitcore.yarnlevel.published.slide import SlideQuenching
from knitcore.yarnlevel.published.sweep import stress_from_energies, sweep_published

__all__ = ["SlideQuenching", "relax_published", "stress_from_energies", "sweep_published"]
