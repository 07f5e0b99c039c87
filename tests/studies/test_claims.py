"""The outer loop of claims, and the table of verdicts that it fills."""

import re
from pathlib import Path

import numpy as np
import pytest

from studies.claims import Basis, Claim, nested

EVIDENCE = Path(__file__).parents[2] / "docs" / "evidence.md"


def test_a_choice_among_guesses_is_not_judged_by_its_luck() -> None:
    rng = np.random.default_rng(4)
    names = [str(i) for i in range(12)]
    lucky, judged = [], []
    for _ in range(300):  # none of the guesses knows anything; their squared error is 2
        missed = np.sqrt(2) * rng.normal(size=(40, 12))
        lucky.append((missed**2).mean(axis=1).min())
        judged.append((nested(missed, names).missed ** 2).mean())
    assert np.mean(lucky) < 1.2
    assert np.mean(judged) == pytest.approx(2.0, rel=0.1)


def test_swatches_of_one_texture_do_not_choose_for_each_other() -> None:
    missed = [[0.0, 0.0, 0.6], [0.5, 0.5, 0.5]]  # the first knows the texture that it has twice
    assert nested(missed, ["rib", "rib", "seed"]).missed.tolist() == [0.5, 0.5, 0.6]
    assert nested(missed, ["a", "b", "c"]).missed.tolist() == [0.0, 0.0, 0.6]
    with pytest.raises(ValueError, match="at least two"):
        nested(missed, ["rib", "rib", "rib"])


def test_a_verdict_has_three_words_at_most() -> None:
    with pytest.raises(ValueError, match="three words"):
        Claim("size", "swatches", Basis.IN_SAMPLE, "1.1", "", "", "rough but good enough")


def verdicts() -> list[list[str]]:
    """Cells of the rows of the table on top of the page."""
    table = EVIDENCE.read_text(encoding="utf-8").partition("\n## ")[0]
    rows = [line.strip("| ").split(" | ") for line in table.splitlines() if line.startswith("| ")]
    return rows[1:]


def test_nothing_loses_to_its_null() -> None:
    judged = 0
    for _, _, basis, figure, null, _, _ in verdicts():
        assert basis in {*map(str, Basis)}
        if basis == Basis.NESTED:
            better, worse = (re.findall(r"\d\.\d+", cell) for cell in (figure, null))
            assert float(better[0]) < min(map(float, worse))
            judged += 1
    assert judged > 0
