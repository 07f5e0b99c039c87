"""What never ranks first."""

import pytest

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.design.atlas_build import build_atlas
from knitcore.design.find import find_fabric
from knitcore.design.targets import Quantity, Target, WornTube
from knitcore.materials import material

REPEATS = [StitchChart.parse(text) for text in ("K", "K\nP", "KP", "KP\nPK", "KKP\nPPK")]


def test_a_fabric_whose_figures_contradict_each_other_never_ranks_first() -> None:
    """Acrylic garter course-wise, as published, is the stiffest: its width was misread."""
    atlas = build_atlas(material("acrylic:published"), REPEATS)
    limb = WornTube(200.0, 250.0)
    pressures = {}
    for quantity in (Quantity.PRESSURE_COURSE, Quantity.PRESSURE_WALE):
        target = Target(quantity, 1000.0, limb=limb)
        found = find_fabric([atlas], [target])
        pressures[quantity] = [c.values[target.label] for c in found.candidates]
        last = found.candidates[-1]
        if quantity is Quantity.PRESSURE_COURSE:
            assert last.repeat == "K/P"
            assert last.values[target.label] == max(pressures[quantity])
    wale = pressures[Quantity.PRESSURE_WALE]
    assert wale == sorted(wale, reverse=True)


def test_one_atlas_and_one_target_by_name_are_enough() -> None:
    atlas = build_atlas(material("acrylic"), [StitchChart.parse(t) for t in ("KKPP", "KP/PK")])
    target = Target("modulus_course", 0.04, tolerance=0.5)
    assert target == Target(Quantity.MODULUS_COURSE, 0.04, tolerance=0.5)
    alone, listed = find_fabric(atlas, target), find_fabric([atlas], [target])
    assert alone.to_dict() == listed.to_dict()
    with pytest.raises(InputError, match="quantity: 'modulus' is not known"):
        Target("modulus", 0.04)
