"""Lowest shapes and bending, computed from the stored repeats."""

import json

import pytest

from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.library.store import document_of, stored_stitch
from scripts.from_store import FILES, StoredTask, bend, follow


@pytest.mark.parametrize("text", ["K", "P/K", pytest.param("KKKKP", marks=pytest.mark.slow)])
def test_a_stored_repeat_is_bent_as_stored(text):
    """Without its mirrors KKKKP goes to a shape that only a finer grid holds."""
    stored = stored_stitch(StitchChart.parse(text), "cotton")
    computed = bend(StoredTask.of(stored))
    expected = document_of(stored.bending)
    assert computed.keys() == expected.keys()
    for state in ("mirrored", "unmirrored")[: 1 if text == "K" else 2]:
        assert computed[state]["minimum"] is expected[state]["minimum"]
        for way in ("course", "wale"):
            assert computed[state][way] == pytest.approx(expected[state][way], rel=1e-3, abs=1e-6)


@pytest.mark.parametrize(("text", "minimum"), [("K", True), ("P/K", False)])
def test_a_stored_repeat_is_followed_as_stored(text, minimum):
    stored = stored_stitch(StitchChart.parse(text), "cotton")
    computed = follow(StoredTask.of(stored))
    assert computed["minimum"] is minimum
    assert stored.unmirrored.minimum is minimum
    assert computed["energy_n_mm"] == pytest.approx(stored.unmirrored.energy_n_mm, rel=1e-4)


def test_finished_repeats_are_not_followed_again(tmp_path):
    charts = {"acrylic": [StitchChart.parse("K")]}
    path, keep = tmp_path / "lowest.json", tmp_path / "keep"
    FILES["lowest"].write(path, charts, keep, workers=1)
    assert json.loads(path.read_text())["acrylic/K"]["minimum"]
    (kept,) = keep.iterdir()
    marked = {**json.loads(kept.read_text()), "cell_course_mm": 7.0}
    kept.write_text(json.dumps(marked))
    FILES["lowest"].write(path, charts, keep, workers=1)
    assert json.loads(path.read_text())["acrylic/K"]["cell_course_mm"] == 7.0
