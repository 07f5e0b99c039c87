"""The learned answer: exact where it must be, continuous everywhere, honest outside what it saw."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import RelaxedSize, StitchChart, material
from knitcore.chart.fabric import PHASES, Direction
from knitcore.prediction.densities import densities
from knitcore.prediction.learned import LearnedResponse, learned, packaged_model
from tests.knitcore.charts import flipped

ACRYLIC = material("acrylic:published")
STRESS = np.array([0.05, 0.1, 0.2])


def strains(answer: LearnedResponse) -> np.ndarray:
    return np.stack([answer.strain(direction, STRESS) for direction in Direction])


@pytest.mark.parametrize("fabric", PHASES)
def test_a_pure_fabric_keeps_its_size_and_law(fabric: str) -> None:
    answer, record = learned(StitchChart.of_fabric(fabric, 2, 2), ACRYLIC), ACRYLIC.record(fabric)
    assert answer.size_mm == pytest.approx(
        [record.stitch_course_mm, record.stitch_wale_mm], rel=0.02
    )
    for direction in Direction:
        assert answer.modulus_n_per_mm(direction) == pytest.approx(
            record.law.modulus(direction), rel=0.05
        )


@settings(max_examples=10)
@given(
    st.sampled_from(["K", "KP", "P/K", "KP/PK", "KK/KP", "KKPP", "KKPP/KKPP/PPKK/PPKK"]),
    st.sampled_from(["acrylic", "cotton", "lace-bamboo"]),
    st.integers(0, 31), st.integers(0, 31),
)  # fmt: skip
def test_one_stitch_in_1024_changes_an_answer_by_at_most_3_percent(
    text: str, yarn: str, row: int, column: int
) -> None:
    whole = StitchChart.parse(text).resized(32, 32)
    before, after = (learned(c, material(yarn)) for c in (whole, flipped(whole, row, column)))
    assert after.size_mm == pytest.approx(before.size_mm, rel=0.03)
    assert strains(after) == pytest.approx(strains(before), rel=0.03)
    assert after.log_ratio_sd == pytest.approx(before.log_ratio_sd, rel=0.1, abs=0.03)


def test_a_known_size_is_kept_and_narrows_the_interval() -> None:
    basket = StitchChart.parse("KKPP/KKPP/PPKK/PPKK")
    guess = learned(basket, ACRYLIC)
    known = learned(basket, ACRYLIC, RelaxedSize(2.9, 2.2))
    assert known.size_mm == pytest.approx([2.9, 2.2])
    for direction in Direction:
        assert known.strain_log_sd(direction, 0.05) < guess.strain_log_sd(direction, 0.05)


def test_cloth_that_is_narrower_at_rest_stretches_further() -> None:
    rib = StitchChart.parse("KKPP")
    narrow, wide = (learned(rib, ACRYLIC, RelaxedSize(w, 2.8)) for w in (1.9, 2.3))
    assert np.all(strains(narrow)[0] > strains(wide)[0])
    ends = [a.size_mm[0] * (1 + strains(a)[0, 2]) for a in (narrow, wide)]
    assert ends[0] == pytest.approx(ends[1], rel=0.1)  # the stretched size is nearly the same


def test_intervals_widen_away_from_the_training_charts() -> None:
    panels = StitchChart(np.kron([[0, 1], [1, 0]], np.ones((20, 20))).astype(bool))
    charts = StitchChart.parse("KKPP/KKPP/PPKK/PPKK"), panels
    seen, unseen = (learned(chart, ACRYLIC) for chart in charts)
    model = packaged_model()
    numbers = seen.mixture.numbers
    variances = [
        model.folding(model.sample(densities(c).features[None], numbers[None]))[1][0]
        for c in charts
    ]
    assert variances[1] > 1.5 * variances[0]
    assert unseen.log_ratio_sd[0, 2] > seen.log_ratio_sd[0, 2]


def test_samples_were_made_by_these_densities() -> None:
    model = packaged_model()
    for i in range(0, len(model.charts), 40):
        features = densities(StitchChart.parse(model.charts[i])).features / model.feature_scale
        assert model.folding.samples.features[i] == pytest.approx(features, abs=1e-9)
