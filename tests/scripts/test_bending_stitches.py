"""Bending the stored repeats."""

import pytest

from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.library.bending_table import document_of
from knitcore.yarn.library.store import stored_stitch
from scripts.bending_stitches import bend
from scripts.from_store import StoredTask


@pytest.mark.parametrize("text", ["K", "P/K", "KKKKP"])
def test_a_stored_repeat_is_bent_as_stored(text):
    """Without its mirrors KKKKP goes to a shape that only a finer grid holds."""
    stored = stored_stitch(StitchChart.parse(text), "cotton")
    found = bend(StoredTask.of(stored))
    expected = document_of(stored.bending)
    assert found.keys() == expected.keys()
    for state in ("mirrored", "unmirrored")[: 1 if text == "K" else 2]:
        assert found[state]["minimum"] is expected[state]["minimum"]
        for way in ("course", "wale"):
            assert found[state][way] == pytest.approx(expected[state][way], rel=1e-3, abs=1e-6)
