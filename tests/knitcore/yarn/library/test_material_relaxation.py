"""Relaxations by the names of a chart and a material."""

import pytest

from knitcore import InputError, StitchChart, material, relax
from knitcore.yarn.library.yarns import yarn_for


def test_a_material_gives_yarn_and_loop_length() -> None:
    used = yarn_for(material("acrylic"), StitchChart.parse("K"))
    by_name = relax("K", "acrylic", branch="mirrored")
    by_yarn = relax(StitchChart.parse("K"), used.yarn, used.loop_length_mm, branch="mirrored")
    assert by_name.energy_n_mm == by_yarn.energy_n_mm
    assert by_name.yarn == used.yarn
    assert len(repr(by_name)) < 800
    longer = relax("K", "acrylic", used.loop_length_mm * 1.1, branch="mirrored")
    assert longer.cell_course_mm > by_name.cell_course_mm


def test_what_is_missing_is_named() -> None:
    used = yarn_for(material("acrylic"), StitchChart.parse("K"))
    with pytest.raises(InputError, match="material: is missing"):
        relax("K")
    with pytest.raises(InputError, match="loop_length_mm: is missing"):
        relax("K", used.yarn)
    with pytest.raises(InputError, match="is of type float"):
        relax("K", 10.5)
