"""An atlas that several tests search, built when the first of them asks: not while collecting."""

from functools import cache

from knitcore import material
from knitcore.chart.repeats import repeats_up_to
from knitcore.design.atlas import Atlas
from knitcore.design.atlas_build import build_atlas

REPEATS = repeats_up_to(2, 3)


@cache
def acrylic_atlas() -> Atlas:
    """The repeats of up to 2 x 3 stitches in acrylic."""
    return build_atlas(material("acrylic"), REPEATS)
