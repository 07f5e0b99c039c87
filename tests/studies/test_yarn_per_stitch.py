"""Masses of swatches and the rule for yarn in a stitch that is chosen on them."""

import os
from pathlib import Path

import numpy as np
import pytest

from knitcore.materials.yarn_per_stitch import change_rule
from studies.yarn_per_stitch import (
    ALIKE,
    BETWEEN,
    CANDIDATES,
    IN_USE,
    KNITDB,
    NUISANCES,
    PITCH_MM,
    Swatches,
    beside,
    between_rows,
    changes,
    feed,
    gap,
    lone,
    of_yarns,
    rms,
    weighed,
)

FOLDER = os.environ.get("KNITCORE_STUDY_DATA")


@pytest.fixture(scope="module")
def invented() -> Swatches:
    """Swatches whose changes along the row take a quarter of a stitch's yarn."""
    rng = np.random.default_rng(2)
    purl = rng.random((40, 90, 84)) < rng.random((40, 1, 1))
    lace = rng.random((40, len(NUISANCES)))
    mass = [4 * (1 + 0.25 * changes(chart)) for chart in purl] + lace @ [0.1, 0.0, 0.0, -0.1]
    return Swatches(purl, lace, mass * np.exp(0.002 * rng.standard_normal(40)))


def test_numbers_of_a_chart() -> None:
    purl = np.array([[c == "P" for c in row] for row in ("KPKKPPKK", "KPKKPPKK", "PPPPPPPP")])
    assert changes(purl) == pytest.approx(8 / 24)
    assert beside(purl) == pytest.approx(2 * 7 / 24)
    assert lone(purl) == pytest.approx(2 / 24)
    assert between_rows(purl) == pytest.approx(5 / 24)


def test_the_rule_behind_masses_is_recovered(invented: Swatches) -> None:
    (constant, sd), *_ = invented.constants(CANDIDATES[IN_USE])
    assert abs(constant - 0.25) < 3 * sd < 0.05
    _, (between, between_sd) = invented.constants(CANDIDATES[BETWEEN])
    assert abs(between) < 3 * between_sd
    assert rms(invented.judged().missed) < 1.005 < rms(invented.missed(CANDIDATES[ALIKE]))


def test_a_texture_is_the_same_from_both_sides(invented: Swatches) -> None:
    turned = invented._replace(purl=~invented.purl)
    assert turned.textures == invented.textures
    assert invented.with_more(turned).repeatability() < 1e-12


def test_a_gap_between_the_beds_and_its_feed() -> None:
    assert feed(1.0, 0.0) == 0.0
    assert gap(7.0 * feed(7.0)) == pytest.approx(PITCH_MM)


def test_the_constant_of_one_machine_is_nearer_to_other_yarns_than_none() -> None:
    """They also set the errors that the rule states."""
    errors, rule = of_yarns(), change_rule()
    assert rms(errors[KNITDB]) < rms(errors[ALIKE])
    assert np.log(rms(errors[KNITDB])) == pytest.approx(rule.log_sd, abs=0.005)
    assert np.log(rms(errors["garter and seed"])) == pytest.approx(rule.alike_log_sd, abs=0.006)


@pytest.mark.skipif(not FOLDER, reason="set KNITCORE_STUDY_DATA to the folder of public data")
def test_the_packaged_constant_is_that_of_the_swatches() -> None:
    plain, others = weighed(Path(FOLDER or ""))
    every, rule = plain.with_more(others), change_rule()
    (constant, sd), *_ = every.constants(CANDIDATES[IN_USE])
    assert (constant, sd) == pytest.approx((rule.per_change, rule.per_change_sd), abs=0.005)
    for swatches, other in ((plain, others), (others, plain)):  # constants of another kind
        missed, null = (
            swatches.missed(CANDIDATES[name], other.fitted(CANDIDATES[name]))
            for name in (IN_USE, ALIKE)
        )
        assert rms(missed) < rms(null)
    assert rms(every.judged().missed) < rms(every.missed(CANDIDATES[ALIKE]))
