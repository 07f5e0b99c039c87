"""Single points of stretch curves, where there is no whole pull: read in photos, or of a law."""

from dataclasses import dataclass

from knitcore.chart.fabric import Direction, Fabric


@dataclass(frozen=True)
class StretchPoint:
    """A point of the stretch curve, the width free, with standard deviations.

    Attributes
    ----------
    fabric, direction : of the pull.
    force_n_per_mm : force per clamped width in the middle of the swatch.
    strain_along, strain_along_sd : along the pull.
    strain_across, strain_across_sd : across it, below 0 where the swatch narrows.
    """

    fabric: Fabric
    direction: Direction
    force_n_per_mm: float
    strain_along: float
    strain_along_sd: float
    strain_across: float
    strain_across_sd: float
