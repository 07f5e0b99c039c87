"""Patterns of the house."""

from knitcore.chart import StitchChart
from knitcore.patterns import Pattern


def patterns() -> list[Pattern]:
    """Repeats for the shelf, as seen from the face."""
    waffle = StitchChart.parse("KKK/PPK/PPK")
    return [Pattern("waffle", "Waffle", waffle, "Purl pockets between knit lines.")]
