"""Sizes of lace and cables, and the form that is chosen on them."""

import os
from pathlib import Path

import numpy as np
import pytest

from knitcore import material
from knitcore.prediction.stitch_effects import FADE, StitchDensities, effects
from studies.other_stitches import CANDIDATES, FADES, IN_USE, KINDS_IN_USE, Compared, compared

FOLDER = os.environ.get("KNITCORE_STUDY_DATA")


@pytest.fixture(scope="module")
def invented() -> Compared:
    """Swatches without folds that yarn overs widen by 0.5 and crossings narrow by 0.6."""
    rng = np.random.default_rng(3)
    counts = rng.random((60, 2)) * [0.25, 0.3]
    made_of = [StitchDensities(yo, 0, 0, 0, pairs, pairs / 2) for yo, pairs in counts]
    flat, folds = rng.normal(0, 0.1, (2, 60, 2))
    true = flat + counts @ np.array([[0.5, -0.2], [-0.6, -0.5]])
    return Compared(
        [str(k) for k in range(60)],
        counts[:, 0] > 0.1,
        true + 0.01 * rng.standard_normal((60, 2)),
        flat + folds,
        flat,
        made_of,
    )


def test_the_form_that_made_the_swatches_is_chosen(invented: Compared) -> None:
    judged = invented.judged
    names = [list(CANDIDATES)[k] for k in judged.chosen]
    assert names.count("stitches, without folds") > 50
    assert np.sqrt((judged.missed**2).mean()) < 0.012


def test_constants_are_found_again(invented: Compared) -> None:
    constants = invented.fitted(CANDIDATES["stitches, without folds"], np.ones(60, dtype=bool))
    assert constants == pytest.approx(np.array([[0.5, -0.6], [-0.2, -0.5]]), abs=0.03)


def test_a_swatch_is_judged_without_its_texture(invented: Compared) -> None:
    true = invented.true.copy()
    true[0] += 1.0
    errors = invented._replace(true=true).missed(CANDIDATES["offset of its kind"])
    assert errors[0] == pytest.approx(invented.missed(CANDIDATES["offset of its kind"])[0] - 1.0)


@pytest.mark.skipif(FOLDER is None, reason="KNITCORE_STUDY_DATA names no folder of measured data")
def test_the_packaged_effects_are_those_of_the_study() -> None:
    swatches = compared(Path(str(FOLDER)), material("lace-acrylic"))
    constants = swatches.fitted(CANDIDATES[IN_USE], np.ones(len(swatches.lace), dtype=bool))
    for kind, of_size in zip(KINDS_IN_USE, constants.T, strict=True):
        assert effects()[kind].log_size == pytest.approx(of_size, abs=0.006)
    assert FADES[0] == FADE
    left = np.sqrt((swatches.judged.missed**2).mean(axis=0))
    assert effects()["left"].log_sd == pytest.approx(left, abs=0.0015)
