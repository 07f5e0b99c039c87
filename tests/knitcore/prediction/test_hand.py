import re
from pathlib import Path

import numpy as np
import pytest

from knitcore import Fabric, StitchChart, material, predict
from knitcore.materials import load_library
from knitcore.prediction.hand import PULLS_N_PER_MM, HandPull, hand_pulls

ACRYLIC = material("acrylic")
RIB = StitchChart.parse("KKPP")


def pulls_of(chart: StitchChart) -> tuple[HandPull, ...]:
    return hand_pulls(ACRYLIC, predict(chart, ACRYLIC))


def test_stretches_are_those_of_the_predicted_curve() -> None:
    predicted = predict(RIB, ACRYLIC)
    pulls = pulls_of(RIB)
    assert [pull.pull for pull in pulls] == ["light", "hand", "firm"]
    for pull in pulls:
        assert pull.n_per_mm == PULLS_N_PER_MM[pull.pull]
        for along, stretch in ((predicted.course, pull.course), (predicted.wale, pull.wale)):
            assert stretch.strain == pytest.approx(float(along.strain(pull.n_per_mm)), rel=1e-6)
            assert stretch.strain_interval.low < stretch.strain < stretch.strain_interval.high
    assert np.all(np.diff([pull.course.strain for pull in pulls]) > 0)


def test_a_stretch_has_its_place_among_the_fabrics_of_the_yarn() -> None:
    along = pulls_of(RIB)[1].course
    assert along.word == "very stretchy"
    assert set(along.more_than) == {Fabric.STOCKINETTE, Fabric.GARTER, Fabric.SEED}
    assert along.less_than == (Fabric.RIB,)
    for fabric in Fabric:
        own = pulls_of(StitchChart.of_fabric(fabric))
        assert all(fabric not in (*p.course.more_than, *p.course.less_than) for p in own)


def test_words_go_by_the_stretch() -> None:
    words = ("firm", "slightly stretchy", "stretchy", "very stretchy")
    stretches = [
        of
        for fabric in Fabric
        for pull in pulls_of(StitchChart.of_fabric(fabric))
        for of in (pull.course, pull.wale)
    ]
    ranks = [words.index(of.word) for of in sorted(stretches, key=lambda of: of.strain)]
    assert ranks == sorted(ranks)
    assert {words[rank] for rank in ranks} >= set(words[1:])


GALLERY = Path(__file__).parents[3] / "frontend" / "panels" / "gallery" / "examples.js"


def test_the_gallery_of_the_page_says_what_the_numbers_say() -> None:
    """Notes that compare fabrics hold for every yarn of the library at a hand's pull."""
    notes = re.findall(
        r'(?i)"([^"]*\b(?:gives?|stretch\w*|stiff\w*|soft\w*|firm\w*)\b[^"]*)"', GALLERY.read_text()
    )
    for yarn in load_library().values():
        pulls = {
            fabric: hand_pulls(yarn, predict(chart, yarn))[1]
            for fabric in Fabric
            for chart in [StitchChart.of_fabric(fabric)]
        }
        across = {fabric: pull.course.strain for fabric, pull in pulls.items()}
        lengthwise = {fabric: pull.wale.strain for fabric, pull in pulls.items()}
        twice = 2 * lengthwise[Fabric.STOCKINETTE]
        known = {
            "Of these four, gives least lengthwise.": (
                min(lengthwise, key=lengthwise.__getitem__) is Fabric.STOCKINETTE
            ),
            "Gives more than twice as far lengthwise as stockinette.": (
                lengthwise[Fabric.GARTER] > twice
            ),
            "Of these four, gives most across.": max(across, key=across.__getitem__) is Fabric.RIB,
            "Like garter, gives more than twice as far lengthwise as stockinette.": (
                lengthwise[Fabric.SEED] > twice
            ),
        }
        assert set(known) == set(notes)
        assert all(known.values()), (yarn.identifier, known)
