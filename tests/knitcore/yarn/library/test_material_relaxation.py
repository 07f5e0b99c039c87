"""Relaxations by the names of a chart and a material."""

import pytest

from knitcore import InputError, StitchChart, material, relax
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.library.yarns import yarn_for
from knitcore.yarn.loops.relaxed_stitches import RelaxedStitches


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


def test_a_chart_of_other_stitches_takes_their_path() -> None:
    mesh = relax(SymbolChart.parse("O/;KK"), "acrylic", history="agitated")
    assert isinstance(mesh, RelaxedStitches)
    assert "1.2 to 1.35" in mesh.notes[0]
    assert mesh.to_dict()["pattern"] == "O/;KK"
    plain = relax(SymbolChart.parse("K"), "acrylic", branch="mirrored")
    assert plain.energy_n_mm == relax("K", "acrylic", branch="mirrored").energy_n_mm
    with pytest.raises(InputError, match="branch: is for charts of knits and purls"):
        relax(SymbolChart.parse("O/;KK"), "acrylic", branch="free")
