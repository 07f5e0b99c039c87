"""Images of a fabric relax to the same shape."""

import numpy as np
import pytest

from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.solve.images import turned
from knitcore.yarn.study.relax import relax

IMAGES = {
    "shifted": lambda purl: np.roll(purl, (1, 1), axis=(0, 1)),
    "mirrored": lambda purl: purl[:, ::-1],
    "from the back": lambda purl: ~purl,
}


@pytest.mark.parametrize("given", [{}, {"branch": "mirrored"}, {"cell_course_mm": 4.0}])
@pytest.mark.parametrize("text", ["KPP", "KP/PP/KK"])
@pytest.mark.parametrize("image", IMAGES)
def test_an_image_has_the_shape_of_the_chart(text, image, given):
    entry = sample("cotton", "rib")
    chart = StitchChart.parse(text)
    other = StitchChart(IMAGES[image](chart.purl))
    one = relax(chart, entry.yarn, entry.loop_length_mm, **given)
    two = relax(other, entry.yarn, entry.loop_length_mm, **given)
    assert two.chart.repeat() == other.repeat()
    assert two.energy_n_mm == pytest.approx(one.energy_n_mm, rel=1e-6)
    assert two.cell_course_mm == pytest.approx(one.cell_course_mm, rel=1e-4)
    assert two.cell_wale_mm == pytest.approx(one.cell_wale_mm, rel=1e-4)
    assert two.force_n == pytest.approx(one.force_n, abs=1e-4)
    assert two.minimum == one.minimum
    assert (two.mirrored is None) == (one.mirrored is None)


def test_the_yarn_of_a_mirrored_image_runs_the_other_way():
    entry = sample("acrylic", "rib")
    chart = StitchChart.parse("KKP/KPP")
    one = relax(chart, entry.yarn, entry.loop_length_mm, branch="free")
    two = turned(one, StitchChart(chart.purl[:, ::-1]))
    wide = 3 * one.cell_course_mm
    here, there = one.centre_lines[0], two.centre_lines[0, ::-1] * (-1.0, 1.0, 1.0)
    np.testing.assert_allclose(there + np.array([wide, 0.0, 0.0]), here, atol=1e-2)


def test_another_fabric_is_no_image():
    entry = sample("acrylic", "rib")
    rib = relax(StitchChart.parse("KP"), entry.yarn, entry.loop_length_mm, branch="mirrored")
    with pytest.raises(ValueError, match="no image"):
        turned(rib, StitchChart.parse("K\nP"))
