"""Sizes of charts with lace, cables, slips and tucks."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore import material, predict
from knitcore.chart.fabric import Direction
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.prediction.prediction import Prediction, Source
from knitcore.prediction.size import RelaxedSize
from knitcore.prediction.stitch_effects import StitchDensities

ACRYLIC = material("acrylic")
CHARTS = ["KKKK;O/\\O", "P[2/2R]P;PKKKKP;PKKKKP;PKKKKP", "VK;KK;KV;KK", "TK;KK", "O^O;KKK"]


def sizes(prediction: Prediction) -> np.ndarray:
    return np.array([prediction.relaxed_course_mm, prediction.relaxed_wale_mm])


@given(st.sampled_from(CHARTS).map(SymbolChart.parse))
def test_mirror_image_and_back_have_the_same_size(chart: SymbolChart) -> None:
    size = sizes(predict(chart, ACRYLIC))
    for image in (chart.mirror(), chart.tile(2, 2)):
        assert sizes(predict(image, ACRYLIC)) == pytest.approx(size, rel=1e-6)


@pytest.mark.parametrize(
    ("text", "wider", "higher"),
    [
        ("O/KK;KKKK", True, False),
        ("K[2/2R]K;KKKKKK;KKKKKK;KKKKKK", False, False),
        ("VK;KK;KV;KK", False, False),
        ("TK;KK;KT;KK", True, False),
    ],
)
def test_signs_that_knitters_agree_on(text: str, wider: bool, higher: bool) -> None:
    size, plain = sizes(predict(text, ACRYLIC)), sizes(predict("K", ACRYLIC))
    assert ((size > plain) == (wider, higher)).all()


def test_a_few_other_stitches_change_little() -> None:
    rows = ["KP" * 20] * 40
    plain = sizes(predict("\n".join(rows), ACRYLIC))
    rows[20] = "O/" + "KP" * 19
    size = sizes(predict(";".join(rows), ACRYLIC))
    assert size == pytest.approx(plain, rel=0.03)


def test_the_stretch_is_that_of_knits_and_purls_with_wider_intervals() -> None:
    lace, plain = predict("O/KP;KKKP", ACRYLIC), predict("KKKP/KKKP", ACRYLIC)
    for direction in Direction:
        own, other = lace.along(direction), plain.along(direction)
        assert own.strain([0.1]) == pytest.approx(other.strain([0.1]))
        low, high = own.strain_interval([0.1])
        assert np.log(high / low) == pytest.approx(
            np.log(np.divide(*other.strain_interval([0.1])[::-1])) + 2 * math.log(2)
        )
        assert own.modulus_interval_n_per_mm.low < other.modulus_interval_n_per_mm.low
    assert lace.provenance is Source.OTHER_STITCHES
    assert any("not been measured" in note for note in lace.notes)


def test_guessed_effects_are_called_so() -> None:
    assert any("tucks on the size is a stated guess" in n for n in predict("TK;KK", ACRYLIC).notes)
    assert not any("guess" in note for note in predict("O/;KK", ACRYLIC).notes)


def test_a_counted_gauge_comes_first() -> None:
    known = predict("O/;KK", ACRYLIC, RelaxedSize(3.0, 2.0))
    assert sizes(known).tolist() == [3.0, 2.0]
    assert known.size_is_known


def test_densities_count_pairs_that_cross() -> None:
    made_of = StitchDensities.of(SymbolChart.parse("P[2/2R]P;PKKKKP;OVTTK/"[:15] + ";OVKKK/"))
    assert made_of.crossings == pytest.approx(4 / 18)
    assert made_of.crossed == pytest.approx(4 / 18)
    assert made_of.yarn_overs == made_of.slips == pytest.approx(1 / 18)


def test_without_yarn_overs_or_crossings_size_and_interval_are_those_of_knits_and_purls() -> None:
    twisted, plain = predict("BP;BP", ACRYLIC), predict("KP/KP", ACRYLIC)
    assert sizes(twisted) == pytest.approx(sizes(plain))
    for direction in Direction:
        own, other = twisted.along(direction), plain.along(direction)
        assert own.relaxed_log_sd == pytest.approx(other.relaxed_log_sd)
    assert twisted.size_errors == plain.size_errors
