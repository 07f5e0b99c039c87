"""Following the stored repeats without their mirrors."""

import json

import pytest

from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.library.store import stored_stitch
from scripts.from_store import StoredTask
from scripts.lowest_stitches import LOWEST, follow


@pytest.mark.parametrize(("text", "minimum"), [("K", True), ("P/K", False)])
def test_a_stored_repeat_is_followed_as_stored(text, minimum):
    stored = stored_stitch(StitchChart.parse(text), "cotton")
    found = follow(StoredTask.of(stored))
    assert found["minimum"] is minimum
    assert stored.unmirrored.minimum is minimum
    assert found["energy_n_mm"] == pytest.approx(stored.unmirrored.energy_n_mm, rel=1e-4)


def test_finished_repeats_are_not_followed_again(tmp_path):
    charts = {"acrylic": [StitchChart.parse("K")]}
    path, keep = tmp_path / "lowest.json", tmp_path / "keep"
    LOWEST.write(path, charts, keep, workers=1)
    assert json.loads(path.read_text())["acrylic/K"]["minimum"]
    (kept,) = keep.iterdir()
    marked = {**json.loads(kept.read_text()), "cell_course_mm": 7.0}
    kept.write_text(json.dumps(marked))
    LOWEST.write(path, charts, keep, workers=1)
    assert json.loads(path.read_text())["acrylic/K"]["cell_course_mm"] == 7.0
