"""Rounds: when a sheet is settled."""

from dataclasses import replace

import numpy as np
import pytest

from knitcore.yarn.solve.rounds import WholeShape


def test_a_chart_is_settled_when_neither_energy_nor_size_changes_much() -> None:
    sheet = WholeShape(np.zeros((1, 12, 3)), np.ones(2), np.zeros((1, 1)), 0.3)
    assert sheet.change == np.inf
    after = replace(sheet, rounds=((0.4, 3.0, 2.0), (0.25, 3.0, 2.0), (0.2, 2.7, 2.1)))
    assert after.energy_change == pytest.approx(0.2)
    assert after.size_change == pytest.approx(0.1)
    assert after.may_fall == pytest.approx(0.6)
    assert replace(after, earlier=2).may_fall == pytest.approx(1.0)
    assert after.change == pytest.approx(0.2)
    narrower = replace(sheet, rounds=((0.2, 3.0, 2.0), (0.2, 2.7, 2.1)))
    assert narrower.energy_change == 0.0
    assert narrower.change == pytest.approx(0.01)  # a tenth of the size's
